//! Irradiance from lights against closed forms (Howell, A Catalog of Radiation Heat Transfer Configuration Factors; Siegel and
//! Howell, Thermal Radiation Heat Transfer). Each estimate may be off by 5 of its standard errors: with other seeds one in 1.7 million
//! checks would fail by chance.

use std::f64::consts::PI;

use glam::DVec3;

use super::*;
use crate::geometry::Ray;
use crate::geometry::shape::{Cone, Polygon, Ring, Sphere, Triangle};
use crate::material::{Alternate, Mirror};
use crate::pattern::Memory;
use crate::scene::{FarId, Scene, Surface};

const SAMPLES: u32 = 100_000;

/// A fixed sequence of numbers in [0,1): SplitMix64 (Steele et al., 2014).
fn numbers(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// Mean of what samples give, and its standard error.
fn mean(light: &Light, from: DVec3, weigh: impl Fn(&LightSample) -> f64) -> (f64, f64) {
    let mut number = numbers(5);
    let (mut sum, mut squares) = (0.0, 0.0);
    for _ in 0..SAMPLES {
        let value = light.sample(from, [number(), number()]).map_or(0.0, |sample| weigh(&sample));
        sum += value;
        squares += value * value;
    }
    let n = f64::from(SAMPLES);
    let mean = sum / n;
    (mean, ((squares / n - mean * mean) / n).max(0.0).sqrt())
}

/// Irradiance of radiance 1 on a surface of normal `normal`, over pi: the configuration factor.
fn factor(light: &Light, from: DVec3, normal: DVec3) -> (f64, f64) {
    let (mean, error) = mean(light, from, |sample| sample.dir.dot(normal).max(0.0) * sample.solid_angle);
    (mean / PI, error / PI)
}

fn check(what: &str, (mean, error): (f64, f64), exact: f64) {
    assert!((mean - exact).abs() <= 5.0 * error + 1e-12 * exact.abs(), "{what}: {mean} +- {error}, expected {exact}");
    assert!(error <= 0.02 * exact.abs(), "{what}: {mean} +- {error} says too little");
}

fn lamp() -> Emitter {
    Emitter::light(&[1.0; 3]).unwrap()
}

fn light(shape: Shape) -> Light {
    Light::of_surface(SurfaceId(0), &shape, lamp())
}

fn flat(outline: &[[f64; 2]], height: f64) -> Shape {
    // Clockwise as seen from above: it shines down.
    let vertices: Vec<DVec3> = outline.iter().rev().map(|&[x, y]| DVec3::new(x, y, height)).collect();
    match <[DVec3; 3]>::try_from(vertices) {
        Ok(corners) => Shape::Triangle(Triangle::new(corners).unwrap()),
        Err(vertices) => Shape::Polygon(Polygon::new(vertices).unwrap()),
    }
}

/// Factor from an element to a parallel rectangle `a` x `b` with a corner at the height `h` above it.
fn corner_factor(a: f64, b: f64, h: f64) -> f64 {
    let (x, y) = (a / h, b / h);
    let part = |x: f64, y: f64| x / x.hypot(1.0) * (y / x.hypot(1.0)).atan();
    (part(x, y) + part(y, x)) / (2.0 * PI)
}

#[test]
fn rectangles_and_polygons_light_as_their_factor_says() {
    let square = light(flat(&[[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]], 1.5));
    check("rectangle", factor(&square, DVec3::ZERO, DVec3::Z), corner_factor(2.0, 1.0, 1.5));
    // Far coordinates and tiny units change nothing.
    for (scale, place) in [(1e-6, DVec3::ZERO), (1e7, DVec3::ZERO), (1.0, DVec3::new(1e5, -1e5, 5e4))] {
        let vertices =
            [[0.0, 0.0], [0.0, 1.0], [2.0, 1.0], [2.0, 0.0]].map(|[x, y]| DVec3::new(x, y, 1.5) * scale + place);
        let moved = light(Shape::Polygon(Polygon::new(vertices.to_vec()).unwrap()));
        let (mean, error) = factor(&moved, place, DVec3::Z);
        assert!((mean - corner_factor(2.0, 1.0, 1.5)).abs() < 5.0 * error);
    }
    // An L of three unit squares around the corner above the element; five or more vertices are not approximated.
    let ell = light(flat(&[[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]], 1.0));
    let whole = corner_factor(2.0, 2.0, 1.0);
    let notch = whole - 2.0 * corner_factor(1.0, 2.0, 1.0) + corner_factor(1.0, 1.0, 1.0);
    check("concave polygon", factor(&ell, DVec3::ZERO, DVec3::Z), whole - notch);
    // A square of side 4 with a hole of side 2 by a seam, seen from under its middle.
    let holed = light(flat(
        &[
            [-2.0, -2.0],
            [2.0, -2.0],
            [2.0, 2.0],
            [-2.0, 2.0],
            [-2.0, -2.0],
            [-1.0, -1.0],
            [-1.0, 1.0],
            [1.0, 1.0],
            [1.0, -1.0],
            [-1.0, -1.0],
        ],
        1.0,
    ));
    let exact = 4.0 * (corner_factor(2.0, 2.0, 1.0) - corner_factor(1.0, 1.0, 1.0));
    check("polygon with a hole", factor(&holed, DVec3::ZERO, DVec3::Z), exact);
    // Two triangles make the square.
    let halves = [[[0.0, 0.0], [2.0, 0.0], [2.0, 2.0]], [[0.0, 0.0], [2.0, 2.0], [0.0, 2.0]]];
    for half in halves {
        let exact = corner_factor(2.0, 2.0, 0.7) / 2.0;
        check("triangle", factor(&light(flat(&half, 0.7)), DVec3::ZERO, DVec3::Z), exact);
    }
    // It shines from its front only.
    assert_eq!(factor(&square, DVec3::Z * 3.0, -DVec3::Z).0, 0.0);
}

#[test]
fn discs_spheres_and_far_sources_light_as_their_factor_says() {
    let ring = |radii| light(Shape::Ring(Ring::new(DVec3::Z * 2.0, -DVec3::Z, radii).unwrap()));
    let disc = |r: f64| r * r / (r * r + 4.0);
    check("disc", factor(&ring([0.0, 1.5]), DVec3::ZERO, DVec3::Z), disc(1.5));
    check("annulus", factor(&ring([1.0, 1.5]), DVec3::ZERO, DVec3::Z), disc(1.5) - disc(1.0));

    let towards = DVec3::new(1.0, 2.0, 2.0) / 3.0;
    for (radius, distance) in [(1.0, 1.5), (1e-3, 1.0), (1e-9, 1.0), (1e5, 1e7)] {
        let ball = light(Shape::Sphere(Sphere::new(towards * distance, radius).unwrap()));
        let sine = radius / distance;
        check("sphere ahead", factor(&ball, DVec3::ZERO, towards), sine * sine);
        // Tilted, but wholly above the horizon.
        if sine < 0.5 {
            check("sphere aside", factor(&ball, DVec3::ZERO, DVec3::Z), sine * sine * towards.z);
        }
    }
    // From a hair above the surface it fills the hemisphere.
    let ball = light(Shape::Sphere(Sphere::new(DVec3::ZERO, 1.0).unwrap()));
    check("sphere touched", factor(&ball, DVec3::Z * (1.0 + 1e-12), -DVec3::Z), 1.0);
    assert!(ball.sample(DVec3::Z * 0.5, [0.3, 0.3]).is_none());
    let bubble = light(Shape::Sphere(Sphere::new(DVec3::ZERO, -1.0).unwrap()));
    check("inside of a bubble", factor(&bubble, DVec3::new(0.3, 0.2, 0.5), DVec3::X), 1.0);
    assert!(bubble.sample(DVec3::Z * 1.5, [0.3, 0.3]).is_none());

    for angle_deg in [180.0, 10.0, 0.533, 1e-5] {
        let half = f64::to_radians(angle_deg) / 2.0;
        let versine = 2.0 * (half / 2.0).sin().powi(2);
        let sun = Light::distant(SourceId::Far(FarId(0)), towards, versine, lamp());
        check("distant", factor(&sun, DVec3::ZERO, towards), half.sin().powi(2));
    }
}

#[test]
fn cylinders_and_cones_light_as_their_factor_says() {
    // An element whose normal meets the axis at right angles at one end of the cylinder.
    let (r, l, h) = (0.5, 2.0, 1.5);
    let cylinder = light(Shape::Cone(Cone::new([DVec3::ZERO, DVec3::Z * l], [r; 2], false).unwrap()));
    let (len, dist) = (l / r, h / r);
    let (x, y) = ((1.0 + dist).powi(2) + len * len, (1.0 - dist).powi(2) + len * len);
    let exact = (len / (dist * dist - 1.0).sqrt()).atan() / (PI * dist)
        + len / PI
            * ((x - 2.0 * dist) / (dist * (x * y).sqrt()) * (x * (dist - 1.0) / (y * (dist + 1.0))).sqrt().atan()
                - ((dist - 1.0) / (dist + 1.0)).sqrt().atan() / dist);
    check("cylinder", factor(&cylinder, DVec3::X * h, -DVec3::X), exact);
    assert!(cylinder.sample(DVec3::new(0.2, 0.0, 1.0), [0.5; 2]).is_none());

    // On the axis at one end of a tube: what the open end does not cover.
    let tube = light(Shape::Cone(Cone::new([DVec3::ZERO, DVec3::Z * l], [r; 2], true).unwrap()));
    check("tube", factor(&tube, DVec3::ZERO, DVec3::Z), 1.0 - r * r / (r * r + l * l));
    let cup = light(Shape::Cone(Cone::new([DVec3::ZERO, DVec3::Z * l], [1.0, r], true).unwrap()));
    check("cup", factor(&cup, DVec3::ZERO, DVec3::Z), 1.0 - r * r / (r * r + l * l));
    let hat = light(Shape::Cone(Cone::new([DVec3::ZERO, DVec3::Z * l], [1.0, 0.0], true).unwrap()));
    check("closed cup", factor(&hat, DVec3::ZERO, DVec3::Z), 1.0);
    // From above its tip a cone looks like its base.
    let cone = light(Shape::Cone(Cone::new([DVec3::ZERO, DVec3::Z], [2.0, 0.0], false).unwrap()));
    check("cone from above", factor(&cone, DVec3::Z * 2.0, -DVec3::Z), 4.0 / (4.0 + 4.0));
}

#[test]
fn samples_lie_on_the_light_and_see_it() {
    let shapes = [
        flat(&[[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]], 1.0),
        Shape::Ring(Ring::new(DVec3::Z * 2.0, -DVec3::Z, [0.5, 1.5]).unwrap()),
        Shape::Sphere(Sphere::new(DVec3::new(1.0, 2.0, 3.0), 0.7).unwrap()),
        Shape::Sphere(Sphere::new(DVec3::ZERO, -3.0).unwrap()),
        Shape::Cone(Cone::new([DVec3::X * 2.0, DVec3::new(2.0, 1.0, 2.0)], [0.3, 0.8], false).unwrap()),
        Shape::Cone(Cone::new([DVec3::X * 2.0, DVec3::new(2.0, 1.0, 2.0)], [0.3; 2], false).unwrap()),
    ];
    for shape in &shapes {
        let light = light(shape.clone());
        let mut number = numbers(3);
        let mut seen = 0;
        for _ in 0..1000 {
            let from = DVec3::new(number(), number(), 0.5 * number());
            let Some(sample) = light.sample(from, [number(), number()]) else { continue };
            seen += 1;
            assert!((sample.dir.length() - 1.0).abs() < 1e-12);
            let point = from + sample.dir * sample.distance;
            let (settled, normal) = shape.settle(point);
            assert!((settled - point).length() < 1e-7, "{shape:?}: {point} is not on it");
            assert!(normal.dot(sample.dir) < 1e-7);
        }
        assert!(seen > 200);
    }
}

#[test]
fn spotlights_keep_their_cone_and_glows_their_radius() {
    // A disc shines down through a cone of 90 degrees with a focal length of 2.
    let disc = Shape::Ring(Ring::new(DVec3::Z, -DVec3::Z, [0.0, 1e-3]).unwrap());
    let spot = Emitter::spotlight(&[1.0, 1.0, 1.0, 90.0, 0.0, 0.0, -2.0]).unwrap();
    let light = Light::of_surface(SurfaceId(0), &disc, spot);
    let at = |x: f64| light.sample(DVec3::X * x, [0.5, 0.5]);
    assert!(at(0.99).is_some() && at(1.01).is_none());
    let area = PI * 1e-6;
    assert!((at(0.0).unwrap().solid_angle / (area / 9.0) - 1.0).abs() < 1e-12);

    let glow = |radius| Light::of_surface(SurfaceId(0), &disc, Emitter::glow(&[1.0, 1.0, 1.0, radius]).unwrap());
    assert!(glow(1.01).sample(DVec3::ZERO, [0.5; 2]).is_some());
    assert!(glow(0.99).sample(DVec3::ZERO, [0.5; 2]).is_none());

    // A ball's counts from its middle: rtrace shows a glow of radius 1.5 at (0, 0, 1) as far as sqrt(1.5^2 - 1) = 1.118.
    let ball = Shape::Sphere(Sphere::new(DVec3::Z, 0.25).unwrap());
    let glow = Light::of_surface(SurfaceId(0), &ball, Emitter::glow(&[1.0, 1.0, 1.0, 1.5]).unwrap());
    let at = |x: f64| glow.sample(DVec3::X * x, [0.5; 2]);
    assert!(at(1.117).is_some() && at(1.119).is_none());
}

/// A scene of a lamp and mirrors, each a square of side 2 around a point, facing along a normal.
fn mirrors(lamp_at: [DVec3; 2], at: &[[DVec3; 2]]) -> Scene {
    let mut scene = Scene {
        materials: vec![
            crate::material::Material::Emitter(lamp()),
            crate::material::Material::Mirror(Mirror::from_reals(&[1.0; 3], Alternate::None).unwrap()),
        ],
        ..Scene::default()
    };
    for (index, &[point, normal]) in std::iter::once(&lamp_at).chain(at).enumerate() {
        let frame = crate::math::Frame::around(normal);
        let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
        let vertices = corners.iter().map(|&[x, y]| point + frame.u * x + frame.v * y).collect();
        let shape = Shape::Polygon(Polygon::new(vertices).unwrap());
        if index == 0 {
            scene.lights.push(Light::of_surface(SurfaceId(0), &shape, lamp()));
        }
        let name = scene.names.id("mirror");
        let material = Some(crate::material::MaterialId(u32::from(index > 0)));
        scene.surfaces.push(Surface { shape, material, name, modifier: None, precedence: 0 });
    }
    scene
}

#[test]
fn a_mirror_shows_the_light_behind_it() {
    // Lamp above the origin, shining down; a mirror stands at x = 2 and faces it.
    let mut scene = mirrors([DVec3::Z * 3.0, -DVec3::Z], &[[DVec3::new(2.0, 0.0, 1.0), -DVec3::X]]);
    scene.set_relays(1);
    assert_eq!(scene.lights.len(), 2);
    let image = &scene.lights[1];
    assert_eq!(image.relay(), [SurfaceId(1)]);
    // Its image is at x = 4. Seen from the plane at z = 0, at x = 0.5, every way leads through the mirror.
    let twin = light(flat(&[[3.0, -1.0], [5.0, -1.0], [5.0, 1.0], [3.0, 1.0]], 3.0));
    let from = DVec3::new(0.5, 0.0, 0.0);
    let mut legs = Vec::new();
    let mut number = numbers(1);
    let mut through = 0;
    for _ in 0..1000 {
        let sample = image.sample(from, [number(), number()]).unwrap();
        if image.legs(&scene, Ray::new(from, DVec3::X), &sample, &mut Memory::default(), &mut legs).is_none() {
            continue;
        }
        through += 1;
        let [to_mirror, to_lamp] = legs[..] else { panic!("two legs") };
        let met = to_mirror.ray.at(to_mirror.ray.t_max);
        assert!((met.x - 2.0).abs() < 1e-12 && to_mirror.left == Rgb::ONE && to_mirror.target == Some(SurfaceId(1)));
        assert!((to_mirror.ray.t_max + to_lamp.ray.t_max - sample.distance).abs() < 1e-12);
        let end = to_lamp.ray.at(to_lamp.ray.t_max);
        assert!((end.z - 3.0).abs() < 1e-12 && end.x.abs() <= 1.0 && end.y.abs() <= 1.0);
        assert_eq!((to_lamp.target, to_lamp.left), (Some(SurfaceId(0)), Rgb::ONE));
    }
    assert!(through > 900, "{through}");
    let exact = factor(&twin, from, DVec3::Z).0;
    let (mean, error) = factor(image, from, DVec3::Z);
    assert!((mean - exact).abs() < 7.1 * error, "both are estimates");
    // Behind the mirror there is no image, nor where the mirror's edge is passed.
    assert!(image.sample(DVec3::new(2.5, 0.0, 0.0), [0.5; 2]).is_none());
    let below = DVec3::new(0.5, 0.0, -50.0);
    let sample = image.sample(below, [0.5; 2]).unwrap();
    assert!(image.legs(&scene, Ray::new(below, DVec3::X), &sample, &mut Memory::default(), &mut legs).is_none());
    // -dr 0.
    scene.set_relays(0);
    assert_eq!(scene.lights.len(), 1);
}

#[test]
fn impossible_images_are_left_out() {
    let lamp_at = [DVec3::Z * 3.0, -DVec3::Z];
    let count = |at: &[[DVec3; 2]], levels| {
        let mut scene = mirrors(lamp_at, at);
        scene.set_relays(levels);
        scene.lights.len() - 1
    };
    // A mirror that faces away, one behind the lamp, one level with it.
    assert_eq!(count(&[[DVec3::X * 2.0, DVec3::X]], 1), 0);
    assert_eq!(count(&[[DVec3::Z * 5.0, -DVec3::Z]], 1), 0);
    assert_eq!(count(&[[DVec3::Z * 3.0 + DVec3::X * 4.0, -DVec3::Z]], 1), 0);
    // Two mirrors that face each other relay n images at each level n, from either side.
    let facing = [[DVec3::X * 2.0, -DVec3::X], [DVec3::X * -2.0, DVec3::X]];
    assert_eq!([1, 2, 3].map(|levels| count(&facing, levels)), [2, 4, 6]);
    // Side by side they do not see each other.
    let beside = [[DVec3::new(2.0, 1.5, 0.0), -DVec3::X], [DVec3::new(2.0, -1.5, 0.0), -DVec3::X]];
    assert_eq!(count(&beside, 3), 2);
}

#[test]
fn two_mirrors_fold_the_way_twice() {
    // A corner of two mirrors, at x = 2 and y = 2: over both, the image is the lamp turned about the corner.
    let at = [[DVec3::new(2.0, 1.0, 1.0), -DVec3::X], [DVec3::new(1.0, 2.0, 1.0), -DVec3::Y]];
    let mut scene = mirrors([DVec3::Z * 2.0, -DVec3::Z], &at);
    scene.set_relays(2);
    let twice: Vec<&Light> = scene.lights.iter().filter(|light| light.relay().len() == 2).collect();
    assert_eq!(twice.len(), 2);
    let from = DVec3::new(0.9, 1.1, 0.1);
    let mut legs = Vec::new();
    let mut passed = 0;
    for light in twice {
        let mut number = numbers(2);
        for _ in 0..2000 {
            let sample = light.sample(from, [number(), number()]).unwrap();
            let image = from + sample.dir * sample.distance;
            let source = DVec3::new(4.0 - image.x, 4.0 - image.y, image.z);
            assert!((source.z - 2.0).abs() < 1e-12 && source.x.abs() < 1.0 + 1e-9 && source.y.abs() < 1.0 + 1e-9);
            if light.legs(&scene, Ray::new(from, DVec3::X), &sample, &mut Memory::default(), &mut legs).is_some() {
                passed += 1;
                let last = legs[2].ray;
                assert!((last.at(last.t_max) - source).length() < 1e-12);
            }
        }
    }
    assert!(passed > 100, "{passed}");
}
