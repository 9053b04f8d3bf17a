//! The crex language against its rules: texts, errors, and what runs on scenes made of words.

mod errors;
mod paper;
mod prose;
mod rules;
mod scene;
mod texts;
mod tiles;
mod trees;
mod words;
