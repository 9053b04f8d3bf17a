//! `--withdraw`: erases what a person answered, and leaves a dated note in its place, so that counts still add up.
//!
//! The stone is on disk before anything is erased: an erasure that is cut short is finished by asking for it again. What
//! stays is the pseudonym, the slot's claim, how many rows there were and when they were erased. The slot goes back into
//! the plan. Copies elsewhere (backups, exports, reports) are not reached; the stone's date says what they may not hold.

use std::io::ErrorKind;
use std::path::PathBuf;

use crate::clock::Utc;
use crate::enrol::DataFolder;
use crate::error::{Error, Result};
use crate::log::{sync_folder_of, write_new};
use crate::participant::check_code;

/// The stone's name in the session's folder.
pub const STONE: &str = "withdrawn.json";

/// What was erased.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Withdrawn {
    /// The session's folder; only the stone is in it.
    pub folder: PathBuf,
    /// Files that were erased now.
    pub files: usize,
    /// Whether the stone had been there already.
    pub again: bool,
}

/// Erases a participant's session.
///
/// # Errors
/// If there is none, or its files cannot be erased.
pub fn withdraw(data: &DataFolder, participant: &str) -> Result<Withdrawn> {
    check_code(participant)?;
    let folder = data.session_folder(participant);
    if !folder.is_dir() {
        let data = data.path().display();
        return Err(Error::Input(format!("{data}: participant {participant} has no session here")));
    }
    let stone = folder.join(STONE);
    let log = folder.join(format!("{participant}.csv"));
    let rows = std::fs::read_to_string(&log).map_or(0, |text| text.lines().count().saturating_sub(1));
    let note = serde_json::json!({
        "participant": participant,
        "withdrawn_utc": Utc::now().to_string(),
        "lines_erased": rows,
        "simulated": data.is_simulated(),
        "version": crate::enrol::VERSION,
    });
    let again = match write_new(&stone, format!("{note:#}\n").as_bytes()) {
        Ok(()) => false,
        Err(Error::Io { source, .. }) if source.kind() == ErrorKind::AlreadyExists => true,
        Err(error) => return Err(error),
    };
    if let Some(claimed) = data.claimed_by(participant)? {
        data.give_back(&claimed, "withdrawn")?;
    }
    let mut files = 0;
    for entry in std::fs::read_dir(&folder).map_err(Error::io("read the folder", &folder))? {
        let path = entry.map_err(Error::io("read the folder", &folder))?.path();
        if path != stone {
            std::fs::remove_file(&path).map_err(Error::io("erase", &path))?;
            files += 1;
        }
    }
    sync_folder_of(&stone)?;
    Ok(Withdrawn { folder, files, again })
}
