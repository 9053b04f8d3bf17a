//! Tokens to an [`Ast`]: one pass, an explicit stack, all the rules of the language checked on the way.

use std::num::NonZeroU32;

use super::ast::{Ast, Atom, Group, Item, MAX_NESTING, Multiplier, Repeat, Span};
use super::error::{Error, ErrorKind};
use super::lex::{Token, TokenKind, tokens};
use crate::component::Component;

/// Errors reported for one text, at most: the first ones.
pub const MAX_ERRORS: usize = 20;

/// Reads a crex.
///
/// Time and memory grow with the length of the text and with nothing else, multipliers and nesting included.
///
/// # Errors
/// Every error found, in the order of their spans, up to [`MAX_ERRORS`].
pub fn parse(text: &str) -> Result<Ast, Vec<Error>> {
    let mut parser = Parser::new(text);
    for token in tokens(text) {
        parser.take(token);
    }
    parser.finish()
}

/// An item being read, with what the checks need to know of it.
struct Part {
    item: Item,
    /// Groups within each other inside the item, itself included.
    height: usize,
}

/// A group being read; the first one is the whole text.
struct Frame {
    /// What closes it; none for the whole text.
    opened: Option<(Group, Span)>,
    parts: Vec<Part>,
}

struct Parser<'t> {
    text: &'t str,
    frames: Vec<Frame>,
    /// How many groups of each kind are open.
    open: [usize; 4],
    errors: Vec<Error>,
    too_deep: bool,
}

impl<'t> Parser<'t> {
    fn new(text: &'t str) -> Self {
        let root = Frame { opened: None, parts: Vec::new() };
        Self { text, frames: vec![root], open: [0; 4], errors: Vec::new(), too_deep: false }
    }

    fn error(&mut self, kind: ErrorKind, span: Span) {
        if self.errors.len() < MAX_ERRORS {
            self.errors.push(Error::new(kind, span, self.text));
        }
    }

    fn frame(&mut self) -> &mut Frame {
        self.frames.last_mut().expect("the whole text is never closed")
    }

    fn is_open(&self, group: Group) -> bool {
        self.open[group as usize] > 0
    }

    fn take(&mut self, token: Token) {
        let span = token.span;
        match token.kind {
            TokenKind::Letter(component) => self.letter(component, span),
            TokenKind::Open(group) => self.open(group, span),
            TokenKind::Close(group) => self.close(group, span),
            TokenKind::Star => self.star(span),
            TokenKind::Digits => self.digits(span),
            TokenKind::LowerCase => {
                let suggestion = span.of(self.text).to_ascii_uppercase();
                self.error(ErrorKind::LowerCase { suggestion }, span);
                self.stand_in(span);
            }
            TokenKind::Unknown => {
                self.error(ErrorKind::UnknownCharacter, span);
                self.stand_in(span);
            }
        }
    }

    fn letter(&mut self, component: Component, span: Span) {
        let item = Item { atom: Atom::Component(component), atom_span: span, multipliers: Vec::new() };
        self.frame().parts.push(Part { item, height: 0 });
    }

    /// Stands where an item was surely meant, so that one mistake is not reported twice. The text has an error: the
    /// tree will not be used.
    fn stand_in(&mut self, span: Span) {
        self.letter(Component::Diffuse, span);
    }

    fn open(&mut self, group: Group, span: Span) {
        if group == Group::Importance {
            let around = [Group::Importance, Group::Timed].into_iter().find(|&around| self.is_open(around));
            if let Some(around) = around {
                self.error(ErrorKind::ImportanceInside(around), span);
            }
        }
        if self.frames.len() > MAX_NESTING {
            self.deep(span);
        }
        self.open[group as usize] += 1;
        self.frames.push(Frame { opened: Some((group, span)), parts: Vec::new() });
    }

    /// Reports nesting that is too deep, once for a text.
    fn deep(&mut self, span: Span) {
        if !self.too_deep {
            self.too_deep = true;
            self.error(ErrorKind::TooDeep, span);
        }
    }

    fn close(&mut self, found: Group, span: Span) {
        let Some((open, opened)) = self.frame().opened else {
            self.error(ErrorKind::Unopened(found), span);
            return;
        };
        if open == found {
            if self.frame().parts.is_empty() {
                self.error(ErrorKind::Empty(open), Span::new(opened.start, span.end));
            }
        } else if self.is_open(found) {
            // Its partner stands further out: the groups between are the ones left open.
            while let Some((inner, opened)) = self.frame().opened
                && inner != found
            {
                self.error(ErrorKind::Unclosed(inner), opened);
                self.end_group(span.start);
            }
        } else {
            self.error(ErrorKind::Mismatched { found, open, opened_at: opened.start }, span);
        }
        self.end_group(span.end);
    }

    /// Ends the innermost group, which becomes an item of the one around it.
    fn end_group(&mut self, end: usize) {
        let Some(Frame { opened: Some((group, opened)), parts }) = self.frames.pop() else {
            unreachable!("only called with a group open");
        };
        self.open[group as usize] -= 1;
        let span = Span::new(opened.start, end);
        if self.too_deep {
            // A tree this deep is not built: dropping it would recurse as deeply.
            self.stand_in(span);
            return;
        }
        let height = 1 + parts.iter().map(|part| part.height).max().unwrap_or(0);
        let items = parts.into_iter().map(|part| part.item).collect();
        let item = Item { atom: Atom::Group(group, items), atom_span: span, multipliers: Vec::new() };
        self.frame().parts.push(Part { item, height });
    }

    fn star(&mut self, span: Span) {
        let around = [Group::Importance, Group::Timed].into_iter().find(|&around| self.is_open(around));
        if let Some(around) = around {
            self.error(ErrorKind::StarInside(around), span);
        }
        self.multiply(Repeat::UntilEmpty, span);
    }

    fn digits(&mut self, span: Span) {
        let digits = span.of(self.text).trim_start_matches('0');
        if digits.is_empty() {
            self.error(ErrorKind::Zero, span);
        }
        let times = digits.parse().ok().and_then(NonZeroU32::new);
        if times.is_none() && !digits.is_empty() {
            self.error(ErrorKind::TooLarge, span);
        }
        self.multiply(Repeat::Times(times.unwrap_or(NonZeroU32::MIN)), span);
    }

    fn multiply(&mut self, repeat: Repeat, span: Span) {
        let depth = self.frames.len() - 1;
        let Some(part) = self.frame().parts.last_mut() else {
            self.error(ErrorKind::NothingToMultiply, span);
            self.stand_in(span);
            return;
        };
        part.height += usize::from(!part.item.multipliers.is_empty());
        part.item.multipliers.push(Multiplier { repeat, span });
        if depth + part.height > MAX_NESTING {
            self.deep(span);
        }
    }

    fn finish(mut self) -> Result<Ast, Vec<Error>> {
        let unclosed: Vec<_> = self.frames.iter().filter_map(|frame| frame.opened).collect();
        for (group, opened) in unclosed {
            self.error(ErrorKind::Unclosed(group), opened);
        }
        if self.errors.is_empty() {
            let root = self.frames.pop().expect("the whole text is never closed");
            let items = root.parts.into_iter().map(|part| part.item).collect();
            return Ok(Ast { text: self.text.to_owned(), items });
        }
        self.errors.sort_by_key(|error| (error.span.start, error.span.end));
        Err(self.errors)
    }
}
