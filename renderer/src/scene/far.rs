//! `source`: something so far away that only its direction counts, as the sun and the sky.

use glam::DVec3;

use super::NameId;
use crate::material::MaterialId;

/// Index of a distant source in `Scene::far`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct FarId(pub u32);

impl FarId {
    /// The index.
    #[must_use]
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// A cone of directions that emits.
#[derive(Clone, Debug, PartialEq)]
pub struct FarSource {
    /// What it emits; always an emitter.
    pub material: MaterialId,
    /// Its identifier.
    pub name: NameId,
    axis: DVec3,
    versine: f64,
}

impl FarSource {
    /// A source around the unit vector `axis`, which points towards it, with a full angle in degrees: more than 0, at
    /// most 360.
    pub(super) fn new(material: MaterialId, name: NameId, axis: DVec3, angle_deg: f64) -> Self {
        // 1 - cos(a/2) = 2 sin^2(a/4): exact for a sun of half a degree and for a star.
        let sine = (angle_deg.to_radians() / 4.0).sin();
        Self { material, name, axis, versine: 2.0 * sine * sine }
    }

    /// Unit vector towards its centre.
    #[must_use]
    pub fn axis(&self) -> DVec3 {
        self.axis
    }

    /// 1 - cosine of its half angle; its solid angle is 2 pi times that.
    #[must_use]
    pub fn versine(&self) -> f64 {
        self.versine
    }

    /// Whether the unit vector `dir` points at it.
    #[must_use]
    pub fn contains(&self, dir: DVec3) -> bool {
        // |dir - axis|^2 = 2 (1 - cos), without the cancellation of 1 - cos.
        (dir - self.axis).length_squared() <= 2.0 * self.versine
    }

    /// Whether any of it shows above a plane of unit normal `normal`.
    pub(super) fn rises_above(&self, normal: DVec3) -> bool {
        self.versine >= 1.0 || self.axis.dot(normal) > -(self.versine * (2.0 - self.versine)).sqrt()
    }
}
