use std::f64::consts::{PI, TAU};

use proptest::prelude::*;

use super::*;

fn meet(shape: &Shape, origin: DVec3, dir: DVec3) -> Option<f64> {
    shape.meet(&Probe::new(origin, dir), false, 0.0, f64::INFINITY)
}

fn vector(range: f64) -> impl Strategy<Value = DVec3> {
    prop::array::uniform3(-range..range).prop_map(DVec3::from)
}

fn direction() -> impl Strategy<Value = DVec3> {
    (-1.0..=1.0_f64, 0.0..TAU).prop_map(|(z, phi)| {
        let r = (1.0 - z * z).max(0.0).sqrt();
        DVec3::new(r * phi.cos(), r * phi.sin(), z)
    })
}

fn square() -> Shape {
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    Shape::Polygon(Polygon::new(corners.iter().map(|&[x, y]| DVec3::new(x, y, 0.0)).collect()).unwrap())
}

#[test]
fn distances_are_those_of_closed_forms() {
    let sphere = Shape::Sphere(Sphere::new(DVec3::new(0.0, 0.0, 5.0), 2.0).unwrap());
    assert_eq!(meet(&sphere, DVec3::ZERO, DVec3::Z), Some(3.0));
    assert_eq!(meet(&sphere, DVec3::new(0.0, 0.0, 5.0), DVec3::X), Some(2.0));
    assert_eq!(meet(&sphere, DVec3::ZERO, -DVec3::Z), None);
    // A chord at distance 1 from the centre: half its length is sqrt 3.
    let t = meet(&sphere, DVec3::X, DVec3::Z).unwrap();
    assert!((t - (5.0 - 3.0_f64.sqrt())).abs() < 1e-15);

    let tube = Shape::Cone(Cone::new([DVec3::ZERO, DVec3::Z * 4.0], [1.0; 2], true).unwrap());
    assert_eq!(meet(&tube, DVec3::new(-3.0, 0.0, 1.0), DVec3::X), Some(2.0));
    assert_eq!(meet(&tube, DVec3::new(-3.0, 0.0, 5.0), DVec3::X), None);
    // Along the axis it is open.
    assert_eq!(meet(&tube, DVec3::new(0.3, 0.0, -1.0), DVec3::Z), None);
    // Over its lower rim the ray enters at the far wall.
    let t = meet(&tube, DVec3::new(-3.0, 0.0, -1.1), DVec3::new(2.0, 0.0, 1.0).normalize()).unwrap();
    assert!((t - 20.0_f64.sqrt()).abs() < 1e-14, "{t}");

    let cone = Shape::Cone(Cone::new([DVec3::ZERO, DVec3::Z * 2.0], [2.0, 0.0], false).unwrap());
    assert_eq!(meet(&cone, DVec3::new(-5.0, 0.0, 1.0), DVec3::X), Some(4.0));
    // Only one nappe: the line passes above the apex.
    assert_eq!(meet(&cone, DVec3::new(-5.0, 0.0, 3.0), DVec3::X), None);

    let ring = Shape::Ring(Ring::new(DVec3::Z, DVec3::Z * 9.0, [1.0, 2.0]).unwrap());
    assert_eq!(meet(&ring, DVec3::X * 1.5, DVec3::Z), Some(1.0));
    assert_eq!(meet(&ring, DVec3::X * 0.5, DVec3::Z), None);
    assert_eq!(meet(&ring, DVec3::X * 2.5, DVec3::Z), None);
}

#[test]
fn normals_are_those_of_the_front() {
    let outward = Shape::Sphere(Sphere::new(DVec3::ZERO, 2.0).unwrap());
    let inward = Shape::Sphere(Sphere::new(DVec3::ZERO, -2.0).unwrap());
    assert_eq!(outward.settle(DVec3::X * 1.999), (DVec3::X * 2.0, DVec3::X));
    assert_eq!(inward.settle(DVec3::X * 2.001), (DVec3::X * 2.0, -DVec3::X));
    let cone = |inward| Shape::Cone(Cone::new([DVec3::ZERO, DVec3::Z], [1.0, 0.0], inward).unwrap());
    let expected = DVec3::new(1.0, 0.0, 1.0).normalize();
    assert!(cone(false).settle(DVec3::new(0.5, 0.0, 0.5)).1.abs_diff_eq(expected, 1e-15));
    assert!(cone(true).settle(DVec3::new(0.5, 0.0, 0.5)).1.abs_diff_eq(-expected, 1e-15));
    // Counter-clockwise as seen from above.
    assert_eq!(square().settle(DVec3::new(0.2, 0.1, 1e-9)), (DVec3::new(0.2, 0.1, 0.0), DVec3::Z));
    assert_eq!(Ring::new(DVec3::ZERO, -DVec3::Y * 1e-200, [0.0, 1.0]).unwrap().normal(), -DVec3::Y);
}

#[test]
fn areas_are_those_of_closed_forms() {
    assert_eq!(square().area(), 4.0);
    assert!((Shape::Sphere(Sphere::new(DVec3::ZERO, -0.5).unwrap()).area() - PI).abs() < 1e-15);
    assert!((Shape::Ring(Ring::new(DVec3::ZERO, DVec3::X, [2.0, 1.0]).unwrap()).area() - 3.0 * PI).abs() < 1e-14);
    // pi (r0 + r1) slant: 3-4-5.
    let cone = Shape::Cone(Cone::new([DVec3::ZERO, DVec3::Y * 4.0], [4.0, 1.0], false).unwrap());
    assert!((cone.area() - 25.0 * PI).abs() < 1e-13);
    let triangle = Triangle::new([DVec3::ZERO, DVec3::X * 3.0, DVec3::Y * 4.0]).unwrap();
    assert_eq!(Shape::Triangle(triangle).area(), 6.0);
}

#[test]
fn what_covers_nothing_is_no_shape() {
    let p = DVec3::new(1.0, 2.0, 3.0);
    assert_eq!(Sphere::new(p, 0.0), Err(Degenerate::NoRadius));
    assert_eq!(Cone::new([p, p], [1.0; 2], false), Err(Degenerate::NoLength));
    assert_eq!(Cone::new([p, p + 1.0], [0.0; 2], false), Err(Degenerate::NoRadius));
    assert_eq!(Ring::new(p, DVec3::ZERO, [0.0, 1.0]), Err(Degenerate::NoNormal));
    assert_eq!(Ring::new(p, DVec3::X, [1.0; 2]), Err(Degenerate::NoArea));
    assert_eq!(Triangle::new([p, p * 2.0, p * 3.0]), Err(Degenerate::NoArea));
    assert_eq!(Triangle::new([p; 3]), Err(Degenerate::NoArea));
    assert!(Polygon::new(vec![p, p * 2.0, p * 3.0, p * 7.0]).is_err());
    // Three digits of a millimetre at 1e8 are still a triangle.
    let far = DVec3::splat(1e8);
    assert!(Triangle::new([far, far + DVec3::X * 1e-3, far + DVec3::Y * 1e-3]).is_ok());
    assert!(Triangle::new([DVec3::ZERO, DVec3::X, DVec3::new(0.5, 1e-12, 0.0)]).is_ok());
}

#[test]
fn seams_cut_holes() {
    // A square of side 4 with a hole of side 2, joined by a seam along a diagonal.
    let outline = [
        [0.0, 0.0],
        [4.0, 0.0],
        [4.0, 4.0],
        [0.0, 4.0],
        [0.0, 0.0],
        [1.0, 1.0],
        [1.0, 3.0],
        [3.0, 3.0],
        [3.0, 1.0],
        [1.0, 1.0],
    ];
    let polygon = Polygon::new(outline.iter().map(|&[x, y]| DVec3::new(x, y, 0.0)).collect()).unwrap();
    assert_eq!(polygon.area(), 12.0);
    let shape = Shape::Polygon(polygon);
    for i in 0..41 {
        for j in 0..41 {
            let at = DVec3::new(f64::from(i) * 0.1 + 1e-3, f64::from(j) * 0.1 + 2e-3, 0.0);
            let inside = |low: f64, high: f64| at.x > low && at.x < high && at.y > low && at.y < high;
            let solid = inside(0.0, 4.0) && !inside(1.0, 3.0);
            assert_eq!(meet(&shape, at + DVec3::Z, -DVec3::Z).is_some(), solid, "{at}");
        }
    }
    // On the seam itself the two walks cancel.
    assert_eq!(meet(&shape, DVec3::new(0.5, 0.5, 1.0), -DVec3::Z), Some(1.0));
}

#[test]
fn a_ray_leaves_its_own_surface() {
    let sphere = Shape::Sphere(Sphere::new(DVec3::splat(1e5), 1e-3).unwrap());
    let (point, normal) = sphere.settle(DVec3::new(1e5 + 1e-3, 1e5, 1e5));
    for dir in [normal, DVec3::Y, DVec3::new(0.1, 1.0, 0.0).normalize()] {
        assert_eq!(sphere.meet(&Probe::new(point, dir), true, 1e-12, f64::INFINITY), None);
    }
    // Inward it crosses the whole chord.
    let t = sphere.meet(&Probe::new(point, -normal), true, 1e-12, f64::INFINITY).unwrap();
    assert!((t - 2e-3).abs() < 1e-10);
    assert_eq!(square().meet(&Probe::new(DVec3::ZERO, DVec3::X), true, 0.0, f64::INFINITY), None);
    let tube = Shape::Cone(Cone::new([DVec3::ZERO, DVec3::Z], [1.0; 2], true).unwrap());
    let t = tube.meet(&Probe::new(DVec3::new(1.0, 0.0, 0.5), -DVec3::X), true, 1e-12, f64::INFINITY).unwrap();
    assert_eq!(t, 2.0);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    /// A ray aimed at a point of a sphere from any distance meets it there or nearer.
    #[test]
    fn spheres_are_met_from_far_away(centre in vector(10.0), outward in direction(), towards in direction(), e in -3..8_i32, r in 0.1..3.0_f64) {
        let sphere = Sphere::new(centre, r).unwrap();
        let shape = Shape::Sphere(sphere);
        let target = centre + outward * r * 0.999;
        let origin = target - towards * 10_f64.powi(e);
        let from_inside = (origin - centre).length() < r;
        let t = meet(&shape, origin, towards).expect("the target lies inside");
        let (point, normal) = shape.settle(origin + towards * t);
        let rounding = 1e-15 * (origin.length() + 20.0);
        prop_assert!((origin + towards * t - point).length() < 1e3 * rounding);
        prop_assert_eq!(normal.dot(towards) > 0.0, from_inside);
    }

    /// The first crossing of a frustum is where stepping along the ray finds it.
    #[test]
    fn frusta_are_met_where_stepping_finds_them(
        base in vector(2.0), axis in direction(), length in 0.2..3.0_f64,
        r0 in 0.0..2.0_f64, r1 in 0.0..2.0_f64, origin in vector(6.0), dir in direction(),
    ) {
        prop_assume!(r0 + r1 > 0.1);
        let shape = Shape::Cone(Cone::new([base, base + axis * length], [r0, r1], false).unwrap());
        let height = |p: DVec3| (p - base).dot(axis);
        // Signed excess over the radius of the infinite double cone's nappe at that height.
        let excess = |t: f64| {
            let p = origin + dir * t;
            let h = height(p);
            ((p - base) - axis * h).length() - (r0 + (r1 - r0) * h / length)
        };
        let steps = 4000;
        let mut found = None;
        for i in 0..steps {
            let (a, b) = (f64::from(i) * 20.0 / f64::from(steps), f64::from(i + 1) * 20.0 / f64::from(steps));
            if excess(a).signum() != excess(b).signum() {
                let (mut low, mut high) = (a, b);
                for _ in 0..60 {
                    let middle = 0.5 * (low + high);
                    if excess(middle).signum() == excess(low).signum() { low = middle } else { high = middle }
                }
                let h = height(origin + dir * low);
                if (0.0..=length).contains(&h) {
                    found = Some(low);
                    break;
                }
            }
        }
        let t = meet(&shape, origin, dir);
        if let Some(found) = found {
            let h = height(origin + dir * found);
            // Within a step of a rim the two may differ about what is met.
            if h > 0.02 && h < length - 0.02 {
                let t = t.expect("stepping finds it");
                prop_assert!(t <= found + 1e-9);
                if t < found - 1e-9 {
                    // Stepping jumped over a grazed pair of crossings.
                    prop_assert!(excess(t).abs() < 1e-9 && (-1e-9..=length + 1e-9).contains(&height(origin + dir * t)));
                }
            }
        } else if let Some(t) = t {
            prop_assert!(excess(t).abs() < 1e-9);
            prop_assert!((-1e-9..=length + 1e-9).contains(&height(origin + dir * t)));
        }
    }

    /// The pieces of a square cut by a zigzag between two opposite sides: every ray through the square meets exactly one.
    #[test]
    fn a_cut_square_has_no_gap_and_no_overlap(
        cut in prop::collection::vec(-0.9..0.9_f64, 1..6), rise in vector(1.0), at in prop::array::uniform2(-0.999..0.999_f64),
        dir in direction(), on_edge in 0.0..1.0_f64, e in -4..5_i32,
    ) {
        prop_assume!(dir.z.abs() > 1e-3);
        let scale = 10_f64.powi(e);
        let lift = |x: f64, y: f64| DVec3::new(x, y, 0.0) * scale + rise;
        let seam: Vec<DVec3> = (0..cut.len())
            .map(|i| lift(-1.0 + 2.0 * (i as f64 + 1.0) / (cut.len() as f64 + 1.0), cut[i]))
            .collect();
        let (left, right) = (lift(-1.0, 0.0), lift(1.0, 0.0));
        let mut below = vec![lift(-1.0, -1.0), lift(1.0, -1.0), right];
        below.extend(seam.iter().rev());
        below.push(left);
        let mut above = vec![left];
        above.extend(&seam);
        above.extend([right, lift(1.0, 1.0), lift(-1.0, 1.0)]);
        let pieces = [below, above].map(|outline| Shape::Polygon(Polygon::new(outline).unwrap()));
        // A point of the square, a point of the seam and a vertex of the seam.
        let from = if seam.len() > 1 { seam[0] } else { left };
        let to = if seam.len() > 1 { seam[1] } else { seam[0] };
        for target in [lift(at[0], at[1]), from + (to - from) * on_edge, seam[0]] {
            let origin = target - dir * 3.0 * scale;
            let met = pieces.iter().filter(|piece| meet(piece, origin, dir).is_some()).count();
            prop_assert_eq!(met, 1);
        }
    }
}
