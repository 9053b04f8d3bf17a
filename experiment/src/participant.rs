//! The code that stands for a person.

use crate::error::{Error, Result};

/// A participant's code is a pseudonym that can be a folder's name everywhere.
///
/// # Errors
/// If it is not 1 to 32 letters, digits, `-` or `_` of ASCII, beginning with a letter or digit.
pub fn check_code(code: &str) -> Result<()> {
    let fits = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
    let begins = code.starts_with(|c: char| c.is_ascii_alphanumeric());
    if begins && code.len() <= 32 && code.chars().all(fits) {
        return Ok(());
    }
    Err(Error::Input(format!(
        "`{code}` cannot be a participant's code: use 1 to 32 letters, digits, `-` and `_`, and no name of a person"
    )))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_that_are_no_codes_are_refused() {
        for code in ["", "../x", "a/b", "Ann Smith", "-x", ".", "caf\u{e9}", &"x".repeat(33)] {
            assert!(check_code(code).is_err(), "{code}");
        }
        for code in ["P01", "7", "a_b-c"] {
            assert!(check_code(code).is_ok(), "{code}");
        }
    }
}
