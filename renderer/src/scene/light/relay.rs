//! Virtual lights: the images of lights in flat mirrors (`rpict(1)`, `-dr`).

use glam::DVec3;

use super::{Light, LightSample};
use crate::geometry::shape::Probe;
use crate::geometry::{Hit, Ray, Shape, SurfaceId};
use crate::math::tolerance;
use crate::scene::{Scene, SourceId};

/// The plane of a mirror.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Plane {
    point: DVec3,
    normal: DVec3,
}

impl Plane {
    /// How far a point lies in front.
    fn height(&self, point: DVec3) -> f64 {
        (point - self.point).dot(self.normal)
    }

    /// The image of a point in front; none of one behind.
    pub(super) fn reflect_point_in_front(&self, point: DVec3) -> Option<DVec3> {
        let height = self.height(point);
        (height > 0.0).then(|| point - self.normal * (2.0 * height))
    }

    pub(super) fn reflect_direction(&self, direction: DVec3) -> DVec3 {
        direction - self.normal * (2.0 * direction.dot(self.normal))
    }
}

/// One straight piece of the way from a lit point to a light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Leg {
    /// The piece; it ends at the mirror or the light, infinitely far for distant sources.
    pub ray: Ray,
    /// The surface at its end, which is no obstacle.
    pub target: Option<SurfaceId>,
    /// Where it meets the mirror that relays it; `None` on the last piece.
    pub mirror: Option<Hit>,
}

impl Light {
    /// Lays out the way of a sample taken at `start.origin`, from mirror to mirror; `start` also names the surface that is
    /// lit. `legs` is cleared and filled. False if the way misses one of the mirrors: then no light comes.
    pub fn legs(&self, scene: &Scene, start: Ray, sample: &LightSample, legs: &mut Vec<Leg>) -> bool {
        legs.clear();
        let mut ray = Ray { dir: sample.dir, ..start };
        let mut left = sample.distance;
        for (&surface, plane) in self.relay.iter().zip(&self.planes) {
            let probe = Probe::new(ray.origin, ray.dir);
            let t_min = tolerance::least_distance(ray.origin, 0.0);
            let shape = &scene.surfaces[surface.index()].shape;
            let Some(t) = shape.meet(&probe, ray.leaving == Some(surface), t_min, left) else { return false };
            if ray.dir.dot(plane.normal) >= 0.0 {
                return false;
            }
            let (point, normal) = shape.settle(ray.at(t));
            let hit = Hit { t, point, normal, surface };
            legs.push(Leg { ray: ray.up_to(t), target: Some(surface), mirror: Some(hit) });
            ray = Ray::new(point, plane.reflect_direction(ray.dir)).leaving(surface);
            left -= t;
        }
        let target = match self.source {
            SourceId::Surface(surface) => Some(surface),
            SourceId::Far(_) => None,
        };
        legs.push(Leg { ray: ray.up_to(left), target, mirror: None });
        true
    }
}

/// The images of every light in `lights` in the flat mirrors of `mirrors`, over up to `levels` reflections. An image is left out
/// where geometry forbids that any light passes: the light wholly behind the mirror, one mirror wholly behind the other.
pub(in crate::scene) fn relayed(
    lights: &[Light],
    mirrors: &[(SurfaceId, &Shape)],
    scene: &Scene,
    levels: u32,
) -> Vec<Light> {
    let mut images: Vec<Light> = Vec::new();
    let mut last: Vec<Light> = lights.to_vec();
    for _ in 0..levels {
        let mut next: Vec<Light> = Vec::new();
        for light in &last {
            for &(surface, shape) in mirrors {
                let Some((point, normal)) = shape.plane() else { continue };
                let plane = Plane { point, normal };
                if !may_relay(light, surface, shape, &plane, scene) {
                    continue;
                }
                let mut image = light.clone();
                image.relay.insert(0, surface);
                image.planes.insert(0, plane);
                next.push(image);
            }
        }
        images.extend(next.iter().cloned());
        last = next;
        if last.is_empty() {
            break;
        }
    }
    images
}

/// Whether light that comes from `light` (over its own mirrors) can reach the front of a mirror.
fn may_relay(light: &Light, mirror: SurfaceId, shape: &Shape, plane: &Plane, scene: &Scene) -> bool {
    match (light.relay.first(), light.source) {
        // The mirror that sends the light on: each must see part of the other's front.
        (Some(&sender), _) => {
            let sender_shape = &scene.surfaces[sender.index()].shape;
            sender != mirror
                && reaches_front(sender_shape, plane)
                && light.planes.first().is_some_and(|sending| reaches_front(shape, sending))
        }
        (None, SourceId::Surface(source)) => {
            let source_shape = &scene.surfaces[source.index()].shape;
            let faces =
                source_shape.plane().is_none_or(|(point, normal)| reaches_front(shape, &Plane { point, normal }));
            source != mirror && reaches_front(source_shape, plane) && faces
        }
        (None, SourceId::Far(far)) => scene.far[far.index()].rises_above(plane.normal),
    }
}

/// Whether any corner of the shape's bounds lies in front of the plane: false only if no point of the shape does.
fn reaches_front(shape: &Shape, plane: &Plane) -> bool {
    let [low, high] = shape.bounds();
    let furthest = DVec3::select(plane.normal.cmpgt(DVec3::ZERO), high, low);
    // A shape in the plane itself, computed with rounding, is not in front.
    let rounding = 1e-12 * (low.abs().max(high.abs()).max_element() + plane.point.abs().max_element());
    plane.height(furthest) > rounding
}
