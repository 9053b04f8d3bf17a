//! The low-level pass: first hits alone, without light. Costs one closest hit a ray.

use glam::Vec3;
use rayon::prelude::*;

use super::look::Made;
use super::parcel::Samples;
use super::ray::{PathRay, RayPath};
use super::trace::{Meeting, Tracer};
use crate::color::Rgb;
use crate::component::Component;
use crate::features::{Features, Wanted};
use crate::geometry::SurfaceId;
use crate::material::Interaction;
use crate::pattern::Memory;
use crate::raster::Raster;

/// A pixel of all planes.
#[derive(Clone, Copy)]
struct Pixel {
    object: Option<SurfaceId>,
    depth: f32,
    normal: Vec3,
    albedo: Vec3,
}

impl Tracer<'_> {
    /// The first hits of a whole picture, in the planes that are `wanted`; each pixel is looked at by a regular grid of
    /// `a_side` x `a_side` rays (at least 1; 1 is the pixel's centre).
    #[must_use]
    pub fn first_hits(&self, samples: &Samples<'_>, wanted: Wanted, a_side: usize) -> Features {
        let pixels = each_pixel(samples, |x, y| self.look_at(samples, wanted, a_side.max(1), x, y));
        fn plane<T>(pixels: &Raster<Pixel>, wanted: bool, value: impl Fn(&Pixel) -> T) -> Option<Raster<T>> {
            let values = || pixels.values().iter().map(value).collect();
            wanted.then(values).and_then(|values| Raster::from_values(pixels.width(), pixels.height(), values))
        }
        Features {
            object: plane(&pixels, wanted.object, |pixel| pixel.object),
            depth: plane(&pixels, wanted.depth, |pixel| pixel.depth),
            normal: plane(&pixels, wanted.normal, |pixel| pixel.normal),
            albedo: plane(&pixels, wanted.albedo, |pixel| pixel.albedo),
        }
    }

    /// The pixels in which any of `a_side` x `a_side` rays first meets a surface that `counts`.
    #[must_use]
    pub fn pixels_showing(
        &self,
        samples: &Samples<'_>,
        a_side: usize,
        counts: impl Fn(SurfaceId) -> bool + Sync,
    ) -> Raster<bool> {
        each_pixel(samples, |x, y| {
            let mut hits = self.grid(samples, a_side.max(1), x, y);
            hits.any(|(meeting, _)| meeting.hit.is_some_and(|(hit, _)| counts(hit.surface)))
        })
    }

    fn look_at(&self, samples: &Samples<'_>, wanted: Wanted, a_side: usize, x: usize, y: usize) -> Pixel {
        let mut votes: Vec<(SurfaceId, u32)> = Vec::new();
        let (mut met, mut depth, mut normal, mut albedo) = (0_u32, 0.0_f64, Vec3::ZERO, Vec3::ZERO);
        for (meeting, made) in self.grid(samples, a_side, x, y) {
            let Some((hit, look)) = meeting.hit else { continue };
            let Some(material) = look.material(&made) else { continue };
            met += 1;
            depth += meeting.length;
            let side = if hit.is_front(meeting.ray.dir) { 1.0 } else { -1.0 };
            normal += side * hit.normal.as_vec3();
            if wanted.object {
                match votes.iter_mut().find(|(surface, _)| *surface == hit.surface) {
                    Some((_, count)) => *count += 1,
                    None => votes.push((hit.surface, 1)),
                }
            }
            if wanted.albedo {
                let interaction = Interaction::new(meeting.ray.dir, hit.normal);
                material.scatter(interaction, self.limits.glossy_threshold, |lobe| {
                    if Component::of(lobe.event) == Component::Diffuse {
                        albedo += lobe.coefficient.as_vec3();
                    }
                });
            }
        }
        let most = votes.iter().map(|&(_, count)| count).max();
        let object = votes.iter().find(|&&(_, count)| Some(count) == most).map(|&(surface, _)| surface);
        if met == 0 {
            return Pixel { object: None, depth: f32::INFINITY, normal: Vec3::ZERO, albedo: Vec3::ZERO };
        }
        let share = 1.0 / met as f32;
        Pixel { object, depth: (depth / f64::from(met)) as f32, normal: normal * share, albedo: albedo * share }
    }

    /// What the rays through the middles of `a_side` x `a_side` cells of a pixel meet, row by row.
    fn grid<'a>(
        &'a self,
        samples: &'a Samples<'_>,
        a_side: usize,
        x: usize,
        y: usize,
    ) -> impl Iterator<Item = (Meeting<'a>, Made)> {
        /// Of mixed materials the one that covers more is seen.
        const MIDDLE: f64 = 0.5;
        let (mut memory, mut pieces) = (Memory::default(), Vec::new());
        let middle = move |i: usize| (i as f64 + 0.5) / a_side as f64;
        (0..a_side * a_side).filter_map(move |i| {
            let across = (x as f64 + middle(i % a_side)) / samples.width as f64;
            let down = (y as f64 + middle(i / a_side)) / samples.height as f64;
            let ray = samples.view.ray(across, down)?;
            let path = PathRay { ray, ripple: Rgb::ONE, path: RayPath::primary(0, 0) };
            let mut made = None;
            let meeting = self.meet(&path, MIDDLE, &mut memory, &mut pieces, &mut made)?;
            Some((meeting, made))
        })
    }
}

/// A value for every pixel, rows in parallel.
fn each_pixel<T: Send>(samples: &Samples<'_>, value: impl Fn(usize, usize) -> T + Sync) -> Raster<T> {
    let (width, height) = (samples.width, samples.height);
    let place = |index: usize| value(index % width.max(1), index / width.max(1));
    let values = (0..width * height).into_par_iter().map(place).collect();
    Raster::from_values(width, height, values).expect("one value a pixel was made")
}
