//! Which components ran where: a colour-coded picture with a legend (paper, Figure 5 right).

use super::glyphs;
use super::map::ImportanceMap;
use crate::color::{Rgb, srgb_decode};
use crate::component::{Component, ComponentSet};
use crate::raster::Raster;

/// A component that ran, and the importance that a pixel needed for it; `None` is every pixel.
pub type Run = (Component, Option<f32>);

/// For every pixel, the components that were allowed to run there. Without a map all importances are 1.
#[must_use]
pub fn components_run(width: usize, height: usize, map: Option<&ImportanceMap>, runs: &[Run]) -> Raster<ComponentSet> {
    let at = |importance: f32| -> ComponentSet {
        let admitted = runs.iter().filter(|(_, threshold)| threshold.is_none_or(|threshold| importance >= threshold));
        admitted.map(|&(component, _)| component).collect()
    };
    match map {
        Some(map) => {
            let sets = map.values().values().iter().map(|&importance| at(importance)).collect();
            Raster::from_values(map.values().width(), map.values().height(), sets).expect("one set a pixel was made")
        }
        None => Raster::filled(width, height, at(1.0)),
    }
}

/// A set of components that occurs in a picture, with its colour and its part of the pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Entry {
    /// The components.
    pub components: ComponentSet,
    /// Linear display light in [0, 1].
    pub color: Rgb,
    /// Part of all pixels.
    pub share: f64,
}

impl Entry {
    /// `DIRECT` for no component, else the letters.
    #[must_use]
    pub fn name(&self) -> String {
        if self.components.is_empty() {
            "DIRECT".to_owned()
        } else {
            self.components.iter().map(Component::letter).collect()
        }
    }
}

/// The sets that occur, those of fewer components first, each with a colour of its own: from dark blue (least) to yellow (most),
/// in even steps of lightness, so that the order shows in grey and to colour-blind eyes too.
#[must_use]
pub fn legend(sets: &Raster<ComponentSet>) -> Vec<Entry> {
    let mut counts: Vec<(ComponentSet, usize)> = Vec::new();
    for &set in sets.values() {
        match counts.iter_mut().find(|(known, _)| *known == set) {
            Some((_, count)) => *count += 1,
            None => counts.push((set, 1)),
        }
    }
    let order =
        |set: ComponentSet| (set.iter().count(), set.iter().map(|component| component as u8).collect::<Vec<_>>());
    counts.sort_by_key(|&(set, _)| order(set));
    let last = counts.len().saturating_sub(1).max(1) as f64;
    let all = sets.values().len() as f64;
    let entry = |(place, &(components, count)): (usize, &(ComponentSet, usize))| Entry {
        components,
        color: ramp(place as f64 / last),
        share: count as f64 / all,
    };
    counts.iter().enumerate().map(entry).collect()
}

/// The sets in their colours and the legend below, in linear display light; the same picture at every run.
#[must_use]
pub fn picture(sets: &Raster<ComponentSet>) -> Raster<Rgb> {
    let entries = legend(sets);
    let scale = (sets.width() / 256).clamp(1, 8);
    let line = (glyphs::HEIGHT + 4) * scale;
    let (width, below) = (sets.width(), line * entries.len() + 2 * scale);
    let mut picture = Raster::filled(width, sets.height() + below, Rgb::splat(srgb_decode(0.1)));
    for (pixel, set) in picture.values_mut().iter_mut().zip(sets.values()) {
        if let Some(entry) = entries.iter().find(|entry| entry.components == *set) {
            *pixel = entry.color;
        }
    }
    for (place, entry) in entries.iter().enumerate() {
        let top = sets.height() + 2 * scale + place * line;
        let (left, edge) = (2 * scale, glyphs::HEIGHT * scale);
        fill(&mut picture, (left, top), (2 * edge, edge), entry.color);
        let text = format!("{} {:.1} %", entry.name(), 100.0 * entry.share);
        let mut x = left + 2 * edge + 3 * scale;
        for character in text.chars() {
            for (column, row) in glyphs::dots(character) {
                fill(&mut picture, (x + column * scale, top + row * scale), (scale, scale), Rgb::ONE);
            }
            x += (glyphs::WIDTH + 1) * scale;
        }
    }
    picture
}

/// Fills a rectangle as far as it lies in the picture.
fn fill(picture: &mut Raster<Rgb>, (x, y): (usize, usize), (width, height): (usize, usize), color: Rgb) {
    for row in y..(y + height).min(picture.height()) {
        for column in x..(x + width).min(picture.width()) {
            *picture.at_mut(column, row) = color;
        }
    }
}

/// Dark blue over green to yellow, `t` in [0, 1]: sRGB codes between which lightness rises nearly evenly.
#[must_use]
pub fn ramp(t: f64) -> Rgb {
    const STOPS: [[f64; 3]; 5] =
        [[0.13, 0.10, 0.35], [0.20, 0.30, 0.60], [0.10, 0.52, 0.55], [0.40, 0.74, 0.35], [0.98, 0.90, 0.20]];
    let place = t.clamp(0.0, 1.0) * (STOPS.len() - 1) as f64;
    let below = (place as usize).min(STOPS.len() - 2);
    let mixed = Rgb::from(STOPS[below]).lerp(Rgb::from(STOPS[below + 1]), place - below as f64);
    mixed.to_array().map(srgb_decode).into()
}

#[cfg(test)]
mod tests {
    use super::*;
    use Component::{Glossy, Mirror, Reflected, Specular, Transmitted};

    fn set(components: &[Component]) -> ComponentSet {
        components.iter().copied().collect()
    }

    /// `T{RSGM}`: thresholds 1/5 to 4/5 (CREX.md's i/(n+1)).
    const RUNS: [Run; 5] =
        [(Transmitted, None), (Reflected, Some(0.2)), (Specular, Some(0.4)), (Glossy, Some(0.6)), (Mirror, Some(0.8))];

    #[test]
    fn pixels_get_what_their_importance_reaches() {
        let map = Raster::from_values(5, 1, vec![0.0, 0.2, 0.5, 0.79, 1.0]).unwrap();
        let map = ImportanceMap::new(map).unwrap();
        let sets = components_run(5, 1, Some(&map), &RUNS);
        let expected = [
            set(&[Transmitted]),
            set(&[Transmitted, Reflected]),
            set(&[Transmitted, Reflected, Specular]),
            set(&[Transmitted, Reflected, Specular, Glossy]),
            set(&[Transmitted, Reflected, Specular, Glossy, Mirror]),
        ];
        assert_eq!(sets.values(), expected);
        let everywhere = components_run(3, 2, None, &RUNS);
        assert!(everywhere.values().iter().all(|set| *set == expected[4]));
    }

    #[test]
    fn the_legend_lists_what_occurs_in_rising_lightness() {
        let values = vec![set(&[Mirror]), set(&[]), set(&[Mirror]), set(&[Reflected, Mirror])];
        let entries = legend(&Raster::from_values(4, 1, values).unwrap());
        let names: Vec<(String, f64)> = entries.iter().map(|entry| (entry.name(), entry.share)).collect();
        assert_eq!(names, [("DIRECT".to_owned(), 0.25), ("M".to_owned(), 0.5), ("RM".to_owned(), 0.25)]);
        let brightness: Vec<f64> = entries.iter().map(|entry| crate::color::brightness(entry.color)).collect();
        assert!(brightness.is_sorted(), "{brightness:?}");
    }

    #[test]
    fn the_picture_is_as_wide_as_the_map_and_shows_every_set_in_its_colour() {
        for (width, height) in [(1, 1), (40, 3), (600, 20)] {
            let values = (0..width * height).map(|i| if i % 3 == 0 { set(&[Glossy]) } else { set(&[]) }).collect();
            let sets = Raster::from_values(width, height, values).unwrap();
            let picture = picture(&sets);
            assert_eq!(picture.width(), width);
            assert!(picture.height() > height);
            for (place, (pixel, set)) in picture.values().iter().zip(sets.values()).enumerate() {
                let entry = legend(&sets).into_iter().find(|entry| entry.components == *set).unwrap();
                assert_eq!(*pixel, entry.color, "{place}");
            }
        }
    }
}
