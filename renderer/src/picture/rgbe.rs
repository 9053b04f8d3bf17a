//! Radiance's shared-exponent pixels and their run-length coded rows (Radiance's file format reference, "Picture file format";
//! Ward 1991, "Real Pixels", Graphics Gems II).

use super::{Kind, Pixel};

/// Three mantissas and the exponent that they share.
pub(super) type Rgbe = [u8; 4];

/// Rows shorter or longer than this are stored flat.
const RUN_CODED_WIDTHS: std::ops::RangeInclusive<usize> = 8..=0x7fff;

/// A run shorter than this costs as much as the literal bytes.
const SHORTEST_RUN: usize = 4;

/// Encodes by truncation: a decoder adds half a unit, so the mean error is zero. Negative channels become 0; what exceeds the
/// format's largest value becomes that value.
pub(super) fn encode(pixel: Pixel) -> Rgbe {
    let [red, green, blue] = pixel.map(|value| f64::from(value.max(0.0)));
    let largest = red.max(green).max(blue);
    if largest <= 1e-32 {
        return [0; 4];
    }
    // An f32 is a normal f64: its exponent field gives `largest` = m 2^exponent with m in [1/2, 1).
    let exponent = ((largest.to_bits() >> 52) as i32 - 1022).min(127);
    let scale = 2f64.powi(8 - exponent);
    // The cast truncates and saturates at 255.
    [(red * scale) as u8, (green * scale) as u8, (blue * scale) as u8, (exponent + 128) as u8]
}

/// Decodes to the middle of the interval that encodes to these bytes.
pub(super) fn decode([red, green, blue, exponent]: Rgbe) -> Pixel {
    if exponent == 0 {
        return [0.0; 3];
    }
    let scale = 2f64.powi(i32::from(exponent) - 136);
    [red, green, blue].map(|mantissa| ((f64::from(mantissa) + 0.5) * scale) as f32)
}

/// Appends one row as it stands in a file.
pub(super) fn encode_row(row: &[Rgbe], out: &mut Vec<u8>) {
    if !RUN_CODED_WIDTHS.contains(&row.len()) {
        out.extend(row.iter().flatten());
        return;
    }
    out.extend([2, 2, (row.len() >> 8) as u8, (row.len() & 255) as u8]);
    let mut plane = Vec::with_capacity(row.len());
    for channel in 0..4 {
        plane.clear();
        plane.extend(row.iter().map(|pixel| pixel[channel]));
        encode_plane(&plane, out);
    }
}

/// Runs as (128 + length, value), anything else as (length, values).
fn encode_plane(plane: &[u8], out: &mut Vec<u8>) {
    let run_at = |at: usize| plane[at..].iter().take(127).take_while(|&&value| value == plane[at]).count();
    let mut at = 0;
    while at < plane.len() {
        let run = run_at(at);
        if run >= SHORTEST_RUN {
            out.extend([128 + run as u8, plane[at]]);
            at += run;
            continue;
        }
        let start = at;
        while at < plane.len() && at - start < 128 && run_at(at) < SHORTEST_RUN {
            at += 1;
        }
        out.push((at - start) as u8);
        out.extend(&plane[start..at]);
    }
}

/// Reads rows from the bytes that follow a header.
pub(super) struct RowReader<'a> {
    bytes: &'a [u8],
}

impl<'a> RowReader<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        Self { bytes }
    }

    /// Fills `row` from the next row in the file, new, old or flat.
    pub(super) fn read(&mut self, row: &mut [Rgbe]) -> Result<(), Kind> {
        let start = *self.bytes.first_chunk::<4>().ok_or_else(cut_short)?;
        let is_new = RUN_CODED_WIDTHS.contains(&row.len()) && start[..2] == [2, 2] && start[2] < 128;
        if !is_new {
            return self.read_old(row);
        }
        if usize::from(start[2]) << 8 | usize::from(start[3]) != row.len() {
            return Err(Kind::Damaged("a row's length differs from the picture's width".into()));
        }
        self.bytes = &self.bytes[4..];
        for channel in 0..4 {
            let mut x = 0;
            while x < row.len() {
                let code = self.take(1)?[0];
                let count = usize::from(if code > 128 { code - 128 } else { code });
                if count == 0 || count > row.len() - x {
                    return Err(Kind::Damaged("a run goes past the end of its row".into()));
                }
                let values = self.take(if code > 128 { 1 } else { count })?;
                for (offset, pixel) in row[x..x + count].iter_mut().enumerate() {
                    pixel[channel] = values[offset % values.len()];
                }
                x += count;
            }
        }
        Ok(())
    }

    /// Flat pixels, among which (1, 1, 1, n) repeats the last pixel; successive ones are the bytes of a longer count.
    fn read_old(&mut self, row: &mut [Rgbe]) -> Result<(), Kind> {
        let (mut x, mut shift) = (0, 0);
        while x < row.len() {
            let pixel: Rgbe = *self.bytes.first_chunk().ok_or_else(cut_short)?;
            self.bytes = &self.bytes[4..];
            if pixel[..3] != [1, 1, 1] {
                row[x] = pixel;
                x += 1;
                shift = 0;
                continue;
            }
            let count = usize::from(pixel[3]).checked_shl(shift).unwrap_or(usize::MAX);
            if x == 0 || count > row.len() - x || shift > 24 {
                return Err(Kind::Damaged("a run goes past its row".into()));
            }
            let last = row[x - 1];
            row[x..x + count].fill(last);
            x += count;
            shift += 8;
        }
        Ok(())
    }

    fn take(&mut self, count: usize) -> Result<&'a [u8], Kind> {
        let (taken, rest) = self.bytes.split_at_checked(count).ok_or_else(cut_short)?;
        self.bytes = rest;
        Ok(taken)
    }
}

fn cut_short() -> Kind {
    Kind::Damaged("the file ends before its last row".into())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn published_examples_encode_as_radiance_does() {
        // v = (m + .5) 2^(e - 136): 1 is mantissa 128 at exponent 129.
        assert_eq!(encode([1.0, 0.5, 0.25]), [128, 64, 32, 129]);
        assert_eq!(decode([128, 64, 32, 129]), [128.5 / 128.0, 64.5 / 128.0, 32.5 / 128.0]);
        // Truncation, not rounding: 0.999 of a unit below the next step stays below.
        assert_eq!(encode([255.9, 0.0, 0.0]), [255, 0, 0, 136]);
        assert_eq!(encode([256.0, 0.0, 0.0]), [128, 0, 0, 137]);
    }

    #[test]
    fn the_ends_of_the_range() {
        assert_eq!(encode([0.0; 3]), [0; 4]);
        assert_eq!(decode([0; 4]), [0.0; 3]);
        assert_eq!(encode([1e-38; 3]), [0; 4], "under 1e-32 is black");
        assert_eq!(encode([-1.0, -0.0, -1e30]), [0; 4], "negative light is black");
        assert_eq!(encode([-1.0, 1.0, 0.0])[0], 0);
        let [large, ..] = decode(encode([1e38; 3]));
        assert!((large / 1e38 - 1.0).abs() < 0.004, "{large}");
        assert_eq!(encode([f32::MAX, 1.0, 0.0]), [255, 0, 0, 255], "beyond the format's largest value");
    }

    proptest! {
        /// Ward's error bound: the largest channel is within half a unit, that is 1/256 relative; the others within the same
        /// absolute distance.
        #[test]
        fn a_round_trip_is_within_half_a_unit(exponent in -30i32..37, mantissa in prop::array::uniform3(0f32..1.0)) {
            let pixel = mantissa.map(|value| value * 10f32.powi(exponent));
            let largest = pixel.into_iter().fold(0.0, f32::max);
            prop_assume!(largest > 1e-31);
            let again = decode(encode(pixel));
            for (before, after) in pixel.into_iter().zip(again) {
                prop_assert!((before - after).abs() <= largest / 256.0 * 1.000_001, "{before} became {after}");
            }
        }

        /// What was decoded encodes to the same bytes: pictures survive any number of readings and writings.
        #[test]
        fn decoded_values_are_fixed_points(mantissas in prop::array::uniform3(0u8..), exponent in 30u8..) {
            let mut bytes = [mantissas[0], mantissas[1], mantissas[2], exponent];
            // A normal code has a mantissa with its top bit set.
            bytes[usize::from(exponent) % 3] |= 128;
            prop_assert_eq!(encode(decode(bytes)), bytes);
        }

        #[test]
        fn rows_survive_run_length_coding(row in row()) {
            let mut bytes = Vec::new();
            encode_row(&row, &mut bytes);
            let mut again = vec![[0; 4]; row.len()];
            RowReader::new(&bytes).read(&mut again).unwrap();
            prop_assert_eq!(again, row);
        }

        #[test]
        fn random_bytes_never_panic(bytes in prop::collection::vec(0u8..5, 0..200), width in 1usize..40) {
            let _ = RowReader::new(&bytes).read(&mut vec![[0; 4]; width]);
        }
    }

    /// Rows with runs, of widths on both sides of the run-coded ones.
    fn row() -> impl Strategy<Value = Vec<Rgbe>> {
        // Values over 2 keep a flat row from looking like a coded one, as real exponents do.
        prop::collection::vec((prop::array::uniform4(3u8..9), 1usize..200), 1..20)
            .prop_map(|runs| runs.into_iter().flat_map(|(pixel, count)| vec![pixel; count]).collect())
    }

    #[test]
    fn rows_too_narrow_or_wide_are_flat() {
        for width in [1, 7, 0x8000] {
            let row = vec![[9, 8, 7, 130]; width];
            let mut bytes = Vec::new();
            encode_row(&row, &mut bytes);
            assert_eq!(bytes.len(), 4 * width);
            let mut again = vec![[0; 4]; width];
            RowReader::new(&bytes).read(&mut again).unwrap();
            assert_eq!(again, row);
        }
    }

    #[test]
    fn old_runs_are_read() {
        // One pixel, repeated 2 + 256 times: the second count is shifted by eight bits.
        let bytes = [10, 20, 30, 130, 1, 1, 1, 2, 1, 1, 1, 1, 5, 5, 5, 129];
        let mut row = vec![[0; 4]; 260];
        RowReader::new(&bytes).read(&mut row).unwrap();
        assert!(row[..259].iter().all(|&pixel| pixel == [10, 20, 30, 130]));
        assert_eq!(row[259], [5, 5, 5, 129]);
    }
}
