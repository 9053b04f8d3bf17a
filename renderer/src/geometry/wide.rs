//! A hierarchy with four boxes in each node, all tested at once: half as deep as one of pairs, and no sum across a vector.

use std::ops::ControlFlow;

use glam::{Vec3A, Vec4};

/// A node of a hierarchy of pairs.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pair {
    /// Corners of its box.
    pub(super) low: Vec3A,
    pub(super) high: Vec3A,
    /// Of a leaf the first item, else the first of the two children, which follow each other.
    pub(super) first: u32,
    /// Items of a leaf; 0 if it has children.
    pub(super) count: u32,
}

impl Pair {
    fn half_area(&self) -> f32 {
        let size = self.high - self.low;
        size.x * size.y + size.y * size.z + size.z * size.x
    }
}

/// Where a box leads: to the node `first`, or if `count` is not 0 to the items `first..first + count`.
#[derive(Clone, Copy, Debug, Default)]
struct Link {
    first: u32,
    count: u32,
}

/// Up to four boxes; what is absent lies at infinity, where no ray meets it.
#[derive(Clone, Copy, Debug)]
struct Node {
    low: [Vec4; 3],
    high: [Vec4; 3],
    links: [Link; 4],
}

/// What waits to be looked at, with the distance of its box.
#[derive(Clone, Copy, Debug, Default)]
struct Waiting {
    near: f32,
    link: Link,
}

/// The hierarchy.
#[derive(Clone, Debug, Default)]
pub(super) struct Wide {
    nodes: Vec<Node>,
    /// Most that can wait at once.
    most_waiting: usize,
}

impl Wide {
    /// Brings a hierarchy of pairs, whose root is its first node, into nodes of four.
    pub(super) fn new(pairs: &[Pair]) -> Self {
        let mut wide = Self::default();
        let Some(root) = pairs.first() else { return wide };
        let mut children = vec![if root.count > 0 { vec![*root] } else { split(pairs, root) }];
        let mut depths = vec![1];
        let mut next = 0;
        // Breadth first: a node's links are known before the nodes themselves.
        while next < children.len() {
            let mut node = Node { low: [Vec4::INFINITY; 3], high: [Vec4::INFINITY; 3], links: [Link::default(); 4] };
            for (lane, child) in std::mem::take(&mut children[next]).iter().enumerate() {
                for axis in 0..3 {
                    node.low[axis][lane] = child.low[axis];
                    node.high[axis][lane] = child.high[axis];
                }
                node.links[lane] = Link { first: child.first, count: child.count };
                if child.count == 0 {
                    node.links[lane].first = u32::try_from(children.len()).expect("fewer nodes than pairs");
                    children.push(split(pairs, child));
                    depths.push(depths[next] + 1);
                }
            }
            wide.nodes.push(node);
            next += 1;
        }
        // Each node that is gone through leaves at most three of its boxes behind.
        wide.most_waiting = 3 * depths.iter().max().copied().unwrap_or(0) + 1;
        wide
    }

    /// Offers the items of every leaf whose box the ray meets before `t_max` to `visit`, about nearest first. It may lower
    /// `t_max`, or stop the walk. `inverse` is one over the direction, finite.
    #[inline]
    pub(super) fn walk(
        &self,
        origin: Vec3A,
        inverse: Vec3A,
        t_max: f32,
        visit: impl FnMut(std::ops::Range<usize>, &mut f32) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        // What waits lies on the stack unless the hierarchy is uncommonly deep.
        if self.most_waiting <= 64 {
            self.walk_in(&mut [Waiting::default(); 64], origin, inverse, t_max, visit)
        } else if self.most_waiting <= 256 {
            self.walk_in(&mut [Waiting::default(); 256], origin, inverse, t_max, visit)
        } else {
            self.walk_in(&mut vec![Waiting::default(); self.most_waiting], origin, inverse, t_max, visit)
        }
    }

    #[inline]
    fn walk_in(
        &self,
        waiting: &mut [Waiting],
        origin: Vec3A,
        inverse: Vec3A,
        mut t_max: f32,
        mut visit: impl FnMut(std::ops::Range<usize>, &mut f32) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let origin = [Vec4::splat(origin.x), Vec4::splat(origin.y), Vec4::splat(origin.z)];
        let inverse = [Vec4::splat(inverse.x), Vec4::splat(inverse.y), Vec4::splat(inverse.z)];
        if self.nodes.is_empty() {
            return ControlFlow::Continue(());
        }
        waiting[0] = Waiting::default();
        let mut count = 1;
        while count > 0 {
            count -= 1;
            let Waiting { near, link } = waiting[count];
            if near >= t_max {
                continue;
            }
            if link.count > 0 {
                let first = link.first as usize;
                visit(first..first + link.count as usize, &mut t_max)?;
                continue;
            }
            let node = &self.nodes[link.first as usize];
            let (near, mut met) = node.meet(&origin, &inverse, t_max);
            let bottom = count;
            while met != 0 {
                let lane = met.trailing_zeros() as usize;
                met &= met - 1;
                // The nearest is looked at first: it goes on top.
                let (mut at, near) = (count, near[lane]);
                while at > bottom && waiting[at - 1].near < near {
                    waiting[at] = waiting[at - 1];
                    at -= 1;
                }
                waiting[at] = Waiting { near, link: node.links[lane] };
                count += 1;
            }
        }
        ControlFlow::Continue(())
    }
}

impl Node {
    /// At what distances the ray enters the boxes, and which of them it meets before `t_max`, a bit for each.
    #[inline]
    fn meet(&self, origin: &[Vec4; 3], inverse: &[Vec4; 3], t_max: f32) -> ([f32; 4], u32) {
        let mut near = Vec4::NEG_INFINITY;
        let mut far = Vec4::INFINITY;
        for axis in 0..3 {
            let to_low = (self.low[axis] - origin[axis]) * inverse[axis];
            let to_high = (self.high[axis] - origin[axis]) * inverse[axis];
            near = near.max(to_low.min(to_high));
            far = far.min(to_low.max(to_high));
        }
        let met = far.cmpge(near) & far.cmpge(Vec4::ZERO) & near.cmplt(Vec4::splat(t_max));
        (near.to_array(), met.bitmask())
    }
}

/// Up to four nodes below one that has children: the largest are opened first, since rays meet them most.
fn split(pairs: &[Pair], parent: &Pair) -> Vec<Pair> {
    let below = |parent: &Pair| [pairs[parent.first as usize], pairs[parent.first as usize + 1]];
    let mut children = below(parent).to_vec();
    while children.len() < 4 {
        let open = children.iter().enumerate().filter(|(_, child)| child.count == 0);
        let Some((index, _)) = open.max_by(|(_, a), (_, b)| a.half_area().total_cmp(&b.half_area())) else { break };
        let opened = children.swap_remove(index);
        children.extend(below(&opened));
    }
    children
}
