//! What changes a surface's colour and normal before its material sees them: patterns, textures and mixtures of the
//! Radiance reference manual.
//!
//! A [`Field`] gives numbers at a hit: from functions, from tables of data, from pictures, from text. A [`Step`] uses
//! them: it multiplies the colour, bends the normal, or blends two lists of steps. What no surface of a scene uses is not
//! read, and a surface without steps knows nothing of this module.

mod field;
mod font;
mod law;
mod place;
mod spectrum;
mod step;
mod table;
mod text;

pub use crate::cal::{Evaluator, Expression, Lambda, Memory};
pub use field::{Applied, Field, Source};
pub use font::Font;
pub use law::{Form, Law};
pub use place::{Inside, Place, Reflection};
pub use spectrum::{Spectrum, around, to_rgb};
pub use step::{Finish, Step, apply};
pub use table::Table;
pub use text::{Spacing, Text};

use crate::cal::{BadExpression, Dialect, Functions};
use crate::diagnostic::Error;

/// The function files of a scene.
#[derive(Clone, Debug)]
pub struct Library {
    functions: Functions,
    files: Vec<String>,
}

impl Default for Library {
    fn default() -> Self {
        Self { functions: Functions::new(Dialect::Ray), files: Vec::new() }
    }
}

impl Library {
    /// Whether a function file has been read.
    #[must_use]
    pub fn knows(&self, file: &str) -> bool {
        self.files.iter().any(|known| known == file)
    }

    /// How many texts of functions it holds, that of the standard definitions included.
    #[must_use]
    pub fn texts(&self) -> usize {
        self.functions.texts()
    }

    /// Reads a function file.
    ///
    /// # Errors
    /// Its mistakes.
    pub fn define(&mut self, file: &str, text: &str) -> Result<(), Vec<Error>> {
        self.files.push(file.to_owned());
        self.functions.define_file(file, text)
    }

    /// Reads an expression as if it stood in a function file (`.`: in none).
    ///
    /// # Errors
    /// What is wrong with it, in words.
    pub fn expression(&mut self, file: &str, text: &str) -> Result<Expression, String> {
        let expression = self.functions.expression(file, text).map_err(|bad: BadExpression| bad.message)?;
        self.functions.check(expression).map_or(Ok(expression), Err)
    }

    /// A function of up to three numbers by its name in a function file, as data and pictures pass through.
    ///
    /// # Errors
    /// What is wrong with it, in words.
    pub fn function(&mut self, file: &str, name: &str) -> Result<Applied, String> {
        const NAMES: [&str; 3] = ["v.1", "v.2", "v.3"];
        let count = self.functions.parameters(file, name).map_or(1, |count| count as usize).clamp(1, NAMES.len());
        let text = format!("{name}({})", NAMES[..count].join(","));
        let lambda = self.functions.lambda_in(file, &NAMES[..count], &text).map_err(|bad| bad.message)?;
        self.functions.check_lambda(lambda).map_or(Ok(Applied::new(lambda, count)), Err)
    }

    /// A function by its name in a function file, to be given up to `most` (at most 5) numbers; one of fewer parameters
    /// gets the first of them.
    ///
    /// # Errors
    /// What is wrong with it, in words.
    pub fn lambda(&mut self, file: &str, name: &str, most: usize) -> Result<Lambda, String> {
        const NAMES: [&str; 5] = ["v.1", "v.2", "v.3", "v.4", "v.5"];
        let count = self.functions.parameters(file, name).map_or(most, |count| (count as usize).clamp(1, most));
        let text = format!("{name}({})", NAMES[..count].join(","));
        let lambda = self.functions.lambda_in(file, &NAMES[..most], &text).map_err(|bad| bad.message)?;
        self.functions.check_lambda(lambda).map_or(Ok(lambda), Err)
    }

    /// What evaluates its functions, with the memory of an earlier one.
    #[must_use]
    pub fn evaluator(&self, memory: Memory) -> Evaluator<'_> {
        Evaluator::with(&self.functions, memory)
    }
}

#[cfg(test)]
mod tests;
