//! The study of the tests.

use std::path::Path;

use stimuli::Study;

/// The two arms of the paper with `n` participants each, on three layouts.
pub(crate) fn study(n: u32) -> Study {
    let text = include_str!("../tests/data/study.toml");
    let mut study = Study::parse(text, Path::new("tests/data/study.toml")).unwrap_or_else(|error| panic!("{error}"));
    for arm in &mut study.arms {
        arm.n = n;
    }
    study
}
