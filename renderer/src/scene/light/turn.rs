//! What a flat mirror or prism does to the light that it relays.

use glam::{DMat3, DVec3};

use super::sampler::Sample;
use super::{Light, Sampler};
use crate::geometry::Shape;
use crate::material::ProgramId;
use crate::pattern::{Memory, Place};
use crate::scene::Scene;

/// The plane of a mirror or prism.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Plane {
    pub(super) point: DVec3,
    pub(super) normal: DVec3,
}

impl Plane {
    /// How far a point lies in front.
    pub(super) fn height(&self, point: DVec3) -> f64 {
        (point - self.point).dot(self.normal)
    }

    pub(super) fn reflect_direction(&self, direction: DVec3) -> DVec3 {
        direction - self.normal * (2.0 * direction.dot(self.normal))
    }
}

/// The centre of a light or of its image: what a prism is asked to look for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Aim {
    /// A unit vector.
    Direction(DVec3),
    /// A place.
    Point(DVec3),
}

impl Aim {
    /// Unit vector from a point to it.
    pub(super) fn from(self, point: DVec3) -> Option<DVec3> {
        match self {
            Self::Direction(direction) => Some(direction),
            Self::Point(place) => (place - point).try_normalize(),
        }
    }
}

/// A prism relays a light as if it stood elsewhere: by the shear that keeps the prism's plane and brings the light's
/// centre to where the ray through the prism's centre seems to come from (mirrored in the plane, if the prism sends light
/// back). That is exact for the centres; every ray is then redirected by the prism's own functions, and counts if it
/// meets the light (as in rpict). The image of a distant light is drawn in until all of it does; rpict loses the samples that miss.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Shear {
    plane: Plane,
    /// What a point moves by for each unit of its height.
    shift: DVec3,
    /// The image of a difference of points; for distant lights, of a direction.
    image: DMat3,
    /// 1: what is lit lies in front of the plane, -1: behind it.
    lit: f64,
    /// The prism, and the number of its way.
    pub(super) way: (ProgramId, usize),
    /// The light.
    pub(super) aim: Aim,
}

/// What a flat mirror or prism does to the light that it relays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Turn {
    /// A mirror, from which light comes on its front only.
    Mirror(Plane),
    /// A prism.
    Prism(Shear),
}

/// Cosines of at most this lie in the prism's plane, as in rpict; so does a coefficient that is nothing.
const LEAST: f64 = 1e-6;

/// On so many points of a distant light's rim it is tried whether they are met.
const RIM: usize = 32;

impl Turn {
    /// What way `way` of a prism of shape `shape` does to a light; `None` if it relays none of it.
    pub(super) fn of_prism(scene: &Scene, shape: &Shape, light: &Light, way: (ProgramId, usize)) -> Option<Self> {
        let aim = light.aim();
        let (point, normal) = shape.plane()?;
        let centre = match shape {
            Shape::Triangle(triangle) => triangle.corners().iter().sum::<DVec3>() / 3.0,
            Shape::Polygon(polygon) => polygon.vertices().iter().sum::<DVec3>() / polygon.vertices().len() as f64,
            _ => point,
        };
        let before = -aim.from(centre)?;
        let place = Place { point: centre, dir: before, normal, distance: 0.0, uv: None, object: None };
        let (after, coefficient) = scene.redirected(way, &place, DVec3::ZERO, &mut Memory::default())?;
        let (cosine_before, cosine_after) = (before.dot(normal), after.dot(normal));
        if coefficient <= LEAST || cosine_before.abs() <= LEAST || cosine_after.abs() <= LEAST {
            return None;
        }
        let (before, after) = (before / cosine_before, after / cosine_after);
        let through = (cosine_before > 0.0) == (cosine_after > 0.0);
        let shift = if through { after - before } else { -after - before };
        let plane = Plane { point, normal };
        let shear = DMat3::IDENTITY + outer(shift, normal);
        let image = match aim {
            Aim::Direction(axis) => {
                let within = share_met(scene, way, &place, (light, axis), shear).unwrap_or(1.0);
                shear * (DMat3::IDENTITY * within + outer(axis, axis) * (1.0 - within))
            }
            Aim::Point(_) => shear,
        };
        Some(Self::Prism(Shear { plane, shift, image, lit: cosine_after.signum(), way, aim }))
    }

    /// The point whose image is `point`; `None` on the side of the sheet that gets no light.
    pub(super) fn unturned(&self, point: DVec3) -> Option<DVec3> {
        match self {
            Self::Mirror(plane) => {
                let height = plane.height(point);
                (height > 0.0).then(|| point - plane.normal * (2.0 * height))
            }
            Self::Prism(shear) => {
                let height = shear.plane.height(point);
                (height * shear.lit > 0.0).then(|| {
                    let before = height * shear.sense();
                    point - shear.shift * before
                })
            }
        }
    }

    /// The image of a difference of points, or of a direction.
    pub(super) fn turned(&self, vector: DVec3) -> DVec3 {
        match self {
            Self::Mirror(plane) => plane.reflect_direction(vector),
            Self::Prism(shear) => shear.image * vector,
        }
    }

    /// The image of a point.
    pub(super) fn turned_point(&self, point: DVec3) -> DVec3 {
        let origin = match self {
            Self::Mirror(plane) => plane.point,
            Self::Prism(shear) => shear.plane.point,
        };
        origin + self.turned(point - origin)
    }
}

/// The matrix that takes a vector `v` to `a` times the product of `b` and `v`.
fn outer(a: DVec3, b: DVec3) -> DMat3 {
    DMat3::from_cols(a * b.x, a * b.y, a * b.z)
}

/// The share of a distant light's radius within which a prism's functions lead all that a shear takes for its image back to it:
/// less than 1 where they show the light narrower than the shear has it.
fn share_met(
    scene: &Scene,
    way: (ProgramId, usize),
    place: &Place<'_>,
    (light, centre): (&Light, DVec3),
    shear: DMat3,
) -> Option<f64> {
    let mut memory = Memory::default();
    let mut led = |from: DVec3| {
        let place = Place { dir: (shear * from).try_normalize()?, ..*place };
        Some(scene.redirected(way, &place, centre, &mut memory)?.0)
    };
    if !led(centre)?.abs_diff_eq(centre, LEAST) {
        return None;
    }
    let rim = light.rim().filter_map(|rim| Some(led(rim)?.distance(centre) / rim.distance(centre)));
    Some(1.0 / rim.fold(1.0, f64::max))
}

impl Shear {
    /// By what the image's height is the point's own: 1, or -1 where the prism sends light back.
    fn sense(&self) -> f64 {
        (1.0 + self.shift.dot(self.plane.normal)).signum()
    }
}

impl Light {
    /// Its centre, seen over its mirrors and prisms.
    pub(super) fn aim(&self) -> Aim {
        match &self.sampler {
            Sampler::Distant { axis, .. } => {
                let turned = self.turns.iter().rev().fold(*axis, |dir, turn| turn.turned(dir));
                Aim::Direction(turned.normalize_or(*axis))
            }
            sampler => Aim::Point(self.turns.iter().rev().fold(sampler.centre(), |at, turn| turn.turned_point(at))),
        }
    }

    /// Unit vectors to points all around its rim, seen over its mirrors and prisms; none if it is not distant.
    fn rim(&self) -> impl Iterator<Item = DVec3> {
        let points = if let Sampler::Distant { .. } = self.sampler { RIM } else { 0 };
        (0..points).filter_map(|point| {
            let sample = self.sampler.sample(DVec3::ZERO, [1.0, point as f64 / RIM as f64])?;
            self.turns.iter().rev().fold(sample.dir, |dir, turn| turn.turned(dir)).try_normalize()
        })
    }

    /// Turns a sample of the light as seen from `image` into one of the light's image as seen from `from`.
    pub(super) fn relay_sample(&self, sample: &mut Sample, from: DVec3, image: DVec3) -> Option<()> {
        if !self.turns.iter().any(|turn| matches!(turn, Turn::Prism(_))) {
            // Mirrors keep lengths and angles.
            for turn in self.turns.iter().rev() {
                sample.dir = turn.turned(sample.dir);
            }
            return Some(());
        }
        let back = |vector: DVec3| self.turns.iter().rev().fold(vector, |vector, turn| turn.turned(vector));
        if sample.distance.is_infinite() {
            // rpict's distant light keeps its solid angle.
            sample.dir = back(sample.dir).try_normalize()?;
            return Some(());
        }
        let place = image + sample.dir * sample.distance;
        let way = self.turns.iter().rev().fold(place, |at, turn| turn.turned_point(at)) - from;
        let (dir, distance) = (way.try_normalize()?, way.length());
        sample.solid_angle *= (sample.distance / distance).powi(2);
        if let Some(normal) = self.sampler.normal() {
            // rpict turns the normal as it turns directions.
            let cosine = -back(normal).try_normalize()?.dot(dir);
            sample.solid_angle *= cosine / -normal.dot(sample.dir);
        }
        (sample.dir, sample.distance) = (dir, distance);
        (sample.solid_angle > 0.0).then_some(())
    }
}
