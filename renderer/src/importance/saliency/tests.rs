use super::*;

/// A picture of equal bars (`width` x `length` px, `angle_deg` to the horizontal) on a 6 x 5 grid with jitter, one of
/// which, the singleton, is drawn by `odd`. Returns the picture and the singleton's centre.
struct Display {
    picture: Raster<[f32; 3]>,
    singleton: (f64, f64),
}

#[derive(Clone, Copy)]
struct Bar {
    colour: [f32; 3],
    angle_deg: f64,
    length_px: f64,
    width_px: f64,
}

fn hash(seed: u64) -> f64 {
    let mut bits = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15);
    bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((bits ^ (bits >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
}

fn display(seed: u64, common: Bar, odd: Bar) -> Display {
    let (columns, rows, cell) = (8_usize, 6_usize, 64.0);
    let mut picture = Raster::filled(512, 384, [0.35_f32; 3]);
    // The singleton stays off the rim: at the rim the surround of the coarsest scale is cut off.
    let place = (hash(seed ^ 77) * ((columns - 2) * (rows - 2)) as f64) as usize;
    let chosen = (1 + place % (columns - 2), 1 + place / (columns - 2));
    let mut singleton = (0.0, 0.0);
    for row in 0..rows {
        for column in 0..columns {
            let cell_seed = seed.wrapping_mul(1000) + (row * columns + column) as u64;
            let centre = (
                (column as f64 + 0.5) * cell + 12.0 * (hash(cell_seed) - 0.5),
                (row as f64 + 0.5) * cell + 12.0 * (hash(cell_seed + 500) - 0.5),
            );
            let is_odd = (column, row) == chosen;
            let bar = if is_odd { odd } else { common };
            if is_odd {
                singleton = centre;
            }
            let (sin, cos) = bar.angle_deg.to_radians().sin_cos();
            for y in (centre.1 - 32.0).max(0.0) as usize..(centre.1 + 32.0).min(384.0) as usize {
                for x in (centre.0 - 32.0).max(0.0) as usize..(centre.0 + 32.0).min(512.0) as usize {
                    let (dx, dy) = (x as f64 - centre.0, centre.1 - y as f64);
                    let (along, across) = (dx * cos + dy * sin, dy * cos - dx * sin);
                    if along.abs() <= bar.length_px / 2.0 && across.abs() <= bar.width_px / 2.0 {
                        *picture.at_mut(x, y) = bar.colour;
                    }
                }
            }
        }
    }
    Display { picture, singleton }
}

#[test]
fn the_first_fixation_lands_on_the_singleton_of_every_pop_out_display() {
    let bar = Bar { colour: [0.75, 0.75, 0.75], angle_deg: 0.0, length_px: 24.0, width_px: 8.0 };
    let red = Bar { colour: [0.8, 0.25, 0.25], ..bar };
    let green = Bar { colour: [0.25, 0.6, 0.25], ..bar };
    // Green among equally bright red is no pop-out for this model: its opponent maps are rectified, so a response of
    // the other sign is as strong as that of the many.
    let kinds: [(&str, Bar, Bar); 6] = [
        ("orientation", bar, Bar { angle_deg: 90.0, ..bar }),
        ("tilt", Bar { angle_deg: 135.0, ..bar }, Bar { angle_deg: 45.0, ..bar }),
        ("intensity", Bar { colour: [0.45; 3], ..bar }, Bar { colour: [0.9; 3], ..bar }),
        ("red among green", green, red),
        ("blue among red", red, Bar { colour: [0.25, 0.3, 0.8], ..bar }),
        ("size", Bar { length_px: 16.0, width_px: 6.0, ..bar }, Bar { length_px: 40.0, width_px: 16.0, ..bar }),
    ];
    let mut missed = Vec::new();
    for seed in 0..40 {
        for (name, common, odd) in kinds {
            let shown = display(seed, common, odd);
            let (x, y) = first_fixation(&saliency(&shown.picture)).expect("something is salient");
            let off = (x as f64 - shown.singleton.0).hypot(y as f64 - shown.singleton.1);
            // On the singleton: within half the spacing of the grid.
            if off > 32.0 {
                missed.push(format!("{name} {seed}: {off:.0} px off"));
            }
        }
    }
    assert!(missed.is_empty(), "{} of 240: {missed:#?}", missed.len());
}

#[test]
fn an_even_picture_has_no_salient_place() {
    let map = saliency(&Raster::filled(300, 200, [0.4, 0.5, 0.3]));
    assert!(map.values().iter().all(|&value| value == 0.0));
    assert_eq!(first_fixation(&map), None);
}

#[test]
fn saliency_does_not_change_with_the_light_and_keeps_its_size_and_range() {
    let bar = Bar { colour: [0.7, 0.6, 0.5], angle_deg: 20.0, length_px: 30.0, width_px: 9.0 };
    let shown = display(3, bar, Bar { angle_deg: 100.0, colour: [0.7, 0.3, 0.2], ..bar });
    let map = saliency(&shown.picture);
    assert_eq!((map.width(), map.height()), (512, 384));
    assert!(map.values().iter().all(|value| (0.0..=1.0).contains(value)));
    let dimmed = Raster::from_values(512, 384, shown.picture.values().iter().map(|p| p.map(|v| v * 0.25)).collect());
    for (a, b) in map.values().iter().zip(saliency(&dimmed.unwrap()).values()) {
        assert!((a - b).abs() < 1e-3, "each map is scaled to its own range");
    }
}

#[test]
fn pictures_of_any_size_are_taken() {
    for (width, height) in [(1, 1), (1, 300), (2, 3), (17, 1), (0, 4)] {
        let map = saliency(&Raster::filled(width, height, [0.1, f32::NAN, f32::INFINITY]));
        assert!(map.values().iter().all(|value| value.is_finite()));
    }
}
