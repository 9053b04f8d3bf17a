//! Evaluation: parameters by need, variables once for each place where they are asked for.

use std::cell::Cell;
use std::fmt;

use super::functions::{Expression, Functions, Lambda};
use super::library::Library;
use super::node::{List, Node, NodeId, SymbolId, operate};

/// Evaluations within evaluations: what a thread's stack surely holds.
const MAX_DEPTH: u32 = 2000;

/// Steps of one evaluation; a picture's pixel asks for some hundred.
const MAX_STEPS: u64 = 1_000_000;

/// Steps that the evaluations of a [`Evaluator::thrifty`] may take in all: this many, and so many more for each.
const THRIFTY: (u64, u64) = (20_000_000, 500);

/// Arguments of a call beyond these are evaluated anew each time they are used.
const KEPT: usize = 10;

/// What an expression can ask of the place where it is evaluated.
pub trait Surroundings {
    /// The value of channel `n` (`$n`), from 1; `None` if there is none here.
    fn channel(&self, n: u32) -> Option<f64>;

    /// How many real arguments the primitive has.
    fn count(&self) -> usize;

    /// Real argument `n`, from 1.
    fn argument(&self, n: usize) -> Option<f64>;
}

/// Nowhere: for expressions of their parameters alone.
#[derive(Clone, Copy, Debug, Default)]
pub struct Nowhere;

impl Surroundings for Nowhere {
    fn channel(&self, _: u32) -> Option<f64> {
        None
    }

    fn count(&self) -> usize {
        0
    }

    fn argument(&self, _: usize) -> Option<f64> {
        None
    }
}

/// Why an evaluation has no value.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum EvaluationError {
    /// A name that nothing defines.
    Undefined(String),
    /// A call with too few arguments.
    TooFewArguments(String),
    /// A parameter is called that is no function.
    NotAFunction(String),
    /// A channel that the surroundings do not have: the value belongs to another sort of primitive.
    NoChannel(u32),
    /// `arg(n)` beyond the primitive's real arguments.
    NoArgument(usize),
    /// The evaluation does not end, or not soon.
    Endless,
}

impl fmt::Display for EvaluationError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Undefined(name) => write!(f, "`{name}` is not defined"),
            Self::TooFewArguments(name) => write!(f, "`{name}` is called with too few arguments"),
            Self::NotAFunction(name) => write!(f, "an argument of `{name}` is called, but it is no function"),
            Self::NoChannel(n) => write!(f, "{} has no value here", super::channels::name(*n)),
            Self::NoArgument(n) => write!(f, "real argument {n} is missing"),
            Self::Endless => {
                write!(
                    f,
                    "the evaluation goes deeper than {MAX_DEPTH} or takes more than {MAX_STEPS} steps, or with all before it too many"
                )
            }
        }
    }
}

impl std::error::Error for EvaluationError {}

type Result<T> = std::result::Result<T, EvaluationError>;

/// The variables' values of an evaluator, kept between evaluators so that a hit allocates nothing.
#[derive(Clone, Debug, Default)]
pub struct Memory {
    /// By symbol: a variable's value, and for which place it was computed.
    values: Vec<(u64, f64)>,
    /// The place.
    place: u64,
}

/// Evaluates expressions of a set of functions. One for each thread: it keeps the variables' values.
pub struct Evaluator<'a> {
    functions: &'a Functions,
    memory: Memory,
    depth: u32,
    steps: u64,
    /// Steps that this evaluation may take.
    most: u64,
    /// What is left for the evaluations to come, if they are bounded together.
    left: Option<u64>,
}

/// A call in progress.
struct Frame<'a> {
    /// Who is called, for messages; nobody for a lambda.
    called: Option<SymbolId>,
    arguments: Arguments<'a>,
    kept: [Cell<f64>; KEPT],
    /// Bits of the arguments whose values are kept.
    known: Cell<u32>,
    caller: Option<&'a Frame<'a>>,
}

enum Arguments<'a> {
    Nodes(&'a [NodeId]),
    Values(&'a [f64]),
}

impl<'a> Evaluator<'a> {
    /// A fresh one.
    #[must_use]
    pub fn new(functions: &'a Functions) -> Self {
        Self::with(functions, Memory::default())
    }

    /// One with the memory of an earlier one, at another place.
    #[must_use]
    pub fn with(functions: &'a Functions, mut memory: Memory) -> Self {
        memory.values.resize(functions.symbols.len(), (0, 0.0));
        // The first place is 1: no value is kept for 0.
        memory.place += 1;
        Self { functions, memory, depth: 0, steps: 0, most: MAX_STEPS, left: None }
    }

    /// Its memory, for the next one.
    #[must_use]
    pub fn into_memory(self) -> Memory {
        self.memory
    }

    /// One for very many evaluations at once, as a generator makes: together they may take a second and some
    /// microseconds each, so that a line of text with a costly function of a fine grid is an error and not an endless wait.
    #[must_use]
    pub fn thrifty(functions: &'a Functions) -> Self {
        Self { left: Some(THRIFTY.0), ..Self::new(functions) }
    }

    /// Forgets the variables' values: what is asked next is asked at another place.
    pub fn move_on(&mut self) {
        self.memory.place += 1;
    }

    /// The value of an expression. Variables keep their values until [`Self::move_on`].
    ///
    /// # Errors
    /// See [`EvaluationError`].
    pub fn value(&mut self, expression: Expression, at: &dyn Surroundings) -> Result<f64> {
        self.start();
        self.node(expression.0, at, None)
    }

    /// The value of a function of parameters.
    ///
    /// # Errors
    /// See [`EvaluationError`].
    pub fn apply(&mut self, lambda: Lambda, parameters: &[f64]) -> Result<f64> {
        self.apply_at(lambda, parameters, &Nowhere)
    }

    /// The value of a function of parameters that may ask for its surroundings, too.
    ///
    /// # Errors
    /// See [`EvaluationError`].
    pub fn apply_at(&mut self, lambda: Lambda, parameters: &[f64], at: &dyn Surroundings) -> Result<f64> {
        self.start();
        let frame = Frame {
            called: None,
            arguments: Arguments::Values(parameters),
            kept: Default::default(),
            known: Cell::new(0),
            caller: None,
        };
        self.node(lambda.0, at, Some(&frame))
    }

    fn start(&mut self) {
        if let Some(left) = &mut self.left {
            *left = (*left + THRIFTY.1).saturating_sub(self.steps);
            self.most = MAX_STEPS.min(*left);
        }
        (self.depth, self.steps) = (0, 0);
    }

    fn node(&mut self, id: NodeId, at: &dyn Surroundings, frame: Option<&Frame<'_>>) -> Result<f64> {
        self.steps += 1;
        if self.depth >= MAX_DEPTH || self.steps > self.most {
            return Err(EvaluationError::Endless);
        }
        self.depth += 1;
        let value = match self.functions.symbols.nodes.get(id) {
            Node::Number(value) => Ok(value),
            Node::Variable(symbol) => self.variable(symbol, at, frame),
            Node::Parameter(index) => self.parameter(index, at, frame),
            Node::Channel(n) => at.channel(n).ok_or(EvaluationError::NoChannel(n)),
            Node::Negate(of) => self.node(of, at, frame).map(|value| -value),
            Node::Binary(operator, left, right) => match self.node(left, at, frame) {
                Ok(left) => self.node(right, at, frame).map(|right| operate(operator, left, right)),
                error => error,
            },
            Node::Call(symbol, list) => self.call(symbol, list, at, frame),
            Node::CallParameter(index, list) => match self.passed(index, frame) {
                Ok(symbol) => self.call(symbol, list, at, frame),
                Err(error) => Err(error),
            },
        };
        self.depth -= 1;
        value
    }

    fn name(&self, symbol: Option<SymbolId>) -> String {
        symbol.map_or_else(String::new, |symbol| self.functions.symbols.get(symbol).name.clone())
    }

    fn variable(&mut self, symbol: SymbolId, at: &dyn Surroundings, frame: Option<&Frame<'_>>) -> Result<f64> {
        let definition = self.functions.symbols.get(symbol).definition;
        let Some(definition) = definition.filter(|definition| definition.parameters.is_none()) else {
            return Err(EvaluationError::Undefined(self.name(Some(symbol))));
        };
        let kept = self.memory.values[symbol as usize];
        if kept.0 == self.memory.place {
            return Ok(kept.1);
        }
        let value = self.node(definition.body, at, frame)?;
        self.memory.values[symbol as usize] = (self.memory.place, value);
        Ok(value)
    }

    /// The value of a parameter, computed in the caller's frame the first time it is needed.
    fn parameter(&mut self, index: u32, at: &dyn Surroundings, frame: Option<&Frame<'_>>) -> Result<f64> {
        let Some(frame) = frame else { return Err(EvaluationError::TooFewArguments(String::new())) };
        let index = index as usize;
        let node = match frame.arguments {
            Arguments::Values(values) => {
                return values.get(index).copied().ok_or(EvaluationError::TooFewArguments(String::new()));
            }
            Arguments::Nodes(nodes) => nodes.get(index).copied(),
        };
        let Some(node) = node else { return Err(EvaluationError::TooFewArguments(self.name(frame.called))) };
        if index < KEPT && frame.known.get() >> index & 1 == 1 {
            return Ok(frame.kept[index].get());
        }
        let value = self.node(node, at, frame.caller)?;
        if index < KEPT {
            frame.kept[index].set(value);
            frame.known.set(frame.known.get() | 1 << index);
        }
        Ok(value)
    }

    /// The function that was passed as a parameter, perhaps handed on by several callers.
    fn passed(&self, index: u32, frame: Option<&Frame<'_>>) -> Result<SymbolId> {
        let (mut index, mut next) = (index, frame);
        while let Some(frame) = next {
            let Arguments::Nodes(nodes) = frame.arguments else { break };
            let Some(&node) = nodes.get(index as usize) else {
                return Err(EvaluationError::TooFewArguments(self.name(frame.called)));
            };
            match self.functions.symbols.nodes.get(node) {
                Node::Variable(symbol) => return Ok(symbol),
                Node::Parameter(outer) => (index, next) = (outer, frame.caller),
                _ => return Err(EvaluationError::NotAFunction(self.name(frame.called))),
            }
        }
        Err(EvaluationError::NotAFunction(self.name(frame.and_then(|frame| frame.called))))
    }

    fn call(&mut self, symbol: SymbolId, list: List, at: &dyn Surroundings, caller: Option<&Frame<'_>>) -> Result<f64> {
        let functions = self.functions;
        let arguments = functions.symbols.nodes.list(list);
        let called = functions.symbols.get(symbol);
        if let Some(definition) = called.definition.filter(|definition| definition.parameters.is_some()) {
            let frame = Frame {
                called: Some(symbol),
                arguments: Arguments::Nodes(arguments),
                kept: Default::default(),
                known: Cell::new(0),
                caller,
            };
            return self.node(definition.body, at, Some(&frame));
        }
        let Some(library) = called.library else {
            return Err(EvaluationError::Undefined(called.name.clone()));
        };
        if arguments.len() < library.arguments() {
            return Err(EvaluationError::TooFewArguments(called.name.clone()));
        }
        let value = self.library(library, arguments, at, caller)?;
        Ok(if value.is_finite() { value } else { 0.0 })
    }

    fn library(
        &mut self,
        library: Library,
        arguments: &[NodeId],
        at: &dyn Surroundings,
        caller: Option<&Frame<'_>>,
    ) -> Result<f64> {
        match library {
            Library::If => {
                let chosen = if self.node(arguments[0], at, caller)? > 0.0 { 1 } else { 2 };
                self.node(arguments[chosen], at, caller)
            }
            Library::Select => {
                let wanted = self.node(arguments[0], at, caller)?;
                // Rounded to the nearest; 0 asks how many there are.
                let choices = arguments.len() - 1;
                if wanted < -0.5 || wanted.is_nan() {
                    return Ok(0.0);
                }
                match (wanted + 0.5) as usize {
                    0 => Ok(choices as f64),
                    chosen if chosen <= choices => self.node(arguments[chosen], at, caller),
                    _ => Ok(0.0),
                }
            }
            Library::Min | Library::Max => {
                let mut best = self.node(arguments[0], at, caller)?;
                for &argument in &arguments[1..] {
                    let value = self.node(argument, at, caller)?;
                    let better = if library == Library::Min { value < best } else { value > best };
                    if better {
                        best = value;
                    }
                }
                Ok(best)
            }
            Library::Arg => {
                let wanted = self.node(arguments[0], at, caller)? + 0.5;
                if wanted < 1.0 {
                    return Ok(at.count() as f64);
                }
                let n = wanted as usize;
                at.argument(n).ok_or(EvaluationError::NoArgument(n))
            }
            _ => {
                let mut values = [0.0; 5];
                for (value, &argument) in values.iter_mut().zip(&arguments[..library.arguments()]) {
                    *value = self.node(argument, at, caller)?;
                }
                Ok(library.value(&values))
            }
        }
    }
}
