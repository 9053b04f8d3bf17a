//! Session logs in, significance out.
//!
//! The path of an answer: [`trial_log`] reads the rows that a session wrote. This crate draws nothing and starts
//! nothing; it meets the other crates in files alone.

pub mod binomial;
pub mod chi_square;
pub mod interval;
pub mod proportion;
pub mod special;
pub mod trial_log;
