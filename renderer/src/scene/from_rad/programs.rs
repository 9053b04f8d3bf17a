//! Materials with functions: `plastic2` and kin, `ashik2`, `plasfunc` and kin, `BRTDfunc`, prisms (reference manual, 2.1.2).

use super::fields::{self, Sources, Wrong};
use super::{Reporter, wgmd};
use crate::color::Rgb;
use crate::material::{Anisotropic, ArgumentError, Ashikhmin, Gloss};
use crate::pattern::{Form, Law, Source};
use crate::rad::{Argument, Kind, Primitive};
use crate::scene::program::{Program, Way};

/// Whether a material asks functions what it is.
pub(super) fn is_programmed(kind: Kind) -> bool {
    matches!(
        kind,
        Kind::Plastic2
            | Kind::Metal2
            | Kind::Trans2
            | Kind::Ashik2
            | Kind::Plasfunc
            | Kind::Metfunc
            | Kind::Transfunc
            | Kind::Plasdata
            | Kind::Metdata
            | Kind::Transdata
            | Kind::BrtdFunc
            | Kind::Prism1
            | Kind::WgmdFunc
            | Kind::Prism2
    )
}

/// Such a material; `None` if it is wrong (with an error).
pub(super) fn read(
    index: usize,
    primitive: &Primitive,
    sources: &mut Sources<'_, '_>,
    reporter: &mut Reporter,
) -> Option<Program> {
    if primitive.kind == Kind::WgmdFunc {
        return wgmd::read(index, primitive, sources, reporter).map(|parts| Program::Wgmd(Box::new(parts)));
    }
    match program(primitive, sources) {
        Ok(program) => Some(program),
        Err((argument, message)) => {
            reporter.error(primitive, argument, format!("{} `{}`: {message}", primitive.kind, primitive.name));
            None
        }
    }
}

fn argument(error: ArgumentError) -> Wrong {
    let argument = match error {
        ArgumentError::Count { .. } => Argument::Kind,
        ArgumentError::Range { position, .. } => Argument::Real(position - 1),
    };
    (argument, error.to_string())
}

fn program(primitive: &Primitive, sources: &mut Sources<'_, '_>) -> Result<Program, Wrong> {
    let reals = &primitive.reals;
    match primitive.kind {
        Kind::Plastic2 | Kind::Metal2 | Kind::Trans2 => {
            let gloss = if primitive.kind == Kind::Metal2 { Gloss::Colored } else { Gloss::White };
            let material = Anisotropic::from_reals(reals, gloss, primitive.kind == Kind::Trans2).map_err(argument)?;
            Ok(Program::Anisotropic(material, fields::functions(primitive, 0, 3, sources)?))
        }
        Kind::Ashik2 => {
            let material = Ashikhmin::from_reals(reals).map_err(argument)?;
            Ok(Program::Ashikhmin(material, fields::functions(primitive, 0, 3, sources)?))
        }
        Kind::Prism1 => prism(primitive, 1, sources),
        Kind::Prism2 => prism(primitive, 2, sources),
        Kind::BrtdFunc => free(primitive, sources),
        _ => parts(primitive, sources),
    }
}

/// Real arguments that must be there and in [0, most].
pub(super) fn within(primitive: &Primitive, count: usize, most: impl Fn(usize) -> f64) -> Result<(), Wrong> {
    let reals = &primitive.reals;
    if reals.len() < count {
        return Err((Argument::Kind, format!("expected {count} or more real arguments, found {}", reals.len())));
    }
    match (0..count).find(|&at| !(0.0..=most(at)).contains(&reals[at])) {
        Some(at) => {
            let message = format!("real argument {} is {}, expected 0 to {}", at + 1, reals[at], most(at));
            Err((Argument::Real(at), message))
        }
        None => Ok(()),
    }
}

pub(super) fn color(reals: &[f64], at: usize) -> Rgb {
    Rgb::from_slice(&reals[at..at + 3])
}

fn parts(primitive: &Primitive, sources: &mut Sources<'_, '_>) -> Result<Program, Wrong> {
    let passes = matches!(primitive.kind, Kind::Transfunc | Kind::Transdata);
    within(primitive, if passes { 6 } else { 4 }, |at| if at < 3 { f64::MAX } else { 1.0 })?;
    let reals = &primitive.reals;
    let data = matches!(primitive.kind, Kind::Plasdata | Kind::Metdata | Kind::Transdata);
    let name = fields::string(primitive, 0, "a function's name")?;
    let function = |file: &str, at: usize, name: &str, most, sources: &mut Sources<'_, '_>| {
        let lambda = sources.library.lambda(file, name, most);
        lambda.map_err(|why| (Argument::String(at), format!("`{name}`: {why}")))
    };
    let (form, transform_at) = if data {
        let table = fields::table(primitive, 1, sources)?;
        let file = fields::function_file(primitive, 2, sources)?;
        let coordinates = (3..3 + table.dimensions())
            .map(|at| function(file, at, fields::string(primitive, at, "a function's name")?, 4, sources))
            .collect::<Result<Vec<_>, Wrong>>()?;
        let finish = function(file, 0, name, 5, sources)?;
        let transform_at = 3 + table.dimensions();
        (Form::Data { table, coordinates, finish }, transform_at)
    } else {
        let file = fields::function_file(primitive, 1, sources)?;
        (Form::Functions([Some(function(file, 0, name, 4, sources)?); 3]), 2)
    };
    let law = Law { form, to_local: fields::transform(primitive, transform_at)?, reals: reals.as_slice().into() };
    Ok(Program::Parts {
        color: color(reals, 0),
        specular: reals[3],
        transmitted: if passes { reals[4] } else { 0.0 },
        transmitted_specular: if passes { reals[5] } else { 0.0 },
        metallic: matches!(primitive.kind, Kind::Metfunc | Kind::Metdata),
        law,
    })
}

/// For each way a coefficient and a direction, then the function file.
fn prism(primitive: &Primitive, ways: usize, sources: &mut Sources<'_, '_>) -> Result<Program, Wrong> {
    let file = fields::function_file(primitive, 4 * ways, sources)?;
    let ways = (0..ways).map(|way| {
        let mut field = |from, count| {
            let expressions = fields::expressions(primitive, from, count, file, sources)?;
            fields::finished(primitive, Source::Functions(expressions), 4 * ways + 1)
        };
        Ok(Way { coefficient: field(4 * way, 1)?, direction: field(4 * way + 1, 3)? })
    });
    ways.collect::<Result<Vec<_>, Wrong>>().map(Program::Prism)
}

fn free(primitive: &Primitive, sources: &mut Sources<'_, '_>) -> Result<Program, Wrong> {
    within(primitive, 9, |_| f64::MAX)?;
    let reals = &primitive.reals;
    let file = fields::function_file(primitive, 9, sources)?;
    let field = |from: usize, sources: &mut Sources<'_, '_>| -> Result<_, Wrong> {
        let expressions = fields::expressions(primitive, from, 3, file, sources)?;
        fields::finished(primitive, Source::Functions(expressions), 10)
    };
    let (mirrored, passed) = (field(0, sources)?, field(3, sources)?);
    let mut functions = [None; 3];
    for (channel, function) in functions.iter_mut().enumerate() {
        let name = fields::string(primitive, 6 + channel, "a function's name, or 0")?;
        if name != "0" {
            let lambda = sources.library.lambda(file, name, 4);
            *function = Some(lambda.map_err(|why| (Argument::String(6 + channel), format!("`{name}`: {why}")))?);
        }
    }
    let law = functions.iter().any(Option::is_some).then_some(Law {
        form: Form::Functions(functions),
        to_local: fields::transform(primitive, 10)?,
        reals: reals.as_slice().into(),
    });
    Ok(Program::Free { diffuse: [color(reals, 0), color(reals, 3), color(reals, 6)], mirrored, passed, law })
}
