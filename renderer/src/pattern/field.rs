//! Numbers over a scene: functions, data, pictures, text.

use std::sync::Arc;

use super::place::Local;
use super::{Place, Reflection, Spectrum, Table, Text};
use crate::cal::{Evaluator, Expression, Lambda};
use crate::math::Similarity;

/// A function of up to three numbers.
#[derive(Clone, Copy, Debug)]
pub struct Applied {
    lambda: Lambda,
    parameters: usize,
}

impl Applied {
    pub(super) fn new(lambda: Lambda, parameters: usize) -> Self {
        Self { lambda, parameters }
    }

    /// The value for channel `channel` of `values`: a function of fewer than three parameters takes the channel's own.
    fn value(&self, channel: usize, values: [f64; 3], at: &Local<'_>, evaluator: &mut Evaluator<'_>) -> Option<f64> {
        let own = [values[channel]];
        let given = if self.parameters == 3 || channel == 0 { &values[..self.parameters] } else { &own[..] };
        evaluator.apply_at(self.lambda, given, at).ok()
    }
}

/// Where numbers come from.
#[derive(Clone, Debug)]
pub enum Source {
    /// Up to three expressions.
    Functions(Vec<Expression>),
    /// One table, or three of the same dimensions, at the point that expressions give; each value goes through a
    /// function.
    Data {
        /// One, or red, green and blue.
        tables: Vec<Arc<Table>>,
        /// As many as a table has dimensions.
        coordinates: Vec<Expression>,
        /// One for each number.
        finish: Vec<Applied>,
    },
    /// A picture at u and v, whose red, green and blue go through functions.
    Picture {
        /// Rows from the bottom; the shorter side spans 0 to 1.
        picture: Arc<Table>,
        /// u to the right, v up.
        coordinates: [Expression; 2],
        /// One of three numbers for each channel, or a single one.
        finish: Vec<Applied>,
    },
    /// A spectrum, made red, green and blue; of a table at the point that expressions give, without the wavelength.
    Spectrum {
        /// The spectrum.
        spectrum: Spectrum,
        /// As many as a table has dimensions, less one.
        coordinates: Vec<Expression>,
    },
    /// One value in letters, another beside them.
    Text {
        /// The text.
        text: Box<Text>,
        /// In letters.
        fore: [f64; 3],
        /// Beside them.
        back: [f64; 3],
    },
}

/// Numbers over a scene.
#[derive(Clone, Debug)]
pub struct Field {
    /// Where they come from.
    pub source: Source,
    /// From the scene's coordinates (or an instance's) to the functions'.
    pub to_local: Similarity,
    /// The primitive's real arguments.
    pub reals: Arc<[f64]>,
}

impl Field {
    /// The numbers at a hit; a single one stands in all three places. `None` where a function fails.
    #[must_use]
    pub fn values(&self, place: &Place<'_>, evaluator: &mut Evaluator<'_>) -> Option<[f64; 3]> {
        self.reflected(place, None, evaluator)
    }

    /// The same for a material's functions of reflection.
    #[must_use]
    pub fn reflected(
        &self,
        place: &Place<'_>,
        reflection: Option<&Reflection>,
        evaluator: &mut Evaluator<'_>,
    ) -> Option<[f64; 3]> {
        let at = Local::new(place, &self.to_local, &self.reals, reflection);
        let values = match &self.source {
            Source::Functions(expressions) => {
                evaluator.move_on();
                let first = evaluator.value(*expressions.first()?, &at).ok()?;
                let mut values = [first; 3];
                for (value, expression) in values.iter_mut().zip(expressions).skip(1) {
                    *value = evaluator.value(*expression, &at).ok()?;
                }
                values
            }
            Source::Data { tables, coordinates, finish } => {
                evaluator.move_on();
                let mut point = [0.0; Table::MOST_DIMENSIONS];
                for (value, expression) in point.iter_mut().zip(coordinates) {
                    *value = evaluator.value(*expression, &at).ok()?;
                }
                let point = &point[..coordinates.len()];
                let first = tables.first()?.value(point)[0];
                let mut found = [first; 3];
                for (value, table) in found.iter_mut().zip(tables).skip(1) {
                    *value = table.value(point)[0];
                }
                finished(finish, found, &at, evaluator)?
            }
            Source::Picture { picture, coordinates: [u, v], finish } => {
                evaluator.move_on();
                let (u, v) = (evaluator.value(*u, &at).ok()?, evaluator.value(*v, &at).ok()?);
                finished(finish, picture.value(&[v, u]), &at, evaluator)?
            }
            Source::Spectrum { spectrum, coordinates } => {
                evaluator.move_on();
                let mut point = [0.0; Table::MOST_DIMENSIONS];
                for (value, expression) in point.iter_mut().zip(coordinates) {
                    *value = evaluator.value(*expression, &at).ok()?;
                }
                spectrum.value(&point[..coordinates.len()], &at, evaluator)?
            }
            Source::Text { text, fore, back } => {
                if text.covers(place.local_point()) {
                    *fore
                } else {
                    *back
                }
            }
        };
        values.iter().all(|value| value.is_finite()).then_some(values)
    }
}

fn finished(finish: &[Applied], found: [f64; 3], at: &Local<'_>, evaluator: &mut Evaluator<'_>) -> Option<[f64; 3]> {
    let first = finish.first()?.value(0, found, at, evaluator)?;
    let mut values = [first; 3];
    for (channel, function) in finish.iter().enumerate().skip(1) {
        values[channel] = function.value(channel, found, at, evaluator)?;
    }
    Some(values)
}
