//! The image planes: light that primary rays met, a layer for each component, and the ambient estimate.

use std::fmt;
use std::ops::Range;

use glam::{DVec3, Vec3};

use crate::color::Rgb;
use crate::component::{Component, ComponentSet, PerComponent};
use crate::raster::Raster;

/// Under which component light is filed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Layers {
    /// The event that spawned the ray which brought it.
    #[default]
    Last,
    /// The first event of its path from the eye.
    First,
}

/// A place on the film.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Plane {
    /// What primary rays brought.
    Direct,
    /// What a component's rays brought.
    Layer(Component),
    /// The estimate of the diffuse light that was not traced (`-av`).
    Ambient,
}

impl Plane {
    /// All that there are, in the order of files.
    pub fn all() -> impl Iterator<Item = Self> {
        let layers = Component::ALL.into_iter().map(Self::Layer);
        std::iter::once(Self::Direct).chain(layers).chain(std::iter::once(Self::Ambient))
    }

    /// The plane of a layer's name in files, which is how it displays: `direct`, a component's letter or `ambient`.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::all().find(|plane| plane.to_string() == name)
    }
}

impl fmt::Display for Plane {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Direct => f.write_str("direct"),
            Self::Layer(component) => component.fmt(f),
            Self::Ambient => f.write_str("ambient"),
        }
    }
}

/// Sums of radiance over the samples of some pixels, in double precision: what one parcel of rays adds to.
#[derive(Clone, Debug, Default)]
pub struct Planes {
    pixels: usize,
    /// Of each plane that there is, how many come before it.
    layers: PerComponent<Option<usize>>,
    ambient: Option<usize>,
    /// All planes one after the other, first the direct one: one piece of memory, since a picture has thousands of these.
    sums: Vec<Rgb>,
}

impl Planes {
    /// Makes all planes black, with room for `pixels`; only the layers of `components`, and the ambient plane if it is
    /// `ambient`, can be added to afterwards. Allocates only if they grow.
    pub fn clear(&mut self, pixels: usize, components: ComponentSet, ambient: bool) {
        let mut planes = 1;
        let mut place = |present: bool| {
            planes += usize::from(present);
            present.then(|| planes - 1)
        };
        let layers = PerComponent::from_fn(|component| place(components.contains(component)));
        let ambient = place(ambient);
        (self.pixels, self.layers, self.ambient) = (pixels, layers, ambient);
        self.sums.clear();
        self.sums.resize(planes * pixels, Rgb::ZERO);
    }

    /// Makes all planes black, with room for what another has room for.
    pub fn clear_like(&mut self, other: &Self) {
        (self.pixels, self.layers, self.ambient) = (other.pixels, other.layers, other.ambient);
        self.sums.clear();
        self.sums.resize(other.sums.len(), Rgb::ZERO);
    }

    /// Where a plane's sums lie; empty if there is no such plane.
    fn place(&self, plane: Plane) -> Range<usize> {
        let before = match plane {
            Plane::Direct => Some(0),
            Plane::Layer(component) => self.layers[component],
            Plane::Ambient => self.ambient,
        };
        before.map_or(0..0, |before| before * self.pixels..(before + 1) * self.pixels)
    }

    /// A plane's sums, pixel by pixel; nothing if there is no such plane.
    #[must_use]
    pub fn sums(&self, plane: Plane) -> &[Rgb] {
        &self.sums[self.place(plane)]
    }

    /// The same, to change.
    pub fn sums_mut(&mut self, plane: Plane) -> &mut [Rgb] {
        let place = self.place(plane);
        &mut self.sums[place]
    }

    /// Adds radiance at a pixel.
    pub fn add(&mut self, pixel: u32, plane: Plane, radiance: Rgb) {
        self.sums_mut(plane)[pixel as usize] += radiance;
    }

    /// Adds the sums of another set of planes, pixel by pixel; both must have been cleared alike.
    pub fn add_all(&mut self, other: &Self) {
        debug_assert_eq!((&self.layers, self.ambient), (&other.layers, other.ambient));
        self.sums.iter_mut().zip(&other.sums).for_each(|(sum, term)| *sum += *term);
    }

    /// Adds the sums of a rectangle of pixels that lies within the one that `other` is of; both must have been cleared alike.
    pub fn add_part(&mut self, part: &Block, other: &Self, whole: &Block) {
        let planes = self.sums.len() / self.pixels.max(1);
        for plane in 0..planes {
            for row in 0..part.height {
                let from = plane * other.pixels + (part.y - whole.y + row) * whole.width + part.x - whole.x;
                let to = plane * self.pixels + row * part.width;
                let terms = &other.sums[from..from + part.width];
                self.sums[to..to + part.width].iter_mut().zip(terms).for_each(|(sum, term)| *sum += *term);
            }
        }
    }
}

/// A rectangle of pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Block {
    /// First column.
    pub x: usize,
    /// First row, from the top.
    pub y: usize,
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
}

impl Block {
    /// Number of pixels.
    #[must_use]
    pub fn pixels(&self) -> usize {
        self.width * self.height
    }
}

/// A finished picture in its layers. Picture = direct + layers + ambient.
#[derive(Clone, Debug, PartialEq)]
pub struct Film {
    direct: Raster<Vec3>,
    layers: PerComponent<Option<Raster<Vec3>>>,
    ambient: Option<Raster<Vec3>>,
}

impl Film {
    /// A black film with layers for `components`, and an ambient plane if it is `ambient`.
    #[must_use]
    pub fn new(width: usize, height: usize, components: ComponentSet, ambient: bool) -> Self {
        let plane = || Raster::filled(width, height, Vec3::ZERO);
        Self {
            direct: plane(),
            layers: PerComponent::from_fn(|component| components.contains(component).then(plane)),
            ambient: ambient.then(plane),
        }
    }

    /// A film of these planes; `None` if their sizes differ.
    #[must_use]
    pub fn from_planes(
        direct: Raster<Vec3>,
        layers: PerComponent<Option<Raster<Vec3>>>,
        ambient: Option<Raster<Vec3>>,
    ) -> Option<Self> {
        let size = (direct.width(), direct.height());
        let planes = layers.iter().filter_map(|(_, layer)| layer.as_ref()).chain(&ambient);
        let same = planes.map(|plane| (plane.width(), plane.height())).all(|other| other == size);
        same.then_some(Self { direct, layers, ambient })
    }

    /// Pixels in a row.
    #[must_use]
    pub fn width(&self) -> usize {
        self.direct.width()
    }

    /// Rows.
    #[must_use]
    pub fn height(&self) -> usize {
        self.direct.height()
    }

    /// What primary rays brought: radiance, W/(sr m2).
    #[must_use]
    pub fn direct(&self) -> &Raster<Vec3> {
        &self.direct
    }

    /// What a component's rays brought; `None` counts as black.
    #[must_use]
    pub fn layer(&self, component: Component) -> Option<&Raster<Vec3>> {
        self.layers[component].as_ref()
    }

    /// The ambient estimate of diffuse light that was not traced; `None` counts as black.
    #[must_use]
    pub fn ambient(&self) -> Option<&Raster<Vec3>> {
        self.ambient.as_ref()
    }

    /// A plane; `None` counts as black.
    #[must_use]
    pub fn plane(&self, plane: Plane) -> Option<&Raster<Vec3>> {
        match plane {
            Plane::Direct => Some(&self.direct),
            Plane::Layer(component) => self.layers[component].as_ref(),
            Plane::Ambient => self.ambient.as_ref(),
        }
    }

    /// The same, to change.
    pub(crate) fn plane_mut(&mut self, plane: Plane) -> Option<&mut Raster<Vec3>> {
        match plane {
            Plane::Direct => Some(&mut self.direct),
            Plane::Layer(component) => self.layers[component].as_mut(),
            Plane::Ambient => self.ambient.as_mut(),
        }
    }

    /// The planes that there are, in the order of files.
    pub fn planes(&self) -> impl Iterator<Item = (Plane, &Raster<Vec3>)> {
        Plane::all().filter_map(|plane| Some((plane, self.plane(plane)?)))
    }

    /// Puts another plane of the film's size in the place of a layer.
    pub(crate) fn replace(&mut self, component: Component, plane: Raster<Vec3>) {
        assert_eq!((plane.width(), plane.height()), (self.width(), self.height()), "planes are of the film's size");
        self.layers[component] = Some(plane);
    }

    /// Removes the layers of all components that are not in `reached`.
    pub fn keep(&mut self, reached: ComponentSet) {
        for (component, layer) in self.layers.iter_mut() {
            if !reached.contains(component) {
                *layer = None;
            }
        }
    }

    /// Stores sums over `samples` samples as means, in a block of the picture.
    pub fn store(&mut self, block: Block, sums: &Planes, samples: u32) {
        let scale = 1.0 / f64::from(samples);
        let copy = |plane: &mut Raster<Vec3>, sums: &[Rgb]| {
            let stride = plane.width();
            for (row, sums) in sums.chunks_exact(block.width).enumerate() {
                let start = (block.y + row) * stride + block.x;
                let pixels = &mut plane.values_mut()[start..start + block.width];
                pixels.iter_mut().zip(sums).for_each(|(pixel, sum)| *pixel = single(*sum * scale));
            }
        };
        copy(&mut self.direct, sums.sums(Plane::Direct));
        for (component, layer) in self.layers.iter_mut() {
            if let Some(layer) = layer {
                copy(layer, sums.sums(Plane::Layer(component)));
            }
        }
        if let Some(ambient) = &mut self.ambient {
            copy(ambient, sums.sums(Plane::Ambient));
        }
    }

    /// Direct light, the ambient estimate and the layers of `components`, added up.
    #[must_use]
    pub fn develop(&self, components: ComponentSet) -> Raster<Vec3> {
        let pixels = self.develop_rows(components, 0..self.height());
        Raster::from_values(self.width(), self.height(), pixels).expect("as many pixels as the direct plane")
    }

    /// The same of some rows, pixel by pixel. Panics unless the rows are within the film.
    #[must_use]
    pub fn develop_rows(&self, components: ComponentSet, rows: Range<usize>) -> Vec<Vec3> {
        let range = rows.start * self.width()..rows.end * self.width();
        let mut sums: Vec<DVec3> = self.direct.values()[range.clone()].iter().map(|pixel| pixel.as_dvec3()).collect();
        let layers = components.iter().filter_map(|component| self.layers[component].as_ref());
        for plane in layers.chain(&self.ambient) {
            sums.iter_mut().zip(&plane.values()[range.clone()]).for_each(|(sum, pixel)| *sum += pixel.as_dvec3());
        }
        sums.into_iter().map(single).collect()
    }

    /// The whole picture.
    #[must_use]
    pub fn beauty(&self) -> Raster<Vec3> {
        self.develop(ComponentSet::ALL)
    }
}

/// A radiance in single precision; what exceeds its range becomes its largest number.
fn single(radiance: DVec3) -> Vec3 {
    radiance.min(DVec3::splat(f64::from(f32::MAX))).as_vec3()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_land_in_their_place_as_means_and_layers_add_up() {
        let components = ComponentSet::EMPTY.with(Component::Diffuse).with(Component::Mirror);
        let mut sums = Planes::default();
        sums.clear(4, components, true);
        let mut more = sums.clone();
        more.add(3, Plane::Direct, Rgb::splat(8.0));
        more.add(3, Plane::Layer(Component::Diffuse), Rgb::new(4.0, 0.0, 0.0));
        more.add(0, Plane::Layer(Component::Mirror), Rgb::splat(2.0));
        more.add(3, Plane::Ambient, Rgb::splat(1.0));
        sums.add_all(&more);
        sums.add_all(&more);
        let mut film = Film::new(5, 4, components, true);
        film.store(Block { x: 1, y: 2, width: 2, height: 2 }, &sums, 2);
        assert_eq!(*film.direct().at(2, 3), Vec3::splat(8.0));
        assert_eq!(*film.beauty().at(2, 3), Vec3::new(13.0, 9.0, 9.0));
        assert_eq!(*film.develop(ComponentSet::EMPTY).at(2, 3), Vec3::splat(9.0));
        assert_eq!(*film.beauty().at(1, 2), Vec3::splat(2.0));
        assert_eq!(film.beauty().values().iter().filter(|pixel| **pixel != Vec3::ZERO).count(), 2);
        assert!(film.layer(Component::Glossy).is_none());
        film.keep(ComponentSet::EMPTY.with(Component::Mirror));
        assert_eq!(*film.beauty().at(2, 3), Vec3::splat(9.0));
    }
}
