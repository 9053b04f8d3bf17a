//! PNG: display pictures in sRGB with 8 bits a channel, and grey maps without a transfer curve.

use std::io::{Cursor, Write};

use super::grey::{Bits, GreyMap};
use super::{Header, Kind, Picture, Pixel, Provenance, Quantity};
use crate::color::{srgb_decode, srgb_encode};
use crate::raster::Raster;

/// The keyword of the text chunk that holds the provenance as JSON.
const PROVENANCE: &str = "provenance";

/// Writes sRGB(clamp(radiance x exposure)), rounded to 8 bits.
pub(super) struct PngEncoder<W: Write + 'static> {
    stream: ::png::StreamWriter<'static, W>,
    exposure: f64,
}

impl<W: Write + 'static> std::fmt::Debug for PngEncoder<W> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("PngEncoder").field("exposure", &self.exposure).finish_non_exhaustive()
    }
}

impl<W: Write + 'static> PngEncoder<W> {
    pub(super) fn start(stream: W, header: &Header) -> Result<Self, Kind> {
        // The header was checked: both fit.
        let (width, height) = (header.width as u32, header.height as u32);
        let mut encoder = ::png::Encoder::new(stream, width, height);
        encoder.set_color(::png::ColorType::Rgb);
        encoder.set_depth(::png::BitDepth::Eight);
        encoder.set_source_srgb(::png::SrgbRenderingIntent::Perceptual);
        let provenance = header.exposed_provenance();
        if !provenance.software.is_empty() {
            encoder.add_itxt_chunk("Software".into(), provenance.software.clone()).map_err(encoding)?;
        }
        encoder.add_itxt_chunk(PROVENANCE.into(), provenance.to_json()).map_err(encoding)?;
        let stream = encoder.write_header().and_then(::png::Writer::into_stream_writer).map_err(encoding)?;
        Ok(Self { stream, exposure: header.exposure })
    }

    pub(super) fn write(&mut self, pixels: &[Pixel]) -> Result<(), Kind> {
        let code = |&value: &f32| (255.0 * srgb_encode(f64::from(value) * self.exposure)).round() as u8;
        let bytes: Vec<u8> = pixels.iter().flatten().map(code).collect();
        self.stream.write_all(&bytes).map_err(Kind::Write)
    }

    pub(super) fn finish(self) -> Result<(), Kind> {
        self.stream.finish().map_err(encoding)
    }
}

/// Reads a colour or grey picture as linear display light; an alpha channel is ignored.
pub(super) fn read(bytes: &[u8]) -> Result<Picture, Kind> {
    let image = Decoded::read(bytes)?;
    let maximum = f64::from(image.maximum);
    let linear = |code: u16| srgb_decode(f64::from(code) / maximum) as f32;
    let pixel = |codes: &[u16]| match codes {
        [red, green, blue, ..] => [linear(*red), linear(*green), linear(*blue)],
        [grey, ..] => [linear(*grey); 3],
        [] => [0.0; 3],
    };
    let pixels = image.codes.chunks(image.channels).map(pixel).collect();
    let beauty = Raster::from_values(image.width, image.height, pixels).ok_or_else(size_mismatch)?;
    Ok(Picture { quantity: Quantity::Display, beauty, layers: Vec::new(), provenance: image.provenance })
}

/// Reads a map: code / maximum, without any transfer curve. Colours are an error.
pub(super) fn read_grey(bytes: &[u8]) -> Result<GreyMap, Kind> {
    let image = Decoded::read(bytes)?;
    if image.channels > 2 {
        return Err(Kind::Colour);
    }
    let maximum = f32::from(image.maximum);
    let values = image.codes.chunks(image.channels).map(|codes| f32::from(codes[0]) / maximum).collect();
    Raster::from_values(image.width, image.height, values).ok_or_else(size_mismatch)
}

/// The bytes of a grey PNG with code = value x the largest code, rounded, and no transfer curve.
pub(super) fn encode_grey(map: &GreyMap, bits: Bits, provenance: &Provenance) -> Result<Vec<u8>, Kind> {
    let mut bytes = Vec::new();
    let mut encoder = ::png::Encoder::new(&mut bytes, map.width() as u32, map.height() as u32);
    encoder.set_color(::png::ColorType::Grayscale);
    let (depth, largest) = match bits {
        Bits::Eight => (::png::BitDepth::Eight, 255.0),
        Bits::Sixteen => (::png::BitDepth::Sixteen, 65535.0),
    };
    encoder.set_depth(depth);
    encoder.add_itxt_chunk(PROVENANCE.into(), provenance.to_json()).map_err(encoding)?;
    let codes = map.values().iter().map(|&value| (f64::from(value) * largest).round() as u16);
    let data: Vec<u8> = match bits {
        Bits::Eight => codes.map(|code| code as u8).collect(),
        Bits::Sixteen => codes.flat_map(u16::to_be_bytes).collect(),
    };
    let mut writer = encoder.write_header().map_err(encoding)?;
    writer.write_image_data(&data).map_err(encoding)?;
    writer.finish().map_err(encoding)?;
    Ok(bytes)
}

/// A PNG's codes as they stand, palettes and 1-, 2- and 4-bit codes expanded.
struct Decoded {
    width: usize,
    height: usize,
    /// 1 grey, 2 grey and alpha, 3 colour, 4 colour and alpha.
    channels: usize,
    maximum: u16,
    codes: Vec<u16>,
    provenance: Provenance,
}

impl Decoded {
    fn read(bytes: &[u8]) -> Result<Self, Kind> {
        let mut decoder = ::png::Decoder::new(Cursor::new(bytes));
        decoder.set_transformations(::png::Transformations::EXPAND);
        let mut reader = decoder.read_info().map_err(decoding)?;
        let size = reader.output_buffer_size().ok_or_else(size_mismatch)?;
        // Deflate makes at most 1032 bytes of one: larger sizes would only ask for memory.
        if size > bytes.len().saturating_mul(1032) {
            return Err(size_mismatch());
        }
        let mut data = vec![0; size];
        let frame = reader.next_frame(&mut data).map_err(decoding)?;
        data.truncate(frame.buffer_size());
        let (maximum, codes) = if frame.bit_depth == ::png::BitDepth::Sixteen {
            (u16::MAX, data.chunks_exact(2).map(|pair| u16::from_be_bytes([pair[0], pair[1]])).collect())
        } else {
            (255, data.into_iter().map(u16::from).collect())
        };
        let text = reader.info().utf8_text.iter().find(|chunk| chunk.keyword == PROVENANCE);
        let provenance = text.and_then(|chunk| chunk.get_text().ok()).map(|text| Provenance::from_json(&text));
        Ok(Self {
            width: frame.width as usize,
            height: frame.height as usize,
            channels: frame.color_type.samples(),
            maximum,
            codes,
            provenance: provenance.unwrap_or_default(),
        })
    }
}

fn decoding(error: ::png::DecodingError) -> Kind {
    Kind::Damaged(error.to_string())
}

fn encoding(error: ::png::EncodingError) -> Kind {
    match error {
        ::png::EncodingError::IoError(error) => Kind::Write(error),
        other => Kind::Write(std::io::Error::other(other)),
    }
}

fn size_mismatch() -> Kind {
    Kind::Damaged("its size and its data disagree".into())
}
