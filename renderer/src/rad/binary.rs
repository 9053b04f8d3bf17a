//! The portable binary numbers and strings of Radiance's compiled files, and the scenes in them.
//!
//! Integers are big-endian two's complement of a given number of bytes; a real is a 4-byte mantissa m and a 1-byte exponent
//! e that stand for (m + 1/2) / (2^31 - 1) * 2^e (towards 0 for negative m), or for exactly 0 if m is 0; strings end in a
//! zero byte.

use super::arguments::check_counts;
use super::document::{Document, Names, Primitive, SourceFile, Span};
use super::kind::Kind;
use super::{Source, decode};
use crate::diagnostic::Error;

/// Walks over a compiled file.
pub(super) struct Bytes<'a> {
    name: &'a str,
    bytes: &'a [u8],
    at: usize,
}

impl<'a> Bytes<'a> {
    /// Skips a file's header, which ends at the first empty line and must name `format`.
    pub(super) fn after_header(source: &'a Source, format: &str) -> Result<Self, Error> {
        let mut bytes = Self { name: &source.name, bytes: &source.bytes, at: 0 };
        let wanted = format!("FORMAT={format}");
        let mut found = false;
        loop {
            let rest = &bytes.bytes[bytes.at..];
            let Some(length) = rest.iter().position(|&byte| byte == b'\n') else {
                return Err(bytes.wrong(&format!("this is no {format} file: its header does not end")));
            };
            bytes.at += length + 1;
            match &rest[..length] {
                [] => break,
                line => found |= line.trim_ascii_end() == wanted.as_bytes(),
            }
        }
        if found {
            Ok(bytes)
        } else {
            Err(bytes.wrong(&format!("this is no {format} file: its header does not say so")))
        }
    }

    pub(super) fn wrong(&self, message: &str) -> Error {
        Error::of_file(self.name, format!("{message} (at byte {})", self.at))
    }

    /// How many bytes are left: no count in a file can be larger.
    pub(super) fn left(&self) -> usize {
        self.bytes.len() - self.at
    }

    pub(super) fn take(&mut self, count: usize) -> Result<&'a [u8], Error> {
        match self.bytes[self.at..].get(..count) {
            Some(taken) => {
                self.at += count;
                Ok(taken)
            }
            None => Err(self.wrong("the file ends too early")),
        }
    }

    /// A signed integer of 1 to 8 bytes.
    pub(super) fn integer(&mut self, size: usize) -> Result<i64, Error> {
        let taken = self.take(size)?;
        let start = if taken.first().is_some_and(|&byte| byte >= 0x80) { -1 } else { 0 };
        Ok(taken.iter().fold(start, |value, &byte| value << 8 | i64::from(byte)))
    }

    pub(super) fn unsigned(&mut self) -> Result<u32, Error> {
        Ok(self.take(4)?.iter().fold(0, |value, &byte| value << 8 | u32::from(byte)))
    }

    /// A count of things that each take at least `size` bytes.
    pub(super) fn count(&mut self, integer: usize, size: usize, most: usize, what: &str) -> Result<usize, Error> {
        let count = self.integer(integer)?;
        let fits =
            usize::try_from(count).ok().filter(|&count| count <= most && count.saturating_mul(size) <= self.left());
        fits.ok_or_else(|| self.wrong(&format!("the file cannot hold {count} {what}")))
    }

    pub(super) fn real(&mut self) -> Result<f64, Error> {
        let mantissa = self.integer(4)?;
        let exponent = self.integer(1)?;
        if mantissa == 0 {
            return Ok(0.0);
        }
        let half = if mantissa < 0 { -0.5 } else { 0.5 };
        Ok((mantissa as f64 + half) / f64::from(i32::MAX) * f64::powi(2.0, exponent as i32))
    }

    pub(super) fn string(&mut self) -> Result<String, Error> {
        let rest = &self.bytes[self.at..];
        let Some(length) = rest.iter().position(|&byte| byte == 0) else {
            return Err(self.wrong("a string does not end"));
        };
        self.at += length + 1;
        Ok(decode(&rest[..length]))
    }

    /// A number that is written as text.
    pub(super) fn written_real(&mut self) -> Result<f64, Error> {
        let text = self.string()?;
        super::number::real(text.trim()).map_err(|_| self.wrong(&format!("`{text}` is not a number")))
    }

    /// Steps over a tree of nodes: 0 is empty, 1 a set of numbers of `size` bytes, 2 eight nodes.
    pub(super) fn skip_tree(&mut self, size: usize) -> Result<(), Error> {
        let mut pending = 1_u64;
        while pending > 0 {
            match self.integer(1)? {
                0 => pending -= 1,
                1 => {
                    let count = self.count(size, size, usize::MAX, "objects in a set")?;
                    self.take(count * size)?;
                    pending -= 1;
                }
                2 => pending += 7,
                _ => return Err(self.wrong("the tree is damaged")),
            }
        }
        Ok(())
    }

    /// Reads the scene in the file: a list of type names, then primitives that name their modifiers by number.
    pub(super) fn scene(&mut self, size: usize) -> Result<BinaryScene, Error> {
        let mut kinds = Vec::new();
        loop {
            let keyword = self.string()?;
            if keyword.is_empty() {
                break;
            }
            kinds.push(keyword);
        }
        let mut scene = BinaryScene { primitives: Vec::new(), objects: Vec::new(), names: Names::default() };
        loop {
            let kind = self.integer(1)?;
            if kind == -1 {
                return Ok(scene);
            }
            let Some(keyword) = usize::try_from(kind).ok().and_then(|kind| kinds.get(kind)) else {
                return Err(self.wrong("a primitive has a type that the file does not list"));
            };
            self.object(size, keyword, &mut scene)?;
        }
    }

    fn object(&mut self, size: usize, keyword: &str, scene: &mut BinaryScene) -> Result<(), Error> {
        let modifier = match self.integer(size)? {
            -1 => None,
            object => match usize::try_from(object).ok().and_then(|object| scene.objects.get(object)) {
                Some(&object) => object,
                None => return Err(self.wrong("a primitive's modifier is not defined before it")),
            },
        };
        let name = self.string()?;
        let count = self.count(2, 1, usize::MAX, "string arguments")?;
        let strings = (0..count).map(|_| self.string()).collect::<Result<Vec<_>, _>>()?;
        let count = self.count(2, 5, usize::MAX, "real arguments")?;
        let reals = (0..count).map(|_| self.real()).collect::<Result<Vec<_>, _>>()?;
        let index = scene.primitives.len();
        if keyword == "alias" {
            // Without a string the modifier is what the alias stands for.
            let target = match strings.first() {
                None => {
                    scene.objects.push(modifier);
                    if let Some(target) = modifier {
                        scene.names.define(&name, index, target);
                    }
                    return Ok(());
                }
                Some(target) => scene.names.meaning(target, index),
            };
            let Some(target) = target else {
                return Err(self.wrong(&format!("the alias `{name}` stands for nothing that is defined before it")));
            };
            let copy = Primitive { modifier, name: name.clone(), ..scene.primitives[target].clone() };
            scene.primitives.push(copy);
        } else {
            let Some(kind) = Kind::from_keyword(keyword) else {
                return Err(self.wrong(&format!("unknown primitive type `{keyword}`")));
            };
            if let Some(message) = check_counts(kind, strings.len(), reals.len()) {
                return Err(self.wrong(&format!("`{name}`: {message}")));
            }
            let span = Span { source: 0, start: 0, end: 0 };
            scene.primitives.push(Primitive {
                modifier,
                kind,
                name: name.clone(),
                strings,
                reals,
                span,
                as_written: false,
            });
        }
        if scene.primitives[index].kind.is_modifier() {
            scene.names.define(&name, index + 1, index);
        }
        scene.objects.push(Some(index));
        Ok(())
    }
}

/// A scene out of a compiled file.
pub(super) struct BinaryScene {
    pub(super) primitives: Vec<Primitive>,
    /// By the file's numbers: the primitive; nothing for an alias of `void`.
    pub(super) objects: Vec<Option<usize>>,
    pub(super) names: Names,
}

impl BinaryScene {
    pub(super) fn into_document(self, source: &Source) -> Document {
        let file = SourceFile { name: source.name.clone(), text: String::new(), read_by: None };
        let mut document = Document::new(vec![file], self.primitives, self.names);
        document.folders.push(source.folder.clone());
        document
    }
}
