//! The files that primitives name: function files, data, pictures, fonts, texts. Each is read once.

use std::collections::HashMap;
use std::path::Path;
use std::sync::Arc;

use crate::cal::shipped;
use crate::pattern::{Font, Table};
use crate::picture;
use crate::rad::{Files, Found};

/// Finds and keeps files.
pub(super) struct Shelf<'a> {
    files: &'a dyn Files,
    tables: HashMap<String, Arc<Table>>,
    pictures: HashMap<String, Arc<Table>>,
    fonts: HashMap<String, Arc<Font>>,
}

impl<'a> Shelf<'a> {
    pub(super) fn new(files: &'a dyn Files) -> Self {
        Self { files, tables: HashMap::new(), pictures: HashMap::new(), fonts: HashMap::new() }
    }

    /// Bytes of what is kept.
    pub(super) fn bytes(&self) -> usize {
        let tables = self.tables.values().chain(self.pictures.values()).map(|table| table.bytes());
        tables.chain(self.fonts.values().map(|font| font.bytes())).sum()
    }

    /// What finds them.
    pub(super) fn files(&self) -> &'a dyn Files {
        self.files
    }

    /// A file looked for in `folders`.
    pub(super) fn find(&self, name: &str, folders: &[String]) -> Result<Found, String> {
        let mut why = "is not found".to_owned();
        for folder in folders.iter().map(String::as_str).chain(folders.is_empty().then_some("")) {
            match self.files.find(name, folder) {
                Ok(found) => return Ok(found),
                Err(reason) => why = reason,
            }
        }
        Err(why)
    }

    fn text(&self, name: &str, folders: &[String]) -> Result<String, String> {
        Ok(String::from_utf8_lossy(&self.find(name, folders)?.bytes).into_owned())
    }

    /// A function file; one of the standard library is at hand if the scene's folders have none.
    pub(super) fn functions(&self, name: &str, folders: &[String]) -> Result<String, String> {
        match self.text(name, folders) {
            Ok(text) => Ok(text),
            Err(why) => {
                let base = Path::new(name).file_name().and_then(|name| name.to_str()).unwrap_or(name);
                shipped(base).map(str::to_owned).ok_or(why)
            }
        }
    }

    pub(super) fn table(&mut self, name: &str, folders: &[String]) -> Result<Arc<Table>, String> {
        if let Some(table) = self.tables.get(name) {
            return Ok(Arc::clone(table));
        }
        let table = Arc::new(Table::read(&self.text(name, folders)?)?);
        self.tables.insert(name.to_owned(), Arc::clone(&table));
        Ok(table)
    }

    /// A picture as its pixels are stored: patterns do not undo its exposure. `.pic` and `.hdr` are the same format, and
    /// one stands for the other.
    pub(super) fn picture(&mut self, name: &str, folders: &[String]) -> Result<Arc<Table>, String> {
        if let Some(table) = self.pictures.get(name) {
            return Ok(Arc::clone(table));
        }
        let found = self.find(name, folders).or_else(|why| {
            let other = if let Some(stem) = name.strip_suffix(".pic") {
                format!("{stem}.hdr")
            } else if let Some(stem) = name.strip_suffix(".hdr") {
                format!("{stem}.pic")
            } else {
                return Err(why);
            };
            self.find(&other, folders).map_err(|_| why)
        })?;
        // Pictures from before the format had a first line.
        let old = !(found.bytes.starts_with(b"#?") || found.bytes.starts_with(b"\x89PNG"));
        let bytes = if old { [b"#?RADIANCE\n".as_slice(), &found.bytes].concat() } else { found.bytes };
        let read = picture::read_bytes(&bytes).map_err(|kind| kind.to_string())?;
        let exposed = exposure(&bytes);
        let pixels: Vec<[f32; 3]> = read
            .beauty
            .values()
            .iter()
            .map(|pixel| [0, 1, 2].map(|channel| pixel[channel] * exposed[channel]))
            .collect();
        let table = Table::of_picture(read.beauty.width(), &pixels).ok_or_else(|| "has no pixels".to_owned())?;
        let table = Arc::new(table);
        self.pictures.insert(name.to_owned(), Arc::clone(&table));
        Ok(table)
    }

    pub(super) fn font(&mut self, name: &str, folders: &[String]) -> Result<Arc<Font>, String> {
        if let Some(font) = self.fonts.get(name) {
            return Ok(Arc::clone(font));
        }
        let font = Arc::new(Font::read(&self.text(name, folders)?)?);
        self.fonts.insert(name.to_owned(), Arc::clone(&font));
        Ok(font)
    }

    /// The lines of a text file. One that is not UTF-8 is Latin-1.
    pub(super) fn lines(&self, name: &str, folders: &[String]) -> Result<Vec<String>, String> {
        let bytes = self.find(name, folders)?.bytes;
        let text = match String::from_utf8(bytes) {
            Ok(text) => text,
            Err(error) => error.into_bytes().into_iter().map(char::from).collect(),
        };
        Ok(text.lines().map(str::to_owned).collect())
    }
}

/// By what a picture's pixels exceed radiance, per channel: its header's exposures and colour corrections.
fn exposure(bytes: &[u8]) -> [f32; 3] {
    let mut exposure = [1.0_f32; 3];
    for line in bytes.split(|&byte| byte == b'\n').take_while(|line| !line.is_empty()) {
        let line = String::from_utf8_lossy(line);
        if let Some(value) = line.strip_prefix("EXPOSURE=").and_then(|value| value.trim().parse::<f32>().ok()) {
            exposure.iter_mut().for_each(|channel| *channel *= value);
        } else if let Some(values) = line.strip_prefix("COLORCORR=") {
            for (channel, value) in exposure.iter_mut().zip(values.split_whitespace()) {
                *channel *= value.parse::<f32>().unwrap_or(1.0);
            }
        }
    }
    exposure
}
