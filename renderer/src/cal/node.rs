//! Parsed expressions: a flat list of nodes that name each other by index.

/// Index of a node.
pub(super) type NodeId = u32;

/// Index of a symbol.
pub(super) type SymbolId = u32;

/// Operators of two operands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Operator {
    Add,
    Subtract,
    Multiply,
    Divide,
    Power,
}

/// A list of operands: where it starts in [`Nodes::lists`], and how many there are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct List {
    pub(super) start: u32,
    pub(super) length: u32,
}

/// One step of an expression.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Node {
    Number(f64),
    /// A variable; as an argument, perhaps a function.
    Variable(SymbolId),
    /// A parameter of the function that is being defined, from 0.
    Parameter(u32),
    /// `$n`: what the surroundings give as their channel n.
    Channel(u32),
    Negate(NodeId),
    Binary(Operator, NodeId, NodeId),
    Call(SymbolId, List),
    /// A call of a function that was passed as a parameter.
    CallParameter(u32, List),
}

/// All nodes of a set of functions.
#[derive(Clone, Debug, Default)]
pub(super) struct Nodes {
    nodes: Vec<Node>,
    lists: Vec<NodeId>,
}

impl Nodes {
    pub(super) fn get(&self, id: NodeId) -> Node {
        self.nodes[id as usize]
    }

    pub(super) fn list(&self, list: List) -> &[NodeId] {
        &self.lists[list.start as usize..(list.start + list.length) as usize]
    }

    /// Adds a node; an operation on two numbers becomes a number.
    pub(super) fn add(&mut self, node: Node) -> NodeId {
        let node = match node {
            Node::Negate(of) => match self.get(of) {
                Node::Number(value) => Node::Number(-value),
                _ => node,
            },
            Node::Binary(operator, left, right) => match (self.get(left), self.get(right)) {
                (Node::Number(left), Node::Number(right)) => Node::Number(operate(operator, left, right)),
                _ => node,
            },
            _ => node,
        };
        self.nodes.push(node);
        (self.nodes.len() - 1) as NodeId
    }

    pub(super) fn add_list(&mut self, ids: &[NodeId]) -> List {
        let start = self.lists.len() as u32;
        self.lists.extend_from_slice(ids);
        List { start, length: ids.len() as u32 }
    }

    pub(super) fn len(&self) -> usize {
        self.nodes.len()
    }
}

/// An operator's value. Division by 0 and powers that are no finite number give 0, as in Radiance's evaluator.
pub(super) fn operate(operator: Operator, left: f64, right: f64) -> f64 {
    match operator {
        Operator::Add => left + right,
        Operator::Subtract => left - right,
        Operator::Multiply => left * right,
        Operator::Divide if right == 0.0 => 0.0,
        Operator::Divide => left / right,
        Operator::Power => {
            let power = left.powf(right);
            if power.is_finite() { power } else { 0.0 }
        }
    }
}
