//! A closed room of triangles, and rays in it: what rates of rays are measured on.

use glam::DVec3;
use renderer::geometry::shape::Triangle;
use renderer::geometry::{Aggregate, Item, Passage, Ray, Shape, SurfaceId};
use renderer::math::{Frame, warp};
use renderer::sample::{PathKey, Sampler};

/// Triangles by their corners: a bumpy floor, four walls and a ceiling, and nine bumpy balls.
pub(crate) fn triangles() -> Vec<[DVec3; 3]> {
    let mut triangles = Vec::new();
    let bump = |x: f64, y: f64| 0.05 * (7.0 * x).sin() * (5.0 * y).cos() + 0.01 * (61.0 * x).sin() * (53.0 * y).sin();
    grid(256, 256, &mut triangles, |u, v| DVec3::new(4.0 * u - 2.0, 4.0 * v - 2.0, bump(u, v)));
    let corners = [(-2.0, -2.0), (2.0, -2.0), (2.0, 2.0), (-2.0, 2.0)];
    for (i, (x, y)) in corners.into_iter().enumerate() {
        let (x2, y2) = corners[(i + 1) % 4];
        grid(2, 2, &mut triangles, |u, v| DVec3::new(x + (x2 - x) * u, y + (y2 - y) * u, 3.2 * v - 0.2));
    }
    grid(2, 2, &mut triangles, |u, v| DVec3::new(4.0 * u - 2.0, 4.0 * v - 2.0, 3.0));
    for ball in 0..9 {
        let centre = DVec3::new(f64::from(ball % 3) * 1.2 - 1.2, f64::from(ball / 3) * 1.2 - 1.2, 0.6);
        grid(128, 64, &mut triangles, |u, v| {
            let (sin, cos) = (std::f64::consts::TAU * u).sin_cos();
            let (out, up) = (std::f64::consts::PI * v).sin_cos();
            let radius = 0.4 + 0.02 * (40.0 * u).sin() * (30.0 * v).sin() * out;
            centre + DVec3::new(cos * out, sin * out, up) * radius
        });
    }
    triangles
}

fn grid(columns: u32, rows: u32, triangles: &mut Vec<[DVec3; 3]>, point: impl Fn(f64, f64) -> DVec3) {
    // Vertices as other tracers get them.
    let at =
        |i: u32, j: u32| point(f64::from(i) / f64::from(columns), f64::from(j) / f64::from(rows)).as_vec3().as_dvec3();
    for j in 0..rows {
        for i in 0..columns {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
}

pub(crate) fn aggregate(triangles: &[[DVec3; 3]]) -> Aggregate {
    let shapes = triangles.iter().filter_map(|&corners| Triangle::new(corners).ok());
    Aggregate::new(shapes.zip(0..).map(|(triangle, number)| Item {
        shape: Shape::Triangle(triangle),
        surface: SurfaceId(number),
        passage: Passage::Opaque,
        precedence: 0,
    }))
}

/// A million rays are `side` = 1000: through a pinhole; off what they hit by the cosine; and from there to points of a
/// small lamp at the ceiling, ending just before it.
pub(crate) struct Rays {
    pub(crate) primary: Vec<Ray>,
    pub(crate) diffuse: Vec<Ray>,
    pub(crate) shadow: Vec<Ray>,
}

/// Rays whose origins and directions fit `f32`, as other tracers get them.
fn rounded(origin: DVec3, dir: DVec3) -> Ray {
    Ray::new(origin.as_vec3().as_dvec3(), dir.as_vec3().as_dvec3().normalize())
}

pub(crate) fn rays(aggregate: &Aggregate, side: u32) -> Rays {
    let mut rays = Rays { primary: Vec::new(), diffuse: Vec::new(), shadow: Vec::new() };
    for pixel in 0..side * side {
        let sampler = Sampler::new(1, u64::from(pixel), PathKey::EYE, 0);
        let [dx, dy] = sampler.pair(0);
        let x = (f64::from(pixel % side) + dx) / f64::from(side) - 0.5;
        let y = (f64::from(pixel / side) + dy) / f64::from(side) - 0.5;
        let ray = rounded(DVec3::new(0.0, -1.9, 1.6), DVec3::new(1.4 * x, 1.0, -1.4 * y - 0.3).normalize());
        rays.primary.push(ray);
        let Some(hit) = aggregate.closest(&ray) else { continue };
        let normal = if hit.is_front(ray.dir) { hit.normal } else { -hit.normal };
        // Off the surface, for tracers that do not know what a ray leaves.
        let origin = hit.point + normal * 1e-4;
        rays.diffuse.push(rounded(origin, Frame::around(normal).to_world(warp::cosine_hemisphere(sampler.pair(1)))));
        let [u, v] = sampler.pair(2);
        let way = DVec3::new(0.4 * u - 0.2, 0.4 * v - 0.2, 2.99) - origin;
        rays.shadow.push(rounded(origin, way.normalize()).up_to(0.999 * way.length()));
    }
    rays
}
