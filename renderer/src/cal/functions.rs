//! A set of definitions and of expressions that use them.

use super::channels::CHANNELS;
use super::library::Dialect;
use super::node::{Node, NodeId, SymbolId};
use super::parse::{BadExpression, Parser};
use super::symbols::{Definition, Symbols, context};
use crate::diagnostic::{Error, Problems};

/// Definitions that every function of a ray's hit can use.
const RAY_DEFINITIONS: &str = include_str!("rays.cal");

/// An expression of a set of functions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Expression(pub(super) NodeId);

/// An expression of parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Lambda(pub(super) NodeId);

/// Definitions from function files and elsewhere, and expressions.
#[derive(Clone, Debug)]
pub struct Functions {
    pub(super) symbols: Symbols,
    /// The texts that were read: their names, and what they say.
    texts: Vec<(String, String)>,
}

impl Functions {
    /// How many texts were read.
    #[must_use]
    pub fn texts(&self) -> usize {
        self.texts.len()
    }

    /// The library alone, and for a generator the constant `PI`; for rays also the definitions that scenes take for
    /// granted (Radiance's `rayinit.cal`).
    #[must_use]
    pub fn new(dialect: Dialect) -> Self {
        let mut functions = Self { symbols: Symbols::new(dialect), texts: Vec::new() };
        match dialect {
            Dialect::Generator => functions.set_globally("PI", std::f64::consts::PI),
            Dialect::Ray => {
                for (index, name) in CHANNELS.into_iter().enumerate() {
                    let body = functions.symbols.nodes.add(Node::Channel(index as u32 + 1));
                    functions.symbols.define(name, "", Definition { parameters: None, body }, 0);
                }
                let defined = functions.define_globally("rays.cal", RAY_DEFINITIONS);
                debug_assert!(defined.is_ok(), "{defined:?}");
            }
        }
        functions
    }

    /// Reads a function file into its own context.
    ///
    /// # Errors
    /// The text's syntax errors, at most [`crate::diagnostic::MAX_ERRORS`].
    pub fn define_file(&mut self, file: &str, text: &str) -> Result<(), Vec<Error>> {
        self.define_in(&context(file), file, text)
    }

    /// Reads definitions for all (`-e` of the generators); `name` is for messages.
    ///
    /// # Errors
    /// See [`Self::define_file`].
    pub fn define_globally(&mut self, name: &str, text: &str) -> Result<(), Vec<Error>> {
        self.define_in("", name, text)
    }

    fn define_in(&mut self, context: &str, name: &str, text: &str) -> Result<(), Vec<Error>> {
        self.begin(name, text);
        let mut problems = Problems::default();
        let told = |bad: BadExpression| Error::in_text(name, text, bad.start, bad.end, bad.message);
        match Parser::new(text, &mut self.symbols, context) {
            Err(bad) => problems.add(told(bad)),
            Ok(mut parser) => {
                while !parser.at_end() && !problems.full() {
                    if let Err(bad) = parser.statement() {
                        problems.add(told(bad));
                        parser.recover();
                    }
                }
            }
        }
        if problems.is_empty() { Ok(()) } else { Err(problems.into_errors()) }
    }

    fn begin(&mut self, name: &str, text: &str) {
        self.symbols.text = self.texts.len() as u32;
        self.texts.push((name.to_owned(), text.to_owned()));
    }

    /// Gives a name a value for all.
    pub fn set_globally(&mut self, name: &str, value: f64) {
        let body = self.symbols.nodes.add(Node::Number(value));
        self.symbols.define(name, "", Definition { parameters: None, body }, 0);
    }

    /// Reads an expression as if it stood in the function file `file` (`.` for none). Its names are looked up now, so
    /// the file's definitions come first; [`Self::check`] tells whether it can be evaluated.
    ///
    /// # Errors
    /// A syntax error, with offsets in `text`.
    pub fn expression(&mut self, file: &str, text: &str) -> Result<Expression, BadExpression> {
        let context = context(file);
        self.begin(text, text);
        Parser::new(text, &mut self.symbols, &context)?.whole(&[]).map(Expression)
    }

    /// Reads an expression of parameters, without context.
    ///
    /// # Errors
    /// A syntax error, with offsets in `text`.
    pub fn lambda(&mut self, parameters: &[&'static str], text: &str) -> Result<Lambda, BadExpression> {
        self.begin(text, text);
        Parser::new(text, &mut self.symbols, "")?.whole(parameters).map(Lambda)
    }

    /// Reads an expression of parameters as if it stood in the function file `file` (`.` for none).
    ///
    /// # Errors
    /// A syntax error, with offsets in `text`.
    pub fn lambda_in(&mut self, file: &str, parameters: &[&'static str], text: &str) -> Result<Lambda, BadExpression> {
        let context = context(file);
        self.begin(text, text);
        Parser::new(text, &mut self.symbols, &context)?.whole(parameters).map(Lambda)
    }

    /// How many parameters the function has that `name` means in the function file `file`: `None` for what is no
    /// function, or one of the library.
    #[must_use]
    pub fn parameters(&self, file: &str, name: &str) -> Option<u32> {
        let symbol = self.symbols.get(self.symbols.find(name, &context(file))?);
        symbol.definition?.parameters
    }

    /// Whether a name is a function of that many parameters, or a variable (no parameters).
    #[must_use]
    pub fn defines(&self, name: &str, parameters: Option<u32>) -> bool {
        let symbol = self.symbols.find(name, "").map(|id| self.symbols.get(id));
        symbol.and_then(|symbol| symbol.definition).is_some_and(|definition| definition.parameters == parameters)
    }

    /// Whether everything that an expression may need is defined: `None`, or what is wrong with which name. What is
    /// passed as an argument may be a function and is not looked into.
    #[must_use]
    pub fn check(&self, expression: Expression) -> Option<String> {
        self.check_node(expression.0)
    }

    /// The same for an expression of parameters.
    #[must_use]
    pub fn check_lambda(&self, lambda: Lambda) -> Option<String> {
        self.check_node(lambda.0)
    }

    fn check_node(&self, root: NodeId) -> Option<String> {
        let mut nodes = vec![(root, false)];
        let (mut seen_nodes, mut seen_symbols) =
            (vec![false; self.symbols.nodes.len()], vec![false; self.symbols.len()]);
        while let Some((id, passed)) = nodes.pop() {
            if std::mem::replace(&mut seen_nodes[id as usize], true) {
                continue;
            }
            let mut symbol_body = |id: SymbolId| -> Option<NodeId> {
                let body = self.symbols.get(id).definition?.body;
                (!std::mem::replace(&mut seen_symbols[id as usize], true)).then_some(body)
            };
            match self.symbols.nodes.get(id) {
                Node::Number(_) | Node::Parameter(_) | Node::Channel(_) => {}
                Node::Negate(of) => nodes.push((of, false)),
                Node::Binary(_, left, right) => nodes.extend([(left, false), (right, false)]),
                Node::Variable(id) => {
                    let symbol = self.symbols.get(id);
                    let is_variable = symbol.definition.is_some_and(|definition| definition.parameters.is_none());
                    let is_function = symbol.definition.is_some() || symbol.library.is_some();
                    if !(is_variable || passed && is_function) {
                        return Some(self.undefined(id, "variable"));
                    }
                    nodes.extend(symbol_body(id).map(|body| (body, false)));
                }
                Node::Call(id, list) => {
                    let symbol = self.symbols.get(id);
                    let definition = symbol.definition.and_then(|definition| definition.parameters);
                    let wanted = match (definition, symbol.library) {
                        (Some(parameters), _) => parameters as usize,
                        (None, Some(library)) => library.arguments(),
                        (None, None) => return Some(self.undefined(id, "function")),
                    };
                    let arguments = self.symbols.nodes.list(list);
                    if arguments.len() < wanted {
                        let found = arguments.len();
                        return Some(format!("`{}` wants {wanted} arguments, found {found}", symbol.name));
                    }
                    nodes.extend(arguments.iter().map(|&argument| (argument, true)));
                    nodes.extend(symbol_body(id).map(|body| (body, false)));
                }
                Node::CallParameter(_, list) => {
                    nodes.extend(self.symbols.nodes.list(list).iter().map(|&argument| (argument, true)));
                }
            }
        }
        None
    }

    /// `x` is not defined, with the place of its first use if that is in a file.
    fn undefined(&self, id: SymbolId, sort: &str) -> String {
        let symbol = self.symbols.get(id);
        let bare = symbol.name.split('`').next().unwrap_or_default();
        let shown = if bare.is_empty() { symbol.name.as_str() } else { bare };
        let mut message = format!("{sort} `{shown}` is not defined");
        let (text, offset) = symbol.met;
        if let Some((name, text)) = self.texts.get(text as usize)
            && name != text
        {
            let (line, column, _) = crate::diagnostic::locate(text, offset);
            message.push_str(&format!(" (used at {name}:{line}:{column})"));
        }
        message
    }

    /// All defined names, qualified.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.symbols.names()
    }
}
