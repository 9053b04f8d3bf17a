//! Checks of a material's numeric arguments.

use crate::color::Rgb;

/// What is wrong with a material's arguments. The message names the argument; the caller knows the primitive, the file
/// and the line.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ArgumentError {
    /// The number of real arguments does not fit.
    #[error("expected {expected} real arguments ({names}), found {found}")]
    Count {
        /// How many, in words: `5`, or `4 or 5`.
        expected: &'static str,
        /// What they are, in order.
        names: &'static str,
        /// How many there are.
        found: usize,
    },
    /// An argument lies outside its range.
    #[error("argument {position} ({name}) is {value}, expected {expected}")]
    Range {
        /// Its place among the real arguments, from 1.
        position: usize,
        /// What it is.
        name: &'static str,
        /// What was found.
        value: f64,
        /// The range, in words.
        expected: &'static str,
    },
}

/// Largest colour, radiance or roughness. Products of those of a hit, of a path's ripple and of a light's solid angle,
/// each bounded, then stay within `f64` (`docs/numerics.md`), and 1e30 W/(sr m2) is more than any star has.
const LARGEST: f64 = 1e30;

/// Takes real arguments one after the other, checking each.
pub(super) struct Arguments<'a> {
    reals: &'a [f64],
    taken: usize,
}

impl<'a> Arguments<'a> {
    /// Begins with `reals`, whose number must be one of `counts`.
    pub(super) fn new(
        reals: &'a [f64],
        counts: &[usize],
        expected: &'static str,
        names: &'static str,
    ) -> Result<Self, ArgumentError> {
        if counts.contains(&reals.len()) {
            Ok(Self { reals, taken: 0 })
        } else {
            Err(ArgumentError::Count { expected, names, found: reals.len() })
        }
    }

    /// The next argument, which must satisfy `holds`. NaN satisfies no comparison, so it never passes a range.
    pub(super) fn take(
        &mut self,
        name: &'static str,
        expected: &'static str,
        holds: impl Fn(f64) -> bool,
    ) -> Result<f64, ArgumentError> {
        let value = self.reals[self.taken];
        self.taken += 1;
        if holds(value) { Ok(value) } else { Err(ArgumentError::Range { position: self.taken, name, value, expected }) }
    }

    /// The next argument, not negative.
    pub(super) fn non_negative(&mut self, name: &'static str) -> Result<f64, ArgumentError> {
        self.take(name, "a number from 0 to 1e30", |x| (0.0..=LARGEST).contains(&x))
    }

    /// The next argument, in [0, 1].
    pub(super) fn fraction(&mut self, name: &'static str) -> Result<f64, ArgumentError> {
        self.take(name, "a fraction from 0 to 1", |x| (0.0..=1.0).contains(&x))
    }

    /// The next argument, finite.
    pub(super) fn finite(&mut self, name: &'static str) -> Result<f64, ArgumentError> {
        self.take(name, "a finite number", f64::is_finite)
    }

    /// The next three arguments as a colour, not negative. Radiance clamps no colour, and neither does this.
    pub(super) fn color(&mut self) -> Result<Rgb, ArgumentError> {
        Ok(Rgb::new(self.non_negative("red")?, self.non_negative("green")?, self.non_negative("blue")?))
    }
}
