//! The study file: what is rendered, shown and asked, and how the answers will be judged.

mod extend;
mod importance;
mod judge;
mod locate;
mod picture;
mod protocol;
#[cfg(test)]
mod shipped;
mod validate;

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

pub use importance::{Falloff, ImportancePlan, MapRequest};
pub use judge::{AnalysisPlan, Exclusions};
pub use picture::{Layout, Quality, Request, Stimulus};
pub use protocol::{
    Arm, Consent, DisplayGeometry, FreeWording, Hints, Kind, Practice, QualityCheck, Task, Timing, Viewing, Wording,
};

use crate::error::{Error, Mistake, Result};
use crate::hash::Sha256;

/// A study: one folder, described by its `study.toml`.
///
/// Names in the file are the names of the fields. Keys that are not known are errors, so that a misspelt one cannot pass
/// for a default.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Study {
    /// Short name, written into every row of the log: letters, digits, `-` and `_`.
    pub id: String,
    /// One line for people.
    pub title: String,
    /// A demonstration runs on an unverified display with a notice; its data are marked and never pool with a main study.
    pub demo: bool,
    /// The seed of the allocation of participants to arms, orders and layouts.
    pub seed: u64,
    /// The display and the distance that the study is designed for.
    pub display: DisplayGeometry,
    /// How long things are on the screen.
    pub timing: Timing,
    /// What the participant agrees to.
    pub consent: Consent,
    /// Every text that is shown.
    pub wording: Wording,
    /// What is counted.
    pub task: Task,
    /// How the importance maps of the layouts are made; without it they are taken as they are drawn.
    #[serde(default)]
    pub importance: Option<ImportancePlan>,
    /// The scenes: the same place with its items in different positions.
    pub layouts: Vec<Layout>,
    /// The ways to render a layout.
    pub qualities: Vec<Quality>,
    /// The two layouts of the critical pair: each participant sees one, then the other.
    pub critical_layouts: [String; 2],
    /// The groups of participants.
    pub arms: Vec<Arm>,
    /// Trials before the critical one, in order; they rehearse counting alone.
    #[serde(default)]
    pub practice: Vec<Practice>,
    /// The obvious pair after the critical answer, which shows that the person can see a difference at all.
    #[serde(default)]
    pub check: Option<QualityCheck>,
    /// Who is left out of the analysis, fixed before the first participant.
    pub exclusions: Exclusions,
    /// What will be computed, fixed before the first participant.
    pub analysis: AnalysisPlan,
    /// The folder of the study file; paths in the file start there. Empty for a study read from a text.
    #[serde(skip)]
    pub folder: PathBuf,
}

impl Study {
    /// Reads `path`: a study file, or a folder with a `study.toml`.
    ///
    /// # Errors
    /// If the file cannot be read, or says something that cannot be: with file, line, column and what to do.
    pub fn load(path: &Path) -> Result<Self> {
        let file = if path.is_dir() { path.join("study.toml") } else { path.to_owned() };
        let text = std::fs::read_to_string(&file).map_err(|source| Error::io("read", &file, source))?;
        let mut study = match extend::base_of(&text) {
            Some(base) => extend::read(&text, &file, &base)?,
            None => Self::parse(&text, &file)?,
        };
        study.folder = file.parent().unwrap_or(Path::new("")).to_owned();
        Ok(study)
    }

    /// Reads a study from its text; `file` is only named in errors.
    ///
    /// # Errors
    /// As [`Study::load`].
    pub fn parse(text: &str, file: &Path) -> Result<Self> {
        let study: Self = toml::from_str(text).map_err(|error| {
            let byte = error.span().map_or(0, |span| span.start);
            Error::Wrong(vec![Mistake::at(
                file,
                text,
                byte,
                error.message(),
                "stimuli/README.md says what a study file holds.",
            )])
        })?;
        let found = validate::problems(&study);
        if found.is_empty() {
            return Ok(study);
        }
        let mut mistakes: Vec<_> = found
            .into_iter()
            .map(|problem| {
                let byte = locate::byte_of(text, &problem.path);
                (byte, Mistake::at(file, text, byte, problem.message, problem.help))
            })
            .collect();
        mistakes.sort_by_key(|(byte, _)| *byte);
        Err(Error::Wrong(mistakes.into_iter().map(|(_, mistake)| mistake).collect()))
    }

    /// The layout of a name.
    #[must_use]
    pub fn layout(&self, id: &str) -> Option<&Layout> {
        self.layouts.iter().find(|layout| layout.id == id)
    }

    /// The quality of a name.
    #[must_use]
    pub fn quality(&self, name: &str) -> Option<&Quality> {
        self.qualities.iter().find(|quality| quality.name == name)
    }

    /// Every picture that the study shows, without repetition: the critical pairs of all arms, then practice, then the
    /// check.
    #[must_use]
    pub fn stimuli(&self) -> Vec<Stimulus> {
        let critical = self.critical_layouts.iter().flat_map(|layout| {
            let qualities = self.arms.iter().flat_map(|arm| arm.qualities.iter());
            qualities.map(|quality| Stimulus { layout: layout.clone(), quality: quality.clone() })
        });
        let practice = self.practice.iter().flat_map(|trial| [trial.first.clone(), trial.second.clone()]);
        let check = self.check.iter().flat_map(QualityCheck::stimuli);
        let mut all: Vec<Stimulus> = Vec::new();
        for stimulus in critical.chain(practice).chain(check) {
            if !all.contains(&stimulus) {
                all.push(stimulus);
            }
        }
        all
    }

    /// Everything that decides what a picture looks like; `None` if the study has no such layout or quality.
    #[must_use]
    pub fn request(&self, stimulus: &Stimulus) -> Option<Request> {
        let (layout, quality) = (self.layout(&stimulus.layout)?, self.quality(&stimulus.quality)?);
        Some(Request::new(layout, quality, &self.display))
    }

    /// The number of items that a participant should count in a layout; `None` if there is no such layout.
    #[must_use]
    pub fn true_count(&self, layout: &str) -> Option<u32> {
        let counts = &self.layout(layout)?.true_counts;
        Some(self.task.kinds.iter().filter_map(|kind| counts.get(&kind.id)).sum())
    }

    /// What the participants of an arm do while they look.
    #[must_use]
    pub fn viewing(&self, arm: &str) -> Viewing {
        self.arms.iter().find(|other| other.name == arm).map_or(Viewing::Task, |arm| arm.viewing)
    }

    /// The digest of the study as it was read: of its content, so that comments and white space do not count.
    #[must_use]
    pub fn hash(&self) -> Sha256 {
        let text = serde_json::to_string(self).expect("a study read from a text is text");
        Sha256::of(text.as_bytes())
    }
}
