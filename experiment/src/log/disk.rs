//! Files that are created once, appended to, and on disk when a call returns.

use std::fs::{File, OpenOptions};
use std::io::{ErrorKind, Read, Write};
use std::path::{Path, PathBuf};

use crate::clock::Utc;
use crate::error::{Error, Result};

/// A file that only grows, line by line.
#[derive(Debug)]
pub struct AppendFile {
    file: File,
    path: PathBuf,
    /// Bytes of whole lines that are on disk.
    whole: u64,
}

impl AppendFile {
    /// Creates a file that must not be there yet, and makes its name durable.
    ///
    /// # Errors
    /// If it is there, or cannot be made.
    pub fn create(path: &Path) -> Result<Self> {
        let file = OpenOptions::new().append(true).create_new(true).open(path).map_err(Error::io("create", path))?;
        sync_folder_of(path)?;
        Ok(Self { file, path: path.to_owned(), whole: 0 })
    }

    /// Opens a file whose writer may have died within a line. Half a line at its end is put aside into a file of its own.
    ///
    /// # Errors
    /// If it cannot be opened, read or cut.
    pub fn recover(path: &Path, now: Utc) -> Result<(Self, Option<PathBuf>)> {
        let mut options = OpenOptions::new();
        let mut file = options.read(true).append(true).open(path).map_err(Error::io("open", path))?;
        let mut bytes = Vec::new();
        file.read_to_end(&mut bytes).map_err(Error::io("read", path))?;
        let end = bytes.iter().rposition(|&byte| byte == b'\n').map_or(0, |newline| newline + 1);
        let mut recovered = Self { file, path: path.to_owned(), whole: end as u64 };
        if end == bytes.len() {
            return Ok((recovered, None));
        }
        let mut name = path.file_name().unwrap_or_default().to_owned();
        name.push(format!(".torn-{}", now.micros()));
        let aside = path.with_file_name(name);
        write_new(&aside, &bytes[end..])?;
        recovered.take_back()?;
        Ok((recovered, Some(aside)))
    }

    /// Appends a line in one write, and returns when it is on disk.
    ///
    /// # Errors
    /// If it could not be written whole; then nothing of it is left.
    pub fn append(&mut self, line: &[u8]) -> Result<()> {
        let written = self.file.write_all(line).and_then(|()| self.file.flush()).and_then(|()| self.file.sync_data());
        match written {
            Ok(()) => {
                self.whole += line.len() as u64;
                Ok(())
            }
            Err(source) => {
                // The first error is what the reader needs; a second one while tidying up adds nothing to it.
                let _untidy = self.take_back();
                Err(Error::Io { action: "write", path: self.path.clone(), source })
            }
        }
    }

    fn take_back(&mut self) -> Result<()> {
        self.file.set_len(self.whole).and_then(|()| self.file.sync_data()).map_err(Error::io("cut", &self.path))
    }
}

/// Writes a whole new file so that it is never seen in part: beside it first, then linked to its name, which fails if the
/// name is taken. Returns when file and name are on disk.
///
/// # Errors
/// If the name is taken ([`ErrorKind::AlreadyExists`]), or it cannot be written.
pub fn write_new(path: &Path, bytes: &[u8]) -> Result<()> {
    let (file, beside) = create_beside(path).map_err(Error::io("create", path))?;
    let linked = write_and_link(file, &beside, path, bytes);
    let removed = std::fs::remove_file(&beside);
    match linked {
        Err(error) if matches!(error.kind(), ErrorKind::Unsupported | ErrorKind::PermissionDenied) => {
            // A file system without links: create it under its name. A crash may then leave it short.
            let mut file =
                OpenOptions::new().write(true).create_new(true).open(path).map_err(Error::io("create", path))?;
            file.write_all(bytes).and_then(|()| file.sync_all()).map_err(Error::io("write", path))?;
        }
        other => other.and(removed).map_err(Error::io("create", path))?,
    }
    sync_folder_of(path)
}

/// A new file beside `path` that nobody else has: threads, and machines that share the folder, may ask in the same microsecond,
/// and who takes another's would remove it under their hands.
fn create_beside(path: &Path) -> std::io::Result<(File, PathBuf)> {
    for n in 0_u32.. {
        let mut name = path.file_name().unwrap_or_default().to_owned();
        name.push(format!(".part-{}-{}-{n}", std::process::id(), Utc::now().micros()));
        let beside = path.with_file_name(name);
        match OpenOptions::new().write(true).create_new(true).open(&beside) {
            Err(error) if error.kind() == ErrorKind::AlreadyExists => {}
            created => return created.map(|file| (file, beside)),
        }
    }
    Err(ErrorKind::AlreadyExists.into())
}

fn write_and_link(mut file: File, beside: &Path, path: &Path, bytes: &[u8]) -> std::io::Result<()> {
    file.write_all(bytes)?;
    file.sync_all()?;
    std::fs::hard_link(beside, path)
}

/// Makes the names in a file's folder durable. Only Unix lets a folder be synced; elsewhere the file's own sync must do.
pub(crate) fn sync_folder_of(path: &Path) -> Result<()> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    if cfg!(unix) {
        File::open(folder).and_then(|folder| folder.sync_all()).map_err(Error::io("sync", folder))?;
    }
    Ok(())
}
