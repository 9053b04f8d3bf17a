//! gensurf(1): a surface x(s, t), y(s, t), z(s, t), s and t from 0 to 1, cut into triangles and flat quadrangles.

use glam::DVec3;

use super::super::command::Word;
use super::super::document::Span;
use super::super::number::real;
use super::super::statement::Draft;
use super::super::xform::BadWords;
use super::Output;
use super::arguments::Arguments;
use super::curves::{Curve, Curves, MAX_SURFACES};
use super::height_data::HeightData;
use super::smooth::interpolation;

/// Two triangles whose unit normals' product falls short of 1 by no more are one flat quadrangle.
const FLAT: f64 = 1e-12;

/// Function file of the interpolated normals.
const NORMALS: &str = "surf.cal";

/// Name of the function that leaves holes where it is not above 0.
const VALID: &str = "valid";

/// A vertex, unless it falls into a hole.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Vertex {
    pub(super) valid: bool,
    pub(super) position: DVec3,
    pub(super) normal: DVec3,
}

/// One of the three coordinates.
enum Coordinate {
    Function(Curve),
    /// A column of a data file.
    Data(usize),
}

struct Surface<'a> {
    coordinates: [Coordinate; 3],
    data: Option<HeightData>,
    valid: Option<Curve>,
    curves: &'a Curves,
    smooth: bool,
    invert: bool,
    out: Output<'a>,
    made: usize,
}

/// `gensurf material name x y z m n [-e definitions] [-f file] [-s] [-i]`
pub(super) fn run(
    words: &[Word],
    span: Span,
    read: &mut dyn FnMut(&Word) -> Result<String, BadWords>,
) -> Result<Vec<Draft>, BadWords> {
    let mut arguments = Arguments::new(words);
    let modifier = arguments.word("the material")?;
    let name = arguments.word("the name")?;
    let xyz = [arguments.word("x(s,t)")?, arguments.word("y(s,t)")?, arguments.word("z(s,t)")?];
    let (m, n) = (arguments.word("the number of steps in s")?, arguments.word("the number of steps in t")?);
    let (mut curves, mut smooth, mut invert) = (Curves::new(), false, false);
    while let Some(option) = arguments.next() {
        match option.text.as_str() {
            "-s" => smooth = true,
            "-i" => invert = true,
            "-o" => return Err(BadWords::at(Some(option), "`-o`: Wavefront text is no scene text")),
            _ if curves.take_option(option, &mut arguments, read)? => {}
            _ => return Err(arguments.unknown("-e definitions, -f file, -s, -i")),
        }
    }
    let (rows, columns) = (curves.segments(m)?, curves.segments(n)?);
    if rows.saturating_mul(columns).saturating_mul(2) > MAX_SURFACES {
        return Err(BadWords::at(Some(n), format!("the surface needs more than {MAX_SURFACES} triangles")));
    }
    // A z that names a file is data; if x and y name the same, so are they.
    let triplets = xyz[0].text == xyz[2].text && xyz[1].text == xyz[2].text;
    let data = match read(xyz[2]) {
        Ok(text) => Some(data(&text, xyz[2], rows, columns, if triplets { 3 } else { 1 })?),
        Err(_) => None,
    };
    let mut coordinates = Vec::with_capacity(3);
    for (axis, word) in xyz.into_iter().enumerate() {
        coordinates.push(match (&data, triplets, axis) {
            (Some(_), true, _) => Coordinate::Data(axis),
            (Some(_), false, 2) => Coordinate::Data(0),
            _ => Coordinate::Function(curves.function(word, &["s", "t"])?),
        });
    }
    let Ok(coordinates) = coordinates.try_into() else { return Err(BadWords::at(None, "wants x, y and z")) };
    let valid = curves.optional(VALID, xyz[0])?;
    let out = Output::new(&modifier.text, &name.text, span);
    let surface = Surface { coordinates, data, valid, curves: &curves, smooth, invert, out, made: 0 };
    surface.run(rows, columns)
}

fn data(text: &str, word: &Word, rows: usize, columns: usize, width: usize) -> Result<HeightData, BadWords> {
    let mut values = Vec::new();
    for (line, words) in text.lines().enumerate() {
        for found in words.split_ascii_whitespace() {
            let value = real(found).map_err(|_| {
                BadWords::at(Some(word), format!("{}:{}: `{found}` is not a number", word.text, line + 1))
            })?;
            values.push(value);
        }
    }
    HeightData::new(values, rows, columns, width).map_err(|message| BadWords::at(Some(word), message))
}

impl Surface<'_> {
    fn run(mut self, rows: usize, columns: usize) -> Result<Vec<Draft>, BadWords> {
        let mut evaluator = self.curves.evaluator();
        let mut row = |surface: &Self, index: i64| -> Result<Vec<Vertex>, BadWords> {
            // Normals need a vertex more on every side.
            let outside = index < 0 || index > rows as i64;
            if outside && !surface.smooth {
                return Ok(Vec::new());
            }
            let (first, last) = if surface.smooth { (-1, columns as i64 + 1) } else { (0, columns as i64) };
            let s = index as f64 / rows as f64;
            (first..=last).map(|column| surface.vertex(&mut evaluator, s, column as f64 / columns as f64)).collect()
        };
        let mut three = [row(&self, -1)?, row(&self, 0)?, row(&self, 1)?];
        let mut behind = self.with_normals(&three);
        for index in 0..rows {
            three.rotate_left(1);
            three[2] = row(&self, index as i64 + 2)?;
            let here = self.with_normals(&three);
            for column in 0..columns {
                let [a, b, c, d] = [here[column], here[column + 1], behind[column], behind[column + 1]];
                // Diagonals alternate, but for squares of which one corner falls into a hole.
                let other = if !(c.valid && b.valid) {
                    true
                } else if !(a.valid && d.valid) {
                    false
                } else {
                    column % 2 == 1
                };
                if other { self.square([c, a, d, b]) } else { self.square([a, b, c, d]) }
            }
            behind = here;
        }
        self.out.finish()
    }

    fn vertex(&self, evaluator: &mut crate::cal::Evaluator<'_>, s: f64, t: f64) -> Result<Vertex, BadWords> {
        if let Some(valid) = &self.valid
            && valid.at(evaluator, &[s, t])? <= 0.0
        {
            return Ok(Vertex::default());
        }
        let mut position = [0.0; 3];
        for (value, coordinate) in position.iter_mut().zip(&self.coordinates) {
            *value = match (coordinate, &self.data) {
                (Coordinate::Function(curve), _) => curve.at(evaluator, &[s, t])?,
                (Coordinate::Data(column), Some(data)) => data.at(s, t, *column),
                (Coordinate::Data(_), None) => 0.0,
            };
        }
        Ok(Vertex { valid: true, position: DVec3::from_array(position), normal: DVec3::ZERO })
    }

    /// The middle one of three rows, without the vertices beyond its ends, with normals if they are wanted.
    fn with_normals(&self, [before, here, after]: &[Vec<Vertex>; 3]) -> Vec<Vertex> {
        if !self.smooth {
            return here.clone();
        }
        (1..here.len().saturating_sub(1))
            .map(|index| {
                let mut vertex = here[index];
                let along_s = slope(before[index], vertex, after[index]);
                let along_t = slope(here[index - 1], vertex, here[index + 1]);
                vertex.normal = match (vertex.valid, along_s, along_t) {
                    (true, Some(s), Some(t)) if self.invert => t.cross(s).normalize_or_zero(),
                    (true, Some(s), Some(t)) => s.cross(t).normalize_or_zero(),
                    _ => DVec3::ZERO,
                };
                vertex
            })
            .collect()
    }

    /// Two triangles (a, b, c) and (c, b, d), or one quadrangle.
    fn square(&mut self, [a, mut b, mut c, d]: [Vertex; 4]) {
        if self.invert {
            std::mem::swap(&mut b, &mut c);
        }
        let first = face_normal(a, b, c);
        let second = face_normal(d, c, b);
        let corners = completed([a, b, c, d]);
        match (first, second) {
            (Some(one), Some(two)) if one.dot(two) >= 1.0 - FLAT => {
                self.face(&corners, (one + two) / 2.0, &[a, b, d, c]);
            }
            _ => {
                if let Some(normal) = first {
                    self.face(&corners, normal, &[a, b, c]);
                }
                if let Some(normal) = second {
                    self.face(&corners, normal, &[c, b, d]);
                }
            }
        }
    }

    fn face(&mut self, corners: &[Vertex; 4], normal: DVec3, outline: &[Vertex]) {
        if self.smooth
            && let Some((axis, [uv, u, v, constant])) = interpolation(corners)
        {
            // The interpolated normal, less the flat one.
            let rows = [uv, u, v, constant - normal];
            let mut reals = vec![axis as f64];
            reals.extend(rows.iter().flat_map(DVec3::to_array));
            self.out.texture(["surf_dx", "surf_dy", "surf_dz", NORMALS], reals);
        } else {
            self.out.plain();
        }
        self.made += 1;
        let points: Vec<DVec3> = outline.iter().map(|vertex| vertex.position).collect();
        self.out.polygon(&self.made.to_string(), &points);
    }
}

/// A square of which one corner falls into a hole, with that corner where a parallelogram has it: the normals of the other
/// three are then interpolated linearly. (The program itself takes what its memory holds there.)
fn completed(mut corners: [Vertex; 4]) -> [Vertex; 4] {
    let missing: Vec<usize> = (0..4).filter(|&corner| !corners[corner].valid).collect();
    if let [missing] = missing[..] {
        // a and d are opposite, b and c are.
        let [one, other] = if missing == 0 || missing == 3 { [1, 2] } else { [0, 3] };
        let (one, other, across) = (corners[one], corners[other], corners[3 - missing]);
        corners[missing] = Vertex {
            valid: true,
            position: one.position + other.position - across.position,
            normal: one.normal + other.normal - across.normal,
        };
    }
    corners
}

/// The step from one neighbour to the other, past a hole from the vertex itself.
fn slope(before: Vertex, here: Vertex, after: Vertex) -> Option<DVec3> {
    match (before.valid, after.valid) {
        (true, true) => Some(after.position - before.position),
        (true, false) => Some(here.position - before.position),
        (false, true) => Some(after.position - here.position),
        (false, false) => None,
    }
}

/// Unit normal at `a` of the triangle (a, b, c); none of a degenerate one.
fn face_normal(a: Vertex, b: Vertex, c: Vertex) -> Option<DVec3> {
    if !(a.valid && b.valid && c.valid) {
        return None;
    }
    (b.position - a.position).cross(c.position - a.position).try_normalize()
}
