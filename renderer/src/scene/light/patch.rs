//! Uniform points of flat shapes.

use glam::{DVec2, DVec3};

use crate::geometry::shape::{Polygon, Ring, Triangle};
use crate::math::{Frame, warp};

/// A flat piece of surface from which points are drawn.
#[derive(Clone, Debug)]
pub(super) enum Patch {
    /// A corner and two edges.
    Parallelogram([DVec3; 3]),
    /// Triangles that do not overlap, each with the share of the area that it and those before it cover.
    Triangles(Vec<([DVec3; 3], f64)>),
    /// A polygon that falls into no triangles (it crosses itself, or has very many corners): a rectangle around it, of which points outside the
    /// polygon are dark.
    Boxed { corner: DVec3, edges: [DVec3; 2], outline: Vec<DVec2> },
    /// An annulus between squared radii.
    Ring { centre: DVec3, frame: Frame, squared_radii: [f64; 2] },
}

impl Patch {
    pub(super) fn of_triangle(triangle: &Triangle) -> Self {
        Self::Triangles(vec![(triangle.corners(), 1.0)])
    }

    pub(super) fn of_ring(ring: &Ring) -> Self {
        let frame = Frame::around(ring.normal());
        Self::Ring { centre: ring.centre(), frame, squared_radii: ring.radii().map(|radius| radius * radius) }
    }

    pub(super) fn of_polygon(polygon: &Polygon) -> Self {
        let vertices = polygon.vertices();
        if let &[a, b, c, d] = vertices {
            let size = (c - a).abs().max((d - b).abs()).max_element();
            if (a + (c - b) - d).abs().max_element() <= 1e-9 * size {
                return Self::Parallelogram([a, b - a, d - a]);
            }
        }
        // In the polygon's plane, from its mean, so that far coordinates keep their digits.
        let frame = Frame::around(polygon.normal());
        let outline: Vec<DVec2> =
            vertices.iter().map(|&vertex| frame.to_local(vertex - polygon.point()).truncate()).collect();
        let area = 0.5 * doubled_area(&outline);
        let corners = |ears: Vec<[usize; 3]>| ears.into_iter().map(|ear| ear.map(|index| vertices[index]));
        let triangles: Option<Vec<([DVec3; 3], f64)>> = clip_ears(&outline).and_then(|ears| {
            let mut sum = 0.0;
            let mut triangles: Vec<([DVec3; 3], f64)> = corners(ears)
                .map(|triangle| {
                    sum += 0.5 * (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]).dot(polygon.normal());
                    (triangle, sum)
                })
                .collect();
            for (_, covered) in &mut triangles {
                *covered /= sum;
            }
            ((sum - area).abs() <= 1e-9 * area).then_some(triangles)
        });
        triangles.map_or_else(|| Self::boxed(polygon, &frame, outline), Self::Triangles)
    }

    fn boxed(polygon: &Polygon, frame: &Frame, outline: Vec<DVec2>) -> Self {
        let low = outline.iter().copied().fold(DVec2::INFINITY, DVec2::min);
        let high = outline.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max);
        let corner = polygon.point() + frame.u * low.x + frame.v * low.y;
        let edges = [frame.u * (high.x - low.x), frame.v * (high.y - low.y)];
        let outline = outline.into_iter().map(|vertex| vertex - low).collect();
        Self::Boxed { corner, edges, outline }
    }

    /// The area over which points are spread.
    pub(super) fn area(&self) -> f64 {
        match self {
            Self::Parallelogram([_, u, v]) => u.cross(*v).length(),
            Self::Triangles(triangles) => {
                triangles.iter().map(|([a, b, c], _)| 0.5 * (*b - *a).cross(*c - *a).length()).sum()
            }
            Self::Boxed { edges: [u, v], .. } => u.length() * v.length(),
            Self::Ring { squared_radii: [inner, outer], .. } => std::f64::consts::PI * (outer - inner),
        }
    }

    /// Its middle: the centre of its area (of a boxed outline, of the box).
    pub(super) fn middle(&self) -> DVec3 {
        match self {
            Self::Parallelogram([corner, along, up]) => *corner + (*along + *up) * 0.5,
            Self::Triangles(triangles) => {
                let mut before = 0.0;
                let weighted = triangles.iter().map(|&([a, b, c], covered)| {
                    let share = covered - std::mem::replace(&mut before, covered);
                    (a + b + c) * (share / 3.0)
                });
                weighted.sum()
            }
            Self::Boxed { corner, edges: [along, up], .. } => *corner + (*along + *up) * 0.5,
            Self::Ring { centre, .. } => *centre,
        }
    }

    /// A point, uniform over [`Self::area`]; `None` where the shape is not.
    pub(super) fn point(&self, u: [f64; 2]) -> Option<DVec3> {
        match self {
            Self::Parallelogram([corner, along, up]) => Some(*corner + *along * u[0] + *up * u[1]),
            Self::Triangles(triangles) => {
                let index = triangles.partition_point(|&(_, covered)| covered <= u[0]).min(triangles.len() - 1);
                let before = if index == 0 { 0.0 } else { triangles[index - 1].1 };
                let ([a, b, c], covered) = triangles[index];
                // What is left of the number after choosing the triangle is uniform again.
                let rest = ((u[0] - before) / (covered - before)).clamp(0.0, 1.0);
                let [towards_b, towards_c] = warp::triangle([rest, u[1]]);
                Some(a + (b - a) * towards_b + (c - a) * towards_c)
            }
            Self::Boxed { corner, edges, outline } => {
                let at = DVec2::new(u[0] * edges[0].length(), u[1] * edges[1].length());
                is_inside(outline, at).then(|| *corner + edges[0] * u[0] + edges[1] * u[1])
            }
            Self::Ring { centre, frame, squared_radii: [inner, outer] } => {
                let across = if *inner == 0.0 {
                    warp::disc(u) * outer.sqrt()
                } else {
                    let (sin, cos) = (std::f64::consts::TAU * u[1]).sin_cos();
                    DVec2::new(cos, sin) * (inner + (outer - inner) * u[0]).sqrt()
                };
                Some(*centre + frame.u * across.x + frame.v * across.y)
            }
        }
    }
}

fn cross(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    (b - a).perp_dot(c - a)
}

fn doubled_area(outline: &[DVec2]) -> f64 {
    let first = outline[0];
    outline.windows(2).map(|edge| cross(first, edge[0], edge[1])).sum()
}

/// Even-odd rule.
fn is_inside(outline: &[DVec2], at: DVec2) -> bool {
    let mut inside = false;
    let mut from = outline[outline.len() - 1];
    for &to in outline {
        if (from.y > at.y) != (to.y > at.y) {
            let (low, high) = if from.y < to.y { (from, to) } else { (to, from) };
            inside ^= cross(at, low, high) > 0.0;
        }
        from = to;
    }
    inside
}

/// Corners up to which an outline is cut into triangles: the time grows with their cube at worst.
const MOST_CORNERS: usize = 1000;

/// Triangles of a counter-clockwise outline that may be concave and have holes by seams: cuts off one corner after the other
/// that holds no other vertex (Meisters, "Polygons Have Ears", 1975). `None` if no corner is left to cut: the outline crosses itself; or if
/// there are more than [`MOST_CORNERS`].
pub(in crate::scene) fn clip_ears(outline: &[DVec2]) -> Option<Vec<[usize; 3]>> {
    if outline.len() > MOST_CORNERS {
        return None;
    }
    let mut left: Vec<usize> = (0..outline.len()).collect();
    let mut ears = Vec::with_capacity(outline.len().saturating_sub(2));
    while left.len() > 2 {
        let count = left.len();
        let corner = |at: usize| [left[(at + count - 1) % count], left[at], left[(at + 1) % count]];
        // Flat corners first: they cover nothing, and a seam leaves them behind.
        let flat = (0..count).find(|&at| {
            let [a, b, c] = corner(at).map(|index| outline[index]);
            cross(a, b, c) == 0.0 && (count == 3 || b == a || b == c || (a - b).dot(c - b) < 0.0 || a == c)
        });
        if let Some(at) = flat {
            left.remove(at);
            continue;
        }
        let ear = (0..count).find(|&at| {
            let [a, b, c] = corner(at).map(|index| outline[index]);
            cross(a, b, c) > 0.0
                && left.iter().all(|&other| {
                    let p = outline[other];
                    p == a
                        || p == b
                        || p == c
                        || !(cross(a, b, p) >= 0.0 && cross(b, c, p) >= 0.0 && cross(c, a, p) >= 0.0)
                })
        })?;
        ears.push(corner(ear));
        left.remove(ear);
    }
    Some(ears)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn outline(corners: &[[f64; 2]]) -> Vec<DVec2> {
        corners.iter().copied().map(DVec2::from).collect()
    }

    fn clipped_area(outline: &[DVec2]) -> f64 {
        let ears = clip_ears(outline).expect("a simple outline has ears");
        ears.iter().map(|ear| 0.5 * cross(outline[ear[0]], outline[ear[1]], outline[ear[2]])).sum()
    }

    #[test]
    fn concave_and_holed_outlines_fall_into_triangles_of_their_area() {
        let ell = outline(&[[0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]]);
        assert_eq!(clipped_area(&ell), 4.0);
        // A square of side 4 with a square hole of side 2, joined by a seam.
        let holed = outline(&[
            [0.0, 0.0],
            [4.0, 0.0],
            [4.0, 4.0],
            [0.0, 4.0],
            [0.0, 0.0],
            [1.0, 1.0],
            [1.0, 3.0],
            [3.0, 3.0],
            [3.0, 1.0],
            [1.0, 1.0],
        ]);
        assert_eq!(clipped_area(&holed), 12.0);
        let star: Vec<DVec2> = (0..10)
            .map(|i| {
                let radius = if i % 2 == 0 { 2.0 } else { 0.5 };
                DVec2::from_angle(std::f64::consts::TAU * f64::from(i) / 10.0) * radius
            })
            .collect();
        assert!((clipped_area(&star) - 0.5 * doubled_area(&star)).abs() < 1e-12);
        let with_flat_corners = outline(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [2.0, 2.0], [1.0, 2.0], [0.0, 2.0]]);
        assert_eq!(clipped_area(&with_flat_corners), 4.0);
    }

    #[test]
    fn a_bow_tie_is_boxed() {
        let bow = [[0.0, 0.0], [3.0, 3.0], [3.0, 0.0], [0.0, 1.0]];
        let polygon = Polygon::new(bow.iter().map(|&[x, y]| DVec3::new(x, y, 1.0)).collect());
        // Its lobes turn in opposite ways; what is left of the signed area makes the normal.
        let polygon = polygon.expect("its signed area is not zero");
        let patch = Patch::of_polygon(&polygon);
        assert!(matches!(patch, Patch::Boxed { .. }));
        let n = 512;
        let hits = (0..n * n)
            .filter(|i| {
                let u = [((i % n) as f64 + 0.5) / n as f64, ((i / n) as f64 + 0.5) / n as f64];
                patch.point(u).is_some()
            })
            .count();
        // Diagonals meet at x = 3/4: lobes of area 3/8 and 27/8.
        let area = patch.area() * hits as f64 / (n * n) as f64;
        assert!((area - 3.75).abs() < 0.01, "{area}");
    }
}
