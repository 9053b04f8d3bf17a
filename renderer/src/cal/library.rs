//! Functions that need no definition. What they return is finite: a call outside a function's domain, or one whose value
//! overflows, gives 0, as Radiance's evaluator does after its warning.

use super::noise;

/// A function of the library.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Library {
    If,
    Select,
    Min,
    Max,
    Rand,
    Floor,
    Ceil,
    Sqrt,
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
    Atan2,
    Exp,
    Log,
    Log10,
    Erf,
    Erfc,
    Arg,
    Noise3,
    Noise3x,
    Noise3y,
    Noise3z,
    Fnoise3,
    Hermite,
    Bezier,
    Bspline,
}

/// Who evaluates: the renderer's library has noise and the arguments of primitives, the generators' has splines.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dialect {
    /// gensurf(1), genrev(1), genworm(1): functions of parameters.
    Generator,
    /// Patterns, textures and materials: functions of a ray's hit.
    Ray,
}

impl Library {
    /// The function of a name.
    pub(super) fn named(name: &str, dialect: Dialect) -> Option<Self> {
        Some(match (name, dialect) {
            ("if", _) => Self::If,
            ("select", _) => Self::Select,
            ("min", _) => Self::Min,
            ("max", _) => Self::Max,
            ("rand", _) => Self::Rand,
            ("floor", _) => Self::Floor,
            ("ceil", _) => Self::Ceil,
            ("sqrt", _) => Self::Sqrt,
            ("sin", _) => Self::Sin,
            ("cos", _) => Self::Cos,
            ("tan", _) => Self::Tan,
            ("asin", _) => Self::Asin,
            ("acos", _) => Self::Acos,
            ("atan", _) => Self::Atan,
            ("atan2", _) => Self::Atan2,
            ("exp", _) => Self::Exp,
            ("log", _) => Self::Log,
            ("log10", _) => Self::Log10,
            ("erf", Dialect::Ray) => Self::Erf,
            ("erfc", Dialect::Ray) => Self::Erfc,
            ("arg", Dialect::Ray) => Self::Arg,
            ("noise3", Dialect::Ray) => Self::Noise3,
            ("noise3x", Dialect::Ray) => Self::Noise3x,
            ("noise3y", Dialect::Ray) => Self::Noise3y,
            ("noise3z", Dialect::Ray) => Self::Noise3z,
            ("fnoise3", Dialect::Ray) => Self::Fnoise3,
            ("hermite", Dialect::Generator) => Self::Hermite,
            ("bezier", Dialect::Generator) => Self::Bezier,
            ("bspline", Dialect::Generator) => Self::Bspline,
            _ => return None,
        })
    }

    /// How many arguments a call needs; more are ignored, but for `select`, `min` and `max`.
    pub(super) fn arguments(self) -> usize {
        match self {
            Self::Atan2 => 2,
            Self::If | Self::Noise3 | Self::Noise3x | Self::Noise3y | Self::Noise3z | Self::Fnoise3 => 3,
            Self::Hermite | Self::Bezier | Self::Bspline => 5,
            _ => 1,
        }
    }

    /// The value of a function whose arguments are all needed. The lazy ones and `arg` are the evaluator's business.
    pub(super) fn value(self, x: &[f64; 5]) -> f64 {
        match self {
            Self::Rand => rand(x[0]),
            Self::Floor => x[0].floor(),
            Self::Ceil => x[0].ceil(),
            Self::Sqrt => x[0].sqrt(),
            Self::Sin => x[0].sin(),
            Self::Cos => x[0].cos(),
            Self::Tan => x[0].tan(),
            Self::Asin => x[0].asin(),
            Self::Acos => x[0].acos(),
            Self::Atan => x[0].atan(),
            Self::Atan2 => x[0].atan2(x[1]),
            Self::Exp => x[0].exp(),
            Self::Log => x[0].ln(),
            Self::Log10 => x[0].log10(),
            Self::Erf => 1.0 - erfc(x[0]),
            Self::Erfc => erfc(x[0]),
            Self::Noise3 => noise::noise3([x[0], x[1], x[2]]),
            Self::Noise3x => noise::slope([x[0], x[1], x[2]], 0),
            Self::Noise3y => noise::slope([x[0], x[1], x[2]], 1),
            Self::Noise3z => noise::slope([x[0], x[1], x[2]], 2),
            Self::Fnoise3 => noise::fnoise3([x[0], x[1], x[2]]),
            Self::Hermite => hermite(x),
            Self::Bezier => bezier(x),
            Self::Bspline => bspline(x),
            Self::If | Self::Select | Self::Min | Self::Max | Self::Arg => 0.0,
        }
    }
}

/// The multiplier of [`rand`]: e to the digits that Radiance gives it.
#[allow(clippy::approx_constant, reason = "a hash needs these very digits")]
const SPREAD: f64 = 2.718_281_828_459_04;

/// A number in [0, 1) from another: Radiance's `rand` (calfunc.c), a hash rather than a random number.
fn rand(x: f64) -> f64 {
    let spread = x * (1.0 / (1.0 + x * x) + SPREAD);
    let fraction = spread + (0.785_398_163_397_447 - spread.floor());
    let scaled = 1e5 / fraction;
    scaled - scaled.floor()
}

/// Cubic from `p0` to `p1` with these slopes at its ends: (p0, p1, r0, r1, t).
fn hermite(&[p0, p1, r0, r1, t]: &[f64; 5]) -> f64 {
    let (square, cube) = (t * t, t * t * t);
    p0 * (2.0 * cube - 3.0 * square + 1.0)
        + p1 * (3.0 * square - 2.0 * cube)
        + r0 * (cube - 2.0 * square + t)
        + r1 * (cube - square)
}

/// Cubic with these control points: (p1, p2, p3, p4, t).
fn bezier(&[p1, p2, p3, p4, t]: &[f64; 5]) -> f64 {
    let s = 1.0 - t;
    p1 * s * s * s + 3.0 * p2 * s * s * t + 3.0 * p3 * s * t * t + p4 * t * t * t
}

/// Uniform cubic B-spline between its two middle points: (before, p0, p1, after, t).
fn bspline(&[before, p0, p1, after, t]: &[f64; 5]) -> f64 {
    let (s, square, cube) = (1.0 - t, t * t, t * t * t);
    (before * s * s * s
        + p0 * (3.0 * cube - 6.0 * square + 4.0)
        + p1 * (-3.0 * cube + 3.0 * square + 3.0 * t + 1.0)
        + after * cube)
        / 6.0
}

/// 1 - erf(x): the power series near 0 (Abramowitz and Stegun 7.1.6), beyond it the continued fraction 7.1.14 by Lentz's
/// method.
fn erfc(x: f64) -> f64 {
    let magnitude = x.abs();
    if x.is_nan() {
        return x;
    }
    if magnitude < 2.5 {
        let (mut term, mut sum, mut n) = (x, x, 0.0);
        while f64::abs(term) > 1e-17 * f64::abs(sum) {
            n += 1.0;
            term *= 2.0 * x * x / (2.0 * n + 1.0);
            sum += term;
        }
        return 1.0 - std::f64::consts::FRAC_2_SQRT_PI * (-x * x).exp() * sum;
    }
    if magnitude > 27.5 {
        return if x > 0.0 { 0.0 } else { 2.0 };
    }
    // x + (1/2)/(x + 1/(x + (3/2)/(x + ...)))
    let (mut value, mut c, mut d) = (magnitude, magnitude, 0.0);
    for n in 1..200 {
        let a = f64::from(n) / 2.0;
        d = 1.0 / (magnitude + a * d);
        c = magnitude + a / c;
        value *= c * d;
        if (c * d - 1.0).abs() < 1e-16 {
            break;
        }
    }
    let tail = (-magnitude * magnitude).exp() / (value * std::f64::consts::PI.sqrt());
    if x > 0.0 { tail } else { 2.0 - tail }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn error_function() {
        // Abramowitz and Stegun, tables 7.1 and 7.3.
        for (x, erf) in [
            (0.0, 0.0),
            (0.1, 0.112_462_916_0),
            (0.5, 0.520_499_877_8),
            (1.0, 0.842_700_792_9),
            (1.5, 0.966_105_146_5),
            (2.0, 0.995_322_265_0),
            (2.6, 0.999_763_965_6),
        ] {
            assert!((1.0 - erfc(x) - erf).abs() < 1e-10, "{x}");
            assert!((erfc(-x) - 1.0 - erf).abs() < 1e-10, "{x}");
        }
        assert!((erfc(2.499_999_999) / erfc(2.500_000_001) - 1.0).abs() < 1e-7);
        assert!((erfc(10.0) / 2.088_487_583_762_545e-45 - 1.0).abs() < 1e-12);
    }

    #[test]
    fn splines_pass_through_their_ends() {
        let ends = [3.0, -2.0, 0.5, 7.0];
        let at = |t: f64| [ends[0], ends[1], ends[2], ends[3], t];
        assert_eq!((hermite(&at(0.0)), hermite(&at(1.0))), (3.0, -2.0));
        assert_eq!((bezier(&at(0.0)), bezier(&at(1.0))), (3.0, 7.0));
        let slope = (hermite(&at(1e-7)) - hermite(&at(0.0))) / 1e-7;
        assert!((slope - 0.5).abs() < 1e-5);
        // Four equal points give that point.
        assert!((bspline(&[2.0, 2.0, 2.0, 2.0, 0.3]) - 2.0).abs() < 1e-15);
        assert!((bspline(&at(0.0)) - (3.0 + 4.0 * -2.0 + 0.5) / 6.0).abs() < 1e-15);
    }
}
