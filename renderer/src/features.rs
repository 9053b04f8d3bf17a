//! What the first hit of each pixel is: what filters, fills and importance maps look at besides light.
//!
//! Written by [`crate::transport::Tracer::first_hits`], which makes only the planes that are asked for.

use glam::Vec3;

use crate::geometry::SurfaceId;
use crate::raster::Raster;

/// Which planes to make.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Wanted {
    /// [`Features::object`].
    pub object: bool,
    /// [`Features::depth`].
    pub depth: bool,
    /// [`Features::normal`].
    pub normal: bool,
    /// [`Features::albedo`].
    pub albedo: bool,
}

impl Wanted {
    /// All planes.
    pub const ALL: Self = Self { object: true, depth: true, normal: true, albedo: true };
}

/// First hits, a plane for each thing that was asked for; row 0 is the top.
///
/// A pixel is looked at by a grid of rays; a plane holds the mean over those that met something. What is not there (an
/// illum, a surface without a material) is looked through as the picture's own rays do; glass and mirrors are what is met.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Features {
    /// The surface that most rays meet, of equals the first met; its identifier and modifier are those of
    /// `Scene::surface`. `None`: nothing is met.
    pub object: Option<Raster<Option<SurfaceId>>>,
    /// Distance from where the ray starts, in the scene's unit; infinite where nothing is met.
    pub depth: Option<Raster<f32>>,
    /// Mean of the unit normals on the side of the eye; shorter than 1 where a pixel shows several; zero where nothing is
    /// met.
    pub normal: Option<Raster<Vec3>>,
    /// Sum of the coefficients of the diffuse lobes, reflected and transmitted, in [0, 1] per channel: what the light of
    /// component D is a multiple of. Zero on emitters, glass, mirrors, and where nothing is met.
    pub albedo: Option<Raster<Vec3>>,
}
