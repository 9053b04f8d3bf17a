//! Numbers as a reader wants them.

/// A probability to four digits after the point, smaller ones in powers of ten, never a bare 0. `log10` is its logarithm,
/// used where the value itself is below the range of f64.
#[must_use]
pub fn p_value(p: f64, log10: f64) -> String {
    if p >= 0.9999 {
        "1".to_owned()
    } else if p >= 1e-4 {
        format!("{p:.4}")
    } else if p >= 1e-300 {
        format!("{p:.2e}")
    } else if log10.is_finite() {
        format!("10^{log10:.1}")
    } else {
        "below 1e-300".to_owned()
    }
}

/// `p = ...`.
#[must_use]
pub fn p_equals(p: f64, log10: f64) -> String {
    format!("p = {}", p_value(p, log10))
}

/// A share in percent with one digit, with more where it would round to 0 or 100.
#[must_use]
pub fn percent(share: f64) -> String {
    let percent = 100.0 * share;
    let rest = percent.min(100.0 - percent);
    if rest <= 0.0 || rest >= 0.05 {
        format!("{percent:.1} %")
    } else if percent < 50.0 {
        format!("{percent:.1e} %")
    } else {
        format!("(100 - {:.1e}) %", 100.0 - percent)
    }
}

/// Two ends of an interval in percent, with as many digits as they need to differ.
#[must_use]
pub fn percent_range([low, high]: [f64; 2]) -> String {
    let digits = digits_of(100.0 * (high - low), 1);
    if digits > 1 && low >= 5e-4 && high <= 1.0 - 5e-4 {
        return format!("{:.digits$} % to {:.digits$} %", 100.0 * low, 100.0 * high);
    }
    format!("{} to {}", percent(low), percent(high))
}

/// Two ends of an interval between 0 and 1, with three digits or as many as they need to differ.
#[must_use]
pub fn range([low, high]: [f64; 2]) -> String {
    let digits = digits_of(high - low, 3);
    format!("[{low:.digits$}, {high:.digits$}]")
}

/// Digits after the point that show a width, at least `least`.
fn digits_of(width: f64, least: usize) -> usize {
    if width > 0.0 { (1.0 - width.log10().floor()).clamp(least as f64, 12.0) as usize } else { least }
}

/// A number to about four digits.
#[must_use]
pub fn short(value: f64) -> String {
    let size = value.abs();
    if size == 0.0 {
        "0".to_owned()
    } else if !(1e-4..1e7).contains(&size) {
        format!("{value:.3e}")
    } else {
        let digits = (3 - size.log10().floor() as i32).clamp(0, 6) as usize;
        let text = format!("{value:.digits$}");
        if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
    }
}

/// A whole number with thin groups of three digits.
#[must_use]
pub fn grouped(n: u64) -> String {
    let digits = n.to_string();
    let mut text = String::new();
    for (at, digit) in digits.chars().enumerate() {
        if at > 0 && (digits.len() - at).is_multiple_of(3) && digits.len() > 4 {
            text.push('\u{202f}');
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn probabilities_are_never_zero() {
        assert_eq!(p_value(0.617_075, -0.2), "0.6171");
        assert_eq!(p_value(1.0, 0.0), "1");
        assert_eq!(p_value(3.21e-9, -8.5), "3.21e-9");
        assert_eq!(p_value(0.0, -436.043), "10^-436.0");
        assert_eq!(p_value(0.0, f64::NEG_INFINITY), "below 1e-300");
    }

    #[test]
    fn shares_never_round_to_certainty() {
        assert_eq!(percent(0.5625), "56.2 %");
        assert_eq!(percent(0.0), "0.0 %");
        assert_eq!(percent(1.0), "100.0 %");
        assert_eq!(percent(3.7e-9), "3.7e-7 %");
        assert_eq!(percent(1.0 - 1e-6), "(100 - 1.0e-4) %");
        assert_eq!(percent_range([0.25, 0.75]), "25.0 % to 75.0 %");
    }

    #[test]
    fn the_ends_of_an_interval_differ() {
        assert_eq!(percent_range([0.499_97, 0.500_032]), "49.9970 % to 50.0032 %");
        assert_eq!(percent_range([0.0, 3.7e-9]), "0.0 % to 3.7e-7 %");
        assert_eq!(percent_range([0.5, 0.5]), "50.0 % to 50.0 %");
        assert_eq!(range([0.298_8, 0.802_5]), "[0.299, 0.802]");
        assert_eq!(range([0.499_97, 0.500_032]), "[0.499970, 0.500032]");
    }

    #[test]
    fn numbers_keep_four_digits() {
        for (value, text) in [
            (0.25, "0.25"),
            (12.0, "12"),
            (2.9717, "2.972"),
            (1e300, "1.000e300"),
            (0.0, "0"),
            (1234.5, "1234"),
            (1e-7, "1.000e-7"),
        ] {
            assert_eq!(short(value), text);
        }
    }

    #[test]
    fn large_counts_are_grouped() {
        assert_eq!(grouped(1000), "1000");
        assert_eq!(grouped(1_000_000_000), "1\u{202f}000\u{202f}000\u{202f}000");
    }
}
