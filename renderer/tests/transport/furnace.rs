//! Furnaces through the whole renderer: in surroundings of radiance 1 a surface shows its albedo, whatever it is made
//! of.

use renderer::color::Rgb;
use renderer::material::FRESNEL_OFFSET;

use crate::{Stage, assert_close, endless};

/// A ball in a uniform glow, seen through a narrow view at its centre.
fn ball(material: &str) -> Stage {
    let text = format!(
        "{material}\nvoid glow white 0 0 4 1 1 1 0\nwhite source sky 0 0 4 0 0 1 360\nstuff sphere ball 0 0 4 0 0 0 1\n"
    );
    Stage::new(&text, [0.0, -5.0, 0.0], [0.0, 1.0, 0.0], 0.01)
}

const EVERYTHING: &str = "(TRSGMD)*";

#[test]
fn matt_plastic_shows_its_colour() {
    // Every diffuse ray escapes to the glow: not even noise.
    let ball = ball("void plastic stuff 0 0 5 .7 .5 .2 0 0");
    assert_close(ball.pixel(EVERYTHING, endless(4)), Rgb::new(0.7, 0.5, 0.2), 1e-6);
    assert_close(ball.pixel("D", endless(4)), Rgb::new(0.7, 0.5, 0.2), 1e-6);
    assert_eq!(ball.pixel("", endless(4)), Rgb::ZERO);
    assert_eq!(ball.pixel("S", endless(4)), Rgb::ZERO);
}

#[test]
fn gloss_and_colour_share_the_light() {
    let rough = ball("void plastic stuff 0 0 5 .7 .5 .2 .1 .2");
    let diffuse = Rgb::new(0.7, 0.5, 0.2) * 0.9;
    assert_close(rough.pixel(EVERYTHING, endless(4)), diffuse + Rgb::splat(0.1), 1e-6);
    assert_close(rough.pixel("G", endless(4)), Rgb::splat(0.1), 1e-6);
    assert_close(rough.pixel("D", endless(4)), diffuse, 1e-6);

    let smooth = ball("void metal stuff 0 0 5 .7 .5 .2 .9 0");
    let fresnel = (-5.85_f64).exp() - FRESNEL_OFFSET;
    let specular = Rgb::new(0.7, 0.5, 0.2) * (0.9 * (1.0 - fresnel)) + Rgb::splat(fresnel);
    assert_close(smooth.pixel("S", endless(1)), specular, 1e-5);
    let diffuse = Rgb::new(0.7, 0.5, 0.2) * (0.1 * (1.0 - fresnel));
    assert_close(smooth.pixel(EVERYTHING, endless(1)), specular + diffuse, 1e-5);
}

#[test]
fn a_clear_dielectric_disappears() {
    // What is reflected, inside and outside, and what is refracted, n^2 in and 1/n^2 out, add up to what is behind.
    let ball = ball("void dielectric stuff 0 0 5 1 1 1 1.5 0");
    assert_close(ball.pixel(EVERYTHING, endless(1)), Rgb::ONE, 1e-6);
    // Seen head on: R off the front; two passages of T; k reflections inside between them.
    let r: f64 = 0.04;
    assert_close(ball.pixel("R", endless(1)), Rgb::splat(r), 1e-3);
    assert_close(ball.pixel("TT", endless(1)), Rgb::splat((1.0 - r).powi(2)), 1e-3);
    assert_close(ball.pixel("T2", endless(1)), Rgb::splat((1.0 - r).powi(2)), 1e-3);
    assert_eq!(ball.pixel("T", endless(1)), Rgb::ZERO);
    // TRT spells the words R, TT and TRT.
    let expected = r + (1.0 - r).powi(2) * (1.0 + r);
    assert_close(ball.pixel("TRT", endless(1)), Rgb::splat(expected), 1e-4);
}

#[test]
fn a_dielectric_absorbs_along_the_way() {
    // Transmission .5 per unit of length, seen along the diameter of 2: the straight way keeps .25 of (1 - R)^2, the
    // next one, reflected once inside, .0625 of it times R.
    let ball = ball("void dielectric stuff 0 0 5 .5 .5 .5 1.5 0");
    let through = 0.96_f64.powi(2);
    assert_close(ball.pixel("TT", endless(1)), Rgb::splat(through * 0.25), 1e-3);
    let expected = 0.04 + through * (0.25 + 0.04 * 0.0625);
    assert_close(ball.pixel("TRT", endless(1)), Rgb::splat(expected), 1e-4);
}

#[test]
fn a_hollow_ball_of_clear_glass_disappears() {
    let ball = ball("void glass stuff 0 0 3 1 1 1");
    assert_close(ball.pixel(EVERYTHING, endless(1)), Rgb::ONE, 1e-6);
}

#[test]
fn trans_divides_light_between_its_sides() {
    // A sheet that fills the view, in the same surroundings on both sides.
    let sheet = |reals: &str| {
        let text = format!(
            "void trans stuff 0 0 7 {reals}\nvoid glow white 0 0 4 1 1 1 0\nwhite source sky 0 0 4 0 0 1 360\nstuff polygon sheet 0 0 12 -9 0 -9 9 0 -9 9 0 9 -9 0 9\n"
        );
        Stage::new(&text, [0.0, -5.0, 0.0], [0.0, 1.0, 0.0], 0.01)
    };
    let smooth = sheet(".8 .8 .8 0 0 .6 .5");
    assert_close(smooth.pixel("T", endless(1)), Rgb::splat(0.8 * 0.3), 1e-6);
    assert_close(smooth.pixel("D", endless(4)), Rgb::splat(0.8 * 0.7), 1e-6);
    assert_close(smooth.pixel(EVERYTHING, endless(4)), Rgb::splat(0.8), 1e-6);
    let rough = sheet(".8 .8 .8 .1 .1 .6 .5");
    assert_close(rough.pixel("G", endless(4)), Rgb::splat(0.1 + 0.8 * 0.9 * 0.3), 1e-6);
    assert_close(rough.pixel(EVERYTHING, endless(4)), Rgb::splat(0.1 + 0.8 * 0.9), 1e-6);
}

#[test]
fn the_ambient_value_stands_for_what_has_not_run() {
    // Inside a closed matt room of albedo a without lights everything is the estimate: a x av before any D, and after k
    // runs of D, whose rays all meet the wall again, a^(k+1) x av.
    let room = Stage::new(
        "void plastic wall 0 0 5 .5 .6 .7 0 0\nwall bubble room 0 0 4 0 0 0 3\n",
        [0.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        60.0,
    );
    let albedo = Rgb::new(0.5, 0.6, 0.7);
    let mut settings = endless(4);
    settings.ambient = Rgb::new(2.0, 1.0, 0.5);
    let value = settings.ambient;
    for (crex, power) in [("", 1.0), ("T", 1.0), ("D", 2.0), ("D3", 4.0), ("<DD>", 2.0), ("<D>2", 3.0)] {
        assert_close(room.pixel(crex, settings.clone()), albedo.powf(power) * value, 1e-6);
    }
    // What `-ab` refuses keeps its estimate, as in rpict's last bounce; and so does what `-lr` refuses.
    settings.limits.diffuse = Some(2);
    assert_close(room.pixel("D*", settings.clone()), albedo.powf(3.0) * value, 1e-6);
    settings.limits.diffuse = None;
    settings.limits.reflections = 3;
    assert_close(room.pixel("D*", settings.clone()), albedo.powf(4.0) * value, 1e-6);
    // Several rays for each hit share the ripple.
    settings.limits.diffuse_rays = 5;
    assert_close(room.pixel("D2", settings), albedo.powf(3.0) * value, 1e-6);
}
