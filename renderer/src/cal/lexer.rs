//! Tokens of the function language: names, numbers, operators; `{comments}` that may nest.

/// A token and where it stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Token<'a> {
    pub(super) kind: TokenKind<'a>,
    /// Byte offsets.
    pub(super) start: usize,
    pub(super) end: usize,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum TokenKind<'a> {
    /// Starts with a letter or a context mark (`` ` ``); goes on with letters, digits, `_`, `.` and marks.
    Name(&'a str),
    Number(f64),
    /// Any other character: an operator, a bracket, or nothing of the language.
    Sign(char),
    End,
}

/// Why a text has no next token.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct BadToken {
    pub(super) start: usize,
    pub(super) end: usize,
    pub(super) message: &'static str,
}

/// Walks over a text, one token ahead.
pub(super) struct Lexer<'a> {
    text: &'a str,
    at: usize,
}

impl<'a> Lexer<'a> {
    pub(super) fn new(text: &'a str) -> Self {
        Self { text, at: 0 }
    }

    fn skip_blanks(&mut self) -> Result<(), BadToken> {
        let bytes = self.text.as_bytes();
        while let Some(&byte) = bytes.get(self.at) {
            match byte {
                b' ' | b'\t' | b'\n' | b'\r' | 0x0b | 0x0c => self.at += 1,
                b'{' => {
                    let start = self.at;
                    let mut depth = 0_usize;
                    loop {
                        match bytes.get(self.at) {
                            None => {
                                let message = "this comment is not closed: expected `}`";
                                return Err(BadToken { start, end: start + 1, message });
                            }
                            Some(b'{') => depth += 1,
                            Some(b'}') => depth -= 1,
                            Some(_) => {}
                        }
                        self.at += 1;
                        if depth == 0 {
                            break;
                        }
                    }
                }
                _ => break,
            }
        }
        Ok(())
    }

    pub(super) fn next(&mut self) -> Result<Token<'a>, BadToken> {
        self.skip_blanks()?;
        let start = self.at;
        let rest = &self.text[start..];
        let Some(first) = rest.chars().next() else {
            return Ok(Token { kind: TokenKind::End, start, end: start });
        };
        let kind = if first.is_ascii_alphabetic() || first == '`' {
            let length = rest
                .bytes()
                .take_while(|byte| byte.is_ascii_alphanumeric() || matches!(byte, b'_' | b'.' | b'`'))
                .count();
            self.at += length;
            TokenKind::Name(&rest[..length])
        } else if first.is_ascii_digit() || first == '.' {
            let length = number_length(rest.as_bytes());
            self.at += length;
            let value = rest[..length].parse().ok().filter(|value: &f64| value.is_finite());
            let message = "expected a number: digits with at most one point, an exponent, and within 64 bits";
            TokenKind::Number(value.ok_or(BadToken { start, end: self.at.max(start + 1), message })?)
        } else {
            self.at += first.len_utf8();
            TokenKind::Sign(first)
        };
        Ok(Token { kind, start, end: self.at })
    }
}

fn digits(bytes: &[u8]) -> usize {
    bytes.iter().take_while(|byte| byte.is_ascii_digit()).count()
}

/// How many bytes a number takes: at least one, though it may be none.
fn number_length(bytes: &[u8]) -> usize {
    let mut length = digits(bytes);
    if bytes.get(length) == Some(&b'.') {
        length += 1;
        length += digits(&bytes[length..]);
    }
    if matches!(bytes.get(length), Some(b'e' | b'E')) {
        length += 1;
        length += usize::from(matches!(bytes.get(length), Some(b'+' | b'-')));
        length += digits(&bytes[length..]);
    }
    length
}

#[cfg(test)]
mod tests {
    use super::*;

    fn kinds(text: &str) -> Vec<TokenKind<'_>> {
        let mut lexer = Lexer::new(text);
        std::iter::from_fn(|| Some(lexer.next().unwrap().kind).filter(|kind| *kind != TokenKind::End)).collect()
    }

    #[test]
    fn names_numbers_and_signs() {
        use TokenKind::{Name, Number, Sign};
        assert_eq!(kinds("a_1.b`c`=.5e-3*x"), [Name("a_1.b`c`"), Sign('='), Number(0.0005), Sign('*'), Name("x")]);
        assert_eq!(kinds("1.(2"), [Number(1.0), Sign('('), Number(2.0)]);
    }

    #[test]
    fn comments_nest() {
        assert_eq!(kinds("{ a { b } c } 1 {}"), [TokenKind::Number(1.0)]);
        assert!(Lexer::new("{ a { b }").next().is_err());
    }

    #[test]
    fn bad_numbers_are_told() {
        for text in [".", "1e", "1e+", "1e999"] {
            assert!(Lexer::new(text).next().is_err(), "{text}");
        }
    }
}
