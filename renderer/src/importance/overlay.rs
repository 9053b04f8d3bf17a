//! A map laid over the picture that it belongs to, to be looked at.

use super::map::ImportanceMap;
use super::ran::ramp;
use crate::color::{Rgb, brightness, srgb_decode, srgb_encode};
use crate::raster::Raster;

/// The picture (linear display light in [0, 1]) in grey, coloured by importance from dark blue (0) over green to yellow
/// (1); linear display light. `None` if the sizes differ.
#[must_use]
pub fn overlay(picture: &Raster<[f32; 3]>, map: &ImportanceMap) -> Option<Raster<Rgb>> {
    let (width, height) = (picture.width(), picture.height());
    if (map.values().width(), map.values().height()) != (width, height) {
        return None;
    }
    let colored = |(pixel, &importance): (&[f32; 3], &f32)| {
        // Mixed in code values, where steps of light look even.
        let grey = srgb_encode(brightness(Rgb::from(pixel.map(f64::from))));
        let tint = ramp(f64::from(importance)).to_array().map(srgb_encode);
        Rgb::from(tint.map(|tint| srgb_decode(0.5 * tint + 0.5 * grey)))
    };
    let values = picture.values().iter().zip(map.values().values()).map(colored).collect();
    Raster::from_values(width, height, values)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn importance_shows_at_equal_light_and_sizes_must_agree() {
        let picture = Raster::filled(2, 1, [0.3; 3]);
        let map = ImportanceMap::new(Raster::from_values(2, 1, vec![0.0, 1.0]).unwrap()).unwrap();
        let shown = overlay(&picture, &map).unwrap();
        assert!(brightness(*shown.at(1, 0)) > 2.0 * brightness(*shown.at(0, 0)));
        assert!(overlay(&Raster::filled(1, 2, [0.3; 3]), &map).is_none());
    }
}
