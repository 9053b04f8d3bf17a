//! OpenEXR: one part, linear `f32`, the beauty as `R G B` and each layer as `NAME.R NAME.G NAME.B`.

use std::fs::File;
use std::io::{BufWriter, Cursor};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread::JoinHandle;

use ::exr::block::chunk::Chunk;
use ::exr::block::writer::ChunksWriter;
use ::exr::block::{BlockIndex, UncompressedBlock};
use ::exr::meta::attribute::{AttributeValue, ChannelDescription, SampleType, Text};
use ::exr::meta::header::Header as ExrHeader;
use ::exr::meta::{BlockDescription, attribute::LineOrder};
use ::exr::prelude as api;
use rayon::prelude::*;

use super::grey::GreyMap;
use super::{Band, Compression, Header, Kind, Layer, Picture, Pixel, Provenance, Quantity};
use crate::color::WHITE_EFFICACY;
use crate::raster::Raster;

/// The one attribute of our own. The crate keeps several in a hash map, whose order changes from run to run.
const PROVENANCE: &str = "provenance";

/// Blocks sent to the file thread at a time, at most: enough to keep every core compressing.
const BLOCKS_AT_ONCE: usize = 16;

/// Bytes of them, about: up to three times as many wait, are compressed, and are filled at a time.
const BYTES_AT_ONCE: usize = 128 << 20;

/// Writes blocks of rows as they fill. The `exr` crate drives its file from a closure; a thread holds that closure and is fed
/// through a short queue, so memory stays bounded however slow the disk is.
#[derive(Debug)]
pub(super) struct ExrEncoder {
    /// `None` once the last block is sent.
    queue: Option<SyncSender<Vec<Vec<u8>>>>,
    file_thread: JoinHandle<Result<(), Kind>>,
    sources: Vec<Source>,
    width: usize,
    height: usize,
    rows_per_block: usize,
    blocks_at_once: usize,
    rows_done: usize,
    /// Native-endian bytes of the block being filled.
    block: Vec<u8>,
    full_blocks: Vec<Vec<u8>>,
}

/// Where a channel's numbers come from; channels are stored in the order of their names.
#[derive(Clone, Copy, Debug)]
struct Source {
    /// Index of the layer; `None` for the beauty.
    layer: Option<usize>,
    /// 0 red, 1 green, 2 blue.
    channel: usize,
}

impl ExrEncoder {
    pub(super) fn start(file: File, header: &Header) -> Result<Self, Kind> {
        let mut channels: Vec<(String, Source)> = Vec::new();
        let prefixes = std::iter::once((None, String::new()))
            .chain(header.layers.iter().enumerate().map(|(index, name)| (Some(index), format!("{name}."))));
        for (layer, prefix) in prefixes {
            for (channel, letter) in ["R", "G", "B"].into_iter().enumerate() {
                channels.push((format!("{prefix}{letter}"), Source { layer, channel }));
            }
        }
        channels.sort_by(|a, b| a.0.cmp(&b.0));
        let row_bytes = channels.len() * header.width * size_of::<f32>();
        let sources = channels.iter().map(|(_, source)| *source).collect();
        let exr_header = exr_header(header, channels.into_iter().map(|(name, _)| name));
        let rows_per_block = exr_header.compression.scan_lines_per_block();
        let (queue, blocks) = sync_channel(1);
        let file_thread = std::thread::Builder::new()
            .name("exr file".into())
            .spawn(move || write_blocks(file, exr_header, &blocks))
            .map_err(Kind::Write)?;
        Ok(Self {
            queue: Some(queue),
            file_thread,
            sources,
            width: header.width,
            height: header.height,
            rows_per_block,
            blocks_at_once: (BYTES_AT_ONCE / (row_bytes * rows_per_block)).clamp(1, BLOCKS_AT_ONCE),
            rows_done: 0,
            block: Vec::new(),
            full_blocks: Vec::new(),
        })
    }

    pub(super) fn write(&mut self, band: Band<'_>) -> Result<(), Kind> {
        for start in (0..band.beauty.len()).step_by(self.width) {
            let row = start..start + self.width;
            for source in &self.sources {
                let pixels = &source.layer.map_or(band.beauty, |index| band.layers[index])[row.clone()];
                let begin = self.block.len();
                self.block.resize(begin + pixels.len() * size_of::<f32>(), 0);
                for (bytes, pixel) in self.block[begin..].chunks_exact_mut(size_of::<f32>()).zip(pixels) {
                    bytes.copy_from_slice(&pixel[source.channel].to_ne_bytes());
                }
            }
            self.rows_done += 1;
            if self.rows_done.is_multiple_of(self.rows_per_block) || self.rows_done == self.height {
                self.full_blocks.push(std::mem::take(&mut self.block));
            }
            if self.full_blocks.len() == self.blocks_at_once {
                self.send();
            }
        }
        Ok(())
    }

    /// A file thread that has failed no longer listens; its error is told by [`ExrEncoder::finish`].
    fn send(&mut self) {
        if let Some(queue) = &self.queue {
            let _ = queue.send(std::mem::take(&mut self.full_blocks));
        }
    }

    pub(super) fn finish(mut self) -> Result<(), Kind> {
        self.send();
        self.queue = None;
        self.file_thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
    }
}

fn exr_header(header: &Header, names: impl Iterator<Item = String>) -> ExrHeader {
    // Every name is ASCII: the header was checked.
    let channels = names.map(|name| ChannelDescription::new(Text::new_or_panic(name), SampleType::F32, true)).collect();
    let compression = match header.compression {
        Compression::Zip => api::Compression::ZIP16,
        Compression::Piz => api::Compression::PIZ,
        Compression::Rle => api::Compression::RLE,
        Compression::Uncompressed => api::Compression::Uncompressed,
    };
    let mut exr_header = ExrHeader::new(Text::new_or_panic(""), api::Vec2(header.width, header.height), channels);
    exr_header.own_attributes.layer_name = None;
    // How bright (1, 1, 1) is, in cd/m2: a standard attribute that viewers know.
    exr_header.own_attributes.white_luminance = Some(WHITE_EFFICACY as f32);
    let provenance = AttributeValue::Text(Text::new_or_panic(header.provenance.to_json()));
    exr_header.own_attributes.other.insert(Text::new_or_panic(PROVENANCE), provenance);
    exr_header.with_encoding(compression, BlockDescription::ScanLines, LineOrder::Increasing)
}

/// The body of the file thread: compresses what comes, all cores at once, and writes it in order.
fn write_blocks(file: File, header: ExrHeader, blocks: &Receiver<Vec<Vec<u8>>>) -> Result<(), Kind> {
    let (width, height) = (header.layer_size.width(), header.layer_size.height());
    let rows_per_block = header.compression.scan_lines_per_block();
    let headers = std::iter::once(header).collect();
    ::exr::block::write(BufWriter::new(file), headers, true, |meta, writer| {
        let mut done = 0;
        while let Ok(group) = blocks.recv() {
            let compress = |(offset, data): (usize, Vec<u8>)| {
                let first_row = (done + offset) * rows_per_block;
                let rows = rows_per_block.min(height - first_row);
                let index = BlockIndex {
                    layer: 0,
                    pixel_position: api::Vec2(0, first_row),
                    pixel_size: api::Vec2(width, rows),
                    level: api::Vec2(0, 0),
                };
                UncompressedBlock { index, data }.compress_to_chunk(&meta.headers)
            };
            let group: Vec<_> = group.into_iter().enumerate().collect();
            let chunks: Result<Vec<Chunk>, _> = group.into_par_iter().map(compress).collect();
            for chunk in chunks? {
                writer.write_chunk(done, chunk)?;
                done += 1;
            }
        }
        Ok(())
    })
    .map_err(|error| match error {
        ::exr::error::Error::Io(error) => Kind::Write(error),
        other => Kind::Write(std::io::Error::other(other.to_string())),
    })
}

/// Refuses sizes that the file cannot hold: they would only ask for memory.
fn check_size(bytes: &[u8]) -> Result<(), Kind> {
    let damaged = |error: ::exr::error::Error| Kind::Damaged(error.to_string());
    let meta = ::exr::meta::MetaData::read_from_buffered(Cursor::new(bytes), false).map_err(damaged)?;
    for header in &meta.headers {
        let pixels = header.layer_size.width().saturating_mul(header.layer_size.height());
        let channels = header.channels.list.len().max(1);
        // Deflate makes at most 1032 bytes of one, two of which are a sample; the wavelet codecs do not reach that.
        if pixels.saturating_mul(channels) > bytes.len().saturating_mul(1032) {
            return Err(Kind::Damaged(format!("it is too short for {pixels} pixels of {channels} channels")));
        }
    }
    Ok(())
}

/// Reads the first part of a file: `R G B` (or `Y`) and every `NAME.R NAME.G NAME.B`.
pub(super) fn read(bytes: &[u8]) -> Result<Picture, Kind> {
    use api::{ReadChannels, ReadLayers, read};

    check_size(bytes)?;
    let image = read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .from_buffered(Cursor::new(bytes))
        .map_err(|error| Kind::Damaged(error.to_string()))?;
    let part = &image.layer_data;
    let (width, height) = (part.size.width(), part.size.height());
    let channel = |name: &str| {
        let found = part.channel_data.list.iter().find(|channel| channel.name.eq(name))?;
        (found.sampling == api::Vec2(1, 1)).then(|| found.sample_data.values_as_f32().collect::<Vec<f32>>())
    };
    let pixels = |prefix: &str| -> Option<Raster<Pixel>> {
        let [red, green, blue] = ["R", "G", "B"].map(|letter| channel(&format!("{prefix}{letter}")));
        let (red, green, blue) = (red?, green?, blue?);
        let pixels = red.into_iter().zip(green).zip(blue).map(|((red, green), blue)| [red, green, blue]);
        Raster::from_values(width, height, pixels.collect())
    };
    let grey = || {
        let values = channel("Y")?;
        Raster::from_values(width, height, values.into_iter().map(|value| [value; 3]).collect())
    };
    let beauty = pixels("").or_else(grey).ok_or_else(|| {
        let names: Vec<String> = part.channel_data.list.iter().map(|channel| channel.name.to_string()).collect();
        Kind::Damaged(format!("its first part has no channels R, G, B (or Y), only {}", names.join(", ")))
    })?;
    let mut names: Vec<String> = Vec::new();
    for channel in &part.channel_data.list {
        if let Some(name) = channel.name.to_string().strip_suffix(".R") {
            names.push(name.to_owned());
        }
    }
    let layers = names.into_iter().filter_map(|name| {
        let pixels = pixels(&format!("{name}."))?;
        Some(Layer { name, pixels })
    });
    let provenance = match part.attributes.other.get(&Text::new_or_panic(PROVENANCE)) {
        Some(AttributeValue::Text(text)) => Provenance::from_json(&text.to_string()),
        _ => Provenance::default(),
    };
    Ok(Picture { quantity: Quantity::Radiance, layers: layers.collect(), beauty, provenance })
}

/// Reads a map: the red channel, which must equal the others.
pub(super) fn read_grey(bytes: &[u8]) -> Result<GreyMap, Kind> {
    let Picture { beauty, .. } = read(bytes)?;
    let values: Option<Vec<f32>> = beauty
        .values()
        .iter()
        .map(|&[red, green, blue]| (red.to_bits() == green.to_bits() && red.to_bits() == blue.to_bits()).then_some(red))
        .collect();
    let values = values.ok_or(Kind::Colour)?;
    Raster::from_values(beauty.width(), beauty.height(), values)
        .ok_or_else(|| Kind::Damaged("its size and its data disagree".into()))
}
