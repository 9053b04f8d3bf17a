//! Simulated and real observers: a timed two-interval session and its log.

pub mod app;
pub mod bids;
pub mod bot;
pub mod clock;
pub mod conduct;
pub mod design;
pub mod display;
pub mod draw;
pub mod enrol;
pub mod error;
pub mod input;
pub mod log;
pub mod observer;
pub mod participant;
pub mod rehearse;
pub mod script;
pub mod selftest;
pub mod session;
pub mod setup;
pub mod stimulus;
pub mod timing;
pub mod trial;
pub mod withdraw;

#[cfg(test)]
mod example;
