//! A field's text to its value. An error is the text "expected ..., found ...".

use super::{Interval, OnsetSource, Phase, Vsync};

/// A value that a field can hold.
pub(super) trait Field: Sized {
    /// What the field must hold, for the error message.
    const EXPECTED: &'static str;
    /// The value, or none if the text is not one.
    fn parse(text: &str) -> Option<Self>;
}

impl Field for bool {
    const EXPECTED: &'static str = "true or false";
    fn parse(text: &str) -> Option<Self> {
        match text {
            "true" => Some(true),
            "false" => Some(false),
            _ => None,
        }
    }
}

macro_rules! whole {
    ($($type:ty: $expected:literal),*) => {$(
        impl Field for $type {
            const EXPECTED: &'static str = $expected;
            fn parse(text: &str) -> Option<Self> {
                text.parse().ok()
            }
        }
    )*};
}
whole!(u8: "a whole number from 0 to 255", u32: "a whole number from 0 to 4294967295", u64: "a whole number");

impl Field for f64 {
    const EXPECTED: &'static str = "a finite number";
    fn parse(text: &str) -> Option<Self> {
        text.parse().ok().filter(|value: &f64| value.is_finite())
    }
}

impl Field for Phase {
    const EXPECTED: &'static str = "practice, critical, informed or check";
    fn parse(text: &str) -> Option<Self> {
        Some(match text {
            "practice" => Self::Practice,
            "critical" => Self::Critical,
            "informed" => Self::Informed,
            "check" => Self::Check,
            _ => return None,
        })
    }
}

impl Field for Interval {
    const EXPECTED: &'static str = "first or second";
    fn parse(text: &str) -> Option<Self> {
        match text {
            "first" => Some(Self::First),
            "second" => Some(Self::Second),
            _ => None,
        }
    }
}

impl Field for OnsetSource {
    const EXPECTED: &'static str = "swap_return, present or estimated";
    fn parse(text: &str) -> Option<Self> {
        Some(match text {
            "swap_return" => Self::SwapReturn,
            "present" => Self::Present,
            "estimated" => Self::Estimated,
            _ => return None,
        })
    }
}

impl Field for Vsync {
    const EXPECTED: &'static str = "verified or unverified";
    fn parse(text: &str) -> Option<Self> {
        match text {
            "verified" => Some(Self::Verified),
            "unverified" => Some(Self::Unverified),
            _ => None,
        }
    }
}

/// A required field.
pub(super) fn required<T: Field>(text: &str) -> Result<T, String> {
    T::parse(text).ok_or_else(|| expected(T::EXPECTED, text))
}

/// A field that may be empty.
pub(super) fn optional<T: Field>(text: &str) -> Result<Option<T>, String> {
    if text.is_empty() {
        return Ok(None);
    }
    T::parse(text).map(Some).ok_or_else(|| expected(&format!("{} or nothing", T::EXPECTED), text))
}

/// A name that may not be empty, into `target`, whose memory is used again.
pub(super) fn name(text: &str, target: &mut String) -> Result<(), String> {
    if text.trim().is_empty() {
        return Err("expected a name, found an empty field".to_owned());
    }
    any(text, target);
    Ok(())
}

/// Any text, into `target`.
pub(super) fn any(text: &str, target: &mut String) {
    target.clear();
    target.push_str(text);
}

/// A SHA-256 in hexadecimal digits.
pub(super) fn hash(text: &str, target: &mut String) -> Result<(), String> {
    if text.len() != 64 || !text.bytes().all(|byte| byte.is_ascii_hexdigit()) {
        return Err(expected("a SHA-256 of 64 hexadecimal digits", text) + ": was the log edited?");
    }
    any(text, target);
    Ok(())
}

/// A moment in universal time, `YYYY-MM-DDTHH:MM:SSZ`, seconds perhaps with a fraction.
pub(super) fn moment(text: &str, target: &mut String) -> Result<(), String> {
    let shape = b"dddd-dd-ddTdd:dd:dd";
    let bytes = text.as_bytes();
    let fits = bytes.len() > shape.len()
        && shape.iter().zip(bytes).all(|(form, byte)| match form {
            b'd' => byte.is_ascii_digit(),
            form => byte == form,
        });
    let rest = text.get(shape.len()..).unwrap_or("");
    let fraction = rest.strip_suffix('Z').map(|rest| rest.strip_prefix('.').map_or(rest.is_empty(), all_digits));
    if !fits || fraction != Some(true) {
        return Err(expected("a moment as 2005-11-29T09:30:00Z", text));
    }
    any(text, target);
    Ok(())
}

fn all_digits(text: &str) -> bool {
    !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit())
}

fn expected(what: &str, found: &str) -> String {
    let mut shown: String = found.chars().take(40).collect();
    if shown.len() < found.len() {
        shown.push_str("...");
    }
    if found.is_empty() {
        format!("expected {what}, found an empty field")
    } else {
        format!("expected {what}, found {shown:?}")
    }
}
