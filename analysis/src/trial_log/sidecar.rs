//! The JSON that lies beside every log and says what its columns mean.

use serde::Serialize;

use stimuli::Study;

use super::{COLUMNS, Column};
use crate::plan::Plan;

/// The sidecar of a log: `LOG.json` beside `LOG.csv`.
#[derive(Clone, Debug, Serialize)]
pub struct Sidecar {
    /// File name of the log it describes.
    pub log: String,
    /// Name of the study.
    pub study: String,
    /// Version of the program that wrote it.
    pub version: String,
    /// SHA-256 of the analysis plan as it was when the session began, where the study has one.
    pub analysis_plan_hash: Option<String>,
    /// Every column with its unit and meaning.
    pub columns: Vec<Column>,
}

impl Sidecar {
    /// A sidecar for one log.
    #[must_use]
    pub fn new(log: &str, study: &str, version: &str, analysis_plan_hash: Option<String>) -> Self {
        Self {
            log: log.to_owned(),
            study: study.to_owned(),
            version: version.to_owned(),
            analysis_plan_hash,
            columns: COLUMNS.to_vec(),
        }
    }

    /// The sidecar of a log of `study`, with the hash of the study's analysis plan.
    #[must_use]
    pub fn of_study(log: &str, study: &Study, version: &str) -> Self {
        Self::new(log, &study.id, version, Plan::of(study).map(|plan| plan.hash().to_string()))
    }

    /// The sidecar's text.
    #[must_use]
    pub fn to_json(&self) -> String {
        serde_json::to_string_pretty(self).expect("a sidecar is plain text and lists") + "\n"
    }
}
