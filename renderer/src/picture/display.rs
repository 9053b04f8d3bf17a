//! The screen on which pictures are judged: how bright, how large, how far away.

use std::path::Path;

use serde::{Deserialize, Serialize};

/// A display and the place of the person before it, as a display file (TOML) gives them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Display {
    /// Luminance of white, cd/m2.
    pub peak_cd_m2: f64,
    /// Luminance of black in a dark room, cd/m2, above 0.
    pub black_cd_m2: f64,
    /// Illuminance on the screen, lux.
    #[serde(default)]
    pub ambient_lux: f64,
    /// Part of that light which the screen reflects diffusely; 0.01 for a matt screen.
    #[serde(default = "Display::usual_reflectivity")]
    pub reflectivity: f64,
    /// Pixels across.
    pub width_px: u32,
    /// Pixels down.
    pub height_px: u32,
    /// Visible width, metres.
    pub width_m: f64,
    /// From the eye to the screen, metres.
    pub distance_m: f64,
    /// How codes become light.
    #[serde(default)]
    pub transfer: Transfer,
}

/// How a display turns codes in [0, 1] into linear light in [0, 1].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Transfer {
    /// The sRGB curve: `transfer = "srgb"`.
    #[default]
    #[serde(with = "srgb_word")]
    Srgb,
    /// A power: `transfer = 2.2`.
    Gamma(f64),
}

mod srgb_word {
    use serde::{Deserialize, Deserializer, Serializer, de::Error};

    pub(super) fn serialize<S: Serializer>(serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str("srgb")
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<(), D::Error> {
        match String::deserialize(deserializer)?.as_str() {
            "srgb" => Ok(()),
            other => {
                Err(D::Error::custom(format!("`{other}` is no transfer curve: say \"srgb\" or a gamma such as 2.2")))
            }
        }
    }
}

/// A display file that makes no sense.
#[derive(Debug, thiserror::Error)]
pub enum DisplayError {
    /// It cannot be read.
    #[error("{path}: cannot be read: {error}")]
    Read {
        /// The file.
        path: String,
        /// Why.
        error: std::io::Error,
    },
    /// It is not the expected TOML; the message has line and column.
    #[error("{path}: {error}")]
    Toml {
        /// The file.
        path: String,
        /// What and where.
        error: toml::de::Error,
    },
    /// A number is out of its range.
    #[error("{field} is {value}; expected {expected}")]
    Range {
        /// The key.
        field: &'static str,
        /// Its value.
        value: f64,
        /// What would do.
        expected: &'static str,
    },
}

impl Display {
    fn usual_reflectivity() -> f64 {
        0.01
    }

    /// The screen of the 2005 experiment, a typical one of then: 17 inches, 1280 x 1024, 60 cm away, in a dim office (white
    /// 250 cd/m2, contrast 500, 50 lux of which 1 % is reflected).
    #[must_use]
    pub const fn of_the_paper() -> Self {
        Self {
            peak_cd_m2: 250.0,
            black_cd_m2: 0.5,
            ambient_lux: 50.0,
            reflectivity: 0.01,
            width_px: 1280,
            height_px: 1024,
            width_m: 0.3372,
            distance_m: 0.6,
            transfer: Transfer::Srgb,
        }
    }

    /// The same screen with pixels `factor` times as large, for pictures that have so many times fewer.
    #[must_use]
    pub fn with_larger_pixels(&self, factor: f64) -> Self {
        Self { width_m: self.width_m * factor, ..self.clone() }
    }

    /// Reads a display file.
    ///
    /// # Errors
    /// If it cannot be read, a key is missing or unknown, or a number is out of range.
    pub fn read(path: &Path) -> Result<Self, DisplayError> {
        let name = || path.display().to_string();
        let text = std::fs::read_to_string(path).map_err(|error| DisplayError::Read { path: name(), error })?;
        let display: Self = toml::from_str(&text).map_err(|error| DisplayError::Toml { path: name(), error })?;
        display.check()?;
        Ok(display)
    }

    /// # Errors
    /// If a number is out of its range.
    pub fn check(&self) -> Result<(), DisplayError> {
        let positive = |value: f64| value.is_finite() && value > 0.0;
        let range = |field, value: f64, good: bool, expected| {
            if good { Ok(()) } else { Err(DisplayError::Range { field, value, expected }) }
        };
        let peak = self.peak_cd_m2;
        range("peak_cd_m2", peak, peak.is_finite() && (0.005..=900_000.0).contains(&peak), "0.005 to 900000 cd/m2")?;
        let black = self.black_cd_m2;
        range("black_cd_m2", black, positive(black) && black <= peak, "more than 0 and at most peak_cd_m2")?;
        let lux = self.ambient_lux;
        range("ambient_lux", lux, (0.0..=200_000.0).contains(&lux), "0 to 200000 lux")?;
        let reflectivity = self.reflectivity;
        range("reflectivity", reflectivity, (0.0..=1.0).contains(&reflectivity), "0 to 1")?;
        range("width_px", self.width_px.into(), self.width_px > 0, "at least 1")?;
        range("height_px", self.height_px.into(), self.height_px > 0, "at least 1")?;
        range("width_m", self.width_m, positive(self.width_m), "a positive number of metres")?;
        range("distance_m", self.distance_m, positive(self.distance_m), "a positive number of metres")?;
        if let Transfer::Gamma(gamma) = self.transfer {
            range("transfer", gamma, (1.0..=4.0).contains(&gamma), "\"srgb\" or a gamma of 1 to 4")?;
        }
        Ok(())
    }

    /// Pixels in a degree of visual angle at the middle of the screen: 1 / (2 atan(pixel / 2 / distance)).
    #[must_use]
    pub fn pixels_per_degree(&self) -> f64 {
        let pixel_m = self.width_m / f64::from(self.width_px);
        1.0 / (2.0 * (0.5 * pixel_m / self.distance_m).atan()).to_degrees()
    }

    /// The linear light in [0, 1] that a code in [0, 1] shows, before black level and reflections.
    #[must_use]
    pub fn decode(&self, code: f64) -> f64 {
        match self.transfer {
            Transfer::Srgb => crate::color::srgb_decode(code),
            Transfer::Gamma(gamma) => code.clamp(0.0, 1.0).powf(gamma),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The 2005 experiment's screen: 17 inches, 1280 x 1024, seen from 60 cm.
    const PAPER: &str = "peak_cd_m2 = 250\nblack_cd_m2 = 0.5\nambient_lux = 50\nwidth_px = 1280\nheight_px = 1024\n\
                         width_m = 0.3372\ndistance_m = 0.6\n";

    fn read(text: &str) -> Result<Display, DisplayError> {
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), text).unwrap();
        Display::read(file.path())
    }

    #[test]
    fn the_papers_screen_has_forty_pixels_a_degree() {
        let display = read(PAPER).unwrap();
        assert!((display.pixels_per_degree() - 39.75).abs() < 0.01, "{}", display.pixels_per_degree());
        assert_eq!(display.transfer, Transfer::Srgb);
        assert_eq!(read(&format!("{PAPER}transfer = 2.2\n")).unwrap().transfer, Transfer::Gamma(2.2));
    }

    #[test]
    fn mistakes_are_named() {
        let cases = [
            (PAPER.replace("peak_cd_m2 = 250", "peak_cd_m2 = 0"), "peak_cd_m2"),
            (PAPER.replace("black_cd_m2 = 0.5", "black_cd_m2 = 0"), "black_cd_m2"),
            (PAPER.replace("distance_m = 0.6", "distance_m = nan"), "distance_m"),
            (format!("{PAPER}transfer = \"film\"\n"), "transfer"),
            (format!("{PAPER}nits = 3\n"), "nits"),
            (PAPER.replace("width_m = 0.3372\n", ""), "width_m"),
        ];
        for (text, word) in cases {
            let message = read(&text).unwrap_err().to_string();
            assert!(message.contains(word), "{message}");
        }
    }
}
