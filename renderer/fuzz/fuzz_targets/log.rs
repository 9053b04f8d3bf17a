#![no_main]

use std::path::Path;

use analysis::trial_log::{Reader, Trial};

// Rows are read or refused.
libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    let Ok(mut reader) = Reader::new(data, Path::new("log.csv")) else { return };
    let mut trial = Trial::default();
    for _ in 0..10_000 {
        match reader.read_into(&mut trial) {
            Ok(true) => {}
            Ok(false) | Err(_) => return,
        }
    }
});
