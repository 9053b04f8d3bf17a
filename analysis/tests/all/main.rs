//! What needs whole logs, or the program.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod bad_logs;
mod false_alarms;
mod golden;
mod logs;
mod paper;
mod program;
mod properties;
mod reports;
mod schema;
mod sentences;
