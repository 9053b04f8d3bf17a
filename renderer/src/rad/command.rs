//! Cuts a scene's command line into programs and their words, as a shell would, but nothing is handed to a shell.

/// A word of a command line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Word {
    /// The word with quotes and escapes resolved.
    pub(super) text: String,
    /// Where it stands: byte offsets in the line.
    pub(super) start: usize,
    pub(super) end: usize,
}

/// One program of a pipe.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Stage {
    /// The program's name and its arguments; never empty.
    pub(super) words: Vec<Word>,
    /// Where the stage ends in the line: at its `|`, or at the line's end.
    pub(super) end: usize,
}

/// A command line that means something only to a shell.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct NotPlain {
    pub(super) start: usize,
    pub(super) end: usize,
    pub(super) message: String,
}

/// Cuts `line` (without its `!`) at pipes and blanks. Quotes (`'`, `"`) and backslashes mean what they mean to sh(1); a
/// backslash at a line's end joins lines; `#` starts a comment. Wildcards stand for themselves.
pub(super) fn split(line: &str) -> Result<Vec<Stage>, NotPlain> {
    let mut cutter = Cutter { line, at: 0, stages: Vec::new(), words: Vec::new() };
    cutter.run()?;
    Ok(cutter.stages)
}

struct Cutter<'a> {
    line: &'a str,
    at: usize,
    stages: Vec<Stage>,
    words: Vec<Word>,
}

impl Cutter<'_> {
    fn run(&mut self) -> Result<(), NotPlain> {
        while let Some(letter) = self.letter() {
            match letter {
                _ if letter.is_ascii_whitespace() => self.at += 1,
                '\\' if self.joins_lines() > 0 => self.at += self.joins_lines(),
                '#' => self.at = self.line.len(),
                '|' => {
                    self.end_stage(self.at)?;
                    self.at += 1;
                }
                _ => self.word()?,
            }
        }
        self.end_stage(self.line.len())
    }

    fn letter(&self) -> Option<char> {
        self.line[self.at..].chars().next()
    }

    /// How many bytes a backslash and a line end take here, or 0.
    fn joins_lines(&self) -> usize {
        let rest = &self.line[self.at..];
        ["\\\r\n", "\\\n"].iter().find(|ending| rest.starts_with(**ending)).map_or(0, |ending| ending.len())
    }

    fn end_stage(&mut self, end: usize) -> Result<(), NotPlain> {
        if self.words.is_empty() {
            let message = "expected a command".to_owned();
            return Err(NotPlain { start: end, end: end + 1, message });
        }
        self.stages.push(Stage { words: std::mem::take(&mut self.words), end });
        Ok(())
    }

    fn word(&mut self) -> Result<(), NotPlain> {
        let start = self.at;
        let mut text = String::new();
        while let Some(letter) = self.letter() {
            match letter {
                '|' => break,
                _ if letter.is_ascii_whitespace() => break,
                '\'' | '"' => self.quoted(letter, &mut text)?,
                '\\' => match self.joins_lines() {
                    0 => {
                        self.at += 1;
                        if let Some(escaped) = self.letter() {
                            text.push(escaped);
                            self.at += escaped.len_utf8();
                        }
                    }
                    ending => self.at += ending,
                },
                ';' | '&' | '<' | '>' | '(' | ')' | '$' | '`' => return Err(self.shell(letter)),
                _ => {
                    text.push(letter);
                    self.at += letter.len_utf8();
                }
            }
        }
        self.words.push(Word { text, start, end: self.at });
        Ok(())
    }

    fn quoted(&mut self, quote: char, text: &mut String) -> Result<(), NotPlain> {
        let start = self.at;
        self.at += 1;
        while let Some(letter) = self.letter() {
            let joined = if quote == '"' { self.joins_lines() } else { 0 };
            if letter == quote {
                self.at += 1;
                return Ok(());
            }
            if joined > 0 {
                self.at += joined;
                continue;
            }
            self.at += letter.len_utf8();
            match letter {
                '\\' if quote == '"' => match self.letter() {
                    Some(escaped @ ('"' | '\\' | '$' | '`')) => {
                        text.push(escaped);
                        self.at += 1;
                    }
                    _ => text.push(letter),
                },
                '$' | '`' if quote == '"' => {
                    self.at -= 1;
                    return Err(self.shell(letter));
                }
                _ => text.push(letter),
            }
        }
        Err(NotPlain { start, end: start + 1, message: "this quote is not closed on the command's line".to_owned() })
    }

    fn shell(&self, letter: char) -> NotPlain {
        let message = format!(
            "`{letter}` has a meaning to a shell only, and no shell is run: quote it ('{letter}') if it stands for itself"
        );
        NotPlain { start: self.at, end: self.at + 1, message }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn words(line: &str) -> Vec<Vec<String>> {
        let stages = split(line).unwrap();
        stages.into_iter().map(|stage| stage.words.into_iter().map(|word| word.text).collect()).collect()
    }

    #[test]
    fn pipes_quotes_and_escapes() {
        assert_eq!(
            words("genbox m b 1 2 3|xform -t 1 2 3"),
            [vec!["genbox", "m", "b", "1", "2", "3"], vec!["xform", "-t", "1", "2", "3"]]
        );
        assert_eq!(words(r#"a 'b|c "d"' "e'f\"g" h\ i "" # j"#), [["a", r#"b|c "d""#, "e'f\"g", "h i", ""]]);
        assert_eq!(words("a \\\n b\\\r\nc"), [["a", "bc"]]);
        assert_eq!(words("gensurf m n 2*t"), [["gensurf", "m", "n", "2*t"]]);
    }

    #[test]
    fn what_only_a_shell_can_do_is_refused() {
        for (line, start) in [
            ("rm x; ls", 4),
            ("cat <x", 4),
            ("cat >x", 4),
            ("a `b`", 2),
            ("a \"$b\"", 3),
            ("a &", 2),
            ("(a)", 0),
            ("a | ", 4),
            ("", 0),
            ("a 'b", 2),
            ("a || b", 3),
        ] {
            assert_eq!(split(line).unwrap_err().start, start, "{line}");
        }
    }

    proptest! {
        #[test]
        fn any_line_is_cut_or_refused(line in "\\PC{0,40}|[a-c'\"\\\\|;$ \n]{0,30}") {
            if let Ok(stages) = split(&line) {
                for stage in stages {
                    prop_assert!(!stage.words.is_empty() && stage.end <= line.len());
                }
            }
        }
    }
}
