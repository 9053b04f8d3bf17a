use glam::DVec3;
use proptest::prelude::*;

use super::shape::{Cone, Polygon, Probe, Ring, Sphere, Triangle};
use super::*;
use crate::math::tolerance;

mod extremes;
mod levels;

fn item(shape: Shape, index: usize) -> Item {
    Item { shape, surface: SurfaceId(index as u32), passage: Passage::Opaque, precedence: 0 }
}

fn aggregate(shapes: impl IntoIterator<Item = Shape>) -> Aggregate {
    Aggregate::new(shapes.into_iter().enumerate().map(|(index, shape)| item(shape, index)))
}

/// An icosahedron whose triangles were divided `levels` times, pushed out to a sphere of radius 1.
fn icosphere(levels: u32) -> Vec<[DVec3; 3]> {
    let golden = 0.5 * (1.0 + 5.0_f64.sqrt());
    let vertices: Vec<DVec3> = (0..3)
        .flat_map(|turn| {
            [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]].map(|[a, b]| {
                let mut p = [0.0; 3];
                (p[turn], p[(turn + 1) % 3]) = (a, b * golden);
                DVec3::from(p).normalize()
            })
        })
        .collect();
    let edge = 2.0 / (1.0 + golden * golden).sqrt();
    let near = |a: DVec3, b: DVec3| ((a - b).length() - edge).abs() < 1e-9;
    let mut triangles = Vec::new();
    for (i, &a) in vertices.iter().enumerate() {
        for (j, &b) in vertices.iter().enumerate().skip(i + 1) {
            for &c in &vertices[j + 1..] {
                if near(a, b) && near(b, c) && near(c, a) {
                    let outward = (b - a).cross(c - a).dot(a) > 0.0;
                    triangles.push(if outward { [a, b, c] } else { [a, c, b] });
                }
            }
        }
    }
    assert_eq!(triangles.len(), 20);
    for _ in 0..levels {
        triangles = triangles
            .into_iter()
            .flat_map(|[a, b, c]| {
                let [ab, bc, ca] = [a + b, b + c, c + a].map(DVec3::normalize);
                [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
            })
            .collect();
    }
    triangles
}

/// A fixed sequence of numbers in [0,1): SplitMix64 (Steele et al., 2014).
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }

    fn point(&mut self, reach: f64) -> DVec3 {
        DVec3::from_array([(); 3].map(|()| self.within(-reach, reach)))
    }

    fn direction(&mut self) -> DVec3 {
        loop {
            let p = self.point(1.0);
            if (0.01..=1.0).contains(&p.length()) {
                return p.normalize();
            }
        }
    }
}

/// No ray from inside a closed mesh escapes, wherever it is aimed and whatever the unit and place of the mesh.
#[test]
fn a_closed_mesh_lets_no_ray_out() {
    let mesh = icosphere(3);
    for (scale, centre) in [
        (1.0, DVec3::ZERO),
        (1e-6, DVec3::ZERO),
        (1e-6, DVec3::new(3e-6, -1e-5, 2e-6)),
        (1e8, DVec3::new(-2e8, 1e7, 5e8)),
        (1.0, DVec3::new(1e5, -1e5, 5e4)),
        (1e-3, DVec3::new(1e3, 1e3, -1e3)),
    ] {
        let moved: Vec<[DVec3; 3]> = mesh.iter().map(|t| t.map(|p| p * scale + centre)).collect();
        let aggregate = aggregate(moved.iter().map(|&t| Shape::Triangle(Triangle::new(t).unwrap())));
        let mut numbers = Numbers(1);
        let off_centre = centre + numbers.point(0.5) * scale;
        for origin in [centre, off_centre] {
            let aim = |target: DVec3| {
                let dir = (target - origin).normalize();
                assert!(
                    aggregate.closest(&Ray::new(origin, dir)).is_some(),
                    "{scale:e} {centre}: lost towards {target}"
                );
                assert!(aggregate.occluded(&Ray::new(origin, dir), |_| true));
            };
            for &[a, b, c] in &moved {
                for (p, q) in [(a, b), (b, c), (c, a)] {
                    aim(p);
                    aim((p + q) * 0.5);
                    aim(p + (q - p) * numbers.next());
                }
                aim((a + b + c) / 3.0);
            }
            for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
                aim(origin + axis * scale);
                aim(origin - axis * scale);
            }
        }
    }
}

/// Axis-parallel rays on the lattice of a flat grid, through every vertex and edge of it.
#[test]
fn a_grid_lets_no_axis_parallel_ray_through() {
    let n = 32;
    let at = |i: usize, j: usize| DVec3::new(i as f64 / n as f64, j as f64 / n as f64, 0.0);
    for turn in [|p: DVec3| p, |p: DVec3| DVec3::new(p.z, p.x, p.y), |p: DVec3| DVec3::new(p.y, p.z, p.x)] {
        let mut shapes = Vec::new();
        for i in 0..n {
            for j in 0..n {
                let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)].map(turn);
                if (i + j) % 2 == 0 {
                    shapes.push(Shape::Triangle(Triangle::new([a, b, c]).unwrap()));
                    shapes.push(Shape::Triangle(Triangle::new([a, c, d]).unwrap()));
                } else {
                    shapes.push(Shape::Polygon(Polygon::new(vec![a, b, c, d]).unwrap()));
                }
            }
        }
        let aggregate = aggregate(shapes);
        for i in 1..4 * n {
            for j in 1..4 * n {
                let target = turn(DVec3::new(i as f64, j as f64, 0.0) / (4 * n) as f64);
                for dir in [turn(DVec3::Z), -turn(DVec3::Z)] {
                    let hit = aggregate.closest(&Ray::new(target - dir * 3.0, dir)).expect("the grid is closed there");
                    assert_eq!((hit.t, hit.point), (3.0, target));
                }
            }
        }
    }
}

fn some_shape(numbers: &mut Numbers, reach: f64, size: f64) -> Shape {
    loop {
        let centre = numbers.point(reach);
        let (a, b) = (numbers.within(0.05, 1.0) * size, numbers.within(0.0, 1.0) * size);
        let end = centre + numbers.direction() * a;
        let shape = match (numbers.next() * 7.0) as u32 {
            0 => Sphere::new(centre, if b > a { -a } else { a }).map(Shape::Sphere),
            1 => Ring::new(centre, numbers.direction(), [a, b]).map(Shape::Ring),
            2 => Cone::new([centre, end], [a, b], b > a).map(Shape::Cone),
            3 => Cone::new([centre, end], [b; 2], b > a).map(Shape::Cone),
            4 | 5 => {
                Triangle::new([centre, centre + numbers.point(size), centre + numbers.point(size)]).map(Shape::Triangle)
            }
            _ => {
                let (u, v) = (numbers.direction() * a, numbers.direction() * b);
                let outline = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]];
                Polygon::new(outline.iter().map(|&[x, y]| centre + u * x + v * y).collect()).map(Shape::Polygon)
            }
        };
        if let Ok(shape) = shape {
            return shape;
        }
    }
}

/// Nearest of all shapes, each tested.
fn brute_force(shapes: &[Shape], ray: &Ray, radius: f64) -> Option<(f64, usize)> {
    let t_min = tolerance::least_distance(ray.origin, radius);
    let probe = Probe::new(ray.origin, ray.dir);
    let leaving = |index: usize| ray.leaving == Some(SurfaceId(index as u32));
    shapes
        .iter()
        .enumerate()
        .filter_map(|(index, shape)| Some((shape.meet(&probe, leaving(index), t_min, ray.t_max)?, index)))
        .min_by(|a, b| a.0.total_cmp(&b.0))
}

#[test]
fn the_answer_is_the_one_of_testing_every_shape() {
    // (extent of the scene, size of the shapes, place)
    for (reach, size, place) in [
        (1.0, 0.2, DVec3::ZERO),
        (1e-6, 1e-7, DVec3::ZERO),
        (1e8, 1e7, DVec3::ZERO),
        (1e4, 1.0, DVec3::new(1e5, -1e5, 0.0)),
        (10.0, 1e-3, DVec3::new(0.0, 0.0, 1e6)),
        (0.1, 1e-3, DVec3::new(2e3, 0.0, 0.0)),
    ] {
        let mut numbers = Numbers(7);
        let mut shapes: Vec<Shape> = (0..500).map(|_| some_shape(&mut numbers, reach, size)).collect();
        // Small things on a ground 100 000 times their field, under a dome.
        let ground = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
        shapes.push(Shape::Polygon(
            Polygon::new(ground.iter().map(|&[x, y]| DVec3::new(x, y, -1e-3) * reach * 1e5).collect()).unwrap(),
        ));
        shapes.push(Shape::Sphere(Sphere::new(DVec3::ZERO, -reach * 1e7).unwrap()));
        let moved: Vec<Shape> = shapes.into_iter().map(|shape| moved(&shape, place).unwrap()).collect();
        let aggregate = aggregate(moved.clone());
        let (mut found, mut leaving) = (0, None);
        for i in 0..8000 {
            let far = if i % 4 == 0 { 1e3 } else { 2.0 };
            let origin = place + numbers.point(reach * far);
            // Half of the rays aim at a shape.
            let dir = if i % 2 == 0 {
                numbers.direction()
            } else {
                let [low, high] = moved[(numbers.next() * 502.0) as usize].bounds();
                (low + (high - low) * numbers.next() - origin).normalize()
            };
            let mut ray = Ray::new(origin, dir);
            // Every fourth ray starts on the surface that the last hit found.
            if let Some(Hit { point, surface, .. }) = leaving.filter(|_| i % 4 == 3) {
                ray = Ray::new(point, dir).leaving(surface);
            }
            let expected = brute_force(&moved, &ray, aggregate.radius());
            let hit = aggregate.closest(&ray);
            assert_eq!(hit.map(|hit| hit.t), expected.map(|(t, _)| t), "{ray:?}");
            if let Some(hit) = hit {
                found += 1;
                leaving = Some(hit);
                assert!(aggregate.occluded(&ray, |_| true));
                assert!(!aggregate.occluded(&ray.up_to(hit.t), |_| true));
                assert!(aggregate.occluded(&ray, |surface| surface == hit.surface));
            } else {
                assert!(!aggregate.occluded(&ray, |_| true));
            }
        }
        assert!(found > 3000, "{found} of 8000 rays meet something");
    }
}

/// A shape elsewhere; `None` where rounding leaves nothing of it.
fn moved(shape: &Shape, by: DVec3) -> Option<Shape> {
    Some(match shape {
        Shape::Triangle(t) => Shape::Triangle(Triangle::new(t.corners().map(|p| p + by)).ok()?),
        Shape::Polygon(p) => Shape::Polygon(Polygon::new(p.vertices().iter().map(|&v| v + by).collect()).ok()?),
        Shape::Sphere(s) => {
            let radius = if s.is_bubble() { -s.radius() } else { s.radius() };
            Shape::Sphere(Sphere::new(s.centre() + by, radius).ok()?)
        }
        Shape::Ring(r) => Shape::Ring(Ring::new(r.centre() + by, r.normal(), r.radii()).ok()?),
        Shape::Placed(_) => panic!("placed shapes are tested by themselves"),
        Shape::Cone(c) => {
            let (base, axis) = c.axis();
            let ends = [base + by, base + axis * c.length() + by];
            Shape::Cone(Cone::new(ends, c.radii(), c.is_inward()).ok()?)
        }
    })
}

fn square(z: f64, facing_up: bool) -> Shape {
    let mut corners: Vec<DVec3> =
        [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].iter().map(|&[x, y]| DVec3::new(x, y, z)).collect();
    if !facing_up {
        corners.reverse();
    }
    Shape::Polygon(Polygon::new(corners).unwrap())
}

/// Of coincident surfaces: opaque before transparent, front before back, later modifier before earlier, whatever the order.
#[test]
fn coincident_surfaces_have_an_order() {
    let ray = Ray::new(DVec3::new(0.3, 0.1, 5.0), -DVec3::Z);
    let make = |up: bool, passage, precedence, z: f64| (square(z, up), passage, precedence);
    let off = 3e-12;
    for (winner, loser) in [
        (make(false, Passage::Opaque, 0, 0.0), make(true, Passage::Straight, 9, off)),
        (make(true, Passage::Opaque, 0, -off), make(false, Passage::Opaque, 9, 0.0)),
        (make(true, Passage::Opaque, 2, -off), make(true, Passage::Opaque, 1, off)),
        (make(true, Passage::Straight, 2, 0.0), make(true, Passage::Refracting, 1, 0.0)),
    ] {
        for order in [[&winner, &loser], [&loser, &winner]] {
            let items = order.iter().enumerate().map(|(index, (shape, passage, precedence))| Item {
                shape: shape.clone(),
                surface: SurfaceId(index as u32),
                passage: *passage,
                precedence: *precedence,
            });
            let hit = Aggregate::new(items).closest(&ray).unwrap();
            assert!(std::ptr::eq(order[hit.surface.index()], &winner));
        }
    }
    // A thousandth of a millimetre apart they are two surfaces.
    let hit = aggregate([square(0.0, true), square(1e-6, false)]).closest(&ray).unwrap();
    assert_eq!(hit.surface, SurfaceId(1));
}

#[test]
fn shadow_rays_list_what_they_cross() {
    let pane = |z: f64, index: usize| Item { passage: Passage::Straight, ..item(square(z, true), index) };
    let wall = |z: f64, index: usize| item(square(z, true), index);
    let lens = |z: f64, index: usize| Item { passage: Passage::Refracting, ..item(square(z, true), index) };
    let lamp = SurfaceId(0);
    let ray = Ray::new(DVec3::new(0.1, 0.2, -1.0), DVec3::Z).up_to(11.0);
    let mut crossings = Vec::new();
    let mut shadow = |items: Vec<Item>| {
        let answer = Aggregate::new(items).shadow(&ray, Some(lamp), &mut crossings);
        (answer, crossings.iter().map(|hit| hit.surface.0).collect::<Vec<_>>())
    };
    assert_eq!(shadow(vec![wall(10.0, 0)]), (Shadow::Clear, vec![]));
    // Beyond the lamp nothing matters; panes come in order, coincident ones once.
    let panes = vec![wall(10.0, 0), pane(5.0, 1), pane(2.0, 2), wall(12.0, 3), pane(5.0, 4), pane(11.0, 5)];
    assert_eq!(shadow(panes), (Shadow::Clear, vec![2, 4]));
    assert_eq!(shadow(vec![wall(10.0, 0), pane(2.0, 1), wall(3.0, 2)]), (Shadow::Blocked, vec![]));
    // What bends the ray decides only if nothing opaque comes first.
    assert_eq!(shadow(vec![wall(10.0, 0), lens(2.0, 1), wall(3.0, 2)]).0, Shadow::Refracted);
    assert_eq!(shadow(vec![wall(10.0, 0), lens(4.0, 1), wall(3.0, 2)]).0, Shadow::Blocked);
    assert_eq!(shadow(vec![wall(10.0, 0), lens(4.0, 1), pane(3.0, 2)]).0, Shadow::Refracted);
    let ball = Item { passage: Passage::Straight, ..item(Shape::Sphere(Sphere::new(DVec3::Z * 4.0, 1.0).unwrap()), 1) };
    assert_eq!(shadow(vec![wall(10.0, 0), ball]), (Shadow::Clear, vec![1, 1]));
}

#[test]
fn an_empty_aggregate_meets_nothing() {
    let empty = Aggregate::new([]);
    assert!(empty.is_empty() && empty.closest(&Ray::new(DVec3::ZERO, DVec3::X)).is_none());
    assert!(!empty.occluded(&Ray::new(DVec3::ZERO, DVec3::X), |_| true));
    assert_eq!(empty.shadow(&Ray::new(DVec3::ZERO, DVec3::X), None, &mut Vec::new()), Shadow::Clear);
}

proptest! {
    /// Hits follow the scene through a shift of the origin and a change of unit.
    #[test]
    fn hits_follow_the_scene(seed in 0..1000_u64, e in -6..9_i32) {
        let scale = 10_f64.powi(e);
        let shapes = |scale: f64| {
            let mut numbers = Numbers(seed);
            let shapes: Vec<Shape> = (0..40).map(|_| some_shape(&mut numbers, scale, 0.5 * scale)).collect();
            (aggregate(shapes), numbers)
        };
        let (small, mut numbers) = shapes(1.0);
        let (large, _) = shapes(scale);
        for _ in 0..50 {
            let (origin, dir) = (numbers.point(2.0), numbers.direction());
            let (a, b) = (small.closest(&Ray::new(origin, dir)), large.closest(&Ray::new(origin * scale, dir)));
            if let (Some(a), Some(b)) = (a, b) {
                prop_assert!((a.t * scale - b.t).abs() <= 1e-9 * b.t.max(scale) || a.surface != b.surface);
            }
            prop_assert_eq!(a.map(|hit| hit.surface), b.map(|hit| hit.surface));
        }
    }
}

/// A group that is placed is met where its shapes would be if each were moved alone, and keeps their numbers.
#[test]
fn placed_shapes_are_met_as_if_each_were_moved() {
    use super::shape::Placed;
    use crate::math::Similarity;
    use glam::DAffine3;

    let mut numbers = Numbers(11);
    let shapes: Vec<Shape> = (0..60).map(|_| some_shape(&mut numbers, 1.0, 0.3)).collect();
    let bounds = shapes
        .iter()
        .map(Shape::bounds)
        .fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |[low, high], [a, b]| [low.min(a), high.max(b)]);
    let group = std::sync::Arc::new(aggregate(shapes.clone()));
    let place = DVec3::new(5.0, -3.0, 100.0);
    let to_scene = Similarity { affine: DAffine3::from_translation(place), scale: 1.0 };
    let turned = Similarity {
        affine: to_scene.affine * DAffine3::from_scale(DVec3::splat(0.01)) * DAffine3::from_rotation_x(2.0),
        scale: 0.01,
    };
    let by_moving = aggregate(shapes.iter().map(|shape| moved(shape, place).unwrap()).collect::<Vec<_>>());
    let by_placing = aggregate(vec![Shape::Placed(Placed::new(group.clone(), to_scene, 1000, bounds))]);
    let by_turning = aggregate(vec![Shape::Placed(Placed::new(group, turned, 0, bounds))]);
    let mut met = 0;
    for _ in 0..2000 {
        let (from, dir) = (numbers.point(2.0), numbers.direction());
        let ray = Ray::new(place + from, dir);
        let (expected, found) = (by_moving.closest(&ray), by_placing.closest(&ray));
        assert_eq!(expected.is_some(), found.is_some());
        let back = Ray::new(turned.point(from), turned.direction(dir));
        let small = by_turning.closest(&back);
        assert_eq!(expected.is_some(), small.is_some());
        if let (Some(expected), Some(found), Some(small)) = (expected, found, small) {
            met += 1;
            assert_eq!(found.surface.0, 1000 + expected.surface.0);
            assert_eq!(small.surface, expected.surface);
            assert!((found.t - expected.t).abs() < 1e-9 && (small.t * 100.0 - expected.t).abs() < 1e-9);
            assert!(found.normal.abs_diff_eq(expected.normal, 1e-9));
            assert!(small.normal.abs_diff_eq(turned.direction(expected.normal), 1e-9));
        }
    }
    assert!(met > 100, "{met}");
}
