//! Eight triangles that are asked at once whether a ray could meet them, so that only those few are met exactly.

use glam::Vec3;

use super::lanes::Lanes;
use super::line::Line;

/// Triangles in a block.
pub(super) const LANES: usize = 8;

/// By how much the place of a corner may be off across a ray, in a frame where the scene's half extent is 1. Rounding of the corner
/// and of the origin (3e-8 each), of their differences (1.2e-7 each), of the shear (6e-8 of a depth up to 2) and of the product and
/// difference with it (2.4e-7 each) add up to 9e-7; products of two such places are rounded by 5e-7 of either.
pub(super) const CORNER_ERROR: f32 = 4e-6;

/// The triangles, and whose they are: a polygon is there as a [`fan`].
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub(super) struct Block {
    /// By corner and axis.
    corners: [[[f32; LANES]; 3]; 3],
    /// How much further along a ray a hit may lie than a triangle's own corners.
    reach: f32,
    /// Where the first lane's shape is, and how much further on those of the lanes are; the lanes of one follow each other. Spare
    /// lanes repeat the last.
    first: u32,
    further: [u8; LANES],
}

/// A triangle that stands for a shape, or for a part of one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Part {
    /// Where the shape is.
    pub(super) slot: u32,
    /// In the hierarchy's frame.
    pub(super) corners: [[f32; 3]; 3],
    /// The largest distance along an axis from a corner to another vertex of the shape.
    pub(super) reach: f32,
}

/// A polygon as triangles around its first vertex: one that passes inside it by the even-odd rule passes an odd number of them,
/// since what is added is walked both ways.
pub(super) fn fan(slot: u32, vertices: impl ExactSizeIterator<Item = Vec3> + Clone) -> impl Iterator<Item = Part> {
    let first = vertices.clone().next().unwrap_or_default();
    let away = |vertex: Vec3| (vertex - first).abs().max_element();
    let reach = if vertices.len() > 3 { vertices.clone().map(away).fold(0.0, f32::max) } else { 0.0 };
    let pairs = vertices.clone().skip(1).zip(vertices.skip(2));
    pairs.map(move |(a, b)| Part { slot, corners: [first, a, b].map(|corner| corner.to_array()), reach })
}

impl Block {
    /// A block of at least one and at most eight triangles, of shapes that follow each other.
    pub(super) fn new(parts: &[Part]) -> Self {
        let reach = parts.iter().map(|part| part.reach).fold(0.0, f32::max) + CORNER_ERROR;
        let mut block = Self { corners: [[[0.0; LANES]; 3]; 3], reach, first: parts[0].slot, further: [0; LANES] };
        for lane in 0..LANES {
            let part = parts[lane.min(parts.len() - 1)];
            block.further[lane] = (part.slot - block.first) as u8;
            for (to, corner) in block.corners.iter_mut().zip(part.corners) {
                for axis in 0..3 {
                    to[axis][lane] = corner[axis];
                }
            }
        }
        block
    }

    /// Where the shape of a lane is.
    #[inline(always)]
    pub(super) fn slot(&self, lane: usize) -> u32 {
        self.first + u32::from(self.further[lane])
    }

    /// Which of the triangles the ray may meet before `t_max`, a bit for each: all that it does meet, and a few others.
    #[inline(always)]
    pub(super) fn meet<L: Lanes>(&self, lanes: L, line: &Line, t_max: f32) -> u32 {
        // No closures over lanes here, nor `map`: they might be compiled apart, without the lanes' instructions.
        let a = self.across(lanes, line, 0);
        let b = self.across(lanes, line, 1);
        let c = self.across(lanes, line, 2);
        // Twice the signed areas that the line and two corners span; all of one sign where it passes within.
        let ab = lanes.sub_mul(lanes.mul(a[0], b[1]), b[0], a[1]);
        let bc = lanes.sub_mul(lanes.mul(b[0], c[1]), c[0], b[1]);
        let ca = lanes.sub_mul(lanes.mul(c[0], a[1]), a[0], c[1]);
        let error = lanes.splat(line.corner_error);
        let size_a = lanes.add(lanes.abs(a[0]), lanes.abs(a[1]));
        let size_b = lanes.add(lanes.abs(b[0]), lanes.abs(b[1]));
        let size_c = lanes.add(lanes.abs(c[0]), lanes.abs(c[1]));
        let error = lanes.mul(lanes.add(lanes.add(size_a, size_b), lanes.add(size_c, error)), error);
        let least = lanes.min(lanes.min(ab, bc), ca);
        let most = lanes.max(lanes.max(ab, bc), ca);
        let zero = lanes.splat(0.0);
        let outside = lanes.greater(lanes.sub(zero, error), least) & lanes.greater(most, error);
        // The shape's hit lies between the depths of its vertices.
        let [reach, scale] = [lanes.splat(self.reach), lanes.splat(line.inverse[line.axes[2]])];
        let (one, other) = (lanes.min(lanes.min(a[2], b[2]), c[2]), lanes.max(lanes.max(a[2], b[2]), c[2]));
        let one = lanes.mul(lanes.sub(one, reach), scale);
        let other = lanes.mul(lanes.add(other, reach), scale);
        let error = lanes.splat(2.0 * line.corner_error);
        let behind = lanes.greater(lanes.sub(zero, error), lanes.max(one, other));
        let beyond = lanes.greater(lanes.sub(lanes.min(one, other), error), lanes.splat(t_max));
        (outside | behind | beyond) ^ 0xff
    }

    /// The corners of one number across the line, which passes through zero, and their depths along its axis.
    #[inline(always)]
    fn across<L: Lanes>(&self, lanes: L, line: &Line, corner: usize) -> [L::Eight; 3] {
        let corner = &self.corners[corner];
        let [across, up, along] = line.axes;
        let depth = lanes.sub(lanes.load(&corner[along]), lanes.splat(line.origin[along]));
        let x = lanes.sub(lanes.load(&corner[across]), lanes.splat(line.origin[across]));
        let y = lanes.sub(lanes.load(&corner[up]), lanes.splat(line.origin[up]));
        let x = lanes.sub_mul(x, lanes.splat(line.shear[0]), depth);
        [x, lanes.sub_mul(y, lanes.splat(line.shear[1]), depth), depth]
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use proptest::prelude::*;

    use super::*;
    use crate::geometry::lanes::{Level, Task};
    use crate::geometry::shape::{Polygon, Probe};

    struct Meet<'a>(&'a Block, &'a Line, f32);

    impl Task for Meet<'_> {
        type Answer = u32;

        #[inline(always)]
        fn run<L: Lanes>(self, lanes: L) -> u32 {
            self.0.meet(lanes, self.1, self.2)
        }
    }

    fn point() -> impl Strategy<Value = DVec3> {
        prop::array::uniform3(-1.0..1.0_f64).prop_map(DVec3::from)
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(4000))]

        /// Whatever meets a polygon, however warped and tangled, is not turned away by its fan; what passes it clearly is.
        #[test]
        fn a_fan_is_met_where_its_polygon_is(
            vertices in prop::collection::vec(point(), 4..9), scale in -5..1_i32, origin in point(), weights in prop::array::uniform8(0.0..1.0_f64),
            aside in point(),
        ) {
            let (middle, scale) = (vertices[0] * 0.5, 10_f64.powi(scale) * 0.5);
            let vertices: Vec<DVec3> = vertices.iter().map(|&vertex| middle + vertex * scale).collect();
            let Ok(polygon) = Polygon::new(vertices.clone()) else { return Ok(()) };
            let polygon = crate::geometry::Shape::Polygon(polygon);
            let parts: Vec<Part> = fan(3, vertices.iter().map(|vertex| vertex.as_vec3())).collect();
            let block = Block::new(&parts);
            let sum: f64 = weights[..vertices.len()].iter().sum();
            let inside = vertices.iter().zip(weights).map(|(&vertex, weight)| vertex * (weight / sum)).sum::<DVec3>();
            for target in [vertices[0], vertices[2], (vertices[1] + vertices[2]) * 0.5, inside, inside + aside * 8.0 * scale] {
                let dir = (target - origin).normalize();
                let probe = Probe::new(origin, dir);
                let line = Line::new(origin, dir, &probe, 0.0).unwrap();
                let met = polygon.meet(&probe, false, 0.0, f64::INFINITY);
                for level in [Level::Plain, Level::best()] {
                    if let Some(t) = met {
                        prop_assert!(level.run(Meet(&block, &line, (t as f32).next_up())) != 0, "{polygon:?} {origin} {dir}");
                    } else if target == inside + aside * 8.0 * scale && aside.cross(dir).length() > 0.9 && scale > 0.01 {
                        prop_assert_eq!(level.run(Meet(&block, &line, f32::INFINITY)), 0);
                    }
                }
            }
        }
    }
}
