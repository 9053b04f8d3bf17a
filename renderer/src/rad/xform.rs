//! The command line of xform(1): leading options, a transform with arrays, files; argument files.

use super::command::Word;
use super::number::integer;
use super::place::Placement;
use super::transform::{Transform, is_option};

/// One run of xform over its input, perhaps an array of copies.
#[derive(Clone, Debug)]
pub(super) struct Run {
    prefix: Option<String>,
    modifier: Option<String>,
    invert: bool,
    /// `-c`: commands inside a file run in the folder of the command, not in the file's.
    pub(super) keeps_folder: bool,
    /// The transform's words, each array written `-i` and its count.
    words: Vec<String>,
    /// Places of the array counts in `words`, and how many copies each makes.
    arrays: Vec<(usize, u64)>,
    /// Files to read; none means what is piped in.
    pub(super) files: Vec<Word>,
}

/// What is wrong with a program's words.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct BadWords {
    /// The word meant; `None` is the end of the words.
    pub(super) word: Option<Word>,
    pub(super) message: String,
}

impl BadWords {
    pub(super) fn at(word: Option<&Word>, message: impl Into<String>) -> Self {
        Self { word: word.cloned(), message: message.into() }
    }
}

/// Argument files name argument files no deeper than this, and make no more runs than that.
const MAX_DEPTH: usize = 16;
const MAX_RUNS: usize = 100_000;

/// Reads the words after `xform`; `read` gives the text of an argument file.
pub(super) fn runs(
    words: &[Word],
    read: &mut dyn FnMut(&Word) -> Result<String, BadWords>,
) -> Result<Vec<Run>, BadWords> {
    let mut found = Vec::new();
    expand(words.to_vec(), 0, read, &mut found)?;
    Ok(found)
}

/// Puts each line of the first argument file (`-f`) in the place of the option.
fn expand(
    words: Vec<Word>,
    depth: usize,
    read: &mut dyn FnMut(&Word) -> Result<String, BadWords>,
    found: &mut Vec<Run>,
) -> Result<(), BadWords> {
    let Some(at) = words.iter().position(|word| word.text == "-f") else {
        if found.len() >= MAX_RUNS {
            return Err(BadWords::at(words.first(), format!("argument files make more than {MAX_RUNS} runs")));
        }
        found.push(run(&words)?);
        return Ok(());
    };
    let Some(file) = words.get(at + 1) else {
        return Err(BadWords::at(None, "`-f` wants a file with arguments"));
    };
    if depth >= MAX_DEPTH {
        return Err(BadWords::at(Some(file), format!("argument files name each other more than {MAX_DEPTH} deep")));
    }
    let text = read(file)?;
    let lines = text.replace("\\\r\n", " ").replace("\\\n", " ");
    let lines = lines.lines().map(str::trim).filter(|line| !line.is_empty() && !line.starts_with('#'));
    let mut count = 0;
    for line in lines {
        let line = line.strip_prefix('!').unwrap_or(line);
        let line = line.strip_prefix("xform ").unwrap_or(line);
        let mut lexer = super::lexer::Lexer::new(line, 0);
        let inserted = std::iter::from_fn(|| lexer.word());
        // An argument of the file is blamed on the word that names the file.
        let inserted = inserted.map(|word| Word { text: word.text.into_owned(), ..file.clone() });
        let mut all: Vec<Word> = words[..at].to_vec();
        all.extend(inserted);
        all.extend_from_slice(&words[at + 2..]);
        match all.iter().position(|word| word.text == "-n") {
            Some(name) if name + 1 < all.len() => all[name + 1].text = format!("{}.{count}", all[name + 1].text),
            _ => {
                let option = Word { text: "-n".to_owned(), ..file.clone() };
                let name = Word { text: format!("i{count}"), ..file.clone() };
                all.splice(0..0, [option, name]);
            }
        }
        expand(all, depth + 1, read, found)?;
        count += 1;
    }
    if count == 0 {
        return Err(BadWords::at(Some(file), format!("the argument file `{}` holds no arguments", file.text)));
    }
    Ok(())
}

/// A run without argument files.
fn run(words: &[Word]) -> Result<Run, BadWords> {
    let mut run = Run {
        prefix: None,
        modifier: None,
        invert: false,
        keeps_folder: false,
        words: Vec::new(),
        arrays: Vec::new(),
        files: Vec::new(),
    };
    let mut next = 0;
    while let Some(word) = words.get(next) {
        next += 1;
        match word.text.as_str() {
            "-c" => run.keeps_folder = true,
            "-e" => run.keeps_folder = false,
            "-I" => run.invert = !run.invert,
            option @ ("-m" | "-n") => {
                let Some(value) = words.get(next) else {
                    return Err(BadWords::at(None, format!("`{option}` wants a name")));
                };
                next += 1;
                match option {
                    "-m" => run.modifier = run.modifier.or_else(|| Some(value.text.clone())),
                    _ => run.prefix = Some(dotted(run.prefix.as_deref(), &value.text)),
                }
            }
            _ => {
                next -= 1;
                break;
            }
        }
    }
    let first = next;
    while let Some(word) = words.get(next).filter(|word| is_option(&word.text) || word.text == "-a") {
        if word.text == "-a" {
            let copies = words.get(next + 1).map(|count| integer(&count.text));
            let Some(copies) = copies.and_then(Result::ok).and_then(|copies| u64::try_from(copies).ok()) else {
                return Err(BadWords::at(words.get(next + 1), "`-a` wants the number of copies"));
            };
            if copies == 0 {
                return Err(BadWords::at(words.get(next + 1), "`-a` wants at least one copy"));
            }
            run.arrays.push((next + 1 - first, copies));
        }
        let values = match word.text.as_str() {
            "-t" => 3,
            "-mx" | "-my" | "-mz" => 0,
            _ => 1,
        };
        next += 1 + values;
    }
    let transform = &words[first..next.min(words.len())];
    run.words = transform.iter().map(|word| word.text.clone()).collect();
    for &(count, _) in &run.arrays {
        run.words[count - 1] = "-i".to_owned();
        run.words[count] = "0".to_owned();
    }
    if let Err(bad) = Transform::take(&run.words) {
        return Err(BadWords::at(transform.get(bad.word), bad.message));
    }
    run.files = words[next.min(words.len())..].to_vec();
    if let Some(option) = run.files.iter().find(|file| file.text.starts_with('-')) {
        let message = match option.text.as_str() {
            "-c" | "-e" | "-I" | "-m" | "-n" => "this option must stand before the transform",
            text if is_option(text) || text == "-a" => "the transform must stand before the files",
            _ => "xform knows no such option: -n -m -c -e -I -f, then -t -rx -ry -rz -s -mx -my -mz -i -a, then files",
        };
        return Err(BadWords::at(Some(option), format!("`{}`: {message}", option.text)));
    }
    Ok(run)
}

fn dotted(prefix: Option<&str>, name: &str) -> String {
    prefix.map_or_else(|| name.to_owned(), |prefix| format!("{prefix}.{name}"))
}

impl Run {
    /// How many copies it makes.
    pub(super) fn copies(&self) -> u64 {
        self.arrays.iter().fold(1, |copies, &(_, count)| copies.saturating_mul(count))
    }

    /// The placement of one copy, counted with the last array fastest.
    pub(super) fn placement(&self, copy: u64) -> Placement {
        let mut indices = vec![0; self.arrays.len()];
        let mut left = copy;
        for (index, &(_, count)) in indices.iter_mut().zip(&self.arrays).rev() {
            *index = left % count;
            left /= count;
        }
        let mut words = self.words.clone();
        let mut prefix = self.prefix.clone();
        for (index, &(place, _)) in indices.iter().zip(&self.arrays) {
            words[place] = index.to_string();
            prefix = Some(match prefix {
                None => format!("a{index}"),
                Some(prefix) => format!("{prefix}.{index}"),
            });
        }
        // The same words were read with other counts before, so this cannot fail.
        let transform = Transform::take(&words).map_or(Transform::IDENTITY, |(transform, _)| transform);
        Placement { transform, words, prefix, modifier: self.modifier.clone(), invert: self.invert }
    }
}
