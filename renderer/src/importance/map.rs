//! The importance map: what a pixel matters, in [0, 1]; from task objects, from saliency, from both, or from a file.

use super::distance::distance_px;
use super::fovea::Fovea;
use crate::raster::Raster;

/// Importance of every pixel, each a finite number in [0, 1].
#[derive(Clone, Debug, PartialEq)]
pub struct ImportanceMap(Raster<f32>);

/// A value of a would-be importance map lies outside [0, 1].
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("importance at column {x}, row {y} is {value}; it must lie in [0, 1]")]
pub struct OutOfRange {
    /// Column, from the left.
    pub x: usize,
    /// Row, from the top.
    pub y: usize,
    /// The value found.
    pub value: f32,
}

impl ImportanceMap {
    /// Takes `values` as they are.
    ///
    /// # Errors
    /// Names the first value that is not in [0, 1].
    pub fn new(values: Raster<f32>) -> Result<Self, OutOfRange> {
        match values.values().iter().position(|value| !(0.0..=1.0).contains(value)) {
            Some(index) => {
                Err(OutOfRange { x: index % values.width(), y: index / values.width(), value: values.values()[index] })
            }
            None => Ok(Self(values)),
        }
    }

    /// The task map with its foveal gradient (paper, Figure 5 left and middle): 1 on and around the pixels of task
    /// objects, falling as sight does; 0 everywhere if no pixel shows one.
    #[must_use]
    pub fn of_task(task_object: &Raster<bool>, fovea: &Fovea) -> Self {
        let distances = distance_px(task_object);
        let values = distances.values().iter().map(|&distance| fovea.importance(distance) as f32).collect();
        Self(Raster::from_values(task_object.width(), task_object.height(), values).expect("as many values as pixels"))
    }

    /// (1 - `saliency_weight`) x this + `saliency_weight` x `saliency`: the paper's user-defined weight of the two
    /// maps. `None` if their sizes differ or the weight is not in [0, 1].
    #[must_use]
    pub fn mixed(&self, saliency: &Self, saliency_weight: f32) -> Option<Self> {
        let same_size = (self.0.width(), self.0.height()) == (saliency.0.width(), saliency.0.height());
        if !same_size || !(0.0..=1.0).contains(&saliency_weight) {
            return None;
        }
        let pairs = self.0.values().iter().zip(saliency.0.values());
        let values = pairs.map(|(&a, &b)| ((1.0 - saliency_weight) * a + saliency_weight * b).clamp(0.0, 1.0));
        Raster::from_values(self.0.width(), self.0.height(), values.collect()).map(Self)
    }

    /// The map at another size: each new pixel takes the largest value of the old pixels that it overlaps, so that no
    /// important place is lost by shrinking and none is invented by enlarging.
    #[must_use]
    pub fn resized(&self, width: usize, height: usize) -> Self {
        let (old_width, old_height) = (self.0.width(), self.0.height());
        if (old_width, old_height) == (width, height) || self.0.values().is_empty() {
            let values = if self.0.values().is_empty() { Raster::filled(width, height, 0.0) } else { self.0.clone() };
            return Self(values);
        }
        let overlapped = |i: usize, new: usize, old: usize| (i * old / new)..((i + 1) * old).div_ceil(new);
        let mut values = Vec::with_capacity(width * height);
        for y in 0..height {
            for x in 0..width {
                let rows = overlapped(y, height, old_height);
                let largest = rows
                    .flat_map(|v| overlapped(x, width, old_width).map(move |u| (u, v)))
                    .map(|(u, v)| *self.0.at(u, v))
                    .fold(0.0, f32::max);
                values.push(largest);
            }
        }
        Self(Raster::from_values(width, height, values).expect("one value a pixel was made"))
    }

    /// The values.
    #[must_use]
    pub fn values(&self) -> &Raster<f32> {
        &self.0
    }
}

#[cfg(test)]
mod tests {
    use super::super::fovea::Falloff;
    use super::*;
    use proptest::prelude::*;

    fn fovea() -> Fovea {
        Fovea { diameter_deg: 2.0, falloff: Falloff::Cortical, px_per_deg: 10.0 }
    }

    #[test]
    fn a_value_outside_the_range_is_named() {
        for bad in [-0.1, 1.1, f32::NAN, f32::INFINITY] {
            let mut values = Raster::filled(4, 3, 0.5);
            *values.at_mut(2, 1) = bad;
            let error = ImportanceMap::new(values).unwrap_err();
            assert_eq!((error.x, error.y), (2, 1));
        }
    }

    #[test]
    fn a_task_map_is_one_on_its_objects_and_nothing_without() {
        let mut objects = Raster::filled(90, 40, false);
        *objects.at_mut(10, 20) = true;
        let map = ImportanceMap::of_task(&objects, &fovea());
        assert_eq!(*map.values().at(10, 20), 1.0);
        assert_eq!(*map.values().at(20, 20), 1.0, "a radius of one degree is ten pixels");
        assert!(map.values().at(80, 20) < map.values().at(60, 20));
        let none = ImportanceMap::of_task(&Raster::filled(9, 4, false), &fovea());
        assert!(none.values().values().iter().all(|&value| value == 0.0));
    }

    proptest! {
        #[test]
        fn resizing_keeps_the_largest_and_invents_nothing(
            width in 1_usize..20, height in 1_usize..20, new_width in 1_usize..30, new_height in 1_usize..30,
            values in prop::collection::vec(0.0_f32..=1.0, 400),
        ) {
            let map = ImportanceMap::new(
                Raster::from_values(width, height, values[..width * height].to_vec()).unwrap()).unwrap();
            let resized = map.resized(new_width, new_height);
            prop_assert_eq!((resized.values().width(), resized.values().height()), (new_width, new_height));
            let largest = |map: &ImportanceMap| map.values().values().iter().copied().fold(0.0, f32::max);
            prop_assert_eq!(largest(&map), largest(&resized));
            prop_assert!(resized.values().values().iter().all(|value| map.values().values().contains(value)));
        }

        #[test]
        fn mixing_stays_between_the_two(weight in 0.0_f32..=1.0, a in 0.0_f32..=1.0, b in 0.0_f32..=1.0) {
            let map = |value| ImportanceMap::new(Raster::filled(2, 2, value)).unwrap();
            let mixed = *map(a).mixed(&map(b), weight).unwrap().values().at(1, 1);
            prop_assert!(mixed >= a.min(b) - 1e-6 && mixed <= a.max(b) + 1e-6);
            prop_assert!(map(a).mixed(&map(b), 1.5).is_none());
        }
    }
}
