//! `antimatter`: volumes in which solids of some modifiers are not there (Radiance reference manual).
//!
//! Radiance's rays remember which volumes they have entered. Here a point's own place decides: it lies in a volume if, back
//! along the ray, the volume's surface has been entered more often than left. So rays carry nothing, and only surfaces that
//! some antimatter lists ask.

use glam::DVec3;

use super::Scene;
use crate::geometry::{Aggregate, Hit, Ray, SurfaceId};
use crate::material::{AntimatterId, Material, MaterialId};

/// Surfaces of a volume that a line may cross.
const MOST_CROSSINGS: usize = 1000;

/// A kind of antimatter.
#[derive(Debug)]
pub(super) struct Antimatter {
    /// What its surface shows where it cuts a solid; `None`: nothing.
    face: Option<MaterialId>,
    /// Its own surfaces, and those that it cuts away.
    volume: Aggregate,
    solids: Aggregate,
}

impl Antimatter {
    pub(super) fn new(face: Option<MaterialId>) -> Self {
        Self { face, volume: Aggregate::new([]), solids: Aggregate::new([]) }
    }
}

/// How many of the closed volumes that the shapes bound a point lies in, seen along the unit vector `dir`.
fn depth(shapes: &Aggregate, point: DVec3, dir: DVec3) -> i32 {
    let mut depth = 0;
    let mut back = Ray::new(point, -dir);
    for _ in 0..MOST_CROSSINGS {
        let Some(hit) = shapes.closest(&back) else { break };
        // Who goes along `dir` enters where the front faces it.
        depth += if hit.is_front(dir) { 1 } else { -1 };
        back = Ray::new(hit.point, -dir).leaving(hit.surface);
    }
    depth
}

impl Scene {
    /// Whether antimatter cuts a surface away where a ray of direction `dir` meets it.
    #[must_use]
    pub fn is_cut_away(&self, hit: &Hit, dir: DVec3) -> bool {
        if self.cut_by.is_empty() {
            return false;
        }
        let Some(by) = self.cut_by.get(&hit.surface) else { return false };
        by.iter().any(|id| depth(&self.antimatters[id.index()].volume, hit.point, dir) > 0)
    }

    /// The material that antimatter shows where its surface cuts a solid; `None` if it is not seen there.
    #[must_use]
    pub fn cut(&self, id: AntimatterId, hit: &Hit, dir: DVec3) -> Option<&Material> {
        let antimatter = &self.antimatters[id.index()];
        let face = antimatter.face?;
        // It shows from within only: from outside the solid itself is met.
        let inside = !hit.is_front(dir) && depth(&antimatter.solids, hit.point, dir) > 0;
        inside.then(|| &self.materials[face.index()])
    }

    /// Says what an antimatter consists of and cuts away.
    pub(super) fn set_antimatter(&mut self, id: AntimatterId, own: &[SurfaceId], solids: &[SurfaceId]) {
        let items = |ids: &[SurfaceId]| -> Vec<_> {
            self.items(&self.surfaces, &self.groups).filter(|item| ids.binary_search(&item.surface).is_ok()).collect()
        };
        let (volume, cut) = (Aggregate::new(items(own)), Aggregate::new(items(solids)));
        let antimatter = &mut self.antimatters[id.index()];
        (antimatter.volume, antimatter.solids) = (volume, cut);
        for &solid in solids {
            self.cut_by.entry(solid).or_default().push(id);
        }
    }
}
