//! A picture some of whose planes are smoothed: biased, far less noisy.

use std::sync::Mutex;

use glam::Vec3;

use super::{RenderError, Renderer, Rendering, settings};
use crate::component::{Component, ComponentSet};
use crate::features::Wanted;
use crate::film::Film;
use crate::raster::Raster;
use crate::reconstruct::{Guides, smooth};

/// Rays on a side of the grid through which a pixel's reflectance is looked at.
const ALBEDO_GRID: usize = 3;

/// What smoothing did to one plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SmoothedPlane {
    /// Which.
    pub component: Component,
    /// Root mean square of its noise before, relative to the plane's mean brightness.
    pub noise_before: f64,
    /// The same after. What smoothing moved (its bias) is not in it.
    pub noise_after: f64,
}

impl Renderer<'_> {
    /// Renders the picture as [`Self::render`] does and smooths the planes of `components`, each by itself
    /// ([`crate::reconstruct`]): layers still add up to the picture, and the picture is the same for any number of threads.
    /// Biased. Layers must be filed by the last event, else a plane's light is not in proportion to what is seen.
    ///
    /// # Errors
    /// If there are fewer than 2 samples, which tell no noise; if continuous importance spreads them unevenly; if the threads
    /// cannot be started.
    pub fn render_smoothed(&self, components: ComponentSet) -> Result<(Rendering, Vec<SmoothedPlane>), RenderError> {
        if self.settings.samples < 2 {
            return Err(settings::out_of_range(
                "the number of samples",
                self.settings.samples,
                "2 or more to smooth planes",
            ));
        }
        self.in_threads(|| {
            let kept: ComponentSet = self.stored().iter().filter(|&component| components.contains(component)).collect();
            let first = Mutex::new(Film::new(self.settings.width, self.settings.height, kept, false));
            let mut rendering = self.render_tiles(Some(&first))?;
            let first = first.into_inner().expect("no thread panicked");
            let planes = self.smooth_planes(kept, &first, &mut rendering.film);
            Ok((rendering, planes))
        })?
    }

    /// Smooths planes of a film, of which `first` holds the mean of the first half of the samples.
    fn smooth_planes(&self, components: ComponentSet, first: &Film, film: &mut Film) -> Vec<SmoothedPlane> {
        let (tracer, samples) = (self.tracer(), self.samples());
        let wanted = Wanted { depth: true, normal: true, albedo: true, ..Wanted::default() };
        let hits = tracer.first_hits(&samples, wanted, 1);
        let wanted = Wanted { albedo: true, ..Wanted::default() };
        let albedo = tracer.first_hits(&samples, wanted, ALBEDO_GRID).albedo;
        let (Some(depth), Some(normal), Some(middle), Some(mut albedo)) =
            (hits.depth, hits.normal, hits.albedo, albedo)
        else {
            return Vec::new();
        };
        // A pixel that is partly a mirror or a pane shows light that its reflectance has no part in.
        for (albedo, middle) in albedo.values_mut().iter_mut().zip(middle.values()) {
            if albedo.max_element() < 0.5 * middle.max_element() || middle.max_element() == 0.0 {
                *albedo = Vec3::ZERO;
            }
        }
        let point = self.points(&depth);
        let count = self.settings.samples;
        let shares = [self.first_half(), count - self.first_half()].map(|part| part as f32 / count as f32);
        let mut done = Vec::new();
        for component in components.iter() {
            let (Some(first), Some(whole)) = (first.layer(component), film.layer(component)) else { continue };
            let rest = whole
                .values()
                .iter()
                .zip(first.values())
                .map(|(&whole, &first)| (whole - first * shares[0]) / shares[1]);
            let second = Raster::from_values(whole.width(), whole.height(), rest.collect());
            let second = second.expect("as many pixels as the plane");
            let albedo = (component == Component::Diffuse).then_some(&albedo);
            let smoothed = smooth([first, &second], shares, &Guides { normal: &normal, point: &point, albedo });
            film.replace(component, smoothed.plane);
            let (noise_before, noise_after) = (smoothed.noise_before, smoothed.noise_after);
            done.push(SmoothedPlane { component, noise_before, noise_after });
        }
        done
    }

    /// Samples of the first half.
    pub(super) fn first_half(&self) -> u32 {
        self.settings.samples / 2
    }

    /// Where the middles of pixels meet the scene, relative to the eye; zero where they do not.
    fn points(&self, depth: &Raster<f32>) -> Raster<Vec3> {
        let (width, height) = (depth.width(), depth.height());
        let point = |(pixel, &depth): (usize, &f32)| {
            let (x, y) = ((pixel % width) as f64 + 0.5, (pixel / width) as f64 + 0.5);
            match self.view.ray(x / width as f64, y / height as f64) {
                Some(ray) if depth.is_finite() => (ray.at(f64::from(depth)) - self.view.point()).as_vec3(),
                _ => Vec3::ZERO,
            }
        };
        let points = depth.values().iter().enumerate().map(point).collect();
        Raster::from_values(width, height, points).expect("a point for every pixel")
    }
}
