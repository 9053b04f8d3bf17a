//! Wavefront `.obj` files: the statements that obj2mesh(1) reads, `v`, `vt`, `vn`, `f` and `usemtl`. All others are passed over.

use std::collections::HashMap;

use super::Source;
use super::mesh::MeshVertex;
use super::number::{integer, real};
use crate::diagnostic::Error;

/// Vertices of all faces together, at most.
const MOST_CORNERS: usize = 100_000_000;

/// A face of an object.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ObjFace {
    /// Indices of its vertices, at least 3, counter-clockwise as seen from its front.
    pub vertices: Vec<u32>,
    /// Its material, an index into [`Obj::materials`].
    pub material: Option<usize>,
}

/// A Wavefront object.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Obj {
    /// The vertices.
    pub vertices: Vec<MeshVertex>,
    /// The faces.
    pub faces: Vec<ObjFace>,
    /// The names of their materials.
    pub materials: Vec<String>,
}

/// Reads a Wavefront object.
///
/// # Errors
/// The first statement that is wrong.
pub fn read_obj(source: &Source) -> Result<Obj, Error> {
    let text = super::decode(&source.bytes);
    let mut reader = Reader { file: &source.name, text: &text, ..Reader::default() };
    let mut at = 0;
    let mut words: Vec<(usize, &str)> = Vec::new();
    for line in text.split_inclusive('\n') {
        let start = at;
        at += line.len();
        let line = line.trim_end();
        // A backslash at a line's end goes on with the next line.
        let (line, goes_on) = line.strip_suffix('\\').map_or((line, false), |line| (line, true));
        let offset = |word: &str| start + (word.as_ptr() as usize - line.as_ptr() as usize);
        words.extend(line.split_whitespace().map(|word| (offset(word), word)));
        if !goes_on {
            reader.statement(&words)?;
            words.clear();
        }
    }
    reader.statement(&words)?;
    Ok(reader.obj)
}

#[derive(Default)]
struct Reader<'a> {
    file: &'a str,
    text: &'a str,
    obj: Obj,
    points: Vec<[f64; 3]>,
    textures: Vec<[f64; 2]>,
    normals: Vec<[f64; 3]>,
    /// The vertices that have been made, by the numbers of their point, texture and normal.
    made: HashMap<[usize; 3], u32>,
    corners: usize,
    material: Option<usize>,
}

/// Stands for a texture or normal that a vertex does not have.
const NONE: usize = usize::MAX;

impl Reader<'_> {
    fn wrong(&self, (at, word): (usize, &str), message: impl Into<String>) -> Error {
        Error::in_text(self.file, self.text, at, at + word.len(), message)
    }

    fn statement(&mut self, words: &[(usize, &str)]) -> Result<(), Error> {
        let Some(&first) = words.first() else { return Ok(()) };
        match first.1 {
            "v" => {
                let point = self.numbers(words, "x y z of a vertex")?;
                self.points.push(point);
            }
            "vt" => {
                let texture = self.numbers(words, "u v of a vertex")?;
                self.textures.push(texture);
            }
            "vn" => {
                let [x, y, z] = self.numbers(words, "x y z of a normal")?;
                let length = x.hypot(y).hypot(z);
                if !(length > 0.0 && length.is_finite()) {
                    return Err(self.wrong(first, "this normal has no direction"));
                }
                self.normals.push([x / length, y / length, z / length]);
            }
            "f" => self.face(words)?,
            "usemtl" => {
                self.material = words.get(1).map(|&(_, name)| {
                    let known = self.obj.materials.iter().position(|known| known == name);
                    known.unwrap_or_else(|| {
                        self.obj.materials.push(name.to_owned());
                        self.obj.materials.len() - 1
                    })
                });
            }
            _ => {}
        }
        Ok(())
    }

    fn numbers<const N: usize>(&self, words: &[(usize, &str)], what: &str) -> Result<[f64; N], Error> {
        let mut numbers = [0.0; N];
        for (index, number) in numbers.iter_mut().enumerate() {
            let Some(&word) = words.get(1 + index) else {
                return Err(self.wrong(words[0], format!("expected {what}, found {} numbers", words.len() - 1)));
            };
            *number =
                real(word.1).map_err(|_| self.wrong(word, format!("`{}` is no number: expected {what}", word.1)))?;
        }
        Ok(numbers)
    }

    fn face(&mut self, words: &[(usize, &str)]) -> Result<(), Error> {
        if words.len() < 4 {
            return Err(
                self.wrong(words[0], format!("a face has at least 3 vertices, this one has {}", words.len() - 1))
            );
        }
        self.corners += words.len() - 1;
        if self.corners > MOST_CORNERS {
            return Err(self.wrong(words[0], format!("the faces have more than {MOST_CORNERS} vertices")));
        }
        let vertices = words[1..].iter().map(|&word| self.vertex(word)).collect::<Result<Vec<u32>, Error>>()?;
        self.obj.faces.push(ObjFace { vertices, material: self.material });
        Ok(())
    }

    /// `point`, `point/texture`, `point//normal` or `point/texture/normal`, each counted from 1, or from the last one
    /// backwards if negative.
    fn vertex(&mut self, word: (usize, &str)) -> Result<u32, Error> {
        let mut parts = word.1.split('/');
        let mut next = |count: usize| match parts.next() {
            None | Some("") => Some(NONE),
            Some(part) => match integer(part) {
                Ok(n) if n > 0 => usize::try_from(n - 1).ok().filter(|&n| n < count),
                Ok(n) if n < 0 => usize::try_from(n.unsigned_abs()).ok().and_then(|n| count.checked_sub(n)),
                _ => None,
            },
        };
        let counts = [self.points.len(), self.textures.len(), self.normals.len()];
        let place = counts.map(&mut next);
        let [Some(point), Some(texture), Some(normal)] = place else {
            return Err(self.missing(word));
        };
        let Some(&position) = self.points.get(point) else { return Err(self.missing(word)) };
        let key = [point, texture, normal];
        if let Some(&made) = self.made.get(&key) {
            return Ok(made);
        }
        let (normal, uv) = (self.normals.get(normal).copied(), self.textures.get(texture).copied());
        let made = self.obj.vertices.len() as u32;
        self.obj.vertices.push(MeshVertex { position, normal, uv });
        self.made.insert(key, made);
        Ok(made)
    }

    fn missing(&self, word: (usize, &str)) -> Error {
        let message = format!("`{}` names no vertex, texture or normal above: expected numbers such as 3/1/2", word.1);
        self.wrong(word, message)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Obj, Error> {
        read_obj(&Source::new("a.obj", text))
    }

    #[test]
    fn vertices_are_shared_and_counted_from_either_end() {
        let text = "# a square\nmtllib x.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0 \\\n\nv 0 1 0\nvt .5 .25\nvn 0 0 2\n\
            usemtl red\nf 1/1/1 2//1 3\nf -4/1/1 -2 -1\nusemtl\nf 1 2 3 4\n";
        let obj = read(text).unwrap();
        assert_eq!(obj.materials, ["red"]);
        let faces: Vec<_> = obj.faces.iter().map(|face| (face.vertices.as_slice(), face.material)).collect();
        assert_eq!(faces, [(&[0, 1, 2][..], Some(0)), (&[0, 2, 3], Some(0)), (&[4, 5, 2, 3], None)]);
        let first = MeshVertex { position: [0.0; 3], normal: Some([0.0, 0.0, 1.0]), uv: Some([0.5, 0.25]) };
        assert_eq!(obj.vertices[0], first);
        assert_eq!(obj.vertices[1].uv, None);
        assert_eq!(obj.vertices.len(), 6);
    }

    #[test]
    fn mistakes_are_placed() {
        let place = |text: &str| {
            let error = read(text).unwrap_err();
            (error.line, error.column)
        };
        assert_eq!(place("v 0 0 0\nv 1 nan 0\n"), (2, 5));
        assert_eq!(place("v 0 0\n"), (1, 1));
        assert_eq!(place("v 0 0 0\nf 1 1\n"), (2, 1));
        assert_eq!(place("v 0 0 0\nf 1 1 2\n"), (2, 7));
        assert_eq!(place("v 0 0 0\nf 1 1 0\n"), (2, 7));
        assert_eq!(place("v 0 0 0\nf 1 1/1 1\n"), (2, 5));
        assert_eq!(place("v 0 0 0\nf 1 1 99999999999999999999\n"), (2, 7));
        assert_eq!(place("vn 0 0 0\n"), (1, 1));
        assert!(read("").unwrap().faces.is_empty());
    }
}
