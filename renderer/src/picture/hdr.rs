//! Radiance HDR pictures: the text header, the orientation line, the rows.

use std::io::Write;

use super::rgbe::{RowReader, decode, encode, encode_row};
use super::{Header, Kind, Picture, Pixel, Provenance, Quantity};
use crate::raster::Raster;

/// Writes a picture in the standard orientation, `-Y height +X width`.
#[derive(Debug)]
pub(super) struct HdrEncoder<W: Write> {
    stream: W,
    width: usize,
    exposure: f64,
    bytes: Vec<u8>,
}

impl<W: Write> HdrEncoder<W> {
    pub(super) fn start(mut stream: W, header: &Header) -> Result<Self, Kind> {
        let Provenance { software, crex, view, options, .. } = &header.provenance;
        let mut text = String::from("#?RADIANCE\n");
        let lines = [
            ("SOFTWARE= ", Some(software).filter(|name| !name.is_empty())),
            ("CREX= ", crex.as_ref()),
            ("OPTIONS= ", options.as_ref()),
            ("VIEW= ", view.as_ref()),
        ];
        for (name, value) in lines {
            if let Some(value) = value {
                text.push_str(name);
                // A line break would end the header line, and an empty one the header.
                text.push_str(&value.split_whitespace().collect::<Vec<_>>().join(" "));
                text.push('\n');
            }
        }
        text.push_str(&format!("EXPOSURE={:e}\nFORMAT=32-bit_rle_rgbe\n\n", header.exposure));
        text.push_str(&format!("-Y {} +X {}\n", header.height, header.width));
        stream.write_all(text.as_bytes()).map_err(Kind::Write)?;
        Ok(Self { stream, width: header.width, exposure: header.exposure, bytes: Vec::new() })
    }

    pub(super) fn write(&mut self, pixels: &[Pixel]) -> Result<(), Kind> {
        for row in pixels.chunks(self.width) {
            let exposed = |value: f32| (f64::from(value) * self.exposure) as f32;
            let row: Vec<_> = row.iter().map(|pixel| encode(pixel.map(exposed))).collect();
            self.bytes.clear();
            encode_row(&row, &mut self.bytes);
            self.stream.write_all(&self.bytes).map_err(Kind::Write)?;
        }
        Ok(())
    }

    pub(super) fn finish(mut self) -> Result<(), Kind> {
        self.stream.flush().map_err(Kind::Write)
    }
}

/// Pixels that a byte of a file stands for at most.
const MOST_PER_BYTE: usize = 16;

/// Pixels that any file may have.
const ANYWAY: usize = 1 << 22;

/// Reads a picture in any of the eight orientations and divides the exposures and colour corrections out of it.
pub(super) fn read(bytes: &[u8]) -> Result<Picture, Kind> {
    let mut text = Lines { bytes };
    let mut factor = [1.0f64; 3];
    let mut provenance = Provenance::default();
    let mut views: Vec<&str> = Vec::new();
    loop {
        let line = text.next().ok_or_else(|| Kind::Damaged("its header has no end".into()))?;
        if line.is_empty() {
            break;
        }
        let Some((name, value)) = line.split_once('=') else { continue };
        let value = value.trim();
        match name {
            "FORMAT" if value != "32-bit_rle_rgbe" => {
                return Err(Kind::Damaged(format!(
                    "FORMAT={value}; only 32-bit_rle_rgbe is read: convert it with ra_xyze -r"
                )));
            }
            "EXPOSURE" => {
                let exposure = positive_numbers::<1>(value).ok_or_else(|| bad_line(line))?;
                factor = factor.map(|product| product * exposure[0]);
            }
            "COLORCORR" => {
                let correction = positive_numbers::<3>(value).ok_or_else(|| bad_line(line))?;
                factor.iter_mut().zip(correction).for_each(|(product, value)| *product *= value);
            }
            "VIEW" => views.push(value),
            "SOFTWARE" => provenance.software = value.to_owned(),
            "CREX" => provenance.crex = Some(value.to_owned()),
            "OPTIONS" => provenance.options = Some(value.to_owned()),
            _ => {}
        }
    }
    // Later view options override earlier ones, as in a view file.
    provenance.view = (!views.is_empty()).then(|| views.join(" "));
    let line = text.next().unwrap_or_default();
    let layout = Layout::parse(line).ok_or_else(|| bad_line(line))?;
    // Sizes that the file cannot hold would only ask for memory: 127 pixels of a coded row take at least 8 bytes. (The old
    // code can hold more; no writer of such pictures is left, and some millions of pixels are let through.)
    let holds = text.bytes.len().saturating_mul(MOST_PER_BYTE).saturating_add(ANYWAY);
    if layout.rows.saturating_mul(4) > text.bytes.len() || layout.rows.saturating_mul(layout.columns) > holds {
        return Err(Kind::Damaged(format!("it is too short for `{line}`")));
    }
    let mut rows = RowReader::new(text.bytes);
    let mut row = vec![[0; 4]; layout.columns];
    let (width, height) = layout.size();
    let mut beauty = Raster::filled(width, height, [0.0; 3]);
    for scanline in 0..layout.rows {
        rows.read(&mut row)?;
        for (column, &bytes) in row.iter().enumerate() {
            let (x, y) = layout.position(column, scanline);
            let [red, green, blue] = decode(bytes).map(f64::from);
            *beauty.at_mut(x, y) = [(red / factor[0]) as f32, (green / factor[1]) as f32, (blue / factor[2]) as f32];
        }
    }
    Ok(Picture { quantity: Quantity::Radiance, beauty, layers: Vec::new(), provenance })
}

fn bad_line(line: &str) -> Kind {
    let shown: String = line.chars().take(60).collect();
    Kind::Damaged(format!("its header line `{shown}` makes no sense"))
}

fn positive_numbers<const N: usize>(text: &str) -> Option<[f64; N]> {
    let numbers: Vec<f64> = text.split_whitespace().map(|word| word.parse().ok()).collect::<Option<_>>()?;
    let numbers: [f64; N] = numbers.try_into().ok()?;
    numbers.iter().all(|&number| number > 0.0 && number.is_finite()).then_some(numbers)
}

/// Lines of the header; what is not UTF-8 reads as an empty name, which no header line uses.
struct Lines<'a> {
    bytes: &'a [u8],
}

impl<'a> Iterator for Lines<'a> {
    type Item = &'a str;

    fn next(&mut self) -> Option<&'a str> {
        let end = self.bytes.iter().position(|&byte| byte == b'\n')?;
        let line = &self.bytes[..end];
        self.bytes = &self.bytes[end + 1..];
        let line = line.strip_suffix(b"\r").unwrap_or(line);
        Some(std::str::from_utf8(line).unwrap_or("?"))
    }
}

/// The orientation line: how scan lines lie in the picture. `-Y` counts rows from the top, `+X` columns from the left.
struct Layout {
    rows: usize,
    columns: usize,
    /// Scan lines are columns of the picture.
    transposed: bool,
    /// Row 0 of the file is the bottom.
    upward: bool,
    /// Column 0 of the file is the right.
    leftward: bool,
}

impl Layout {
    fn parse(line: &str) -> Option<Self> {
        let words: Vec<&str> = line.split_whitespace().collect();
        let [major, rows, minor, columns] = words.try_into().ok()?;
        let (rows, columns) = (rows.parse().ok()?, columns.parse().ok()?);
        let transposed = match (major.get(1..)?, minor.get(1..)?) {
            ("Y", "X") => false,
            ("X", "Y") => true,
            _ => return None,
        };
        let sign = |word: &str| match word.as_bytes()[0] {
            b'+' => Some(true),
            b'-' => Some(false),
            _ => None,
        };
        let (y, x) = if transposed { (minor, major) } else { (major, minor) };
        let (upward, leftward) = (sign(y)?, !sign(x)?);
        (rows > 0 && columns > 0).then_some(Self { rows, columns, transposed, upward, leftward })
    }

    /// Width and height of the picture.
    fn size(&self) -> (usize, usize) {
        if self.transposed { (self.rows, self.columns) } else { (self.columns, self.rows) }
    }

    /// Where a pixel of a scan line lies in the picture, row 0 at the top.
    fn position(&self, column: usize, scanline: usize) -> (usize, usize) {
        let (width, height) = self.size();
        let (x, y) = if self.transposed { (scanline, column) } else { (column, scanline) };
        (if self.leftward { width - 1 - x } else { x }, if self.upward { height - 1 - y } else { y })
    }
}
