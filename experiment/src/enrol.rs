//! The data folder: the plan's record, slots handed out to one participant each, a folder for every session.
//!
//! | in the folder | is |
//! |---|---|
//! | `plan.json` | what may be known of the plan: seed, hash, cell totals; made before the first participant |
//! | `slots/0007-1.json` | the claim of slot 7; `-2` is the next claim, after the first was given back |
//! | `slots/0007-1.back.json` | slot 7 was given back, and why |
//! | `sessions/P01/` | one session |
//!
//! A claim is the creation of a file that must not exist: whatever number of machines share the folder, one of them gets
//! the slot. No file is ever changed or removed.

use std::cell::Cell;
use std::fs::OpenOptions;
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use stimuli::{Sha256, Study};

use crate::clock::{Clock, Utc};
use crate::design::{CellTotal, Plan, Slot};
use crate::error::{Error, Result};
use crate::log::{AppendFile, Identity, write_new};
use crate::participant::check_code;

/// Name and version of this program, as every row has it.
pub const VERSION: &str = concat!("crex-session ", env!("CARGO_PKG_VERSION"));

/// What a session may need at most, bytes: its lines are a few hundred bytes each.
const ROOM: usize = 1 << 20;

/// What may be known of a plan beforehand; `plan.json`.
#[derive(Debug, Serialize)]
struct PlanRecord {
    study: String,
    title: String,
    demo: bool,
    simulated: bool,
    seed: u64,
    times: u32,
    study_hash: Sha256,
    stimuli_hash: Sha256,
    plan_hash: Sha256,
    analysis_plan_hash: Sha256,
    consent_version: String,
    consent_hash: Sha256,
    slots: usize,
    cells: Vec<CellTotal>,
    version: String,
    created_utc: String,
}

/// What is read back of `plan.json`.
#[derive(Debug, Deserialize)]
struct PlanKey {
    simulated: bool,
    times: u32,
    plan_hash: Sha256,
    stimuli_hash: Sha256,
}

/// A slot's claim.
#[derive(Debug, Serialize, Deserialize)]
struct Claim {
    participant: String,
    simulated: bool,
    utc: String,
}

/// A slot that is taken.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Claimed {
    /// The slot.
    pub slot: Slot,
    /// How often it has been handed out, this time included.
    pub generation: u32,
}

/// Whether people or programs answer. The two never share a folder.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// People.
    Real,
    /// Programs; the plan has so many times the study's participants.
    Simulated {
        /// At least 1.
        times: u32,
    },
}

impl Kind {
    fn is_simulated(self) -> bool {
        matches!(self, Self::Simulated { .. })
    }

    fn times(self) -> u32 {
        match self {
            Self::Real => 1,
            Self::Simulated { times } => times,
        }
    }
}

/// A study's data folder.
#[derive(Debug)]
pub struct DataFolder {
    folder: PathBuf,
    kind: Kind,
    plan: Plan,
    plan_hash: Sha256,
    stimuli_hash: Sha256,
    /// No slot before this index was free when last looked at: saves looking at all of them every time.
    first_free: Cell<usize>,
}

impl DataFolder {
    /// Opens a data folder that is there already, whoever answers in it.
    ///
    /// # Errors
    /// As [`DataFolder::open`], and if there is no plan's record.
    pub fn reopen(folder: &Path, study: &Study, stimuli_hash: Sha256) -> Result<Self> {
        let file = folder.join("plan.json");
        let bytes = std::fs::read(&file).map_err(|error| match error.kind() {
            ErrorKind::NotFound => Error::Input(format!("{}: no data of a study are here", folder.display())),
            _ => Error::io("read", &file)(error),
        })?;
        let key: PlanKey = serde_json::from_slice(&bytes).map_err(|error| {
            let (file, line, column) = (file.display(), error.line(), error.column());
            Error::Input(format!("{file}:{line}:{column}: not a plan's record: {error}"))
        })?;
        let kind = if key.simulated { Kind::Simulated { times: key.times } } else { Kind::Real };
        Self::open(folder, study, stimuli_hash, kind)
    }

    /// Opens the data folder of a study; the first time, writes the plan's record there.
    ///
    /// # Errors
    /// If it belongs to another plan, other pictures or another kind of participants, or cannot be written.
    pub fn open(folder: &Path, study: &Study, stimuli_hash: Sha256, kind: Kind) -> Result<Self> {
        let file = folder.join("plan.json");
        for part in [folder.to_owned(), folder.join("slots"), folder.join("sessions")] {
            std::fs::create_dir_all(&part).map_err(Error::io("make the folder", &part))?;
        }
        let found = match std::fs::read(&file) {
            Ok(bytes) => Some(bytes),
            Err(error) if error.kind() == ErrorKind::NotFound => None,
            Err(error) => return Err(Error::io("read", &file)(error)),
        };
        let Some(bytes) = found else {
            let plan = Plan::draw(study, kind.times());
            let record = record(study, &plan, stimuli_hash, kind)?;
            return match write_new(&file, &record) {
                // Another machine was faster: what it wrote must fit as well.
                Err(Error::Io { source, .. }) if source.kind() == ErrorKind::AlreadyExists => {
                    Self::open(folder, study, stimuli_hash, kind)
                }
                Err(error) => Err(error),
                Ok(()) => Ok(Self::new(folder, kind, plan, stimuli_hash)),
            };
        };
        let key: PlanKey = serde_json::from_slice(&bytes).map_err(|error| {
            let (file, line, column) = (file.display(), error.line(), error.column());
            Error::Input(format!(
                "{file}:{line}:{column}: not a plan's record: {error}; use another folder with --data"
            ))
        })?;
        let file = file.display();
        let differs = |what: &str| Err(Error::Input(format!("{file}: {what}; use another folder with --data")));
        match (key.simulated, kind) {
            (true, Kind::Real) => {
                return differs("this folder holds simulated sessions, and these are never mixed with real ones");
            }
            (false, Kind::Simulated { .. }) => {
                return differs("this folder holds real sessions, and these are never mixed with simulated ones");
            }
            _ => {}
        }
        let plan = Plan::draw(study, key.times);
        if plan.hash() != key.plan_hash {
            return differs("the study file has been changed since this plan was drawn");
        }
        if stimuli_hash != key.stimuli_hash {
            return differs("the pictures are others than when this plan was drawn");
        }
        Ok(Self::new(folder, kind, plan, stimuli_hash))
    }

    fn new(folder: &Path, kind: Kind, plan: Plan, stimuli_hash: Sha256) -> Self {
        Self { folder: folder.to_owned(), kind, plan_hash: plan.hash(), plan, stimuli_hash, first_free: Cell::new(0) }
    }

    /// The plan.
    #[must_use]
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// The folder itself.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.folder
    }

    /// Whether programs answer here.
    #[must_use]
    pub fn is_simulated(&self) -> bool {
        self.kind.is_simulated()
    }

    /// The folder of a participant's session.
    #[must_use]
    pub fn session_folder(&self, participant: &str) -> PathBuf {
        self.folder.join("sessions").join(participant)
    }

    /// Writes, syncs and removes a file of `ROOM` bytes, so that a full disk or a folder that cannot be written is known
    /// before a participant sits down.
    ///
    /// # Errors
    /// If that cannot be done.
    pub fn check_room(&self) -> Result<()> {
        let path = self.folder.join(format!(".room-{}-{}", std::process::id(), Utc::now().micros()));
        let written = write_and_sync(&path, &vec![b' '; ROOM]);
        let removed = std::fs::remove_file(&path);
        written.and(removed).map_err(|source| {
            let kib = ROOM / 1024;
            let folder = self.folder.display();
            Error::Machine(format!("{folder}: {kib} KiB for a session's data cannot be written there: {source}"))
        })
    }

    /// How long a line takes to be on this folder's disk: the median and the longest of 40, milliseconds.
    ///
    /// # Errors
    /// If nothing can be written there.
    pub fn time_disk_ms(&self) -> Result<[f64; 2]> {
        let path = self.folder.join(format!(".speed-{}-{}", std::process::id(), Utc::now().micros()));
        let mut file = AppendFile::create(&path)?;
        let mut took_ms = Vec::new();
        let line = [b'x'; 400];
        for _ in 0..40 {
            let clock = Clock::new(1.0);
            file.append(&line)?;
            took_ms.push(clock.now_s() * 1e3);
        }
        std::fs::remove_file(&path).map_err(Error::io("remove", &path))?;
        took_ms.sort_by(f64::total_cmp);
        Ok([took_ms[20], took_ms[39]])
    }

    /// Takes a code for a participant and the next free slot for it.
    ///
    /// # Errors
    /// If the code is no code or taken, if every slot is taken, or if the folder cannot be written.
    pub fn enrol(&self, participant: &str) -> Result<Claimed> {
        check_code(participant)?;
        let folder = self.session_folder(participant);
        std::fs::create_dir(&folder).map_err(|error| match error.kind() {
            ErrorKind::AlreadyExists => Error::Input(format!(
                "participant {participant} has a session in {} already; \
                 go on with it with --resume, or use another code",
                folder.display()
            )),
            _ => Error::io("make the folder", &folder)(error),
        })?;
        self.claim(participant).inspect_err(|_| {
            // Nothing was written into it; if it cannot be removed, the code stays taken, which harms nothing.
            let _still_there = std::fs::remove_dir(&folder);
        })
    }

    /// Takes the next free slot for a code that is taken already.
    ///
    /// # Errors
    /// If every slot is taken, or the folder cannot be written.
    pub(crate) fn claim(&self, participant: &str) -> Result<Claimed> {
        let claim = Claim {
            participant: participant.to_owned(),
            simulated: self.kind.is_simulated(),
            utc: Utc::now().to_string(),
        };
        let claim = to_json(&claim)?;
        let hint = self.first_free.get().min(self.plan.slots.len());
        let in_turn = self.plan.slots[hint..].iter().chain(&self.plan.slots[..hint]);
        for slot in in_turn {
            let mut generation = 1;
            while self.back_file(slot.number, generation).exists() {
                generation += 1;
            }
            let file = self.claim_file(slot.number, generation);
            if file.exists() {
                continue;
            }
            match write_new(&file, &claim) {
                Ok(()) => {
                    self.first_free.set(usize::try_from(slot.number).unwrap_or(0));
                    return Ok(Claimed { slot: slot.clone(), generation });
                }
                // Another machine was faster.
                Err(Error::Io { source, .. }) if source.kind() == ErrorKind::AlreadyExists => {}
                Err(error) => return Err(error),
            }
        }
        Err(Error::Input(format!(
            "{}: all {} slots of the plan are taken; the study is complete",
            self.folder.display(),
            self.plan.slots.len()
        )))
    }

    /// The slot that a participant holds, or held last.
    ///
    /// # Errors
    /// If the claims cannot be read.
    pub fn claimed_by(&self, participant: &str) -> Result<Option<Claimed>> {
        let mut found = None;
        for slot in &self.plan.slots {
            for generation in 1.. {
                let file = self.claim_file(slot.number, generation);
                let bytes = match std::fs::read(&file) {
                    Ok(bytes) => bytes,
                    Err(error) if error.kind() == ErrorKind::NotFound => break,
                    Err(error) => return Err(Error::io("read", &file)(error)),
                };
                let claim: Claim = serde_json::from_slice(&bytes)
                    .map_err(|error| Error::Input(format!("{}: not a slot's claim: {error}", file.display())))?;
                if claim.participant == participant {
                    found = Some(Claimed { slot: slot.clone(), generation });
                }
            }
        }
        Ok(found)
    }

    /// Whether a slot was given back and then taken by somebody else.
    #[must_use]
    pub fn is_taken_over(&self, claimed: &Claimed) -> bool {
        self.claim_file(claimed.slot.number, claimed.generation + 1).exists()
    }

    /// Gives a slot back, so that the next participant takes it. A slot that was given back stays so.
    ///
    /// # Errors
    /// If the folder cannot be written.
    pub fn give_back(&self, claimed: &Claimed, why: &str) -> Result<()> {
        let note = to_json(&serde_json::json!({ "why": why, "utc": Utc::now().to_string() }))?;
        let index = usize::try_from(claimed.slot.number.saturating_sub(1)).unwrap_or(0);
        self.first_free.set(self.first_free.get().min(index));
        match write_new(&self.back_file(claimed.slot.number, claimed.generation), &note) {
            Err(Error::Io { source, .. }) if source.kind() == ErrorKind::AlreadyExists => Ok(()),
            other => other,
        }
    }

    /// What every row of a participant's session says.
    #[must_use]
    pub fn identity(&self, study: &Study, participant: &str, claimed: &Claimed, started: Utc) -> Identity {
        let unique = format!("{} {participant} {} {}", self.plan_hash, started.micros(), claimed.generation);
        let unique = Sha256::of(unique.as_bytes()).to_string();
        Identity {
            study: study.id.clone(),
            session_id: format!("{participant}-{}", &unique[..12]),
            participant: participant.to_owned(),
            arm: claimed.slot.arm.clone(),
            simulated: self.kind.is_simulated(),
            seed: study.seed,
            plan_hash: self.plan_hash.to_string(),
            stimuli_hash: self.stimuli_hash.to_string(),
            version: VERSION.to_owned(),
            started_utc: started.to_string(),
            demo: study.demo,
        }
    }

    /// Notes that the sequence was looked at: `unblinded-<moment>.json`.
    ///
    /// # Errors
    /// If the folder cannot be written; then the sequence must not be shown.
    pub fn note_unblinding(&self) -> Result<()> {
        let now = Utc::now();
        let note = serde_json::json!({ "plan_hash": self.plan_hash, "utc": now.to_string(), "version": VERSION });
        write_new(&self.folder.join(format!("unblinded-{}.json", now.micros())), &to_json(&note)?)
    }

    fn claim_file(&self, slot: u32, generation: u32) -> PathBuf {
        self.folder.join("slots").join(format!("{slot:04}-{generation}.json"))
    }

    fn back_file(&self, slot: u32, generation: u32) -> PathBuf {
        self.folder.join("slots").join(format!("{slot:04}-{generation}.back.json"))
    }
}

/// The digest of what will be computed and who will be left out.
///
/// # Errors
/// If the study states a bound that no proportion has.
pub fn analysis_plan_hash(study: &Study) -> Result<Sha256> {
    let plan = analysis::plan::Plan::of(study)
        .ok_or_else(|| Error::Input("the equivalence bound must lie between 0 and 0.5".to_owned()))?;
    Ok(plan.hash())
}

fn record(study: &Study, plan: &Plan, stimuli_hash: Sha256, kind: Kind) -> Result<Vec<u8>> {
    to_json(&PlanRecord {
        study: study.id.clone(),
        title: study.title.clone(),
        demo: study.demo,
        simulated: kind.is_simulated(),
        seed: study.seed,
        times: kind.times(),
        study_hash: study.hash(),
        stimuli_hash,
        plan_hash: plan.hash(),
        analysis_plan_hash: analysis_plan_hash(study)?,
        consent_version: study.consent.version.clone(),
        consent_hash: study.consent.hash(),
        slots: plan.slots.len(),
        cells: plan.totals(),
        version: VERSION.to_owned(),
        created_utc: Utc::now().to_string(),
    })
}

fn write_and_sync(path: &Path, bytes: &[u8]) -> std::io::Result<()> {
    let mut file = OpenOptions::new().write(true).create_new(true).open(path)?;
    file.write_all(bytes)?;
    file.sync_all()
}

fn to_json(value: &impl Serialize) -> Result<Vec<u8>> {
    let mut bytes =
        serde_json::to_vec_pretty(value).map_err(|error| Error::Machine(format!("cannot write JSON: {error}")))?;
    bytes.push(b'\n');
    Ok(bytes)
}

#[cfg(test)]
mod tests;
