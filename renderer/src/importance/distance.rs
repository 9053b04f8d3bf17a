//! Exact Euclidean distance to the nearest marked pixel, in two passes of lower envelopes of parabolas
//! (Felzenszwalb and Huttenlocher, "Distance transforms of sampled functions", 2012).

use crate::raster::Raster;

/// Distance in pixels, centre to centre, from every pixel to the nearest one that `marked` holds `true` for;
/// infinite everywhere if there is none.
#[must_use]
pub fn distance_px(marked: &Raster<bool>) -> Raster<f64> {
    let (width, height) = (marked.width(), marked.height());
    let mut squared: Vec<f64> = marked.values().iter().map(|&is| if is { 0.0 } else { f64::INFINITY }).collect();
    let mut line = Vec::new();
    for x in 0..width {
        line.clear();
        line.extend((0..height).map(|y| squared[y * width + x]));
        for (y, value) in squared_distances(&line).into_iter().enumerate() {
            squared[y * width + x] = value;
        }
    }
    for row in squared.chunks_mut(width.max(1)) {
        let out = squared_distances(row);
        row.copy_from_slice(&out);
    }
    let distances = squared.into_iter().map(f64::sqrt).collect();
    Raster::from_values(width, height, distances).expect("as many values as pixels")
}

/// min over q of (p - q)^2 + f(q), for every p: the lower envelope of one parabola a finite sample.
fn squared_distances(f: &[f64]) -> Vec<f64> {
    let mut roots: Vec<(usize, f64)> = Vec::with_capacity(f.len());
    for (q, &height) in f.iter().enumerate().filter(|(_, height)| height.is_finite()) {
        let lift = |i: usize, value: f64| value + (i * i) as f64;
        let mut from = f64::NEG_INFINITY;
        while let Some(&(last, start)) = roots.last() {
            from = (lift(q, height) - lift(last, f[last])) / (2 * (q - last)) as f64;
            if from > start {
                break;
            }
            roots.pop();
            from = f64::NEG_INFINITY;
        }
        roots.push((q, from));
    }
    let mut current = 0;
    (0..f.len())
        .map(|p| {
            while current + 1 < roots.len() && roots[current + 1].1 < p as f64 {
                current += 1;
            }
            roots.get(current).map_or(f64::INFINITY, |&(q, _)| {
                let offset = p as f64 - q as f64;
                offset * offset + f[q]
            })
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn equals_the_nearest_of_all_marked_pixels(
            width in 1_usize..14, height in 1_usize..14, marks in prop::collection::vec(any::<bool>(), 196),
            rare in any::<bool>(),
        ) {
            let is = |x: usize, y: usize| marks[y * 14 + x] && (!rare || (x * 7 + y * 3).is_multiple_of(11));
            let values = (0..width * height).map(|i| is(i % width, i / width)).collect();
            let found = distance_px(&Raster::from_values(width, height, values).unwrap());
            for y in 0..height {
                for x in 0..width {
                    let mut nearest = f64::INFINITY;
                    for v in 0..height {
                        for u in 0..width {
                            if is(u, v) {
                                nearest = nearest.min((x as f64 - u as f64).hypot(y as f64 - v as f64));
                            }
                        }
                    }
                    let here = *found.at(x, y);
                    prop_assert!(here == nearest || (here - nearest).abs() < 1e-9, "{here} for {nearest}");
                }
            }
        }
    }
}
