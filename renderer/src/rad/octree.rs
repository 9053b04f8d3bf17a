//! Octrees that oconv(1) has made: frozen ones hold their scene, others the names of its files. The tree itself is of no
//! use here.

use super::binary::Bytes;
use super::document::Document;
use super::files::Files;
use super::options::Options;
use super::{Source, read};
use crate::diagnostic::{Error, Problems};

/// First value of the file, less the bytes of an object number.
const MAGIC: i64 = 283;

/// Reads the scene of an octree file.
///
/// # Errors
/// A file that is no octree or is damaged; for one that is not frozen, what [`read`] finds wrong with its scene files.
pub fn read_octree(source: &Source, files: &dyn Files, options: &Options<'_>) -> Result<Document, Vec<Error>> {
    let texts = match contents(source).map_err(|error| vec![error])? {
        Contents::Frozen(document) => return Ok(document),
        Contents::Named(names) => names,
    };
    let (mut sources, mut problems) = (Vec::new(), Problems::default());
    for name in texts {
        if name.starts_with('!') {
            sources.push(Source { folder: source.folder.clone(), ..Source::new(&source.name, name) });
            continue;
        }
        match files.find(&name, &source.folder) {
            Ok(found) => sources.push(Source { folder: source.folder.clone(), ..Source::from(found) }),
            Err(why) => {
                let message = format!("the octree is not frozen (oconv -f), and its scene file `{name}` {why}");
                problems.add(Error::of_file(&source.name, message));
            }
        }
    }
    if problems.is_empty() { read(&sources, files, options) } else { Err(problems.into_errors()) }
}

enum Contents {
    Frozen(Document),
    Named(Vec<String>),
}

fn contents(source: &Source) -> Result<Contents, Error> {
    let mut bytes = Bytes::after_header(source, "Radiance_octree")?;
    let size = bytes.integer(2)? - MAGIC;
    let Some(size) = usize::try_from(size).ok().filter(|size| (1..=8).contains(size)) else {
        return Err(bytes.wrong("this is an octree of an unknown version"));
    };
    for _ in 0..4 {
        bytes.written_real()?;
    }
    let mut names = Vec::new();
    loop {
        let name = bytes.string()?;
        if name.is_empty() {
            break;
        }
        names.push(name);
    }
    if !names.is_empty() {
        return Ok(Contents::Named(names));
    }
    bytes.integer(size)?;
    bytes.skip_tree(size)?;
    Ok(Contents::Frozen(bytes.scene(size)?.into_document(source)))
}
