//! Words of scene text, as Radiance's readers cut them.
//!
//! Words stand between blanks. A quote (`"` or `'`) anywhere in a word makes blanks part of it up to the same quote;
//! the quotes themselves are dropped, so `a" "b` is the word `a b`, and `""` is an empty word. `#` has no meaning here:
//! whether a comment may start is known to the reader of primitives alone.

/// A cut word and where it stands.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Word<'a> {
    /// The word without its quotes.
    pub(super) text: std::borrow::Cow<'a, str>,
    /// Byte offset of its first character, a quote if it starts with one.
    pub(super) start: usize,
    /// Byte offset after its last character.
    pub(super) end: usize,
    /// Byte offset of a quote that the text does not close.
    pub(super) unclosed: Option<usize>,
}

/// Walks over a text.
#[derive(Clone, Debug)]
pub(super) struct Lexer<'a> {
    text: &'a str,
    at: usize,
}

/// What C's `isspace` takes for a blank.
pub(super) fn is_blank(byte: u8) -> bool {
    matches!(byte, b' ' | b'\t' | b'\n' | b'\r' | 0x0b | 0x0c)
}

impl<'a> Lexer<'a> {
    pub(super) fn new(text: &'a str, at: usize) -> Self {
        Self { text, at }
    }

    pub(super) fn offset(&self) -> usize {
        self.at
    }

    pub(super) fn set_offset(&mut self, at: usize) {
        self.at = at;
    }

    /// Steps over blanks; the byte that follows, if any.
    pub(super) fn peek(&mut self) -> Option<u8> {
        let rest = &self.text.as_bytes()[self.at..];
        self.at += rest.iter().take_while(|&&byte| is_blank(byte)).count();
        self.text.as_bytes().get(self.at).copied()
    }

    /// Steps over the rest of the line and its end.
    pub(super) fn skip_line(&mut self) {
        let rest = &self.text.as_bytes()[self.at..];
        self.at += rest.iter().position(|&byte| byte == b'\n').map_or(rest.len(), |end| end + 1);
    }

    /// The rest of the line; a line that ends in a backslash goes on. Gives the bytes' range, the last line end not
    /// included.
    pub(super) fn command_line(&mut self) -> (usize, usize) {
        let start = self.at;
        let bytes = self.text.as_bytes();
        loop {
            let line = self.at;
            self.skip_line();
            let mut end = self.at;
            // Past the last line end there is no line to go on with.
            if end > line && bytes[end - 1] == b'\n' {
                end -= 1;
            } else {
                return (start, end);
            }
            if end > start && bytes[end - 1] == b'\r' {
                end -= 1;
            }
            if end == start || bytes[end - 1] != b'\\' {
                return (start, end);
            }
        }
    }

    /// The next word, or `None` at the end.
    pub(super) fn word(&mut self) -> Option<Word<'a>> {
        self.peek()?;
        let (start, bytes) = (self.at, self.text.as_bytes());
        let plain = bytes[start..].iter().take_while(|&&byte| !is_blank(byte) && byte != b'"' && byte != b'\'').count();
        if bytes.get(start + plain).is_none_or(|&byte| is_blank(byte)) {
            self.at = start + plain;
            let text = std::borrow::Cow::Borrowed(&self.text[start..self.at]);
            return Some(Word { text, start, end: self.at, unclosed: None });
        }
        let (mut text, mut open, mut piece) = (String::new(), None, start);
        let mut at = start;
        while let Some(&byte) = bytes.get(at) {
            match open {
                None if is_blank(byte) => break,
                None if byte == b'"' || byte == b'\'' => {
                    text.push_str(&self.text[piece..at]);
                    open = Some((byte, at));
                    piece = at + 1;
                }
                Some((quote, _)) if byte == quote => {
                    text.push_str(&self.text[piece..at]);
                    open = None;
                    piece = at + 1;
                }
                _ => {}
            }
            at += 1;
        }
        text.push_str(&self.text[piece..at]);
        self.at = at;
        Some(Word { text: text.into(), start, end: at, unclosed: open.map(|(_, at)| at) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(text: &str) -> Vec<String> {
        let mut lexer = Lexer::new(text, 0);
        std::iter::from_fn(|| lexer.word()).map(|word| word.text.into_owned()).collect()
    }

    #[test]
    fn words_stand_between_blanks() {
        assert_eq!(words(" a\tb\r\nc\x0b\x0cd "), ["a", "b", "c", "d"]);
        assert_eq!(words("   "), [""; 0]);
    }

    #[test]
    fn quotes_hold_blanks_and_vanish() {
        assert_eq!(words(r#""a b" 'c "d' e"f g"h '' x"#), ["a b", "c \"d", "ef gh", "", "x"]);
    }

    #[test]
    fn an_open_quote_is_told() {
        let word = Lexer::new("ab'cd ef", 0).word().unwrap();
        assert_eq!((word.text.as_ref(), word.unclosed), ("abcd ef", Some(2)));
    }

    #[test]
    fn a_hash_is_data() {
        assert_eq!(words("#1 a#b"), ["#1", "a#b"]);
    }

    #[test]
    fn commands_go_on_after_a_backslash() {
        for text in ["!a \\\n b\nrest", "!a \\\r\n b\r\nrest"] {
            let mut lexer = Lexer::new(text, 0);
            let (start, end) = lexer.command_line();
            assert_eq!(text[start..end].replace('\r', ""), "!a \\\n b");
            assert_eq!(lexer.word().unwrap().text, "rest");
        }
        assert_eq!(Lexer::new("!a \\", 0).command_line(), (0, 4));
        assert_eq!(Lexer::new("!a \\\n", 0).command_line(), (0, 5));
    }
}
