//! Rays as geometry sees them, and where they meet a surface.

use glam::DVec3;

/// Index of a surface in `Scene::surfaces`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct SurfaceId(pub u32);

impl SurfaceId {
    /// The index.
    #[must_use]
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// A half line, or a piece of one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Where it starts.
    pub origin: DVec3,
    /// Where it goes; a unit vector.
    pub dir: DVec3,
    /// Only hits nearer than this count; may be infinite.
    pub t_max: f64,
    /// The surface that it starts from, which it therefore does not meet at distance zero
    /// (see [`crate::math::tolerance`]).
    pub leaving: Option<SurfaceId>,
}

impl Ray {
    /// An endless ray from a point in space along the unit vector `dir`.
    #[must_use]
    pub fn new(origin: DVec3, dir: DVec3) -> Self {
        Self { origin, dir, t_max: f64::INFINITY, leaving: None }
    }

    /// The same ray, starting on a surface.
    #[must_use]
    pub fn leaving(self, surface: SurfaceId) -> Self {
        Self { leaving: Some(surface), ..self }
    }

    /// The same ray, ending at distance `t_max`.
    #[must_use]
    pub fn up_to(self, t_max: f64) -> Self {
        Self { t_max, ..self }
    }

    /// The point at distance `t`.
    #[must_use]
    pub fn at(&self, t: f64) -> DVec3 {
        self.origin + self.dir * t
    }
}

/// Where a ray meets a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Distance from the ray's origin.
    pub t: f64,
    /// The point, projected onto the surface.
    pub point: DVec3,
    /// Unit normal on the surface's own front, whatever side was hit.
    pub normal: DVec3,
    /// What was hit.
    pub surface: SurfaceId,
}

impl Hit {
    /// Whether a ray of direction `dir` comes from the front.
    #[must_use]
    pub fn is_front(&self, dir: DVec3) -> bool {
        self.normal.dot(dir) < 0.0
    }
}
