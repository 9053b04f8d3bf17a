//! Input files of rad(1): `variable= values`, which say what files make a scene and how it is looked at.

use super::files::Files;
use super::lexer::Lexer;
use super::{Source, SourceFile};
use crate::diagnostic::{Error, Problems};

/// rad's variables. A name may be cut down to its first three letters or more; case does not matter.
const VARIABLES: [&str; 32] = [
    "OBJECTS",
    "SCENE",
    "MATERIALS",
    "ILLUM",
    "VIEW",
    "OCTREE",
    "ZONE",
    "EXPOSURE",
    "EYESEP",
    "UP",
    "RESOLUTION",
    "QUALITY",
    "PENUMBRAS",
    "INDIRECT",
    "PICTURE",
    "RAWFILE",
    "ZFILE",
    "AMBFILE",
    "DETAIL",
    "VARIABILITY",
    "OPTFILE",
    "REPORT",
    "OCONV",
    "MKILLUM",
    "RENDER",
    "RPICT",
    "RVU",
    "PFILT",
    "MKPMAP",
    "PGMAP",
    "PCMAP",
    "RTRACE",
];

/// Variables whose names may be cut down to two letters.
const SHORT: [&str; 5] = ["VIEW", "UP", "ZONE", "ZFILE", "PFILT"];

/// The files of a scene, in the order in which rad gives them to oconv.
const SCENE_VARIABLES: [&str; 3] = ["MATERIALS", "ILLUM", "SCENE"];

/// One line of a rad input file.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Assignment {
    /// In full, in capitals.
    variable: &'static str,
    value: String,
    /// Byte offset of the value in the text.
    start: usize,
}

/// A view that a rad input file names.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RifView {
    /// Its name, if it has one.
    pub name: Option<String>,
    /// View options, `-vf file` among them perhaps.
    pub options: Vec<String>,
}

/// A rad input file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Rif {
    file: SourceFile,
    assignments: Vec<Assignment>,
}

impl Rif {
    /// Reads a rad input file.
    ///
    /// # Errors
    /// Lines that are no assignments, and variables that rad does not know.
    pub fn read(source: &Source) -> Result<Self, Vec<Error>> {
        let text = super::decode(&source.bytes);
        let mut problems = Problems::default();
        let mut assignments = Vec::new();
        let mut lexer = Lexer::new(&text, 0);
        while lexer.peek().is_some() {
            let (start, end) = lexer.command_line();
            let line = text[start..end].split('#').next().unwrap_or_default();
            if line.trim().is_empty() {
                continue;
            }
            let Some((name, value)) = line.split_once('=') else {
                let message = "expected `variable= value`, or a comment that starts with #";
                problems.add(Error::in_text(&source.name, &text, start, start + line.trim_end().len(), message));
                continue;
            };
            let wanted = name.trim().to_ascii_uppercase();
            let variable = VARIABLES
                .iter()
                .find(|known| known.starts_with(&wanted) && wanted.len() >= if SHORT.contains(known) { 2 } else { 3 });
            let Some(variable) = variable else {
                let message = format!("rad has no variable `{}`", name.trim());
                problems.add(Error::in_text(&source.name, &text, start, start + name.trim_end().len(), message));
                continue;
            };
            let value = value.replace("\\\r\n", " ").replace("\\\n", " ").trim().to_owned();
            assignments.push(Assignment { variable, value, start: start + name.len() + 1 });
        }
        let file = SourceFile { name: source.name.clone(), text, read_by: None };
        if problems.is_empty() { Ok(Self { file, assignments }) } else { Err(problems.into_errors()) }
    }

    fn all<'a>(&'a self, variable: &'a str) -> impl Iterator<Item = &'a Assignment> {
        self.assignments.iter().filter(move |assignment| assignment.variable == variable)
    }

    /// The words of a variable that may be given several times, all in order; the name in full.
    #[must_use]
    pub fn words(&self, variable: &str) -> Vec<String> {
        let variable = variable.to_ascii_uppercase();
        self.all(&variable).flat_map(|assignment| words(&assignment.value)).collect()
    }

    /// The value of a variable that has one: the last that is given.
    #[must_use]
    pub fn value(&self, variable: &str) -> Option<&str> {
        let variable = variable.to_ascii_uppercase();
        let mut given = self.assignments.iter().filter(|assignment| assignment.variable == variable);
        given.next_back().map(|assignment| assignment.value.as_str())
    }

    /// The views, in order. A first word that is no option is the view's name.
    #[must_use]
    pub fn views(&self) -> Vec<RifView> {
        self.all("VIEW")
            .map(|assignment| {
                let mut options = words(&assignment.value);
                let named = options.first().is_some_and(|word| !word.starts_with('-'));
                let name = named.then(|| options.remove(0));
                if let Some(up) = self.up() {
                    options.splice(0..0, ["-vu".to_owned()].into_iter().chain(up.map(|x| x.to_string())));
                }
                RifView { name, options }
            })
            .collect()
    }

    /// The vector of `UP`, if that is given: the views' `-vu` unless they have their own.
    fn up(&self) -> Option<[i32; 3]> {
        let value = self.value("UP")?;
        let sign = if value.starts_with('-') { -1 } else { 1 };
        let axis = value.trim_start_matches(['+', '-']).chars().next()?.to_ascii_uppercase();
        let at = ['X', 'Y', 'Z'].iter().position(|&letter| letter == axis)?;
        let mut up = [0; 3];
        up[at] = sign;
        Some(up)
    }

    /// The texts that make the scene: `materials`, `illum` and `scene`, files or commands (`"!command"`).
    ///
    /// # Errors
    /// Files that cannot be read, with the place where they are named.
    pub fn scene(&self, files: &dyn Files, folder: &str) -> Result<Vec<Source>, Vec<Error>> {
        let (mut sources, mut problems) = (Vec::new(), Problems::default());
        for assignment in SCENE_VARIABLES.iter().flat_map(|variable| self.all(variable)) {
            for word in words(&assignment.value) {
                if word.starts_with('!') {
                    sources.push(Source { folder: folder.to_owned(), ..Source::new(&self.file.name, word) });
                    continue;
                }
                match files.find(&word, folder) {
                    // Commands of a scene's files run where rad does.
                    Ok(found) => sources.push(Source { folder: folder.to_owned(), ..Source::from(found) }),
                    Err(why) => {
                        let text = &self.file.text;
                        let start = text[assignment.start..].find(&word).map_or(0, |at| assignment.start + at);
                        let message = format!("`{word}` {why}");
                        problems.add(Error::in_text(&self.file.name, text, start, start + word.len(), message));
                    }
                }
            }
        }
        if problems.is_empty() { Ok(sources) } else { Err(problems.into_errors()) }
    }
}

fn words(text: &str) -> Vec<String> {
    let mut lexer = Lexer::new(text, 0);
    std::iter::from_fn(|| lexer.word()).map(|word| word.text.into_owned()).collect()
}

#[cfg(test)]
mod tests {
    use super::super::MemoryFiles;
    use super::*;

    const OFFICE: &str = "# an office\nmat= paints.mat\nscene = desk \\\n lamp\nscene= \"!xform -t 1 2 3 chair\" # one more\n\
                          view = norm -vp 8 36 -27 -vh 40\nVIEW= -vf a.vf\nRES= 512 400\nRES= 256\nUP=Y\nrender= -av 1 1 1\n";

    fn source(text: &str) -> Source {
        Source::new("office.rif", text)
    }

    #[test]
    fn variables_may_be_cut_short() {
        let rif = Rif::read(&source(OFFICE)).unwrap();
        assert_eq!(rif.words("materials"), ["paints.mat"]);
        assert_eq!(rif.words("scene"), ["desk", "lamp", "!xform -t 1 2 3 chair"]);
        assert_eq!((rif.value("resolution"), rif.value("UP"), rif.value("ZONE")), (Some("256"), Some("Y"), None));
        let views = rif.views();
        assert_eq!((views[0].name.as_deref(), views[0].options.len()), (Some("norm"), 10));
        assert_eq!(views[0].options[..4].join(" "), "-vu 0 1 0");
        assert_eq!((views[1].name.as_deref(), views[1].options.join(" ").as_str()), (None, "-vu 0 1 0 -vf a.vf"));
    }

    #[test]
    fn the_scene_comes_in_oconvs_order() {
        let files = MemoryFiles::new().with("paints.mat", "").with("desk", "").with("lamp", "");
        let rif = Rif::read(&source(OFFICE)).unwrap();
        let names: Vec<String> = rif.scene(&files, "").unwrap().into_iter().map(|source| source.name).collect();
        assert_eq!(names, ["paints.mat", "desk", "lamp", "office.rif"]);
        let error = rif.scene(&MemoryFiles::new(), "").unwrap_err().remove(0);
        assert_eq!((error.line, error.column), (2, 6));
    }

    #[test]
    fn errors_have_places() {
        let errors = Rif::read(&source("UP=Z\nfoo= 1\n  nothing\nSC= x")).unwrap_err();
        let places: Vec<(usize, usize)> = errors.iter().map(|error| (error.line, error.column)).collect();
        assert_eq!(places, [(2, 1), (3, 3), (4, 1)]);
    }
}
