//! The instructions by which a hierarchy is walked, and the blocks that spare exact tests, change no answer.

use super::super::lanes::Level;
use super::*;

fn at_level(shapes: &[Shape], level: Level) -> Aggregate {
    let items = shapes.iter().cloned().enumerate().map(|(index, shape)| Item {
        passage: [Passage::Opaque, Passage::Straight, Passage::Refracting][index % 7 % 3],
        precedence: index as u32 % 5,
        ..item(shape, index)
    });
    Aggregate::at_level(items, level)
}

/// An outline that wanders, so that it crosses itself, is concave and not quite flat.
fn tangle(numbers: &mut Numbers, size: f64) -> Option<Shape> {
    let count = 4 + (numbers.next() * 5.0) as usize;
    let (centre, u, v, n) = (numbers.point(1.0), numbers.direction(), numbers.direction(), numbers.direction());
    let warp = [0.0, 1e-9, 1e-2][(numbers.next() * 3.0) as usize];
    let mut at = || numbers.within(-size, size);
    let vertices = (0..count).map(|_| centre + u * at() + v * at() + n * (warp * at()));
    Polygon::new(vertices.collect()).map(Shape::Polygon).ok()
}

proptest! {
    /// Every answer, to the bit: by AVX2 where the processor has it (elsewhere both are the plain way), and by testing every shape.
    #[test]
    fn both_ways_answer_alike(seed in 0..1_000_000_u64, count in 1..120_usize, e in -3..1_i32, far in -1..9_i32) {
        let mut numbers = Numbers(seed);
        let (size, place) = (10_f64.powi(e), numbers.direction() * if far < 0 { 0.0 } else { 10_f64.powi(far) });
        let mut shapes: Vec<Shape> = (0..count).map(|_| some_shape(&mut numbers, 1.0, size)).collect();
        shapes.extend((0..count).filter_map(|_| tangle(&mut numbers, size)));
        let shapes: Vec<Shape> = shapes.iter().filter_map(|shape| moved(shape, place)).collect();
        let (plain, best) = (at_level(&shapes, Level::Plain), at_level(&shapes, Level::best()));
        let (mut crossings, mut others) = (Vec::new(), Vec::new());
        let mut leaving = None;
        for i in 0..40 {
            let origin = place + numbers.point([0.5, 3.0, 1e4][i % 3]);
            // At a corner, into a box, or anywhere.
            let shape = &shapes[(numbers.next() * shapes.len() as f64) as usize];
            let [low, high] = shape.bounds();
            let dir = match (i % 4, shape.vertices()) {
                (0, _) => numbers.direction(),
                (1 | 2, Some(vertices)) => (vertices[i % vertices.len()] - origin).normalize(),
                _ => (low + (high - low) * numbers.next() - origin).normalize(),
            };
            let mut ray = Ray::new(origin, dir);
            if let Some(Hit { point, surface, .. }) = leaving.filter(|_| i % 5 == 4) {
                ray = Ray::new(point, dir).leaving(surface);
            }
            let hit = plain.closest(&ray);
            prop_assert_eq!(hit, best.closest(&ray));
            let expected = brute_force(&shapes, &ray, plain.radius());
            prop_assert_eq!(hit.map(|hit| hit.t), expected.map(|(t, _)| t), "{:?}", ray);
            leaving = hit.or(leaving);
            for t_max in [f64::INFINITY, hit.map_or(1.0, |hit| hit.t * 1.5)] {
                let ray = ray.up_to(t_max);
                prop_assert_eq!(plain.shadow(&ray, None, &mut crossings), best.shadow(&ray, None, &mut others));
                prop_assert_eq!(&crossings, &others);
                prop_assert_eq!(plain.occluded(&ray, |_| true), best.occluded(&ray, |_| true));
                prop_assert_eq!(best.occluded(&ray, |_| true), hit.is_some_and(|hit| hit.t < t_max));
            }
        }
    }

    /// A mesh of 10^3 triangles, with rays at its corners and edges from inside.
    #[test]
    fn meshes_are_closed_both_ways(seed in 0..1_000_000_u64) {
        let mesh = icosphere(3);
        let shapes: Vec<Shape> = mesh.iter().map(|&t| Shape::Triangle(Triangle::new(t).unwrap())).collect();
        let mut numbers = Numbers(seed);
        let origin = numbers.point(0.5);
        for level in [Level::Plain, Level::best()] {
            let all = at_level(&shapes, level);
            for _ in 0..200 {
                let [a, b, _] = mesh[(numbers.next() * mesh.len() as f64) as usize];
                let target = if numbers.next() < 0.3 { a } else { a + (b - a) * numbers.next() };
                let ray = Ray::new(origin, (target - origin).normalize());
                prop_assert_eq!(all.closest(&ray).map(|hit| hit.t), brute_force(&shapes, &ray, all.radius()).map(|it| it.0));
            }
        }
    }
}
