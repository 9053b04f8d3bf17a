//! Where a report's numbers come from: digests of what was read.

use std::cell::RefCell;
use std::io::Read;
use std::rc::Rc;

use serde::Serialize;
use sha2::{Digest, Sha256};

/// One log that was read.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LogRecord {
    /// The file's name as given.
    pub file: String,
    /// SHA-256 of its bytes.
    pub sha256: String,
    /// Rows in it.
    pub rows: u64,
    /// SHA-256 of the analysis plan that its sidecar recorded before the first trial, where it did.
    pub analysis_plan_hash: Option<String>,
}

/// Where the numbers come from.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Provenance {
    /// The study, as the rows name it.
    pub study: Option<String>,
    /// The logs, in the order given.
    pub logs: Vec<LogRecord>,
    /// Counts from the command line instead of logs, as typed.
    pub counts: Vec<String>,
    /// SHA-256 of the allocation plan, from the rows.
    pub plan_hash: Option<String>,
    /// SHA-256 of the stimuli manifest, from the rows.
    pub stimuli_hash: Option<String>,
    /// SHA-256 of the analysis plan used.
    pub analysis_plan_hash: Option<String>,
    /// Versions of the program that wrote the rows.
    pub session_versions: Vec<String>,
    /// When the first and the last session began, universal time.
    pub started_utc: Option<[String; 2]>,
    /// Version of the program that made the report.
    pub report_version: String,
}

/// A reader that takes the digest of what passes through.
pub(crate) struct HashingReader<'a, R> {
    inner: R,
    passed: &'a dyn Fn(u64),
    state: Rc<RefCell<Sha256>>,
}

/// The digest of what a [`HashingReader`] has passed so far.
#[derive(Clone)]
pub(crate) struct Digested(Rc<RefCell<Sha256>>);

impl Digested {
    pub(crate) fn hex(&self) -> String {
        self.0.borrow().clone().finalize().iter().map(|byte| format!("{byte:02x}")).collect()
    }
}

impl<'a, R> HashingReader<'a, R> {
    /// `passed` hears how many bytes came through, each time that some did.
    pub(crate) fn new(inner: R, passed: &'a dyn Fn(u64)) -> (Self, Digested) {
        let state = Rc::new(RefCell::new(Sha256::new()));
        (Self { inner, passed, state: Rc::clone(&state) }, Digested(state))
    }
}

impl<R: Read> Read for HashingReader<'_, R> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let count = self.inner.read(buffer)?;
        self.state.borrow_mut().update(&buffer[..count]);
        (self.passed)(count as u64);
        Ok(count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_passes_is_digested() {
        let (mut reader, digest) = HashingReader::new(&b"abc"[..], &|_| ());
        std::io::copy(&mut reader, &mut std::io::sink()).unwrap();
        // FIPS 180-2, appendix B.1.
        assert_eq!(digest.hex(), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    }
}
