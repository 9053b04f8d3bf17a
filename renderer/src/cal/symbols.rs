//! Names and what they mean. Every function file is a context; a name in it is looked for in the context first, then
//! among the names of all.
//!
//! A qualified name is a name and the context's path, with a mark (`` ` ``) before each part: `x` of `wood.cal` is
//! `` x`wood ``. A mark before a name keeps the search within the context, a mark after it makes it global.

use std::collections::HashMap;

use super::library::{Dialect, Library};
use super::node::{NodeId, Nodes, SymbolId};

/// What a name stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Definition {
    /// How many parameters a function has; `None` for a variable.
    pub(super) parameters: Option<u32>,
    pub(super) body: NodeId,
}

#[derive(Clone, Debug)]
pub(super) struct Symbol {
    /// Qualified.
    pub(super) name: String,
    pub(super) definition: Option<Definition>,
    pub(super) library: Option<Library>,
    /// The text (by its number) and the byte offset at which it was first met.
    pub(super) met: (u32, usize),
}

/// All names of a set of functions.
#[derive(Clone, Debug)]
pub(super) struct Symbols {
    pub(super) nodes: Nodes,
    pub(super) dialect: Dialect,
    symbols: Vec<Symbol>,
    by_name: HashMap<String, SymbolId>,
    /// The text that is being parsed.
    pub(super) text: u32,
}

impl Symbols {
    pub(super) fn new(dialect: Dialect) -> Self {
        Self { nodes: Nodes::default(), dialect, symbols: Vec::new(), by_name: HashMap::new(), text: 0 }
    }

    pub(super) fn get(&self, id: SymbolId) -> &Symbol {
        &self.symbols[id as usize]
    }

    pub(super) fn len(&self) -> usize {
        self.symbols.len()
    }

    pub(super) fn names(&self) -> impl Iterator<Item = &str> {
        self.symbols.iter().filter(|symbol| symbol.definition.is_some()).map(|symbol| symbol.name.as_str())
    }

    /// What a name means where it is used; a name that nothing defines yet is taken to be the context's own, unless the
    /// library has it.
    pub(super) fn reference(&mut self, name: &str, context: &str, offset: usize) -> SymbolId {
        if let Some(known) = self.find(name, context) {
            return known;
        }
        let library = Library::named(name, self.dialect);
        let qualified = if library.is_some() { name.to_owned() } else { qualify(name, context) };
        self.insert(qualified, library, offset)
    }

    /// The nearest meaning that a name has already.
    pub(super) fn find(&self, name: &str, context: &str) -> Option<SymbolId> {
        if let Some(&id) = self.by_name.get(&qualify(name, context)) {
            return Some(id);
        }
        // A mark at either end has said where to look.
        if name.starts_with('`') || name.ends_with('`') {
            return None;
        }
        let mut path = context;
        while !path.is_empty() {
            path = path[1..].find('`').map_or("", |mark| &path[mark + 1..]);
            if let Some(&id) = self.by_name.get(&format!("{name}{path}")) {
                return Some(id);
            }
        }
        None
    }

    /// Defines a name in its context; a later definition replaces an earlier one for all who use the name.
    pub(super) fn define(&mut self, name: &str, context: &str, definition: Definition, offset: usize) {
        let qualified = qualify(name, context);
        let id = match self.by_name.get(&qualified) {
            Some(&id) => id,
            None => {
                let library = Library::named(&qualified, self.dialect);
                self.insert(qualified, library, offset)
            }
        };
        self.symbols[id as usize].definition = Some(definition);
    }

    fn insert(&mut self, qualified: String, library: Option<Library>, offset: usize) -> SymbolId {
        let id = self.symbols.len() as SymbolId;
        self.by_name.insert(qualified.clone(), id);
        self.symbols.push(Symbol { name: qualified, definition: None, library, met: (self.text, offset) });
        id
    }
}

fn qualify(name: &str, context: &str) -> String {
    if let Some(global) = name.strip_suffix('`').filter(|global| !global.is_empty()) {
        return global.trim_start_matches('`').to_owned();
    }
    format!("{}{context}", name.strip_prefix('`').unwrap_or(name))
}

/// The context of a function file: a mark and its name without `.cal`; what cannot stand in a name becomes `_`. The name
/// `.` is no file and has no context.
pub(super) fn context(file: &str) -> String {
    if file == "." || file.is_empty() {
        return String::new();
    }
    let bare = match file.len().checked_sub(4).and_then(|at| Some((file.get(..at)?, file.get(at..)?))) {
        Some((bare, suffix)) if !bare.is_empty() && suffix.eq_ignore_ascii_case(".cal") => bare,
        _ => file,
    };
    let bare = bare.trim_matches('`');
    let letter = |letter: char| {
        let allowed = letter.is_ascii_alphanumeric() || matches!(letter, '_' | '.' | '`');
        if allowed { letter } else { '_' }
    };
    if bare.is_empty() { String::new() } else { format!("`{}", bare.chars().map(letter).collect::<String>()) }
}
