//! A hierarchy with eight boxes in each node, and eight triangles in each leaf, all tested at once.

use std::ops::ControlFlow;

use super::block::Block;
use super::lanes::{Lanes, Level, Task};
use super::line::Line;

/// Boxes in a node.
pub(super) const WIDTH: usize = 8;

/// What can wait in most hierarchies, and in all that are not uncommonly deep.
const WAITING: [usize; 2] = [64, 256];

/// Where a box leads.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Link(u32);

impl Link {
    const BLOCK: u32 = 1 << 30;
    const SINGLE: u32 = 1 << 31;

    /// To a node.
    pub(super) fn node(index: usize) -> Self {
        Self::new(0, index)
    }

    /// To a block.
    pub(super) fn block(index: usize) -> Self {
        Self::new(Self::BLOCK, index)
    }

    /// To a shape that is in no block.
    pub(super) fn single(slot: usize) -> Self {
        Self::new(Self::SINGLE, slot)
    }

    fn new(kind: u32, index: usize) -> Self {
        let index = u32::try_from(index).ok().filter(|&index| index < Self::BLOCK);
        Self(kind | index.expect("a scene of 2^30 shapes fits no memory"))
    }

    #[inline(always)]
    fn index(self) -> usize {
        (self.0 & (Self::BLOCK - 1)) as usize
    }
}

/// Up to eight boxes; what is absent no ray meets.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub(super) struct Node {
    /// Low and high end of x, of y, and of z.
    planes: [[f32; WIDTH]; 6],
    links: [Link; WIDTH],
}

impl Node {
    /// A node without boxes.
    pub(super) fn empty() -> Self {
        let (low, high) = ([f32::INFINITY; WIDTH], [f32::NEG_INFINITY; WIDTH]);
        Self { planes: [low, high, low, high, low, high], links: [Link::default(); WIDTH] }
    }

    /// Puts a box into a lane.
    pub(super) fn set(&mut self, lane: usize, low: [f32; 3], high: [f32; 3], link: Link) {
        for axis in 0..3 {
            self.planes[2 * axis][lane] = low[axis];
            self.planes[2 * axis + 1][lane] = high[axis];
        }
        self.link_to(lane, link);
    }

    /// Makes a lane lead elsewhere.
    pub(super) fn link_to(&mut self, lane: usize, link: Link) {
        self.links[lane] = link;
    }
}

/// What waits to be looked at, with the distance of its box.
#[derive(Clone, Copy, Debug, Default)]
struct Waiting {
    near: f32,
    link: Link,
}

/// The hierarchy. Its first node is the root.
#[derive(Clone, Debug, Default)]
pub(super) struct Wide {
    pub(super) nodes: Vec<Node>,
    pub(super) blocks: Vec<Block>,
    /// Most that can wait at once.
    pub(super) most_waiting: usize,
    /// By which instructions it is walked.
    pub(super) level: Level,
}

impl Wide {
    /// Offers every shape that the ray may meet before the line's end to `visit`, which may bring the end nearer, or stop the walk.
    /// If `ORDERED`, about nearest first.
    #[inline(always)]
    pub(super) fn walk<const ORDERED: bool>(
        &self,
        line: &Line,
        visit: impl FnMut(usize, &mut f32) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        if self.nodes.is_empty() {
            return ControlFlow::Continue(());
        }
        self.level.run(Walk::<ORDERED, _> { wide: self, line, visit })
    }
}

struct Walk<'a, const ORDERED: bool, V> {
    wide: &'a Wide,
    line: &'a Line,
    visit: V,
}

impl<const ORDERED: bool, V: FnMut(usize, &mut f32) -> ControlFlow<()>> Task for Walk<'_, ORDERED, V> {
    type Answer = ControlFlow<()>;

    #[inline(always)]
    fn run<L: Lanes>(mut self, lanes: L) -> ControlFlow<()> {
        let Self { wide, line, .. } = self;
        let (mut short, mut middle, mut long);
        let waiting: &mut [Waiting] = if wide.most_waiting <= WAITING[0] {
            short = [Waiting::default(); WAITING[0]];
            &mut short
        } else if wide.most_waiting <= WAITING[1] {
            middle = [Waiting::default(); WAITING[1]];
            &mut middle
        } else {
            long = vec![Waiting::default(); wide.most_waiting];
            &mut long
        };
        // No closures over lanes here, nor `map`: they might be compiled apart, without the lanes' instructions.
        let [x, y, z] = line.inverse;
        let inverse = [lanes.splat(x), lanes.splat(y), lanes.splat(z)];
        let [from_x, from_y, from_z] = line.origin;
        let shift = [lanes.splat(-from_x * x), lanes.splat(-from_y * y), lanes.splat(-from_z * z)];
        // Which end of a box the ray comes to first.
        let first = [usize::from(x < 0.0), 2 + usize::from(y < 0.0), 4 + usize::from(z < 0.0)];
        let mut t_max = line.t_max;
        let mut link = Link::default();
        let mut count = 0;
        loop {
            if link.0 < Link::BLOCK {
                let node = &wide.nodes[link.index()];
                let near = [
                    lanes.mul_add(lanes.load(&node.planes[first[0]]), inverse[0], shift[0]),
                    lanes.mul_add(lanes.load(&node.planes[first[1]]), inverse[1], shift[1]),
                    lanes.mul_add(lanes.load(&node.planes[first[2]]), inverse[2], shift[2]),
                ];
                let far = [
                    lanes.mul_add(lanes.load(&node.planes[first[0] ^ 1]), inverse[0], shift[0]),
                    lanes.mul_add(lanes.load(&node.planes[first[1] ^ 1]), inverse[1], shift[1]),
                    lanes.mul_add(lanes.load(&node.planes[first[2] ^ 1]), inverse[2], shift[2]),
                ];
                let near = lanes.max(lanes.max(near[0], near[1]), lanes.max(near[2], lanes.splat(0.0)));
                let far = lanes.min(lanes.min(far[0], far[1]), lanes.min(far[2], lanes.splat(t_max)));
                let mut met = lanes.at_least(far, near);
                if met != 0 {
                    let lane = met.trailing_zeros() as usize;
                    met &= met - 1;
                    if met == 0 {
                        link = node.links[lane];
                        continue;
                    }
                    let near = lanes.store(near);
                    let other = met.trailing_zeros() as usize;
                    met &= met - 1;
                    // The nearest is looked at first, the others wait, the next nearest on top.
                    let swap = ORDERED && near[other] < near[lane];
                    let (mut nearest, other) = if swap { (other, lane) } else { (lane, other) };
                    let bottom = count;
                    waiting[count] = Waiting { near: near[other], link: node.links[other] };
                    count += 1;
                    while met != 0 {
                        let mut lane = met.trailing_zeros() as usize;
                        met &= met - 1;
                        let mut at = count;
                        if ORDERED {
                            if near[lane] < near[nearest] {
                                std::mem::swap(&mut lane, &mut nearest);
                            }
                            while at > bottom && waiting[at - 1].near < near[lane] {
                                waiting[at] = waiting[at - 1];
                                at -= 1;
                            }
                        }
                        waiting[at] = Waiting { near: near[lane], link: node.links[lane] };
                        count += 1;
                    }
                    link = node.links[nearest];
                    continue;
                }
            } else if link.0 < Link::SINGLE {
                let block = &wide.blocks[link.index()];
                let mut met = block.meet(lanes, line, t_max);
                let mut last = u32::MAX;
                while met != 0 {
                    let slot = block.slot(met.trailing_zeros() as usize);
                    met &= met - 1;
                    if slot != last {
                        (self.visit)(slot as usize, &mut t_max)?;
                    }
                    last = slot;
                }
            } else {
                (self.visit)(link.index(), &mut t_max)?;
            }
            // The next that is not behind what was met.
            loop {
                if count == 0 {
                    return ControlFlow::Continue(());
                }
                count -= 1;
                if waiting[count].near <= t_max {
                    break;
                }
            }
            link = waiting[count].link;
        }
    }
}
