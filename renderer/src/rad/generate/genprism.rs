//! genprism(1): a polygon in the plane z = 0, extruded, with sharp or rounded edges.

use glam::{DVec2, DVec3};

use super::super::command::Word;
use super::super::document::Span;
use super::super::number::real;
use super::super::statement::Draft;
use super::super::xform::BadWords;
use super::Output;
use super::arguments::Arguments;

/// Lengths and sines below this are none (the program's own bound).
const TINY: f64 = 1e-6;

struct Prism<'a> {
    vertices: Vec<DVec2>,
    /// The extrusion.
    length: DVec3,
    /// Rounding of the edges; 0 is sharp.
    radius: f64,
    out: Output<'a>,
}

/// `genprism material name { file | N x1 y1 .. xN yN } [-l x y z] [-r radius] [-c] [-e]`
pub(super) fn run(
    words: &[Word],
    span: Span,
    read: &mut dyn FnMut(&Word) -> Result<String, BadWords>,
) -> Result<Vec<Draft>, BadWords> {
    let mut arguments = Arguments::new(words);
    let modifier = arguments.word("the material")?;
    let name = arguments.word("the name")?;
    let vertices = vertices(&mut arguments, read)?;
    let out = Output::new(&modifier.text, &name.text, span);
    let mut prism = Prism { vertices, length: DVec3::Z, radius: 0.0, out };
    let (mut closed, mut ends, mut rounding) = (true, true, None);
    while let Some(option) = arguments.next() {
        match option.text.as_str() {
            "-l" => {
                prism.length = DVec3::new(
                    arguments.real("x of the extrusion")?,
                    arguments.real("y of the extrusion")?,
                    arguments.real("z of the extrusion")?,
                );
                if prism.length.z.abs() <= TINY {
                    return Err(BadWords::at(arguments.last(), "the extrusion must leave the plane z = 0"));
                }
            }
            "-r" => {
                prism.radius = arguments.real("the radius")?;
                rounding = arguments.last();
            }
            "-e" => ends = !ends,
            "-c" => closed = !closed,
            _ => return Err(arguments.unknown("-l x y z, -r radius, -c, -e")),
        }
    }
    if prism.radius > TINY {
        if prism.radius > prism.length.z.abs() {
            return Err(BadWords::at(rounding, "the radius is larger than the height"));
        }
        let rounded = prism.rounded().map_err(|message| BadWords::at(None, message))?;
        if ends {
            prism.rounded_ends(&rounded);
        }
        prism.rounded_sides(&rounded, closed);
    } else {
        if ends {
            prism.ends();
        }
        prism.sides(closed);
    }
    prism.out.finish()
}

fn vertices(
    arguments: &mut Arguments<'_>,
    read: &mut dyn FnMut(&Word) -> Result<String, BadWords>,
) -> Result<Vec<DVec2>, BadWords> {
    let first = arguments.word("the number of vertices, or a file with them")?;
    let mut vertices = Vec::new();
    if first.text == "-" {
        return Err(BadWords::at(Some(first), "vertices from a pipe are not supported: name their file"));
    }
    if first.text.starts_with(|letter: char| letter.is_ascii_digit()) {
        let count = first.text.parse().ok().filter(|&count: &usize| count <= arguments.left() / 2);
        let Some(count) = count else {
            let message = format!("`{}` vertices need two numbers each", first.text);
            return Err(BadWords::at(Some(first), message));
        };
        for index in 1..=count {
            let x = arguments.real(&format!("x of vertex {index}"))?;
            let y = arguments.real(&format!("y of vertex {index}"))?;
            vertices.push(DVec2::new(x, y));
        }
    } else {
        let text = read(first)?;
        let mut numbers = Vec::new();
        for (line, words) in text.lines().enumerate() {
            for word in words.split_ascii_whitespace() {
                let number = real(word).map_err(|_| {
                    let message = format!("{}:{}: `{word}` is not a number", first.text, line + 1);
                    BadWords::at(Some(first), message)
                })?;
                numbers.push(number);
            }
        }
        let (pairs, odd) = numbers.as_chunks::<2>();
        if !odd.is_empty() {
            return Err(BadWords::at(Some(first), format!("the last vertex of `{}` lacks its y", first.text)));
        }
        vertices.extend(pairs.iter().map(|&pair| DVec2::from_array(pair)));
    }
    if vertices.len() < 3 {
        return Err(BadWords::at(Some(first), format!("a prism needs at least 3 vertices, found {}", vertices.len())));
    }
    Ok(vertices)
}

/// What rounding needs of each vertex.
struct Rounded {
    /// Along the side that ends here, backwards; unit.
    back: Vec<DVec2>,
    /// How far the rounding of this corner reaches along its sides, in radii; negative where the outline turns inwards.
    trim: Vec<f64>,
    /// The outline, one radius inside.
    inner: Vec<DVec2>,
    /// The radius with the sign of the extrusion: it points inwards for either.
    radius: f64,
}

impl Prism<'_> {
    fn ends(&mut self) {
        let bottom: Vec<DVec3> = self.vertices.iter().map(|vertex| vertex.extend(0.0)).collect();
        let top: Vec<DVec3> = bottom.iter().rev().map(|vertex| vertex + self.length).collect();
        self.out.polygon("b", &bottom);
        self.out.polygon("t", &top);
    }

    /// Vertex pairs of the sides with the first one's number from 1.
    fn pairs(&self, closed: bool) -> impl Iterator<Item = (usize, usize)> + use<> {
        let count = self.vertices.len();
        (0..count).map(move |from| (from, (from + 1) % count)).take(if closed { count } else { count - 1 })
    }

    fn sides(&mut self, closed: bool) {
        for (from, to) in self.pairs(closed) {
            let (a, b) = (self.vertices[from].extend(0.0), self.vertices[to].extend(0.0));
            self.out.polygon(&(from + 1).to_string(), &[a, a + self.length, b + self.length, b]);
        }
    }

    fn rounded(&self) -> Result<Rounded, &'static str> {
        let count = self.vertices.len();
        let before = |index: usize| (index + count - 1) % count;
        let mut back = Vec::with_capacity(count);
        for index in 0..count {
            let side = self.vertices[before(index)] - self.vertices[index];
            if side.length() <= TINY {
                return Err("two neighbouring vertices are the same: the edge cannot be rounded");
            }
            back.push(side.normalize());
        }
        let radius = self.radius.copysign(self.length.z);
        let mut trim = Vec::with_capacity(count);
        for (index, &here) in back.iter().enumerate() {
            let next = back[(index + 1) % count];
            let cos = here.dot(next);
            if 1.0 + cos <= TINY {
                return Err("two neighbouring sides lie on each other: the edge cannot be rounded");
            }
            // Tangent of half the angle by which the outline turns here.
            let half = ((1.0 - cos).max(0.0) / (1.0 + cos)).sqrt();
            trim.push(if next.perp_dot(here) < 0.0 { -half } else { half });
        }
        let inner = (0..count)
            .map(|index| self.vertices[index] + radius * (trim[index] * back[index] + back[index].perp()))
            .collect();
        Ok(Rounded { back, trim, inner, radius })
    }

    /// Whether a corner is rounded: it is not where the outline turns inwards.
    fn bulges(&self, rounded: &Rounded, index: usize) -> f64 {
        rounded.trim[index] * rounded.radius.signum()
    }

    fn rounded_ends(&mut self, rounded: &Rounded) {
        let count = self.vertices.len();
        let lift = DVec3::Z * rounded.radius;
        let bottom: Vec<DVec3> = rounded.inner.iter().map(|vertex| vertex.extend(0.0)).collect();
        let top: Vec<DVec3> = bottom.iter().map(|vertex| vertex + self.length).collect();
        self.out.polygon("b", &bottom);
        self.out.polygon("t", &top.iter().rev().copied().collect::<Vec<_>>());
        for (end, vertices, lift) in [("b", bottom, lift), ("t", top, -lift)] {
            for index in 0..count {
                let (from, to) = (vertices[(index + count - 1) % count] + lift, vertices[index] + lift);
                if self.bulges(rounded, index) > 0.0 {
                    self.out.sphere(&format!("{end}c{}", index + 1), to, self.radius);
                }
                self.out.cylinder(&format!("{end}e{}", index + 1), from, to, self.radius);
            }
        }
    }

    fn rounded_sides(&mut self, rounded: &Rounded, closed: bool) {
        let (length, radius) = (self.length, rounded.radius);
        for (from, to) in self.pairs(closed) {
            let back = rounded.back[to];
            // The side's plane is tangent to the edges' cylinders: it leans if the extrusion does.
            let lean = radius.signum() * back.perp_dot(length.truncate()) / length.length();
            let tangent = if lean.abs() > TINY {
                let short = 1.0 - (1.0 - lean * lean).max(0.0).sqrt();
                (short * back.perp()).extend(lean)
            } else {
                DVec3::ZERO
            };
            let along = back.extend(0.0);
            let start = self.vertices[from].extend(0.0) + radius * (tangent - rounded.trim[from] * along);
            let end = self.vertices[to].extend(0.0) + radius * (tangent + rounded.trim[to] * along);
            let up = DVec3::Z * radius;
            let suffix = (from + 1).to_string();
            self.out.polygon(&suffix, &[start + up, start + length - up, end + length - up, end + up]);
            if self.bulges(rounded, to) >= 0.0 {
                let foot = rounded.inner[to].extend(0.0) + up;
                self.out.cylinder(&format!("e{suffix}"), foot, foot + length - 2.0 * up, self.radius);
            }
        }
    }
}
