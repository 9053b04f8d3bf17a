//! The grammar: `name = expression;`, `name(a, b) = expression;`, the same with `:` for constants.
//!
//! ```text
//! E1: E1 (+|-) E2 | E2        E2: E2 (*|/) E3 | E3        E3: E4 ^ E3 | E4        E4: (+|-) E5 | E5
//! E5: number | $n | name | name(E1, ..) | (E1)
//! ```
//! A sign binds closer than `^`: `-2^2` is 4.

use super::lexer::{BadToken, Lexer, Token, TokenKind};
use super::node::{Node, NodeId, Operator};
use super::symbols::{Definition, Symbols};

/// Brackets and operators may nest this deep.
const MAX_DEPTH: u32 = 200;

/// A text that is no expression or definition.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BadExpression {
    /// Byte offset of what is wrong.
    pub start: usize,
    /// Byte offset after it.
    pub end: usize,
    /// What was expected.
    pub message: String,
}

impl From<BadToken> for BadExpression {
    fn from(bad: BadToken) -> Self {
        Self { start: bad.start, end: bad.end, message: bad.message.to_owned() }
    }
}

type Result<T> = std::result::Result<T, BadExpression>;

pub(super) struct Parser<'a> {
    lexer: Lexer<'a>,
    token: Token<'a>,
    symbols: &'a mut Symbols,
    context: &'a str,
    parameters: Vec<&'a str>,
    depth: u32,
}

impl<'a> Parser<'a> {
    pub(super) fn new(text: &'a str, symbols: &'a mut Symbols, context: &'a str) -> Result<Self> {
        let mut lexer = Lexer::new(text);
        let token = lexer.next()?;
        Ok(Self { lexer, token, symbols, context, parameters: Vec::new(), depth: 0 })
    }

    pub(super) fn at_end(&self) -> bool {
        self.token.kind == TokenKind::End
    }

    fn advance(&mut self) -> Result<()> {
        self.token = self.lexer.next()?;
        Ok(())
    }

    fn is(&self, sign: char) -> bool {
        self.token.kind == TokenKind::Sign(sign)
    }

    fn wrong<T>(&self, message: impl Into<String>) -> Result<T> {
        let end = self.token.end.max(self.token.start + 1);
        Err(BadExpression { start: self.token.start, end, message: message.into() })
    }

    fn expect(&mut self, sign: char, wanted: &str) -> Result<()> {
        if self.is(sign) { self.advance() } else { self.wrong(format!("expected {wanted}, found {}", self.found())) }
    }

    fn found(&self) -> String {
        match self.token.kind {
            TokenKind::Name(name) => format!("`{name}`"),
            TokenKind::Number(value) => format!("`{value}`"),
            TokenKind::Sign(sign) => format!("`{sign}`"),
            TokenKind::End => "the end".to_owned(),
        }
    }

    /// After an error: past the next `;`, or to the end.
    pub(super) fn recover(&mut self) {
        self.parameters.clear();
        self.depth = 0;
        loop {
            match self.token.kind {
                TokenKind::End => return,
                TokenKind::Sign(';') => {
                    if self.advance().is_ok() {
                        return;
                    }
                }
                _ => while self.advance().is_err() {},
            }
        }
    }

    /// A definition and its `;`, which the last one may lack.
    pub(super) fn statement(&mut self) -> Result<()> {
        if self.is(';') {
            return self.advance();
        }
        let TokenKind::Name(name) = self.token.kind else {
            return self.wrong(format!("expected the name of a definition, found {}", self.found()));
        };
        let offset = self.token.start;
        self.advance()?;
        let mut function = false;
        if self.is('(') {
            function = true;
            loop {
                self.advance()?;
                match self.token.kind {
                    TokenKind::Name(parameter) if !parameter.contains('`') => self.parameters.push(parameter),
                    _ => return self.wrong(format!("expected the name of a parameter, found {}", self.found())),
                }
                self.advance()?;
                if !self.is(',') {
                    break;
                }
            }
            self.expect(')', "`,` or `)`")?;
        }
        if !self.is('=') && !self.is(':') {
            return self.wrong(format!("expected `=` or `:` after `{name}`, found {}", self.found()));
        }
        self.advance()?;
        let body = self.sum()?;
        let parameters = std::mem::take(&mut self.parameters).len();
        if !self.at_end() {
            self.expect(';', "an operator or `;`")?;
        }
        let parameters = function.then_some(parameters as u32);
        self.symbols.define(name, self.context, Definition { parameters, body }, offset);
        Ok(())
    }

    /// An expression that is the whole text, of these parameters.
    pub(super) fn whole(&mut self, parameters: &[&'a str]) -> Result<NodeId> {
        self.parameters = parameters.to_vec();
        let body = self.sum()?;
        if self.at_end() { Ok(body) } else { self.wrong(format!("expected an operator, found {}", self.found())) }
    }

    fn deeper<T>(&mut self, parse: impl FnOnce(&mut Self) -> Result<T>) -> Result<T> {
        self.depth += 1;
        if self.depth > MAX_DEPTH {
            return self.wrong(format!("the expression nests more than {MAX_DEPTH} deep"));
        }
        let parsed = parse(self);
        self.depth -= 1;
        parsed
    }

    fn binary(&mut self, operator: Operator, left: NodeId, right: NodeId) -> NodeId {
        self.symbols.nodes.add(Node::Binary(operator, left, right))
    }

    fn sum(&mut self) -> Result<NodeId> {
        let mut left = self.product()?;
        loop {
            let operator = match self.token.kind {
                TokenKind::Sign('+') => Operator::Add,
                TokenKind::Sign('-') => Operator::Subtract,
                _ => return Ok(left),
            };
            self.advance()?;
            let right = self.product()?;
            left = self.binary(operator, left, right);
        }
    }

    fn product(&mut self) -> Result<NodeId> {
        let mut left = self.power()?;
        loop {
            let operator = match self.token.kind {
                TokenKind::Sign('*') => Operator::Multiply,
                TokenKind::Sign('/') => Operator::Divide,
                _ => return Ok(left),
            };
            self.advance()?;
            let right = self.power()?;
            left = self.binary(operator, left, right);
        }
    }

    fn power(&mut self) -> Result<NodeId> {
        let left = self.signed()?;
        if !self.is('^') {
            return Ok(left);
        }
        self.advance()?;
        let right = self.deeper(Self::power)?;
        Ok(self.binary(Operator::Power, left, right))
    }

    fn signed(&mut self) -> Result<NodeId> {
        if self.is('-') {
            self.advance()?;
            let of = self.operand()?;
            return Ok(self.symbols.nodes.add(Node::Negate(of)));
        }
        if self.is('+') {
            self.advance()?;
        }
        self.operand()
    }

    fn operand(&mut self) -> Result<NodeId> {
        match self.token.kind {
            TokenKind::Number(value) => {
                self.advance()?;
                Ok(self.symbols.nodes.add(Node::Number(value)))
            }
            TokenKind::Sign('(') => {
                self.advance()?;
                let inner = self.deeper(Self::sum)?;
                self.expect(')', "an operator or `)`")?;
                Ok(inner)
            }
            TokenKind::Sign('$') => {
                self.advance()?;
                match self.token.kind {
                    TokenKind::Number(channel) if (1.0..1e6).contains(&channel) && channel.fract() == 0.0 => {
                        self.advance()?;
                        Ok(self.symbols.nodes.add(Node::Channel(channel as u32)))
                    }
                    _ => self.wrong(format!("expected the number of a channel, found {}", self.found())),
                }
            }
            TokenKind::Name(name) => self.named(name),
            TokenKind::Sign(_) | TokenKind::End => {
                self.wrong(format!("expected a number, a name or `(`, found {}", self.found()))
            }
        }
    }

    fn named(&mut self, name: &'a str) -> Result<NodeId> {
        let offset = self.token.start;
        self.advance()?;
        let parameter = self.parameters.iter().position(|parameter| *parameter == name);
        if !self.is('(') {
            let node = match parameter {
                Some(parameter) => Node::Parameter(parameter as u32),
                None => Node::Variable(self.symbols.reference(name, self.context, offset)),
            };
            return Ok(self.symbols.nodes.add(node));
        }
        // The function is looked up before its arguments: the order in which names are first met decides what they mean.
        let symbol = match parameter {
            Some(_) => None,
            None => Some(self.symbols.reference(name, self.context, offset)),
        };
        let mut arguments = Vec::new();
        loop {
            self.advance()?;
            arguments.push(self.deeper(Self::sum)?);
            if !self.is(',') {
                break;
            }
        }
        self.expect(')', "`,` or `)`")?;
        let list = self.symbols.nodes.add_list(&arguments);
        let node = match (symbol, parameter) {
            (Some(symbol), _) => Node::Call(symbol, list),
            (None, parameter) => Node::CallParameter(parameter.unwrap_or(0) as u32, list),
        };
        Ok(self.symbols.nodes.add(node))
    }
}
