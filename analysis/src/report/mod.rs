//! The report: one value, written as HTML, Markdown, JSON or CSV.

pub mod arm;
pub mod between;
mod block;
mod csv_table;
mod document;
pub mod equivalence;
mod escape;
mod gather;
mod html;
pub mod ladder;
mod markdown;
pub mod numbers;
pub mod planning;
pub mod plot;
mod sources;
pub mod target;
pub mod words;

use std::path::PathBuf;

use serde::Serialize;
use stimuli::Sha256;

use crate::exclude::{Excluded, Reason};
use crate::pictures::Picture;
use crate::plan::Plan;
use crate::provenance::Provenance;
use crate::sessions;
use crate::tally::ArmTally;
use crate::timing::Timing;
use crate::trial_log::Error;
use arm::ArmReport;
use between::{ContrastReport, Multiplicity};
use gather::Gather;
use ladder::Ladder;

/// Exclusions that are listed one by one; beyond, they are only counted.
pub const LISTED: usize = 10_000;

/// What to report on and how.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// The analysis plan; without one the level is .05, there is no equivalence bound, and only interrupted trials and
    /// those who knew the purpose are left out.
    pub plan: Option<Plan>,
    /// The pictures of the study's folder, with the manifest's digest.
    pub pictures: Option<(Vec<Picture>, Sha256)>,
}

/// Everything that a report says.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// True when simulated observers answered, and nobody else.
    pub simulated: bool,
    /// True when the data are a demonstration's.
    pub demo: bool,
    /// Level of every test.
    pub alpha: f64,
    /// The arms, in order of name, without the excluded trials.
    pub arms: Vec<ArmReport>,
    /// Arms with a right answer against one another.
    pub contrasts: Vec<ContrastReport>,
    /// The primary tests, adjusted for being several.
    pub multiplicity: Multiplicity,
    /// The arms as steps of a ladder, where at least three qualities have known costs.
    pub ladder: Option<Ladder>,
    /// The arms with every answered critical trial.
    pub without_exclusions: Vec<ArmReport>,
    /// Sessions whose critical trial is left out, the first [`LISTED`] of them.
    pub exclusions: Vec<Excluded>,
    /// From sessions to analysed trials.
    pub flow: Flow,
    /// How long pictures stood; none for published counts.
    pub timing: Option<Timing>,
    /// The analysis plan.
    pub plan: Option<Plan>,
    /// What departs from the plan, or cannot be held against one.
    pub deviations: Vec<String>,
    /// The pictures that were shown, where the study's folder was given.
    pub stimuli: Vec<Picture>,
    /// Where the numbers come from.
    pub provenance: Provenance,
}

/// How many came, how many were left out and why, how many remain.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Flow {
    /// Sessions begun.
    pub sessions: u64,
    /// Sessions left out, by reason, in the order in which reasons are looked for.
    pub excluded: Vec<(Reason, u64)>,
    /// Participants analysed.
    pub analysed: u64,
    /// The same by arm.
    pub by_arm: Vec<(String, u64)>,
}

/// Reads logs and reports on them.
///
/// # Errors
/// When a log cannot be read or is wrong, with file, line and column.
pub fn of_logs(logs: &[PathBuf], options: &Options) -> Result<Report, Error> {
    of_logs_told(logs, options, &|_| ())
}

/// The same; `passed` hears how many bytes of the logs were read, each time that some were.
///
/// # Errors
/// As [`of_logs`].
pub fn of_logs_told(logs: &[PathBuf], options: &Options, passed: &dyn Fn(u64)) -> Result<Report, Error> {
    let mut gather = Gather::new(options);
    let provenance = sessions::read(logs, &mut gather, passed)?;
    Ok(gather.report(provenance, options))
}

/// Reports on published counts: each arm with its count of right answers, or, where none is right, of the second
/// interval. `typed` is kept as the numbers' source.
#[must_use]
pub fn of_counts(arms: &[(String, ArmTally)], typed: Vec<String>, options: &Options) -> Report {
    let mut gather = Gather::new(options);
    for (name, arm) in arms {
        gather.kept.arms.insert(name.clone(), arm.clone());
    }
    gather.report(Provenance { counts: typed, ..Provenance::default() }, options)
}

impl Report {
    /// The report as JSON, in the shape of `report.schema.json`.
    #[must_use]
    pub fn to_json(&self) -> String {
        serde_json::to_string_pretty(self).expect("a report is names and numbers") + "\n"
    }

    /// The report as Markdown.
    #[must_use]
    pub fn to_markdown(&self) -> String {
        markdown::write(&document::of(self))
    }

    /// The report as one HTML page that needs nothing else: no script, no network.
    #[must_use]
    pub fn to_html(&self) -> String {
        html::write(&document::of(self))
    }

    /// Every number of every arm, one a row: arm, quantity, value.
    #[must_use]
    pub fn to_csv(&self) -> String {
        csv_table::write(self)
    }

    /// The report's heading.
    #[must_use]
    pub fn title(&self) -> String {
        match &self.provenance.study {
            Some(study) if self.simulated => format!("Study {study}, rehearsed: what simulated observers answered"),
            Some(study) => format!("Study {study}: what people noticed"),
            None if self.provenance.logs.is_empty() => "Published counts: what people noticed".to_owned(),
            None => "Empty logs".to_owned(),
        }
    }
}
