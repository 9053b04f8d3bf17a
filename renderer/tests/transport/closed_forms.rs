//! Direct light, media, mirrors and the rules against counting light twice, on scenes whose answer is known.

use std::f64::consts::PI;

use renderer::color::Rgb;

use crate::{Stage, assert_close, endless};

/// A matt floor of reflectance .5 at z = 0 that is looked at from one unit above, at the origin, and whatever else.
fn floor(more: &str) -> Stage {
    let text = format!(
        "void plastic matt 0 0 5 .5 .5 .5 0 0\nmatt polygon floor 0 0 12 -9 -9 0 9 -9 0 9 9 0 -9 9 0\n{more}\n"
    );
    // A little off the vertical, so that nothing above the floor is in the way.
    Stage::new(&text, [0.0, -1.0, 0.2], [0.0, 1.0, -0.2], 1e-4)
}

/// Irradiance over radiance under the corner of an a x b rectangle, parallel to the surface at height 1 (configuration
/// factor of a differential element to a parallel rectangle; Howell's catalogue, B-3) times pi.
fn corner_irradiance(a: f64, b: f64) -> f64 {
    let (x, y) = ((1.0 + a * a).sqrt(), (1.0 + b * b).sqrt());
    0.5 * (a / x * (b / x).atan() + b / y * (a / y).atan())
}

const LAMP: &str = "void light lamp 0 0 3 4 2 1\nlamp polygon l 0 0 12 -1 -1 1 -1 1 1 1 1 1 1 -1 1\n";

#[test]
fn a_square_lamp_gives_its_form_factor() {
    let scene = floor(LAMP);
    let expected = Rgb::new(4.0, 2.0, 1.0) * (0.5 / PI * 4.0 * corner_irradiance(1.0, 1.0));
    // 4096 stratified samples: the error of the mean is far below the deviation of one, .3, over 64.
    assert_close(scene.pixel("", endless(4096)), expected, 2e-3);
}

#[test]
fn a_round_sky_gives_the_square_of_its_sine() {
    // A uniform cap of half angle a around the zenith: irradiance pi L sin^2 a.
    let scene = floor("void light sun 0 0 3 1 1 1\nsun source s 0 0 4 0 0 1 60\n");
    assert_close(scene.pixel("", endless(1024)), Rgb::splat(0.5 * 0.25), 1e-3);
    // A sphere above looks like such a cap: sine = radius over distance.
    let scene = floor("void light lamp 0 0 3 9 9 9\nlamp sphere l 0 0 4 0 0 3 .5\n");
    assert_close(scene.pixel("", endless(1024)), Rgb::splat(0.5 * 9.0 / 36.0), 1e-3);
}

#[test]
fn a_pane_dims_a_lamp_by_its_transmittance() {
    // A small lamp overhead, so that all its light meets the pane head on.
    let lamp = "void light lamp 0 0 3 100 100 100\nlamp sphere l 0 0 4 0 0 4 .01\n";
    let clear = floor(lamp).pixel("", endless(16));
    let pane = "void glass pane 0 0 3 .96 .96 .96\npane polygon p 0 0 12 -1 -1 2 1 -1 2 1 1 2 -1 1 2\n";
    let dimmed = floor(&format!("{lamp}{pane}")).pixel("", endless(16));
    // Transmissivity .96 at index 1.52 by the formula of the manual, for a single polarisation at normal incidence.
    let r = (0.52_f64 / 2.52).powi(2);
    let transmittance = (1.0 - r).powi(2) * 0.96 / (1.0 - (r * 0.96).powi(2));
    assert_close(dimmed, clear * transmittance, 1e-5);
    let sheet = "void trans sheet 0 0 7 .9 .8 .7 0 0 .5 .6\nsheet polygon p 0 0 12 -1 -1 2 1 -1 2 1 1 2 -1 1 2\n";
    let through = floor(&format!("{lamp}{sheet}")).pixel("", endless(16));
    assert_close(through, clear * Rgb::new(0.9, 0.8, 0.7) * 0.3, 1e-5);
    let wall = "matt polygon p 0 0 12 -1 -1 2 1 -1 2 1 1 2 -1 1 2\n";
    assert_eq!(floor(&format!("{lamp}{wall}")).pixel("", endless(16)), Rgb::ZERO);
    // Void is no obstacle.
    let nothing = "void polygon p 0 0 12 -1 -1 2 1 -1 2 1 1 2 -1 1 2\n";
    assert_close(floor(&format!("{lamp}{nothing}")).pixel("", endless(16)), clear, 1e-9);
}

#[test]
fn a_slab_bends_shadow_rays_and_absorbs() {
    // A slab of thickness 1 over the floor: shadow rays leave it parallel, so of a wide lamp nearly nothing is missed;
    // what passes is (1 - R)^2, twice refracted, times what the glass absorbs.
    let sun = "void light sun 0 0 3 1 1 1\nsun source s 0 0 4 0 0 1 2\n";
    let open = floor(sun).pixel("", endless(64));
    let slab = "void dielectric glass 0 0 5 .5 .6 .7 1.5 0\n\
        glass polygon top 0 0 12 -8 -8 3 8 -8 3 8 8 3 -8 8 3\n\
        glass polygon bottom 0 0 12 -8 -8 2 -8 8 2 8 8 2 8 -8 2\n";
    let dimmed = floor(&format!("{sun}{slab}")).pixel("", endless(64));
    assert_close(dimmed, open * Rgb::new(0.5, 0.6, 0.7) * 0.96_f64.powi(2), 2e-3);
}

#[test]
fn a_mirror_lights_like_the_lamp_behind_it() {
    // A mirror at x = 2 shows the lamp at x = 1 as one at x = 3.
    let lamp = |x: f64| format!("lamp sphere l{x} 0 0 4 {x} 0 1 .3\n");
    let light = "void light lamp 0 0 3 5 5 5\n";
    let silver = "void mirror silver 0 0 3 .8 .7 .6\nsilver polygon m 0 0 12 2 -9 0 2 -9 9 2 9 9 2 9 0\n";
    let alone = floor(&format!("{light}{}", lamp(1.0))).pixel("", endless(1024));
    let image = floor(&format!("{light}{}", lamp(3.0))).pixel("", endless(1024));
    let relayed = floor(&format!("{light}{}{silver}", lamp(1.0))).pixel("", endless(1024));
    assert_close(relayed, alone + image * Rgb::new(0.8, 0.7, 0.6), 2e-3);
    // What is in the way of the reflected light shadows it: a wall between mirror and floor, but not between lamp and
    // floor.
    let wall = "matt polygon w 0 0 12 1.6 -9 0 1.6 9 0 1.6 9 9 1.6 -9 9\n";
    let shadowed = floor(&format!("{light}{}{silver}{wall}", lamp(1.0))).pixel("", endless(1024));
    assert_close(shadowed, alone, 1e-6);
}

#[test]
fn mirrors_show_what_stands_before_them() {
    // From the origin a mirror at y = 2 shows the front of the lamp behind the eye, which faces it, and nothing of a
    // lamp that faces away.
    let mirror = "void mirror silver 0 0 3 .9 .8 .7\nsilver polygon m 0 0 12 -9 2 -9 9 2 -9 9 2 9 -9 2 9\n";
    let facing =
        format!("{mirror}void light lamp 0 0 3 3 2 1\nlamp polygon l 0 0 12 -9 -1 -9 -9 -1 9 9 -1 9 9 -1 -9\n");
    let averted =
        format!("{mirror}void light lamp 0 0 3 3 2 1\nlamp polygon l 0 0 12 -9 -1 -9 9 -1 -9 9 -1 9 -9 -1 9\n");
    let view = |text: &str| Stage::new(text, [0.0, 0.0, 0.0], [0.0, 1.0, 0.0], 1.0);
    assert_close(view(&facing).pixel("M", endless(1)), Rgb::new(2.7, 1.6, 0.7), 1e-6);
    assert_eq!(view(&facing).pixel("", endless(1)), Rgb::ZERO);
    assert_eq!(view(&averted).pixel("M", endless(1)), Rgb::ZERO);
    // Behind, a mirror is black.
    let back = Stage::new(&facing, [0.0, 5.0, 0.0], [0.0, -1.0, 0.0], 1.0);
    assert_eq!(back.pixel("M", endless(1)), Rgb::ZERO);
}

#[test]
fn light_is_counted_once() {
    // A matt speck, a mirror overhead, and a dome of light that diffuse rays meet, directly or by the mirror. None of
    // it counts, for direct light has sampled the dome where the diffuse ray starts. The mirror is curved, so it relays
    // no light.
    let text = "void plastic matt 0 0 5 .5 .5 .5 0 0\n\
        matt polygon speck 0 0 12 -.001 -.001 0 .001 -.001 0 .001 .001 0 -.001 .001 0\n\
        void light lamp 0 0 3 1 1 1\nlamp bubble dome 0 0 4 0 0 0 5\n\
        void mirror silver 0 0 3 1 1 1\nsilver sphere m 0 0 4 0 0 3 1\n";
    let scene = Stage::new(text, [0.0, -1.0, 0.2], [0.0, 1.0, -0.2], 1e-4);
    let direct = scene.pixel("", endless(256));
    // The mirror, of sine 1/3, hides a ninth of the dome's irradiance.
    assert_close(direct, Rgb::splat(0.5 * 8.0 / 9.0), 0.02);
    for crex in ["D", "DM", "(TRSGMD)*"] {
        assert_close(scene.pixel(crex, endless(256)), direct, 1e-6);
    }
    assert!(scene.render("DM", endless(256)).stages[1].report.rays > 10);
    // A glow beyond its radius is no lamp but surroundings: diffuse rays see it, direct light does not, and the sum is
    // the same at any radius: half the sky's radiance.
    for radius in [1.0, 4.9, 5.1, 100.0] {
        let glow = format!("void glow g 0 0 4 1 1 1 {radius}\ng bubble dome 0 0 4 0 0 0 5\n");
        let mut settings = endless(4096);
        settings.limits.diffuse = Some(1);
        assert_close(floor(&glow).pixel("D", settings), Rgb::splat(0.5), 5e-3);
    }
}

#[test]
fn illum_shines_but_is_not_seen() {
    // A window that shines down on the floor; through it the eye sees the glow behind, or the pane that stands for it.
    let illum = |alternate: &str| {
        format!(
            "void glass pane 0 0 3 .96 .96 .96\nvoid illum window {alternate} 0 3 2 2 2\n\
            window polygon w 0 0 12 -1 -1 1 -1 1 1 1 1 1 1 -1 1\n"
        )
    };
    let lit = floor(&illum("0")).pixel("", endless(4096));
    assert_close(lit, Rgb::splat(2.0 * 0.5 / PI * 4.0 * corner_irradiance(1.0, 1.0)), 2e-3);
    // Diffuse rays meet it without counting its light again.
    assert_close(floor(&illum("0")).pixel("D", endless(4096)), lit, 1e-6);
    let sky = "void glow sky 0 0 4 3 3 3 0\nsky source s 0 0 4 0 0 1 180\n";
    let upward =
        |alternate: &str| Stage::new(&format!("{}{sky}", illum(alternate)), [0.0, 0.0, 0.0], [0.0, 0.0, 1.0], 1.0);
    assert_close(upward("0").pixel("", endless(1)), Rgb::splat(3.0), 1e-6);
    assert_close(upward("1 void").pixel("", endless(1)), Rgb::splat(3.0), 1e-6);
    assert_eq!(upward("1 pane").pixel("", endless(1)), Rgb::ZERO);
    let r = (0.52_f64 / 2.52).powi(2);
    let transmittance = (1.0 - r).powi(2) * 0.96 / (1.0 - (r * 0.96).powi(2));
    assert_close(upward("1 pane").pixel("T", endless(1)), Rgb::splat(3.0 * transmittance), 1e-4);
}

#[test]
fn a_mirror_with_another_material_is_that_to_the_eye() {
    let text = "void plastic red 0 0 5 .6 .1 .1 0 0\nvoid mirror blind 1 red 0 3 .9 .9 .9\n\
        blind polygon m 0 0 12 -1 2 -1 -1 2 1 1 2 1 1 2 -1\n\
        void light lamp 0 0 3 50 50 50\nlamp sphere l 0 0 4 0 -2 0 .1\n";
    let scene = Stage::new(text, [0.3, 0.0, 0.0], [0.0, 1.0, 0.0], 1.0);
    let seen = scene.pixel("M", endless(64));
    assert!(seen.x > 0.0 && (seen.x / seen.y - 6.0).abs() < 1e-6, "{seen}");
    let rendering = scene.render("M", endless(64));
    assert_eq!(rendering.stages[0].report.rays, 0);
}
