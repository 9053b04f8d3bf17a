//! genbox(1): a box from the origin to (x, y, z), with sharp, bevelled or rounded edges.
//!
//! A corner is three bits, one an axis: set where the coordinate is at its far end. A vertex is a corner and three bits
//! more: set on the axes along which the vertex is moved inwards by the bevel or radius.

use glam::DVec3;

use super::super::command::Word;
use super::super::document::Span;
use super::super::statement::Draft;
use super::super::xform::BadWords;
use super::Output;
use super::arguments::Arguments;
use super::smooth::over_triangle;

/// Rounding by more segments would make millions of triangles a corner.
const MAX_SEGMENTS: usize = 1024;

/// Segments for a rounded box that is turned inside out, unless told.
const INVERTED_SEGMENTS: usize = 32;

/// How edges and corners are finished.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Edges {
    Sharp,
    Bevelled,
    /// By cylinders and spheres.
    Round,
    /// By this many flat segments a quarter turn, a power of two.
    Segmented(usize),
}

struct Cuboid<'a> {
    size: DVec3,
    /// How far bevel or rounding reach inwards.
    inset: f64,
    invert: bool,
    /// Whether the normals of flat segments are those of the rounding that they stand for.
    smooth: bool,
    out: Output<'a>,
}

/// Function file of the interpolated normals.
const NORMALS: &str = "tmesh.cal";

/// `genbox material name xsize ysize zsize [-i] [-b bevel | -r radius [-n segments] [-s]]`
pub(super) fn run(words: &[Word], span: Span) -> Result<Vec<Draft>, BadWords> {
    let mut arguments = Arguments::new(words);
    let modifier = arguments.word("the material")?;
    let name = arguments.word("the name")?;
    let size = DVec3::new(
        arguments.positive("the x size")?,
        arguments.positive("the y size")?,
        arguments.positive("the z size")?,
    );
    let out = Output::new(&modifier.text, &name.text, span);
    let mut cuboid = Cuboid { size, inset: 0.0, invert: false, smooth: false, out };
    let (mut round, mut segments) = (false, 1);
    while let Some(option) = arguments.next() {
        match option.text.as_str() {
            "-i" => cuboid.invert = true,
            "-b" => cuboid.inset = arguments.positive("the bevel")?,
            "-r" => {
                cuboid.inset = arguments.positive("the radius")?;
                round = true;
            }
            "-n" => segments = arguments.count("the number of segments", 1, MAX_SEGMENTS)?,
            "-s" => cuboid.smooth = true,
            "-o" => return Err(BadWords::at(Some(option), "`-o`: Wavefront text is no scene text")),
            _ => return Err(arguments.unknown("-i, -b bevel, -r radius, -n segments, -s")),
        }
    }
    if cuboid.invert && segments == 1 {
        segments = INVERTED_SEGMENTS;
    }
    let edges = match (cuboid.inset > 0.0, round) {
        (false, _) => Edges::Sharp,
        (true, false) => Edges::Bevelled,
        (true, true) if segments <= 2 => Edges::Round,
        (true, true) => Edges::Segmented(segments.next_power_of_two()),
    };
    cuboid.faces(edges);
    for axis in 0..3 {
        for sides in 0..4 {
            cuboid.edge(axis, sides & 1, sides >> 1, edges);
        }
    }
    for corner in 0..8 {
        cuboid.corner(corner, edges);
    }
    cuboid.out.finish()
}

/// The letters that name vertices.
fn letter(corner: usize, inset: usize) -> char {
    const LETTERS: &[u8; 64] = b"0123456789._ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz";
    char::from(LETTERS[(inset * 8 + corner) % 64])
}

/// Outward at a corner: -1 or 1 on each axis.
fn outward(corner: usize) -> DVec3 {
    DVec3::from_array([0, 1, 2].map(|axis| if corner >> axis & 1 == 1 { 1.0 } else { -1.0 }))
}

impl Cuboid<'_> {
    fn vertex(&self, corner: usize, inset: usize) -> DVec3 {
        DVec3::from_array([0, 1, 2].map(|axis| {
            let in_by = if inset >> axis & 1 == 1 { self.inset } else { 0.0 };
            if corner >> axis & 1 == 1 { self.size[axis] - in_by } else { in_by }
        }))
    }

    /// A polygon that faces outwards if its vertices run counter-clockwise (or clockwise, if `clockwise`).
    fn polygon(&mut self, suffix: &str, mut vertices: Vec<DVec3>, clockwise: bool) {
        if clockwise != self.invert {
            vertices.reverse();
        }
        self.out.polygon(suffix, &vertices);
    }

    /// A triangle of a rounding about `centre`.
    fn rounded(&mut self, suffix: &str, directions: [DVec3; 3], centres: [DVec3; 3], clockwise: bool) {
        let points: [DVec3; 3] = std::array::from_fn(|corner| centres[corner] + self.inset * directions[corner]);
        let normals = if self.invert { directions.map(|direction| -direction) } else { directions };
        match over_triangle(points, normals).filter(|_| self.smooth) {
            Some((axis, rows)) => {
                let mut reals = vec![axis as f64];
                reals.extend(rows.iter().flat_map(DVec3::to_array));
                self.out.texture(["dx", "dy", "dz", NORMALS], reals);
            }
            None => self.out.plain(),
        }
        self.polygon(suffix, points.to_vec(), clockwise);
    }

    fn flat(&mut self, vertices: &[(usize, usize)], clockwise: bool) {
        let suffix: String = vertices.iter().map(|&(corner, inset)| letter(corner, inset)).collect();
        let points = vertices.iter().map(|&(corner, inset)| self.vertex(corner, inset)).collect();
        self.polygon(&suffix, points, clockwise);
    }

    /// The six sides: what is left of them between the edges.
    fn faces(&mut self, edges: Edges) {
        for axis in 0..3 {
            let (u, v) = (1 << ((axis + 1) % 3), 1 << ((axis + 2) % 3));
            let inset = if edges == Edges::Sharp { 0 } else { u | v };
            for side in 0..2 {
                let base = side << axis;
                // Counter-clockwise as seen from the far end of the axis.
                let corners = [base, base | u, base | u | v, base | v];
                self.flat(&corners.map(|corner| (corner, inset)), side == 0);
            }
        }
    }

    /// The edge along an axis where the two axes after it have these ends.
    fn edge(&mut self, axis: usize, first: usize, second: usize, edges: Edges) {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        let (near, all) = (first << u | second << v, 7);
        let far = near | 1 << axis;
        // From the face of u to the face of v, then along the axis: outwards where both ends are alike.
        let clockwise = first != second;
        match edges {
            Edges::Sharp => {}
            Edges::Bevelled => {
                let (on_u, on_v) = (all ^ 1 << u, all ^ 1 << v);
                self.flat(&[(near, on_u), (near, on_v), (far, on_v), (far, on_u)], clockwise);
            }
            Edges::Round => {
                let suffix: String = [letter(near, all), letter(far, all)].into_iter().collect();
                let (from, to) = (self.vertex(near, all), self.vertex(far, all));
                self.out.cylinder(&suffix, from, to, self.inset);
            }
            Edges::Segmented(segments) => {
                let (from, to) = (self.vertex(near, all), self.vertex(far, all));
                let out = outward(near);
                let direction = |step: usize| {
                    let (sin, cos) = quarter(step, segments);
                    let mut direction = DVec3::ZERO;
                    direction[u] = cos * out[u];
                    direction[v] = sin * out[v];
                    direction
                };
                for step in 0..segments {
                    let (here, there) = (direction(step), direction(step + 1));
                    let suffix = format!("e{}{}.{step}", letter(near, all), letter(far, all));
                    if self.smooth {
                        self.rounded(&format!("{suffix}a"), [here, there, there], [from, from, to], clockwise);
                        self.rounded(&format!("{suffix}b"), [there, here, here], [to, to, from], clockwise);
                    } else {
                        let corners = [(from, here), (from, there), (to, there), (to, here)];
                        let points = corners.map(|(centre, direction)| centre + self.inset * direction).to_vec();
                        self.polygon(&suffix, points, clockwise);
                    }
                }
            }
        }
    }

    fn corner(&mut self, corner: usize, edges: Edges) {
        let (all, out) = (7, outward(corner));
        // Three faces in the order of the axes run counter-clockwise about the far corner; every flip reverses that.
        let clockwise = out.element_product() < 0.0;
        match edges {
            Edges::Sharp => {}
            Edges::Bevelled => self.flat(&[0, 1, 2].map(|axis| (corner, all ^ 1 << axis)), clockwise),
            Edges::Round => {
                let centre = self.vertex(corner, all);
                self.out.sphere(&letter(corner, all).to_string(), centre, self.inset);
            }
            Edges::Segmented(segments) => {
                let centre = self.vertex(corner, all);
                let mut triangles = vec![[DVec3::X * out.x, DVec3::Y * out.y, DVec3::Z * out.z]];
                for _ in 0..segments.trailing_zeros() {
                    triangles = triangles.into_iter().flat_map(quartered).collect();
                }
                for (index, triangle) in triangles.into_iter().enumerate() {
                    let suffix = format!("c{}.{index}", letter(corner, all));
                    self.rounded(&suffix, triangle, [centre; 3], clockwise);
                }
            }
        }
    }
}

/// Sine and cosine of a part of a quarter turn; exact at its ends.
fn quarter(step: usize, steps: usize) -> (f64, f64) {
    match step {
        0 => (0.0, 1.0),
        _ if step == steps => (1.0, 0.0),
        _ => (std::f64::consts::FRAC_PI_2 * step as f64 / steps as f64).sin_cos(),
    }
}

/// A triangle on the unit sphere, cut at the middles of its sides.
fn quartered([a, b, c]: [DVec3; 3]) -> [[DVec3; 3]; 4] {
    let (ab, bc, ca) = ((a + b).normalize(), (b + c).normalize(), (c + a).normalize());
    [[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]
}

#[cfg(test)]
mod tests {
    use super::super::super::{Kind, MemoryFiles, Options, Source, read};
    use super::*;

    #[test]
    fn smoothed_roundings_have_the_normals_of_cylinders_and_spheres() {
        for (options, sign) in [("", 1.0), ("-i", -1.0)] {
            let text = format!("void plastic m 0 0 5 1 1 1 0 0\n!genbox m b 1 2 3 -r .25 -n 4 -s {options}\n");
            let document = read(&[Source::new("t", text)], &MemoryFiles::new(), &Options::default()).unwrap();
            let mut smoothed = 0;
            for polygon in document.primitives.iter().filter(|primitive| primitive.kind == Kind::Polygon) {
                let texture = &document.primitives[polygon.modifier.unwrap()];
                if texture.kind != Kind::Texfunc {
                    assert_eq!(polygon.reals.len(), 12);
                    continue;
                }
                let points: Vec<DVec3> = polygon.reals.as_chunks::<3>().0.iter().map(|&p| DVec3::from(p)).collect();
                let axis = texture.reals[0] as usize;
                let facing = (points[1] - points[0]).cross(points[2] - points[0]).normalize();
                for point in points {
                    let place = DVec3::new(point[(axis + 1) % 3], point[(axis + 2) % 3], 1.0);
                    let found =
                        DVec3::from_array([1, 4, 7].map(|at| DVec3::from_slice(&texture.reals[at..]).dot(place)));
                    let core = point.clamp(DVec3::splat(0.25), DVec3::new(1.0, 2.0, 3.0) - 0.25);
                    let wanted = sign * (point - core) / 0.25;
                    assert!((found - wanted).length() < 1e-12, "{found} is not {wanted} at {point}");
                    assert!(found.dot(facing) > 0.8);
                }
                smoothed += 1;
            }
            // Twelve edges of four squares, eight corners of sixteen triangles.
            assert_eq!(smoothed, 12 * 4 * 2 + 8 * 16);
        }
    }
}
