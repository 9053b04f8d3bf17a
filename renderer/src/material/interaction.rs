//! A ray meeting a surface, as a material sees it.

use glam::DVec3;

/// A ray meeting a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interaction {
    /// Direction of the ray, towards the surface; a unit vector.
    pub incoming: DVec3,
    /// Unit normal on the side that the ray comes from.
    pub normal: DVec3,
    /// Cosine between the normal and the way back along the ray, in [[`Self::LEAST_COSINE`], 1].
    pub cosine: f64,
    /// Whether the ray comes from the surface's own front.
    pub front: bool,
}

impl Interaction {
    /// Radiance bounds the cosine away from zero, where Fresnel's and Ward's terms divide by it.
    pub const LEAST_COSINE: f64 = 0.001;

    /// A ray of direction `incoming` that meets a surface whose own front has the normal `front_normal`; both unit
    /// vectors.
    #[must_use]
    pub fn new(incoming: DVec3, front_normal: DVec3) -> Self {
        let cosine = -incoming.dot(front_normal);
        let front = cosine > 0.0;
        let (normal, cosine) = if front { (front_normal, cosine) } else { (-front_normal, -cosine) };
        Self { incoming, normal, cosine: cosine.clamp(Self::LEAST_COSINE, 1.0), front }
    }

    /// The same, with `bend` added to the front's normal by textures: a normal that would turn away from the ray is
    /// tilted as far to its other side, as in Radiance.
    #[must_use]
    pub fn bent(incoming: DVec3, front_normal: DVec3, bend: DVec3) -> Self {
        let front = incoming.dot(front_normal) < 0.0;
        let (normal, bend) = if front { (front_normal, bend) } else { (-front_normal, -bend) };
        let Some(mut bent) = (normal + bend).try_normalize() else { return Self::new(incoming, front_normal) };
        let mut cosine = -incoming.dot(bent);
        if cosine < 0.0 {
            bent -= incoming * (2.0 * incoming.dot(bent));
            cosine = -cosine;
        }
        Self { incoming, normal: bent, cosine: cosine.clamp(Self::LEAST_COSINE, 1.0), front }
    }

    /// The direction of ideal reflection.
    #[must_use]
    pub fn reflected(&self) -> DVec3 {
        // The unclamped cosine: the clamped one would not keep the length at grazing angles.
        (self.incoming - self.normal * (2.0 * self.incoming.dot(self.normal))).normalize()
    }
}
