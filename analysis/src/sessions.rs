//! Logs to sessions: one pass, one row in memory, and every row held against those before it.
//!
//! Beside the row at hand only some hundred bytes a session are kept, to tell a session or a participant that comes twice.

use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};
use std::fs::File;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};

use crate::proportion::Proportion;
use crate::provenance::{HashingReader, LogRecord, Provenance};
use crate::trial_log::{Error, Interval, Phase, Place, Reader, Trial};

/// What one session says.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Session {
    /// The session's name.
    pub id: String,
    /// The participant.
    pub participant: String,
    /// The arm.
    pub arm: String,
    /// The log.
    pub file: PathBuf,
    /// The line of the critical trial, or of the session's first row where it has none.
    pub line: u64,
    /// The critical trial, if it was answered.
    pub critical: Option<Trial>,
    /// The critical pair was shown, whether or not it was answered.
    pub shown: bool,
    /// The participant says to have known the purpose.
    pub knew_task: bool,
    /// Whether the obvious pair was told right.
    pub check: Option<bool>,
    /// The informed trials with a right answer: how many were right.
    pub informed: Proportion,
    /// The participant took part before.
    pub repeated: bool,
}

/// Takes what is read.
pub trait Visitor {
    /// Every row, in the order of the logs.
    fn trial(&mut self, trial: &Trial);
    /// Every session, when its last row was read.
    fn session(&mut self, session: &Session);
}

/// What must be the same in all rows of a report, with the place where it was seen first.
struct Common {
    first: Trial,
    place: String,
}

#[derive(Default)]
struct Checks {
    common: Option<Common>,
    /// The logs read so far, by name.
    files: Vec<PathBuf>,
    /// Where each session begins: the log, by its place in `files`, and the line.
    sessions: HashMap<u128, (u32, u64)>,
    participants: HashSet<u128>,
    /// Whether an arm has a right answer, and where that was seen.
    right_answer: HashMap<String, (bool, String)>,
    /// Which of two qualities is the lower, and where that was seen.
    lower: BTreeMap<[String; 2], (String, String)>,
    versions: BTreeSet<String>,
    started: Option<[String; 2]>,
}

/// Reads logs and hands every row and every session to `visitor`. All rows must be of one study, of one allocation plan
/// and one set of stimuli, and either all simulated or none. `passed` hears how many bytes were read, each time that some
/// were.
///
/// # Errors
/// When a log cannot be read or a row is wrong or does not belong with the others, with file, line and column.
pub fn read(files: &[PathBuf], visitor: &mut impl Visitor, passed: &dyn Fn(u64)) -> Result<Provenance, Error> {
    let mut checks = Checks::default();
    let mut logs = Vec::new();
    for file in files {
        let opened = File::open(file).map_err(|source| Error::Io { file: file.clone(), source })?;
        let (source, digest) = HashingReader::new(opened, passed);
        let mut reader = Reader::new(source, file)?;
        checks.files.push(file.clone());
        let rows = read_log(&mut reader, &mut checks, visitor)?;
        let analysis_plan_hash = sidecar_plan_hash(file)?;
        logs.push(LogRecord { file: file.display().to_string(), sha256: digest.hex(), rows, analysis_plan_hash });
    }
    let common = checks.common.map(|common| common.first);
    Ok(Provenance {
        study: common.as_ref().map(|row| row.study.clone()),
        logs,
        plan_hash: common.as_ref().map(|row| row.plan_hash.clone()),
        stimuli_hash: common.map(|row| row.stimuli_hash),
        session_versions: checks.versions.into_iter().collect(),
        started_utc: checks.started,
        ..Provenance::default()
    })
}

fn read_log<R: std::io::Read>(
    reader: &mut Reader<R>,
    checks: &mut Checks,
    visitor: &mut impl Visitor,
) -> Result<u64, Error> {
    let mut row = Trial::default();
    let mut last = Trial::default();
    let mut session = Session::default();
    let mut rows = 0;
    while reader.read_into(&mut row)? {
        rows += 1;
        checks.row(&row, reader)?;
        if rows == 1 || row.session_id != session.id {
            if rows > 1 {
                visitor.session(&session);
            }
            session = checks.begin(&row, reader)?;
        } else {
            same_session(&row, &last, reader)?;
        }
        visitor.trial(&row);
        take_in(&mut session, &row, reader)?;
        std::mem::swap(&mut row, &mut last);
    }
    if rows > 0 {
        visitor.session(&session);
    }
    Ok(rows)
}

/// Adds a row to its session.
fn take_in<R: std::io::Read>(session: &mut Session, row: &Trial, reader: &Reader<R>) -> Result<(), Error> {
    session.knew_task |= row.known_task == Some(true);
    match row.phase {
        Phase::Practice => {}
        Phase::Critical if session.shown => {
            let message = format!(
                "a second critical trial of session `{}`: a participant has one; later trials are `informed`",
                session.id
            );
            return Err(wrong(reader, "phase", message));
        }
        Phase::Critical => {
            session.shown = true;
            if row.worse_answer.is_some() {
                session.line = reader.place("phase").line;
                session.critical = Some(row.clone());
            }
        }
        Phase::Informed => {
            if let Some(correct) = row.correct {
                session.informed.count(correct);
            }
        }
        Phase::Check => session.check = row.correct.or(session.check),
    }
    Ok(())
}

fn same_session<R: std::io::Read>(row: &Trial, last: &Trial, reader: &Reader<R>) -> Result<(), Error> {
    for (column, found, before) in [("participant", &row.participant, &last.participant), ("arm", &row.arm, &last.arm)]
    {
        if found != before {
            let message = format!("`{found}`, but the rows of session `{}` before it say `{before}`", row.session_id);
            return Err(wrong(reader, column, message));
        }
    }
    if row.trial <= last.trial {
        let message = format!("trial {} after trial {}: is a row there twice, or moved?", row.trial, last.trial);
        return Err(wrong(reader, "trial", message));
    }
    Ok(())
}

impl Checks {
    /// Holds a row against what all rows must share.
    fn row<R: std::io::Read>(&mut self, row: &Trial, reader: &Reader<R>) -> Result<(), Error> {
        match &self.common {
            None => self.common = Some(Common { first: row.clone(), place: here(reader) }),
            Some(Common { first, place }) => {
                let texts = [
                    ("study", &row.study, &first.study, "studies are not pooled; report each by itself"),
                    (
                        "stimuli_hash",
                        &row.stimuli_hash,
                        &first.stimuli_hash,
                        "people saw other pictures, or the log was edited",
                    ),
                    ("plan_hash", &row.plan_hash, &first.plan_hash, "another allocation plan, or the log was edited"),
                ];
                for (column, found, expected, why) in texts {
                    if found != expected {
                        let message = format!("`{found}`, but {place} says `{expected}`: {why}");
                        return Err(wrong(reader, column, message));
                    }
                }
                let flags = [
                    ("simulated", row.simulated, first.simulated, "simulated observers are never pooled with people"),
                    ("demo", row.demo, first.demo, "a demonstration's data never join a study's"),
                ];
                for (column, found, expected, why) in flags {
                    if found != expected {
                        return Err(wrong(reader, column, format!("{found}, but {place} says {expected}: {why}")));
                    }
                }
            }
        }
        self.answer(row, reader)?;
        if !self.versions.contains(&row.version) {
            self.versions.insert(row.version.clone());
        }
        match &mut self.started {
            None => self.started = Some([row.started_utc.clone(), row.started_utc.clone()]),
            Some([first, last]) => {
                if row.started_utc < *first {
                    first.clone_from(&row.started_utc);
                } else if row.started_utc > *last {
                    last.clone_from(&row.started_utc);
                }
            }
        }
        Ok(())
    }

    /// Holds an answer against what `correct` has meant so far.
    fn answer<R: std::io::Read>(&mut self, row: &Trial, reader: &Reader<R>) -> Result<(), Error> {
        let Some(answer) = row.worse_answer else {
            return match row.correct {
                None => Ok(()),
                Some(_) => Err(wrong(reader, "correct", "correct without an answer in worse_answer".to_owned())),
            };
        };
        if row.phase == Phase::Critical {
            let right = row.correct.is_some();
            match self.right_answer.get(&row.arm) {
                None => {
                    self.right_answer.insert(row.arm.clone(), (right, here(reader)));
                }
                Some((before, place)) if *before != right => {
                    let message = format!("arm `{}` {} a right answer here, unlike {place}", row.arm, has(right));
                    return Err(wrong(reader, "correct", message));
                }
                Some(_) => {}
            }
        }
        let Some(correct) = row.correct else { return Ok(()) };
        if row.first_quality == row.second_quality {
            let message = format!("both pictures are `{}`, so no answer is right: expected nothing", row.first_quality);
            return Err(wrong(reader, "correct", message));
        }
        let lower = if (answer == Interval::First) == correct { &row.first_quality } else { &row.second_quality };
        let known = self.lower.iter().find(|(pair, _)| {
            (pair[0] == row.first_quality && pair[1] == row.second_quality)
                || (pair[1] == row.first_quality && pair[0] == row.second_quality)
        });
        match known {
            None => {
                let pair = [row.first_quality.clone(), row.second_quality.clone()];
                self.lower.insert(pair, (lower.clone(), here(reader)));
            }
            Some((_, (before, place))) if before != lower => {
                let message = format!("makes `{lower}` the lower quality, but {place} makes it `{before}`");
                return Err(wrong(reader, "correct", message));
            }
            Some(_) => {}
        }
        Ok(())
    }

    fn begin<R: std::io::Read>(&mut self, row: &Trial, reader: &Reader<R>) -> Result<Session, Error> {
        let place = reader.place("session_id");
        let file = u32::try_from(self.files.len().saturating_sub(1)).unwrap_or(u32::MAX);
        if let Some((file, line)) = self.sessions.insert(key(&row.session_id), (file, place.line)) {
            let file = self.files.get(file as usize).cloned().unwrap_or_default();
            let before = Place { file, line, column: None };
            let message = format!("session `{}` is already in {before}: is a log given twice?", row.session_id);
            return Err(wrong(reader, "session_id", message));
        }
        let repeated = !self.participants.insert(key(&row.participant));
        Ok(Session {
            id: row.session_id.clone(),
            participant: row.participant.clone(),
            arm: row.arm.clone(),
            file: place.file,
            line: place.line,
            repeated,
            ..Session::default()
        })
    }
}

fn has(right: bool) -> &'static str {
    if right { "has" } else { "has not" }
}

fn here<R: std::io::Read>(reader: &Reader<R>) -> String {
    Place { column: None, ..reader.place("study") }.to_string()
}

fn wrong<R: std::io::Read>(reader: &Reader<R>, column: &str, message: String) -> Error {
    Error::Content { place: reader.place(column), message }
}

/// 128 bits of a name: two different names alike in all of them are not to be expected.
fn key(name: &str) -> u128 {
    let half = |salt: u8| {
        let mut hasher = DefaultHasher::new();
        (salt, name).hash(&mut hasher);
        u128::from(hasher.finish())
    };
    half(0) << 64 | half(1)
}

/// The hash of the analysis plan in the JSON beside a log, if it is there.
fn sidecar_plan_hash(log: &Path) -> Result<Option<String>, Error> {
    #[derive(serde::Deserialize)]
    struct Head {
        analysis_plan_hash: Option<String>,
    }
    let file = log.with_extension("json");
    let Ok(text) = std::fs::read_to_string(&file) else { return Ok(None) };
    serde_json::from_str::<Head>(&text).map(|head| head.analysis_plan_hash).map_err(|error| Error::Content {
        place: Place { line: error.line() as u64, column: Some((error.column(), String::new())), file },
        message: format!("not the sidecar of a log: {error}"),
    })
}
