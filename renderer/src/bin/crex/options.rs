//! rpict's options, accepted in rpict's own spelling.
//!
//! They are words of several letters behind one dash, some with several values, so no usual command line reader takes them. This
//! pass takes them out of the words and leaves the rest to clap. Source: the manual page rpict(1) of Radiance.

use std::collections::VecDeque;
use std::ffi::OsString;
use std::path::Path;

use renderer::rad::{self, ViewSpec};

use crate::spellings::{Effect, SPELLINGS, Spelling, Takes};

/// What the options say; what is not given has rpict's default, except `-ab` and `-st`, which the crex
/// takes over, and the jitters, which are whole (`-pj 1 -dj 1`) so that a picture converges to the mean over pixel and light.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct RadianceOptions {
    /// The view, with rpict's defaults where nothing is said.
    pub(crate) view: ViewSpec,
    /// Whether any view option was given.
    pub(crate) view_given: bool,
    /// `-x`, `-y`: most columns and rows.
    pub(crate) size: [u32; 2],
    /// `-pa`.
    pub(crate) pixel_aspect: f64,
    /// `-pj`.
    pub(crate) pixel_jitter: f64,
    pub(crate) aperture: f64,
    /// `-ab`.
    pub(crate) diffuse: Option<u32>,
    /// `-ad`.
    pub(crate) diffuse_rays: u32,
    /// `-av`.
    pub(crate) ambient: [f64; 3],
    /// `-lr`.
    pub(crate) reflections: i32,
    /// `-lw`.
    pub(crate) least_weight: f64,
    /// `-st`.
    pub(crate) glossy_threshold: f64,
    /// `-ss`.
    pub(crate) glossy_rays: f64,
    /// `-dv`.
    pub(crate) lights_visible: bool,
    /// `-dr`.
    pub(crate) relays: u32,
    /// `-n`.
    pub(crate) threads: Option<u32>,
    /// What was accepted and changes nothing, in words.
    pub(crate) without_effect: Vec<String>,
    /// The options that shape the picture besides the view, as given, for its provenance.
    pub(crate) spelled: String,
}

impl Default for RadianceOptions {
    fn default() -> Self {
        Self {
            view: ViewSpec::default(),
            view_given: false,
            size: [512, 512],
            pixel_aspect: 1.0,
            pixel_jitter: 1.0,
            aperture: 0.0,
            diffuse: None,
            diffuse_rays: 1,
            ambient: [0.0; 3],
            reflections: 7,
            least_weight: 1e-4,
            glossy_threshold: 0.0,
            glossy_rays: 1.0,
            lights_visible: true,
            relays: 1,
            threads: None,
            without_effect: Vec::new(),
            spelled: String::new(),
        }
    }
}

/// `@FILE`s within `@FILE`s beyond this are a circle.
const DEEPEST: usize = 16;

/// A word of the command line, and how many `@FILE`s it comes through.
type Word = (OsString, usize);

/// Takes the options out of `words`; `own` is the command whose own options are left for clap. Gives the words that are left.
pub(crate) fn take(words: Vec<OsString>, own: &clap::Command) -> Result<(Vec<OsString>, RadianceOptions), String> {
    let mut options = RadianceOptions::default();
    let mut left = Vec::new();
    let mut words: VecDeque<Word> = words.into_iter().map(|word| (word, 0)).collect();
    // The program and its command.
    left.extend(words.drain(..2.min(words.len())).map(|(word, _)| word));
    while let Some((word, depth)) = words.pop_front() {
        let text = word.to_string_lossy().into_owned();
        if let Some(file) = text.strip_prefix('@').filter(|file| !file.is_empty()) {
            let more = words_of_file(Path::new(file), depth)?;
            more.into_iter().rev().for_each(|word| words.push_front((word, depth + 1)));
        } else if text == "--" {
            left.push(word);
            left.extend(words.drain(..).map(|(word, _)| word));
        } else if !text.starts_with('-') || text == "-" || text.starts_with("--") || looks_like_number(&text) {
            let takes_value = owns(own, &text).unwrap_or(false);
            left.push(word);
            left.extend(takes_value.then(|| words.pop_front()).flatten().map(|(word, _)| word));
        } else if let Some(spelling) = find(&text) {
            options.set(spelling, &text, &mut words)?;
        } else if let Some(takes_value) = owns(own, &text) {
            left.push(word);
            left.extend(takes_value.then(|| words.pop_front()).flatten().map(|(word, _)| word));
        } else {
            return Err(unknown(&text, own));
        }
    }
    Ok((left, options))
}

/// Whether clap knows an option, and if so whether the next word is its value.
fn owns(own: &clap::Command, text: &str) -> Option<bool> {
    let argument = own.get_arguments().find(|argument| match text.strip_prefix("--") {
        Some(long) => argument.get_long().is_some_and(|name| long == name),
        None => {
            argument.get_short().is_some_and(|short| text.strip_prefix('-').is_some_and(|it| it.starts_with(short)))
        }
    });
    match argument {
        // `-oFILE` holds its value.
        Some(argument) => {
            let attached = !text.starts_with("--") && text.chars().count() > 2;
            Some(argument.get_action().takes_values() && !attached)
        }
        None => ["-h", "-V", "--help", "--version"].contains(&text).then_some(false),
    }
}

fn looks_like_number(text: &str) -> bool {
    text[1..].starts_with(|c: char| c.is_ascii_digit() || c == '.')
}

/// The option that a word spells.
fn find(text: &str) -> Option<&'static Spelling> {
    SPELLINGS.iter().find(|spelling| {
        let Some(rest) = text.strip_prefix(spelling.name) else { return false };
        match spelling.takes {
            Takes::Switch { .. } => rest.is_empty() || switch(rest).is_some(),
            Takes::Letter => true,
            _ => rest.is_empty(),
        }
    })
}

/// What is attached to a switch, as rpict(1) reads it.
fn switch(rest: &str) -> Option<bool> {
    Some(match rest {
        "+" | "y" | "Y" | "t" | "T" | "1" => true,
        "-" | "n" | "N" | "f" | "F" | "0" => false,
        _ => return None,
    })
}

fn unknown(text: &str, own: &clap::Command) -> String {
    let names = SPELLINGS.iter().map(|spelling| spelling.name.to_owned());
    let shorts = own.get_arguments().filter_map(|argument| argument.get_short()).map(|short| format!("-{short}"));
    let longs = own.get_arguments().filter_map(|argument| argument.get_long()).map(|long| format!("--{long}"));
    let names: Vec<String> = names.chain(shorts).chain(longs).collect();
    // `-threads` for `--threads` is the commonest slip.
    let long = format!("-{text}");
    let suggestion = names.iter().find(|name| **name == long).map(String::as_str);
    let suggestion = suggestion.or_else(|| rad::nearest(text, names.iter().map(String::as_str)));
    let advice =
        suggestion.map_or("`crex help` lists what there is".to_owned(), |name| format!("did you mean `{name}`?"));
    format!("there is no option `{text}`: {advice}")
}

/// The words of an options file; quotes hold words with blanks together, as in rpict(1).
fn words_of_file(file: &Path, depth: usize) -> Result<Vec<OsString>, String> {
    let name = file.display();
    if depth >= DEEPEST {
        return Err(format!("@{name}: options files that name each other in a circle"));
    }
    let text = std::fs::read_to_string(file).map_err(|error| format!("@{name}: cannot be read: {error}"))?;
    let mut words = Vec::new();
    let mut rest = text.trim_start();
    while let Some(first) = rest.chars().next() {
        let (word, after) = if first == '"' || first == '\'' {
            let inside = &rest[1..];
            inside.split_once(first).ok_or_else(|| format!("@{name}: a quote {first} that never ends"))?
        } else {
            rest.split_at(rest.find(char::is_whitespace).unwrap_or(rest.len()))
        };
        words.push(OsString::from(word));
        rest = after.trim_start();
    }
    Ok(words)
}

impl RadianceOptions {
    /// Takes one option, spelled `text`, whose values are the next words.
    fn set(&mut self, spelling: &Spelling, text: &str, words: &mut VecDeque<Word>) -> Result<(), String> {
        let name = spelling.name;
        let mut given = vec![text.to_owned()];
        let count = match spelling.takes {
            Takes::Switch { .. } | Takes::Letter => 0,
            Takes::Numbers(count) => count,
            Takes::Count(_) | Takes::Integer | Takes::File => 1,
        };
        for _ in 0..count {
            let Some((word, _)) = words.pop_front() else {
                let plural = if count == 1 { "value" } else { "values" };
                return Err(format!("`{name}` wants {count} {plural} ({}), the command line ends", spelling.help));
            };
            given.push(word.to_string_lossy().into_owned());
        }
        if name == "-vf" {
            return self.read_view(Path::new(&given[1]));
        }
        if name.starts_with("-v") {
            self.view_given = true;
            return self.view.take_option(&given).map(|_| ()).map_err(|error| error.message);
        }
        let value = value(spelling, &given)?;
        self.store(name, &value, &given)?;
        match spelling.effect {
            Effect::Works if name == "-n" => {}
            Effect::Works => {
                self.spelled.push_str(if self.spelled.is_empty() { "" } else { " " });
                self.spelled.push_str(&given.join(" "));
            }
            Effect::Fixed(fixed, why) if value[0] != fixed => {
                self.without_effect.push(format!("{} changes nothing here: {why}", given.join(" ")));
            }
            Effect::Fixed(..) => {}
        }
        Ok(())
    }

    fn store(&mut self, name: &str, value: &[f64], given: &[String]) -> Result<(), String> {
        let at_least = |least: f64| {
            if value[0] >= least {
                Ok(value[0])
            } else {
                Err(format!("`{}` must be at least {least}", given.join(" ")))
            }
        };
        // Whole numbers were checked to be whole and in range.
        let count = value[0] as u32;
        match name {
            "-x" => self.size[0] = count,
            "-y" => self.size[1] = count,
            "-pa" => self.pixel_aspect = at_least(0.0)?,
            "-pd" => self.aperture = at_least(0.0)?,
            "-pj" => self.pixel_jitter = at_least(0.0)?.min(1.0),
            "-ab" => self.diffuse = Some(count),
            "-ad" => self.diffuse_rays = count,
            "-av" => self.ambient = [at_least(0.0)?, value[1], value[2]],
            "-lr" => self.reflections = value[0] as i32,
            "-lw" => self.least_weight = at_least(0.0)?,
            "-st" => self.glossy_threshold = at_least(0.0)?,
            "-ss" => self.glossy_rays = at_least(0.0)?,
            "-dv" => self.lights_visible = value[0] != 0.0,
            "-dr" => self.relays = count,
            "-n" => self.threads = Some(count),
            _ => {}
        }
        if name == "-av" && value.iter().any(|&channel| channel < 0.0) {
            return Err(format!("`{}` must not be negative", given.join(" ")));
        }
        Ok(())
    }

    /// Takes the view of a .rif file in `folder`.
    pub(crate) fn take_view(&mut self, words: &[String], folder: &Path) -> Result<(), String> {
        let mut next = 0;
        while next < words.len() {
            if let ("-vf", Some(file)) = (words[next].as_str(), words.get(next + 1)) {
                self.read_view(&folder.join(file))?;
                next += 2;
                continue;
            }
            let taken = self.view.take_option(&words[next..]).map_err(|error| error.message)?;
            // Other options of rpict stand beside a view's.
            next += taken.max(1);
        }
        self.view_given = true;
        Ok(())
    }

    /// A view from a view file or a picture's header.
    fn read_view(&mut self, file: &Path) -> Result<(), String> {
        let name = file.display().to_string();
        let bytes = std::fs::read(file).map_err(|error| format!("-vf {name}: cannot be read: {error}"))?;
        let text = String::from_utf8_lossy(&bytes);
        let taken = self.view.take_header(&name, &text).map_err(|errors| {
            errors.iter().map(|error| error.to_string().trim_end().to_owned()).collect::<Vec<_>>().join("\n")
        })?;
        if taken == 0 {
            return Err(format!("-vf {name}: holds no view: expected a line such as `rvu -vtv -vp 0 0 0 -vd 0 1 0`"));
        }
        self.view_given = true;
        Ok(())
    }
}

/// The numbers that an option was given; a switch is 0 or 1.
fn value(spelling: &Spelling, given: &[String]) -> Result<Vec<f64>, String> {
    let wrong =
        |word: &str, wanted: String| format!("`{}`: `{word}` is not {wanted} ({})", given.join(" "), spelling.help);
    let whole = |least: i64, most: i64, wanted: &str| match given[1].parse::<i64>() {
        Ok(number) if (least..=most).contains(&number) => Ok(vec![number as f64]),
        _ => Err(wrong(&given[1], wanted.to_owned())),
    };
    match spelling.takes {
        Takes::Switch { default } => {
            let on = switch(&given[0][spelling.name.len()..]).unwrap_or(!default);
            Ok(vec![f64::from(u8::from(on))])
        }
        Takes::Numbers(_) => {
            let number = |word: &String| {
                let number = word.parse::<f64>().ok().filter(|number| number.is_finite());
                number.ok_or_else(|| wrong(word, "a number".to_owned()))
            };
            given[1..].iter().map(number).collect()
        }
        Takes::Count(least) => whole(least.into(), u32::MAX.into(), &format!("a whole number from {least} on")),
        Takes::Integer => whole(i32::MIN.into(), i32::MAX.into(), "a whole number"),
        Takes::File | Takes::Letter => Ok(vec![0.0]),
    }
}

#[cfg(test)]
mod tests;
