//! Mist, prisms and lenses at their ends.

use crate::look::{Look, first_bad};
use crate::table::{Case, Row, group};

/// A white wall behind what stands around (0, 1, 0).
const WALL: &str = "void glow wall 0 0 4 1 1 1 0\nwall polygon w 0 0 12 -9 2e4 -9 9 2e4 -9 9 2e4 9 -9 2e4 9\n";

/// The wall through a ball of mist 2 `radius` across.
fn misty(reals: &str, radius: f64) -> Look {
    let count = reals.split_whitespace().count();
    let text = format!(
        "{WALL}void light sun 0 0 3 1e30 1e30 1e30\nsun source side 0 0 4 1 0 .1 .5\n\
        void mist m 1 side 0 {count} {reals}\nm sphere ball 0 0 4 0 {:e} 0 {radius:e}\n",
        1.5 * radius
    );
    Look::new(text, [0.0; 3], [0.0, 1.0, 0.0])
}

fn thin(extinction: f64, radius: f64) -> Row {
    let look = misty(&format!("{extinction:e} 0 0"), radius);
    Row::near((-2.0 * radius * extinction).exp(), look.red(), 1e-6)
}

fn prism(arguments: &str, wall: f64) -> f64 {
    let text = format!(
        "void glow wall 0 0 4 {wall:e} {wall:e} {wall:e} 0\nwall polygon w 0 0 12 -9 2 -9 9 2 -9 9 2 9 -9 2 9\n\
        void prism1 p 5 {arguments} . 0 0\np polygon s 0 0 12 -1 1 -1 1 1 -1 1 1 1 -1 1 1\n"
    );
    Look::new(text, [0.0; 3], [0.0, 1.0, 0.0]).crex("T").red()
}

fn lens(diameter: f64) -> Row {
    let text = "void glow wall 0 0 4 1 1 1 0\nwall polygon w 0 0 12 -9 2 -9 9 2 -9 9 2 9 -9 2 9\n";
    let mut look = Look::new(text, [0.0; 3], [0.0, 2.0, 0.0]).samples(16);
    look.settings.aperture = diameter;
    // In focus the wall is met where it would be met without a lens.
    Row::near(1.0, look.red(), 1e-6)
}

pub(crate) fn cases() -> Vec<Case> {
    group(
        "media",
        &[
            ("mist of 1e-9 a metre, 2 km deep", || thin(1e-9, 1e3)),
            ("mist of 1e-3 a metre, 2 km deep", || thin(1e-3, 1e3)),
            ("mist of 1e3 a metre, a millimetre deep", || thin(1e3, 5e-4)),
            ("mist of 1e30 a metre passes nothing", || Row::same(0.0, misty("1e30 1e30 1e30", 1.0).red())),
            ("mist of 1e30 that scatters a sun of 1e30: finite", || {
                Row::same(None, first_bad(&misty("1e30 1 1e-30 1 1 1 .999999", 1.0).samples(64).render()))
            }),
            ("mist that scatters all ahead scatters nothing aside", || {
                Row::near((-2.0_f64).exp(), misty("1 1 1 1 1 1 1", 1.0).red(), 1e-6)
            }),
            ("a prism that passes 1e30 of 1e10 saturates", || {
                Row::same(f64::from(f32::MAX), prism("1e30 Dx Dy Dz", 1e10))
            }),
            ("a prism whose direction has no length", || Row::same(0.0, prism("1 0 0 0", 1.0))),
            ("a prism whose direction is 1e200 long", || Row::near(1.0, prism("1 Dx*1e200 Dy*1e200 0", 1.0), 1e-6)),
            ("a lens 1e-12 wide", || lens(1e-12)),
            ("a lens 1e8 wide", || lens(1e8)),
        ],
    )
}
