//! Shapes whose boxes are the same to the bit.
//!
//! A builder that joins nearest neighbours makes a chain of equal boxes: as deep as they are many, in steps that grow with their
//! square. So it gets one box for all of them, and below that they lie in halves of halves.

use glam::Vec3A;

use super::widen::Pair;

/// Least and greatest corner.
pub(super) type Box3 = [Vec3A; 2];

/// Shapes with one box.
#[derive(Clone, Copy)]
struct Group {
    /// Their places in the order.
    begin: u32,
    end: u32,
    /// The number of the first of its halves; the other follows.
    below: u32,
}

/// Shapes in groups of equal boxes, each with its halves down to single shapes.
pub(super) struct Coincident<'a> {
    boxes: &'a [Box3],
    /// The shapes, those of a group side by side.
    order: Vec<u32>,
    /// The whole groups, in the order of their first shapes, then all halves.
    groups: Vec<Group>,
    whole: usize,
}

impl<'a> Coincident<'a> {
    /// Of shapes with these boxes.
    pub(super) fn new(boxes: &'a [Box3]) -> Self {
        let bits = |corners: &Box3| corners.map(|corner| corner.to_array().map(f32::to_bits));
        let mut keyed: Vec<([[u32; 3]; 2], u32)> = boxes.iter().zip(0..).map(|(it, index)| (bits(it), index)).collect();
        keyed.sort_unstable();
        let mut groups = Vec::with_capacity(boxes.len());
        let mut begin = 0;
        for run in keyed.chunk_by(|a, b| a.0 == b.0) {
            let end = begin + run.len() as u32;
            groups.push(Group { begin, end, below: 0 });
            begin = end;
        }
        let order: Vec<u32> = keyed.iter().map(|&(_, index)| index).collect();
        groups.sort_unstable_by_key(|group| order[group.begin as usize]);
        let whole = groups.len();
        let mut next = 0;
        while let Some(&Group { begin, end, .. }) = groups.get(next) {
            if end - begin > 1 {
                groups[next].below = groups.len() as u32;
                let middle = begin + (end - begin) / 2;
                groups.push(Group { begin, end: middle, below: 0 });
                groups.push(Group { begin: middle, end, below: 0 });
            }
            next += 1;
        }
        Self { boxes, order, groups, whole }
    }

    /// The box of each whole group.
    pub(super) fn boxes(&self) -> impl Iterator<Item = Box3> {
        self.groups[..self.whole].iter().map(|group| self.boxes[self.order[group.begin as usize] as usize])
    }

    /// A group or half as a pair; halves get their number plus `base`.
    pub(super) fn pair(&self, number: u32, base: u32) -> Pair {
        let Group { begin, end, below } = self.groups[number as usize];
        let shape = self.order[begin as usize];
        let [low, high] = self.boxes[shape as usize];
        let is_leaf = end - begin == 1;
        Pair { low, high, first: if is_leaf { shape } else { base + below }, is_leaf }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every shape is found once, below the group of its box, no deeper than halving needs; alone, it is its own group.
    #[test]
    fn equal_boxes_are_halved() {
        let boxes: Vec<Box3> = (0..3000)
            .map(|index| {
                // 1 of 3 is alone, 1000 are equal, and so are 500 pairs.
                let at = [index as f32, -1.0, (index / 6) as f32 + 0.5][index % 3];
                [Vec3A::splat(at), Vec3A::splat(at + 1.0)]
            })
            .collect();
        let coincident = Coincident::new(&boxes);
        let whole: Vec<Box3> = coincident.boxes().collect();
        assert_eq!(whole.len(), 1000 + 1 + 500);
        let mut found = vec![0; boxes.len()];
        for (group, around) in whole.iter().enumerate() {
            let mut todo = vec![(group as u32, 0)];
            while let Some((number, depth)) = todo.pop() {
                let pair = coincident.pair(number, 7);
                assert_eq!([pair.low, pair.high], *around);
                assert!(depth <= 10, "{depth} halves of at most 1000 = 2^9.97");
                if pair.is_leaf {
                    found[pair.first as usize] += 1;
                    assert_eq!(boxes[pair.first as usize], *around);
                } else {
                    todo.extend([(pair.first - 7, depth + 1), (pair.first - 6, depth + 1)]);
                }
            }
        }
        assert!(found.iter().all(|&times| times == 1));
    }

    /// Boxes that all differ stay in their order.
    #[test]
    fn different_boxes_stay_as_they_are() {
        let boxes: Vec<Box3> = (0..100).map(|index| [Vec3A::splat((index * 37 % 100) as f32); 2]).collect();
        let coincident = Coincident::new(&boxes);
        assert!(coincident.boxes().eq(boxes.iter().copied()));
        assert!((0..100).all(|index| coincident.pair(index, 0).first == index));
    }
}
