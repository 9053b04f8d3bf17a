//! A scene's own function of reflection: what `plasfunc`, `BRTDfunc` and their kin answer lights with.

use std::sync::Arc;

use glam::DVec3;

use super::place::Local;
use super::{Place, Reflection, Table};
use crate::cal::{Evaluator, Lambda};
use crate::color::Rgb;
use crate::math::Similarity;

/// How the function is given.
#[derive(Clone, Debug)]
pub enum Form {
    /// One function of the direction to the light and its solid angle, or one for each channel; `None` is 0.
    Functions([Option<Lambda>; 3]),
    /// A table at the point that functions of the light give; the value goes through a function of it and the light.
    Data {
        /// The table.
        table: Arc<Table>,
        /// As many as it has dimensions.
        coordinates: Vec<Lambda>,
        /// Of the value, the direction and the solid angle.
        finish: Lambda,
    },
}

/// A function of reflection.
#[derive(Clone, Debug)]
pub struct Law {
    /// How it is given.
    pub form: Form,
    /// From the scene's coordinates to the function's.
    pub to_local: Similarity,
    /// The primitive's real arguments.
    pub reals: Arc<[f64]>,
}

impl Law {
    /// Its value, 1/sr per channel, for a light in the unit direction `to_light` of `solid_angle` steradians; `None` where
    /// a function fails.
    #[must_use]
    pub fn value(
        &self,
        (to_light, solid_angle): (DVec3, f64),
        place: &Place<'_>,
        reflection: &Reflection,
        evaluator: &mut Evaluator<'_>,
    ) -> Option<Rgb> {
        let at = Local::new(place, &self.to_local, &self.reals, Some(reflection));
        let DVec3 { x, y, z } = at.turned(to_light);
        evaluator.move_on();
        let value = match &self.form {
            Form::Functions(functions) => {
                let mut value = Rgb::ZERO;
                let mut last: Option<(Lambda, f64)> = None;
                for (channel, function) in functions.iter().enumerate() {
                    let Some(function) = *function else { continue };
                    value[channel] = match last {
                        Some((same, value)) if same == function => value,
                        _ => evaluator.apply_at(function, &[x, y, z, solid_angle], &at).ok()?,
                    };
                    last = Some((function, value[channel]));
                }
                value
            }
            Form::Data { table, coordinates, finish } => {
                let mut point = [0.0; Table::MOST_DIMENSIONS];
                for (value, function) in point.iter_mut().zip(coordinates) {
                    *value = evaluator.apply_at(*function, &[x, y, z, solid_angle], &at).ok()?;
                }
                let found = table.value(&point[..coordinates.len()])[0];
                Rgb::splat(evaluator.apply_at(*finish, &[found, x, y, z, solid_angle], &at).ok()?)
            }
        };
        value.is_finite().then_some(value)
    }
}
