//! The scene that both tracers see, as things and as Radiance text.

use std::fmt::Write as _;

use super::*;

fn quad(corner: [f64; 3], along: [f64; 3], up: [f64; 3], stuff: Stuff) -> Thing {
    Thing { form: Form::Quad { corner: corner.into(), along: along.into(), up: up.into() }, stuff }
}

fn ball(centre: [f64; 3], radius: f64, stuff: Stuff) -> Thing {
    Thing { form: Form::Ball { centre: centre.into(), radius }, stuff }
}

fn plastic(color: [f64; 3], spec: f64, rough: f64) -> Stuff {
    Stuff::Plastic { color: color.into(), spec, rough }
}

pub(super) fn world() -> World {
    let white = plastic([0.6, 0.6, 0.6], 0.0, 0.0);
    let trans = |rough| Stuff::Trans { color: DVec3::new(0.8, 0.7, 0.6), rough, trans: 0.6, tspec: 0.5 };
    World(vec![
        quad([-2., -2., 0.], [4., 0., 0.], [0., 4., 0.], plastic([0.5, 0.4, 0.3], 0.1, 0.2)),
        quad([-2., -2., 3.], [0., 4., 0.], [4., 0., 0.], white),
        quad([-2., 2., 0.], [4., 0., 0.], [0., 0., 3.], white),
        quad([2., -2., 0.], [0., 0., 3.], [0., 4., 0.], plastic([0.1, 0.5, 0.2], 0.0, 0.0)),
        quad([-2., -2., 0.], [0., 4., 0.], [0., 0., 3.], plastic([0.6, 0.1, 0.1], 0.0, 0.0)),
        quad([-1.9, -1., 0.3], [0., 2.5, 0.], [0., 0., 2.], Stuff::Mirror(DVec3::new(0.8, 0.85, 0.9))),
        quad([-0.6, 0., 2.9], [0., 1.2, 0.], [1.2, 0., 0.], Stuff::Light(DVec3::new(12., 11., 10.))),
        quad([-1.2, -0.2, 0.2], [1., 0., 0.], [0., 0.3, 1.2], Stuff::Glass(DVec3::new(0.9, 0.95, 0.9))),
        quad([0.3, -0.4, 1.3], [0.8, 0., 0.], [0., 0., 0.9], trans(0.0)),
        quad([-0.7, 0.4, 1.6], [0.8, 0., 0.], [0., 0., 0.8], trans(0.3)),
        ball([-0.9, 1.1, 0.5], 0.5, Stuff::Metal { color: DVec3::new(0.8, 0.7, 0.4), spec: 0.9, rough: 0.0 }),
        ball([0.2, 1.4, 0.5], 0.5, Stuff::Metal { color: DVec3::new(0.5, 0.7, 0.8), spec: 0.8, rough: 0.25 }),
        ball([1.2, 1.2, 0.4], 0.4, plastic([0.2, 0.3, 0.6], 0.05, 0.0)),
        ball([0.7, 0.1, 0.45], 0.45, Stuff::Dielectric { absorption: DVec3::new(0.7, 0.2, 0.1), index: 1.5 }),
    ])
}

/// The world as scene text.
pub(super) fn text(world: &World) -> String {
    let mut text = String::new();
    let rgb = |c: DVec3| format!("{} {} {}", c.x, c.y, c.z);
    for (i, thing) in world.0.iter().enumerate() {
        let (kind, count, reals) = match thing.stuff {
            Stuff::Plastic { color, spec, rough } => ("plastic", 5, format!("{} {spec} {rough}", rgb(color))),
            Stuff::Metal { color, spec, rough } => ("metal", 5, format!("{} {spec} {rough}", rgb(color))),
            Stuff::Trans { color, rough, trans, tspec } => {
                ("trans", 7, format!("{} 0 {rough} {trans} {tspec}", rgb(color)))
            }
            Stuff::Glass(color) => ("glass", 3, rgb(color)),
            Stuff::Dielectric { absorption, index } => {
                ("dielectric", 5, format!("{} {index} 0", rgb((-absorption).exp())))
            }
            Stuff::Mirror(color) => ("mirror", 3, rgb(color)),
            Stuff::Light(radiance) => ("light", 3, rgb(radiance)),
        };
        writeln!(text, "void {kind} m{i} 0 0 {count} {reals}").unwrap();
        match thing.form {
            Form::Quad { corner, along, up } => {
                let corners = [corner, corner + along, corner + along + up, corner + up].map(rgb).join(" ");
                writeln!(text, "m{i} polygon s{i} 0 0 12 {corners}").unwrap();
            }
            Form::Ball { centre, radius } => writeln!(text, "m{i} sphere s{i} 0 0 4 {} {radius}", rgb(centre)).unwrap(),
        }
    }
    text
}
