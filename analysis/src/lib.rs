//! Session logs in, significance out.
//!
//! The path of an answer: [`trial_log`] reads the rows that a session wrote, [`sessions`] holds them against one another,
//! [`exclude`] leaves out what the [`plan`] leaves out, [`tally`] counts, the tests ([`chi_square`], [`mod@binomial`],
//! [`interval`]) judge the counts, and [`report`] says what they say. [`special`] has the distributions underneath.
//!
//! The crate draws nothing and starts nothing; it meets the other crates in files alone.

pub mod bayes;
pub mod binomial;
pub mod chi_square;
pub mod contrast;
pub mod counting;
pub mod effect;
pub mod equivalence;
pub mod exclude;
pub mod interval;
pub mod order;
pub mod pictures;
pub mod plan;
pub mod power;
pub mod proportion;
pub mod provenance;
pub mod psychometric;
pub mod report;
pub mod sessions;
pub mod special;
pub mod tally;
pub mod timing;
pub mod trial_log;
