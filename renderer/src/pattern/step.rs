//! What patterns and textures do to a hit.

use glam::DVec3;

use super::{Field, Place};
use crate::cal::Evaluator;
use crate::color::Rgb;

/// One modifier of a surface, below or above its material.
#[derive(Clone, Debug)]
pub enum Step {
    /// Multiplies the colour.
    Tint(Field),
    /// Multiplies the colour, the same everywhere.
    Fixed(Rgb),
    /// Bends the normal.
    Bend(Field),
    /// Takes a part of what some steps do and the rest of what others do.
    Blend {
        /// The first ones' part, clipped to [0, 1].
        part: Field,
        /// Their steps.
        fore: Vec<Step>,
        /// The others'.
        back: Vec<Step>,
    },
}

/// What steps have done so far.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Finish {
    /// The colour is multiplied by this.
    pub tint: Rgb,
    /// This is added to the unit normal of the surface's front.
    pub bend: DVec3,
}

impl Default for Finish {
    fn default() -> Self {
        Self { tint: Rgb::ONE, bend: DVec3::ZERO }
    }
}

/// Takes `steps` at a hit. A step whose function fails does nothing.
pub fn apply(steps: &[Step], place: &Place<'_>, evaluator: &mut Evaluator<'_>, finish: &mut Finish) {
    for step in steps {
        match step {
            Step::Tint(field) => {
                if let Some(values) = field.values(place, evaluator) {
                    finish.tint *= Rgb::from(values);
                }
            }
            Step::Fixed(tint) => finish.tint *= *tint,
            Step::Bend(field) => {
                if let Some(values) = field.values(place, evaluator) {
                    finish.bend += place.turned_back(&field.to_local, DVec3::from(values));
                }
            }
            Step::Blend { part, fore, back } => {
                let Some([part, ..]) = part.values(place, evaluator) else { continue };
                let part = part.clamp(0.0, 1.0);
                let (mut first, mut second) = (*finish, *finish);
                if part > 0.0 {
                    apply(fore, place, evaluator, &mut first);
                }
                if part < 1.0 {
                    apply(back, place, evaluator, &mut second);
                }
                finish.tint = first.tint * part + second.tint * (1.0 - part);
                finish.bend = first.bend * part + second.bend * (1.0 - part);
            }
        }
    }
}
