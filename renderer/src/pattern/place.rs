//! A hit as functions see it.

use glam::{DAffine3, DVec3};

use crate::cal::Surroundings;
use crate::color::Rgb;
use crate::math::Similarity;

/// What functions can ask of a hit, in the scene's coordinates.
#[derive(Clone, Copy, Debug)]
pub struct Place<'a> {
    /// Where the ray meets the surface.
    pub point: DVec3,
    /// Direction of the ray, towards the surface; a unit vector.
    pub dir: DVec3,
    /// Unit normal of the surface's own front.
    pub normal: DVec3,
    /// Length of the ray.
    pub distance: f64,
    /// Coordinates on a mesh, if it has them.
    pub uv: Option<[f64; 2]>,
    /// The instance or mesh that was hit, if one was.
    pub object: Option<Inside<'a>>,
}

/// The way into an instance or a mesh.
#[derive(Clone, Copy, Debug)]
pub struct Inside<'a> {
    /// From the scene's coordinates to those of the instance that holds it, if one does.
    pub around: Option<Similarity>,
    /// From there, or from the scene's coordinates, to its own.
    pub own: &'a Similarity,
}

impl Inside<'_> {
    /// From the scene's coordinates to the innermost ones.
    #[must_use]
    pub fn whole(&self) -> Similarity {
        self.around.map_or(*self.own, |around| around.then(self.own))
    }
}

impl Place<'_> {
    /// The point in the coordinates of the object that was hit.
    pub(super) fn local_point(&self) -> DVec3 {
        self.object.map_or(self.point, |object| object.whole().point(self.point))
    }

    /// A vector of the coordinates that `to_local` leads to, turned (not scaled) back into the scene's.
    #[must_use]
    pub fn turned_back(&self, to_local: &Similarity, vector: DVec3) -> DVec3 {
        let to_local = self.local(to_local);
        to_local.affine.matrix3.transpose() * vector / to_local.scale
    }

    /// From the scene's coordinates to those of a function whose own transform is undone by `inverse`.
    fn local(&self, inverse: &Similarity) -> Similarity {
        self.object.map_or(*inverse, |object| object.whole().then(inverse))
    }
}

/// What functions of a material's reflection can ask besides.
#[derive(Clone, Copy, Debug)]
pub struct Reflection {
    /// Unit normal on the ray's side, bent by textures.
    pub normal: DVec3,
    /// Cosine between it and the way back along the ray.
    pub cosine: f64,
    /// The material's colour, patterns included.
    pub color: Rgb,
    /// Unit direction to the light that a prism is asked for.
    pub to_light: Option<DVec3>,
}

/// The surroundings of one primitive's functions.
pub(super) struct Local<'a> {
    place: &'a Place<'a>,
    to_local: DAffine3,
    scale: f64,
    reals: &'a [f64],
    reflection: Option<&'a Reflection>,
}

impl<'a> Local<'a> {
    pub(super) fn new(
        place: &'a Place<'a>,
        inverse: &Similarity,
        reals: &'a [f64],
        reflection: Option<&'a Reflection>,
    ) -> Self {
        let Similarity { affine, scale } = place.local(inverse);
        Self { place, to_local: affine, scale, reals, reflection }
    }

    fn direction(&self, vector: DVec3) -> DVec3 {
        self.to_local.transform_vector3(vector) / self.scale
    }

    /// A vector into local coordinates, lengths and all.
    pub(super) fn turned(&self, vector: DVec3) -> DVec3 {
        self.direction(vector)
    }
}

impl Surroundings for Local<'_> {
    fn channel(&self, n: u32) -> Option<f64> {
        let axis = |vector: DVec3, first: u32| vector[(n - first) as usize];
        let reflection = self.reflection;
        Some(match n {
            1..=3 => axis(self.direction(self.place.dir), 1),
            4..=6 => axis(self.direction(self.place.normal), 4),
            7..=9 => axis(self.to_local.transform_point3(self.place.point), 7),
            10 | 25 => self.place.distance * self.scale,
            11 => -self.place.dir.dot(self.place.normal),
            12 => self.scale,
            13..=15 => axis(self.to_local.translation, 13),
            16..=18 => axis(self.to_local.matrix3.x_axis / self.scale, 16),
            19..=21 => axis(self.to_local.matrix3.y_axis / self.scale, 19),
            22..=24 => axis(self.to_local.matrix3.z_axis / self.scale, 22),
            26 => self.place.uv?[0],
            27 => self.place.uv?[1],
            28..=30 => axis(self.direction(reflection?.normal), 28),
            31 => reflection?.cosine,
            32..=34 => axis(reflection?.color, 32),
            35..=37 => axis(self.direction(reflection?.to_light?), 35),
            _ => return None,
        })
    }

    fn count(&self) -> usize {
        self.reals.len()
    }

    fn argument(&self, n: usize) -> Option<f64> {
        self.reals.get(n.checked_sub(1)?).copied()
    }
}
