//! The fields of patterns, textures and mixtures: reference manual, sections 2.1.3 to 2.1.5.

use std::sync::Arc;

use glam::DVec3;

use super::files::Shelf;
use super::{Reporter, spectra};
use crate::math::Similarity;
use crate::pattern::{Applied, Field, Library, Source, Spacing, Table, Text};
use crate::rad::{Argument, Kind, Primitive, Transform};

/// An argument that is wrong, and how.
pub(super) type Wrong = (Argument, String);

/// What fields are read with.
pub(super) struct Sources<'a, 'b> {
    pub(super) shelf: &'a mut Shelf<'b>,
    pub(super) library: &'a mut Library,
    pub(super) folders: &'a [String],
}

/// The field of a primitive; `None` if it is wrong (with an error).
pub(super) fn read(primitive: &Primitive, sources: &mut Sources<'_, '_>, reporter: &mut Reporter) -> Option<Field> {
    match field(primitive, sources) {
        Ok(field) => Some(field),
        Err((argument, message)) => {
            let message = format!("{} `{}`: {message}", primitive.kind, primitive.name);
            reporter.error(primitive, argument, message);
            None
        }
    }
}

fn field(primitive: &Primitive, sources: &mut Sources<'_, '_>) -> Result<Field, Wrong> {
    match primitive.kind {
        Kind::Brightfunc => functions(primitive, 0, 1, sources),
        Kind::Colorfunc | Kind::Texfunc => functions(primitive, 0, 3, sources),
        Kind::Mixfunc => functions(primitive, 2, 1, sources),
        Kind::Brightdata => data(primitive, 0, 1, sources),
        Kind::Colordata | Kind::Texdata => data(primitive, 0, 3, sources),
        Kind::Mixdata => data(primitive, 2, 1, sources),
        Kind::Colorpict => picture(primitive, 0, 3, sources),
        Kind::Mixpict => picture(primitive, 2, 1, sources),
        Kind::Specfunc | Kind::Specdata => spectra::varying(primitive, sources),
        Kind::Brighttext => text(primitive, 0, Some(1), sources),
        Kind::Colortext => text(primitive, 0, Some(3), sources),
        Kind::Mixtext => text(primitive, 2, None, sources),
        _ => Err((Argument::Kind, super::materials::unsupported(primitive))),
    }
}

/// A string argument.
pub(super) fn string<'a>(primitive: &'a Primitive, at: usize, what: &str) -> Result<&'a str, Wrong> {
    let given = primitive.strings.get(at).map(String::as_str);
    given.ok_or_else(|| (Argument::Kind, format!("string argument {} is missing: {what}", at + 1)))
}

/// Reads the function file that string argument `at` names, unless it is `.`.
pub(super) fn function_file<'a>(
    primitive: &'a Primitive,
    at: usize,
    sources: &mut Sources<'_, '_>,
) -> Result<&'a str, Wrong> {
    let name = string(primitive, at, "the function file, or `.`")?;
    if name != "." && !sources.library.knows(name) {
        let text = sources
            .shelf
            .functions(name, sources.folders)
            .map_err(|why| (Argument::String(at), format!("the function file `{name}` {why}")))?;
        sources.library.define(name, &text).map_err(|errors| {
            let first = errors.first().map(|error| error.to_string().trim_end().to_owned()).unwrap_or_default();
            (Argument::String(at), format!("the function file `{name}` is wrong: {first}"))
        })?;
    }
    Ok(name)
}

/// The inverse of the transform that the string arguments from `at` on spell.
pub(super) fn transform(primitive: &Primitive, at: usize) -> Result<Similarity, Wrong> {
    let words = primitive.strings.get(at..).unwrap_or_default();
    let (transform, taken) = Transform::take(words).map_err(|bad| (Argument::String(at + bad.word), bad.message))?;
    if taken < words.len() {
        let message = format!("`{}` is no transform option: expected -t, -rx, -s and the like", words[taken]);
        return Err((Argument::String(at + taken), message));
    }
    let inverse = transform.inverse();
    Ok(Similarity { affine: inverse.affine, scale: inverse.scale.abs() })
}

/// Expressions from string argument `from` on, then the function file, then a transform.
pub(super) fn functions(
    primitive: &Primitive,
    from: usize,
    count: usize,
    sources: &mut Sources<'_, '_>,
) -> Result<Field, Wrong> {
    let file = function_file(primitive, from + count, sources)?;
    let expressions = expressions(primitive, from, count, file, sources)?;
    finished(primitive, Source::Functions(expressions), from + count + 1)
}

pub(super) fn expressions(
    primitive: &Primitive,
    from: usize,
    count: usize,
    file: &str,
    sources: &mut Sources<'_, '_>,
) -> Result<Vec<crate::pattern::Expression>, Wrong> {
    (from..from + count)
        .map(|at| {
            let text = string(primitive, at, "an expression")?;
            sources.library.expression(file, text).map_err(|why| (Argument::String(at), format!("`{text}`: {why}")))
        })
        .collect()
}

fn applied(
    primitive: &Primitive,
    from: usize,
    count: usize,
    file: &str,
    sources: &mut Sources<'_, '_>,
) -> Result<Vec<Applied>, Wrong> {
    (from..from + count)
        .map(|at| {
            let name = string(primitive, at, "a function's name")?;
            sources.library.function(file, name).map_err(|why| (Argument::String(at), format!("`{name}`: {why}")))
        })
        .collect()
}

/// The data file that string argument `at` names.
pub(super) fn table(primitive: &Primitive, at: usize, sources: &mut Sources<'_, '_>) -> Result<Arc<Table>, Wrong> {
    let name = string(primitive, at, "a data file")?;
    let table = sources.shelf.table(name, sources.folders);
    table.map_err(|why| (Argument::String(at), format!("the data file `{name}`: {why}")))
}

/// Functions, as many data files, the function file, an expression for each dimension, a transform.
pub(super) fn data(
    primitive: &Primitive,
    from: usize,
    count: usize,
    sources: &mut Sources<'_, '_>,
) -> Result<Field, Wrong> {
    let tables = (from + count..from + 2 * count)
        .map(|at| table(primitive, at, sources))
        .collect::<Result<Vec<Arc<Table>>, Wrong>>()?;
    let dimensions = tables.first().map_or(0, |table| table.dimensions());
    if let Some(other) = tables.iter().position(|table| table.dimensions() != dimensions) {
        let found = tables[other].dimensions();
        let message = format!("this data file has {found} dimensions, the first one {dimensions}");
        return Err((Argument::String(from + count + other), message));
    }
    let file_at = from + 2 * count;
    let file = function_file(primitive, file_at, sources)?;
    let finish = applied(primitive, from, count, file, sources)?;
    let coordinates = expressions(primitive, file_at + 1, dimensions, file, sources)?;
    finished(primitive, Source::Data { tables, coordinates, finish }, file_at + 1 + dimensions)
}

/// Functions, the picture, the function file, expressions of u and v, a transform.
fn picture(primitive: &Primitive, from: usize, count: usize, sources: &mut Sources<'_, '_>) -> Result<Field, Wrong> {
    let at = from + count;
    let name = string(primitive, at, "a picture")?;
    let picture = sources.shelf.picture(name, sources.folders);
    let picture = picture.map_err(|why| (Argument::String(at), format!("the picture `{name}` {why}")))?;
    let file = function_file(primitive, at + 1, sources)?;
    let finish = applied(primitive, from, count, file, sources)?;
    let coordinates = expressions(primitive, at + 2, 2, file, sources)?;
    let coordinates = [coordinates[0], coordinates[1]];
    finished(primitive, Source::Picture { picture, coordinates, finish }, at + 4)
}

/// A font and a text file, or `.` and words; anchor, right, down; colours; spacing.
fn text(
    primitive: &Primitive,
    from: usize,
    channels: Option<usize>,
    sources: &mut Sources<'_, '_>,
) -> Result<Field, Wrong> {
    let font = string(primitive, from, "a font")?;
    let font = sources.shelf.font(font, sources.folders);
    let font = font.map_err(|why| (Argument::String(from), format!("the font: {why}")))?;
    let first = string(primitive, from + 1, "a text file, or `.` and words")?;
    let lines = if primitive.strings.len() > from + 2 {
        vec![primitive.strings[from + 2..].join(" ")]
    } else {
        let lines = sources.shelf.lines(first, sources.folders);
        lines.map_err(|why| (Argument::String(from + 1), format!("the text file `{first}` {why}")))?
    };
    let values = 2 * channels.unwrap_or(0);
    let reals = &primitive.reals;
    if reals.len() < 9 + values || reals.len() > 10 + values {
        let message = format!("expected {} or {} real arguments, found {}", 9 + values, 10 + values, reals.len());
        return Err((Argument::Kind, message));
    }
    let vector = |at: usize| DVec3::from_slice(&reals[at..at + 3]);
    let spacing = reals.get(9 + values).map_or(Spacing::Uniform, |&gap| Spacing::Given(gap));
    let text = Text::new(font, [vector(0), vector(3), vector(6)], spacing, &lines);
    let text = text.ok_or((Argument::Real(3), "the step to the right is none, or along the step down".to_owned()))?;
    let color = |at: usize| match channels {
        Some(1) => [reals[at]; 3],
        Some(_) => [reals[at], reals[at + 1], reals[at + 2]],
        None => [0.0; 3],
    };
    let (fore, back) = match channels {
        Some(count) => (color(9), color(9 + count)),
        None => ([1.0; 3], [0.0; 3]),
    };
    let source = Source::Text { text: Box::new(text), fore, back };
    Ok(Field { source, to_local: Similarity::IDENTITY, reals: Arc::new([]) })
}

pub(super) fn finished(primitive: &Primitive, source: Source, transform_at: usize) -> Result<Field, Wrong> {
    let to_local = transform(primitive, transform_at)?;
    Ok(Field { source, to_local, reals: primitive.reals.as_slice().into() })
}
