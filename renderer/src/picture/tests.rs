//! What goes in comes out, in every format.

use std::path::Path;

use proptest::prelude::*;

use super::grey::Bits;
use super::*;
use crate::color::srgb_encode;

fn picture(width: usize, height: usize, layers: &[&str], mut value: impl FnMut(usize) -> f32) -> Picture {
    let mut pixels = |offset: usize| {
        let pixels = (0..width * height).map(|index| [0, 1, 2].map(|channel| value(7 * index + channel + offset)));
        Raster::from_values(width, height, pixels.collect()).unwrap()
    };
    Picture {
        quantity: Quantity::Radiance,
        beauty: pixels(0),
        layers: layers
            .iter()
            .enumerate()
            .map(|(index, name)| Layer { name: (*name).to_owned(), pixels: pixels(1000 * (index + 1)) })
            .collect(),
        provenance: Provenance {
            software: "crex test".into(),
            crex: Some("T{RSGM}".into()),
            view: Some("-vtv -vp 0 0 1".into()),
            inputs: vec![Input { name: "Flur \u{fc}ber \u{1f525}.rad".into(), sha256: "00ff".into() }],
            ..Provenance::default()
        },
    }
}

fn round_trip(name: &str, picture: &Picture, compression: Compression) -> Picture {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    write(&path, picture, compression).unwrap();
    read(&path).unwrap()
}

#[test]
fn exr_keeps_every_bit_layer_and_word() {
    let all = ["direct", "D", "S", "G", "T", "R", "M", "ambient"];
    // Ends of the range, signs, subnormals, and sizes on both sides of the 16 and 32 rows of a block.
    let values = [0.0, -0.0, 1e-38, 1e38, -2.5, f32::MIN_POSITIVE / 8.0, f32::MAX, 0.1, 1.0 / 3.0];
    for height in [1, 15, 16, 17, 33, 600] {
        let written = picture(5, height, &all, |index| values[index % values.len()]);
        for compression in [Compression::Zip, Compression::Piz, Compression::Rle, Compression::Uncompressed] {
            let mut again = round_trip("a.exr", &written, compression);
            assert_eq!(again.layers.len(), 8);
            again.layers.sort_by_key(|layer| all.iter().position(|name| *name == layer.name));
            let bits = |picture: &Picture| -> Vec<u32> {
                let rasters = std::iter::once(&picture.beauty).chain(picture.layers.iter().map(|layer| &layer.pixels));
                rasters.flat_map(|raster| raster.values().iter().flatten().map(|value| value.to_bits())).collect()
            };
            assert_eq!(bits(&again), bits(&written), "{compression:?} {height}");
            assert_eq!(again.provenance, written.provenance);
        }
    }
}

#[test]
fn the_same_picture_gives_the_same_bytes() {
    let written = picture(40, 70, &["direct", "D"], |index| index as f32);
    let folder = tempfile::tempdir().unwrap();
    for extension in ["exr", "hdr", "png"] {
        let files: Vec<Vec<u8>> = (0..3)
            .map(|run| {
                let path = folder.path().join(format!("{run}.{extension}"));
                write(&path, &written, Compression::Zip).unwrap();
                std::fs::read(path).unwrap()
            })
            .collect();
        assert!(files.iter().all(|bytes| *bytes == files[0]), "{extension}");
    }
}

#[test]
fn bands_of_any_height_give_the_same_bytes() {
    let written = picture(9, 37, &["direct"], |index| (index % 91) as f32);
    let folder = tempfile::tempdir().unwrap();
    let mut header = Header::new(9, 37, written.provenance.clone());
    header.layers = vec!["direct".into()];
    for extension in ["exr", "hdr", "png"] {
        let bytes = [1, 5, 16, 37].map(|rows| {
            let path = folder.path().join(format!("{rows}.{extension}"));
            let mut file = PictureFile::create(&path, &header).unwrap();
            let layer = written.layers[0].pixels.values();
            for (beauty, layer) in written.beauty.values().chunks(9 * rows).zip(layer.chunks(9 * rows)) {
                file.write(Band { beauty, layers: &[layer] }).unwrap();
            }
            file.finish().unwrap();
            std::fs::read(path).unwrap()
        });
        assert!(bytes.iter().all(|other| *other == bytes[0]), "{extension}");
    }
}

#[test]
fn hdr_header_says_what_radiance_programs_look_for() {
    let written = picture(9, 3, &[], |index| index as f32);
    let mut header = Header::new(9, 3, written.provenance.clone());
    header.exposure = 4.0;
    let mut bytes = Vec::new();
    let mut stream = HdrStream::start(&mut bytes, &header).unwrap();
    stream.write(Band { beauty: written.beauty.values(), layers: &[] }).unwrap();
    stream.finish().unwrap();
    let end = bytes.windows(2).position(|pair| pair == b"\n\n").unwrap();
    let text = std::str::from_utf8(&bytes[..end]).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines[0], "#?RADIANCE");
    for line in
        ["VIEW= -vtv -vp 0 0 1", "SOFTWARE= crex test", "CREX= T{RSGM}", "EXPOSURE=4e0", "FORMAT=32-bit_rle_rgbe"]
    {
        assert!(lines.contains(&line), "{line} is not in\n{text}");
    }
    assert!(bytes[end + 2..].starts_with(b"-Y 3 +X 9\n"));
    // Reading divides the exposure out again.
    let again = read_bytes(&bytes).unwrap();
    for (before, after) in written.beauty.values().iter().flatten().zip(again.beauty.values().iter().flatten()) {
        let largest = 7.0 * 27.0;
        assert!((before - after).abs() <= largest / 128.0, "{before} {after}");
    }
    assert_eq!(again.provenance.crex.as_deref(), Some("T{RSGM}"));
    assert_eq!(again.provenance.view.as_deref(), Some("-vtv -vp 0 0 1"));
}

/// A 2 x 3 picture whose pixel (x, y from the top) has red 2^(x + 2y), in the eight orders in which Radiance may store it.
#[test]
fn hdr_orientations_and_factors() {
    for (line, transposed, upward, leftward) in [
        ("-Y 3 +X 2", false, false, false),
        ("+Y 3 +X 2", false, true, false),
        ("-Y 3 -X 2", false, false, true),
        ("+Y 3 -X 2", false, true, true),
        ("+X 2 -Y 3", true, false, false),
        ("+X 2 +Y 3", true, true, false),
        ("-X 2 -Y 3", true, false, true),
        ("-X 2 +Y 3", true, true, true),
    ] {
        let header =
            "#?RADIANCE\nrpict -x 2\nEXPOSURE=2\nEXPOSURE= 0.5\nEXPOSURE=4\nCOLORCORR= 2 1 1\nFORMAT=32-bit_rle_rgbe\n";
        let mut bytes = format!("{header}\n{line}\n").into_bytes();
        let (scanlines, columns) = if transposed { (2, 3) } else { (3, 2) };
        for scanline in 0..scanlines {
            for column in 0..columns {
                let (x, y) = if transposed { (scanline, column) } else { (column, scanline) };
                let (x, y) = (if leftward { 1 - x } else { x }, if upward { 2 - y } else { y });
                bytes.extend([128, 0, 0, 129 + (x + 2 * y) as u8]);
            }
        }
        let picture = read_bytes(&bytes).unwrap();
        assert_eq!((picture.beauty.width(), picture.beauty.height()), (2, 3));
        for y in 0..3 {
            for x in 0..2 {
                let expected = 2f32.powi((x + 2 * y) as i32) * (128.5 / 128.0) / 8.0;
                assert_eq!(picture.beauty.at(x, y)[0], expected, "{line} at {x} {y}");
            }
        }
    }
}

#[test]
fn png_is_srgb_of_the_clamped_exposed_radiance() {
    let values = [-1.0, 0.0, 1e-38, 0.0031308, 0.18, 0.5, 1.0, 1e38];
    let written = picture(8, 1, &[], |index| values[(index / 7) % 8]);
    let again = round_trip("a.png", &written, Compression::Zip);
    assert_eq!(again.quantity, Quantity::Display);
    assert_eq!(again.provenance, written.provenance);
    for (x, value) in values.into_iter().enumerate() {
        let code = 255.0 * srgb_encode(f64::from(again.beauty.at(x, 0)[0]));
        assert!((code - code.round()).abs() < 1e-3, "a PNG holds whole codes");
        assert!((code - 255.0 * srgb_encode(f64::from(value))).abs() <= 0.501, "{value}");
    }
}

#[test]
fn srgb_agrees_with_the_standards_table() {
    // IEC 61966-2-1: mid grey 0.18 linear is code 117.6; code 188 is 0.5029 linear; the two branches meet.
    assert!((255.0 * srgb_encode(0.18) - 117.65).abs() < 0.05);
    assert!((crate::color::srgb_decode(188.0 / 255.0) - 0.5029).abs() < 1e-4);
    assert!((srgb_encode(0.003_130_8) - srgb_encode(0.003_130_9)).abs() < 3e-6);
}

#[test]
fn what_no_picture_can_hold_is_refused_with_its_place() {
    let folder = tempfile::tempdir().unwrap();
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        for extension in ["exr", "hdr", "png"] {
            let path = folder.path().join(format!("bad.{extension}"));
            let written = picture(5, 4, &["D"], |index| if index == 7 * 13 + 1001 { bad } else { 1.0 });
            let error = write(&path, &written, Compression::Zip).unwrap_err().to_string();
            assert!(error.contains("D at column 3, row 2"), "{error}");
            assert!(!path.exists());
        }
    }
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn a_picture_with_rows_missing_never_appears() {
    let folder = tempfile::tempdir().unwrap();
    for extension in ["exr", "hdr", "png"] {
        let path = folder.path().join(format!("short.{extension}"));
        let header = Header::new(4, 4, Provenance::default());
        let mut file = PictureFile::create(&path, &header).unwrap();
        file.write(Band { beauty: &[[1.0; 3]; 8], layers: &[] }).unwrap();
        assert!(matches!(file.finish().unwrap_err().kind, Kind::Rows(_)));
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
    }
}

#[test]
fn names_without_a_format_are_refused() {
    let header = Header::new(4, 4, Provenance::default());
    for name in ["picture", "picture.tif", "picture.exr.bak", ""] {
        assert!(matches!(PictureFile::create(Path::new(name), &header).unwrap_err().kind, Kind::Extension));
    }
    assert_eq!(Format::of_name(Path::new("A.EXR")), Some(Format::Exr));
    assert_eq!(Format::of_name(Path::new("a.pic")), Some(Format::Hdr));
}

#[test]
fn grey_maps_are_code_over_maximum() {
    let folder = tempfile::tempdir().unwrap();
    let map = Raster::from_values(3, 2, vec![0.0, 1.0, 0.5, 0.25, 1.0 / 3.0, 0.1]).unwrap();
    for (name, bits, tolerance) in [
        ("map.png", Bits::Sixteen, 0.5 / 65535.0),
        ("eight.png", Bits::Eight, 0.5 / 255.0),
        ("map.exr", Bits::Eight, 0.0),
    ] {
        let path = folder.path().join(name);
        grey::write(&path, &map, bits, &Provenance::default()).unwrap();
        let again = grey::read(&path).unwrap();
        for (before, after) in map.values().iter().zip(again.values()) {
            assert!((before - after).abs() <= tolerance * 1.0001, "{name}: {before} {after}");
        }
    }
    // Eight bits: code 128 is 128/255, untouched by any transfer curve.
    let path = folder.path().join("eight.png");
    let mut encoder = ::png::Encoder::new(std::fs::File::create(&path).unwrap(), 2, 1);
    encoder.set_color(::png::ColorType::Grayscale);
    encoder.set_depth(::png::BitDepth::Eight);
    encoder.write_header().unwrap().write_image_data(&[128, 255]).unwrap();
    assert_eq!(grey::read(&path).unwrap().values(), [128.0 / 255.0, 1.0]);
}

#[test]
fn maps_with_colour_or_values_out_of_range_are_errors() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["colour.png", "colour.exr"] {
        let path = folder.path().join(name);
        write(&path, &picture(3, 2, &[], |index| (index % 3) as f32 / 3.0), Compression::Zip).unwrap();
        assert!(matches!(grey::read(&path).unwrap_err().kind, Kind::Colour), "{name}");
    }
    let path = folder.path().join("large.exr");
    let mut large = picture(3, 2, &[], |_| 0.5);
    *large.beauty.at_mut(1, 1) = [1.5; 3];
    write(&path, &large, Compression::Zip).unwrap();
    assert!(matches!(grey::read(&path).unwrap_err().kind, Kind::Range { x: 1, y: 1, .. }));
    let bad = Raster::from_values(1, 1, vec![f32::NAN]).unwrap();
    assert!(grey::write(&folder.path().join("nan.png"), &bad, Bits::Sixteen, &Provenance::default()).is_err());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn damaged_files_are_errors_and_never_panics(
        format in 0usize..3,
        cut in 0.0f64..1.0,
        flips in prop::collection::vec((0.0f64..1.0, any::<u8>()), 0..4),
    ) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(["a.exr", "a.hdr", "a.png"][format]);
        write(&path, &picture(11, 20, &["D"], |index| (index % 9) as f32), Compression::Zip).unwrap();
        let mut bytes = std::fs::read(&path).unwrap();
        for (place, value) in flips {
            let index = (place * bytes.len() as f64) as usize;
            bytes[index] ^= value;
        }
        bytes.truncate((cut * 1.2 * bytes.len() as f64) as usize);
        let _ = read_bytes(&bytes);
    }
}
