//! How rpict spells its options, which of them do something here, and what follows each.
//!
//! Source: the manual page rpict(1) of Radiance.

/// What follows an option.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Takes {
    /// `+`, `-` or nothing, attached; nothing means the opposite of the default.
    Switch { default: bool },
    /// So many numbers.
    Numbers(usize),
    /// A whole number, at least this.
    Count(u32),
    /// A whole number, also negative.
    Integer,
    /// A file.
    File,
    /// A letter, attached.
    Letter,
}

/// Whether an option does anything here.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Effect {
    /// Yes.
    Works,
    /// No: it is as if it always had this value; any other is accepted and changes nothing.
    Fixed(f64, &'static str),
}

/// One option as rpict spells it.
#[derive(Debug)]
pub(crate) struct Spelling {
    pub(crate) name: &'static str,
    pub(crate) takes: Takes,
    pub(crate) effect: Effect,
    pub(crate) help: &'static str,
}

const fn works(name: &'static str, takes: Takes, help: &'static str) -> Spelling {
    Spelling { name, takes, effect: Effect::Works, help }
}

const fn fixed(name: &'static str, takes: Takes, value: f64, why: &'static str, help: &'static str) -> Spelling {
    Spelling { name, takes, effect: Effect::Fixed(value, why), help }
}

use Takes::{Count, File, Integer, Letter, Numbers, Switch};

/// All of them, in the order in which help shows them.
pub(crate) const SPELLINGS: &[Spelling] = &[
    works("-vf", File, "read the view from FILE (a .vf file or a picture)"),
    works(
        "-vt",
        Letter,
        "projection: v perspective, l parallel, c cylindrical, h hemispherical, a angular, s planispheric",
    ),
    works("-vp", Numbers(3), "view point"),
    works("-vd", Numbers(3), "view direction"),
    works("-vu", Numbers(3), "up"),
    works("-vh", Numbers(1), "horizontal size, degrees"),
    works("-vv", Numbers(1), "vertical size, degrees"),
    works("-vo", Numbers(1), "fore clipping distance"),
    works("-va", Numbers(1), "aft clipping distance"),
    works("-vs", Numbers(1), "shift, picture widths"),
    works("-vl", Numbers(1), "lift, picture heights"),
    works("-x", Count(1), "most columns (512)"),
    works("-y", Count(1), "most rows (512)"),
    works("-pa", Numbers(1), "height of a pixel over its width; 0 takes -x and -y as they are (1)"),
    works("-pj", Numbers(1), "part of a pixel over which its samples spread (1)"),
    fixed("-ps", Count(1), 1.0, "every pixel is sampled", "pixel sampling"),
    fixed("-pt", Numbers(1), 0.0, "every pixel is sampled", "threshold of the pixel sampling"),
    works("-pd", Numbers(1), "diameter of the lens, which is in focus at the length of -vd (0)"),
    works("-ab", Count(0), "most diffuse events of a path (unlimited: the crex says which run)"),
    works("-ad", Count(0), "diffuse rays at a primary hit (1)"),
    fixed("-aa", Numbers(1), 0.0, "there is no ambient cache", "accuracy of the ambient cache"),
    fixed("-ar", Count(0), 0.0, "there is no ambient cache", "resolution of the ambient cache"),
    fixed("-as", Count(0), 0.0, "there is no ambient cache", "extra ambient samples"),
    works("-av", Numbers(3), "radiance that stands for diffuse light not traced (0 0 0)"),
    fixed("-aw", Count(0), 0.0, "the ambient value is not averaged", "weight of the ambient value"),
    fixed("-i", Switch { default: false }, 0.0, "pictures hold radiance", "irradiance in place of radiance"),
    works("-lr", Integer, "most reflections of a path (7)"),
    works("-lw", Numbers(1), "least weight of a ray (1e-4)"),
    works("-st", Numbers(1), "rough lobes of at most this specular fraction scatter diffusely (0: the crex says)"),
    works("-ss", Numbers(1), "glossy rays at a primary hit (1)"),
    fixed(
        "-bv",
        Switch { default: true },
        1.0,
        "the backs of surfaces always show",
        "whether the backs of surfaces show",
    ),
    works("-dv", Switch { default: true }, "whether light sources show"),
    fixed(
        "-dj",
        Numbers(1),
        1.0,
        "shadow rays always spread over the whole light",
        "part of a light over which shadow rays spread",
    ),
    fixed(
        "-ds",
        Numbers(1),
        0.0,
        "a hit samples each light once, --spp says how often",
        "size over distance from which a light is divided",
    ),
    fixed("-dt", Numbers(1), 0.0, "every shadow ray is traced", "threshold of the shadow tests"),
    fixed("-dc", Numbers(1), 1.0, "every shadow ray is traced", "certainty of the shadow tests"),
    works("-dr", Count(0), "reflections over which mirrors relay lights (1)"),
    fixed("-dp", Count(0), 0.0, "relayed lights are not tested beforehand", "density of the tests of relayed lights"),
    fixed("-u", Switch { default: false }, 0.0, "--seed chooses the random numbers", "uncorrelated random numbers"),
    works("-n", Count(1), "threads, as --threads"),
];

/// The table as text, for help.
pub(crate) fn help() -> String {
    let mut text = String::from("Options in rpict's spelling (as rpict(1) has them; defaults in brackets):\n");
    for Spelling { name, takes, effect, help } in SPELLINGS {
        let follows = match takes {
            Takes::Switch { .. } => "[+|-]",
            Takes::Numbers(3) => " x y z",
            Takes::Numbers(_) => " value",
            Takes::Count(_) | Takes::Integer => " number",
            Takes::File => " FILE",
            Takes::Letter => "LETTER",
        };
        let inert = match effect {
            Effect::Works => String::new(),
            Effect::Fixed(_, why) => format!("; changes nothing: {why}"),
        };
        text.push_str(&format!("  {:<12}{help}{inert}\n", format!("{name}{follows}")));
    }
    text.push_str("  @FILE       more words from FILE\n");
    text
}
