//! Values for pixels without samples, from those of their neighbours.

use glam::Vec3;

use crate::raster::Raster;

/// Gives every pixel that is not wholly `known` a value from those nearby as well: the pull-push interpolation of S. J. Gortler,
/// R. Grzeszczuk, R. Szeliski and M. F. Cohen, "The Lumigraph", SIGGRAPH 1996, section 3.3. A value is a weighted mean of
/// known values, so it lies between them; wholly known pixels keep theirs. Without any known pixel all are black.
///
/// `known` has a weight in [0, 1] for each pixel, row by row: 0 if nothing is known of it, 1 if its value is to stay as it is, and
/// between them the part that its own value has in what it is to be.
pub fn fill(plane: &mut Raster<Vec3>, known: &[f32]) {
    // Nothing to fill, or nothing to fill in with.
    if known.iter().all(|known| *known >= 1.0) || plane.values().iter().all(|value| *value == Vec3::ZERO) {
        return;
    }
    let mut levels = vec![Layer::finest(plane, known)];
    while let Some(last) = levels.last()
        && last.width.max(last.height) > 1
    {
        levels.push(last.pulled());
    }
    let mut coarse = levels.pop().unwrap_or_default();
    for mut layer in levels.into_iter().rev() {
        layer.push(&coarse);
        coarse = layer;
    }
    for ((pixel, known), (value, _)) in plane.values_mut().iter_mut().zip(known).zip(coarse.values) {
        if *known < 1.0 {
            *pixel = value;
        }
    }
}

/// Values and their weights in [0, 1].
#[derive(Default)]
struct Layer {
    width: usize,
    height: usize,
    values: Vec<(Vec3, f32)>,
}

impl Layer {
    fn finest(plane: &Raster<Vec3>, known: &[f32]) -> Self {
        let values = plane.values().iter().zip(known);
        let values = values.map(|(value, known)| (if *known > 0.0 { *value } else { Vec3::ZERO }, *known)).collect();
        Self { width: plane.width(), height: plane.height(), values }
    }

    /// Half the size: each value is the mean of the four below it by their weights, its weight their sum but at most 1.
    fn pulled(&self) -> Self {
        let (width, height) = (self.width.div_ceil(2), self.height.div_ceil(2));
        let mut values = Vec::with_capacity(width * height);
        for y in 0..height {
            for x in 0..width {
                let (mut sum, mut weights) = (Vec3::ZERO, 0.0);
                for (column, row) in [(2 * x, 2 * y), (2 * x + 1, 2 * y), (2 * x, 2 * y + 1), (2 * x + 1, 2 * y + 1)] {
                    if column < self.width && row < self.height {
                        let (value, weight) = self.values[row * self.width + column];
                        sum += weight * value;
                        weights += weight;
                    }
                }
                let value = if weights > 0.0 { sum / weights } else { Vec3::ZERO };
                values.push((value, weights.min(1.0)));
            }
        }
        Self { width, height, values }
    }

    /// Completes what is not fully known from the layer of half the size, interpolated between its four nearest values.
    fn push(&mut self, coarse: &Self) {
        for y in 0..self.height {
            for x in 0..self.width {
                let (value, weight) = self.values[y * self.width + x];
                if weight < 1.0 {
                    let filled = weight * value + (1.0 - weight) * coarse.between(x, y);
                    self.values[y * self.width + x] = (filled, 1.0);
                }
            }
        }
    }

    /// The value at the centre of a pixel of a layer of twice the size.
    fn between(&self, x: usize, y: usize) -> Vec3 {
        // Centres lie a quarter of this layer's pixel away from its own.
        let neighbours = |at: usize, end: usize| {
            let near = at / 2;
            let far = if at.is_multiple_of(2) { near.saturating_sub(1) } else { (near + 1).min(end - 1) };
            [(near, 0.75), (far, 0.25)]
        };
        let (mut sum, mut weights) = (Vec3::ZERO, 0.0);
        for (row, down) in neighbours(y, self.height) {
            for (column, across) in neighbours(x, self.width) {
                let (value, weight) = self.values[row * self.width + column];
                // A value that nothing is known of counts only if there is no other.
                let share = down * across * weight.max(f32::MIN_POSITIVE);
                sum += share * value;
                weights += share;
            }
        }
        sum / weights
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn filled_values_lie_between_known_ones_and_known_ones_stay(
            width in 1..40usize,
            height in 1..40usize,
            seed in any::<u64>(),
            rarity in 1..200u64,
        ) {
            let hash = |i: usize| (seed ^ i as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 33;
            // Some known wholly, some in part.
            let part = |i: usize| [1.0, 0.125][usize::from(hash(i + 3) % 3 == 0)];
            let is_known = |i: usize| i == 0 || hash(i) % rarity == 0;
            let known: Vec<f32> = (0..width * height).map(|i| if is_known(i) { part(i) } else { 0.0 }).collect();
            let values = (0..width * height).map(|i| Vec3::splat(hash(i + 7) as f32 / 1e9));
            let values: Vec<Vec3> = values.collect();
            let mut plane = Raster::from_values(width, height, values.clone()).expect("its size");
            fill(&mut plane, &known);
            let of_known = || values.iter().zip(&known).filter(|(_, known)| **known > 0.0).map(|(value, _)| value.x);
            let least = of_known().fold(f32::INFINITY, f32::min);
            let most = of_known().fold(0.0, f32::max);
            for ((value, before), known) in plane.values().iter().zip(&values).zip(&known) {
                prop_assert!(value.x >= least * (1.0 - 1e-5) && value.x <= most * (1.0 + 1e-5), "{} {least} {most}", value.x);
                prop_assert!(*known < 1.0 || value == before);
            }
        }
    }

    #[test]
    fn a_ramp_on_a_lattice_is_met_within_its_step() {
        // Every fourth pixel of a ramp of slope 1 a pixel is known; away from the border the fill cannot be off by more than
        // the distance to what is known.
        let ramp: Vec<Vec3> = (0..64 * 64).map(|i| Vec3::splat((i % 64) as f32)).collect();
        let lattice = |i: usize| (i % 64).is_multiple_of(4) && (i / 64).is_multiple_of(4);
        let known: Vec<f32> = (0..64 * 64).map(|i| f32::from(u8::from(lattice(i)))).collect();
        let mut plane = Raster::from_values(64, 64, ramp.clone()).expect("its size");
        fill(&mut plane, &known);
        for (i, (value, before)) in plane.values().iter().zip(&ramp).enumerate() {
            if (8..56).contains(&(i % 64)) {
                assert!((value.x - before.x).abs() < 4.0, "{i}: {} {}", value.x, before.x);
            }
        }
    }

    #[test]
    fn what_is_half_known_is_a_mean_with_its_neighbours() {
        // Noise of deviation 1 about 5, an eighth of each pixel known: sixteen of them make two whole ones.
        let noise = |i: usize| if (i.wrapping_mul(0x9e37_79b9) >> 7).is_multiple_of(2) { 6.0 } else { 4.0 };
        let values = (0..64 * 64).map(|i| Vec3::splat(noise(i))).collect();
        let mut plane = Raster::from_values(64, 64, values).expect("its size");
        fill(&mut plane, &[0.125; 64 * 64]);
        let deviation = |v: &Vec3| f64::from(v.x - 5.0).powi(2);
        let spread = (plane.values().iter().map(deviation).sum::<f64>() / 4096.0).sqrt();
        assert!(spread < 0.5, "{spread}");
    }

    #[test]
    fn nothing_known_is_black() {
        let mut plane = Raster::filled(5, 3, Vec3::ONE);
        fill(&mut plane, &[0.0; 15]);
        assert!(plane.values().iter().all(|value| *value == Vec3::ZERO));
    }
}
