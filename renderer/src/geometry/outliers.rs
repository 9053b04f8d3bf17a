//! The few shapes that are so much larger, or so far away, that they would spoil the hierarchy of all others: a ground of 20 km under
//! a house, a dome around a city.
//!
//! The hierarchy's boxes are padded in proportion to its extent, so under such a shape every small one would get a box of metres,
//! and a ray would have to test them all. Outliers are tested one by one instead.

use glam::DVec3;

/// Most shapes that are tested one by one.
const MOST: usize = 16;

/// By how much the extent must fall to make that worthwhile.
const WORTHWHILE: f64 = 32.0;

/// Shapes whose middle is looked at to find where most of a scene lies.
const LOOKED_AT: usize = 999;

type Bounds = [DVec3; 2];

fn union(a: Bounds, b: Bounds) -> Bounds {
    [a[0].min(b[0]), a[1].max(b[1])]
}

fn extent([low, high]: Bounds) -> f64 {
    (high - low).max_element()
}

/// The box around nothing.
const NOTHING: Bounds = [DVec3::INFINITY, DVec3::NEG_INFINITY];

/// The indices of outliers, ascending, and the bounds of all other shapes.
pub(super) fn outliers(bounds: &[Bounds]) -> (Vec<usize>, Bounds) {
    let middle = middle(bounds);
    let reach = |[low, high]: Bounds| (high - middle).max(middle - low).max_element();
    // The shapes that reach furthest from the middle, the furthest first.
    let mut furthest: Vec<(f64, usize)> = Vec::with_capacity(MOST + 1);
    for (index, &bounds) in bounds.iter().enumerate() {
        let reach = reach(bounds);
        if furthest.len() < MOST || reach > furthest[MOST - 1].0 {
            let at = furthest.partition_point(|&(other, _)| other >= reach);
            furthest.insert(at, (reach, index));
            furthest.truncate(MOST);
        }
    }
    let is_far = |index: usize| furthest.iter().any(|&(_, far)| far == index);
    let others = bounds.iter().enumerate().filter(|&(index, _)| !is_far(index));
    // left[k] is around all but the first k of them.
    let mut left = vec![others.fold(NOTHING, |sum, (_, &bounds)| union(sum, bounds))];
    for &(_, index) in furthest.iter().rev() {
        let sum = union(left[left.len() - 1], bounds[index]);
        left.push(sum);
    }
    left.reverse();
    // As few as bring the extent near to the least; something must be left.
    let candidates = || left.iter().enumerate().filter(|&(count, _)| count < bounds.len());
    let least = candidates().map(|(_, &left)| extent(left)).fold(f64::INFINITY, f64::min);
    let count = candidates().find(|&(_, &left)| extent(left) <= 4.0 * least).map_or(0, |(count, _)| count);
    let count = if extent(left[count]) * WORTHWHILE <= extent(left[0]) { count } else { 0 };
    let mut indices: Vec<usize> = furthest[..count].iter().map(|&(_, index)| index).collect();
    indices.sort_unstable();
    (indices, left[count])
}

/// The median of the shapes' middles, by axis.
fn middle(bounds: &[Bounds]) -> DVec3 {
    let step = bounds.len().div_ceil(LOOKED_AT).max(1);
    let middle = |axis: usize| {
        let mut middles: Vec<f64> =
            bounds.iter().step_by(step).map(|[low, high]| 0.5 * low[axis] + 0.5 * high[axis]).collect();
        middles.sort_unstable_by(f64::total_cmp);
        middles.get(middles.len() / 2).copied().unwrap_or(0.0)
    };
    DVec3::new(middle(0), middle(1), middle(2))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cube(at: f64, half: f64) -> Bounds {
        [DVec3::splat(at - half), DVec3::splat(at + half)]
    }

    #[test]
    fn grounds_domes_and_strays_are_outliers() {
        let mut bounds: Vec<Bounds> = (0..100).map(|i| cube(f64::from(i) * 0.1, 0.1)).collect();
        assert_eq!(outliers(&bounds).0, Vec::<usize>::new());
        bounds.push(cube(0.0, 1e4));
        bounds.insert(7, cube(3.0, 1e9));
        bounds.push(cube(-1e6, 1e-3));
        let (indices, left) = outliers(&bounds);
        assert_eq!(indices, [7, 101, 102]);
        assert!((extent(left) - 10.1).abs() < 1e-9);
    }

    #[test]
    fn a_scene_of_one_size_has_none() {
        assert_eq!(outliers(&[]).0, Vec::<usize>::new());
        assert_eq!(outliers(&[cube(5.0, 1.0)]).0, Vec::<usize>::new());
        assert_eq!(outliers(&[cube(5.0, 1.0), cube(6.0, 20.0)]).0, Vec::<usize>::new());
        // Something must be left to build a hierarchy of.
        assert_eq!(outliers(&[cube(5.0, 1.0), cube(6.0, 1e6)]).0, [1]);
        // Twenty that are all large cannot all be outliers.
        let many: Vec<Bounds> = (0..200).map(|i| cube(0.0, if i % 10 == 0 { 1e6 } else { 1.0 })).collect();
        assert_eq!(outliers(&many).0, Vec::<usize>::new());
    }
}
