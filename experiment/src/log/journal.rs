//! The journal: what happened in a session besides its rows, one JSON object a line, each with the digest of the line
//! before it, so that a line that was altered, removed or added later is found.

use std::path::{Path, PathBuf};

use analysis::trial_log::{Phase, Trial as Row, row_line};
use serde::{Deserialize, Serialize};
use stimuli::Sha256;

use super::{AppendFile, Identity};
use crate::clock::Utc;
use crate::display::Display;
use crate::error::{Error, Result};
use crate::session::{Done, Outcome, Record};
use crate::setup::Conditions;

/// What happened.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "event", rename_all = "snake_case")]
pub enum Event {
    /// The session began.
    Started {
        /// Whose it is, and with what.
        identity: Identity,
        /// The slot of the plan.
        slot: u32,
    },
    /// What the experimenter stated; an empty value is not measured.
    Conditions {
        /// Names with their units, and values.
        conditions: Conditions,
    },
    /// What was found about the display.
    Display {
        /// Everything.
        display: Display,
        /// Universal time of the session's zero second, microseconds since the start of 1970: with it, somebody who
        /// watched the screen from outside can hold their clock against this one.
        zero_unix_us: u64,
    },
    /// It was taken up again.
    Resumed {
        /// After a break of so many seconds.
        gap_s: f64,
    },
    /// Consent was asked.
    Consent {
        /// The answer.
        agreed: bool,
    },
    /// A pair is about to be shown.
    PairStarts {
        /// The trial's number.
        trial: u32,
        /// Its phase, by the word of the log.
        phase: String,
    },
    /// A row is on disk.
    Row {
        /// The trial's number.
        trial: u32,
        /// The digest of the row's line.
        sha256: Sha256,
    },
    /// What was noticed.
    Noticed {
        /// In the participant's words.
        text: String,
    },
    /// Whether the purpose was known.
    KnownTask {
        /// The answer.
        known: bool,
    },
    /// The session is over.
    Ended {
        /// How: completed, declined or aborted.
        outcome: String,
    },
}

impl Event {
    /// The event that a record is; `None` for a trial, whose row tells it.
    #[must_use]
    pub fn of(record: &Record) -> Option<Self> {
        Some(match record {
            Record::Consent(agreed) => Self::Consent { agreed: *agreed },
            Record::PairStarts { trial, phase } => Self::PairStarts { trial: *trial, phase: word(*phase).to_owned() },
            Record::Noticed(text) => Self::Noticed { text: text.clone() },
            Record::KnownTask(known) => Self::KnownTask { known: *known },
            Record::Ended(outcome) => Self::Ended { outcome: outcome.word().to_owned() },
            Record::Trial { .. } => return None,
        })
    }

    /// The event of a row that was written.
    #[must_use]
    pub fn row(row: &Row) -> Self {
        Self::Row { trial: row.trial, sha256: Sha256::of(row_line(row).as_bytes()) }
    }

    /// What this event says about how far the session came.
    pub(super) fn mark(&self, done: &mut Done) {
        match self {
            Self::Started { .. }
            | Self::Conditions { .. }
            | Self::Display { .. }
            | Self::Resumed { .. }
            | Self::Row { .. } => {}
            Self::Consent { agreed } => done.consent = Some(*agreed),
            Self::PairStarts { trial, .. } => {
                done.started.insert(*trial);
            }
            Self::Noticed { .. } => done.noticed = true,
            Self::KnownTask { known } => done.known_task = Some(*known),
            Self::Ended { outcome } => done.ended = Outcome::of(outcome),
        }
    }
}

fn word(phase: Phase) -> &'static str {
    match phase {
        Phase::Practice => "practice",
        Phase::Critical => "critical",
        Phase::Informed => "informed",
        Phase::Check => "check",
    }
}

impl Outcome {
    /// The word in the journal.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Completed => "completed",
            Self::Declined => "declined",
            Self::Aborted => "aborted",
        }
    }

    fn of(word: &str) -> Option<Self> {
        [Self::Completed, Self::Declined, Self::Aborted].into_iter().find(|outcome| outcome.word() == word)
    }
}

/// One line of a journal.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Line {
    /// Number of the line, from 1.
    pub n: u64,
    /// When, universal time, to the second.
    pub utc: String,
    /// The same in microseconds since the start of 1970.
    pub unix_us: u64,
    /// What.
    #[serde(flatten)]
    pub event: Event,
    /// The digest of the line before, line end left out; of nothing in the first.
    pub previous: Sha256,
}

/// A journal that is being written.
#[derive(Debug)]
pub struct Journal {
    file: AppendFile,
    n: u64,
    last: Sha256,
}

impl Journal {
    /// Begins a journal with its first event.
    ///
    /// # Errors
    /// If the file is there already or cannot be written.
    pub fn create(path: &Path, first: Event, now: Utc) -> Result<Self> {
        let mut journal = Self { file: AppendFile::create(path)?, n: 0, last: Sha256::of(b"") };
        journal.append(first, now)?;
        Ok(journal)
    }

    /// Opens a journal whose writer may have died, checks its chain and gives its lines.
    ///
    /// # Errors
    /// If it cannot be read, or a line does not follow from the one before it.
    pub fn recover(path: &Path, now: Utc) -> Result<(Self, Vec<Line>, Option<PathBuf>)> {
        let (file, torn) = AppendFile::recover(path, now)?;
        let text = std::fs::read_to_string(path).map_err(Error::io("read", path))?;
        let lines = read(&text, path)?;
        let last = Sha256::of(text.lines().last().unwrap_or("").as_bytes());
        Ok((Self { file, n: lines.len() as u64, last }, lines, torn))
    }

    /// Appends an event; it is on disk when this returns.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn append(&mut self, event: Event, now: Utc) -> Result<()> {
        let line = Line { n: self.n + 1, utc: now.to_string(), unix_us: now.micros(), event, previous: self.last };
        let text = serde_json::to_string(&line).map_err(|error| Error::Machine(format!("journal: {error}")))?;
        self.file.append(format!("{text}\n").as_bytes())?;
        self.n = line.n;
        self.last = Sha256::of(text.as_bytes());
        Ok(())
    }
}

/// The whole lines of a journal, which is left as it is.
///
/// # Errors
/// If it cannot be read, or a line does not follow from the one before it.
pub fn read_journal(path: &Path) -> Result<Vec<Line>> {
    let text = std::fs::read_to_string(path).map_err(Error::io("read", path))?;
    read(&text[..text.rfind('\n').map_or(0, |end| end + 1)], path)
}

/// The lines of a journal, each checked against the one before it.
pub(super) fn read(text: &str, path: &Path) -> Result<Vec<Line>> {
    let mut previous = Sha256::of(b"");
    let mut lines = Vec::new();
    for (number, text) in (1..).zip(text.lines()) {
        let wrong = |what: String| Error::Input(format!("{}:{number}:1: {what}", path.display()));
        let line: Line =
            serde_json::from_str(text).map_err(|error| wrong(format!("not a line of a session's journal: {error}")))?;
        if line.previous != previous || line.n != number {
            let what =
                "this line does not follow from the one before: the journal was altered; restore it from a backup";
            return Err(wrong(what.to_owned()));
        }
        previous = Sha256::of(text.as_bytes());
        lines.push(line);
    }
    Ok(lines)
}
