//! Expressions in the words of a generator: functions of one or two parameters, and what `-e` and `-f` define for them.

use std::fmt;

use crate::cal::{BadExpression, Dialect, Evaluator, Functions, Lambda, Nowhere};

use super::super::command::Word;
use super::super::xform::BadWords;
use super::arguments::Arguments;

/// Surfaces that one command may make.
pub(super) const MAX_SURFACES: usize = 4_000_000;

/// Definitions of a command.
pub(super) struct Curves {
    functions: Functions,
}

impl Curves {
    pub(super) fn new() -> Self {
        Self { functions: Functions::new(Dialect::Generator) }
    }

    /// Takes `-e definitions` or `-f file`; false if `option` is neither.
    pub(super) fn take_option(
        &mut self,
        option: &Word,
        arguments: &mut Arguments<'_>,
        read: &mut dyn FnMut(&Word) -> Result<String, BadWords>,
    ) -> Result<bool, BadWords> {
        let (word, text) = match option.text.as_str() {
            "-e" => {
                let word = arguments.word("definitions")?;
                (word, word.text.clone())
            }
            "-f" => {
                let word = arguments.word("a function file")?;
                (word, read(word)?)
            }
            _ => return Ok(false),
        };
        let name = if option.text == "-f" { word.text.as_str() } else { "-e" };
        self.functions.define_globally(name, &text).map_err(|errors| {
            let first = errors.first();
            let message = first.map_or_else(String::new, |error| {
                format!("{}:{}:{}: {}", error.file, error.line, error.column, error.message)
            });
            BadWords::at(Some(word), message)
        })?;
        Ok(true)
    }

    /// A word as a function of these parameters.
    pub(super) fn function(&mut self, word: &Word, parameters: &[&'static str]) -> Result<Curve, BadWords> {
        let lambda = self.functions.lambda(parameters, &word.text).map_err(|bad| misread(word, &bad))?;
        match self.functions.check_lambda(lambda) {
            None => Ok(Curve { lambda, word: word.clone() }),
            Some(problem) => Err(BadWords::at(Some(word), problem)),
        }
    }

    /// The function `name` of two parameters, if `-e` or `-f` define it.
    pub(super) fn optional(&mut self, name: &str, word: &Word) -> Result<Option<Curve>, BadWords> {
        if !self.functions.defines(name, Some(2)) {
            return Ok(None);
        }
        self.function(&Word { text: format!("{name}(s, t)"), ..word.clone() }, &["s", "t"]).map(Some)
    }

    /// A word as a constant expression, rounded to a number of segments.
    pub(super) fn segments(&mut self, word: &Word) -> Result<usize, BadWords> {
        let expression = self.functions.expression(".", &word.text).map_err(|bad| misread(word, &bad))?;
        if let Some(problem) = self.functions.check(expression) {
            return Err(BadWords::at(Some(word), problem));
        }
        let value = Evaluator::new(&self.functions).value(expression, &Nowhere);
        let value = value.map_err(|error| BadWords::at(Some(word), error.to_string()))? + 0.5;
        if !(1.0..=MAX_SURFACES as f64).contains(&value) {
            let message = format!("expected a number of segments from 1 to {MAX_SURFACES}, found {}", value - 0.5);
            return Err(BadWords::at(Some(word), message));
        }
        Ok(value as usize)
    }

    pub(super) fn evaluator(&self) -> Evaluator<'_> {
        Evaluator::thrifty(&self.functions)
    }
}

/// A function in a command's words.
pub(super) struct Curve {
    lambda: Lambda,
    word: Word,
}

impl Curve {
    pub(super) fn at(&self, evaluator: &mut Evaluator<'_>, parameters: &[f64]) -> Result<f64, BadWords> {
        evaluator.apply(self.lambda, parameters).map_err(|error| self.blame(parameters, &error))
    }

    fn blame(&self, parameters: &[f64], error: &dyn fmt::Display) -> BadWords {
        BadWords::at(Some(&self.word), format!("there is no value at {parameters:?}: {error}"))
    }
}

/// A syntax error, under the part of the word that is wrong if quoting lets it be found.
fn misread(word: &Word, bad: &BadExpression) -> BadWords {
    let quote = match (word.end - word.start).checked_sub(word.text.len()) {
        Some(0) => 0,
        Some(2) => 1,
        _ => return BadWords::at(Some(word), format!("`{}`: {}", word.text, bad.message)),
    };
    let offset = word.start + quote;
    let part = Word { text: word.text.clone(), start: offset + bad.start, end: offset + bad.end };
    BadWords::at(Some(&part), bad.message.clone())
}
