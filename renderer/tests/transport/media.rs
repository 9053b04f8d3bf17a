//! Mist, prisms, lenses and objects, on scenes whose answer is known.

use std::f64::consts::PI;

use renderer::color::Rgb;
use renderer::component::Component;
use renderer::geometry::Aggregate;
use renderer::rad::{self, MemoryFiles, Source, ViewSpec};
use renderer::scene::{Scene, View};

use crate::{Stage, assert_close, beauty, endless};

/// A box of the material `m` from corner to corner, its sides facing outwards.
fn solid(m: &str, [x0, y0, z0]: [f64; 3], [x1, y1, z1]: [f64; 3]) -> String {
    let side = |corners: [[f64; 3]; 4]| {
        let numbers: Vec<String> = corners.iter().flatten().map(f64::to_string).collect();
        format!("{m} polygon side 0 0 12 {}\n", numbers.join(" "))
    };
    [
        side([[x0, y0, z0], [x0, y0, z1], [x0, y1, z1], [x0, y1, z0]]),
        side([[x1, y0, z0], [x1, y1, z0], [x1, y1, z1], [x1, y0, z1]]),
        side([[x0, y0, z0], [x1, y0, z0], [x1, y0, z1], [x0, y0, z1]]),
        side([[x0, y1, z0], [x0, y1, z1], [x1, y1, z1], [x1, y1, z0]]),
        side([[x0, y0, z0], [x0, y1, z0], [x1, y1, z0], [x1, y0, z0]]),
        side([[x0, y0, z1], [x1, y0, z1], [x1, y1, z1], [x0, y1, z1]]),
    ]
    .concat()
}

/// A mist of these real arguments from y = 1 to y = 1.5, half a unit to either side, looked through from the origin along y.
fn misty(reals: &str, lights: &str, more: &str) -> Stage {
    let count = reals.split_whitespace().count();
    let names = lights.split_whitespace().count();
    let mist = format!("void mist m {names} {lights} 0 {count} {reals}\n");
    let text = format!("{more}{mist}{}", solid("m", [-0.5, 1.0, -0.5], [0.5, 1.5, 0.5]));
    Stage::new(&text, [0.0; 3], [0.0, 1.0, 0.0], 0.01)
}

const WALL: &str = "void glow wall 0 0 4 8 4 2 0\nwall polygon w 0 0 12 -9 5 -9 9 5 -9 9 5 9 -9 5 9\n";

fn exp(x: [f64; 3]) -> Rgb {
    Rgb::from(x.map(f64::exp))
}

#[test]
fn mist_takes_light_away() {
    let wall = Rgb::new(8.0, 4.0, 2.0);
    let seen = misty("1 2 3", "", WALL).pixel("", endless(1));
    assert_close(seen, wall * exp([-0.5, -1.0, -1.5]), 1e-6);
    // Mists that share a place add up, and what is inside is left in order.
    let inner = format!("{WALL}void mist n 0 0 3 4 0 1\n{}", solid("n", [-0.2, 1.1, -0.2], [0.2, 1.3, 0.2]));
    let seen = misty("1 2 3", "", &inner).pixel("", endless(1));
    assert_close(seen, wall * exp([-1.3, -1.0, -1.7]), 1e-6);
    // An eye inside sees through what lies before it.
    let around = format!("{WALL}void mist n 0 0 3 1 1 1\n{}", solid("n", [-0.2, -0.2, -0.2], [0.2, 0.3, 0.2]));
    let seen = misty("0 0 0", "", &around).pixel("", endless(1));
    assert_close(seen, wall * (-0.3_f64).exp(), 1e-6);
    // Without extinction it is not there, to the bit.
    let plain = Stage::new(WALL, [0.0; 3], [0.0, 1.0, 0.0], 0.01).pixel("", endless(4));
    assert_eq!(misty("", "", WALL).pixel("", endless(4)), plain);
}

/// A narrow sun from the side: each point of the way through half a unit of mist gets it through half a unit more, weakened
/// by absorption alone, and sends a part of it on by Henyey and Greenstein's function at a right angle.
#[test]
fn mist_scatters_the_lights_that_it_lists() {
    let sun = "void light sun 0 0 3 1e4 1e4 1e4\nsun source side 0 0 4 1 0 0 1\n";
    let (albedo, eccentricity, extinction) = (Rgb::new(0.2, 0.5, 0.9), 0.4_f64, [1.0, 2.0, 3.0]);
    let stage = misty("1 2 3 .2 .5 .9 .4", "side", sun);
    let solid_angle = 2.0 * PI * (1.0 - 0.5_f64.to_radians().cos());
    let phase = (1.0 - eccentricity.powi(2)) / (1.0 + eccentricity.powi(2)).powf(1.5) / (4.0 * PI);
    let absorbed = exp([0, 1, 2].map(|channel| -0.5 * extinction[channel] * (1.0 - albedo[channel])));
    let met = Rgb::ONE - exp(extinction.map(|x| -0.5 * x));
    let expected = albedo * met * absorbed * (1e4 * solid_angle * phase);
    // Uniform points of the way: the deviation of one is at most half the value, and 4096 of them are stratified.
    assert_close(stage.pixel("", endless(4096)), expected, 2e-3);
    // Unlisted, the sun is not scattered; behind a wall neither.
    assert_eq!(misty("1 2 3 .2 .5 .9 .4", "", sun).pixel("", endless(16)), Rgb::ZERO);
    let wall = format!("{sun}void plastic p 0 0 5 0 0 0 0 0\np polygon w 0 0 12 2 -9 -9 2 9 -9 2 9 9 2 -9 9\n");
    assert_eq!(misty("1 2 3 .2 .5 .9 .4", "side", &wall).pixel("", endless(16)), Rgb::ZERO);
    // -av stands for what is scattered more than once, in a plane of its own.
    let mut settings = endless(64);
    settings.ambient = Rgb::ONE;
    let dark = misty("1 2 3 .2 .5 .9 .4", "", sun);
    assert_close(dark.pixel("", settings), albedo * met, 1e-6);
}

/// What is scattered into a ray belongs to what spawned the ray.
#[test]
fn scattered_light_is_filed_under_the_rays_own_event() {
    let text = "void light sun 0 0 3 1e4 1e4 1e4\nsun source side 0 0 4 1 0 0 1\n\
        void metal mirror 0 0 5 .5 .5 .5 1 0\nmirror polygon m 0 0 12 -9 .5 -9 9 .5 -9 9 .5 9 -9 .5 9\n";
    let mist = format!(
        "{text}void mist fog 1 side 0 6 1 1 1 .9 .9 .9\n{}",
        solid("fog", [-0.5, -1.5, -0.5], [0.5, -1.0, 0.5])
    );
    let stage = Stage::new(&mist, [0.0; 3], [0.0, 1.0, 0.0], 0.01);
    assert_eq!(stage.pixel("", endless(16)), Rgb::ZERO);
    let rendering = stage.render("S", endless(4096));
    let layer = rendering.film.layer(Component::Specular).unwrap().values()[0];
    assert!(layer.min_element() > 0.0 && (beauty(&rendering).values()[0] - layer.as_dvec3()).length() < 1e-9);
    // Half of what would be seen without the mirror.
    let direct = Stage::new(&mist, [0.0, 0.4, 0.0], [0.0, -1.0, 0.0], 0.01).pixel("", endless(4096));
    assert_close(layer.as_dvec3(), direct * 0.5, 4e-3);
}

/// A floor lit through a mist that only absorbs, and through one that only scatters: rpict's shadow rays lose the absorbed
/// part alone.
#[test]
fn shadow_rays_lose_what_is_absorbed() {
    let scene = |albedo: &str| {
        let text = format!(
            "void plastic matt 0 0 5 .5 .5 .5 0 0\nmatt polygon floor 0 0 12 -9 -9 0 9 -9 0 9 9 0 -9 9 0\n\
            void light sun 0 0 3 1e4 1e4 1e4\nsun source above 0 0 4 0 0 1 .5\n\
            void mist m 0 0 6 1 2 3 {albedo}\n{}",
            solid("m", [-3.0, -3.0, 1.0], [3.0, 3.0, 1.5])
        );
        Stage::new(&text, [0.0, -1.0, 0.2], [0.0, 1.0, -0.2], 1e-4).pixel("", endless(64))
    };
    let clear = scene("1 1 1");
    assert_close(scene("0 0 0"), clear * exp([-0.5, -1.0, -1.5]), 1e-4);
    assert_close(scene(".5 .5 .5"), clear * exp([-0.25, -0.5, -0.75]), 1e-4);
}

/// A prism that turns by one slope: the eye sees the wall to which it turns, dimmed, by T.
#[test]
fn prisms_turn_what_is_seen() {
    let walls = "void glow low 0 0 4 1 1 1 0\nlow polygon l 0 0 12 -9 5 -9 9 5 -9 9 5 1 -9 5 1\n\
        void glow high 0 0 4 3 2 1 0\nhigh polygon h 0 0 12 -9 5 1 9 5 1 9 5 9 -9 5 9\n";
    let prism = |kind: &str, arguments: &str| {
        let count = arguments.split_whitespace().count();
        let sheet =
            format!("void {kind} p {count} {arguments} 0 1 .7\np polygon s 0 0 12 -1 1 -1 1 1 -1 1 1 1 -1 1 1\n");
        Stage::new(&format!("{walls}{sheet}"), [0.0; 3], [0.0, 1.0, 0.0], 1e-3)
    };
    let up = prism("prism1", ".5 Dx Dy Dz+A1 .");
    assert_eq!(up.pixel("", endless(1)), Rgb::ZERO);
    assert_close(up.pixel("T", endless(1)), Rgb::new(1.5, 1.0, 0.5), 1e-6);
    let both = prism("prism2", ".5 Dx Dy Dz+A1 .25 Dx Dy Dz-A1 .");
    assert_close(both.pixel("T", endless(1)), Rgb::new(1.75, 1.25, 0.75), 1e-6);
    // In the sheet's own coordinates: its z is the scene's x.
    let turned = prism("prism1", "1 Dx Dy Dz+A1*100 . -ry 90");
    assert_eq!(turned.pixel("T", endless(1)), Rgb::ZERO);
    // Nothing passes where the coefficient is 0 or less, or a function fails.
    for coefficient in ["0", "-1", "log(-1)", "1/0"] {
        assert_eq!(prism("prism1", &format!("{coefficient} Dx Dy Dz .")).pixel("T", endless(1)), Rgb::ZERO);
    }
}

/// A prism overhead that shifts slopes by a constant makes a lamp shine as if it stood elsewhere, and a sun as if it stood
/// lower; the lamp itself it hides from the floor.
#[test]
fn prisms_relay_lights_to_where_they_seem_to_be() {
    let floor = "void plastic matt 0 0 5 .5 .5 .5 0 0\nmatt polygon floor 0 0 12 -9 -9 0 9 -9 0 9 9 0 -9 9 0\n";
    let prism =
        "void prism1 p 5 .8 Dx+.5*abs(Dz) Dy Dz . 0 0\np polygon s 0 0 12 -50 -50 2 50 -50 2 50 50 2 -50 50 2\n";
    let lit = |more: &str| {
        let text = format!("{floor}{more}");
        Stage::new(&text, [0.0, -1.0, 0.2], [0.0, 1.0, -0.2], 1e-4).pixel("", endless(256))
    };
    // A small lamp at height 3 above the prism's plane: its image is 1.5 aside.
    let lamp = |x: f64| format!("void light lamp 0 0 3 900 900 900\nlamp sphere l 0 0 4 {x} 0 5 .05\n");
    let relayed = lit(&format!("{}{prism}", lamp(0.0)));
    assert_close(relayed, lit(&lamp(1.5)) * 0.8, 2e-3);
    // From straight above, the sun comes at a slope of a half.
    let sun = "void light sun 0 0 3 1e4 1e4 1e4\nsun source s 0 0 4 0 0 1 .5\n";
    let slanted = 1.0 / 1.25_f64.sqrt();
    assert_close(lit(&format!("{sun}{prism}")), lit(sun) * (0.8 * slanted), 2e-3);
    // Without relays nothing comes through.
    let text = format!("{floor}{sun}{prism}");
    let mut stage = Stage::new(&text, [0.0, -1.0, 0.2], [0.0, 1.0, -0.2], 1e-4);
    stage.scene.set_relays(0);
    assert_eq!(stage.pixel("", endless(16)), Rgb::ZERO);
}

/// A sheet that doubles sines on the way up, and halves them on the way down, lights the floor as a sun would that stood where
/// the sheet shows it, of the sun's own solid angle: no part of the light is lost where the image is narrower than the sun (a
/// shear would keep a quarter of it).
#[test]
fn prisms_relay_all_of_a_sun() {
    let lit = |more: &str| {
        let floor = "void plastic matt 0 0 5 .5 .5 .5 0 0\nmatt polygon floor 0 0 12 -9 -9 0 9 -9 0 9 9 0 -9 9 0\n";
        let sun = "void light sun 0 0 3 1e4 1e4 1e4\n";
        Stage::new(&format!("{floor}{sun}{more}"), [0.0, -1.0, 0.2], [0.0, 1.0, -0.2], 1e-4).pixel("", endless(256))
    };
    let prism = "void prism1 p 5 .8 Dx*if(Dz,2,.5) Dy*if(Dz,2,.5) \
        if(Dz,sqrt(1-4*(Dx*Dx+Dy*Dy)),-sqrt(1-(Dx*Dx+Dy*Dy)/4)) . 0 0\n";
    let sheet = format!("{prism}p polygon s 0 0 12 -50 -50 2 50 -50 2 50 50 2 -50 50 2\n");
    for sine in [0.0_f64, 0.3] {
        let sun = |sine: f64| format!("sun source s 0 0 4 {sine} 0 {} .5\n", (1.0 - sine * sine).sqrt());
        let seen = lit(&sun(sine)) * 0.8;
        assert!(seen.min_element() > 0.0);
        assert_close(lit(&format!("{}{sheet}", sun(2.0 * sine))), seen, 1e-5);
    }
}

/// DxA..DzA is where the light is that a prism is asked for: one that passes light from above only.
#[test]
fn prisms_know_the_light() {
    let lit = |coefficient: &str| {
        let text = format!(
            "void plastic matt 0 0 5 .5 .5 .5 0 0\nmatt polygon floor 0 0 12 -9 -9 0 9 -9 0 9 9 0 -9 9 0\n\
            void light sun 0 0 3 1e4 1e4 1e4\nsun source s 0 0 4 0 3 4 .5\n\
            void prism1 p 5 {coefficient} Dx Dy Dz . 0 0\np polygon s 0 0 12 -50 -50 2 50 -50 2 50 50 2 -50 50 2\n"
        );
        Stage::new(&text, [0.0, -1.0, 0.2], [0.0, 1.0, -0.2], 1e-4).pixel("", endless(64))
    };
    // Where no light is asked for all three are 0: so the relay is laid out, and by (0, 3/5, 4/5) it is weighed.
    let whole = lit("1");
    assert!(whole.min_element() > 0.0);
    assert_close(lit("1-DzA+DyA+DxA"), whole * 0.8, 1e-6);
}

/// A point of light at distance d, seen through a lens of diameter a in focus at f, is a disc of diameter a |d - f|/d in the
/// plane in focus (similar triangles): uniform over its area, and no light is lost.
#[test]
fn points_out_of_focus_are_discs() {
    let (aperture, focus, distance) = (0.5, 4.0, 8.0);
    let text = "void glow g 0 0 4 1e6 1e6 1e6 0\ng sphere s 0 0 4 0 8 0 .02\n";
    let document = rad::read(&[Source::new("a.rad", text)], &MemoryFiles::new(), &rad::Options::default()).unwrap();
    let scene = Scene::from_rad(&document).unwrap();
    let width = 64;
    let half = 0.5_f64;
    let degrees = 2.0 * (half / focus).atan().to_degrees();
    let spec = ViewSpec { direction: [0.0, focus, 0.0], horizontal: degrees, vertical: degrees, ..ViewSpec::default() };
    let stage = Stage { aggregate: Aggregate::new([]), view: View::new(spec).unwrap(), scene };
    let stage = Stage { aggregate: stage.scene.aggregate(), ..stage };
    let mut settings = renderer::render::Settings::new(width, width);
    settings.samples = 256;
    settings.aperture = aperture;
    let picture = beauty(&stage.render("", settings));
    // The mean square distance from the centre of a uniform disc is half its squared radius.
    let (mut sum, mut square) = (0.0, 0.0);
    let pixel = 2.0 * half / width as f64;
    for (index, value) in picture.values().iter().enumerate() {
        let at = |n: usize| (n as f64 + 0.5) * pixel - half;
        let (x, y) = (at(index % width), at(index / width));
        sum += value.x;
        square += value.x * (x * x + y * y);
    }
    let radius = 0.5 * aperture * (distance - focus) / distance;
    // A sample hits with a chance of pi .01^2: some 330 do, of whose squared distances (uniform from 0 to the radius squared)
    // the mean is off by 3.2 % in the standard deviation; 6 of those: once in 10^9. The seed is fixed.
    assert!((2.0 * square / sum / (radius * radius) - 1.0).abs() < 0.2, "{}", (2.0 * square / sum).sqrt() / radius);
    // In focus it stays a point.
    settings = renderer::render::Settings::new(width, width);
    (settings.samples, settings.aperture) = (64, aperture);
    let spec = ViewSpec { direction: [0.0, distance, 0.0], ..spec };
    let stage = Stage { view: View::new(spec).unwrap(), ..stage };
    let sharp = beauty(&stage.render("", settings));
    let lit = sharp.values().iter().filter(|value| value.x > 0.0).count();
    assert!((1..=4).contains(&lit), "{lit}");
}

/// An object of triangles and of concave faces is the same as those polygons.
#[test]
fn objects_are_their_polygons() {
    let obj = "v -1 2 -1\nv 1 2 -1\nv 1 2 1\nv 0 2 0\nv -1 2 1\nusemtl red\nf 1 2 3 4 5\n";
    let lamp = "void light l 0 0 3 9 9 9\nl sphere s 0 0 4 0 0 1 .1\n";
    let red = "void plastic red 0 0 5 .8 .2 .1 0 0\n";
    let blue = "void plastic blue 0 0 5 .1 .2 .8 0 0\n";
    let picture = |text: &str| {
        let files = MemoryFiles::new().with("a.obj", obj);
        let document = rad::read(&[Source::new("a.rad", text)], &files, &rad::Options::default()).unwrap();
        let scene = Scene::from_rad_with(&document, &files).unwrap();
        let view = ViewSpec { horizontal: 60.0, vertical: 60.0, ..ViewSpec::default() };
        let stage = Stage { aggregate: scene.aggregate(), view: View::new(view).unwrap(), scene };
        let mut settings = renderer::render::Settings::new(24, 24);
        settings.samples = 4;
        beauty(&stage.render("", settings))
    };
    let polygon = "polygon p 0 0 15 -1 2 -1 1 2 -1 1 2 1 0 2 0 -1 2 1\n";
    let close = |a: &renderer::raster::Raster<Rgb>, b: &renderer::raster::Raster<Rgb>| {
        let off = a.values().iter().zip(b.values()).map(|(a, b)| (*a - *b).abs().max_element()).fold(0.0, f64::max);
        let most = a.values().iter().map(|a| a.max_element()).fold(0.0, f64::max);
        assert!(most > 0.0 && off <= 1e-6 * most, "{off} of {most}");
    };
    close(&picture(&format!("{lamp}{red}void mesh m 1 a.obj 0 0\n")), &picture(&format!("{lamp}{red}red {polygon}")));
    // A material of the mesh's own overrides the object's, which then need not be there.
    close(
        &picture(&format!("{lamp}{blue}blue mesh m 1 a.obj 0 0\n")),
        &picture(&format!("{lamp}{blue}blue {polygon}")),
    );
    // Names that the scene does not have are errors.
    let files = MemoryFiles::new().with("a.obj", obj);
    let text = format!("{lamp}void mesh m 1 a.obj 0 0\n");
    let document = rad::read(&[Source::new("a.rad", text)], &files, &rad::Options::default()).unwrap();
    let errors = Scene::from_rad_with(&document, &files).unwrap_err();
    assert!(errors[0].to_string().contains("`red`"), "{}", errors[0]);
}
