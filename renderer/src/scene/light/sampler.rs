//! Points of a light of any shape, as seen from somewhere.

use std::f64::consts::TAU;

use glam::DVec3;

use super::patch::Patch;
use crate::geometry::Shape;
use crate::geometry::shape::{Cone, Sphere};
use crate::math::{Frame, warp};

/// How points of a light are chosen.
#[derive(Clone, Debug)]
pub(super) enum Sampler {
    /// By area, from a flat shape.
    Flat { patch: Patch, area: f64, normal: DVec3 },
    /// By solid angle, from the cap of a sphere that is seen.
    Sphere(Sphere),
    /// By area, from the part of a cylinder that is seen, or from a whole cone.
    Cone(Cone),
    /// By solid angle, from a cone of directions.
    Distant { axis: DVec3, versine: f64 },
}

/// A direction with its length and the solid angle that it stands for.
pub(super) struct Sample {
    pub(super) dir: DVec3,
    pub(super) distance: f64,
    pub(super) solid_angle: f64,
}

impl Sampler {
    pub(super) fn of_shape(shape: &Shape) -> Self {
        let flat = |patch: Patch, normal| Self::Flat { area: patch.area(), patch, normal };
        match shape {
            Shape::Triangle(triangle) => flat(Patch::of_triangle(triangle), triangle.normal()),
            Shape::Polygon(polygon) => flat(Patch::of_polygon(polygon), polygon.normal()),
            Shape::Ring(ring) => flat(Patch::of_ring(ring), ring.normal()),
            Shape::Sphere(sphere) => Self::Sphere(*sphere),
            Shape::Cone(cone) => Self::Cone(*cone),
            // Instances and meshes are no lights, as in Radiance.
            Shape::Placed(_) => Self::Distant { axis: DVec3::Z, versine: 0.0 },
        }
    }

    /// The middle of a light that is a surface.
    pub(super) fn centre(&self) -> DVec3 {
        match self {
            Self::Flat { patch, .. } => patch.middle(),
            Self::Sphere(sphere) => sphere.centre(),
            Self::Cone(cone) => {
                let (base, axis) = cone.axis();
                base + axis * (0.5 * cone.length())
            }
            Self::Distant { .. } => DVec3::ZERO,
        }
    }

    /// The unit normal of a flat light.
    pub(super) fn normal(&self) -> Option<DVec3> {
        if let Self::Flat { normal, .. } = self { Some(*normal) } else { None }
    }

    pub(super) fn sample(&self, from: DVec3, u: [f64; 2]) -> Option<Sample> {
        match self {
            Self::Flat { patch, area, normal } => towards(from, patch.point(u)?, *normal, *area),
            Self::Sphere(sphere) if sphere.is_bubble() => bubble(sphere, from, u),
            Self::Sphere(ball) => sphere(ball, from, u),
            Self::Cone(cone) => frustum(cone, from, u),
            Self::Distant { axis, versine } => Some(Sample {
                dir: Frame::around(*axis).to_world(warp::cone(u, *versine)),
                distance: f64::INFINITY,
                solid_angle: TAU * versine,
            }),
        }
    }

    /// The distance that a glow's radius limits: to the middle of a sphere, as in Radiance, to the sample of other shapes. A bubble
    /// counts by its sample, as the rays do that meet it from within: by its middle its light would count twice in Radiance.
    pub(super) fn reach(&self, from: DVec3, sample: &Sample) -> f64 {
        match self {
            Self::Sphere(sphere) if !sphere.is_bubble() => sphere.centre().distance(from),
            _ => sample.distance,
        }
    }
}

/// The sample of a point of a surface that stands for `area` of it; `None` if the surface faces away there.
fn towards(from: DVec3, point: DVec3, normal: DVec3, area: f64) -> Option<Sample> {
    let way = point - from;
    let distance = way.length();
    let dir = way / distance;
    let cosine = -normal.dot(dir);
    // Also false where the point itself is chosen: 0/0.
    (cosine > 0.0).then(|| Sample { dir, distance, solid_angle: area * cosine / (distance * distance) })
}

/// A sphere shines outward: uniform over the directions in which it is seen.
fn sphere(sphere: &Sphere, from: DVec3, u: [f64; 2]) -> Option<Sample> {
    let to_centre = sphere.centre() - from;
    let centre_distance = to_centre.length();
    let radius = sphere.radius();
    // Both factors, so that nothing is lost just above the surface.
    let tangent_squared = (centre_distance - radius) * (centre_distance + radius);
    if tangent_squared <= 0.0 {
        return None;
    }
    // 1 - cos = sin^2 / (1 + cos), exact for spheres that look as small as a star.
    let sine = radius / centre_distance;
    let cosine = tangent_squared.sqrt() / centre_distance;
    let versine = sine * sine / (1.0 + cosine);
    let local = warp::cone(u, versine);
    let dir = Frame::around(to_centre / centre_distance).to_world(local);
    // The nearer root of the chord: product of the roots over the further one.
    let aside_squared = centre_distance * centre_distance * local.truncate().length_squared();
    let half_chord = (radius * radius - aside_squared).max(0.0).sqrt();
    let distance = tangent_squared / (centre_distance * local.z + half_chord);
    Some(Sample { dir, distance, solid_angle: TAU * versine })
}

/// A bubble shines inward: from inside, every direction meets it.
fn bubble(bubble: &Sphere, from: DVec3, u: [f64; 2]) -> Option<Sample> {
    let to_centre = bubble.centre() - from;
    let depth_squared = (bubble.radius() - to_centre.length()) * (bubble.radius() + to_centre.length());
    if depth_squared <= 0.0 {
        return None;
    }
    let dir = warp::sphere(u);
    let middle = to_centre.dot(dir);
    Some(Sample { dir, distance: middle + (middle * middle + depth_squared).sqrt(), solid_angle: 2.0 * TAU })
}

/// A frustum: uniform over its area; of a cylinder seen from outside only over the strip that faces `from`.
fn frustum(cone: &Cone, from: DVec3, u: [f64; 2]) -> Option<Sample> {
    let (base, axis) = cone.axis();
    let [base_radius, top_radius] = cone.radii();
    let from_base = from - base;
    let aside = from_base - axis * from_base.dot(axis);
    let mut frame = Frame::around(axis);
    let mut half_arc = 0.5 * TAU;
    if base_radius == top_radius && !cone.is_inward() {
        let distance = aside.length();
        if distance <= base_radius {
            return None;
        }
        half_arc = (base_radius / distance).acos();
        frame.u = aside / distance;
        frame.v = axis.cross(frame.u);
    }
    // Heights in proportion to the radius there: the square of the radius is uniform.
    let height = if base_radius == top_radius {
        u[0]
    } else {
        let squared = base_radius * base_radius + u[0] * (top_radius * top_radius - base_radius * base_radius);
        (squared.sqrt() - base_radius) / (top_radius - base_radius)
    };
    let radius = base_radius + (top_radius - base_radius) * height;
    let (sin, cos) = (half_arc * (2.0 * u[1] - 1.0)).sin_cos();
    let outward = frame.u * cos + frame.v * sin;
    let point = base + axis * (cone.length() * height) + outward * radius;
    let (_, normal) = Shape::Cone(*cone).settle(point);
    let whole = Shape::Cone(*cone).area();
    towards(from, point, normal, whole * (2.0 * half_arc / TAU))
}
