//! How the answers will be judged: fixed in the study file, before the first participant.

use serde::{Deserialize, Serialize};

/// Whose trial is left out. No limit looks at the answer to "which was worse".
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Exclusions {
    /// Leave out interrupted trials.
    pub interrupted: bool,
    /// Leave out trials on a display whose swaps were not seen to be paced by it.
    pub unverified_display: bool,
    /// Leave out those who knew the purpose.
    pub knew_task: bool,
    /// The most that a picture's onset may miss its time, milliseconds.
    pub max_onset_error_ms: f64,
    /// The most that a picture's duration may miss its time, milliseconds.
    pub max_duration_error_ms: f64,
    /// The most that either count may miss the true number of items.
    pub max_count_error: u32,
}

/// What will be computed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AnalysisPlan {
    /// The level of every test, two-sided where there are two sides.
    pub alpha: f64,
    /// The equivalence bound on the proportion correct, as a distance from 1/2.
    pub bound_proportion: f64,
    /// The same bound in JOD: 1 JOD is .25 of proportion correct.
    pub bound_jod: f64,
}

impl AnalysisPlan {
    /// The distance of the proportion correct from 1/2 that a difference of `jod` makes: one JOD is where three in four
    /// tell the two apart (Perez-Ortiz & Mantiuk 2017), so it is Phi(z jod) - 1/2 with z = Phi^-1(3/4).
    #[must_use]
    pub fn proportion_of_jod(jod: f64) -> f64 {
        const Z_THREE_QUARTERS: f64 = 0.674_489_750_196_081_7;
        phi_minus_half(Z_THREE_QUARTERS * jod)
    }
}

/// Phi(x) - 1/2 by Phi's series at 0 (Abramowitz & Stegun 26.2.11); beyond |x| = 8 it is a half to double precision.
fn phi_minus_half(x: f64) -> f64 {
    if x.abs() >= 8.0 {
        return 0.5_f64.copysign(x);
    }
    let density = (-0.5 * x * x).exp() / (2.0 * std::f64::consts::PI).sqrt();
    let (mut term, mut sum, mut odd) = (x, x, 1.0);
    while term.abs() > f64::EPSILON * sum.abs() {
        odd += 2.0;
        term *= x * x / odd;
        sum += term;
    }
    density * sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_jod_is_three_in_four() {
        assert!((AnalysisPlan::proportion_of_jod(1.0) - 0.25).abs() < 1e-12);
        assert_eq!(AnalysisPlan::proportion_of_jod(0.0), 0.0);
        assert!((AnalysisPlan::proportion_of_jod(0.2) - 0.054).abs() < 5e-4, "the method's page gives .054 for .2 JOD");
        assert_eq!(AnalysisPlan::proportion_of_jod(1e300), 0.5);
    }

    /// Phi at 1, 2 and 3 standard deviations (Abramowitz & Stegun, table 26.1).
    #[test]
    fn phi_has_its_tabled_values() {
        for (x, phi) in [(1.0, 0.841_344_746_068_543), (2.0, 0.977_249_868_051_821), (3.0, 0.998_650_101_968_370)] {
            assert!((phi_minus_half(x) + 0.5 - phi).abs() < 1e-14, "{x}");
            assert_eq!(phi_minus_half(-x), -phi_minus_half(x));
        }
    }
}
