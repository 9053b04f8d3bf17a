//! Instances and meshes: many shapes that are one, placed in the scene by a transform and held once however often placed.

use std::fmt;
use std::sync::Arc;

use glam::DVec3;

use super::Probe;
use crate::geometry::{Aggregate, Hit, Ray, SurfaceId};
use crate::math::Similarity;

/// A placed set of shapes. Their surfaces have consecutive numbers in the scene.
#[derive(Clone)]
pub struct Placed(
    /// Apart, so that a shape of another kind takes no more room than it needs.
    Arc<Place>,
);

#[derive(Clone)]
struct Place {
    group: Arc<Aggregate>,
    to_scene: Similarity,
    to_group: Similarity,
    first: u32,
    bounds: [DVec3; 2],
}

impl fmt::Debug for Placed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} shapes placed by {:?}", self.0.group.len(), self.0.to_scene)
    }
}

impl PartialEq for Placed {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0.group, &other.0.group)
            && self.0.to_scene == other.0.to_scene
            && self.0.first == other.0.first
    }
}

impl Placed {
    /// Places `group`, which lies within `bounds` in its own coordinates; its surface n has the number `first` + n.
    #[must_use]
    pub fn new(group: Arc<Aggregate>, to_scene: Similarity, first: u32, [low, high]: [DVec3; 2]) -> Self {
        let corner = |n: usize| {
            let pick = |axis: usize| if n >> axis & 1 == 0 { low[axis] } else { high[axis] };
            to_scene.point(DVec3::new(pick(0), pick(1), pick(2)))
        };
        let bounds = (0..8)
            .map(corner)
            .fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |[low, high], corner| [low.min(corner), high.max(corner)]);
        Self(Arc::new(Place { group, to_group: to_scene.inverse(), to_scene, first, bounds }))
    }

    /// From the scene's coordinates to the group's own.
    #[must_use]
    pub fn to_group(&self) -> &Similarity {
        &self.0.to_group
    }

    /// Number of its first surface.
    #[must_use]
    pub fn first(&self) -> u32 {
        self.0.first
    }

    /// The same set with other numbers, the first being `first`.
    #[must_use]
    pub fn numbered(self, first: u32) -> Self {
        Self(Arc::new(Place { first, ..Arc::unwrap_or_clone(self.0) }))
    }

    /// The nearest hit beyond `t_min`, in the group's coordinates but for its distance.
    fn nearest(&self, origin: DVec3, dir: DVec3, t_min: f64, t_max: f64) -> Option<Hit> {
        let scale = self.0.to_group.scale;
        let ray = Ray::new(self.0.to_group.point(origin + dir * t_min), self.0.to_group.direction(dir).normalize());
        let hit = self.0.group.closest(&ray.up_to((t_max - t_min) * scale))?;
        let t = t_min + hit.t / scale;
        (t > t_min && t < t_max).then_some(Hit { t, ..hit })
    }

    pub(super) fn meet(&self, probe: &Probe, t_min: f64, t_max: f64) -> Option<f64> {
        self.nearest(probe.origin, probe.dir, t_min, t_max).map(|hit| hit.t)
    }

    /// The nearest hit beyond `t_min` in the scene's coordinates.
    #[must_use]
    pub fn hit(&self, ray: &Ray, t_min: f64) -> Option<Hit> {
        let hit = self.nearest(ray.origin, ray.dir, t_min, f64::INFINITY)?;
        Some(Hit {
            t: hit.t,
            point: self.0.to_scene.point(hit.point),
            normal: self.0.to_scene.direction(hit.normal).normalize(),
            surface: SurfaceId(self.0.first + hit.surface.0),
        })
    }

    pub(super) fn bounds(&self) -> [DVec3; 2] {
        self.0.bounds
    }
}
