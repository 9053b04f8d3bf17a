//! How sight falls off from the point that the eye looks at: the gradient around task objects (paper, section 4.2 and
//! Figure 5).

use std::fmt;
use std::str::FromStr;

/// Relative resolution of the eye in [0, 1] as a function of eccentricity.
///
/// All are 1 within the fovea's radius and fall from there with the eccentricity beyond it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Falloff {
    /// The smallest resolvable angle grows linearly: w0 / (w0 + m e). Guenter, Finch, Drucker, Tan and Snyder 2012,
    /// with w0 = 1/48 degree and m = 1.32 arc minutes a degree, the more careful of the two slopes that they measured.
    MinimumAngle,
    /// Cortical magnification 29.2 / (e + 3.67) mm a degree (Dougherty and others 2003), relative to the fovea's.
    Cortical,
    /// The highest frequency that a contrast of 1 shows, e2 ln(1/CT0) / (a (e + e2)) with CT0 = 1/64, a = .106 and
    /// e2 = 2.3 (Geisler and Perry 1998), relative to what the display can show: 1 until the eye falls under the
    /// display's Nyquist frequency.
    GeislerPerry,
}

impl Falloff {
    /// All, in the order in which help texts list them.
    pub const ALL: [Self; 3] = [Self::MinimumAngle, Self::Cortical, Self::GeislerPerry];

    /// The name on the command line and in study files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::MinimumAngle => "mar",
            Self::Cortical => "cortical",
            Self::GeislerPerry => "geisler-perry",
        }
    }

    /// Relative resolution at `eccentricity_deg` >= 0 beyond the fovea's rim, on a display of `px_per_deg` > 0.
    #[must_use]
    pub fn relative_resolution(self, eccentricity_deg: f64, px_per_deg: f64) -> f64 {
        let e = eccentricity_deg.max(0.0);
        match self {
            Self::MinimumAngle => {
                const SMALLEST_DEG: f64 = 1.0 / 48.0;
                const SLOPE: f64 = 1.32 / 60.0;
                SMALLEST_DEG / (SMALLEST_DEG + SLOPE * e)
            }
            Self::Cortical => 3.67 / (3.67 + e),
            Self::GeislerPerry => {
                const E2_DEG: f64 = 2.3;
                let cut_off = |e: f64| E2_DEG * 64.0_f64.ln() / (0.106 * (e + E2_DEG));
                // On a display finer than the fovea the fovea is the limit.
                let most = (px_per_deg / 2.0).min(cut_off(0.0));
                (cut_off(e) / most).min(1.0)
            }
        }
    }
}

impl fmt::Display for Falloff {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Falloff {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        Self::ALL
            .into_iter()
            .find(|falloff| falloff.name() == name)
            .ok_or_else(|| format!("`{name}` is no falloff; one of mar, cortical, geisler-perry is"))
    }
}

/// A falloff around a fovea, on a display.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fovea {
    /// Diameter of the region seen sharply, in degrees of visual angle; 2 in the paper.
    pub diameter_deg: f64,
    /// How sight falls off outside it.
    pub falloff: Falloff,
    /// Pixels a degree of visual angle; 39.75 on the paper's display (17 inch, 1280 x 1024, at 60 cm).
    pub px_per_deg: f64,
}

impl Fovea {
    /// Importance in [0, 1] of a pixel that is `distance_px` from the nearest task object; 0 at infinity.
    #[must_use]
    pub fn importance(&self, distance_px: f64) -> f64 {
        let beyond_deg = distance_px / self.px_per_deg - self.diameter_deg / 2.0;
        self.falloff.relative_resolution(beyond_deg, self.px_per_deg)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PAPER_PX_PER_DEG: f64 = 39.75;

    #[test]
    fn published_values() {
        // Guenter 2012: at 20 degrees a resolvable angle of 1/48 + 20 x .022 degrees.
        let mar = Falloff::MinimumAngle.relative_resolution(20.0, PAPER_PX_PER_DEG);
        assert!((mar - (1.0 / 48.0) / (1.0 / 48.0 + 0.44)).abs() < 1e-12);
        // Dougherty 2003: half the fovea's magnification at 3.67 degrees.
        assert!((Falloff::Cortical.relative_resolution(3.67, PAPER_PX_PER_DEG) - 0.5).abs() < 1e-12);
        // Geisler and Perry 1998: the display's Nyquist frequency equals the cut-off at 2.24 degrees.
        let gp = |e| Falloff::GeislerPerry.relative_resolution(e, PAPER_PX_PER_DEG);
        assert_eq!(gp(2.2), 1.0);
        assert!(gp(2.3) < 1.0);
    }

    #[test]
    fn one_within_the_fovea_then_falling_to_nothing() {
        for falloff in Falloff::ALL {
            let fovea = Fovea { diameter_deg: 2.0, falloff, px_per_deg: PAPER_PX_PER_DEG };
            assert_eq!(fovea.importance(0.0), 1.0);
            assert_eq!(fovea.importance(39.7), 1.0, "one degree is the radius");
            let values: Vec<f64> = (0..1500).map(|px| fovea.importance(f64::from(px))).collect();
            assert!(values.windows(2).all(|pair| pair[1] <= pair[0]));
            assert!(values[1499] < 0.3);
            assert_eq!(fovea.importance(f64::INFINITY), 0.0);
            assert_eq!(falloff.name().parse(), Ok(falloff));
        }
        assert!("linear".parse::<Falloff>().is_err());
    }
}
