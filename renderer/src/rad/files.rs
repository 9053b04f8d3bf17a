//! Where files come from: the library reads no environment and asks its caller.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Files larger than this are refused: no scene text is, and a device file may never end.
const MAX_BYTES: u64 = 1 << 31;

/// A file that was found.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Found {
    /// Its name for messages; also tells whether two finds are the same file.
    pub name: String,
    /// The folder in which files that it names are looked for first.
    pub folder: String,
    /// Its content.
    pub bytes: Vec<u8>,
}

/// Finds the files that scene text names.
pub trait Files {
    /// Reads the file `name`, looked for in `folder` first (the folder of the file that names it; empty for the
    /// caller's own).
    ///
    /// # Errors
    /// Why it cannot be read, in words that can stand after the file's name.
    fn find(&self, name: &str, folder: &str) -> Result<Found, String>;
}

/// Files on disk.
#[derive(Clone, Debug, Default)]
pub struct DiskFiles {
    search: Vec<PathBuf>,
}

impl DiskFiles {
    /// Looks in the folder of the naming file first, then in these, in order; a name that starts with `/`, `./` or
    /// `../` is not searched for (as rpict(1) does with RAYPATH).
    #[must_use]
    pub fn new(search: Vec<PathBuf>) -> Self {
        Self { search }
    }
}

impl Files for DiskFiles {
    fn find(&self, name: &str, folder: &str) -> Result<Found, String> {
        let given = Path::new(name);
        let searched = !(given.is_absolute() || name.starts_with("./") || name.starts_with("../"));
        let mut places = vec![Path::new(folder).join(given)];
        if searched {
            places.extend(self.search.iter().map(|place| place.join(given)));
        }
        for place in &places {
            let Ok(meta) = std::fs::metadata(place) else { continue };
            if meta.is_dir() {
                return Err("is a folder".to_owned());
            }
            if !meta.is_file() {
                return Err("is not a regular file".to_owned());
            }
            if meta.len() > MAX_BYTES {
                return Err(format!("is larger than {MAX_BYTES} bytes"));
            }
            let bytes = std::fs::read(place).map_err(|error| format!("cannot be read: {error}"))?;
            let folder = place.parent().unwrap_or(Path::new("")).to_string_lossy().into_owned();
            return Ok(Found { name: place.to_string_lossy().into_owned(), folder, bytes });
        }
        let tried: Vec<String> = places.iter().map(|place| place.display().to_string()).collect();
        Err(format!("is not found (looked for: {})", tried.join(", ")))
    }
}

/// Files in memory, by name: for tests and for scenes that are made, not stored.
#[derive(Clone, Debug, Default)]
pub struct MemoryFiles {
    files: BTreeMap<String, Vec<u8>>,
}

impl MemoryFiles {
    /// No files.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds one; its folder is what stands before the last `/` of its name.
    #[must_use]
    pub fn with(mut self, name: impl Into<String>, bytes: impl Into<Vec<u8>>) -> Self {
        self.files.insert(name.into(), bytes.into());
        self
    }
}

impl Files for MemoryFiles {
    fn find(&self, name: &str, folder: &str) -> Result<Found, String> {
        let here = if folder.is_empty() { name.to_owned() } else { format!("{folder}/{name}") };
        let (name, bytes) = self
            .files
            .get_key_value(&here)
            .or_else(|| self.files.get_key_value(name))
            .ok_or_else(|| "is not found".to_owned())?;
        let folder = name.rsplit_once('/').map_or("", |(folder, _)| folder).to_owned();
        Ok(Found { name: name.clone(), folder, bytes: bytes.clone() })
    }
}
