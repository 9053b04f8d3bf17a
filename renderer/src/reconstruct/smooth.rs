//! A component's plane with less noise: means over pixels that show the same kind of surface and, as far as the noise
//! lets one tell, the same light.
//!
//! Non-local means over two half buffers, with first hits beside the light: A. Buades, B. Coll and J.-M. Morel, CVPR
//! 2005; F. Rousselle, M. Manzi and M. Zwicker, "Robust Denoising using Feature and Color Information", Computer
//! Graphics Forum 32(7), 2013. Each half is averaged with weights that were found in the other, so the noise of the light
//! does not choose its own weights. The light is divided by the surface's diffuse reflectance first: what is left of
//! component D is irradiance, smooth over textures.
//!
//! Biased: where light changes by less than the noise hides, the change is smoothed.

use glam::Vec3;
use rayon::prelude::*;

use super::padded::{Padded, box_means};
use crate::color::brightness;
use crate::raster::Raster;

/// Reach of the means, pixels in each direction.
const REACH: usize = 8;

/// Radius of the patches of light that are compared.
const PATCH: usize = 3;

/// Radius of the squares over which the variance is estimated.
const VARIANCE: usize = 3;

/// How much light may differ, in standard deviations of the noise, before pixels are told apart: k of the paper.
const SENSITIVITY: f32 = 0.45;

/// Square of the distance of unit normals from which on surfaces have nothing in common (32 degrees).
const NORMALS: f32 = 0.3;

/// Distance from each other's plane, as a fraction of the distance from the eye, from which on surfaces have nothing in
/// common: some six pixels of a picture 60 degrees wide.
const PLANES: f32 = 0.005;

/// Reflectance below which light is not divided by it: what a mirror or a pane shows is no light on it.
const LEAST_ALBEDO: f32 = 0.004;

/// Rows that are worked on together.
const BAND: usize = 16;

/// What first hits say.
#[derive(Clone, Copy, Debug)]
pub struct Guides<'a> {
    /// Unit normals; zero where nothing is met.
    pub normal: &'a Raster<Vec3>,
    /// Points, in the scene's unit, relative to the eye; zero where nothing is met.
    pub point: &'a Raster<Vec3>,
    /// Diffuse reflectance, in [0, 1], zero where light is not in proportion to it; `None`: it is nowhere.
    pub albedo: Option<&'a Raster<Vec3>>,
}

/// A plane with less noise.
#[derive(Clone, Debug, PartialEq)]
pub struct Smoothed {
    /// The plane.
    pub plane: Raster<Vec3>,
    /// Root mean square of its noise before, relative to its mean brightness: half the difference of the halves.
    pub noise_before: f64,
    /// The same of the smoothed halves. Noise alone: what smoothing moved is not in it.
    pub noise_after: f64,
}

/// Everything that the means are made of.
struct Inputs {
    /// Light of each half by channel, divided by the reflectance.
    light: [[Padded; 3]; 2],
    /// Its brightness.
    grey: [Padded; 2],
    /// Variance of the brightness of one half.
    variance: Padded,
    normal: [Padded; 3],
    point: [Padded; 3],
    /// 1 where light was divided by the reflectance, 0 where not: two kinds that do not mix.
    divided: Padded,
    /// One over the square of the distance from a plane at which surfaces part.
    parting: Padded,
}

/// Smooths a plane given as the means of two halves of its samples, which stand for `shares` of them (sum 1). All rasters
/// are of one size. The same for any number of threads.
#[must_use]
pub fn smooth(halves: [&Raster<Vec3>; 2], shares: [f32; 2], guides: &Guides<'_>) -> Smoothed {
    let (width, height) = (halves[0].width(), halves[0].height());
    let albedo = |pixel: usize| {
        let albedo = guides.albedo.map(|albedo| albedo.values()[pixel]);
        albedo.filter(|albedo| albedo.min_element() >= LEAST_ALBEDO)
    };
    let divisor = |pixel: usize| albedo(pixel).unwrap_or(Vec3::ONE);
    let inputs = Inputs::new(halves, guides, divisor, |pixel| albedo(pixel).is_some());
    let mut bands: Vec<[Vec<Vec3>; 2]> = Vec::new();
    let starts: Vec<usize> = (0..height).step_by(BAND).collect();
    starts
        .into_par_iter()
        .map(|start| inputs.band(width, start, BAND.min(height - start)))
        .collect_into_vec(&mut bands);
    let smoothed = |half: usize| bands.iter().flat_map(move |band| band[half].iter().copied());
    let mut values = Vec::with_capacity(width * height);
    let (mut before, mut after, mut mean) = (0.0_f64, 0.0_f64, 0.0_f64);
    let square = |a: Vec3, b: Vec3| brightness((0.5 * (a - b)).as_dvec3()).powi(2);
    for (pixel, (first, second)) in smoothed(0).zip(smoothed(1)).enumerate() {
        let divisor = divisor(pixel);
        let value = (first * shares[0] + second * shares[1]) * divisor;
        before += square(halves[0].values()[pixel], halves[1].values()[pixel]);
        after += square(first * divisor, second * divisor);
        mean += brightness(value.as_dvec3());
        values.push(value);
    }
    let pixels = (width * height) as f64;
    let relative = |squares: f64| if mean > 0.0 { (squares / pixels).sqrt() / (mean / pixels) } else { 0.0 };
    let plane = Raster::from_values(width, height, values).expect("a value was made for every pixel");
    Smoothed { plane, noise_before: relative(before), noise_after: relative(after) }
}

impl Inputs {
    fn new(
        halves: [&Raster<Vec3>; 2],
        guides: &Guides<'_>,
        divisor: impl Fn(usize) -> Vec3 + Sync,
        is_divided: impl Fn(usize) -> bool + Sync,
    ) -> Self {
        let (width, height) = (halves[0].width(), halves[0].height());
        let margin = REACH + PATCH;
        let plane = |value: &(dyn Fn(usize) -> f32 + Sync)| Padded::new(width, height, margin, value);
        let light = halves.map(|half| {
            [0, 1, 2].map(|channel| plane(&|pixel| half.values()[pixel][channel] / divisor(pixel)[channel]))
        });
        let grey_at =
            |half: usize, pixel: usize| brightness((halves[half].values()[pixel] / divisor(pixel)).as_dvec3()) as f32;
        let grey = [0, 1].map(|half| plane(&|pixel| grey_at(half, pixel)));
        let squares = Padded::new(width, height, VARIANCE, |pixel| {
            let difference = grey_at(0, pixel) - grey_at(1, pixel);
            0.5 * difference * difference
        });
        let mut variance = vec![0.0; width * height];
        let rows = (-(VARIANCE as isize)..(height + VARIANCE) as isize)
            .flat_map(|y| squares.row(-(VARIANCE as isize), y, width + 2 * VARIANCE).iter().copied())
            .collect::<Vec<f32>>();
        box_means(&rows, width, VARIANCE, &mut Vec::new(), &mut variance);
        let of = |raster: &Raster<Vec3>| [0, 1, 2].map(|axis| plane(&|pixel| raster.values()[pixel][axis]));
        Self {
            light,
            grey,
            variance: plane(&|pixel| variance[pixel]),
            normal: of(guides.normal),
            point: of(guides.point),
            divided: plane(&|pixel| f32::from(u8::from(is_divided(pixel)))),
            parting: plane(&|pixel| {
                let distance = PLANES * guides.point.values()[pixel].length();
                if distance > 0.0 { 1.0 / (distance * distance) } else { 0.0 }
            }),
        }
    }

    /// The smoothed halves, divided by the reflectance, of `rows` rows from `start` on.
    fn band(&self, width: usize, start: usize, rows: usize) -> [Vec<Vec3>; 2] {
        let mut room = Room::new(width, rows);
        let reach = REACH as isize;
        for down in -reach..=reach {
            for across in -reach..=reach {
                self.add(&mut room, width, start as isize, [across, down]);
            }
        }
        let Room { sums, weights, .. } = room;
        [0, 1].map(|half| {
            let channels = sums[half][0].iter().zip(&sums[half][1]).zip(&sums[half][2]);
            let values = channels.map(|((&r, &g), &b)| Vec3::new(r, g, b));
            values.zip(&weights[half]).map(|(sum, &weight)| sum / weight).collect()
        })
    }

    /// Adds to every pixel of a band the one that lies `shift` away.
    fn add(&self, room: &mut Room, width: usize, start: isize, shift: [isize; 2]) {
        let Room { rows, distances, sums, weights, patches, line, alike } = room;
        let (wide, patch) = (width + 2 * PATCH, PATCH as isize);
        for (grey, (distances, patches)) in self.grey.iter().zip(distances.iter_mut().zip(patches.iter_mut())) {
            for (row, distances) in distances.chunks_exact_mut(wide).enumerate() {
                let y = start + row as isize - patch;
                let here = grey.row(-patch, y, wide).iter().zip(self.variance.row(-patch, y, wide));
                let (x, y) = (shift[0] - patch, y + shift[1]);
                let there = grey.row(x, y, wide).iter().zip(self.variance.row(x, y, wide));
                for (distance, ((a, a_variance), (b, b_variance))) in distances.iter_mut().zip(here.zip(there)) {
                    let (difference, variance) = (a - b, a_variance + b_variance);
                    let scale = SENSITIVITY * SENSITIVITY * variance + f32::MIN_POSITIVE;
                    *distance = ((difference * difference - variance) / scale).min(MOST_DISTANCE);
                }
            }
            box_means(distances, width, PATCH, line, patches);
        }
        for row in 0..*rows {
            let y = start + row as isize;
            self.alike(width, y, shift, alike);
            let range = row * width..(row + 1) * width;
            for half in [0, 1] {
                // The other half's light chooses.
                let patches = &patches[1 - half][range.clone()];
                let weights = &mut weights[half][range.clone()];
                line.clear();
                line.extend(alike.iter().zip(patches).map(|(alike, distance)| {
                    // (1 - d/4)^4 for exp(-d), which ends.
                    let root = (1.0 - 0.25 * distance.max(0.0)).max(0.0);
                    alike * (root * root) * (root * root)
                }));
                weights.iter_mut().zip(line.iter()).for_each(|(sum, weight)| *sum += weight);
                for (sums, light) in sums[half].iter_mut().zip(&self.light[half]) {
                    let light = light.row(shift[0], y + shift[1], width);
                    let sums = &mut sums[range.clone()];
                    sums.iter_mut()
                        .zip(light)
                        .zip(line.iter())
                        .for_each(|((sum, light), weight)| *sum += weight * light);
                }
            }
        }
    }

    /// How much each pixel of a row has in common with the one `shift` away as a surface, in [0, 1].
    fn alike(&self, width: usize, y: isize, shift: [isize; 2], alike: &mut [f32]) {
        let normal = self.normal.each_ref().map(|plane| plane.row(0, y, width));
        let point = self.point.each_ref().map(|plane| plane.row(0, y, width));
        let (x2, y2) = (shift[0], y + shift[1]);
        let other_normal = self.normal.each_ref().map(|plane| plane.row(x2, y2, width));
        let other_point = self.point.each_ref().map(|plane| plane.row(x2, y2, width));
        let parting = self.parting.row(0, y, width);
        let (divided, other_divided) = (self.divided.row(0, y, width), self.divided.row(x2, y2, width));
        for (x, alike) in alike.iter_mut().enumerate() {
            let kinds = divided[x] - other_divided[x];
            let (mut turned, mut above, mut below) = (kinds * kinds, 0.0, 0.0);
            for axis in 0..3 {
                let (n, m) = (normal[axis][x], other_normal[axis][x]);
                let way = other_point[axis][x] - point[axis][x];
                turned += (n - m) * (n - m);
                above += way * n;
                below += way * m;
            }
            let apart = (above * above).max(below * below) * parting[x];
            let (turned, apart) = ((1.0 - turned / NORMALS).max(0.0), (1.0 - apart).max(0.0));
            *alike = turned * turned * apart * apart;
        }
    }
}

/// What a pixel counts at most in the distance of two patches: enough to part them alone, not enough to overflow.
const MOST_DISTANCE: f32 = 1e4;

/// Where a band is worked on.
struct Room {
    rows: usize,
    /// Distances of pixels, with the patches' margins, by half.
    distances: [Vec<f32>; 2],
    /// Distances of patches.
    patches: [Vec<f32>; 2],
    sums: [[Vec<f32>; 3]; 2],
    weights: [Vec<f32>; 2],
    line: Vec<f32>,
    alike: Vec<f32>,
}

impl Room {
    fn new(width: usize, rows: usize) -> Self {
        let plane = || vec![0.0; width * rows];
        let wide = || vec![0.0; (width + 2 * PATCH) * (rows + 2 * PATCH)];
        Self {
            rows,
            distances: [wide(), wide()],
            patches: [plane(), plane()],
            sums: [[plane(), plane(), plane()], [plane(), plane(), plane()]],
            weights: [plane(), plane()],
            line: Vec::new(),
            alike: vec![0.0; width],
        }
    }
}

#[cfg(test)]
#[path = "smooth_tests.rs"]
mod tests;
