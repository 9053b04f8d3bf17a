//! Surface primitives' arguments: reference manual, section 2.1.

use glam::DVec3;

use super::Reporter;
use crate::geometry::Shape;
use crate::geometry::shape::{Cone, Degenerate, Polygon, Ring, Sphere, Triangle};
use crate::rad::{Argument, Kind, Primitive};

/// Coordinates beyond this are refused: their cubes would leave the range of `f64`.
const LARGEST: f64 = 1e75;

/// How far a vertex may lie off the plane of its polygon, per extent, without a remark.
const PLANAR: f64 = 1e-3;

/// The shape of a surface primitive; `None` if it is degenerate (with a warning) or wrong (with an error).
pub(super) fn read(primitive: &Primitive, reporter: &mut Reporter) -> Option<Shape> {
    if !in_range(primitive, reporter) {
        return None;
    }
    let reals = &primitive.reals;
    let point = |at: usize| DVec3::from_slice(&reals[at..at + 3]);
    let shape = match primitive.kind {
        Kind::Polygon => polygon(reals),
        Kind::Sphere => Sphere::new(point(0), reals[3]).map(Shape::Sphere),
        Kind::Bubble => Sphere::new(point(0), -reals[3]).map(Shape::Sphere),
        Kind::Cone | Kind::Cup => {
            frustum(primitive, reporter, [point(0), point(3)], [reals[6], reals[7]], primitive.kind == Kind::Cup)?
        }
        Kind::Cylinder | Kind::Tube => {
            frustum(primitive, reporter, [point(0), point(3)], [reals[6]; 2], primitive.kind == Kind::Tube)?
        }
        Kind::Ring => {
            if let Some(at) = [6, 7].into_iter().find(|&at| reals[at] < 0.0) {
                let message = format!("the radius is {}, expected 0 or more", reals[at]);
                reporter.error(primitive, Argument::Real(at), message);
                return None;
            }
            Ring::new(point(0), point(3), [reals[6], reals[7]]).map(Shape::Ring)
        }
        _ => return None,
    };
    match shape {
        Ok(shape) => {
            if let Shape::Polygon(polygon) = &shape
                && polygon.warp() > PLANAR
            {
                let message = format!(
                    "polygon `{}` is not flat: a vertex is off its plane by {:.2} % of its extent",
                    primitive.name,
                    100.0 * polygon.warp()
                );
                reporter.warn(primitive, Argument::Kind, message);
            }
            Some(shape)
        }
        Err(degenerate) => {
            leave_out(primitive, degenerate, reporter);
            None
        }
    }
}

/// Unit vector towards a `source` and its full angle in degrees.
pub(super) fn read_source(primitive: &Primitive, reporter: &mut Reporter) -> Option<(DVec3, f64)> {
    let direction = DVec3::from_slice(&primitive.reals[..3]);
    let angle_deg = primitive.reals[3];
    let size = direction.abs().max_element();
    if size == 0.0 {
        reporter.error(primitive, Argument::Real(0), "the direction is 0 0 0, expected a vector towards the source");
        return None;
    }
    if !(0.0..=360.0).contains(&angle_deg) {
        let message = format!("the angle is {angle_deg} degrees, expected 0 to 360");
        reporter.error(primitive, Argument::Real(3), message);
        return None;
    }
    if angle_deg == 0.0 {
        let message = format!("source `{}` is left out: with an angle of 0 it covers nothing", primitive.name);
        reporter.warn(primitive, Argument::Real(3), message);
        return None;
    }
    Some(((direction / size).normalize(), angle_deg))
}

fn in_range(primitive: &Primitive, reporter: &mut Reporter) -> bool {
    let Some(at) = primitive.reals.iter().position(|x| x.abs() > LARGEST) else { return true };
    let message = format!("{:e} is too large, expected at most {LARGEST:e}", primitive.reals[at]);
    reporter.error(primitive, Argument::Real(at), message);
    false
}

fn leave_out(primitive: &Primitive, degenerate: Degenerate, reporter: &mut Reporter) {
    let message = format!("{} `{}` is left out: {degenerate}", primitive.kind, primitive.name);
    reporter.warn(primitive, Argument::Kind, message);
}

fn polygon(reals: &[f64]) -> Result<Shape, Degenerate> {
    let mut vertices: Vec<DVec3> = reals.chunks_exact(3).map(DVec3::from_slice).collect();
    if vertices.len() > 1 && vertices.first() == vertices.last() {
        vertices.pop();
    }
    match <[DVec3; 3]>::try_from(vertices) {
        Ok(corners) => Triangle::new(corners).map(Shape::Triangle),
        Err(vertices) if vertices.len() < 3 => Err(Degenerate::NoArea),
        Err(vertices) => Polygon::new(vertices).map(Shape::Polygon),
    }
}

/// Cone, cup, cylinder or tube. Negative radii swap inside and outside.
fn frustum(
    primitive: &Primitive,
    reporter: &mut Reporter,
    ends: [DVec3; 2],
    radii: [f64; 2],
    inward: bool,
) -> Option<Result<Shape, Degenerate>> {
    if radii[0] * radii[1] < 0.0 {
        let message = format!("the radii {} and {} have different signs", radii[0], radii[1]);
        reporter.error(primitive, Argument::Real(7), message);
        return None;
    }
    let swapped = radii[0] < 0.0 || radii[1] < 0.0;
    Some(Cone::new(ends, radii.map(f64::abs), inward != swapped).map(Shape::Cone))
}
