//! Material primitives, built when a surface first uses them.

use std::collections::{BTreeSet, HashMap};

use super::Reporter;
use super::chain;
use super::fields::{self, Sources};
use super::files::Shelf;
use super::programs;
use crate::material::{
    Alternate, AntimatterId, ArgumentError, Dielectric, DressId, Emitter, Glass, Material, MaterialId, Metal, Mirror,
    MistId, Plastic, ProgramId, Trans,
};
use crate::pattern::Step;
use crate::rad::{self, Argument, Class, Files, Kind, Primitive};
use crate::scene::Scene;
use crate::scene::antimatter::Antimatter;
use crate::scene::dress::{Base, Dress, MOST_LAYERS};
use crate::scene::mist::MOST_MISTS;

/// The materials that were built, by their place in the document.
pub(super) struct Materials<'a> {
    built: HashMap<usize, Option<MaterialId>>,
    /// Dresses within dresses of those that have any.
    layers: HashMap<usize, usize>,
    /// Antimatter primitives.
    pub(super) antimatters: Vec<(usize, AntimatterId)>,
    /// Mist primitives.
    pub(super) mists: Vec<usize>,
    pub(super) shelf: Shelf<'a>,
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

impl<'a> Materials<'a> {
    pub(super) fn new(files: &'a dyn Files) -> Self {
        Self {
            built: HashMap::new(),
            layers: HashMap::new(),
            antimatters: Vec::new(),
            mists: Vec::new(),
            shelf: Shelf::new(files),
        }
    }

    /// For another document, with the same files.
    pub(super) fn another(&self) -> Self {
        Self::new(self.shelf.files())
    }

    /// The material in the chain of modifiers that starts at `modifier`, with what it wears; `None` if it has none, or is
    /// wrong (with an error). `user` is the primitive that asks.
    pub(super) fn of_modifier(
        &mut self,
        modifier: usize,
        user: usize,
        scene: &mut Scene,
        reporter: &mut Reporter,
    ) -> Option<MaterialId> {
        if let Some(&built) = self.built.get(&modifier) {
            return built;
        }
        // What a modifier names is defined before it, so in ascending order each finds its own built.
        let mut wanted = BTreeSet::new();
        let mut open = vec![modifier];
        while let Some(index) = open.pop() {
            if !self.built.contains_key(&index) && wanted.insert(index) {
                open.extend(needs(index, reporter));
            }
        }
        for index in wanted {
            let built = self.build(index, user, scene, reporter);
            self.built.insert(index, built);
        }
        self.built.get(&modifier).copied().flatten()
    }

    fn build(&mut self, index: usize, user: usize, scene: &mut Scene, reporter: &mut Reporter) -> Option<MaterialId> {
        let document = reporter.document;
        let primitive = &document.primitives[index];
        match primitive.kind.class() {
            Class::Material => {
                let material = if primitive.kind == Kind::Antimatter {
                    let over = primitive.strings.first().filter(|name| *name != "void");
                    let over = match over {
                        None => None,
                        Some(_) => chain::mixed(primitive, index, 0, reporter)?,
                    };
                    let over = over.and_then(|over| self.built.get(&over).copied().flatten());
                    let id = AntimatterId(u32::try_from(scene.antimatters.len()).ok()?);
                    scene.antimatters.push(Antimatter::new(over));
                    self.antimatters.push((index, id));
                    Material::Antimatter(id)
                } else if primitive.kind == Kind::Mist {
                    Material::Mist(self.mist(index, scene, reporter)?)
                } else if programs::is_programmed(primitive.kind) {
                    let program = self
                        .with_sources(scene, document, |sources| programs::read(index, primitive, sources, reporter))?;
                    let id = ProgramId(u32::try_from(scene.programs.len()).ok()?);
                    scene.programs.push(program);
                    Material::Programmed(id)
                } else {
                    self.material(index, reporter)?
                };
                let base = add(scene, material, user, reporter)?;
                if primitive.modifier.is_none() {
                    return Some(base);
                }
                let above = primitive.modifier.map(|above| &document.primitives[above]);
                if let Some(above) = above.filter(|above| above.kind.class() == Class::Material) {
                    let message =
                        format!("`{}` is a material already; its modifier `{}` is another", primitive.name, above.name);
                    reporter.error(primitive, Argument::Kind, message);
                    return None;
                }
                let steps =
                    self.with_sources(scene, document, |sources| chain::steps(primitive.modifier, sources, reporter))?;
                self.dress(index, steps, Base::Material(base), 0, user, scene, reporter)
            }
            Class::Mixture if chain::leads_to_material(Some(index), reporter) && mixes(index, reporter) => {
                if let Some(above) = primitive.modifier {
                    let message = format!(
                        "a mixture of materials has no modifier, this one has `{}`",
                        document.primitives[above].name
                    );
                    reporter.error(primitive, Argument::Modifier, message);
                    return None;
                }
                let (fore, back) =
                    (chain::mixed(primitive, index, 0, reporter)?, chain::mixed(primitive, index, 1, reporter)?);
                let layers = [fore, back].iter().flatten().filter_map(|side| self.layers.get(side)).max().copied();
                let [fore, back] =
                    [fore, back].map(|side| side.and_then(|side| self.built.get(&side).copied().flatten()));
                let part = self.with_sources(scene, document, |sources| fields::read(primitive, sources, reporter))?;
                let base = Base::Mixture { part: Box::new(part), fore, back };
                self.dress(index, Vec::new(), base, layers.unwrap_or(0), user, scene, reporter)
            }
            Class::Surface => None,
            _ => {
                let above = primitive.modifier?;
                let base = self.built.get(&above).copied().flatten()?;
                let layers = self.layers.get(&above).copied().unwrap_or(0);
                let step =
                    self.with_sources(scene, document, |sources| chain::step(index, primitive, sources, reporter))?;
                // One dress for all that stands around a material.
                if let Material::Dressed(id) = scene.materials[base.index()]
                    && let Base::Material(_) = scene.dresses[id.index()].base
                {
                    let inner = scene.dresses[id.index()].clone();
                    let steps = std::iter::once(step).chain(inner.steps.iter().cloned()).collect();
                    return self.dress(index, steps, inner.base, layers.saturating_sub(1), user, scene, reporter);
                }
                self.dress(index, vec![step], Base::Material(base), layers, user, scene, reporter)
            }
        }
    }

    #[allow(clippy::too_many_arguments, reason = "private, and all of them are needed")]
    fn dress(
        &mut self,
        index: usize,
        steps: Vec<Step>,
        base: Base,
        layers: usize,
        user: usize,
        scene: &mut Scene,
        reporter: &mut Reporter,
    ) -> Option<MaterialId> {
        let primitive = &reporter.document.primitives[index];
        let sides = match &base {
            Base::Material(base) => [Some(*base), None],
            Base::Mixture { fore, back, .. } => [*fore, *back],
        };
        if sides.into_iter().flatten().any(|base| matches!(scene.materials[base.index()], Material::Mist(_))) {
            let message = format!("`{}`: patterns and mixtures of mist are not supported", primitive.name);
            reporter.error(primitive, Argument::Kind, message);
            return None;
        }
        if layers >= MOST_LAYERS {
            let message = format!("mixtures within mixtures, more than {MOST_LAYERS} deep");
            reporter.error(primitive, Argument::Kind, message);
            return None;
        }
        self.layers.insert(index, layers + 1);
        let id = DressId(u32::try_from(scene.dresses.len()).ok()?);
        scene.dresses.push(Dress { steps: steps.into(), base });
        scene.library.get_or_insert_default();
        add(scene, Material::Dressed(id), user, reporter)
    }

    fn mist(&mut self, index: usize, scene: &mut Scene, reporter: &mut Reporter) -> Option<MistId> {
        let primitive = &reporter.document.primitives[index];
        let added = scene.add_mist(&primitive.reals, &primitive.strings);
        let added = added.map_err(|error| report_argument(primitive, &error, reporter)).ok()?;
        if added.is_none() {
            reporter.error(primitive, Argument::Kind, format!("the scene has more than {MOST_MISTS} kinds of mist"));
        }
        self.mists.push(index);
        added
    }

    /// Hands out what fields are read with.
    fn with_sources<T>(
        &mut self,
        scene: &mut Scene,
        document: &rad::Document,
        read: impl FnOnce(&mut Sources<'_, 'a>) -> T,
    ) -> T {
        let library = scene.library.get_or_insert_default();
        read(&mut Sources { shelf: &mut self.shelf, library, folders: &document.folders })
    }

    /// The material itself, without what it wears.
    fn material(&self, index: usize, reporter: &mut Reporter) -> Option<Material> {
        let primitive = &reporter.document.primitives[index];
        let reals = &primitive.reals;
        let built = match primitive.kind {
            Kind::Plastic => Plastic::from_reals(reals).map(Material::Plastic),
            Kind::Metal => Metal::from_reals(reals).map(Material::Metal),
            Kind::Trans => Trans::from_reals(reals).map(Material::Trans),
            Kind::Glass => Glass::from_reals(reals).map(Material::Glass),
            Kind::Dielectric => Dielectric::from_reals(reals).map(Material::Dielectric),
            Kind::Interface => Dielectric::interface(reals).map(Material::Dielectric),
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

fn add(scene: &mut Scene, material: Material, user: usize, reporter: &mut Reporter) -> Option<MaterialId> {
    let Ok(id) = u32::try_from(scene.materials.len()) else {
        let primitive = &reporter.document.primitives[user];
        reporter.error(primitive, Argument::Modifier, "the scene has more than 2^32 materials");
        return None;
    };
    scene.materials.push(material);
    Some(MaterialId(id))
}

/// Whether a mixture blends materials and not only what materials wear.
fn mixes(index: usize, reporter: &Reporter) -> bool {
    let primitive = &reporter.document.primitives[index];
    [0, 1].into_iter().any(|at| {
        let side = chain::named(primitive, index, at, reporter).flatten();
        chain::leads_to_material(side, reporter)
    })
}

/// The modifiers that must be built before one: a mirror's or illum's alternate, a mixture's materials, what stands above
/// a pattern.
fn needs(index: usize, reporter: &Reporter) -> Vec<usize> {
    let primitive = &reporter.document.primitives[index];
    let named = |at| chain::named(primitive, index, at, reporter).flatten();
    match primitive.kind.class() {
        Class::Material if matches!(primitive.kind, Kind::Mirror | Kind::Illum | Kind::Antimatter) => {
            named(0).into_iter().collect()
        }
        Class::Material | Class::Surface => Vec::new(),
        Class::Mixture if mixes(index, reporter) => [named(0), named(1)].into_iter().flatten().collect(),
        _ => primitive.modifier.into_iter().collect(),
    }
}

fn report_argument(primitive: &Primitive, error: &ArgumentError, reporter: &mut Reporter) {
    let argument = match error {
        ArgumentError::Count { .. } => Argument::Kind,
        ArgumentError::Range { position, .. } => Argument::Real(position - 1),
    };
    reporter.error(primitive, argument, format!("{} `{}`: {error}", primitive.kind, primitive.name));
}
