//! Virtual lights: the images of lights in flat mirrors and prisms (`rpict(1)`, `-dr`).

use glam::DVec3;

use super::turn::{Plane, Turn};
use super::{Light, LightSample};
use crate::color::Rgb;
use crate::geometry::shape::Probe;
use crate::geometry::{Hit, Ray, Shape, SurfaceId};
use crate::material::{EmitterKind, Material, MaterialId, ProgramId};
use crate::math::tolerance;
use crate::pattern::{Memory, Place};
use crate::scene::{Scene, SourceId};

/// What relays light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::scene) enum Sheet {
    /// A mirror.
    Mirror,
    /// A prism.
    Prism(ProgramId),
}

/// One straight piece of the way from a lit point to a light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Leg {
    /// The piece; it ends at the mirror, the prism or the light, infinitely far for distant sources.
    pub ray: Ray,
    /// The surface at its end, which is no obstacle.
    pub target: Option<SurfaceId>,
    /// What the mirror or prism at its end leaves of the light; 1 on the last piece.
    pub left: Rgb,
}

impl Light {
    /// Lays out the way of a sample taken at `start.origin`, from mirror to mirror; `start` also names the surface that is
    /// lit. `legs` is cleared and filled. `None` if the way misses one of the mirrors: then no light comes.
    pub fn legs(
        &self,
        scene: &Scene,
        start: Ray,
        sample: &LightSample,
        memory: &mut Memory,
        legs: &mut Vec<Leg>,
    ) -> Option<()> {
        legs.clear();
        let mut ray = Ray { dir: sample.dir, ..start };
        let mut left = sample.distance;
        let mut bent = false;
        for (index, (&surface, turn)) in self.relay.iter().zip(&self.turns).enumerate() {
            let hit = met(scene, &ray, surface, left)?;
            let (dir, passes) = self.turn(index, scene, &ray, &hit, memory)?;
            legs.push(Leg { ray: ray.up_to(hit.t), target: Some(surface), left: passes });
            ray = Ray::new(hit.point, dir).leaving(surface);
            bent |= matches!(turn, Turn::Prism(_));
            // How far the light is behind a prism is found out.
            left = if bent { f64::INFINITY } else { left - hit.t };
        }
        if bent {
            left = self.distance(scene, &ray)?;
        }
        let target = match self.source {
            SourceId::Surface(surface) => Some(surface),
            SourceId::Far(_) => None,
        };
        legs.push(Leg { ray: ray.up_to(left), target, left: Rgb::ONE });
        Some(())
    }

    /// Where the mirror or prism `index` of the relay sends a ray that meets it, and what is left of the radiance from
    /// there; `None`: nothing.
    pub(crate) fn turn(
        &self,
        index: usize,
        scene: &Scene,
        ray: &Ray,
        hit: &Hit,
        memory: &mut Memory,
    ) -> Option<(DVec3, Rgb)> {
        match self.turns.get(index)? {
            Turn::Mirror(plane) => {
                if ray.dir.dot(plane.normal) >= 0.0 {
                    return None;
                }
                let material = scene.surface(hit.surface).material?;
                Some((plane.reflect_direction(ray.dir), mirrored(scene, material, &met_at(ray, hit), memory)?))
            }
            Turn::Prism(shear) => {
                let to_light = shear.aim.from(hit.point)?;
                let (dir, coefficient) = scene.redirected(shear.way, &met_at(ray, hit), to_light, memory)?;
                Some((dir, Rgb::splat(coefficient)))
            }
        }
    }

    /// How far along a ray that a prism has bent the light's front is; `None` if the ray misses it.
    fn distance(&self, scene: &Scene, ray: &Ray) -> Option<f64> {
        let distance = match self.source {
            SourceId::Surface(surface) => {
                let hit = met(scene, ray, surface, f64::INFINITY)?;
                hit.is_front(ray.dir).then_some(hit.t)?
            }
            SourceId::Far(far) => scene.far[far.index()].contains(ray.dir).then_some(f64::INFINITY)?,
        };
        match self.emitter.kind() {
            EmitterKind::Spot(spot) => spot.contains(-ray.dir).then_some(distance),
            _ => Some(distance),
        }
    }
}

/// A hit on a surface of the scene's own as functions see it.
fn met_at(ray: &Ray, hit: &Hit) -> Place<'static> {
    Place { point: hit.point, dir: ray.dir, normal: hit.normal, distance: hit.t, uv: None, object: None }
}

/// What a mirror leaves of the light that it relays, under its patterns.
fn mirrored(scene: &Scene, material: MaterialId, place: &Place<'_>, memory: &mut Memory) -> Option<Rgb> {
    match &scene.materials[material.index()] {
        Material::Mirror(mirror) => Some(mirror.reflectance()),
        Material::Dressed(id) => {
            let left = mirrored(scene, scene.base(*id)?, place, memory)?;
            Some(left * scene.tint(*id, place, memory))
        }
        _ => None,
    }
}

/// Where a ray meets one surface of the scene's own before `most`.
fn met(scene: &Scene, ray: &Ray, surface: SurfaceId, most: f64) -> Option<Hit> {
    let shape = &scene.surfaces[surface.index()].shape;
    let t_min = tolerance::least_distance(ray.origin, 0.0);
    let t = shape.meet(&Probe::new(ray.origin, ray.dir), ray.leaving == Some(surface), t_min, most)?;
    let (point, normal) = shape.settle(ray.at(t));
    Some(Hit { t, point, normal, surface })
}

/// The images of every light in `lights` in the flat sheets of `sheets`, over up to `levels` of them. An image is left out
/// where geometry forbids that any light passes: the light wholly behind the mirror, one mirror wholly behind the other.
pub(in crate::scene) fn relayed(
    lights: &[Light],
    sheets: &[(SurfaceId, Sheet)],
    scene: &Scene,
    levels: u32,
) -> Vec<Light> {
    let mut images: Vec<Light> = Vec::new();
    let mut last: Vec<Light> = lights.to_vec();
    for _ in 0..levels {
        let mut next: Vec<Light> = Vec::new();
        for light in &last {
            for &(surface, sheet) in sheets {
                let mut image = |turn| {
                    let mut image = light.clone();
                    image.relay.insert(0, surface);
                    image.turns.insert(0, turn);
                    next.push(image);
                };
                let shape = &scene.surfaces[surface.index()].shape;
                match sheet {
                    Sheet::Mirror => {
                        let Some((point, normal)) = shape.plane() else { continue };
                        let plane = Plane { point, normal };
                        if may_relay(light, surface, shape, &plane, scene) {
                            image(Turn::Mirror(plane));
                        }
                    }
                    Sheet::Prism(prism) => {
                        let itself = light.relay.first() == Some(&surface)
                            || (light.relay.is_empty() && light.source == SourceId::Surface(surface));
                        let ways = if itself { 0 } else { scene.ways(prism) };
                        for way in 0..ways {
                            if let Some(turn) = Turn::of_prism(scene, shape, light, (prism, way)) {
                                image(turn);
                            }
                        }
                    }
                }
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
    match (light.relay.first().zip(light.turns.first()), light.source) {
        // The mirror that sends the light on: each must see part of the other's front.
        (Some((&sender, turn)), _) => {
            let sender_shape = &scene.surfaces[sender.index()].shape;
            let sees = match turn {
                Turn::Mirror(sending) => reaches_front(shape, sending),
                // Which side a prism sends light to its functions say.
                Turn::Prism(_) => true,
            };
            sender != mirror && reaches_front(sender_shape, plane) && sees
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
