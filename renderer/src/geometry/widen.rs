//! Brings a hierarchy of pairs into one of nodes with eight boxes and leaves with eight triangles.
//!
//! Which of the pairs become nodes is chosen so that a ray is expected to visit the fewest (by the surface areas of boxes, and dynamic
//! programming over how many boxes each subtree is spread on: Ylitie, Karras and Laine, HPG 2017, section 3.2).

use glam::Vec3A;

use super::block::{Block, LANES, Part};
use super::lanes::Level;
use super::wide::{Link, Node, WIDTH, Wide};

/// A node of a hierarchy of pairs.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pair {
    /// Corners of its box.
    pub(super) low: Vec3A,
    pub(super) high: Vec3A,
    /// Of a leaf the number of its shape, else of the first of the two children, which follow each other.
    pub(super) first: u32,
    /// Whether it is a leaf.
    pub(super) is_leaf: bool,
}

impl Pair {
    fn half_area(&self) -> f32 {
        let size = self.high - self.low;
        size.x * size.y + size.y * size.z + size.z * size.x
    }
}

/// What becomes of a pair.
#[derive(Clone, Copy)]
enum Kind {
    /// A node, or it is dissolved; its children in the list of branches.
    Inner([u32; 2]),
    /// A leaf of what is below it.
    Block,
    /// A shape that fits into no block.
    Single,
}

/// A pair above or at the leaves.
#[derive(Clone, Copy)]
struct Branch {
    pair: Pair,
    kind: Kind,
    /// The least cost of the subtree, if it may be spread on one to eight boxes.
    cost: [f32; WIDTH],
}

/// Widens the hierarchy below `root`; `pair` tells the others by their numbers, and `parts` adds the triangles that a shape is made
/// of, or none if it is to be alone. Also returns the shapes in their new order, by which the result names them.
pub(super) fn widen(
    root: Option<Pair>,
    pair: impl Fn(u32) -> Pair,
    level: Level,
    parts: impl Fn(u32, &mut Vec<Part>),
) -> (Wide, Vec<u32>) {
    let mut wide = Wide { level, ..Wide::default() };
    let mut order = Vec::new();
    let Some(root) = root else { return (wide, order) };
    let mut tree = Tree { pair, parts, found: Vec::new(), waiting: Vec::new() };
    let branches = tree.branches(root);
    // Depth first, so that what is near in space is near in memory. (branch, the link to it, boxes that can wait when it is come to)
    let mut todo = vec![(0, None, 0)];
    let mut children = Vec::new();
    while let Some((branch, from, left)) = todo.pop() {
        children.clear();
        spread(&branches, branch, &mut children);
        let left = left + children.len() - 1;
        wide.most_waiting = wide.most_waiting.max(left + 1);
        let index = wide.nodes.len();
        if let Some((parent, lane)) = from {
            wide.nodes[parent as usize].link_to(lane, Link::node(index));
        }
        let mut node = Node::empty();
        for (lane, &child) in children.iter().enumerate() {
            let Branch { pair, kind, .. } = branches[child as usize];
            let link = match kind {
                Kind::Inner(_) => {
                    todo.push((child, Some((index as u32, lane)), left));
                    Link::default()
                }
                Kind::Block => {
                    tree.fits(pair);
                    for part in &mut tree.found {
                        if order.last() != Some(&part.slot) {
                            order.push(part.slot);
                        }
                        part.slot = order.len() as u32 - 1;
                    }
                    wide.blocks.push(Block::new(&tree.found));
                    Link::block(wide.blocks.len() - 1)
                }
                Kind::Single => {
                    order.push(pair.first);
                    Link::single(order.len() - 1)
                }
            };
            node.set(lane, pair.low.to_array(), pair.high.to_array(), link);
        }
        wide.nodes.push(node);
    }
    (wide, order)
}

/// The branches that become boxes of the node which `branch` becomes.
fn spread(branches: &[Branch], branch: u32, children: &mut Vec<u32>) {
    let Kind::Inner(below) = branches[branch as usize].kind else { return children.push(branch) };
    let mut todo = vec![(below, WIDTH)];
    while let Some(([a, b], boxes)) = todo.pop() {
        let (_, for_a) = share(branches, [a, b], boxes);
        for (branch, boxes) in [(b, boxes - for_a), (a, for_a)] {
            let Branch { kind, cost, .. } = &branches[branch as usize];
            match kind {
                // What gains nothing from more than one box gets one.
                Kind::Inner(below) if cost[boxes - 1] < cost[0] => todo.push((*below, boxes)),
                _ => children.push(branch),
            }
        }
    }
}

/// The least cost of two branches on so many boxes, and how many of these the first gets.
fn share(branches: &[Branch], [a, b]: [u32; 2], boxes: usize) -> (f32, usize) {
    let (a, b) = (&branches[a as usize].cost, &branches[b as usize].cost);
    let costs = (1..boxes).map(|for_a| (a[for_a - 1] + b[boxes - for_a - 1], for_a));
    costs.min_by(|x, y| x.0.total_cmp(&y.0)).unwrap_or((f32::INFINITY, 1))
}

struct Tree<P, T> {
    pair: P,
    parts: T,
    /// What was last found to fit into a block.
    found: Vec<Part>,
    waiting: Vec<Pair>,
}

impl<P: Fn(u32) -> Pair, T: Fn(u32, &mut Vec<Part>)> Tree<P, T> {
    fn below(&self, parent: &Pair) -> [Pair; 2] {
        [(self.pair)(parent.first), (self.pair)(parent.first + 1)]
    }

    fn branch(&mut self, pair: Pair) -> Branch {
        let kind = if self.fits(pair) {
            Kind::Block
        } else if pair.is_leaf {
            Kind::Single
        } else {
            Kind::Inner([0; 2])
        };
        Branch { pair, kind, cost: [pair.half_area(); WIDTH] }
    }

    /// The root and all below it down to what fits into blocks, each before its children.
    fn branches(&mut self, root: Pair) -> Vec<Branch> {
        let mut branches = vec![self.branch(root)];
        let mut next = 0;
        while next < branches.len() {
            let Branch { pair, kind, .. } = branches[next];
            if let Kind::Inner(_) = kind {
                let first = branches.len() as u32;
                for below in self.below(&pair) {
                    branches.push(self.branch(below));
                }
                branches[next].kind = Kind::Inner([first, first + 1]);
            }
            next += 1;
        }
        for index in (0..branches.len()).rev() {
            if let Kind::Inner(below) = branches[index].kind {
                let mut cost = [0.0; WIDTH];
                cost[0] = branches[index].pair.half_area() + share(&branches, below, WIDTH).0;
                for boxes in 2..=WIDTH {
                    cost[boxes - 1] = share(&branches, below, boxes).0.min(cost[boxes - 2]);
                }
                branches[index].cost = cost;
            }
        }
        branches
    }

    /// Whether all below a pair fits into a block, and if so what that is.
    fn fits(&mut self, pair: Pair) -> bool {
        self.found.clear();
        self.waiting.clear();
        self.waiting.push(pair);
        while let Some(next) = self.waiting.pop() {
            if next.is_leaf {
                let before = self.found.len();
                (self.parts)(next.first, &mut self.found);
                if self.found.len() == before || self.found.len() > LANES {
                    return false;
                }
            } else if self.found.len() + self.waiting.len() + 2 > LANES {
                return false;
            } else {
                let below = self.below(&next);
                self.waiting.extend(below);
            }
        }
        true
    }
}
