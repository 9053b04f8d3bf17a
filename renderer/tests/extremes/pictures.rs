//! Picture files at the ends of what they can hold.

use renderer::picture::{self, Compression, Picture, Pixel, Provenance, Quantity};
use renderer::raster::Raster;

use crate::table::{Case, Row, group};

/// Written to a file and read again.
fn again(ending: &str, width: usize, pixels: Vec<Pixel>) -> Vec<Pixel> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(format!("a.{ending}"));
    let height = pixels.len() / width;
    let beauty = Raster::from_values(width, height, pixels).unwrap();
    let picture =
        Picture { quantity: Quantity::Radiance, beauty, layers: Vec::new(), provenance: Provenance::default() };
    picture::write(&path, &picture, Compression::Zip).unwrap();
    picture::read(&path).unwrap().beauty.values().to_vec()
}

/// One value in all channels.
fn one(ending: &str, value: f32) -> f64 {
    f64::from(again(ending, 1, vec![[value; 3]])[0][0])
}

fn exact(value: f32) -> Row {
    Row::near(f64::from(value), one("exr", value), 0.0)
}

/// A ramp as wide as can be, in a row of a file.
fn wide(ending: &str, bound: f32) -> Row {
    let ramp: Vec<Pixel> = (0..32_768_u16).map(|i| [f32::from(i) / 32_768.0, 0.5, 1.0]).collect();
    let found = again(ending, ramp.len(), ramp.clone());
    let worst = ramp.iter().zip(&found).map(|(a, b)| (a[0] - b[0]).abs().max((a[2] - b[2]).abs())).fold(0.0, f32::max);
    Row::says(&format!("each pixel within {bound:e}"), format!("{worst:e}"), worst <= bound)
}

/// A file that claims a size which it does not hold.
fn claims(bytes: Vec<u8>) -> Row {
    let read = picture::read_bytes(&bytes).map(|_| ()).map_err(|error| error.to_string());
    Row::says("an error", read.clone().err().unwrap_or_default(), read.is_err())
}

fn huge_hdr() -> Vec<u8> {
    let mut bytes = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1000 +X 16777216\n".to_vec();
    bytes.extend([9; 8000]);
    bytes
}

/// A PNG header of 2^31 - 1 pixels a side.
fn huge_png() -> Vec<u8> {
    let mut bytes =
        b"\x89PNG\r\n\x1a\n\x00\x00\x00\x0dIHDR\x7f\xff\xff\xff\x7f\xff\xff\xff\x08\x02\x00\x00\x00".to_vec();
    // Its checksum (CRC-32 of type and data).
    let mut crc = u32::MAX;
    for &byte in &bytes[12..] {
        crc ^= u32::from(byte);
        for _ in 0..8 {
            crc = if crc & 1 == 1 { crc >> 1 ^ 0xedb8_8320 } else { crc >> 1 };
        }
    }
    bytes.extend((!crc).to_be_bytes());
    bytes.extend(b"\x00\x00\x00\x00IDAT\x35\xaf\x06\x1e");
    bytes
}

pub(crate) fn cases() -> Vec<Case> {
    group(
        "pictures",
        &[
            ("EXR: the largest number", || exact(f32::MAX)),
            ("EXR: the least normal number", || exact(f32::MIN_POSITIVE)),
            ("EXR: the least number", || exact(1e-45)),
            // A mantissa of 8 bits, decoded to the middle of its step.
            ("HDR: 1e38", || Row::near(1e38, one("hdr", 1e38), 1.0 / 256.0)),
            ("HDR: the largest number saturates at 255.5 x 2^119", || {
                Row::near(255.5 * 2_f64.powi(119), one("hdr", f32::MAX), 1e-7)
            }),
            ("HDR: 2e-32", || Row::near(2e-32, one("hdr", 2e-32), 1.0 / 256.0)),
            ("HDR: 9e-33 is black", || Row::near(0.0, one("hdr", 9e-33), 0.0)),
            ("HDR: a dim channel beside a bright one", || {
                let [bright, dim, _] = again("hdr", 1, vec![[1.0, 1e-9, 0.0]])[0];
                // The step is 2^-8: what is under it decodes to half of one.
                Row::same((1.0 + 1.0 / 256.0, 1.0 / 256.0), (bright, dim))
            }),
            ("PNG: 0 and 1", || Row::same([0.0, 1.0], [one("png", 0.0), one("png", 1.0)])),
            ("PNG: the largest number is white", || Row::same(1.0, one("png", f32::MAX))),
            ("PNG: a step is at most half a code", || {
                let codes = [0.001_f32, 0.2, 0.5, 0.999];
                let off = codes.map(|value| {
                    let code = |linear: f64| 255.0 * renderer::color::srgb_encode(linear);
                    (code(f64::from(value)) - code(one("png", value))).abs()
                });
                let worst = off.into_iter().fold(0.0, f64::max);
                Row::says("at most .5", format!("{worst:.4}"), worst <= 0.5 + 1e-4)
            }),
            ("EXR: 32768 pixels wide", || wide("exr", 0.0)),
            ("HDR: 32768 pixels wide", || wide("hdr", 1.0 / 128.0)),
            ("PNG: 32768 pixels wide", || wide("png", 0.005)),
            ("HDR: a size that 8 kB do not hold", || claims(huge_hdr())),
            ("PNG: 2^31 x 2^31 pixels", || claims(huge_png())),
        ],
    )
}
