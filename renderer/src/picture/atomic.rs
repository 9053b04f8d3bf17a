//! Files that appear under their name only when they are complete.

use std::ffi::OsString;
use std::fs::{self, File, OpenOptions};
use std::io;
use std::path::{Path, PathBuf};

/// A file being written beside its final name. [`AtomicFile::commit`] makes it durable and renames it; dropped before that, it is
/// removed and whatever had the name before is untouched.
#[derive(Debug)]
pub struct AtomicFile {
    target: PathBuf,
    temporary: PathBuf,
    file: File,
    committed: bool,
}

impl AtomicFile {
    /// Starts a file that will be called `target`.
    ///
    /// # Errors
    /// If the folder is missing or cannot be written to.
    pub fn create(target: &Path) -> io::Result<Self> {
        let temporary = Self::temporary(target);
        let file = OpenOptions::new().read(true).write(true).create(true).truncate(true).open(&temporary)?;
        Ok(Self { target: target.to_owned(), temporary, file, committed: false })
    }

    /// The name under which this process writes `target` until it is complete: in the same folder, so that the rename cannot cross
    /// file systems. A program that is interrupted may remove it.
    #[must_use]
    pub fn temporary(target: &Path) -> PathBuf {
        let mut name = OsString::from(".");
        name.push(target.file_name().unwrap_or_default());
        name.push(format!(".{}.part", std::process::id()));
        target.with_file_name(name)
    }

    /// A handle to write through.
    ///
    /// # Errors
    /// If the system has no handle left.
    pub fn handle(&self) -> io::Result<File> {
        self.file.try_clone()
    }

    /// Puts everything on disk and gives the file its name.
    ///
    /// # Errors
    /// If the disk refuses; the target is then as it was.
    pub fn commit(mut self) -> io::Result<()> {
        self.file.sync_all()?;
        fs::rename(&self.temporary, &self.target)?;
        self.committed = true;
        let folder = match self.target.parent() {
            Some(folder) if !folder.as_os_str().is_empty() => folder,
            _ => Path::new("."),
        };
        // The rename itself is durable once the folder is; a file system that cannot sync a folder has done what it can.
        if let Ok(folder) = File::open(folder) {
            let _ = folder.sync_all();
        }
        Ok(())
    }

    /// Writes `bytes` as the file `target` in one go.
    ///
    /// # Errors
    /// If the disk refuses; the target is then as it was.
    pub fn write_all(target: &Path, bytes: &[u8]) -> io::Result<()> {
        let mut file = Self::create(target)?;
        io::Write::write_all(&mut file.file, bytes)?;
        file.commit()
    }
}

impl Drop for AtomicFile {
    fn drop(&mut self) {
        if !self.committed {
            // Nothing can be done about a failure here, and the target is untouched either way.
            let _ = fs::remove_file(&self.temporary);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write;

    #[test]
    fn a_file_appears_whole_or_not_at_all() {
        let folder = tempfile::tempdir().unwrap();
        let target = folder.path().join("picture.exr");
        fs::write(&target, "before").unwrap();

        let unfinished = AtomicFile::create(&target).unwrap();
        unfinished.handle().unwrap().write_all(b"half").unwrap();
        drop(unfinished);
        assert_eq!(fs::read_to_string(&target).unwrap(), "before");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1, "a temporary file is left");

        AtomicFile::write_all(&target, b"after").unwrap();
        assert_eq!(fs::read_to_string(&target).unwrap(), "after");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1, "a temporary file is left");
    }

    #[test]
    fn a_missing_folder_is_an_error() {
        let folder = tempfile::tempdir().unwrap();
        assert!(AtomicFile::create(&folder.path().join("no/such/picture.exr")).is_err());
    }
}
