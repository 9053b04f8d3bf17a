//! The saliency map of Itti, Koch and Niebur, "A model of saliency-based visual attention for rapid scene analysis",
//! IEEE PAMI 20(11), 1998: 6 intensity, 12 colour and 24 orientation maps, normalised, combined and summed.
//!
//! One sign differs from the print. Its equation 2 subtracts (G - R) at the surround from (R - G) at the centre, by
//! which an even red field answers most and a green spot on red least; the cells that its text describes, excited by
//! red and inhibited by green in the centre *and the other way round in the surround*, answer to
//! (R - G)(centre) - (R - G)(surround). That is what stands here, for blue and yellow likewise.

mod orientation;
mod pyramid;

use crate::raster::Raster;
use orientation::{ANGLES_DEG, gabor_energy};
use pyramid::{Plane, expanded, pyramid, reduced};

/// Scales 0 to 8.
const LEVELS: usize = 9;
/// Centre scales c; the surrounds are c + 3 and c + 4.
const CENTRES: [usize; 3] = [2, 3, 4];
const SURROUND_STEPS: [usize; 2] = [3, 4];
/// The scale at which maps are added.
const MAP_SCALE: usize = 4;
/// Where intensity is under this part of the picture's largest, hue is not seen and counts as none.
const DARK: f32 = 0.1;

/// A map that varies by less holds no feature, only rounding: a fortieth of a step of an 8-bit picture.
const FLAT: f32 = 1e-4;

/// Saliency of every pixel of a display-referred picture (red, green, blue in [0, 1], as shown), scaled to [0, 1]:
/// 1 is the most salient place, and a picture without any feature is 0 everywhere.
///
/// The paper's sum at scale 4 is read bilinearly at full size. Not finite values count as 0.
#[must_use]
pub fn saliency(picture: &Raster<[f32; 3]>) -> Raster<f32> {
    let (width, height) = (picture.width(), picture.height());
    if width == 0 || height == 0 {
        return Raster::filled(width, height, 0.0);
    }
    let features = Features::of(picture);
    let at_scale = |maps: Vec<Plane>| across_scale_sum(maps.into_iter().map(normalised));

    let intensity = at_scale(differences(&features.intensity));
    let opponent = |pyramid: &[Plane]| differences(pyramid).into_iter().map(normalised).collect::<Vec<_>>();
    let colour = across_scale_sum(
        opponent(&features.red_green).into_iter().zip(opponent(&features.blue_yellow)).map(|(rg, by)| added(rg, &by)),
    );
    let mut orientation: Option<Plane> = None;
    for angle in ANGLES_DEG {
        let energies: Vec<Plane> = features
            .intensity
            .iter()
            .enumerate()
            .map(
                |(level, plane)| {
                    if level < CENTRES[0] { Raster::filled(1, 1, 0.0) } else { gabor_energy(plane, angle) }
                },
            )
            .collect();
        let one_angle = normalised(at_scale(differences(&energies)));
        orientation = Some(match orientation {
            Some(sum) => added(sum, &one_angle),
            None => one_angle,
        });
    }
    let orientation = orientation.expect("there are four angles");

    let sum = added(added(normalised(intensity), &normalised(colour)), &normalised(orientation));
    // Every value at scale 4 lies on a pixel, so the largest there is the largest of all.
    let largest = sum.values().iter().copied().fold(0.0, f32::max);
    let scaled = if largest > 0.0 { mapped(&sum, |value| value / largest) } else { sum };
    expanded(&scaled, MAP_SCALE as u32, width, height)
}

/// Where the eye is predicted to go first: column and row of the largest saliency, the first in rows where several
/// are equal; `None` where nothing is salient.
#[must_use]
pub fn first_fixation(saliency: &Raster<f32>) -> Option<(usize, usize)> {
    let mut best = (0.0, None);
    for (index, &value) in saliency.values().iter().enumerate() {
        if value > best.0 {
            best = (value, Some((index % saliency.width(), index / saliency.width())));
        }
    }
    best.1
}

/// The pyramids from which all 42 maps are made.
struct Features {
    intensity: Vec<Plane>,
    /// R - G.
    red_green: Vec<Plane>,
    /// B - Y.
    blue_yellow: Vec<Plane>,
}

impl Features {
    fn of(picture: &Raster<[f32; 3]>) -> Self {
        let (width, height) = (picture.width(), picture.height());
        let seen = |value: f32| if value.is_finite() { value } else { 0.0 };
        let plane = |values: Vec<f32>| Raster::from_values(width, height, values).expect("one value a pixel");
        let pixels = picture.values();
        let mut intensity = vec![0.0_f32; pixels.len()];
        for (light, &[r, g, b]) in intensity.iter_mut().zip(pixels) {
            *light = (seen(r) + seen(g) + seen(b)) / 3.0;
        }
        let dark = DARK * intensity.iter().copied().fold(0.0, |most, light| if light > most { light } else { most });
        let mut red_green = vec![0.0_f32; pixels.len()];
        let mut blue_yellow = vec![0.0_f32; pixels.len()];
        let opponents = red_green.iter_mut().zip(&mut blue_yellow);
        for ((&[r, g, b], &light), (red_green, blue_yellow)) in pixels.iter().zip(&intensity).zip(opponents) {
            // Without branches: where hue is not seen, all three are 0 and so are their differences.
            let unit = if light > dark { light } else { f32::INFINITY };
            let (r, g, b) = (seen(r) / unit, seen(g) / unit, seen(b) / unit);
            let red = (r - (g + b) / 2.0).max(0.0);
            let green = (g - (r + b) / 2.0).max(0.0);
            let blue = (b - (r + g) / 2.0).max(0.0);
            let yellow = ((r + g) / 2.0 - (r - g).abs() / 2.0 - b).max(0.0);
            *red_green = red - green;
            *blue_yellow = blue - yellow;
        }
        // Filtering is linear: the pyramid of a difference is the difference of the pyramids.
        Self {
            intensity: pyramid(plane(intensity), LEVELS),
            red_green: pyramid(plane(red_green), LEVELS),
            blue_yellow: pyramid(plane(blue_yellow), LEVELS),
        }
    }
}

/// |centre(c) - surround(s)| for c = 2, 3, 4 and s = c + 3, c + 4, each at its scale c, in that order.
fn differences(pyramid: &[Plane]) -> Vec<Plane> {
    let mut maps = Vec::with_capacity(CENTRES.len() * SURROUND_STEPS.len());
    for c in CENTRES {
        for step in SURROUND_STEPS {
            let fine = &pyramid[c];
            let mut map = expanded(&pyramid[c + step], step as u32, fine.width(), fine.height());
            for (value, &here) in map.values_mut().iter_mut().zip(fine.values()) {
                *value = (here - *value).abs();
            }
            maps.push(map);
        }
    }
    maps
}

/// The paper's operator N: scaled to [0, 1], then multiplied by (1 - m)^2 with m the mean of the local maxima other
/// than the largest, so that a map with one peak gains on a map with many.
fn normalised(map: Plane) -> Plane {
    let (low, high) = map.values().iter().fold((f32::MAX, f32::MIN), |(l, h), &v| (l.min(v), h.max(v)));
    if high - low <= FLAT {
        return Raster::filled(map.width(), map.height(), 0.0);
    }
    let scaled = mapped(&map, |value| (value - low) / (high - low));
    let mean = mean_of_other_maxima(&scaled);
    mapped(&scaled, |value| value * (1.0 - mean) * (1.0 - mean))
}

/// Mean of the strict local maxima (eight neighbours, borders included) except the largest; 0 where there is none.
fn mean_of_other_maxima(map: &Plane) -> f32 {
    let (width, height) = (map.width(), map.height());
    let values = map.values();
    let (mut sum, mut count, mut largest) = (0.0_f64, 0_u32, f32::MIN);
    let row = |y: usize| &values[y * width..(y + 1) * width];
    for y in 0..height {
        let here = row(y);
        // Beyond the border there is nothing to be exceeded by.
        let above = (y > 0).then(|| row(y - 1));
        let below = (y + 1 < height).then(|| row(y + 1));
        for (x, &value) in here.iter().enumerate() {
            // Most pixels fail at their first neighbours.
            let left = x == 0 || here[x - 1] < value;
            if !(left && (x + 1 == width || here[x + 1] < value)) {
                continue;
            }
            let near = x.saturating_sub(1)..(x + 2).min(width);
            let lower =
                |row: Option<&[f32]>| row.is_none_or(|row| row[near.clone()].iter().all(|&other| other < value));
            if lower(above) && lower(below) {
                sum += f64::from(value);
                count += 1;
                largest = largest.max(value);
            }
        }
    }
    if count < 2 { 0.0 } else { ((sum - f64::from(largest)) / f64::from(count - 1)) as f32 }
}

/// The maps of [`differences`], in its order, reduced to scale 4 and added.
fn across_scale_sum(maps: impl Iterator<Item = Plane>) -> Plane {
    let mut total: Option<Plane> = None;
    for (index, map) in maps.enumerate() {
        let scale = CENTRES[index / SURROUND_STEPS.len()];
        let map = (scale..MAP_SCALE).fold(map, |plane, _| reduced(&plane));
        total = Some(match total {
            Some(sum) => added(sum, &map),
            None => map,
        });
    }
    total.expect("there are six maps")
}

fn mapped(plane: &Plane, change: impl Fn(f32) -> f32) -> Plane {
    let values = plane.values().iter().map(|&value| change(value)).collect();
    Raster::from_values(plane.width(), plane.height(), values).expect("as many values as before")
}

fn added(mut sum: Plane, more: &Plane) -> Plane {
    for (value, &part) in sum.values_mut().iter_mut().zip(more.values()) {
        *value += part;
    }
    sum
}

#[cfg(test)]
mod tests;
