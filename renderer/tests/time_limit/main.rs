//! Rendering under a time limit on a clock that the tests wind, with rays that are words: nothing here waits.

mod estimates;
mod files;
mod odds;
#[path = "../language/scene.rs"]
#[allow(dead_code, reason = "shared with the language's tests")]
mod scene;
mod tasks;
mod tracer;
#[path = "../language/trees.rs"]
#[allow(dead_code, reason = "shared with the language's tests")]
mod trees;
