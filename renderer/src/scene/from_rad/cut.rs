//! Which surfaces antimatter cuts away: those whose own modifier it names.

use super::Builder;
use crate::geometry::SurfaceId;

impl Builder<'_> {
    pub(super) fn cut(&mut self) {
        for (index, id) in std::mem::take(&mut self.materials.antimatters) {
            let primitive = &self.document.primitives[index];
            let listed: Vec<usize> = primitive
                .strings
                .iter()
                .filter(|name| *name != "void")
                .filter_map(|name| self.document.modifier_named(name, index))
                .collect();
            let with = |wanted: &dyn Fn(usize) -> bool| -> Vec<SurfaceId> {
                self.placed_by.iter().filter(|(_, modifier)| wanted(*modifier)).map(|&(surface, _)| surface).collect()
            };
            let (own, solids) = (with(&|modifier| modifier == index), with(&|modifier| listed.contains(&modifier)));
            self.scene.set_antimatter(id, &own, &solids);
        }
    }
}
