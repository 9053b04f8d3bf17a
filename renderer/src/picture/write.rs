//! Writing pictures in any format, row by row.

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

use super::AtomicFile;
use super::exr::ExrEncoder;
use super::hdr::HdrEncoder;
use super::png::PngEncoder;
use super::{Error, Kind, Picture, Pixel, Provenance};

/// A picture file format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// OpenEXR, single part, linear `f32`, with layers.
    Exr,
    /// Radiance's RGBE picture, linear, 8 bits of mantissa.
    Hdr,
    /// Portable Network Graphics, sRGB, 8 bits.
    Png,
}

impl Format {
    /// The format that a file's name asks for: `.exr`, `.hdr` or `.pic`, `.png`, in any case.
    #[must_use]
    pub fn of_name(path: &Path) -> Option<Self> {
        let extension = path.extension()?.to_str()?.to_ascii_lowercase();
        Some(match extension.as_str() {
            "exr" => Self::Exr,
            "hdr" | "pic" => Self::Hdr,
            "png" => Self::Png,
            _ => return None,
        })
    }

    /// The format that a file's first bytes announce.
    #[must_use]
    pub fn of_bytes(bytes: &[u8]) -> Option<Self> {
        if bytes.starts_with(&[0x76, 0x2f, 0x31, 0x01]) {
            Some(Self::Exr)
        } else if bytes.starts_with(b"#?") {
            Some(Self::Hdr)
        } else if bytes.starts_with(b"\x89PNG\r\n\x1a\n") {
            Some(Self::Png)
        } else {
            None
        }
    }
}

/// How an EXR file is packed. All are lossless; they trade the writer's time against the file's size.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Compression {
    /// Deflate over blocks of 16 rows: smallest, slowest.
    #[default]
    Zip,
    /// Wavelet and Huffman.
    Piz,
    /// Run lengths: fast.
    Rle,
    /// None: fastest, largest.
    Uncompressed,
}

/// What a writer must know before the first row.
#[derive(Clone, Debug, PartialEq)]
pub struct Header {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// The names of the layers that follow the beauty in every band. Only EXR stores them.
    pub layers: Vec<String>,
    /// How an EXR is packed.
    pub compression: Compression,
    /// Whether the file is forced onto the disk before it gets its name ([`AtomicFile::commit`]).
    pub durable: bool,
    /// HDR and PNG store radiance x exposure (HDR says so in its header; PNG clamps the product to [0, 1]). EXR always stores
    /// radiance.
    pub exposure: f64,
    /// How the picture is made.
    pub provenance: Provenance,
}

impl Header {
    /// A header without layers, at exposure 1, of a file that is durable.
    #[must_use]
    pub fn new(width: usize, height: usize, provenance: Provenance) -> Self {
        let (layers, compression, durable) = (Vec::new(), Compression::default(), true);
        Self { width, height, layers, compression, durable, exposure: 1.0, provenance }
    }

    /// The provenance that a format whose values are scaled by the exposure stores.
    pub(super) fn exposed_provenance(&self) -> Provenance {
        let exposure = (self.exposure != 1.0).then_some(self.exposure);
        Provenance { exposure, ..self.provenance.clone() }
    }

    fn check(&self) -> Result<(), Kind> {
        let limit = i32::MAX as usize;
        if self.width == 0 || self.height == 0 || self.width > limit || self.height > limit {
            return Err(Kind::Rows(format!("{} x {} is no size of a picture", self.width, self.height)));
        }
        if !(self.exposure.is_finite() && self.exposure > 0.0) {
            return Err(Kind::Rows(format!("exposure {} must be positive", self.exposure)));
        }
        for (index, name) in self.layers.iter().enumerate() {
            if name.is_empty() || name.len() > 200 || !name.bytes().all(|byte| byte.is_ascii_graphic()) {
                return Err(Kind::Rows(format!("`{name}` is no name of a layer")));
            }
            if self.layers[..index].contains(name) {
                return Err(Kind::Rows(format!("two layers are called `{name}`")));
            }
        }
        Ok(())
    }
}

/// Some full rows of a picture, from the row after the last band's.
#[derive(Clone, Copy, Debug)]
pub struct Band<'a> {
    /// Beauty pixels, row by row; a whole number of rows.
    pub beauty: &'a [Pixel],
    /// The same rows of each layer, in the header's order.
    pub layers: &'a [&'a [Pixel]],
}

/// Follows the rows of a picture as they come, and refuses what does not fit.
#[derive(Debug)]
struct Progress {
    width: usize,
    height: usize,
    layers: Vec<String>,
    rows_done: usize,
}

impl Progress {
    fn new(header: &Header) -> Self {
        Self { width: header.width, height: header.height, layers: header.layers.clone(), rows_done: 0 }
    }

    fn accept(&mut self, band: Band<'_>) -> Result<(), Kind> {
        let rows = band.beauty.len() / self.width;
        if !band.beauty.len().is_multiple_of(self.width)
            || band.layers.len() != self.layers.len()
            || band.layers.iter().any(|layer| layer.len() != band.beauty.len())
        {
            return Err(Kind::Rows("a band of rows does not have the picture's width and layers".into()));
        }
        if rows > self.height - self.rows_done {
            return Err(Kind::Rows(format!("more rows than the picture's {}", self.height)));
        }
        let named = std::iter::once(("beauty", band.beauty))
            .chain(self.layers.iter().map(String::as_str).zip(band.layers.iter().copied()));
        for (name, pixels) in named {
            if let Some(index) = pixels.iter().position(|pixel| !pixel.iter().all(|value| value.is_finite())) {
                let value = pixels[index].into_iter().find(|value| !value.is_finite()).unwrap_or(f32::NAN);
                let (x, y) = (index % self.width, self.rows_done + index / self.width);
                return Err(Kind::NotFinite { layer: name.to_owned(), x, y, value });
            }
        }
        self.rows_done += rows;
        Ok(())
    }

    fn finish(&self) -> Result<(), Kind> {
        if self.rows_done < self.height {
            return Err(Kind::Rows(format!("only {} of the picture's {} rows came", self.rows_done, self.height)));
        }
        Ok(())
    }
}

#[derive(Debug)]
enum Encoder {
    Exr(ExrEncoder),
    Hdr(HdrEncoder<BufWriter<File>>),
    Png(Box<PngEncoder<BufWriter<File>>>),
}

/// A picture file being written: takes rows from the top, and appears under its name when [`PictureFile::finish`] succeeds.
#[derive(Debug)]
pub struct PictureFile {
    path: PathBuf,
    progress: Progress,
    encoder: Encoder,
    file: AtomicFile,
    durable: bool,
}

impl PictureFile {
    /// Starts a picture in the format that `path` ends in.
    ///
    /// # Errors
    /// If the name says no format, the header makes no sense or the folder cannot be written to.
    pub fn create(path: &Path, header: &Header) -> Result<Self, Error> {
        Self::open(path, header).map_err(|kind| Error::new(path, kind))
    }

    fn open(path: &Path, header: &Header) -> Result<Self, Kind> {
        let format = Format::of_name(path).ok_or(Kind::Extension)?;
        header.check()?;
        let file = AtomicFile::create(path).map_err(Kind::Write)?;
        let handle = file.handle().map_err(Kind::Write)?;
        let encoder = match format {
            Format::Exr => Encoder::Exr(ExrEncoder::start(handle, header)?),
            Format::Hdr => Encoder::Hdr(HdrEncoder::start(BufWriter::new(handle), header)?),
            Format::Png => Encoder::Png(Box::new(PngEncoder::start(BufWriter::new(handle), header)?)),
        };
        Ok(Self { path: path.to_owned(), progress: Progress::new(header), encoder, file, durable: header.durable })
    }

    /// Takes the next rows.
    ///
    /// # Errors
    /// If the rows do not fit the header, a value is not finite, or the disk refuses.
    pub fn write(&mut self, band: Band<'_>) -> Result<(), Error> {
        self.progress
            .accept(band)
            .and_then(|()| match &mut self.encoder {
                Encoder::Exr(encoder) => encoder.write(band),
                Encoder::Hdr(encoder) => encoder.write(band.beauty),
                Encoder::Png(encoder) => encoder.write(band.beauty),
            })
            .map_err(|kind| Error::new(&self.path, kind))
    }

    /// Completes the file, puts it on disk if it is to be durable, and gives it its name.
    ///
    /// # Errors
    /// If rows are missing or the disk refuses; the name then means what it meant before.
    pub fn finish(self) -> Result<(), Error> {
        let Self { path, progress, encoder, file, durable } = self;
        progress
            .finish()
            .and_then(|()| match encoder {
                Encoder::Exr(encoder) => encoder.finish(),
                Encoder::Hdr(encoder) => encoder.finish(),
                Encoder::Png(encoder) => encoder.finish(),
            })
            .and_then(|()| if durable { file.commit() } else { file.commit_unsynced() }.map_err(Kind::Write))
            .map_err(|kind| Error::new(&path, kind))
    }
}

/// A Radiance HDR picture written to a stream, such as standard output.
#[derive(Debug)]
pub struct HdrStream<W: Write> {
    progress: Progress,
    encoder: HdrEncoder<W>,
}

impl<W: Write> HdrStream<W> {
    /// Writes the header.
    ///
    /// # Errors
    /// If the header makes no sense or the stream refuses.
    pub fn start(stream: W, header: &Header) -> Result<Self, Error> {
        header
            .check()
            .and_then(|()| HdrEncoder::start(stream, header))
            .map(|encoder| Self { progress: Progress::new(header), encoder })
            .map_err(|kind| Error::new(Path::new("-"), kind))
    }

    /// Takes the next rows.
    ///
    /// # Errors
    /// If the rows do not fit the header, a value is not finite, or the stream refuses.
    pub fn write(&mut self, band: Band<'_>) -> Result<(), Error> {
        self.progress
            .accept(band)
            .and_then(|()| self.encoder.write(band.beauty))
            .map_err(|kind| Error::new(Path::new("-"), kind))
    }

    /// Flushes the stream.
    ///
    /// # Errors
    /// If rows are missing or the stream refuses.
    pub fn finish(self) -> Result<(), Error> {
        self.progress.finish().and_then(|()| self.encoder.finish()).map_err(|kind| Error::new(Path::new("-"), kind))
    }
}

/// Writes a whole picture at exposure 1, in the format that `path` ends in.
///
/// # Errors
/// If a value is not finite, a layer differs in size, or the disk refuses.
pub fn write(path: &Path, picture: &Picture, compression: Compression) -> Result<(), Error> {
    let mut header = Header::new(picture.beauty.width(), picture.beauty.height(), picture.provenance.clone());
    header.layers = picture.layers.iter().map(|layer| layer.name.clone()).collect();
    header.compression = compression;
    let mut file = PictureFile::create(path, &header)?;
    let layers: Vec<&[Pixel]> = picture.layers.iter().map(|layer| layer.pixels.values()).collect();
    file.write(Band { beauty: picture.beauty.values(), layers: &layers })?;
    file.finish()
}
