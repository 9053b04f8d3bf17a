//! Spectral patterns, which become red, green and blue as in rpict without `-cs` (reference manual, 2.1.3).

use super::Reporter;
use super::fields::{self, Sources, Wrong};
use crate::color::Rgb;
use crate::pattern::{Field, Source, Spectrum, around, to_rgb};
use crate::rad::{Argument, Kind, Primitive};

/// `spectrum` or `specfile`: the same everywhere. `None` if it is wrong (with an error).
pub(super) fn fixed(primitive: &Primitive, sources: &mut Sources<'_, '_>, reporter: &mut Reporter) -> Option<Rgb> {
    let color = match primitive.kind {
        Kind::Spectrum => spectrum(primitive),
        _ => specfile(primitive, sources),
    };
    match color {
        Ok(color) => Some(color),
        Err((argument, message)) => {
            reporter.error(primitive, argument, format!("{} `{}`: {message}", primitive.kind, primitive.name));
            None
        }
    }
}

fn spectrum(primitive: &Primitive) -> Result<Rgb, Wrong> {
    let Some((&[first, last], values)) = primitive.reals.split_first_chunk::<2>() else {
        return Err((Argument::Kind, "expected two wavelengths and the values between them".to_owned()));
    };
    if values.len() < 3 {
        return Err((Argument::Kind, format!("expected at least 3 values, found {}", values.len())));
    }
    checked(values, first, last)
}

fn specfile(primitive: &Primitive, sources: &mut Sources<'_, '_>) -> Result<Rgb, Wrong> {
    let table = fields::table(primitive, 0, sources)?;
    if table.dimensions() != 1 {
        let message = format!("the data file has {} dimensions, expected one: the wavelength", table.dimensions());
        return Err((Argument::String(0), message));
    }
    let (first, last, count) = table.last_axis();
    let step = (last - first) / (count.max(2) - 1) as f64;
    let values: Vec<f64> = (0..count).map(|index| table.value(&[first + step * index as f64])[0]).collect();
    checked(&values, first, last).map_err(|(_, message)| (Argument::String(0), message))
}

/// The colour of values at points from `first` to `last`.
fn checked(values: &[f64], first: f64, last: f64) -> Result<Rgb, Wrong> {
    /// Beyond this the film could not hold a product.
    const LARGEST: f64 = 1e30;
    if first == last || values.len() < 2 {
        return Err((Argument::Kind, "the wavelengths span nothing".to_owned()));
    }
    if let Some(value) = values.iter().find(|value| !(0.0..=LARGEST).contains(*value)) {
        return Err((Argument::Kind, format!("a value is {value}, expected 0 to 1e30")));
    }
    let [from, to] = around(first, last, values.len());
    let color = Rgb::from(to_rgb(values, from, to));
    if color.is_finite() { Ok(color) } else { Err((Argument::Kind, "the wavelengths are too large".to_owned())) }
}

/// `specfunc` or `specdata`.
pub(super) fn varying(primitive: &Primitive, sources: &mut Sources<'_, '_>) -> Result<Field, Wrong> {
    let name = fields::string(primitive, 0, "a function's name")?;
    let lambda = |file: &str, most, sources: &mut Sources<'_, '_>| {
        let lambda = sources.library.lambda(file, name, most);
        lambda.map_err(|why| (Argument::String(0), format!("`{name}`: {why}")))
    };
    if primitive.kind == Kind::Specfunc {
        let Some(&[first, last]) = primitive.reals.first_chunk::<2>() else {
            return Err((Argument::Kind, "expected two wavelengths as real arguments".to_owned()));
        };
        let file = fields::function_file(primitive, 1, sources)?;
        let function = lambda(file, 1, sources)?;
        let spectrum = Spectrum::Function { function, from: first.min(last), to: first.max(last) };
        return fields::finished(primitive, Source::Spectrum { spectrum, coordinates: Vec::new() }, 2);
    }
    let table = fields::table(primitive, 1, sources)?;
    if table.dimensions() < 2 {
        return Err((Argument::String(1), "the data file has one dimension, expected at least 2".to_owned()));
    }
    let file = fields::function_file(primitive, 2, sources)?;
    let function = lambda(file, 2, sources)?;
    let count = table.dimensions() - 1;
    let coordinates = fields::expressions(primitive, 3, count, file, sources)?;
    let spectrum = Spectrum::Data { table, function };
    fields::finished(primitive, Source::Spectrum { spectrum, coordinates }, 3 + count)
}
