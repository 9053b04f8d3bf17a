//! Geometry where numbers run out: slivers, stacks, coincidence, coordinates and sizes far apart, rays that are no rays.

use glam::DQuat;

use super::*;

fn triangle(corners: [DVec3; 3]) -> Shape {
    Shape::Triangle(Triangle::new(corners).unwrap())
}

fn sphere(centre: DVec3, radius: f64) -> Shape {
    Shape::Sphere(Sphere::new(centre, radius).unwrap())
}

/// Every hit along a line, each ray starting where the last one ended.
fn hits_along(aggregate: &Aggregate, origin: DVec3, dir: DVec3) -> Vec<Hit> {
    let mut ray = Ray::new(origin, dir);
    let mut hits = Vec::new();
    while let Some(hit) = aggregate.closest(&ray) {
        assert!(hit.t > 0.0 && hit.point.is_finite() && hit.normal.is_finite());
        hits.push(hit);
        ray = Ray::new(hit.point, dir).leaving(hit.surface);
        assert!(hits.len() <= 3 * aggregate.len(), "the walk does not end");
    }
    hits
}

#[test]
fn a_fan_of_slivers_has_no_gap() {
    // Needles of aspect 1e2 .. 1e12 around a common vertex, of which each neighbour is a part.
    for (count, length) in [(100, 1.0), (10_000, 1.0), (1000, 1e6), (1000, 1e-6)] {
        for lift in [0.0, 0.3] {
            let rim = |i: usize| {
                let (sin, cos) = (i as f64 * 1.5 / count as f64).sin_cos();
                DVec3::new(cos, sin, lift * (i % 7) as f64 / 7.0) * length
            };
            let fan = aggregate((0..count).map(|i| triangle([DVec3::ZERO, rim(i), rim(i + 1)])));
            for i in (1..count).step_by(count / 50 + 1) {
                // Along each seam, from its outer end to a billionth of its length from the vertex.
                for along in [0.5, 1e-3, 1e-6, 1e-9] {
                    let target = rim(i) * along;
                    // Askew, the lifted fan is folded, and a ray may touch a fold from outside.
                    let askew = if lift == 0.0 { DVec3::new(0.1, 0.2, -1.0).normalize() } else { -DVec3::Z };
                    for dir in [-DVec3::Z, askew] {
                        let origin = target - dir * (3.0 * length);
                        assert!(fan.closest(&Ray::new(origin, dir)).is_some(), "{count} {length:e} {along:e}");
                    }
                }
            }
        }
    }
}

#[test]
fn a_deep_stack_is_crossed_pane_by_pane() {
    // A millimetre, a micrometre and a nanometre apart, near the origin and 100 m away from it.
    for (count, gap, place) in [(10_000, 1e-3, 0.0), (1000, 1e-6, 0.0), (1000, 1e-9, 0.0), (1000, 1e-6, 100.0)] {
        let stack =
            aggregate((0..count).map(|i| moved(&square(f64::from(i) * gap, i % 3 == 0), DVec3::X * place).unwrap()));
        for dir in [DVec3::Z, DVec3::new(1e-3, 0.0, 1.0).normalize()] {
            let hits = hits_along(&stack, DVec3::new(place + 0.1, 0.2, -1.0), dir);
            assert_eq!(hits.len(), count as usize, "{gap:e} {place}");
            assert!(hits.iter().enumerate().all(|(i, hit)| hit.surface == SurfaceId(i as u32)));
        }
    }
}

#[test]
fn coincident_surfaces_are_met_once() {
    let stack = aggregate((0..1000).map(|_| square(0.0, true)));
    for dir in [-DVec3::Z, DVec3::new(0.3, 0.2, -1.0).normalize(), DVec3::new(1.0, 0.0, -1e-3).normalize()] {
        let hits = hits_along(&stack, DVec3::new(0.1, 0.2, 0.0) - dir, dir);
        assert_eq!((hits.len(), hits[0].surface), (1, SurfaceId(999)));
    }
    // A ray within their plane meets none of them.
    for dir in [DVec3::X, DVec3::Y, DVec3::new(1.0, 1.0, 0.0).normalize()] {
        assert!(hits_along(&stack, DVec3::new(-5.0, -5.0, 0.0), dir).is_empty());
    }
    let shells = aggregate((0..100).map(|_| sphere(DVec3::ZERO, 1.0)));
    assert_eq!(hits_along(&shells, DVec3::X * 2.0, -DVec3::X).len(), 2);
}

#[test]
fn thin_shells_are_met_one_by_one() {
    for gap in [1e-2, 1e-6, 1e-9] {
        let shells = aggregate((0..5).map(|i| sphere(DVec3::ZERO, 1.0 + gap * f64::from(i))));
        for dir in [-DVec3::X, DVec3::new(-1.0, 0.5, 0.3).normalize()] {
            let order: Vec<u32> = hits_along(&shells, -dir * 3.0, dir).iter().map(|hit| hit.surface.0).collect();
            assert_eq!(order, [4, 3, 2, 1, 0, 0, 1, 2, 3, 4], "{gap:e}");
        }
    }
}

#[test]
fn rays_that_are_none_meet_nothing() {
    let mut shapes = vec![square(0.0, true), sphere(DVec3::Z, 0.5)];
    shapes.push(Shape::Cone(Cone::new([DVec3::X, DVec3::X * 2.0], [1.0, 0.0], false).unwrap()));
    shapes.push(Shape::Ring(Ring::new(DVec3::Y, DVec3::Y, [0.0, 1.0]).unwrap()));
    let all = aggregate(shapes);
    let mut crossings = Vec::new();
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for (origin, dir) in [
            (DVec3::splat(bad), DVec3::Z),
            (DVec3::new(0.0, bad, 0.0), DVec3::Z),
            (DVec3::ZERO, DVec3::new(bad, 0.0, 0.0)),
            (DVec3::ZERO, DVec3::splat(bad)),
        ] {
            let ray = Ray::new(origin, dir);
            assert!(all.closest(&ray).is_none_or(|hit| hit.t.is_finite()));
            let _ = all.occluded(&ray, |_| true);
            let _ = all.shadow(&ray, None, &mut crossings);
        }
    }
    for t_max in [0.0, -1.0, f64::NAN, f64::MIN_POSITIVE] {
        assert!(all.closest(&Ray::new(DVec3::Z * 5.0, -DVec3::Z).up_to(t_max)).is_none());
    }
    // Along an edge, out of a vertex, through an apex, along a cylinder's wall: finite or nothing.
    for (origin, dir) in [
        (DVec3::new(-1.0, -1.0, 0.0), DVec3::X),
        (DVec3::new(-1.0, -1.0, 0.0), DVec3::Z),
        (DVec3::X * 5.0, -DVec3::X),
        (DVec3::new(0.0, 0.0, 1.5), DVec3::X),
        (DVec3::new(-1.0, 1.0, 0.0), DVec3::X),
    ] {
        hits_along(&all, origin, dir);
    }
}

#[test]
fn shapes_smaller_than_a_digit_have_finite_normals() {
    // At 1e8 the last digit is 1.5e-8.
    let place = DVec3::new(1e8, -1e8, 1e8);
    let dust = aggregate([sphere(place, 1e-9), sphere(place + DVec3::X * 10.0, 1e-3), sphere(place, -1e-12)]);
    for hit in hits_along(&dust, place - DVec3::X * 10.0, DVec3::X) {
        assert!((hit.normal.length() - 1.0).abs() < 1e-9);
    }
    let (point, normal) = sphere(place, 1e-9).settle(place);
    assert!(point.is_finite() && normal.is_finite());
}

#[test]
fn a_polygon_may_have_many_vertices() {
    let n = 100_000;
    let outline = (0..n).map(|i| {
        let (sin, cos) = (std::f64::consts::TAU * f64::from(i) / f64::from(n)).sin_cos();
        DVec3::new(cos, sin, 0.0) * if i % 2 == 0 { 1.0 } else { 0.5 }
    });
    let star = aggregate([Shape::Polygon(Polygon::new(outline.collect()).unwrap())]);
    let meets = |x: f64| star.closest(&Ray::new(DVec3::new(x, 1e-7, 1.0), -DVec3::Z)).is_some();
    assert!(meets(0.0) && meets(0.499) && !meets(1.001));
}

/// Each size class of a scene of very different sizes is met exactly: a dome of 1e9, a ground of 20 km, a room, a coin, a grain.
#[test]
fn sizes_far_apart_live_together() {
    let ground = [[-1e4, -1e4], [1e4, -1e4], [1e4, 1e4], [-1e4, 1e4]];
    let mut shapes = vec![
        sphere(DVec3::ZERO, -1e9),
        Shape::Polygon(Polygon::new(ground.iter().map(|&[x, y]| DVec3::new(x, y, 0.0)).collect()).unwrap()),
    ];
    let mut numbers = Numbers(11);
    for i in 0..300 {
        let size = [3.0, 1e-2, 1e-4, 1e-6][i % 4];
        let at = DVec3::new(numbers.within(-5.0, 5.0), numbers.within(-5.0, 5.0), size);
        shapes.push(sphere(at, size));
    }
    let all = aggregate(shapes.clone());
    for i in 2..shapes.len() {
        let [low, high] = shapes[i].bounds();
        let target = low + (high - low) * 0.5;
        for _ in 0..10 {
            let dir = -(numbers.direction().abs() + DVec3::Z * 0.1).normalize();
            for back in [0.1, 1e3, 1e7] {
                let ray = Ray::new(target - dir * back, dir);
                let expected = brute_force(&shapes, &ray, all.radius());
                assert_eq!(all.closest(&ray).map(|hit| hit.t), expected.map(|(t, _)| t));
            }
        }
    }
    // Upwards there is only the dome.
    let hit = all.closest(&Ray::new(DVec3::new(100.0, 0.0, 1.0), DVec3::Z)).unwrap();
    assert_eq!(hit.surface, SurfaceId(0));
}

fn turned(shape: &Shape, turn: DQuat, scale: f64, by: DVec3) -> Shape {
    let map = |p: DVec3| turn * p * scale + by;
    match shape {
        Shape::Triangle(t) => triangle(t.corners().map(map)),
        Shape::Polygon(p) => Shape::Polygon(Polygon::new(p.vertices().iter().copied().map(map).collect()).unwrap()),
        Shape::Sphere(s) => sphere(map(s.centre()), scale * if s.is_bubble() { -s.radius() } else { s.radius() }),
        Shape::Ring(r) => {
            let radii = r.radii().map(|radius| radius * scale);
            Shape::Ring(Ring::new(map(r.centre()), turn * r.normal(), radii).unwrap())
        }
        Shape::Placed(_) => panic!("placed shapes are tested by themselves"),
        Shape::Cone(c) => {
            let (base, axis) = c.axis();
            let ends = [map(base), map(base + axis * c.length())];
            Shape::Cone(Cone::new(ends, c.radii().map(|radius| radius * scale), c.is_inward()).unwrap())
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    /// Hits follow a scene through rotation, scaling by 1e-6 .. 1e8 and translation by up to 1e4 of its sizes, each of them 50 rays:
    /// 2 x 10^4 cases. What may differ is rounding: eps x coordinate, over the cosine of incidence.
    #[test]
    fn hits_are_invariant(seed in 0..100_000_u64, e in -6..9_i32, angle in 0.0..6.3_f64, shift in -1e4..1e4_f64) {
        let mut numbers = Numbers(seed);
        let shapes: Vec<Shape> = (0..30).map(|_| some_shape(&mut numbers, 1.0, 0.5)).collect();
        let (turn, scale) = (DQuat::from_axis_angle(numbers.direction(), angle), 10_f64.powi(e));
        let by = numbers.direction() * shift * scale;
        let there: Vec<Shape> = shapes.iter().map(|shape| turned(shape, turn, scale, by)).collect();
        let (here, there) = (aggregate(shapes), aggregate(there));
        for _ in 0..50 {
            let (origin, dir) = (numbers.point(2.0), numbers.direction());
            let a = here.closest(&Ray::new(origin, dir));
            let b = there.closest(&Ray::new(turn * origin * scale + by, turn * dir));
            let rounding = 1e-14 * (shift.abs() + 10.0);
            // Rays that pass an edge by less than the rounding may fall on either side of it: one in 10^7 or fewer.
            if let (Some(a), Some(b)) = (a, b) {
                prop_assert_eq!(a.surface, b.surface);
                let incidence = a.normal.dot(dir).abs();
                prop_assert!((a.t - b.t / scale).abs() * incidence <= rounding, "{} {} {incidence}", a.t, b.t / scale);
                prop_assert!((turn * a.normal - b.normal).length() * incidence <= 1e3 * rounding);
            } else {
                prop_assert_eq!(a.is_some(), b.is_some());
            }
        }
    }
}
