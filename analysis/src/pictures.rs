//! The pictures that were shown, made small for the report, with the crex that made them and what that cost.

use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use serde::Serialize;
use stimuli::{Manifest, Sha256};

/// Width of a small picture, pixels.
const WIDTH: usize = 320;

/// A picture that was shown.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Picture {
    /// Its name in the manifest.
    pub id: String,
    /// Its layout.
    pub layout: String,
    /// Its quality.
    pub quality: String,
    /// The component regular expression that made it.
    pub crex: String,
    /// Rays by component, `primary` among them.
    pub rays: Vec<(String, u64)>,
    /// Seconds that making it took, on how many threads.
    pub cost: Option<(f64, usize)>,
    /// SHA-256 of the file, as the manifest has it.
    pub sha256: String,
    /// The picture made small, as a PNG; none where the file is missing or not the one in the manifest.
    #[serde(skip)]
    pub thumbnail: Option<Vec<u8>>,
}

/// The pictures of a study's folder with the manifest's digest; no pictures where nothing was rendered yet.
///
/// # Errors
/// When the manifest cannot be read.
pub fn load(folder: &Path) -> stimuli::Result<(Vec<Picture>, Sha256)> {
    let manifest = Manifest::load(folder)?;
    let pictures = manifest.pictures.iter().map(|(id, record)| Picture {
        id: id.clone(),
        layout: record.layout.clone(),
        quality: record.quality.clone(),
        crex: record.request.crex.clone(),
        rays: record.rays.iter().map(|(component, rays)| (component.clone(), *rays)).collect(),
        cost: manifest.timings.get(id).map(|timing| (timing.seconds, timing.threads)),
        sha256: record.sha256.to_string(),
        thumbnail: thumbnail(&folder.join(&record.file), record.sha256),
    });
    Ok((pictures.collect(), manifest.hash()?))
}

fn thumbnail(path: &Path, digest: Sha256) -> Option<Vec<u8>> {
    (Sha256::of_file(path).ok()? == digest).then_some(())?;
    let mut decoder = png::Decoder::new(BufReader::new(File::open(path).ok()?));
    decoder.set_transformations(png::Transformations::normalize_to_color8() | png::Transformations::STRIP_16);
    let mut reader = decoder.read_info().ok()?;
    let mut bytes = vec![0; reader.output_buffer_size()?];
    let info = reader.next_frame(&mut bytes).ok()?;
    let channels = info.color_type.samples();
    let small = shrink(&bytes, [info.width as usize, info.height as usize], info.line_size, channels)?;
    encode(&small)
}

/// A small picture: width, height, RGB.
struct Small {
    width: usize,
    height: usize,
    rgb: Vec<u8>,
}

/// Averages boxes in linear light, so that fine bright detail keeps its brightness.
fn shrink(bytes: &[u8], [width, height]: [usize; 2], stride: usize, channels: usize) -> Option<Small> {
    if width == 0 || height == 0 {
        return None;
    }
    let small_width = WIDTH.min(width);
    let small_height = (height * small_width / width).max(1);
    let linear: Vec<f32> = (0..=255_u8).map(|code| to_linear(f32::from(code) / 255.0)).collect();
    let mut rgb = Vec::with_capacity(3 * small_width * small_height);
    for y in 0..small_height {
        let rows = y * height / small_height..((y + 1) * height / small_height).max(y * height / small_height + 1);
        for x in 0..small_width {
            let columns = x * width / small_width..((x + 1) * width / small_width).max(x * width / small_width + 1);
            for channel in 0..3 {
                // Grey pictures have one channel, or two with an alpha that is left alone.
                let channel = if channels < 3 { 0 } else { channel };
                let boxed =
                    rows.clone().flat_map(|row| columns.clone().map(move |column| row * stride + column * channels));
                let (mut sum, mut count) = (0.0, 0.0);
                for at in boxed {
                    sum += linear[usize::from(*bytes.get(at + channel)?)];
                    count += 1.0;
                }
                rgb.push((to_code(sum / count) * 255.0).round() as u8);
            }
        }
    }
    Some(Small { width: small_width, height: small_height, rgb })
}

/// The sRGB transfer curve (IEC 61966-2-1), to linear light.
fn to_linear(code: f32) -> f32 {
    if code <= 0.04045 { code / 12.92 } else { ((code + 0.055) / 1.055).powf(2.4) }
}

/// And back.
fn to_code(linear: f32) -> f32 {
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

fn encode(small: &Small) -> Option<Vec<u8>> {
    let mut bytes = Vec::new();
    let mut encoder =
        png::Encoder::new(&mut bytes, u32::try_from(small.width).ok()?, u32::try_from(small.height).ok()?);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::High);
    encoder.write_header().ok()?.write_image_data(&small.rgb).ok()?;
    Some(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_even_picture_stays_as_it_is() {
        let (width, height) = (1280, 1024);
        let bytes: Vec<u8> = [10, 120, 250].repeat(width * height);
        let small = shrink(&bytes, [width, height], 3 * width, 3).unwrap();
        assert_eq!((small.width, small.height), (320, 256));
        assert!(small.rgb.chunks(3).all(|pixel| pixel == [10, 120, 250]));
    }

    #[test]
    fn a_checkerboard_keeps_its_light() {
        // Half the light is code 188, not 128.
        let bytes: Vec<u8> = (0..640 * 2).map(|i| if (i % 640 + i / 640) % 2 == 0 { 255 } else { 0 }).collect();
        let small = shrink(&bytes, [640, 2], 640, 1).unwrap();
        assert!(small.rgb.iter().all(|code| *code == 188));
    }

    #[test]
    fn small_pictures_are_not_enlarged() {
        let small = shrink(&[1, 2, 3, 4], [2, 2], 2, 1).unwrap();
        assert_eq!((small.width, small.height, small.rgb.len()), (2, 2, 12));
        assert!(shrink(&[], [0, 0], 0, 3).is_none());
        assert!(shrink(&[1], [2, 2], 2, 1).is_none(), "too few bytes");
        assert_eq!(&encode(&small).unwrap()[1..4], b"PNG");
    }
}
