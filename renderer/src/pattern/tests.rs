use std::sync::Arc;

use glam::{DAffine3, DVec3};

use super::{Field, Finish, Font, Library, Memory, Place, Source, Spacing, Step, Table, Text, apply};
use crate::color::Rgb;
use crate::math::Similarity;

fn place(point: DVec3) -> Place<'static> {
    Place { point, dir: -DVec3::Z, normal: DVec3::Z, distance: 2.0, uv: None, object: None }
}

fn field(library: &mut Library, expressions: &[&str], to_local: Similarity, reals: &[f64]) -> Field {
    let expressions = expressions.iter().map(|text| library.expression(".", text).unwrap()).collect();
    Field { source: Source::Functions(expressions), to_local, reals: reals.into() }
}

/// Along one dimension with points 0, 1, 2 and values 1, 3, 7: linear between, linear for one division beyond, then
/// harmonic to 0 (the values are those of Radiance's manual, worked out by hand).
#[test]
fn tables_interpolate_and_fade() {
    let even = Table::read("1  0 2 3  1 3 7").unwrap();
    let uneven = Table::read("1  0 0 3  0 1 2  # the same\n1 3 7").unwrap();
    for (x, expected) in [
        (0.0, 1.0),
        (0.25, 1.5),
        (1.0, 3.0),
        (1.75, 6.0),
        (2.0, 7.0),
        (2.5, 9.0),
        // One division beyond: 3 - 2 to 7 + 4. Further: (2 y1 - y0)/(x - i + 1) with division i = 1.
        (3.0, 11.0),
        (5.0, (2.0 * 7.0 - 3.0) / 5.0),
        (-1.0, -1.0),
        (-3.0, (2.0 * 1.0 - 3.0) / 3.0),
    ] {
        for table in [&even, &uneven] {
            let [found, ..] = table.value(&[x]);
            assert!((found - expected).abs() < 1e-6, "{x}: {found}, not {expected}");
        }
    }
    // The last dimension fastest.
    let plane = Table::read("2  0 1 2  0 2 3  1 2 3  4 5 6").unwrap();
    assert_eq!(plane.value(&[0.0, 1.0])[0], 2.0);
    assert_eq!(plane.value(&[1.0, 2.0])[0], 6.0);
    assert!((plane.value(&[0.5, 0.5])[0] - 3.0).abs() < 1e-6);
    for bad in ["", "0", "1 0 1", "1 0 1 2 3", "1 0 1 2 x 3", "6 0 1 2", "1 0 0 3 0 2 1 1 1 1", "1 0 1 1e300 1"] {
        assert!(Table::read(bad).is_err(), "{bad}");
    }
}

/// The shorter side spans 0 to 1, the origin is at the lower left, pixels have their value at their centre.
#[test]
fn pictures_are_tables() {
    let pixels = [[1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [3.0, 0.0, 0.0], [4.0, 0.0, 0.0], [5.0, 0.0, 0.0], [6.0, 0.0, 7.0]];
    let table = Table::of_picture(3, &pixels).unwrap();
    let red = |u: f64, v: f64| table.value(&[v, u])[0];
    // Two rows: side 2 spans 0 to 1, so the row of three spans 0 to 1.5.
    assert_eq!((red(0.0, 0.0), red(1.5, 0.0), red(0.75, 1.0), red(0.375, 1.0)), (4.0, 6.0, 2.0, 1.5));
    assert_eq!(table.value(&[0.0, 1.5]), [6.0, 0.0, 7.0]);
    assert!(Table::of_picture(0, &[]).is_none());
}

/// Functions see the point, the ray and the scale in their own coordinates; what they add to the normal is turned back.
#[test]
fn functions_live_in_local_coordinates() {
    let mut library = Library::default();
    // xform -rz 90 -s 2 -t 1 0 0: local x is the scene's y.
    let there = Similarity {
        affine: DAffine3::from_translation(DVec3::X)
            * DAffine3::from_scale(DVec3::splat(2.0))
            * DAffine3::from_rotation_z(std::f64::consts::FRAC_PI_2),
        scale: 2.0,
    };
    let reals = [0.25, 8.0];
    let position = field(&mut library, &["Px", "Py", "Pz"], there.inverse(), &reals);
    let rest = field(&mut library, &["S", "T", "A2 + AC + Rdot"], there.inverse(), &reals);
    let bend = field(&mut library, &["A1", "0", "0"], there.inverse(), &reals);
    let mut evaluator = library.evaluator(Memory::default());
    let at = place(DVec3::new(1.0, 4.0, 6.0));
    let close = |found: Option<[f64; 3]>, expected: [f64; 3]| {
        let found = found.unwrap();
        assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12), "{found:?}, not {expected:?}");
    };
    close(position.values(&at, &mut evaluator), [2.0, 0.0, 3.0]);
    close(rest.values(&at, &mut evaluator), [0.5, 1.0, 8.0 + 2.0 + 1.0]);
    let mut finish = Finish::default();
    apply(&[Step::Bend(bend)], &at, &mut evaluator, &mut finish);
    assert!((finish.bend - DVec3::new(0.0, 0.25, 0.0)).length() < 1e-15);
}

#[test]
fn blends_mix_what_their_steps_do() {
    let mut library = Library::default();
    let part = field(&mut library, &["Px"], Similarity::IDENTITY, &[]);
    let failing = field(&mut library, &["arg(3)"], Similarity::IDENTITY, &[]);
    let steps = [
        Step::Fixed(Rgb::splat(2.0)),
        Step::Blend { part, fore: vec![Step::Fixed(Rgb::X)], back: vec![Step::Fixed(Rgb::Y)] },
        // A function that fails changes nothing.
        Step::Tint(failing),
    ];
    let mut evaluator = library.evaluator(Memory::default());
    for (x, expected) in [(0.25, Rgb::new(0.5, 1.5, 0.0)), (-3.0, Rgb::Y * 2.0), (7.0, Rgb::X * 2.0)] {
        let mut finish = Finish::default();
        apply(&steps, &place(DVec3::X * x), &mut evaluator, &mut finish);
        assert_eq!(finish.tint, expected);
    }
}

/// Glyph `a` is a square with a hole, given as one outline with a seam; ` ` is blank.
#[test]
fn text_covers_its_glyphs() {
    let font = "97 10  20 20 220 20 220 220 20 220 20 20  80 80 80 160 160 160 160 80 80 80\n32 0\n";
    let font = Arc::new(Font::read(font).unwrap());
    let axes = [DVec3::ZERO, DVec3::X, -DVec3::Y];
    let text = Text::new(Arc::clone(&font), axes, Spacing::Uniform, &["a a".to_owned(), "a".to_owned()]).unwrap();
    let at = |x: f64, y: f64| text.covers(DVec3::new(x, -y, 0.0));
    // Characters are 1 wide, lines 1 high: the outline spans 20/255 to 220/255 of each.
    assert!(at(0.2, 0.2) && !at(0.5, 0.5) && !at(0.03, 0.5) && !at(0.9, 0.2));
    assert!(!at(1.2, 0.2) && at(2.2, 0.2) && !at(3.2, 0.2) && at(0.2, 1.2) && !at(1.2, 1.2) && !at(0.2, 2.2));
    assert!(!at(-0.1, 0.2) && !at(0.2, -0.1));
    // Squeezed: letters of 200 units, a gap of 25 (.1 of 255) between, a blank of the mean width.
    let tight = Text::new(Arc::clone(&font), axes, Spacing::Given(-0.1), &["aa".to_owned()]).unwrap();
    let unit = 1.0 / (200.0 + 25.5);
    let tight_at = |x: f64| tight.covers(DVec3::new(x * unit, -0.2, 0.0));
    // A gap of 24 before, a letter from 24 to 224, a gap of 24, a letter from 248.
    assert!(!tight_at(20.0) && tight_at(30.0) && tight_at(220.0) && !tight_at(236.0) && tight_at(260.0));
    assert!(Text::new(font, [DVec3::ZERO, DVec3::X, DVec3::X], Spacing::Uniform, &[]).is_none());
    for bad in ["0 1 1 1", "97 1 1", "97 1 1 256", "97 0 97 0", "x"] {
        assert!(Font::read(bad).is_err(), "{bad}");
    }
}

#[test]
fn mistakes_in_functions_are_named() {
    let mut library = Library::default();
    assert!(library.expression(".", "nosuch*2").unwrap_err().contains("nosuch"));
    assert!(library.define("a.cal", "f(x) = x +;").is_err());
    library.define("b.cal", "twice(x) = 2*x; bad(x) = nosuch(x);").unwrap();
    assert!(library.knows("b.cal") && !library.knows("c.cal"));
    assert!(library.function("b.cal", "twice").is_ok());
    assert!(library.function("b.cal", "bad").unwrap_err().contains("nosuch"));
    assert!(library.lambda("b.cal", "absent", 4).is_err());
}
