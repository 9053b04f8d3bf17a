//! `WGMDfunc`: modifiers, coefficients and roughness of reflection and transmission, the modifier of diffuse transmission,
//! an axis (reference manual, 2.1.2).

use super::fields::{self, Sources, Wrong};
use super::programs::{color, within};
use super::{Reporter, chain};
use crate::pattern::Source;
use crate::rad::{Argument, Primitive};
use crate::scene::wgmd::{Gloss, Parts, Wear};

/// Such a material; `None` if it is wrong (with an error).
pub(super) fn read(
    index: usize,
    primitive: &Primitive,
    sources: &mut Sources<'_, '_>,
    reporter: &mut Reporter,
) -> Option<Parts> {
    let wears = [0, 4, 8].map(|at| wear(index, primitive, at, sources, reporter));
    let [Some(reflected), Some(passed), Some(through)] = wears else { return None };
    match parts(primitive, [reflected, passed, through], sources) {
        Ok(parts) => Some(parts),
        Err((argument, message)) => {
            reporter.error(primitive, argument, format!("{} `{}`: {message}", primitive.kind, primitive.name));
            None
        }
    }
}

/// The patterns and textures that string argument `at` names.
fn wear(
    index: usize,
    primitive: &Primitive,
    at: usize,
    sources: &mut Sources<'_, '_>,
    reporter: &mut Reporter,
) -> Option<Wear> {
    if primitive.strings.get(at).is_some_and(|name| name == "inherit") {
        return Some(Wear::Main);
    }
    let modifier = chain::mixed(primitive, index, at, reporter)?;
    chain::steps(modifier, sources, reporter).map(|steps| Wear::Own(steps.into()))
}

fn parts(primitive: &Primitive, wears: [Wear; 3], sources: &mut Sources<'_, '_>) -> Result<Parts, Wrong> {
    within(primitive, 9, |_| 1e30)?;
    let file = fields::function_file(primitive, 12, sources)?;
    let mut field = |from: usize, count: usize| {
        let expressions = fields::expressions(primitive, from, count, file, sources)?;
        fields::finished(primitive, Source::Functions(expressions), 13)
    };
    let axis = field(9, 3)?;
    let mut gloss = |wear: Wear, at: usize| -> Result<Option<Gloss>, Wrong> {
        if fields::string(primitive, at, "a coefficient")? == "0" {
            return Ok(None);
        }
        Ok(Some(Gloss { wear, coefficient: field(at, 1)?, roughness: field(at + 1, 2)? }))
    };
    let [reflected, passed, through] = wears;
    let (reflected, passed) = (gloss(reflected, 1)?, gloss(passed, 5)?);
    if primitive.strings.len() < 13 {
        return Err((Argument::Kind, "expected 13 or more string arguments".to_owned()));
    }
    let reals = &primitive.reals;
    Ok(Parts { diffuse: [color(reals, 0), color(reals, 3), color(reals, 6)], through, reflected, passed, axis })
}
