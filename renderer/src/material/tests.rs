//! Materials against closed forms: furnaces, integrals of lobes, Fresnel's and Snell's laws, the rules of emitters.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::DVec3;
use proptest::prelude::*;

use super::*;
use crate::color::Rgb;
use crate::math::warp;
use crate::sample::{PathKey, Sampler};

/// A ray that meets a floor (normal +z) at an angle of incidence in radians, from above or from below.
fn meeting(angle: f64, from_above: bool) -> Interaction {
    let down = if from_above { -angle.cos() } else { angle.cos() };
    Interaction::new(DVec3::new(angle.sin(), 0.0, down), DVec3::Z)
}

fn lobes(material: &Material, interaction: Interaction, threshold: f64) -> Vec<Lobe> {
    let mut lobes = Vec::new();
    material.scatter(interaction, threshold, |lobe| lobes.push(lobe));
    lobes
}

/// Radiance that comes back from a surface in a furnace of radiance 1: the sum of its lobes.
fn furnace(material: &Material, interaction: Interaction) -> Rgb {
    lobes(material, interaction, 0.0).iter().map(|lobe| lobe.coefficient).sum()
}

fn close(a: Rgb, b: Rgb, tolerance: f64) -> bool {
    (a - b).abs().max_element() <= tolerance
}

/// Mean over the sphere of directions by a midpoint rule, uniform in z and azimuth, times 4 pi.
fn over_sphere(n: usize, mut f: impl FnMut(DVec3) -> f64) -> f64 {
    let mut sum = 0.0;
    for i in 0..n {
        for j in 0..2 * n {
            let u = [(i as f64 + 0.5) / n as f64, (j as f64 + 0.5) / (2 * n) as f64];
            sum += f(warp::sphere(u));
        }
    }
    sum * 4.0 * PI / (2 * n * n) as f64
}

/// Smooth, or rough by any amount.
fn roughness() -> impl Strategy<Value = f64> {
    prop_oneof![Just(0.0), 0.002..0.5_f64]
}

proptest! {
    /// What is not specular is coloured diffuse; a furnace gives back rspec + colour x (1 - rspec).
    #[test]
    fn plastic_in_a_furnace(
        spec in 0.0..=1.0_f64, rough in roughness(), color in 0.0..=1.0_f64, angle in 0.0..1.5_f64, above: bool,
    ) {
        let plastic = Plastic::from_reals(&[color, 0.5, 1.0, spec, rough]).unwrap();
        let fresnel = if rough == 0.0 && spec >= 0.018 { (-5.85 * angle.cos()).exp() - FRESNEL_OFFSET } else { 0.0 };
        let gloss = spec + fresnel * (1.0 - spec);
        let expected = Rgb::new(color, 0.5, 1.0) * (1.0 - gloss) + Rgb::splat(gloss);
        prop_assert!(close(furnace(&Material::Plastic(plastic), meeting(angle, above)), expected, 2e-6));
    }

    /// A white metal gives everything back; a coloured one is white only where Fresnel adds to it.
    #[test]
    fn metal_in_a_furnace(spec in 0.0..=1.0_f64, rough in roughness(), angle in 0.0..1.5_f64) {
        let white = Metal::from_reals(&[1.0, 1.0, 1.0, spec, rough]).unwrap();
        prop_assert!(close(furnace(&Material::Metal(white), meeting(angle, true)), Rgb::ONE, 2e-6));
        let fresnel = if rough == 0.0 && spec >= 0.018 { (-5.85 * angle.cos()).exp() - FRESNEL_OFFSET } else { 0.0 };
        let black = Metal::from_reals(&[0.0, 0.0, 0.0, spec, rough]).unwrap();
        prop_assert!(close(furnace(&Material::Metal(black), meeting(angle, true)), Rgb::splat(fresnel), 2e-6));
    }

    /// Trans divides what its gloss leaves between both sides and loses only what its colour takes.
    #[test]
    fn trans_in_a_furnace(
        spec in 0.0..=1.0_f64, rough in roughness(), trans in 0.0..=1.0_f64, share in 0.0..=1.0_f64,
        angle in 0.0..1.5_f64, above: bool,
    ) {
        let reals = |color| [color, color, color, spec, rough, trans, share];
        let sheet = |color| Material::Trans(Trans::from_reals(&reals(color)).unwrap());
        prop_assert!(close(furnace(&sheet(1.0), meeting(angle, above)), Rgb::ONE, 4e-6));
        let gloss = furnace(&sheet(0.0), meeting(angle, above));
        prop_assert!(close(furnace(&sheet(0.25), meeting(angle, above)), gloss + (Rgb::ONE - gloss) * 0.25, 4e-6));
    }

    /// A pane that absorbs nothing passes what it does not reflect, at every angle and index.
    #[test]
    fn clear_glass_in_a_furnace(index in 1.0..3.0_f64, angle in 0.0..1.57_f64) {
        let pane = Material::Glass(Glass::from_reals(&[1.0, 1.0, 1.0, index]).unwrap());
        prop_assert!(close(furnace(&pane, meeting(angle, true)), Rgb::ONE, 1e-12));
    }

    /// In a solid of index n at equilibrium radiance is n^2: entering light gains n^2, so reflection + refraction / n^2
    /// = 1 from outside, and reflection + refraction x n^2 = 1 from inside, where the furnace is n^2 times weaker
    /// beyond.
    #[test]
    fn dielectric_in_a_furnace(index in 1.01..3.0_f64, angle in 0.0..1.57_f64, outside: bool) {
        let solid = Material::Dielectric(Dielectric::from_reals(&[0.5, 0.5, 0.5, index, 0.0]).unwrap());
        let ratio2 = if outside { index * index } else { 1.0 / (index * index) };
        let sum: f64 = lobes(&solid, meeting(angle, outside), 0.0)
            .iter()
            .map(|lobe| lobe.coefficient.x * if lobe.event == Event::Refraction { ratio2 } else { 1.0 })
            .sum();
        prop_assert!((sum - 1.0).abs() < 1e-12);
    }

    /// Snell's law and reversibility: light that enters and leaves by the same angle goes on as it came, and what
    /// remains of it is (1 - R)^2.
    #[test]
    fn refraction_is_reversible(index in 1.01..3.0_f64, angle in 0.0..1.5_f64) {
        let solid = Dielectric::from_reals(&[1.0, 1.0, 1.0, index, 0.0]).unwrap();
        let enters = meeting(angle, true);
        let (inside, gain, _) = solid.shadow(&enters).unwrap();
        prop_assert!((enters.incoming.x - index * inside.x).abs() < 1e-12);
        let (outside, loss, _) = solid.shadow(&Interaction::new(inside, -DVec3::Z)).unwrap();
        prop_assert!((outside - enters.incoming).length() < 1e-6);
        let reflected = lobes(&Material::Dielectric(solid), enters, 0.0)[1].coefficient.x;
        prop_assert!((gain * loss - (1.0 - reflected).powi(2)).abs() < 1e-9);
    }

    #[test]
    fn ideal_reflection_obeys_its_law(angle in 0.0..1.57_f64, above: bool) {
        let interaction = meeting(angle, above);
        let out = interaction.reflected();
        prop_assert!((out.dot(interaction.normal) + interaction.incoming.dot(interaction.normal)).abs() < 1e-15);
        prop_assert!((out.cross(interaction.normal) - interaction.incoming.cross(interaction.normal)).length() < 1e-15);
    }

    /// Every direction drawn is a unit vector on the lobe's side.
    #[test]
    fn directions_keep_their_side(angle in 0.0..1.55_f64, rough in 0.01..0.6_f64, seed: u64, sample: u32) {
        let sheet = Material::Trans(Trans::from_reals(&[0.5, 0.5, 0.5, 0.2, rough, 0.5, 0.5]).unwrap());
        let interaction = meeting(angle, true);
        let sampler = Sampler::new(seed, 0, PathKey::EYE, sample);
        for weighted in [false, true] {
            for lobe in lobes(&sheet, interaction, 0.0) {
                let glossy = GlossySampling { width: 1.0, weighted };
                if let Some((direction, weight)) = lobe.spread.direction(glossy, |trial| sampler.pair(trial)) {
                    prop_assert!((direction.length() - 1.0).abs() < 1e-12);
                    prop_assert!(weight.is_finite() && weight >= 0.0);
                    let side = if lobe.event.is_transmission() { -1.0 } else { 1.0 };
                    prop_assert!(direction.dot(interaction.normal) * side >= 0.0);
                }
            }
        }
    }
}

#[test]
fn fresnel_at_known_angles() {
    // Glass of index 1.5 reflects 4 % head on, nothing of the parallel part at Brewster's angle, all at grazing
    // incidence.
    let solid = |index| Dielectric::from_reals(&[1.0, 1.0, 1.0, index, 0.0]).unwrap();
    let reflected = |index: f64, angle: f64, above| {
        let found = lobes(&Material::Dielectric(solid(index)), meeting(angle, above), 0.0);
        found.iter().find(|lobe| lobe.event == Event::BoundaryReflection).unwrap().coefficient.x
    };
    assert!((reflected(1.5, 0.0, true) - 0.04).abs() < 1e-12);
    assert!((reflected(1.5, 0.0, false) - 0.04).abs() < 1e-12);
    let brewster = 1.5_f64.atan();
    // There the perpendicular part is ((n^2 - 1)/(n^2 + 1))^2, and half of the light has it.
    assert!((reflected(1.5, brewster, true) - 0.5 * (1.25_f64 / 3.25).powi(2)).abs() < 1e-12);
    assert!(reflected(1.5, FRAC_PI_2 - 1e-4, true) > 0.98);
    // Total internal reflection beyond the critical angle, and not before it.
    let critical = (1.0 / 1.5_f64).asin();
    assert_eq!(reflected(1.5, critical + 1e-3, false), 1.0);
    assert_eq!(lobes(&Material::Dielectric(solid(1.5)), meeting(critical + 1e-3, false), 0.0).len(), 1);
    assert!(reflected(1.5, critical - 1e-3, false) < 0.9);
    // Index 1 does not exist to light.
    assert!(lobes(&Material::Dielectric(solid(1.0)), meeting(0.7, true), 0.0).len() == 1);
}

#[test]
fn a_pane_of_88_percent_transmittance_has_transmissivity_96() {
    // The conversion in the Radiance reference manual (`glass`), for index 1.52 at normal incidence.
    let transmittance: f64 = 0.88;
    let transmissivity = ((0.840_252_843_5 + 0.007_252_223_9 * transmittance * transmittance).sqrt() - 0.916_653_066_1)
        / 0.003_626_111_9
        / transmittance;
    assert!((transmissivity - 0.96).abs() < 2e-3);
    let pane = Glass::from_reals(&[transmissivity; 3]).unwrap();
    assert!((pane.shadow(&meeting(0.0, true)).x - transmittance).abs() < 1e-6);
    // Black panes pass nothing, and a shadow behind them is whole.
    assert_eq!(Glass::from_reals(&[0.0; 3]).unwrap().shadow(&meeting(0.3, true)), Rgb::ZERO);
}

#[test]
fn a_uniform_sky_as_light_gives_the_diffuse_albedo() {
    // The direct coefficient of a matt surface, integrated over all directions, is its reflectance and its
    // transmittance.
    let sheet = Trans::from_reals(&[0.8, 0.8, 0.8, 0.0, 0.0, 0.25, 0.0]).unwrap();
    let response = sheet.respond(meeting(0.4, true));
    let above = over_sphere(64, |l| if l.z > 0.0 { response.direct(l, 1.0).x } else { 0.0 });
    let below = over_sphere(64, |l| if l.z < 0.0 { response.direct(l, 1.0).x } else { 0.0 });
    assert!((above - 0.8 * 0.75).abs() < 1e-3, "{above}");
    assert!((below - 0.8 * 0.25).abs() < 1e-3, "{below}");
}

/// White rough metal (alpha .3) under a uniform white dome: rpict (RADIANCE 6.0a, `-ss 64`) returns .91, .87, .79 and
/// .82 at 0, 45, 70 and 85 degrees. The direct term, integrated over the dome, and the weighted samples must both
/// agree.
#[test]
fn the_rough_lobe_and_its_samples_have_one_albedo() {
    let metal = Metal::from_reals(&[1.0, 1.0, 1.0, 1.0, 0.3]).unwrap();
    for (degrees, measured) in [(0.0, 0.91), (45.0, 0.87), (70.0, 0.79), (85.0, 0.82)] {
        let interaction = meeting(f64::to_radians(degrees), true);
        let response = metal.respond(interaction);
        let integrated = over_sphere(512, |l| response.direct(l, 1.0).x);
        assert!((integrated - measured).abs() < 0.011, "{degrees}: {integrated}");
        let [lobe] = lobes(&Material::Metal(metal), interaction, 0.0)[..] else { panic!("one lobe") };
        let mean = |weighted, f: &dyn Fn(DVec3, f64) -> f64| {
            let n = 1 << 14;
            let glossy = GlossySampling { width: 1.0, weighted };
            let drawn = |sample| {
                let sampler = Sampler::new(0, 0, PathKey::EYE, sample);
                lobe.spread.direction(glossy, |trial| sampler.pair(trial))
            };
            (0..n).filter_map(drawn).map(|(direction, weight)| f(direction, weight)).sum::<f64>() / f64::from(n)
        };
        assert!((mean(true, &|_, weight| weight) - integrated).abs() < 2e-3, "{degrees}");
        // The same for a moment that tells directions apart, not only their number.
        let moment = over_sphere(512, |l| response.direct(l, 1.0).x * l.x);
        assert!((mean(true, &|direction, weight| weight * direction.x) - moment).abs() < 2e-3, "{degrees}");
        // Without weights every direction counts in full: albedo 1, which `-ss 1` converges to.
        assert!((mean(false, &|_, weight| weight) - 1.0).abs() < 1e-3, "{degrees}");
    }
}

#[test]
fn half_vectors_spread_by_alpha() {
    // tan^2 of the angle between half vector and normal is exponential with mean alpha^2.
    let alpha = 0.1;
    let metal = Material::Metal(Metal::from_reals(&[1.0, 1.0, 1.0, 1.0, alpha]).unwrap());
    let interaction = meeting(0.2, true);
    let [lobe] = lobes(&metal, interaction, 0.0)[..] else { panic!("one lobe") };
    let n = 1 << 12;
    let mean = (0..n)
        .filter_map(|sample| {
            let sampler = Sampler::new(9, 0, PathKey::EYE, sample);
            lobe.spread.direction(GlossySampling { width: 1.0, weighted: false }, |trial| sampler.pair(trial))
        })
        .map(|(direction, _)| {
            let half = direction - interaction.incoming;
            half.truncate().length_squared() / (half.z * half.z)
        })
        .sum::<f64>()
        / f64::from(n);
    assert!((mean / (alpha * alpha) - 1.0).abs() < 5e-3, "{mean}");
    // Width 0 leaves the ideal direction (rpict: `-ss 0`).
    let (direction, _) = lobe.spread.direction(GlossySampling { width: 0.0, weighted: false }, |_| [0.3, 0.9]).unwrap();
    assert!((direction - interaction.reflected()).length() < 1e-6);
}

#[test]
fn the_transmitted_lobe_passes_its_share() {
    // Seen head on, a lobe of width a lies beyond the surface; with x = 1 - cos its integral is E sqrt(1 - x), x
    // exponential of mean a^2/2: 1 - a^2/4 - a^4/16 to second order.
    let (width, share): (f64, f64) = (0.2, 0.9 * 0.3);
    let sheet = Trans::from_reals(&[0.9, 0.9, 0.9, 0.0, width, 0.6, 0.5]).unwrap();
    let response = sheet.respond(meeting(0.0, true));
    // The midpoint rule is off by (step .002 over the lobe's .02)^2 / 24 of the share: 1.1e-4.
    let whole = over_sphere(1024, |l| response.direct(l, 1.0).x);
    let diffuse = 0.9 * (0.4 + 0.3);
    let passed = share * (1.0 - width.powi(2) / 4.0 - width.powi(4) / 16.0);
    assert!((whole - diffuse - passed).abs() < 2e-4, "{whole} for {}", diffuse + passed);
    // A rough sheet stops shadow rays, a smooth one passes its straight share.
    assert_eq!(sheet.shadow(&meeting(0.0, true)), Rgb::ZERO);
    let clear = Trans::from_reals(&[0.9, 0.9, 0.9, 0.0, 0.0, 0.6, 0.5]).unwrap();
    assert!(close(clear.shadow(&meeting(0.3, true)), Rgb::splat(0.9 * 0.3), 1e-12));
}

#[test]
fn smooth_gloss_takes_from_the_direct_light_that_it_reflects() {
    // Radiance: the diffuse part of a smooth surface is dimmed by Fresnel at the light's own angle.
    let plastic = Plastic::from_reals(&[0.5, 0.5, 0.5, 0.04, 0.0]).unwrap();
    let response = plastic.respond(meeting(0.0, true));
    let gloss = 0.04 + (f64::exp(-5.85) - FRESNEL_OFFSET) * 0.96;
    for angle in [0.1_f64, 0.8, 1.4] {
        let light = DVec3::new(angle.sin(), 0.0, angle.cos());
        let entering = 1.0 - ((-5.85 * angle.cos()).exp() - FRESNEL_OFFSET);
        let expected = 0.5 * (1.0 - gloss) * entering * angle.cos() * 0.01 / PI;
        assert!((response.direct(light, 0.01).x - expected).abs() < 1e-15);
    }
    assert_eq!(response.direct(-DVec3::Z, 0.01), Rgb::ZERO);
}

#[test]
fn events_file_by_the_table() {
    let table = [
        (Event::DiffuseReflection, 'D', true),
        (Event::DiffuseTransmission, 'D', false),
        (Event::SmoothReflection, 'S', true),
        (Event::SmoothTransmission, 'T', false),
        (Event::RoughReflection, 'G', true),
        (Event::RoughTransmission, 'G', false),
        (Event::PaneTransmission, 'T', false),
        (Event::PaneReflection, 'R', true),
        (Event::Refraction, 'T', false),
        (Event::BoundaryReflection, 'R', true),
        (Event::MirrorReflection, 'M', true),
    ];
    for (event, letter, counted) in table {
        assert_eq!(Component::of(event).letter(), letter, "{event:?}");
        assert_eq!(event.counts_as_reflection(), counted, "{event:?}");
        assert_eq!(event.is_spread(), matches!(letter, 'D' | 'G'), "{event:?}");
    }
}

#[test]
fn materials_spawn_their_components() {
    let set = |material: &Material, threshold| {
        material.components(threshold).iter().map(Component::letter).collect::<String>()
    };
    let plastic = |reals: &[f64]| Material::Plastic(Plastic::from_reals(reals).unwrap());
    assert_eq!(set(&plastic(&[0.7, 0.7, 0.7, 0.0, 0.0]), 0.0), "D");
    assert_eq!(set(&plastic(&[0.7, 0.7, 0.7, 0.04, 0.0]), 0.15), "DS");
    assert_eq!(set(&plastic(&[0.7, 0.7, 0.7, 0.04, 0.1]), 0.0), "DG");
    // `-st` .15, rpict's default, leaves a plastic's gloss to the diffuse rays.
    assert_eq!(set(&plastic(&[0.7, 0.7, 0.7, 0.04, 0.1]), 0.15), "D");
    assert_eq!(set(&plastic(&[0.0, 0.0, 0.0, 0.0, 0.0]), 0.0), "");
    let trans = Material::Trans(Trans::from_reals(&[0.9, 0.9, 0.9, 0.04, 0.0, 0.7, 0.5]).unwrap());
    assert_eq!(set(&trans, 0.0), "DST");
    assert_eq!(set(&Material::Glass(Glass::from_reals(&[0.9; 3]).unwrap()), 0.0), "TR");
    let solid = Dielectric::from_reals(&[0.9, 0.9, 0.9, 1.5, 0.0]).unwrap();
    assert_eq!(set(&Material::Dielectric(solid), 0.0), "TR");
    let mirror = Mirror::from_reals(&[0.9; 3], Alternate::None).unwrap();
    assert_eq!(set(&Material::Mirror(mirror), 0.0), "M");
    assert_eq!(set(&Material::Emitter(Emitter::light(&[1.0; 3]).unwrap()), 0.0), "");
}

#[test]
fn a_lobe_under_the_threshold_joins_the_diffuse_one() {
    let plastic = Material::Plastic(Plastic::from_reals(&[0.5, 0.5, 0.5, 0.04, 0.1]).unwrap());
    let interaction = meeting(0.3, true);
    assert_eq!(lobes(&plastic, interaction, 0.03).len(), 2);
    let [diffuse] = lobes(&plastic, interaction, 0.04)[..] else { panic!("one lobe") };
    assert_eq!(diffuse.event, Event::DiffuseReflection);
    assert!((diffuse.coefficient.x - (0.5 * 0.96 + 0.04)).abs() < 1e-12);
}

#[test]
fn media_are_entered_and_left() {
    let solid = Material::Dielectric(Dielectric::from_reals(&[0.5, 1.0, 2.0, 1.5, 0.0]).unwrap());
    let outside = lobes(&solid, meeting(0.3, true), 0.0);
    let inside = lobes(&solid, meeting(0.3, false), 0.0);
    // Radiance: -ln of the transmission per unit of length; a medium that would amplify absorbs nothing.
    let medium = Rgb::new(2.0_f64.ln(), 0.0, 0.0);
    assert!(close(outside[0].medium.unwrap(), medium, 1e-15) && outside[1].medium.is_none());
    assert!(inside[0].medium == Some(Rgb::ZERO) && close(inside[1].medium.unwrap(), medium, 1e-15));
    let opaque = Dielectric::from_reals(&[0.0, 0.0, 0.0, 1.5, 0.0]).unwrap();
    assert_eq!(opaque.extinction(), Rgb::splat(100.0));
}

#[test]
fn emitters_are_seen_by_those_who_have_not_counted_them() {
    let seen = |emitter: &Emitter, blind, distance| emitter.seen(-DVec3::Z, blind, distance).x;
    let light = Emitter::light(&[3.0, 2.0, 1.0]).unwrap();
    assert!(light.illuminates() && seen(&light, false, 1.0) == 3.0 && seen(&light, true, 1.0) == 0.0);
    let near = Emitter::glow(&[3.0, 2.0, 1.0, 1.5]).unwrap();
    assert!(near.illuminates() && seen(&near, true, 1.4) == 0.0 && seen(&near, true, 1.6) == 3.0);
    assert_eq!(seen(&near, false, 1.0), 3.0);
    let ambient = Emitter::glow(&[3.0, 2.0, 1.0, 0.0]).unwrap();
    assert!(!ambient.illuminates() && seen(&ambient, true, 0.1) == 3.0 && seen(&ambient, false, 0.1) == 3.0);
    let dead = Emitter::glow(&[3.0, 2.0, 1.0, -1.0]).unwrap();
    assert!(!dead.illuminates() && seen(&dead, true, 9.0) == 0.0 && seen(&dead, false, 9.0) == 3.0);
    // However dim; but not a black one.
    assert!(Emitter::light(&[0.0, 0.0, 1e-12]).unwrap().illuminates());
    assert!(!Emitter::light(&[0.0; 3]).unwrap().illuminates());
    // A spot of 60 degrees shines 30 degrees off its aim at most; rays that look into it travel the other way.
    let spot = Emitter::spotlight(&[1.0, 1.0, 1.0, 60.0, 0.0, 0.0, -2.0]).unwrap();
    let EmitterKind::Spot(cone) = spot.kind() else { panic!("a spot") };
    let at = |degrees: f64| DVec3::new(degrees.to_radians().sin(), 0.0, -degrees.to_radians().cos());
    assert!(cone.contains(at(29.9)) && !cone.contains(at(30.1)));
    assert!((cone.solid_angle() - 2.0 * PI * (1.0 - 30.0_f64.to_radians().cos())).abs() < 1e-12);
    assert_eq!(cone.focal_length(), 2.0);
    assert_eq!(spot.seen(-at(29.9), false, 1.0), Rgb::ONE);
    assert_eq!(spot.seen(-at(30.1), false, 1.0), Rgb::ZERO);
}

#[test]
fn bad_arguments_are_named() {
    let message = |error: ArgumentError| error.to_string();
    let count = message(Plastic::from_reals(&[0.5; 4]).unwrap_err());
    assert!(count.contains("expected 5") && count.contains("found 4") && count.contains("roughness"), "{count}");
    let range = message(Trans::from_reals(&[0.5, 0.5, 0.5, 0.0, 0.0, 1.5, 0.0]).unwrap_err());
    assert!(range.contains("argument 6 (transmissivity) is 1.5"), "{range}");
    for reals in [[f64::NAN, 0.0, 0.0], [f64::INFINITY, 0.0, 0.0], [-1.0, 0.0, 0.0]] {
        assert!(Emitter::light(&reals).is_err() && Mirror::from_reals(&reals, Alternate::None).is_err());
    }
    assert!(Dielectric::from_reals(&[1.0, 1.0, 1.0, 0.0, 0.0]).is_err());
    assert!(Dielectric::from_reals(&[1.0, 1.0, 1.0, 1.5, -1000.0]).is_err());
    assert!(Emitter::spotlight(&[1.0, 1.0, 1.0, 60.0, 0.0, 0.0, 0.0]).is_err());
    assert!(Glass::from_reals(&[0.9, 0.9, 0.9, 0.5]).is_err());
}
