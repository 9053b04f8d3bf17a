//! What the native commands give against what Radiance's own programs print (`data/commands.rad`; `data/make.py` says
//! how it was made). The programs print 12 digits of most numbers and 6 of some.

use super::super::{Document, Kind, MemoryFiles, Options, Primitive, Source, read};

const TABLE: &str = include_str!("../data/commands.rad");

fn files() -> MemoryFiles {
    MemoryFiles::new()
        .with("everything.rad", include_str!("../data/everything.rad"))
        .with("nested.rad", include_str!("../data/nested.rad"))
        .with("outline.txt", include_str!("../data/outline.txt"))
        .with("args.txt", include_str!("../data/args.txt"))
        .with("funcs.txt", include_str!("../data/funcs.txt"))
        .with("heights.txt", include_str!("../data/heights.txt"))
        .with("points.txt", include_str!("../data/points.txt"))
}

/// The modifiers that generated surfaces ask for.
const GOLD: &str = "void plastic m 0 0 5 1 1 1 0 0\nvoid plastic gold 0 0 5 1 1 1 0 0\n\
                    void plastic paint 0 0 5 0 0 0 0 0\n";

fn document(text: &str) -> Document {
    read(&[Source::new("test", format!("{GOLD}{text}\n"))], &files(), &Options::default())
        .unwrap_or_else(|errors| panic!("{text}: {}", errors[0]))
}

fn close(found: f64, printed: f64, kind: Kind) -> bool {
    // These the program prints with 6 digits.
    let digits = if matches!(kind, Kind::Dielectric | Kind::Interface | Kind::Mist) { 1e-5 } else { 1e-11 };
    // gensky prints 4 digits of brightnesses and 6 after the point of directions.
    if matches!(kind, Kind::Light | Kind::Source | Kind::Brightfunc)
        && (found - printed).abs() <= 6e-4 * printed.abs() + 6e-7
    {
        return true;
    }
    // The second program of a pipe computes with what the first one printed.
    (found - printed).abs() <= digits * printed.abs().max(0.1)
}

fn same(found: &Primitive, printed: &Primitive) -> bool {
    found.kind == printed.kind
        && found.name == printed.name
        && found.modifier == printed.modifier
        && found.strings == printed.strings
        && same_numbers(found, printed)
}

fn same_numbers(found: &Primitive, printed: &Primitive) -> bool {
    found.reals.len() == printed.reals.len()
        && found.reals.iter().zip(&printed.reals).all(|(&a, &b)| close(a, b, found.kind))
}

/// Boxes name and order their parts in another way, start polygons and axes elsewhere, and cut quadrangles in two.
fn same_part(found: &Primitive, printed: &Primitive) -> bool {
    found.kind == printed.kind
        && found.modifier == printed.modifier
        && found.name.split_once("b.").map(|(path, _)| path) == printed.name.split_once("b.").map(|(path, _)| path)
        && found.reals.len() == printed.reals.len()
        && match found.kind {
            Kind::Polygon => {
                let count = found.reals.len() / 3;
                (0..count).any(|start| {
                    let mut turned = found.clone();
                    turned.reals.rotate_left(3 * start);
                    same_numbers(&turned, printed)
                })
            }
            Kind::Cylinder => {
                let mut turned = found.clone();
                turned.reals[..6].rotate_left(3);
                same_numbers(found, printed) || same_numbers(&turned, printed)
            }
            _ => same_numbers(found, printed),
        }
}

#[test]
fn commands_give_what_the_programs_print() {
    let mut tried = 0;
    for section in TABLE.split("#= ").skip(1) {
        let (command, output) = section.split_once('\n').unwrap();
        let (found, printed) = (document(&format!("!{command}")), document(output));
        assert_eq!(found.primitives.len(), printed.primitives.len(), "{command}");
        if command.contains("genbox") || command.contains("nested.rad") {
            let mut left: Vec<&Primitive> = printed.primitives.iter().collect();
            for part in &found.primitives {
                let place = left.iter().position(|printed| same(part, printed) || same_part(part, printed));
                left.swap_remove(place.unwrap_or_else(|| panic!("{command}: {part:?} was not printed")));
            }
        } else {
            for (part, printed) in found.primitives.iter().zip(&printed.primitives) {
                assert!(same(part, printed), "{command}:\n{part:?}\n{printed:?}");
            }
        }
        tried += 1;
    }
    assert_eq!(tried, 74);
}
