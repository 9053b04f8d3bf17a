//! What is allowed in a crex and yet does less than its writer may think.

use std::num::NonZeroU32;

use super::ast::{Ast, Atom, Group, Item, Multiplier, Repeat, Span};
use super::error::underline;
use crate::component::ComponentSet;

/// What is known of the run that a crex is meant for; nothing unless given.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Setting {
    /// The components that the scene's materials can spawn.
    pub components: Option<ComponentSet>,
    /// Whether there is an importance map.
    pub importance_map: Option<bool>,
    /// Whether there is a time limit.
    pub time_limit: Option<bool>,
}

/// A remark on a part of a crex.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Warning {
    /// What it says, in a sentence without a full stop.
    pub message: String,
    /// The part of the text that it is about.
    pub span: Span,
}

impl Warning {
    /// The message, and the line of `text` with the span underlined. `text` must be the text that was parsed.
    #[must_use]
    pub fn render(&self, text: &str) -> String {
        format!("warning: {}\n{}", self.message, underline(text, self.span))
    }
}

/// The warnings that a crex deserves in a setting, in the order of their spans: multipliers that do nothing, components
/// that the scene cannot spawn, `{ }` without an importance map, `[ ]` without a time limit.
#[must_use]
pub fn warnings(ast: &Ast, setting: &Setting) -> Vec<Warning> {
    let mut search = Search { setting, held: None, found: Vec::new() };
    ast.items().iter().for_each(|item| search.item(item));
    search.found.sort_by_key(|warning| (warning.span.start, warning.span.end));
    search.found
}

struct Search<'s> {
    setting: &'s Setting,
    /// The outermost group around that holds what is spawned.
    held: Option<Group>,
    found: Vec<Warning>,
}

impl Search<'_> {
    fn warn(&mut self, span: Span, message: String) {
        self.found.push(Warning { message, span });
    }

    fn item(&mut self, item: &Item) {
        self.multipliers(item);
        match item.atom() {
            &Atom::Component(component) => {
                if self.setting.components.is_some_and(|spawned| !spawned.contains(component)) {
                    let message = format!("no material of the scene spawns {component} rays: this runs nothing");
                    self.warn(item.atom_span(), message);
                }
            }
            Atom::Group(group, items) => {
                if *group == Group::Importance && self.setting.importance_map == Some(false) {
                    let message = "`{ }` without an importance map: every pixel counts as 1, so all of it runs";
                    self.warn(item.atom_span(), message.to_owned());
                }
                if *group == Group::Timed && self.setting.time_limit == Some(false) {
                    self.warn(item.atom_span(), "`[ ]` without a time limit runs as `< >`".to_owned());
                }
                let outside = self.held;
                if matches!(group, Group::Hold | Group::Timed) {
                    self.held = outside.or(Some(*group));
                }
                items.iter().for_each(|member| self.item(member));
                self.held = outside;
            }
        }
    }

    fn multipliers(&mut self, item: &Item) {
        let mut emptied = ends_empty(item.atom());
        for &Multiplier { repeat, span } in item.multipliers() {
            if repeat == Repeat::Times(NonZeroU32::MIN) {
                self.warn(span, "multiplier `1` does nothing: once is how often it runs anyway".to_owned());
            } else if let Some(group) = self.held {
                let (open, close) = group.brackets();
                let message = format!(
                    "multiplier `{repeat}` does nothing: inside `{open} {close}` a second run finds no rays, since \
                     what the first one spawned is held until the group ends"
                );
                self.warn(span, message);
            } else if emptied {
                let message = format!(
                    "multiplier `{repeat}` does nothing: the `*` before it has already run until no ray was left"
                );
                self.warn(span, message);
            }
            emptied |= repeat == Repeat::UntilEmpty;
        }
    }
}

/// Whether an atom, once run, leaves nothing that running it again would trace: it is one item that ends with a `*`.
fn ends_empty(atom: &Atom) -> bool {
    let Atom::Group(Group::Inherit, items) = atom else {
        return false;
    };
    let [only] = items.as_slice() else {
        return false;
    };
    only.multipliers().iter().any(|multiplier| multiplier.repeat == Repeat::UntilEmpty) || ends_empty(only.atom())
}
