//! The rows of a fit, as a CSV file keeps them.

use std::path::Path;

use renderer::propose::{LEAST_LOSS_JOD, LEAST_PREDICTOR};

use crate::predictors::Predictors;

/// A crex of a scene: what the small pictures tell, and what the large ones show.
#[derive(Clone, Debug)]
pub(crate) struct Row {
    /// Scenes of a group are left out together.
    pub(crate) group: String,
    /// The scene.
    pub(crate) scene: String,
    /// What ran.
    pub(crate) crex: String,
    /// In the order of [`Predictors::NAMES`].
    pub(crate) predictors: [f64; 5],
    /// ColorVideoVDP, large pictures.
    pub(crate) loss_jod: f64,
}

impl Row {
    /// What is fitted.
    pub(crate) fn log_loss(&self) -> f64 {
        (self.loss_jod + LEAST_LOSS_JOD).ln()
    }

    /// Logarithms of the predictors whose bits are in `set`.
    pub(crate) fn logs(&self, set: u32) -> Vec<f64> {
        let wanted = self.predictors.iter().enumerate().filter(|(i, _)| set >> i & 1 == 1);
        wanted.map(|(_, value)| (value + LEAST_PREDICTOR).ln()).collect()
    }

    /// The line of a file.
    #[allow(dead_code, reason = "only what measures writes")]
    pub(crate) fn line(&self) -> String {
        let numbers: Vec<String> =
            self.predictors.iter().chain([&self.loss_jod]).map(|value| format!("{value:.6}")).collect();
        format!("{},{},{},{}\n", self.group, self.scene, self.crex, numbers.join(","))
    }
}

/// The first line of a file.
pub(crate) fn header() -> String {
    format!("group,scene,crex,{},loss_jod\n", Predictors::NAMES.join(","))
}

/// Reads a file of rows.
pub(crate) fn read(path: &Path) -> Result<Vec<Row>, String> {
    let text = std::fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))?;
    let mut lines = text.lines();
    if lines.next().map(|line| format!("{line}\n")) != Some(header()) {
        return Err(format!("{}: expected the header {}", path.display(), header().trim_end()));
    }
    let row = |(line, number): (&str, usize)| {
        let words: Vec<&str> = line.split(',').collect();
        let numbers: Option<Vec<f64>> =
            words.get(3..).unwrap_or_default().iter().map(|word| word.parse().ok()).collect();
        match (words.as_slice(), numbers.as_deref()) {
            ([group, scene, crex, ..], Some([predictors @ .., loss_jod])) if predictors.len() == 5 => Ok(Row {
                group: (*group).to_owned(),
                scene: (*scene).to_owned(),
                crex: (*crex).to_owned(),
                predictors: std::array::from_fn(|i| predictors[i]),
                loss_jod: *loss_jod,
            }),
            _ => Err(format!("{}:{number}: expected three words and six numbers", path.display())),
        }
    };
    lines.zip(2..).map(row).collect()
}
