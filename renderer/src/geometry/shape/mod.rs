//! The surfaces that Radiance has (RADIANCE reference manual, section 2.1), one file each.
//!
//! Each meets rays in `f64`, knows its own front, and can bring a nearby point back onto itself.

mod cone;
mod placed;
mod polygon;
mod probe;
mod ring;
mod sphere;

use glam::DVec3;

pub use cone::Cone;
pub use placed::Placed;
pub use polygon::{Polygon, Triangle};
pub use probe::Probe;
pub use ring::Ring;
pub use sphere::Sphere;

/// Why a shape is no surface at all and is left out of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Degenerate {
    /// A polygon or ring that covers nothing.
    #[error("it has no area")]
    NoArea,
    /// A sphere, cone or cylinder of radius zero.
    #[error("its radius is zero")]
    NoRadius,
    /// A cone or cylinder whose ends coincide.
    #[error("its ends coincide")]
    NoLength,
    /// A ring without a normal.
    #[error("its normal has no length")]
    NoNormal,
}

/// A surface's geometry.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// A polygon of three vertices.
    Triangle(Triangle),
    /// A polygon of more vertices, concave or with seams perhaps.
    Polygon(Polygon),
    /// Sphere or bubble.
    Sphere(Sphere),
    /// Cone, cup, cylinder or tube.
    Cone(Cone),
    /// Annulus or disc.
    Ring(Ring),
    /// Instance or mesh.
    Placed(Placed),
}

impl Shape {
    /// The distance at which a ray first meets the shape between `t_min` and `t_max` (exclusive);
    /// `leaving` says that the ray starts on it.
    #[must_use]
    pub fn meet(&self, probe: &Probe, leaving: bool, t_min: f64, t_max: f64) -> Option<f64> {
        match self {
            Self::Triangle(triangle) if !leaving => triangle.meet(probe, t_min, t_max),
            Self::Polygon(polygon) if !leaving => polygon.meet(probe, t_min, t_max),
            Self::Ring(ring) if !leaving => ring.meet(probe, t_min, t_max),
            // A straight line leaves a plane once.
            Self::Triangle(_) | Self::Polygon(_) | Self::Ring(_) => None,
            Self::Sphere(sphere) => sphere.meet(probe, leaving, t_min, t_max),
            Self::Cone(cone) => cone.meet(probe, leaving, t_min, t_max),
            // Its surfaces have numbers of their own; the least distance keeps a ray from what it leaves.
            Self::Placed(placed) => placed.meet(probe, t_min, t_max),
        }
    }

    /// The point of the surface nearest to a `point` that lies on it up to rounding, and the unit normal there on
    /// the surface's front. What is placed has no surface of its own: see [`Placed::hit`].
    #[must_use]
    pub fn settle(&self, point: DVec3) -> (DVec3, DVec3) {
        match self {
            Self::Triangle(triangle) => triangle.settle(point),
            Self::Polygon(polygon) => polygon.settle(point),
            Self::Sphere(sphere) => sphere.settle(point),
            Self::Cone(cone) => cone.settle(point),
            Self::Ring(ring) => ring.settle(point),
            Self::Placed(_) => (point, DVec3::Z),
        }
    }

    /// Lowest and highest corner of the axis-parallel box around the shape.
    #[must_use]
    pub fn bounds(&self) -> [DVec3; 2] {
        match self {
            Self::Triangle(triangle) => triangle.bounds(),
            Self::Polygon(polygon) => polygon.bounds(),
            Self::Sphere(sphere) => sphere.bounds(),
            Self::Cone(cone) => cone.bounds(),
            Self::Ring(ring) => ring.bounds(),
            Self::Placed(placed) => placed.bounds(),
        }
    }

    /// Area in the scene's unit squared; of what is placed, none of its own.
    #[must_use]
    pub fn area(&self) -> f64 {
        match self {
            Self::Triangle(triangle) => triangle.area(),
            Self::Polygon(polygon) => polygon.area(),
            Self::Sphere(sphere) => sphere.area(),
            Self::Cone(cone) => cone.area(),
            Self::Ring(ring) => ring.area(),
            Self::Placed(_) => 0.0,
        }
    }

    /// A point of the plane and its unit normal, if the shape is flat.
    #[must_use]
    pub fn plane(&self) -> Option<(DVec3, DVec3)> {
        match self {
            Self::Triangle(triangle) => Some((triangle.corners()[0], triangle.normal())),
            Self::Polygon(polygon) => Some((polygon.point(), polygon.normal())),
            Self::Ring(ring) => Some((ring.centre(), ring.normal())),
            Self::Sphere(_) | Self::Cone(_) | Self::Placed(_) => None,
        }
    }

    /// The outline of what is bounded by straight edges.
    #[must_use]
    pub fn vertices(&self) -> Option<&[DVec3]> {
        match self {
            Self::Triangle(triangle) => Some(triangle.vertices()),
            Self::Polygon(polygon) => Some(polygon.vertices()),
            Self::Sphere(_) | Self::Cone(_) | Self::Ring(_) | Self::Placed(_) => None,
        }
    }

    /// Whether all of it lies in a plane.
    #[must_use]
    pub fn is_flat(&self) -> bool {
        !matches!(self, Self::Sphere(_) | Self::Cone(_) | Self::Placed(_))
    }
}

/// `t` if it lies strictly between the bounds.
fn within(t: f64, t_min: f64, t_max: f64) -> Option<f64> {
    (t > t_min && t < t_max).then_some(t)
}

#[cfg(test)]
mod tests;
