//! Direct light on materials that answer it by a law of their own.

use glam::DVec3;

use crate::color::Rgb;
use crate::material::{Interaction, Material};
use crate::pattern::Place;
use crate::sample::Sampler;
use crate::scene::reflection;

use super::direct::{Lit, Scratch};

impl Lit<'_> {
    /// Radiance that such a material sends back along the ray, of the light that all sources send it; `None` for those that
    /// lights do not show on. `bend` is what textures add to the normal.
    pub(super) fn own(
        &self,
        material: &Material,
        (interaction, place, bend): (&Interaction, &Place<'_>, DVec3),
        sampler: &Sampler,
        scratch: &mut Scratch,
    ) -> Option<Rgb> {
        match material {
            Material::Anisotropic(anisotropic) => {
                Some(self.light(|dir, size| anisotropic.direct(interaction, dir, size), sampler, scratch))
            }
            Material::Ashikhmin(ashikhmin) => {
                Some(self.light(|dir, size| ashikhmin.direct(interaction, dir, size), sampler, scratch))
            }
            Material::Wgmd(wgmd) if wgmd.takes_direct_light() => {
                Some(self.light(|dir, size| wgmd.direct(interaction.incoming, dir, size), sampler, scratch))
            }
            Material::Functional(functional, id) if functional.takes_direct_light() => {
                let reflection = reflection(place, bend, functional.color);
                let mut evaluator = self.scene.evaluator(std::mem::take(&mut scratch.own_memory))?;
                let direct = |dir, size| {
                    functional.direct(interaction, dir, size, || {
                        self.scene.law(*id, (dir, size), place, &reflection, &mut evaluator)
                    })
                };
                let light = self.light(direct, sampler, scratch);
                scratch.own_memory = evaluator.into_memory();
                Some(light)
            }
            _ => None,
        }
    }
}
