//! Maps from the unit square to directions and points, each with its density.
//!
//! All take u in [0,1)^2 and are area preserving, so uniform u gives the density that is stated.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI, TAU};

use glam::{DVec2, DVec3};

/// A point of the unit disc, density 1/pi per area. Concentric map (Shirley and Chiu, JGT 2(3), 1997): neighbours in
/// the square stay neighbours in the disc.
#[must_use]
pub fn disc(u: [f64; 2]) -> DVec2 {
    let (x, y) = (2.0 * u[0] - 1.0, 2.0 * u[1] - 1.0);
    if x == 0.0 && y == 0.0 {
        return DVec2::ZERO;
    }
    let (radius, angle) =
        if x.abs() > y.abs() { (x, FRAC_PI_4 * (y / x)) } else { (y, FRAC_PI_2 - FRAC_PI_4 * (x / y)) };
    let (sin, cos) = angle.sin_cos();
    DVec2::new(radius * cos, radius * sin)
}

/// A direction of the hemisphere around +z, density cos/pi per solid angle (Malley's method).
#[must_use]
pub fn cosine_hemisphere(u: [f64; 2]) -> DVec3 {
    let p = disc(u);
    DVec3::new(p.x, p.y, (1.0 - p.length_squared()).max(0.0).sqrt())
}

/// Density per solid angle of [`cosine_hemisphere`] at an angle of this cosine to the axis.
#[must_use]
pub fn cosine_hemisphere_pdf(cosine: f64) -> f64 {
    cosine.max(0.0) / PI
}

/// A direction in the cone around +z whose half angle has `1 - cos` = `versine` (in (0,2]); uniform, density
/// [`cone_pdf`]. Taking 1 - cos instead of the cosine keeps cones of 1e-8 radians exact.
#[must_use]
pub fn cone(u: [f64; 2], versine: f64) -> DVec3 {
    let drop = u[0] * versine;
    let radius = (drop * (2.0 - drop)).max(0.0).sqrt();
    let (sin, cos) = (TAU * u[1]).sin_cos();
    DVec3::new(radius * cos, radius * sin, 1.0 - drop)
}

/// Density per solid angle of [`cone`]: one over its solid angle 2 pi (1 - cos).
#[must_use]
pub fn cone_pdf(versine: f64) -> f64 {
    1.0 / (TAU * versine)
}

/// A direction of the whole sphere, density 1/(4 pi).
#[must_use]
pub fn sphere(u: [f64; 2]) -> DVec3 {
    cone(u, 2.0)
}

/// Barycentric weights of a point of a triangle (of its second and third corner), uniform over the area
/// (square-root map; Turk, Graphics Gems, 1990).
#[must_use]
pub fn triangle(u: [f64; 2]) -> [f64; 2] {
    let root = u[0].sqrt();
    [root * (1.0 - u[1]), root * u[1]]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Midpoints of an n x n grid over the unit square.
    fn grid(n: usize) -> impl Iterator<Item = [f64; 2]> {
        (0..n * n).map(move |i| [((i / n) as f64 + 0.5) / n as f64, ((i % n) as f64 + 0.5) / n as f64])
    }

    fn mean(n: usize, f: impl Fn([f64; 2]) -> f64) -> f64 {
        grid(n).map(f).sum::<f64>() / (n * n) as f64
    }

    #[test]
    fn moments_are_those_of_the_stated_densities() {
        // Disc: E x = 0, E x^2 = 1/4. Hemisphere by cosine: E z = 2/3, E z^2 = 1/2. Sphere: E z = 0, E z^2 = 1/3.
        assert!(mean(64, |u| disc(u).x).abs() < 1e-3);
        assert!((mean(64, |u| disc(u).x.powi(2)) - 0.25).abs() < 1e-3);
        assert!((mean(512, |u| cosine_hemisphere(u).z) - 2.0 / 3.0).abs() < 1e-3);
        assert!((mean(64, |u| cosine_hemisphere(u).z.powi(2)) - 0.5).abs() < 1e-3);
        assert!(mean(64, |u| sphere(u).z).abs() < 1e-3);
        assert!((mean(64, |u| sphere(u).z.powi(2)) - 1.0 / 3.0).abs() < 1e-3);
        // Triangle: the mean weights are those of the centroid.
        assert!((mean(64, |u| triangle(u)[0]) - 1.0 / 3.0).abs() < 1e-3);
        assert!((mean(64, |u| triangle(u)[1]) - 1.0 / 3.0).abs() < 1e-3);
    }

    #[test]
    fn densities_integrate_to_one() {
        // Over the sphere, by the uniform map itself.
        let hemisphere = mean(256, |u| cosine_hemisphere_pdf(sphere(u).z)) * 4.0 * PI;
        assert!((hemisphere - 1.0).abs() < 1e-3);
        for versine in [2.0, 1.0, 0.1, 1e-12] {
            assert!((cone_pdf(versine) * TAU * versine - 1.0).abs() < 1e-15);
        }
    }

    #[test]
    fn directions_are_unit_and_narrow_cones_keep_their_width() {
        for u in grid(17) {
            assert!((cosine_hemisphere(u).length() - 1.0).abs() < 1e-15);
            for versine in [2.0, 0.3, 1e-10, 1e-16] {
                let direction = cone(u, versine);
                assert!((direction.length() - 1.0).abs() < 1e-15);
                let radius = direction.truncate().length();
                let exact = (u[0] * versine * (2.0 - u[0] * versine)).sqrt();
                assert!((radius - exact).abs() <= 1e-15 * exact);
            }
        }
        assert_eq!(disc([0.5, 0.5]), DVec2::ZERO);
    }
}
