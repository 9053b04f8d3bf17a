//! How many arguments each type takes, and what they are: the reference manual, section "Primitive Types".

use super::kind::Kind;

/// How many arguments of one sort are right.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Count {
    Exactly(usize),
    AtLeast(usize),
    OneOf(&'static [usize]),
    Any,
    /// Three coordinates for each of at least three vertices.
    Vertices,
}

impl Count {
    fn admits(self, count: usize) -> bool {
        match self {
            Self::Exactly(wanted) => count == wanted,
            Self::AtLeast(wanted) => count >= wanted,
            Self::OneOf(wanted) => wanted.contains(&count),
            Self::Any => true,
            Self::Vertices => count >= 9 && count.is_multiple_of(3),
        }
    }

    fn in_words(self) -> String {
        match self {
            Self::Exactly(0) => "none".to_owned(),
            Self::Exactly(count) => count.to_string(),
            Self::AtLeast(count) => format!("at least {count}"),
            Self::OneOf(counts) => {
                let words: Vec<String> = counts.iter().map(ToString::to_string).collect();
                words.join(" or ")
            }
            Self::Any => "any number".to_owned(),
            Self::Vertices => "3 for each of at least 3 vertices".to_owned(),
        }
    }
}

/// A type's arguments.
struct Rule {
    strings: Count,
    string_names: &'static str,
    reals: Count,
    real_names: &'static str,
}

/// What is wrong with a primitive's number of arguments, or `None`. The message names what the type wants.
pub(super) fn check_counts(kind: Kind, strings: usize, reals: usize) -> Option<String> {
    let rule = rule(kind);
    let (sort, wanted, names, found) = if !rule.strings.admits(strings) {
        ("string", rule.strings, rule.string_names, strings)
    } else if !rule.reals.admits(reals) {
        ("real", rule.reals, rule.real_names, reals)
    } else {
        return None;
    };
    let names = if names.is_empty() { String::new() } else { format!(" ({names})") };
    Some(format!("`{kind}` has {found} {sort} arguments, expected {}{names}", wanted.in_words()))
}

fn rule(kind: Kind) -> Rule {
    use Count::{Any, AtLeast, Exactly, OneOf, Vertices};
    use Kind as K;
    let of = |strings, string_names, reals, real_names| Rule { strings, string_names, reals, real_names };
    let plain = |reals, real_names| of(Exactly(0), "", reals, real_names);
    let emitter = "red green blue";
    match kind {
        K::Polygon => plain(Vertices, "x y z of every vertex"),
        K::Sphere | K::Bubble => plain(Exactly(4), "x y z of the centre, radius"),
        K::Cone | K::Cup => plain(Exactly(8), "x0 y0 z0 x1 y1 z1 r0 r1"),
        K::Cylinder | K::Tube => plain(Exactly(7), "x0 y0 z0 x1 y1 z1 radius"),
        K::Ring => plain(Exactly(8), "x y z of the centre, x y z of the normal, r0 r1"),
        K::Source => plain(Exactly(4), "x y z of the direction, angle in degrees"),
        K::Instance => of(AtLeast(1), "octree [transform]", Any, ""),
        K::Mesh => of(AtLeast(1), "mesh file [transform]", Any, ""),
        K::Light => plain(Exactly(3), emitter),
        K::Illum => of(OneOf(&[0, 1]), "[alternate material]", Exactly(3), emitter),
        K::Glow => plain(Exactly(4), "red green blue, radius of effect"),
        K::Spotlight => plain(Exactly(7), "red green blue, angle in degrees, x y z of the direction"),
        K::Mirror => of(OneOf(&[0, 1]), "[alternate material]", Exactly(3), emitter),
        K::Prism1 => of(AtLeast(5), "coefficient dx dy dz, function file [transform]", Any, ""),
        K::Prism2 => of(AtLeast(9), "coefficient dx dy dz twice, function file [transform]", Any, ""),
        K::Plastic | K::Metal => plain(Exactly(5), "red green blue, specularity, roughness"),
        K::Trans => {
            plain(Exactly(7), "red green blue, specularity, roughness, transmissivity, transmitted specularity")
        }
        K::Plastic2 | K::Metal2 => of(
            AtLeast(4),
            "ux uy uz, function file [transform]",
            Exactly(6),
            "red green blue, specularity, u roughness, v roughness",
        ),
        K::Trans2 => of(
            AtLeast(4),
            "ux uy uz, function file [transform]",
            Exactly(8),
            "red green blue, specularity, u roughness, v roughness, transmissivity, transmitted specularity",
        ),
        K::Ashik2 => of(
            AtLeast(4),
            "ux uy uz, function file [transform]",
            Exactly(8),
            "diffuse red green blue, specular red green blue, u power, v power",
        ),
        K::Dielectric => plain(Exactly(5), "transmission red green blue, refractive index, Hartmann constant"),
        K::Interface => plain(
            Exactly(8),
            "inner transmission red green blue, inner index, outer transmission red green blue, outer index",
        ),
        K::Glass => plain(OneOf(&[3, 4]), "transmissivity red green blue [refractive index]"),
        K::Plasfunc | K::Metfunc => {
            of(AtLeast(2), "reflectance, function file [transform]", AtLeast(4), "red green blue, specularity")
        }
        K::Transfunc => of(
            AtLeast(2),
            "BRTD, function file [transform]",
            AtLeast(6),
            "red green blue, specularity, transmissivity, transmitted specularity",
        ),
        K::Plasdata | K::Metdata => of(
            AtLeast(4),
            "function, data file, function file, coordinates .. [transform]",
            AtLeast(4),
            "red green blue, specularity",
        ),
        K::Transdata => of(
            AtLeast(4),
            "function, data file, function file, coordinates .. [transform]",
            AtLeast(6),
            "red green blue, specularity, transmissivity, transmitted specularity",
        ),
        K::BrtdFunc => of(
            AtLeast(10),
            "rrefl grefl brefl, rtrns gtrns btrns, rbrtd gbrtd bbrtd, function file [transform]",
            AtLeast(9),
            "front diffuse red green blue, back diffuse red green blue, transmitted diffuse red green blue",
        ),
        K::Bsdf => of(
            AtLeast(6),
            "thickness, BSDF file, ux uy uz, function file [transform]",
            OneOf(&[0, 3, 6, 9]),
            "[front diffuse red green blue [back diffuse [transmitted diffuse]]]",
        ),
        K::ApertureBsdf => of(
            AtLeast(5),
            "BSDF file, ux uy uz, function file [transform]",
            OneOf(&[0, 3, 6, 9]),
            "[front diffuse red green blue [back diffuse [transmitted diffuse]]]",
        ),
        K::WgmdFunc => of(
            AtLeast(13),
            "reflection modifier, coefficient, u and v roughness, the same for transmission, orientation ux uy uz, \
             function file [transform]",
            AtLeast(9),
            "front diffuse red green blue, back diffuse red green blue, transmitted diffuse red green blue",
        ),
        K::Antimatter => of(AtLeast(1), "modifiers that it subtracts", Any, ""),
        K::Mist => of(
            Any,
            "light sources",
            OneOf(&[0, 3, 6, 7]),
            "[extinction red green blue [albedo red green blue [eccentricity]]]",
        ),
        K::Texfunc => of(AtLeast(4), "dx dy dz, function file [transform]", Any, ""),
        K::Texdata => {
            of(AtLeast(8), "xfunc yfunc zfunc, xdata ydata zdata, function file, coordinates .. [transform]", Any, "")
        }
        K::Colorfunc => of(AtLeast(4), "red green blue, function file [transform]", Any, ""),
        K::Brightfunc => of(AtLeast(2), "brightness, function file [transform]", Any, ""),
        K::Colordata => {
            of(AtLeast(8), "rfunc gfunc bfunc, rdata gdata bdata, function file, coordinates .. [transform]", Any, "")
        }
        K::Brightdata => of(AtLeast(4), "function, data file, function file, coordinates .. [transform]", Any, ""),
        K::Colorpict => of(AtLeast(7), "rfunc gfunc bfunc, picture, function file, u v [transform]", Any, ""),
        K::Colortext => of(
            AtLeast(2),
            "font file, text file (or . and words)",
            AtLeast(15),
            "origin, right and down vectors, foreground red green blue, background red green blue [spacing]",
        ),
        K::Brighttext => of(
            AtLeast(2),
            "font file, text file (or . and words)",
            AtLeast(11),
            "origin, right and down vectors, foreground, background [spacing]",
        ),
        K::Spectrum => plain(AtLeast(5), "shortest and longest wavelength, at least 3 values"),
        K::Specfile => of(Exactly(1), "spectrum file", Any, ""),
        K::Specfunc => {
            of(AtLeast(2), "function, function file [transform]", AtLeast(2), "shortest and longest wavelength")
        }
        K::Specdata => of(AtLeast(4), "function, data file, function file, coordinates .. [transform]", Any, ""),
        K::Specpict => of(AtLeast(5), "function, picture, function file, u v [transform]", Any, ""),
        K::Mixfunc => of(AtLeast(4), "foreground, background, function, function file [transform]", Any, ""),
        K::Mixdata => of(
            AtLeast(6),
            "foreground, background, function, data file, function file, coordinates .. [transform]",
            Any,
            "",
        ),
        K::Mixpict => {
            of(AtLeast(7), "foreground, background, function, picture, function file, u v [transform]", Any, "")
        }
        K::Mixtext => of(
            AtLeast(4),
            "foreground, background, font file, text file (or . and words)",
            AtLeast(9),
            "origin, right and down vectors [spacing]",
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_type_wants_is_named() {
        let message = check_counts(Kind::Plastic, 0, 4).unwrap();
        assert_eq!(message, "`plastic` has 4 real arguments, expected 5 (red green blue, specularity, roughness)");
        assert!(check_counts(Kind::Sphere, 1, 4).unwrap().contains("1 string arguments, expected none"));
        assert!(check_counts(Kind::Glass, 0, 5).unwrap().contains("expected 3 or 4"));
        assert!(check_counts(Kind::Polygon, 0, 10).unwrap().contains("3 for each of at least 3 vertices"));
    }

    #[test]
    fn right_counts_pass() {
        for (kind, strings, reals) in [
            (Kind::Polygon, 0, 9),
            (Kind::Polygon, 0, 3000),
            (Kind::Ring, 0, 8),
            (Kind::Mist, 3, 7),
            (Kind::Illum, 1, 3),
            (Kind::Colorpict, 12, 0),
            (Kind::Mixtext, 4, 10),
        ] {
            assert_eq!(check_counts(kind, strings, reals), None);
        }
    }
}
