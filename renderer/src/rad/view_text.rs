//! Reads views: rpict(1)'s view options, `.vf` files, the `VIEW=` lines of picture headers.

use std::fmt;

use super::number::real;
use super::view::{ViewKind, ViewSpec};
use crate::diagnostic::{Error, Problems};

/// Programs whose command lines in a header hold view options.
const PROGRAMS: [&str; 6] = ["rpict", "rvu", "rview", "rpiece", "rxpiece", "pinterp"];

/// What starts a line of view options in a header.
const VIEW: &str = "VIEW=";

/// What is wrong with a view option.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BadOption {
    /// Which of the words, the option itself being 0; past the last if one is missing.
    pub word: usize,
    /// What was expected.
    pub message: String,
}

impl fmt::Display for BadOption {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for BadOption {}

impl ViewSpec {
    /// Takes one option and its values from the front of `words`; gives how many words it took, 0 if the first is no
    /// view option (`-vf`, which names a file, is none).
    ///
    /// # Errors
    /// A view option whose values are missing or no numbers; nothing has changed then.
    pub fn take_option<S: AsRef<str>>(&mut self, words: &[S]) -> Result<usize, BadOption> {
        let Some(option) = words.first().map(S::as_ref) else { return Ok(0) };
        if let Some(letters) = option.strip_prefix("-vt") {
            let mut letters = letters.chars();
            let kind = letters.next().and_then(ViewKind::from_letter).filter(|_| letters.next().is_none());
            let message = || format!("`{option}` is no projection: expected -vtv, -vtl, -vtc, -vth, -vta or -vts");
            self.kind = kind.ok_or_else(|| BadOption { word: 0, message: message() })?;
            return Ok(1);
        }
        match option {
            "-vp" => self.point = values(words, "x y z of the view point")?,
            "-vd" => self.direction = values(words, "x y z of the view direction")?,
            "-vu" => self.up = values(words, "x y z of the up direction")?,
            "-vh" => [self.horizontal] = values(words, "the horizontal size")?,
            "-vv" => [self.vertical] = values(words, "the vertical size")?,
            "-vo" => [self.fore] = values(words, "the fore clipping distance")?,
            "-va" => [self.aft] = values(words, "the aft clipping distance")?,
            "-vs" => [self.shift] = values(words, "the shift in picture widths")?,
            "-vl" => [self.lift] = values(words, "the lift in picture heights")?,
            _ => return Ok(0),
        }
        Ok(if matches!(option, "-vp" | "-vd" | "-vu") { 4 } else { 2 })
    }

    /// Takes the view of a `.vf` file or a picture's header: all lines up to the first empty one that start with
    /// `VIEW=` or the name of a Radiance program that renders views; a later option wins. Gives how many options there
    /// were: none is no view.
    ///
    /// # Errors
    /// View options whose values are missing or no numbers.
    pub fn take_header(&mut self, file: &str, text: &str) -> Result<usize, Vec<Error>> {
        let mut problems = Problems::default();
        let (mut taken, mut start) = (0, 0);
        for line in text.split_inclusive('\n') {
            let (at, bare) = (start, line.trim_end_matches(['\r', '\n']));
            start += line.len();
            if bare.is_empty() {
                break;
            }
            let Some(options) = view_options(bare) else { continue };
            let words: Vec<(usize, &str)> = split(options, at + bare.len() - options.len());
            let mut next = 0;
            while next < words.len() {
                let rest: Vec<&str> = words[next..].iter().take(4).map(|&(_, word)| word).collect();
                match self.take_option(&rest) {
                    Ok(0) => next += 1,
                    Ok(count) => (next, taken) = (next + count, taken + 1),
                    Err(bad) => {
                        let (from, to) = match words.get(next + bad.word) {
                            Some(&(from, word)) => (from, from + word.len()),
                            None => (at + bare.len(), at + bare.len()),
                        };
                        problems.add(Error::in_text(file, text, from, to, bad.message));
                        next += 1;
                    }
                }
            }
        }
        if problems.is_empty() { Ok(taken) } else { Err(problems.into_errors()) }
    }
}

/// What follows `VIEW=` or a program's name (with or without its folder); `None` for any other line.
fn view_options(line: &str) -> Option<&str> {
    if let Some(options) = line.strip_prefix(VIEW) {
        return Some(options);
    }
    let (program, options) = line.split_once([' ', '\t'])?;
    let name = program.rsplit(['/', '\\']).next().unwrap_or(program);
    PROGRAMS.contains(&name).then_some(options)
}

/// Words with their byte offsets.
fn split(text: &str, offset: usize) -> Vec<(usize, &str)> {
    text.split_ascii_whitespace()
        .map(|word| (offset + (word.as_ptr() as usize - text.as_ptr() as usize), word))
        .collect()
}

fn values<const N: usize, S: AsRef<str>>(words: &[S], wanted: &str) -> Result<[f64; N], BadOption> {
    let option = words[0].as_ref();
    let mut numbers = [0.0; N];
    for (index, number) in numbers.iter_mut().enumerate() {
        let word = index + 1;
        let Some(text) = words.get(word).map(S::as_ref) else {
            return Err(BadOption { word, message: format!("`{option}` ends too early: expected {wanted}") });
        };
        *number = real(text).map_err(|_| BadOption {
            word,
            message: format!("`{text}` is no finite number: `{option}` wants {wanted}"),
        })?;
    }
    Ok(numbers)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn view(text: &str) -> ViewSpec {
        let mut view = ViewSpec::default();
        view.take_header("a.vf", text).unwrap();
        view
    }

    #[test]
    fn every_option_is_taken() {
        let read = view(
            "rvu -vtl -vp 1 2 3 -vd 4 5 6 -vu 7 8 9 -vh 10 -vv 11 -vo 12 -va 13 -vs 14 -vl 15 -x 512 -av .1 .1 .1 a.oct\n",
        );
        let wanted = ViewSpec {
            kind: ViewKind::Parallel,
            point: [1.0, 2.0, 3.0],
            direction: [4.0, 5.0, 6.0],
            up: [7.0, 8.0, 9.0],
            horizontal: 10.0,
            vertical: 11.0,
            fore: 12.0,
            aft: 13.0,
            shift: 14.0,
            lift: 15.0,
        };
        assert_eq!(read, wanted);
    }

    #[test]
    fn only_view_lines_count_up_to_the_empty_line() {
        let text = "#?RADIANCE\n/usr/local/bin/rpict -vh 10 -vf x.vf\nfoo -vh 20\n rview -vh 25\nVIEW=-vv 30\nVIEW= -vh 40\n\n\
                    VIEW= -vh 50\n";
        let read = view(text);
        assert_eq!((read.horizontal, read.vertical), (40.0, 30.0));
        let mut none = ViewSpec::default();
        assert_eq!(none.take_header("a", "#?RADIANCE\nEXPOSURE=1\n\n"), Ok(0));
        assert_eq!(none, ViewSpec::default());
    }

    #[test]
    fn errors_say_where() {
        let errors = ViewSpec::default().take_header("a.vf", "VIEW= -vp 0 0 x\n\t\nVIEW= -vtq -vh\r\n").unwrap_err();
        let places: Vec<(usize, usize)> = errors.iter().map(|error| (error.line, error.column)).collect();
        assert_eq!(places, [(1, 15), (3, 7), (3, 15)]);
        assert!(errors[0].message.contains("`-vp` wants x y z of the view point"));
    }

    proptest! {
        #[test]
        fn any_text_is_read_or_refused(text in "(VIEW=|rpict|[ -~\n]|-v[a-z]| [0-9.e-]{1,4}){0,40}") {
            let _ = ViewSpec::default().take_header("a", &text);
        }

        #[test]
        fn printed_options_read_back(numbers in proptest::array::uniform15(-1e9..1e9), letter in 0..6usize) {
            let n = numbers;
            let written = ViewSpec {
                kind: ViewKind::from_letter(['v', 'l', 'c', 'h', 'a', 's'][letter]).unwrap(),
                point: [n[0], n[1], n[2]],
                direction: [n[3], n[4], n[5]],
                up: [n[6], n[7], n[8]],
                horizontal: n[9],
                vertical: n[10],
                fore: n[11],
                aft: n[12],
                shift: n[13],
                lift: n[14],
            };
            prop_assert_eq!(view(&format!("VIEW= {written}\n")), written);
        }
    }
}
