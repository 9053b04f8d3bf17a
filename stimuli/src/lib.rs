//! The study file, the manifest of its pictures, and their hashes.
//!
//! A study is a folder: `study.toml` says what is shown to whom ([`Study`]), the scenes lie beside it, and
//! `manifest.json` ([`Manifest`]) records which picture was made from which inputs. The renderer writes the pictures and
//! the manifest, the session reads both; their shapes have this one home. Nothing here draws.

pub mod error;
pub mod hash;
pub mod manifest;
pub mod study;

pub use error::{Error, Result};
pub use hash::Sha256;
pub use manifest::{Manifest, MapRecord, PictureRecord, PictureStatus, Timing};
pub use study::{Layout, MapRequest, Quality, Request, Stimulus, Study};
