//! A crex in plain words, for `crex plan`.

use std::fmt::Write as _;

use super::ast::{Ast, Atom, Group, Item, Repeat};
use super::program::Program;
use crate::component::Component;

/// What a component's rays are, in words.
fn rays(component: Component) -> &'static str {
    match component {
        Component::Diffuse => "indirect diffuse rays",
        Component::Specular => "mirror-like rays off smooth plastic, metal and trans",
        Component::Glossy => "rays off or through rough glossy surfaces",
        Component::Transmitted => "rays through glass and dielectric",
        Component::Reflected => "rays reflected by glass and dielectric",
        Component::Mirror => "rays reflected by mirrors",
    }
}

/// Says what a crex does, a line for every component and group, members indented below their group.
#[must_use]
pub fn explain(ast: &Ast) -> String {
    let program = Program::new(ast);
    let mut words = Words { text: String::new(), thresholds: program.thresholds(), held: false, timed: false };
    words.line(0, "Primary rays run first. At every hit of every ray, direct light is added to the picture,");
    words.line(0, "and the rays that the surface spawns wait in the bins of their components.");
    if ast.items().is_empty() {
        words.line(0, "The crex is empty: nothing else runs.");
        return words.text;
    }
    words.members(ast.items(), 0, None);
    words.line(0, "Rays still waiting at the end are dropped.");
    words.text
}

struct Words<'t> {
    text: String,
    /// Thresholds not yet spoken of.
    thresholds: &'t [f32],
    /// Inside a group that holds what is spawned.
    held: bool,
    /// Inside a `[ ]`.
    timed: bool,
}

impl Words<'_> {
    fn line(&mut self, depth: usize, line: &str) {
        writeln!(self.text, "{:1$}{line}", "", 2 * depth).expect("a String takes all");
    }

    fn members(&mut self, items: &[Item], depth: usize, within: Option<Group>) {
        for (place, item) in items.iter().enumerate() {
            let mut line = format!("{}. {item}: ", place + 1);
            if within == Some(Group::Importance) {
                let (threshold, rest) = self.thresholds.split_first().expect("a threshold for every member");
                self.thresholds = rest;
                let rounded = format!("{threshold:.3}");
                let shown = rounded.trim_end_matches('0').trim_end_matches('.');
                write!(line, "on pixels of importance {shown} and more, ").expect("a String takes all");
            }
            line.push_str(&self.often(item));
            match item.atom() {
                Atom::Component(component) => {
                    let which = if self.held { "that were waiting when the group began" } else { "now waiting" };
                    writeln!(line, "trace the {} {which}.", rays(*component)).expect("a String takes all");
                    self.line(depth + 1, line.trim_end());
                }
                Atom::Group(group, members) => {
                    line.push_str(self.how(*group));
                    self.line(depth + 1, &line);
                    let outside = (self.held, self.timed);
                    self.held |= matches!(group, Group::Hold | Group::Timed);
                    self.timed |= *group == Group::Timed;
                    self.members(members, depth + 1, Some(*group));
                    (self.held, self.timed) = outside;
                }
            }
        }
    }

    /// The multipliers in words.
    fn often(&self, item: &Item) -> String {
        let mut words = String::new();
        for multiplier in item.multipliers().iter().rev() {
            match multiplier.repeat {
                Repeat::Times(times) if times.get() == 1 => {}
                Repeat::Times(times) => write!(words, "{times} times in a row, ").expect("a String takes all"),
                Repeat::UntilEmpty => words.push_str("again and again until a run traces no ray, "),
            }
        }
        if self.held && !words.is_empty() {
            words.push_str("though only the first run finds rays, ");
        }
        words
    }

    /// What a group means, given those around it.
    fn how(&self, group: Group) -> &'static str {
        match group {
            Group::Timed if self.timed => "a part of the `[ ]` around it:",
            _ if self.held && group != Group::Importance => "a part of the group around it, which still holds rays:",
            Group::Inherit => "in order, each member also on what earlier ones spawned:",
            Group::Hold => "each member on the rays now waiting; what they spawn is held until the group ends:",
            Group::Importance => "in order, each member only on the pixels whose importance reaches its threshold:",
            Group::Timed => {
                "under a time limit whole or not at all; each member on the rays now waiting, what they spawn is held \
                 until the group ends:"
            }
        }
    }
}
