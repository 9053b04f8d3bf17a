//! Files that appear under their name only when they are complete.

use std::ffi::OsString;
use std::fs::{self, File, OpenOptions};
use std::io;
use std::path::{Path, PathBuf};

/// A file being written beside its final name. [`AtomicFile::commit`] makes it durable and renames it,
/// [`AtomicFile::commit_unsynced`] renames it alone; dropped before that, it is removed and whatever had the name before is
/// untouched.
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
        self.rename()?;
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

    /// Gives the file its name, and leaves it to the system when it goes to disk: nobody who reads the name sees half a file, but a
    /// machine that loses power within the next seconds may have neither. For files under a time limit, which a busy disk
    /// would have wait for tens of milliseconds.
    ///
    /// # Errors
    /// If it cannot be renamed; the target is then as it was.
    pub fn commit_unsynced(mut self) -> io::Result<()> {
        if exchange(&self.temporary, &self.target) {
            // What had the name before has the temporary one now.
            let _ = fs::remove_file(&self.temporary);
            self.committed = true;
            return Ok(());
        }
        self.rename()
    }

    fn rename(&mut self) -> io::Result<()> {
        fs::rename(&self.temporary, &self.target)?;
        self.committed = true;
        Ok(())
    }

    /// Writes `bytes` as the file `target` in one go.
    ///
    /// # Errors
    /// If the disk refuses; the target is then as it was.
    pub fn write_all(target: &Path, bytes: &[u8]) -> io::Result<()> {
        Self::holding(target, bytes)?.commit()
    }

    /// The same by [`AtomicFile::commit_unsynced`].
    ///
    /// # Errors
    /// If the disk refuses; the target is then as it was.
    pub fn write_all_unsynced(target: &Path, bytes: &[u8]) -> io::Result<()> {
        Self::holding(target, bytes)?.commit_unsynced()
    }

    fn holding(target: &Path, bytes: &[u8]) -> io::Result<Self> {
        let mut file = Self::create(target)?;
        io::Write::write_all(&mut file.file, bytes)?;
        Ok(file)
    }
}

/// Has two names change places, both of which must be there. To rename over a file makes ext4 write out the new one at once, which
/// is ten milliseconds for a picture; to exchange them does not.
#[cfg(target_os = "linux")]
fn exchange(one: &Path, other: &Path) -> bool {
    use rustix::fs::{CWD, RenameFlags, renameat_with};
    // A folder of that name is left alone: renaming says why.
    other.is_file() && renameat_with(CWD, one, CWD, other, RenameFlags::EXCHANGE).is_ok()
}

#[cfg(not(target_os = "linux"))]
fn exchange(_: &Path, _: &Path) -> bool {
    false
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

        let ways = [AtomicFile::write_all, AtomicFile::write_all_unsynced];
        for (write, text) in ways.into_iter().zip(["after", "later"]) {
            write(&target, text.as_bytes()).unwrap();
            assert_eq!(fs::read_to_string(&target).unwrap(), text);
            assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1, "a temporary file is left");
        }
    }

    #[test]
    fn a_missing_folder_is_an_error() {
        let folder = tempfile::tempdir().unwrap();
        assert!(AtomicFile::create(&folder.path().join("no/such/picture.exr")).is_err());
    }
}
