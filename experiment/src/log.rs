//! A session on disk: rows and journal, in a folder of its own, each line synced before the session goes on.
//!
//! | file | holds |
//! |---|---|
//! | `P01.csv` | a row per trial ([`analysis::trial_log`]) |
//! | `P01.json` | what its columns mean |
//! | `P01.events.jsonl` | the journal: start, consent, every pair before it is shown, every row's digest, what was noticed, the end |
//!
//! Files are created so that nothing can be overwritten (`O_EXCL`), opened for appending, and a line is one `write` and
//! one `fdatasync`; the folder is synced when a file was added.

mod disk;
mod journal;
mod row;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use analysis::trial_log::{Reader, Sidecar, Trial as Row, header_line, row_line};
use stimuli::Sha256;

use crate::clock::Utc;
use crate::display::{Display, DisplayFacts};
use crate::error::{Error, Result};
use crate::session::{Done, Record};
use crate::setup::Conditions;

pub(crate) use disk::sync_folder_of;
pub use disk::{AppendFile, write_new};
pub use journal::{Event, Journal, Line, read_journal};
pub use row::Identity;

/// The open files of one session.
#[derive(Debug)]
pub struct SessionLog {
    identity: Identity,
    rows: AppendFile,
    journal: Journal,
}

/// A session taken up again.
#[derive(Debug)]
pub struct Recovered {
    /// Its log, ready to go on.
    pub log: SessionLog,
    /// What is on disk.
    pub done: Done,
    /// The slot of the plan.
    pub slot: u32,
    /// The rows.
    pub rows: Vec<Row>,
    /// From the last line of the journal to now, seconds.
    pub gap_s: f64,
    /// From the session's start to now, seconds.
    pub since_start_s: f64,
    /// Half lines that were found at the ends of files: put aside in files of their own, not thrown away.
    pub torn: Vec<PathBuf>,
}

impl SessionLog {
    /// Begins the files of a session in its folder, which must hold none.
    ///
    /// # Errors
    /// If one is there already or cannot be written.
    pub fn create(folder: &Path, identity: Identity, slot: u32, analysis_plan: Sha256, now: Utc) -> Result<Self> {
        let file = |ending: &str| folder.join(format!("{}{ending}", identity.participant));
        let csv = format!("{}.csv", identity.participant);
        let sidecar = Sidecar::new(&csv, &identity.study, &identity.version, Some(analysis_plan.to_string()));
        write_new(&file(".json"), sidecar.to_json().as_bytes())?;
        let mut rows = AppendFile::create(&file(".csv"))?;
        rows.append(header_line().as_bytes())?;
        // The journal comes last: where it is, everything is.
        let started = Event::Started { identity: identity.clone(), slot };
        let journal = Journal::create(&file(".events.jsonl"), started, now)?;
        Ok(Self { identity, rows, journal })
    }

    /// Whether a session's folder holds a journal with at least its first line: only then may anything have been shown.
    #[must_use]
    pub fn was_begun(folder: &Path, participant: &str) -> bool {
        let journal = std::fs::read(folder.join(format!("{participant}.events.jsonl")));
        journal.is_ok_and(|bytes| bytes.contains(&b'\n'))
    }

    /// Renames what a session left that was killed before its first line, so that it can be begun.
    ///
    /// # Errors
    /// If a file cannot be renamed.
    pub fn put_aside(folder: &Path, participant: &str, now: Utc) -> Result<()> {
        for ending in [".json", ".csv", ".events.jsonl"] {
            let path = folder.join(format!("{participant}{ending}"));
            if path.exists() {
                let aside = folder.join(format!("{participant}{ending}.unused-{}", now.micros()));
                std::fs::rename(&path, &aside).map_err(Error::io("put aside", &path))?;
            }
        }
        Ok(())
    }

    /// Opens the files of a session that broke off, and finds out how far it came.
    ///
    /// # Errors
    /// If they cannot be read or are not what a session writes.
    pub fn recover(folder: &Path, participant: &str, now: Utc) -> Result<Recovered> {
        let file = |ending: &str| folder.join(format!("{participant}{ending}"));
        let csv = file(".csv");
        let (mut journal, lines, torn_line) = Journal::recover(&file(".events.jsonl"), now)?;
        let (rows, torn_row) = AppendFile::recover(&csv, now)?;
        let Some(Line { event: Event::Started { identity, slot }, unix_us, .. }) = lines.first().cloned() else {
            let message = format!("{}: its first line does not start a session", file(".events.jsonl").display());
            return Err(Error::Input(message));
        };
        let mut done = Done::default();
        lines.iter().for_each(|line| line.event.mark(&mut done));
        let found = compare_rows(&csv, &lines, &mut journal, now)?;
        done.finished = found.iter().map(|row| row.trial).collect();
        let last = lines.last().map_or(unix_us, |line| line.unix_us);
        let since = |earlier: u64| now.micros().saturating_sub(earlier) as f64 * 1e-6;
        let (gap_s, since_start_s) = (since(last), since(unix_us));
        journal.append(Event::Resumed { gap_s }, now)?;
        let torn = torn_line.into_iter().chain(torn_row).collect();
        Ok(Recovered { log: Self { identity, rows, journal }, done, slot, rows: found, gap_s, since_start_s, torn })
    }

    /// Whose session this is.
    #[must_use]
    pub fn identity(&self) -> &Identity {
        &self.identity
    }

    /// Brings what the experimenter stated to the disk.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn state(&mut self, conditions: Conditions, now: Utc) -> Result<()> {
        self.journal.append(Event::Conditions { conditions }, now)
    }

    /// Brings what was found about the display to the disk.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn found(&mut self, display: Display, zero: Utc, now: Utc) -> Result<()> {
        self.journal.append(Event::Display { display, zero_unix_us: zero.micros() }, now)
    }

    /// Brings a record to the disk; it is there when this returns. Gives the row that a trial became.
    ///
    /// # Errors
    /// If it cannot be written. A line that was written in part is taken back, so that the record may be saved again.
    pub fn save(
        &mut self,
        record: &Record,
        display: &DisplayFacts,
        known_task: Option<bool>,
        now: Utc,
    ) -> Result<Option<Row>> {
        if let Record::Trial { plan, observed, resume_gap_s } = record {
            let row = row::row(&self.identity, display, plan, observed, known_task, *resume_gap_s);
            self.rows.append(row_line(&row).as_bytes())?;
            self.journal.append(Event::row(&row), now)?;
            return Ok(Some(row));
        }
        if let Some(event) = Event::of(record) {
            self.journal.append(event, now)?;
        }
        Ok(None)
    }
}

/// The rows of a log, each compared with its digest in the journal. The last row may have none
/// there, if the program was killed between the two: it counts, and the journal is completed.
fn compare_rows(csv: &Path, lines: &[Line], journal: &mut Journal, now: Utc) -> Result<Vec<Row>> {
    let mut digests: BTreeMap<u32, Sha256> = BTreeMap::new();
    for line in lines {
        if let Event::Row { trial, sha256 } = line.event {
            digests.insert(trial, sha256);
        }
    }
    let wrong = |trial: u32, what: &str| {
        let message = format!("{}: the row of trial {trial} {what}; restore the log from a backup", csv.display());
        Error::Input(message)
    };
    let mut rows = Vec::new();
    let mut reader = Reader::open(csv)?;
    let mut row = Row::default();
    while reader.read_into(&mut row)? {
        match digests.remove(&row.trial) {
            Some(digest) if digest != Sha256::of(row_line(&row).as_bytes()) => {
                return Err(wrong(row.trial, "is not the one that was written"));
            }
            Some(_) => {}
            None => journal.append(Event::row(&row), now)?,
        }
        rows.push(row.clone());
    }
    match digests.keys().next() {
        Some(&trial) => Err(wrong(trial, "is missing")),
        None => Ok(rows),
    }
}

#[cfg(test)]
mod tests;
