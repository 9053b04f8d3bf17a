//! `polygon`: flat, of any number of vertices, concave or holed by seams.

use std::sync::Arc;

use glam::{DVec2, DVec3};

use super::{Degenerate, Probe, within};

/// A polygon of three vertices.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triangle {
    corners: [DVec3; 3],
}

/// A polygon of more than three vertices.
///
/// What is inside is decided by the even-odd rule, so a hole is cut by a seam: an edge walked in both directions.
#[derive(Clone, Debug, PartialEq)]
pub struct Polygon {
    normal: DVec3,
    point: DVec3,
    vertices: Arc<[DVec3]>,
}

/// Whether an edge seen by a ray crosses the positive x axis.
///
/// The answer is the same for both directions of the edge, since it is computed from the lower to the upper end
/// whatever the direction. So polygons that share an edge agree about it, the decisions about an inner edge of a closed
/// mesh cancel, and the number of hits has the parity of the outline: no ray slips through an edge or a vertex,
/// whatever the rounding.
#[inline]
fn crosses(from: DVec2, to: DVec2) -> bool {
    let (low, high) = match (from.y > 0.0, to.y > 0.0) {
        (false, true) => (from, to),
        (true, false) => (to, from),
        _ => return false,
    };
    low.x * high.y > high.x * low.y
}

/// The smaller of two numbers; not `min`, which takes care of what is none.
#[inline]
fn least(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

/// The larger of two numbers.
#[inline]
fn most(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// Where the ray meets the plane through `point`, kept within the polygon's own range of depths, without which a
/// grazing ray would find a meaningless distance.
#[inline]
fn plane_distance(probe: &Probe, point: DVec3, normal: DVec3, nearest: f64, furthest: f64) -> f64 {
    let t = (point - probe.origin).dot(normal) / probe.dir.dot(normal);
    // Not `clamp`: an edge-on polygon gives 0/0, which `max` replaces.
    t.max(nearest).min(furthest)
}

impl Triangle {
    /// The triangle of three corners, counter-clockwise as seen from its front.
    pub fn new(corners: [DVec3; 3]) -> Result<Self, Degenerate> {
        newell(&corners).ok_or(Degenerate::NoArea)?;
        Ok(Self { corners })
    }

    /// Its corners, counter-clockwise as seen from the front.
    #[must_use]
    pub fn corners(&self) -> [DVec3; 3] {
        self.corners
    }

    pub(super) fn vertices(&self) -> &[DVec3] {
        &self.corners
    }

    fn doubled_area_vector(&self) -> DVec3 {
        (self.corners[1] - self.corners[0]).cross(self.corners[2] - self.corners[0])
    }

    /// Unit normal of the front.
    #[must_use]
    pub fn normal(&self) -> DVec3 {
        unit(self.doubled_area_vector())
    }

    #[inline]
    pub(super) fn meet(&self, probe: &Probe, t_min: f64, t_max: f64) -> Option<f64> {
        let inside = match probe.axis() {
            0 => self.is_met::<0>(probe),
            1 => self.is_met::<1>(probe),
            _ => self.is_met::<2>(probe),
        };
        if !inside {
            return None;
        }
        let [a, b, c] = self.corners.map(|corner| probe.depth(corner));
        let (nearest, furthest) = (least(least(a, b), c), most(most(a, b), c));
        within(plane_distance(probe, self.corners[0], self.doubled_area_vector(), nearest, furthest), t_min, t_max)
    }

    /// Whether the ray's line, whose axis is `AXIS`, passes through.
    #[inline]
    fn is_met<const AXIS: usize>(&self, probe: &Probe) -> bool {
        let [a, b, c] = self.corners.map(|corner| probe.across::<AXIS>(corner));
        crosses(a, b) ^ crosses(b, c) ^ crosses(c, a)
    }

    pub(super) fn settle(&self, point: DVec3) -> (DVec3, DVec3) {
        let normal = self.normal();
        (point - normal * (point - self.corners[0]).dot(normal), normal)
    }

    pub(super) fn bounds(&self) -> [DVec3; 2] {
        bounds(&self.corners)
    }

    pub(super) fn area(&self) -> f64 {
        0.5 * self.doubled_area_vector().length()
    }
}

impl Polygon {
    /// The polygon of these vertices, counter-clockwise as seen from its front; its plane is the one of Newell's normal
    /// through the mean of the vertices.
    pub fn new(vertices: Vec<DVec3>) -> Result<Self, Degenerate> {
        let normal = newell(&vertices).ok_or(Degenerate::NoArea)?;
        let first = vertices[0];
        let mean = vertices.iter().map(|&vertex| vertex - first).sum::<DVec3>() / vertices.len() as f64;
        Ok(Self { normal: unit(normal), point: first + mean, vertices: vertices.into() })
    }

    /// Its vertices in order.
    #[must_use]
    pub fn vertices(&self) -> &[DVec3] {
        &self.vertices
    }

    /// Unit normal of the front.
    #[must_use]
    pub fn normal(&self) -> DVec3 {
        self.normal
    }

    /// The mean of the vertices: a point of the plane, not always of the polygon.
    #[must_use]
    pub fn point(&self) -> DVec3 {
        self.point
    }

    /// How far the vertex that lies furthest from the plane is off, in units of the polygon's extent.
    #[must_use]
    pub fn warp(&self) -> f64 {
        let off = self.vertices.iter().map(|&vertex| (vertex - self.point).dot(self.normal).abs()).fold(0.0, f64::max);
        let [low, high] = self.bounds();
        off / (high - low).length()
    }

    pub(super) fn meet(&self, probe: &Probe, t_min: f64, t_max: f64) -> Option<f64> {
        let inside = match probe.axis() {
            0 => self.is_met::<0>(probe),
            1 => self.is_met::<1>(probe),
            _ => self.is_met::<2>(probe),
        };
        if !inside {
            return None;
        }
        let (mut nearest, mut furthest) = (f64::INFINITY, f64::NEG_INFINITY);
        for &vertex in &*self.vertices {
            let depth = probe.depth(vertex);
            nearest = least(nearest, depth);
            furthest = most(furthest, depth);
        }
        within(plane_distance(probe, self.point, self.normal, nearest, furthest), t_min, t_max)
    }

    /// Whether the ray's line, whose axis is `AXIS`, passes through.
    #[inline]
    fn is_met<const AXIS: usize>(&self, probe: &Probe) -> bool {
        let mut from = probe.across::<AXIS>(self.vertices[self.vertices.len() - 1]);
        let mut inside = false;
        for &vertex in &*self.vertices {
            let to = probe.across::<AXIS>(vertex);
            inside ^= crosses(from, to);
            from = to;
        }
        inside
    }

    pub(super) fn settle(&self, point: DVec3) -> (DVec3, DVec3) {
        (point - self.normal * (point - self.point).dot(self.normal), self.normal)
    }

    pub(super) fn bounds(&self) -> [DVec3; 2] {
        bounds(&self.vertices)
    }

    pub(super) fn area(&self) -> f64 {
        doubled_area_vector(&self.vertices).dot(self.normal) / 2.0
    }
}

/// A vector made unit even where the squares of its parts would leave the range of `f64`.
fn unit(vector: DVec3) -> DVec3 {
    (vector / vector.abs().max_element()).normalize()
}

fn bounds(vertices: &[DVec3]) -> [DVec3; 2] {
    vertices
        .iter()
        .fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |[low, high], &vertex| [low.min(vertex), high.max(vertex)])
}

/// Twice the area times the normal (Newell), taken from the first vertex so that far coordinates do not drown it.
fn doubled_area_vector(vertices: &[DVec3]) -> DVec3 {
    let first = vertices[0];
    vertices.windows(2).map(|edge| (edge[0] - first).cross(edge[1] - first)).sum()
}

/// [`doubled_area_vector`] if it stands out of the rounding of the vertices.
fn newell(vertices: &[DVec3]) -> Option<DVec3> {
    let vector = doubled_area_vector(vertices);
    let [low, high] = bounds(vertices);
    let extent = (high - low).max_element();
    let magnitude = low.abs().max(high.abs()).max_element();
    let rounding = 8.0 * f64::EPSILON * extent * magnitude.max(extent);
    (vector.abs().max_element() > rounding).then_some(vector)
}
