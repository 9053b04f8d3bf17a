//! Binds names: every modifier becomes the index of the latest definition before its use, aliases are followed.
//!
//! Reference manual, section "Aliases"; a name may be defined again, which changes nothing for those who used it before.

use std::collections::HashSet;

use super::document::{Argument, Document, Names, Primitive, SourceFile, Span};
use super::parse::{INHERIT, VOID};
use super::spelling::nearest;
use super::statement::{Alias, Draft, Statement};
use crate::diagnostic::{MAX_ERRORS, Problems};

/// A problem, kept until the document can say where it is.
struct Wrong {
    primitive: Option<Primitive>,
    span: Span,
    argument: Argument,
    message: String,
}

/// Takes statements in order.
pub(super) struct Resolver {
    sources: Vec<SourceFile>,
    primitives: Vec<Primitive>,
    names: Names,
    broken: HashSet<String>,
    wrong: Vec<Wrong>,
}

impl Resolver {
    pub(super) fn new(sources: Vec<SourceFile>) -> Self {
        Self { sources, primitives: Vec::new(), names: Names::default(), broken: HashSet::new(), wrong: Vec::new() }
    }

    pub(super) fn statement(&mut self, statement: Statement) {
        match statement {
            Statement::Primitive(draft) => self.primitive(draft),
            Statement::Alias(alias) => self.alias(&alias),
            Statement::Broken(name) => {
                self.broken.insert(name);
            }
            // What it stands for follows.
            Statement::Command(_) => {}
        }
    }

    /// The document; what was wrong goes to `problems`.
    pub(super) fn finish(self, problems: &mut Problems) -> Document {
        let document = Document::new(self.sources, self.primitives, self.names);
        for Wrong { primitive, span, argument, message } in self.wrong {
            let span = match primitive {
                Some(primitive) => document.argument_span(&primitive, argument),
                None => span,
            };
            problems.add(document.error(span, message));
        }
        document
    }

    fn wrong(&mut self, wrong: Wrong) {
        if self.wrong.len() < MAX_ERRORS && !wrong.message.is_empty() {
            self.wrong.push(wrong);
        }
    }

    fn primitive(&mut self, draft: Draft) {
        let modifier = self.meaning(&draft.modifier);
        let index = self.primitives.len();
        let undefined = modifier.is_none() && draft.modifier != VOID;
        let primitive = Primitive {
            modifier,
            kind: draft.kind,
            name: draft.name,
            strings: draft.strings,
            reals: draft.reals,
            span: draft.span,
            as_written: draft.as_written,
        };
        if undefined {
            let message = if draft.modifier == INHERIT {
                "only an alias can inherit its modifier".to_owned()
            } else {
                self.undefined(&draft.modifier)
            };
            let span = primitive.span;
            self.wrong(Wrong { primitive: Some(primitive.clone()), span, argument: Argument::Modifier, message });
        }
        if primitive.kind.is_modifier() {
            self.broken.remove(&primitive.name);
            self.names.define(&primitive.name, index + 1, index);
        }
        self.primitives.push(primitive);
    }

    /// `inherit alias new old`, and `m alias new old` where m is old's own modifier, give `old` a second name; any
    /// other modifier makes a copy of it with that modifier.
    fn alias(&mut self, alias: &Alias) {
        let Some(target) = self.meaning(&alias.target) else {
            let message = self.undefined(&alias.target);
            self.alias_problem(alias, message);
            return;
        };
        let index = self.primitives.len();
        let inherited = self.primitives[target].modifier;
        let modifier = self.meaning(&alias.modifier);
        if modifier.is_none() && alias.modifier != VOID && alias.modifier != INHERIT {
            let message = self.undefined(&alias.modifier);
            self.alias_problem(alias, message);
            return;
        }
        self.broken.remove(&alias.name);
        if alias.modifier == INHERIT || modifier == inherited {
            self.names.define(&alias.name, index, target);
            return;
        }
        let copy = Primitive {
            modifier,
            name: alias.name.clone(),
            span: alias.span,
            as_written: false,
            ..self.primitives[target].clone()
        };
        self.primitives.push(copy);
        self.names.define(&alias.name, index + 1, index);
    }

    fn alias_problem(&mut self, alias: &Alias, message: String) {
        self.broken.insert(alias.name.clone());
        self.wrong(Wrong { primitive: None, span: alias.span, argument: Argument::Modifier, message });
    }

    fn meaning(&self, name: &str) -> Option<usize> {
        if name == VOID {
            return None;
        }
        self.names.meaning(name, self.primitives.len())
    }

    /// Empty if the name's definition has errors of its own, which are told already.
    fn undefined(&self, name: &str) -> String {
        if self.broken.contains(name) {
            return String::new();
        }
        match nearest(name, self.names.all().chain([VOID])) {
            Some(known) => format!("undefined modifier `{name}`; did you mean `{known}`?"),
            None => format!("undefined modifier `{name}`: a modifier must be defined before it is used"),
        }
    }
}
