//! Dyadic Gaussian pyramids and moving a map from one of their scales to another.
//!
//! Pixel X of scale n lies on pixel 2X of scale n - 1 (Burt and Adelson 1983), so a map at scale n is read at
//! `x / 2^n` for pixel x of the picture.

use crate::raster::Raster;

/// One plane of a picture at one scale.
pub(super) type Plane = Raster<f32>;

/// The binomial low-pass filter of Burt and Adelson, with its weights adding up to 16.
const TAPS: [f32; 5] = [1.0, 4.0, 6.0, 4.0, 1.0];

/// Index `i + offset` in 0..n, mirrored at the ends without repeating the end itself.
pub(super) fn mirrored(i: usize, offset: isize, n: usize) -> usize {
    let last = n as isize - 1;
    if last == 0 {
        return 0;
    }
    let period = 2 * last;
    let at = (i as isize + offset).rem_euclid(period);
    at.min(period - at) as usize
}

/// Low-pass filtered and subsampled by two: ceil(width / 2) x ceil(height / 2).
pub(super) fn reduced(plane: &Plane) -> Plane {
    let (width, height) = (plane.width(), plane.height());
    let (half_width, half_height) = (width.div_ceil(2), height.div_ceil(2));
    let mut out = Vec::with_capacity(half_width * half_height);
    let mut column_sums = vec![0.0_f32; width];
    for y in 0..half_height {
        let row = |k: usize| {
            let start = mirrored(2 * y, k as isize - 2, height) * width;
            &plane.values()[start..start + width]
        };
        let (a, b, c, d, e) = (row(0), row(1), row(2), row(3), row(4));
        for (x, sum) in column_sums.iter_mut().enumerate() {
            *sum = a[x] + e[x] + 4.0 * (b[x] + d[x]) + 6.0 * c[x];
        }
        out.extend((0..half_width).map(|x| {
            let at = 2 * x;
            let sum = if at >= 2 && at + 2 < width {
                let near = &column_sums[at - 2..at + 3];
                near[0] + near[4] + 4.0 * (near[1] + near[3]) + 6.0 * near[2]
            } else {
                (0..5).map(|k| TAPS[k] * column_sums[mirrored(at, k as isize - 2, width)]).sum()
            };
            sum / 256.0
        }));
    }
    Raster::from_values(half_width, half_height, out).expect("one value a pixel was made")
}

/// The plane and `levels - 1` reductions of it.
pub(super) fn pyramid(plane: Plane, levels: usize) -> Vec<Plane> {
    let mut scales = vec![plane];
    while scales.len() < levels {
        let next = reduced(&scales[scales.len() - 1]);
        scales.push(next);
    }
    scales
}

/// `coarse` read bilinearly on the pixels of a scale `octaves` finer, `width` x `height`.
pub(super) fn expanded(coarse: &Plane, octaves: u32, width: usize, height: usize) -> Plane {
    let step = 1.0 / f64::from(1_u32 << octaves);
    let weights = |n: usize, coarse_n: usize| -> Vec<(usize, usize, f32)> {
        (0..n)
            .map(|i| {
                let at = (i as f64 * step).min((coarse_n - 1) as f64);
                let low = at as usize;
                (low, (low + 1).min(coarse_n - 1), (at - low as f64) as f32)
            })
            .collect()
    };
    let columns = weights(width, coarse.width());
    let mut out = Vec::with_capacity(width * height);
    // Along the rows first: a coarse row is read by many fine ones.
    let along = |row: usize| -> Vec<f32> {
        let row = &coarse.values()[row * coarse.width()..(row + 1) * coarse.width()];
        columns.iter().map(|&(left, right, share)| row[left] * (1.0 - share) + row[right] * share).collect()
    };
    let rows: Vec<Vec<f32>> = (0..coarse.height()).map(along).collect();
    for (low, high, part) in weights(height, coarse.height()) {
        out.extend(rows[low].iter().zip(&rows[high]).map(|(upper, lower)| upper * (1.0 - part) + lower * part));
    }
    Raster::from_values(width, height, out).expect("one value a pixel was made")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn indices_mirror_at_both_ends() {
        let around: Vec<usize> = (-3..7).map(|offset| mirrored(0, offset, 4)).collect();
        assert_eq!(around, [3, 2, 1, 0, 1, 2, 3, 2, 1, 0]);
        assert_eq!(mirrored(0, -2, 1), 0);
    }

    #[test]
    fn a_constant_stays_and_a_ramp_stays_a_ramp() {
        let flat = pyramid(Raster::filled(37, 21, 0.25), 4);
        assert_eq!((flat[3].width(), flat[3].height()), (5, 3));
        assert!(flat.iter().flat_map(|plane| plane.values()).all(|&value| (value - 0.25).abs() < 1e-6));
        let ramp: Vec<f32> = (0..33 * 9).map(|i| (i % 33) as f32).collect();
        let half = reduced(&Raster::from_values(33, 9, ramp).unwrap());
        for x in 1..16 {
            assert!((half.at(x, 2) - 2.0 * x as f32).abs() < 1e-5, "pixel X of the half scale lies on pixel 2X");
        }
        let back = expanded(&half, 1, 33, 9);
        for x in 2..31 {
            assert!((back.at(x, 4) - x as f32).abs() < 1e-5);
        }
    }
}
