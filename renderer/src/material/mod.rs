//! Radiance's materials: what each does with light. One file a material; formulas are those of the Radiance reference
//! manual.
//!
//! A hit is shaded in three steps, none of which allocates: an [`Emitter`] shows its radiance; direct light is weighed
//! by a [`Response`]; and [`Material::scatter`] names the [`Lobe`]s along which light arrives from elsewhere, each with
//! its [`Event`]. [`crate::component::Component::of`] turns the event into the bin.

mod anisotropic;
mod arguments;
mod ashikhmin;
mod bend;
mod dielectric;
mod emitter;
mod event;
mod fresnel;
mod functional;
mod glass;
mod interaction;
mod lobe;
mod metal;
mod mirror;
mod mist;
mod plastic;
mod prism;
mod response;
mod trans;
mod ward;
mod wgmd;

pub use anisotropic::{Anisotropic, Gloss};
pub use arguments::ArgumentError;
pub use ashikhmin::Ashikhmin;
pub use bend::Bend;
pub use dielectric::Dielectric;
pub use emitter::{Emitter, EmitterKind, Spot};
pub use event::Event;
pub use fresnel::{FRESNEL_OFFSET, FRESNEL_OFFSET_EXACT};
pub use functional::Functional;
pub use glass::Glass;
pub use interaction::Interaction;
pub use lobe::{GlossySampling, Lobe, Spread};
pub use metal::Metal;
pub use mirror::Mirror;
pub use mist::{MistArguments, MistId};
pub use plastic::Plastic;
pub use prism::Prism;
pub use response::Response;
pub use trans::Trans;
pub use wgmd::{Facet, Sheen, Wgmd};

use crate::color::Rgb;
use crate::component::{Component, ComponentSet};

/// Index of a material in `Scene::materials`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct MaterialId(pub u32);

impl MaterialId {
    /// The index.
    #[must_use]
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// The material that some rays see instead of a mirror or an illum: its string argument.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Alternate {
    /// None given.
    #[default]
    None,
    /// `void`: the surface is not there.
    Void,
    /// Another material.
    Material(MaterialId),
}

/// What a surface is made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Material {
    /// Diffuse colour under a white gloss.
    Plastic(Plastic),
    /// Diffuse colour under a gloss of that colour.
    Metal(Metal),
    /// Translucent sheet.
    Trans(Trans),
    /// Thin pane.
    Glass(Glass),
    /// Boundary of a refracting solid.
    Dielectric(Dielectric),
    /// Mirror that relays lights.
    Mirror(Mirror),
    /// `light`, `glow`, `spotlight` or `illum`.
    Emitter(Emitter),
    /// `plastic2`, `metal2` or `trans2` at a hit.
    Anisotropic(Anisotropic),
    /// `ashik2` at a hit.
    Ashikhmin(Ashikhmin),
    /// A material with a reflection function of its own, at a hit.
    Functional(Functional, ProgramId),
    /// `prism1` or `prism2` at a hit.
    Prism(Prism),
    /// `WGMDfunc` at a hit.
    Wgmd(Wgmd),
    /// One of those five, before functions have said what it is at a hit.
    Programmed(ProgramId),
    /// What cuts other solids away.
    Antimatter(AntimatterId),
    /// The boundary of mist.
    Mist(MistId),
    /// One of these under patterns and textures, or a mixture of two.
    Dressed(DressId),
}

/// Index of an antimatter in `Scene::antimatters`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct AntimatterId(pub u32);

impl AntimatterId {
    /// The index.
    #[must_use]
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// Index of a material's functions in `Scene::programs`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ProgramId(pub u32);

impl ProgramId {
    /// The index.
    #[must_use]
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// Index of a surface's modifiers in `Scene::dresses`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct DressId(pub u32);

impl DressId {
    /// The index.
    #[must_use]
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

impl Material {
    /// The same under a pattern. A dielectric's absorption takes none.
    #[must_use]
    pub fn tinted(self, tint: Rgb) -> Self {
        match self {
            Self::Plastic(plastic) => Self::Plastic(plastic.tinted(tint)),
            Self::Metal(metal) => Self::Metal(metal.tinted(tint)),
            Self::Trans(trans) => Self::Trans(trans.tinted(tint)),
            Self::Glass(glass) => Self::Glass(glass.tinted(tint)),
            Self::Mirror(mirror) => Self::Mirror(mirror.tinted(tint)),
            Self::Emitter(emitter) => Self::Emitter(emitter.tinted(tint)),
            Self::Dielectric(_)
            | Self::Anisotropic(_)
            | Self::Ashikhmin(_)
            | Self::Functional(..)
            | Self::Prism(_)
            | Self::Wgmd(_)
            | Self::Programmed(_)
            | Self::Antimatter(_)
            | Self::Mist(_)
            | Self::Dressed(_) => self,
        }
    }

    /// Whether Radiance counts the material as transparent: some light goes through it.
    #[must_use]
    pub fn is_transparent(&self) -> bool {
        matches!(self, Self::Trans(_) | Self::Glass(_) | Self::Dielectric(_))
    }

    /// The components that the material can spawn when `-st` is `threshold`. Alternates are materials of their own and
    /// not counted here.
    #[must_use]
    pub fn components(&self, threshold: f64) -> ComponentSet {
        // Every lobe that a material has shows at one of these angles, from outside or inside: fractions only
        // grow or fall with the angle.
        let mut components = ComponentSet::EMPTY;
        for cosine in [1.0, 0.5, 0.0_f64] {
            for side in [1.0, -1.0] {
                let incoming = glam::DVec3::new((1.0 - cosine * cosine).sqrt(), 0.0, -cosine * side);
                let interaction = Interaction::new(incoming, glam::DVec3::Z);
                self.scatter(interaction, threshold, |lobe| {
                    components = components.with(Component::of(lobe.event));
                });
            }
        }
        components
    }

    /// How the surface answers direct light; `None` for materials that light sources do not make visible.
    #[must_use]
    pub fn respond(&self, interaction: Interaction) -> Option<Response> {
        match self {
            Self::Plastic(plastic) => Some(plastic.respond(interaction)),
            Self::Metal(metal) => Some(metal.respond(interaction)),
            Self::Trans(trans) => Some(trans.respond(interaction)),
            _ => None,
        }
    }

    /// Gives each lobe of a hit to `spawn`, in a fixed order. A rough lobe of at most `threshold` (rpict's `-st`) joins
    /// the diffuse one.
    pub fn scatter(&self, interaction: Interaction, threshold: f64, spawn: impl FnMut(Lobe)) {
        match self {
            Self::Plastic(plastic) => plastic.respond(interaction).scatter(threshold, spawn),
            Self::Metal(metal) => metal.respond(interaction).scatter(threshold, spawn),
            Self::Trans(trans) => trans.respond(interaction).scatter(threshold, spawn),
            Self::Glass(glass) => glass.scatter(&interaction, spawn),
            Self::Dielectric(dielectric) => dielectric.scatter(&interaction, spawn),
            Self::Mirror(mirror) => mirror.scatter(&interaction, spawn),
            Self::Anisotropic(anisotropic) => anisotropic.scatter(&interaction, threshold, spawn),
            Self::Ashikhmin(ashikhmin) => ashikhmin.scatter(&interaction, threshold, spawn),
            Self::Functional(functional, _) => functional.scatter(&interaction, spawn),
            Self::Prism(prism) => prism.scatter(spawn),
            Self::Wgmd(wgmd) => wgmd.scatter(interaction.incoming, threshold, spawn),
            Self::Emitter(_) | Self::Programmed(_) | Self::Antimatter(_) | Self::Mist(_) | Self::Dressed(_) => {}
        }
    }
}

#[cfg(test)]
mod tests;
