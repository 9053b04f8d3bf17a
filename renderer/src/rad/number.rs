//! Numbers as Radiance writes them.

/// Why a word is no number of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum NotANumber {
    /// Not the form of a number (`nan`, `inf` and hexadecimal are none).
    Form,
    /// Beyond what 64 bits hold: it would become infinite.
    Overflow,
}

/// Reads a real: a sign, digits with at most one point, an exponent (the form that Radiance accepts), and finite.
pub(super) fn real(word: &str) -> Result<f64, NotANumber> {
    let plain = word.bytes().all(|byte| byte.is_ascii_digit() || matches!(byte, b'+' | b'-' | b'.' | b'e' | b'E'));
    if !plain {
        return Err(NotANumber::Form);
    }
    match word.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        Ok(_) => Err(NotANumber::Overflow),
        Err(_) => Err(NotANumber::Form),
    }
}

/// Reads an integer.
pub(super) fn integer(word: &str) -> Result<i64, NotANumber> {
    let digits = word.strip_prefix(['+', '-']).unwrap_or(word);
    if digits.is_empty() || !digits.bytes().all(|byte| byte.is_ascii_digit()) {
        return Err(NotANumber::Form);
    }
    word.parse().map_err(|_| NotANumber::Overflow)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reals() {
        for (word, value) in [
            ("1", 1.0),
            ("-1.", -1.0),
            (".5", 0.5),
            ("+2e3", 2000.0),
            ("1E-2", 0.01),
            ("1e-400", 0.0),
            ("-.5e+1", -5.0),
        ] {
            assert_eq!(real(word), Ok(value), "{word}");
        }
        for word in ["", ".", "e5", "1e", "1e+", "nan", "inf", "-Infinity", "0x10", "1,5", "1d5", "--1", "1.2.3", "1_0"]
        {
            assert_eq!(real(word), Err(NotANumber::Form), "{word}");
        }
        assert_eq!(real("1e400"), Err(NotANumber::Overflow));
        assert_eq!(real(&"9".repeat(400)), Err(NotANumber::Overflow));
    }

    #[test]
    fn integers() {
        assert_eq!(integer("+12"), Ok(12));
        assert_eq!(integer("-3"), Ok(-3));
        assert_eq!(integer("99999999999999999999"), Err(NotANumber::Overflow));
        for word in ["", "-", "1.0", "1e3", "0x1"] {
            assert_eq!(integer(word), Err(NotANumber::Form), "{word}");
        }
    }
}
