//! Chains of modifiers: what stands before and after a material, and mixtures in place of one.

use std::collections::HashSet;

use super::Reporter;
use super::fields::{self, Sources};
use super::spectra;
use crate::pattern::Step;
use crate::rad::{Argument, Class, Kind, Primitive};

/// Whether a chain that starts at `modifier` leads to a material.
pub(super) fn leads_to_material(modifier: Option<usize>, reporter: &Reporter) -> bool {
    let document = reporter.document;
    let (mut open, mut seen) = (vec![modifier], HashSet::new());
    while let Some(next) = open.pop() {
        let Some(index) = next else { continue };
        if !seen.insert(index) {
            continue;
        }
        let primitive = &document.primitives[index];
        match primitive.kind.class() {
            Class::Material => return true,
            Class::Mixture => {
                open.extend([0, 1].map(|at| named(primitive, index, at, reporter).unwrap_or_default()));
                open.push(primitive.modifier);
            }
            _ => open.push(primitive.modifier),
        }
    }
    false
}

/// The modifier that string argument `at` names; `None` inside is `void`, `None` outside is no modifier.
pub(super) fn named(primitive: &Primitive, index: usize, at: usize, reporter: &Reporter) -> Option<Option<usize>> {
    match primitive.strings.get(at)?.as_str() {
        "void" => Some(None),
        name => reporter.document.modifier_named(name, index).map(Some),
    }
}

/// The steps of a chain that must hold no material, nearest to the surface first.
pub(super) fn steps(
    modifier: Option<usize>,
    sources: &mut Sources<'_, '_>,
    reporter: &mut Reporter,
) -> Option<Vec<Step>> {
    let document = reporter.document;
    let mut steps = Vec::new();
    let mut next = modifier;
    while let Some(index) = next {
        let primitive = &document.primitives[index];
        steps.push(step(index, primitive, sources, reporter)?);
        next = primitive.modifier;
    }
    Some(steps)
}

/// One pattern, texture, or mixture of those.
pub(super) fn step(
    index: usize,
    primitive: &Primitive,
    sources: &mut Sources<'_, '_>,
    reporter: &mut Reporter,
) -> Option<Step> {
    match primitive.kind.class() {
        Class::Material => {
            let message = format!("`{}` is a material already, and stands above another", primitive.name);
            reporter.error(primitive, Argument::Kind, message);
            None
        }
        Class::Mixture => {
            let mut side = |at: usize, reporter: &mut Reporter| {
                let modifier = mixed(primitive, index, at, reporter)?;
                steps(modifier, sources, reporter)
            };
            let (fore, back) = (side(0, reporter)?, side(1, reporter)?);
            let part = fields::read(primitive, sources, reporter)?;
            Some(Step::Blend { part, fore, back })
        }
        Class::Texture => fields::read(primitive, sources, reporter).map(Step::Bend),
        _ if matches!(primitive.kind, Kind::Spectrum | Kind::Specfile) => {
            spectra::fixed(primitive, sources, reporter).map(Step::Fixed)
        }
        _ => {
            let field = fields::read(primitive, sources, reporter)?;
            Some(Step::Tint(field))
        }
    }
}

/// A side of a mixture; `None` if it is wrong (with an error).
pub(super) fn mixed(primitive: &Primitive, index: usize, at: usize, reporter: &mut Reporter) -> Option<Option<usize>> {
    let side = named(primitive, index, at, reporter);
    if side.is_none() {
        let message = match primitive.strings.get(at) {
            Some(name) => format!("`{name}` is no modifier defined before this one; expected one, or void"),
            None => format!("{} `{}` names no modifiers to mix", Kind::keyword(primitive.kind), primitive.name),
        };
        reporter.error(primitive, Argument::String(at), message);
    }
    side
}
