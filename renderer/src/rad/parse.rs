//! Scene text to statements: `modifier type name`, counted arguments, aliases, comments, commands.
//!
//! The format is free: line ends are blanks, but for comments (`#`) and commands (`!`), which start only where a
//! primitive could and go to the line's end. (Reference manual, section "Scene Description Format".)

use super::arguments::check_counts;
use super::document::{SourceFile, Span, error_at};
use super::kind::Kind;
use super::lexer::{Lexer, Word};
use super::number::{NotANumber, integer, real};
use super::spelling::nearest;
use super::statement::{Alias, Draft, Statement};
use crate::diagnostic::{Error, Problems};

/// The keyword that is no type: it names again what has a name.
const ALIAS: &str = "alias";

/// The modifier of an alias that keeps its target's own.
pub(super) const INHERIT: &str = "inherit";

/// No modifier.
pub(super) const VOID: &str = "void";

/// Cuts the text `sources[source]` into statements; problems go to `problems` and reading goes on where the next primitive seems to start.
pub(super) fn parse(source: u32, sources: &[SourceFile], problems: &mut Problems) -> Vec<Statement> {
    let Some(file) = sources.get(source as usize) else { return Vec::new() };
    let mut parser = Parser { source, sources, file, lexer: Lexer::new(&file.text, 0), statements: Vec::new() };
    while let Some(byte) = parser.lexer.peek() {
        match byte {
            b'#' => parser.lexer.skip_line(),
            b'!' => {
                let (start, end) = parser.lexer.command_line();
                parser.statements.push(Statement::Command(parser.span(start, end)));
            }
            _ => {
                if let Err(error) = parser.primitive() {
                    problems.add(error);
                    if problems.full() {
                        break;
                    }
                    parser.recover();
                }
            }
        }
    }
    parser.statements
}

struct Parser<'a> {
    source: u32,
    sources: &'a [SourceFile],
    file: &'a SourceFile,
    lexer: Lexer<'a>,
    statements: Vec<Statement>,
}

impl<'a> Parser<'a> {
    fn span(&self, start: usize, end: usize) -> Span {
        // `read` refuses texts whose offsets do not fit.
        let offset = |at: usize| u32::try_from(at).unwrap_or(u32::MAX);
        Span { source: self.source, start: offset(start), end: offset(end) }
    }

    fn error(&self, start: usize, end: usize, message: impl Into<String>) -> Error {
        error_at(self.sources, self.span(start, end), message)
    }

    /// The next word; the end of the text, or a quote that never ends, is an error.
    fn word(&mut self, wanted: &str) -> Result<Word<'a>, Error> {
        let Some(word) = self.lexer.word() else {
            let end = self.file.text.trim_end().len();
            return Err(self.error(end, end, format!("the file ends where {wanted} should stand")));
        };
        match word.unclosed {
            None => Ok(word),
            Some(quote) => {
                let message = "this quote is not closed: an apostrophe opens a quoted word; write a word that holds \
                               one in double quotes";
                Err(self.error(quote, quote + 1, message))
            }
        }
    }

    fn primitive(&mut self) -> Result<(), Error> {
        let modifier = self.word("a modifier")?;
        let (start, modifier_end) = (modifier.start, modifier.end);
        let keyword = self.word("a primitive type")?;
        let kind = Kind::from_keyword(&keyword.text);
        if kind.is_none() && keyword.text != ALIAS {
            self.lexer.set_offset(modifier_end);
            return Err(self.unknown_type(&modifier, &keyword));
        }
        let name = self.word("a name")?;
        let Some(kind) = kind else { return self.alias(&modifier, &name) };
        match self.arguments(kind, &name) {
            Ok((strings, reals)) => {
                if kind.is_modifier() && (name.text == VOID || name.text == INHERIT) {
                    let message =
                        format!("a {kind} cannot be named `{}`: the word has a meaning of its own", name.text);
                    return Err(self.error(name.start, name.end, message));
                }
                let span = self.span(start, self.lexer.offset());
                self.statements.push(Statement::Primitive(Draft {
                    modifier: modifier.text.into_owned(),
                    kind,
                    name: name.text.into_owned(),
                    strings,
                    reals,
                    span,
                    as_written: true,
                }));
                Ok(())
            }
            Err(error) => {
                if kind.is_modifier() {
                    self.statements.push(Statement::Broken(name.text.into_owned()));
                }
                Err(error)
            }
        }
    }

    fn unknown_type(&self, modifier: &Word<'_>, keyword: &Word<'_>) -> Error {
        if real(&modifier.text).is_ok() && real(&keyword.text).is_ok() {
            let message = "expected the modifier of a new primitive, found a number: does the primitive before have \
                           more arguments than its counts say?";
            return self.error(modifier.start, modifier.end, message);
        }
        let known = Kind::ALL.iter().map(|kind| kind.keyword()).chain([ALIAS]);
        let hint = match nearest(&keyword.text, known) {
            Some(known) => format!("; did you mean `{known}`?"),
            None => "; a primitive is written: modifier type name".to_owned(),
        };
        self.error(keyword.start, keyword.end, format!("unknown primitive type `{}`{hint}", keyword.text))
    }

    fn alias(&mut self, modifier: &Word<'_>, name: &Word<'_>) -> Result<(), Error> {
        if name.text == VOID || name.text == INHERIT {
            let message = format!("an alias cannot be named `{}`: the word has a meaning of its own", name.text);
            return Err(self.error(name.start, name.end, message));
        }
        let target = self.word("the modifier that the alias stands for")?;
        let span = self.span(modifier.start, target.end);
        self.statements.push(Statement::Alias(Alias {
            modifier: modifier.text.clone().into_owned(),
            name: name.text.clone().into_owned(),
            target: target.text.into_owned(),
            span,
        }));
        Ok(())
    }

    fn arguments(&mut self, kind: Kind, name: &Word<'_>) -> Result<(Vec<String>, Vec<f64>), Error> {
        let owner = format!("{kind} `{}`", name.text);
        let strings = self.count("string", &owner)?;
        let mut texts = Vec::new();
        for _ in 0..strings {
            texts.push(self.word(&format!("a string argument of {owner}"))?.text.into_owned());
        }
        let integers = self.word(&format!("the number of integer arguments of {owner}"))?;
        match integer(&integers.text) {
            Ok(0) => {}
            Ok(_) => {
                let message = format!("no type takes integer arguments: expected 0, found `{}`", integers.text);
                return Err(self.error(integers.start, integers.end, message));
            }
            Err(_) => {
                let message = format!(
                    "expected 0, the number of integer arguments of {owner}, found `{}`: are there more than the {} \
                     string arguments that its count says?",
                    integers.text, strings
                );
                self.lexer.set_offset(integers.start);
                return Err(self.error(integers.start, integers.end, message));
            }
        }
        let count = self.count("real", &owner)?;
        let mut numbers = Vec::with_capacity(count);
        for index in 0..count {
            numbers.push(self.real(index, count, &owner)?);
        }
        match check_counts(kind, texts.len(), numbers.len()) {
            None => Ok((texts, numbers)),
            Some(message) => Err(self.error(name.start, name.end, message)),
        }
    }

    /// A number of arguments. One that the rest of the text cannot hold is an error before anything is allocated.
    fn count(&mut self, sort: &str, owner: &str) -> Result<usize, Error> {
        let word = self.word(&format!("the number of {sort} arguments of {owner}"))?;
        let count = match integer(&word.text) {
            Ok(count) => usize::try_from(count).ok(),
            Err(NotANumber::Overflow) => Some(usize::MAX),
            Err(NotANumber::Form) => None,
        };
        let Some(count) = count else {
            self.lexer.set_offset(word.start);
            let message = format!("expected the number of {sort} arguments of {owner}, found `{}`", word.text);
            return Err(self.error(word.start, word.end, message));
        };
        // Every argument needs a character, and a blank before it.
        if count > (self.file.text.len() - word.end) / 2 {
            let message =
                format!("{owner} cannot have `{}` {sort} arguments: the file is too short for them", word.text);
            return Err(self.error(word.start, word.end, message));
        }
        Ok(count)
    }

    fn real(&mut self, index: usize, count: usize, owner: &str) -> Result<f64, Error> {
        let word = self.word(&format!("real argument {} of the {count} of {owner}", index + 1))?;
        let problem = match real(&word.text) {
            Ok(value) => return Ok(value),
            Err(NotANumber::Overflow) => "is beyond the range of a number",
            Err(NotANumber::Form) => "is not a number",
        };
        if Kind::from_keyword(&word.text).is_none() {
            self.lexer.set_offset(word.start);
        }
        let message =
            format!("`{}` {problem}: expected real argument {} of the {count} of {owner}", word.text, index + 1);
        Err(self.error(word.start, word.end, message))
    }

    /// After an error: on to a word that a type's keyword follows, or to a line that starts with `void`, a comment or a
    /// command.
    fn recover(&mut self) {
        loop {
            let Some(byte) = self.lexer.peek() else { return };
            let at = self.lexer.offset();
            let before = self.file.text[..at].trim_end_matches([' ', '\t', '\r', '\x0b', '\x0c']);
            let starts_line = before.is_empty() || before.ends_with('\n');
            if starts_line && (byte == b'#' || byte == b'!') {
                return;
            }
            let Some(word) = self.lexer.word() else { return };
            if starts_line && word.text == VOID {
                self.lexer.set_offset(at);
                return;
            }
            let after = self.lexer.clone();
            if self.lexer.word().is_some_and(|next| Kind::from_keyword(&next.text).is_some() || next.text == ALIAS) {
                self.lexer.set_offset(at);
                return;
            }
            self.lexer = after;
        }
    }
}
