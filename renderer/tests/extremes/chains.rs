//! Long paths: stacks of panes, mirrors that face each other, ripples that fade out or swell.

use renderer::component::Component;

use crate::look::{EVERYTHING, Look, PAINT, square};
use crate::table::{Case, Row, group};

const SKY: &str = "void glow sky 0 0 4 1 1 1 0\nsky source all 0 0 4 0 0 1 360\n";

/// 10^4 panes without reflection, a millimetre apart, the lowest at z = 1.
fn stack(transmissivity: f64) -> String {
    let mut text = format!("void glass pane 0 0 4 {transmissivity} {transmissivity} {transmissivity} 1\n");
    for i in 0..10_000 {
        text += &square("pane", "p", [0.0, 0.0, 1.0 + f64::from(i) * 1e-3], 1.0);
    }
    text
}

/// Down through the panes to the sky below.
fn through(transmissivity: f64) -> Look {
    Look::new(SKY.to_owned() + &stack(transmissivity), [0.1, 0.2, 20.0], [0.0, 0.0, -1.0]).crex("T*")
}

/// Two mirrors at x = -1 and 1 that reflect so much; the eye between them looks along x.
fn facing(reflectance: f64) -> Look {
    let r = reflectance;
    let text = format!(
        "void mirror silver 0 0 3 {r:e} {r:e} {r:e}\nsilver polygon a 0 0 12 1 -1 -1 1 -1 1 1 1 1 1 1 -1\n\
         silver polygon b 0 0 12 -1 -1 -1 -1 1 -1 -1 1 1 -1 -1 1\n"
    );
    Look::new(text, [0.0; 3], [1.0, 0.0, 0.0]).crex("M*")
}

/// Rays of mirrors that were traced.
fn reflected(look: &Look) -> u64 {
    let stages = look.render().stages;
    stages.iter().filter(|row| row.stage.component == Component::Mirror).map(|row| row.report.rays).sum()
}

/// Up a corridor of mirrors of some reflectance, askew, into the sky of radiance 1 at its end: 10 reflections.
fn corridor(reflectance: f64, end: &str) -> f64 {
    let mut look = facing(reflectance);
    look.text += end;
    look.view.direction = [1.0, 0.0, 0.05];
    look.red()
}

pub(crate) fn cases() -> Vec<Case> {
    group(
        "chains",
        &[
            ("through 10^4 panes of .999", || Row::near(0.999_f64.powi(10_000), through(0.999).red(), 1e-6)),
            ("through 10^4 clear panes", || Row::same(1.0, through(1.0).red())),
            ("through 10^4 panes of .5: below any number", || Row::same(0.0, through(0.5).red())),
            ("a lamp through 10^4 panes of .999", || {
                // As in places: 1/2 without the panes. They lie between z = 1 and 11, the lamp at 20.
                let floor = square("paint", "floor", [0.0; 3], 1.0) + "lamp sphere ball 0 0 4 0 0 20 .02\n";
                let text = [PAINT, &stack(0.999), &floor].concat();
                let seen = Look::new(text, [0.0, -0.5, 0.5], [0.0, 1.0, -1.0]).red();
                Row::near(0.5 * 0.999_f64.powi(10_000), seen, 1e-4)
            }),
            ("a path of default limits ends at -lw 1e-4", || {
                let mut look = through(0.999);
                look.settings.limits = renderer::transport::Limits::default();
                Row::same(0.0, look.red())
            }),
            // The least number is 2^-1074: the ripple of the 1075th reflection is 0, and that ray is none.
            ("mirrors of .5, until the ripple is 0", || Row::same(1074, reflected(&facing(0.5)))),
            ("mirrors of .5, at -lr 7", || Row::same(7, reflected(&facing(0.5).reflections(7)))),
            ("perfect mirrors: the crex stops at its limit", || {
                let rendering = facing(1.0).render();
                Row::same((1, true), (rendering.stopped.len(), rendering.left[Component::Mirror] == 1))
            }),
            ("a clear pane before a perfect mirror, white all around", || {
                let pane = "void glass pane 0 0 3 1 1 1\nvoid mirror silver 0 0 3 1 1 1\n";
                let text =
                    [SKY, pane, &square("silver", "m", [0.0; 3], 9.0), &square("pane", "p", [0.0, 0.0, 1.0], 9.0)];
                Row::near(1.0, Look::new(text.concat(), [0.0, 0.0, 3.0], [0.3, 0.0, -1.0]).crex(EVERYTHING).red(), 1e-6)
            }),
            ("mirrors of .5: 10 reflections, then the sky", || Row::near(0.5_f64.powi(10), corridor(0.5, SKY), 1e-6)),
            ("mirrors of 1e30 saturate", || Row::same(f64::from(f32::MAX), corridor(1e30, SKY))),
            ("mirrors of 1e30, then a black wall", || {
                let wall = "void plastic soot 0 0 5 0 0 0 0 0\nsoot bubble wall 0 0 4 0 0 0 50\n";
                Row::same(0.0, corridor(1e30, wall))
            }),
        ],
    )
}
