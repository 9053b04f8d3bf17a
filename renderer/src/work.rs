//! The values that pass between the scheduler, which knows the crex, and the tracer, which knows rays.

use crate::component::{Component, PerComponent};

/// Rays (not spawn records) now visible in each component's bin.
pub type BinOccupancy = PerComponent<u64>;

/// Where in a crex's execution a stage stands: item positions and repeat iterations from the root down.
/// Ordered as the stages of one execution run, so the stages of many tiles merge by key.
pub type StageKey = Vec<u32>;

/// One run of one component.
#[derive(Clone, Debug, PartialEq)]
pub struct Stage {
    /// Its place in the execution.
    pub key: StageKey,
    /// What runs.
    pub component: Component,
    /// Byte offsets of the component's letter in the crex text, end exclusive.
    pub span: (usize, usize),
    /// How often this letter of the text has run, from 1.
    pub run: u32,
    /// Only rays of pixels with at least this importance run; the others stay in their bin.
    pub threshold: Option<f32>,
    /// Rays spawned by this stage stay hidden until [`Work::Release`].
    pub held: bool,
}

/// What the tracer is to do next.
#[derive(Clone, Debug, PartialEq)]
pub enum Work {
    /// Trace every visible ray of a component's bin that the threshold admits.
    Run(Stage),
    /// Make all held rays visible: the outermost `< >` has ended.
    Release,
}

/// What a [`Work::Run`] did.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WorkReport {
    /// Rays traced.
    pub rays: u64,
    /// Rays (not records) spawned, by component.
    pub spawned: PerComponent<u64>,
    /// Seconds that it took, by the renderer's clock.
    pub seconds: f64,
}
