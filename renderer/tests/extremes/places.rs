//! Coordinates and sizes. A lamp of radius 1e-3 s and radiance 1e6 hangs s above a matt floor of reflectance 1/2: a small
//! sphere gives the irradiance pi L (r/h)^2, so the floor's radiance under it is 1/2, whatever s and wherever it is.

use crate::look::{Look, PAINT, square};
use crate::table::{Case, Row, group};

/// What is seen of the floor at the lamp's foot.
fn floor(size: f64, [x, y, z]: [f64; 3]) -> Look {
    let lamp = format!("lamp sphere ball 0 0 4 {x:e} {y:e} {:e} {:e}\n", z + size, 1e-3 * size);
    let text = [PAINT, &square("paint", "floor", [x, y, z], size), &lamp].concat();
    Look::new(text, [x, y - 0.5 * size, z + 0.5 * size], [0.0, 1.0, -1.0])
}

fn at(size: f64, place: [f64; 3], relative: f64) -> Row {
    Row::near(0.5, floor(size, place).red(), relative)
}

/// The same floor, in which a stone of a millimetre lies; a ground of 20 km is under all and a dome of 1e9 above.
fn mixed() -> Look {
    let mut look = floor(1.0, [0.0; 3]);
    look.text += &square("paint", "ground", [0.0, 0.0, -1.0], 1e4);
    look.text += "paint bubble dome 0 0 4 0 0 0 1e9\npaint sphere stone 0 0 4 .3 .3 0 1e-3\n";
    look
}

fn grazing(angle: f64) -> Row {
    let mut look = floor(1.0, [0.0; 3]);
    look.view.point = [0.0, -0.5, 0.5 * angle];
    look.view.direction = [0.0, 1.0, -angle];
    look.view.horizontal = 1e-3 * angle;
    look.view.vertical = 1e-3 * angle;
    Row::near(0.5, look.red(), 1e-5)
}

pub(crate) fn cases() -> Vec<Case> {
    group(
        "places",
        &[
            ("a scene of 1e-6", || at(1e-6, [0.0; 3], 2e-6)),
            ("a scene of 1e-3", || at(1e-3, [0.0; 3], 2e-6)),
            ("a scene of 1", || at(1.0, [0.0; 3], 2e-6)),
            ("a scene of 1e4", || at(1e4, [0.0; 3], 2e-6)),
            ("a scene of 1e8", || at(1e8, [0.0; 3], 2e-6)),
            ("a scene of 1e30", || at(1e30, [0.0; 3], 2e-6)),
            ("a scene of 1e-30", || at(1e-30, [0.0; 3], 2e-6)),
            ("a metre at 1e5", || at(1.0, [1e5, -1e5, 5e4], 2e-6)),
            // The last digit of 1e8 is 1.5e-8: a part in 7e4 of the lamp's millimetre, which counts twice.
            ("a metre at 1e8", || at(1.0, [1e8, -1e8, 1e8], 4e-5)),
            // The last digit is a part in 700 of the lamp's radius.
            ("a centimetre at 1e8 loses digits, not light", || at(1e-2, [1e8, -1e8, 1e8], 1e-2)),
            // 1e-11 of the coordinates is a millimetre: nothing is met within it, and all beyond it.
            ("half a millimetre at 1e8 lies within the window: nothing is met", || {
                Row::same(0.0, floor(5e-4, [1e8, -1e8, 1e8]).red())
            }),
            ("four millimetres at 1e8 are met", || at(4e-3, [1e8, -1e8, 1e8], 1e-4)),
            ("a micrometre at 1", || at(1e-6, [1.0, 1.0, 1.0], 1e-6)),
            ("20 km of ground, a dome of 1e9, a metre of floor", || Row::near(0.5, mixed().red(), 2e-6)),
            ("a stone of 1 mm among them", || {
                let mut look = mixed();
                look.view.point = [0.3, 0.3, 0.5];
                look.view.direction = [0.0, 0.0, -1.0];
                look.view.up = [0.0, 1.0, 0.0];
                look.text += "void glow mark 0 0 4 7 7 7 0\nmark sphere on 0 0 4 .3 .3 2e-3 1e-3\n";
                Row::same(7.0, look.red())
            }),
            ("grazing at 1e-3", || grazing(1e-3)),
            ("grazing at 1e-6", || grazing(1e-6)),
            ("grazing at 1e-9", || grazing(1e-9)),
            ("a ray within the floor's plane meets nothing", || {
                let mut look = floor(1.0, [0.0; 3]);
                look.view.point = [0.0, -0.5, 0.0];
                look.view.direction = [0.0, 1.0, 0.0];
                (look.view.horizontal, look.view.vertical) = (1e-9, 1e-9);
                look.settings.jitter = 0.0;
                Row::same(0.0, look.red())
            }),
        ],
    )
}
