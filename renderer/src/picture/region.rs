//! A part of a picture that is judged by itself, such as what people look at.

use super::compare::{self, CompareError};
use super::display::Display;
use super::{Picture, perceptual};
use crate::raster::Raster;

/// Pixels of a picture, at least one.
#[derive(Clone, Debug, PartialEq)]
pub struct Region(Raster<bool>);

/// What people would see of the difference within a region.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seen {
    /// Part of the picture's pixels that lie in the region.
    pub share: f64,
    /// Mean of LDR-FLIP over the region.
    pub flip: f64,
    /// JOD over the region.
    pub jod: f64,
}

impl Region {
    /// The pixels at which `map` is at least `least`; `None` if there is none.
    #[must_use]
    pub fn at_least(map: &Raster<f32>, least: f32) -> Option<Self> {
        let inside: Vec<bool> = map.values().iter().map(|&value| value >= least).collect();
        let any = inside.contains(&true);
        Raster::from_values(map.width(), map.height(), inside).filter(|_| any).map(Self)
    }

    /// Part of the picture's pixels that lie in the region, above 0.
    #[must_use]
    pub fn share(&self) -> f64 {
        let inside = self.0.values().iter().filter(|&&inside| inside).count();
        inside as f64 / self.0.values().len() as f64
    }

    /// What people would see within the region.
    ///
    /// JOD: outside the region the picture is replaced by the reference. ColorVideoVDP pools the difference of a band as
    /// the root of its mean square over all pixels, so its pooled quality difference times (pixels / region's pixels)^1/2
    /// is that of the region by itself. The border of the region counts as seen.
    ///
    /// # Errors
    /// As [`compare::flip`] and [`compare::jod`], and if the region is not of the pictures' size.
    pub fn seen(
        &self,
        reference: &Picture,
        picture: &Picture,
        display: &Display,
        exposure: f64,
    ) -> Result<Seen, CompareError> {
        let size = (self.0.width(), self.0.height());
        let found = (reference.beauty.width(), reference.beauty.height());
        if size != found {
            return Err(CompareError::Region(size.0, size.1, found.0, found.1));
        }
        let mut within = picture.clone();
        let pixels = within.beauty.values_mut().iter_mut().zip(reference.beauty.values()).zip(self.0.values());
        pixels.filter(|(_, inside)| !**inside).for_each(|((pixel, reference), _)| *pixel = *reference);
        let jod = compare::jod(reference, &within, display, exposure)?.jod;
        let share = self.share();
        let pooled = perceptual::pooled_difference(jod) / share.sqrt();
        let flip = compare::flip(reference, picture, display, exposure)?;
        let mut sum = 0.0;
        for (value, _) in flip.values().iter().zip(self.0.values()).filter(|(_, inside)| **inside) {
            sum += f64::from(*value);
        }
        let pixels = share * self.0.values().len() as f64;
        Ok(Seen { share, flip: sum / pixels, jod: perceptual::jod_of(pooled) })
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Provenance, Quantity};
    use super::*;

    const DISPLAY: Display = Display::of_the_paper();

    fn picture(value: impl Fn(usize, usize) -> f32) -> Picture {
        let values = (0..192 * 128).map(|i| [value(i % 192, i / 192); 3]).collect();
        let beauty = Raster::from_values(192, 128, values).unwrap();
        Picture { quantity: Quantity::Display, beauty, layers: Vec::new(), provenance: Provenance::default() }
    }

    fn texture(x: usize, y: usize) -> f32 {
        0.2 + 0.02 * ((x * 7 + y * 13) % 5) as f32
    }

    /// The texture with noise of mean 0: a shift of the whole would be no contrast in it, and an edge around a part.
    fn noisy(x: usize, y: usize) -> f32 {
        texture(x, y) + 0.06 * (((x * 31 + y * 17) % 3) as f32 - 1.0)
    }

    fn region(inside: impl Fn(usize, usize) -> bool) -> Region {
        let values = (0..192 * 128).map(|i| f32::from(u8::from(inside(i % 192, i / 192)))).collect();
        Region::at_least(&Raster::from_values(192, 128, values).unwrap(), 1.0).unwrap()
    }

    #[test]
    fn the_whole_picture_is_a_region_like_any_other() {
        let (reference, noisy) = (picture(texture), picture(noisy));
        let seen = region(|_, _| true).seen(&reference, &noisy, &DISPLAY, 1.0).unwrap();
        let whole = compare::jod(&reference, &noisy, &DISPLAY, 1.0).unwrap().jod;
        assert!((seen.jod - whole).abs() < 1e-5 && whole < 9.7, "{} {whole}", seen.jod);
        let flip = compare::mean(&compare::flip(&reference, &noisy, &DISPLAY, 1.0).unwrap());
        assert!((seen.flip - flip).abs() < 1e-9);
    }

    /// The same difference everywhere: any part of it is as visible as the whole, but for what borders add or take.
    #[test]
    fn a_part_of_an_even_difference_is_as_visible_as_the_whole() {
        let (reference, noisy) = (picture(texture), picture(noisy));
        let whole = 10.0 - compare::jod(&reference, &noisy, &DISPLAY, 1.0).unwrap().jod;
        for (name, part) in [
            ("half", region(|x, _| x < 96)),
            ("quarter", region(|x, y| x < 96 && y < 64)),
            ("middle", region(|x, y| (64..128).contains(&x) && (32..96).contains(&y))),
        ] {
            let loss = 10.0 - part.seen(&reference, &noisy, &DISPLAY, 1.0).unwrap().jod;
            assert!((loss / whole - 1.0).abs() < 0.15, "{name}: {loss} for {whole}");
        }
    }

    #[test]
    fn what_lies_outside_does_not_count() {
        let reference = picture(texture);
        let dark = picture(|x, y| if x > 100 { 0.0 } else { texture(x, y) });
        let seen = region(|x, _| x < 60).seen(&reference, &dark, &DISPLAY, 1.0).unwrap();
        assert_eq!(seen.jod, 10.0);
        let inside = region(|x, _| x > 130).seen(&reference, &dark, &DISPLAY, 1.0).unwrap();
        assert!(inside.jod < compare::jod(&reference, &dark, &DISPLAY, 1.0).unwrap().jod);
        assert!((inside.share - 61.0 / 192.0).abs() < 1e-12);
        assert!(Region::at_least(&Raster::filled(3, 3, 0.5), 0.6).is_none());
    }
}
