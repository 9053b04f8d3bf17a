//! The session log: one CSV row per trial, written by the session, read by the report.
//!
//! This is the one home of the shape of a row. [`Trial`] is a row with types, [`COLUMNS`] the columns with their units
//! and meaning (the JSON sidecar, [`Sidecar`], repeats them beside every log), [`header_line`] and [`row_line`] the
//! bytes of a log, [`Reader`] the way back, with errors that name file, line and column.

mod columns;
mod error;
mod field;
mod read;
mod row;
mod sidecar;
mod write;

pub use columns::{COLUMNS, Column, column};
pub use error::{Error, Place};
pub use read::Reader;
pub use row::{Interval, OnsetSource, Phase, Trial, Vsync};
pub use sidecar::Sidecar;
pub use write::{header_line, row_line};

#[cfg(test)]
mod tests;
