//! Material primitives, built when a surface first uses them.

use std::collections::{BTreeSet, HashMap};

use super::Reporter;
use crate::material::{
    Alternate, ArgumentError, Dielectric, Emitter, Glass, Material, MaterialId, Metal, Mirror, Plastic, Trans,
};
use crate::rad::{Argument, Class, Kind, Primitive};

/// The materials that were built, by their place in the document.
#[derive(Default)]
pub(super) struct Materials {
    built: HashMap<usize, Option<MaterialId>>,
}

/// What is said of a type that the renderer cannot draw.
pub(super) fn unsupported(primitive: &Primitive) -> String {
    format!("{} `{}`: the type `{}` is not supported yet", class_word(primitive), primitive.name, primitive.kind)
}

fn class_word(primitive: &Primitive) -> &'static str {
    match primitive.kind.class() {
        Class::Surface => "surface",
        Class::Material => "material",
        Class::Pattern => "pattern",
        Class::Texture => "texture",
        Class::Mixture => "mixture",
    }
}

impl Materials {
    /// The material in the chain of modifiers that starts at `modifier`; `None` if it has none, or is wrong
    /// (with an error). `user` is the primitive that asks.
    pub(super) fn of_modifier(
        &mut self,
        modifier: usize,
        user: usize,
        materials: &mut Vec<Material>,
        reporter: &mut Reporter,
    ) -> Option<MaterialId> {
        if let Some(&built) = self.built.get(&modifier) {
            return built;
        }
        // Alternates are defined before who names them, so in ascending order each finds its own built.
        let mut wanted = BTreeSet::new();
        let mut open = vec![modifier];
        while let Some(index) = open.pop() {
            if !self.built.contains_key(&index) && wanted.insert(index) {
                open.extend(alternate_of(index, reporter));
            }
        }
        for index in wanted {
            let built = self.build(index, reporter).and_then(|material| {
                let Ok(id) = u32::try_from(materials.len()) else {
                    let primitive = &reporter.document.primitives[user];
                    reporter.error(primitive, Argument::Modifier, "the scene has more than 2^32 materials");
                    return None;
                };
                materials.push(material);
                Some(MaterialId(id))
            });
            self.built.insert(index, built);
        }
        self.built.get(&modifier).copied().flatten()
    }

    fn build(&self, index: usize, reporter: &mut Reporter) -> Option<Material> {
        let primitive = &reporter.document.primitives[index];
        if primitive.kind.class() != Class::Material {
            reporter.error(primitive, Argument::Kind, unsupported(primitive));
            return None;
        }
        if let Some(above) = primitive.modifier {
            let above = &reporter.document.primitives[above];
            let message = if above.kind.class() == Class::Material {
                format!("`{}` is a material already; its modifier `{}` is another", primitive.name, above.name)
            } else {
                unsupported(above)
            };
            let at = if above.kind.class() == Class::Material { primitive } else { above };
            reporter.error(at, Argument::Kind, message);
            return None;
        }
        let reals = &primitive.reals;
        let built = match primitive.kind {
            Kind::Plastic => Plastic::from_reals(reals).map(Material::Plastic),
            Kind::Metal => Metal::from_reals(reals).map(Material::Metal),
            Kind::Trans => Trans::from_reals(reals).map(Material::Trans),
            Kind::Glass => Glass::from_reals(reals).map(Material::Glass),
            Kind::Dielectric => Dielectric::from_reals(reals).map(Material::Dielectric),
            Kind::Mirror => Mirror::from_reals(reals, self.alternate(index, reporter)?).map(Material::Mirror),
            Kind::Light => Emitter::light(reals).map(Material::Emitter),
            Kind::Glow => Emitter::glow(reals).map(Material::Emitter),
            Kind::Spotlight => Emitter::spotlight(reals).map(Material::Emitter),
            Kind::Illum => Emitter::illum(reals, self.alternate(index, reporter)?).map(Material::Emitter),
            _ => {
                reporter.error(primitive, Argument::Kind, unsupported(primitive));
                return None;
            }
        };
        built.map_err(|error| report_argument(primitive, &error, reporter)).ok()
    }

    /// The alternate of a mirror or illum, built before; `None` if it is wrong.
    fn alternate(&self, index: usize, reporter: &mut Reporter) -> Option<Alternate> {
        let primitive = &reporter.document.primitives[index];
        match primitive.strings.first().map(String::as_str) {
            None => Some(Alternate::None),
            Some("void") => Some(Alternate::Void),
            Some(name) => {
                let Some(alternate) = reporter.document.modifier_named(name, index) else {
                    let message = format!("`{name}` is no material defined before this one; expected one, or void");
                    reporter.error(primitive, Argument::String(0), message);
                    return None;
                };
                // An error in the alternate itself was reported when it was built.
                self.built.get(&alternate).copied().flatten().map(Alternate::Material)
            }
        }
    }
}

/// The primitive that a mirror or illum names as its alternate.
fn alternate_of(index: usize, reporter: &Reporter) -> Option<usize> {
    let primitive = &reporter.document.primitives[index];
    if !matches!(primitive.kind, Kind::Mirror | Kind::Illum) {
        return None;
    }
    primitive
        .strings
        .first()
        .filter(|name| *name != "void")
        .and_then(|name| reporter.document.modifier_named(name, index))
}

fn report_argument(primitive: &Primitive, error: &ArgumentError, reporter: &mut Reporter) {
    let argument = match error {
        ArgumentError::Count { .. } => Argument::Kind,
        ArgumentError::Range { position, .. } => Argument::Real(position - 1),
    };
    reporter.error(primitive, argument, format!("{} `{}`: {error}", primitive.kind, primitive.name));
}
