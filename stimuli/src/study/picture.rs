//! What is rendered: layouts, qualities, and the request that the two make together.

use std::collections::BTreeMap;
use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use super::DisplayGeometry;

/// One arrangement of the place: a scene, a view, and what is truly in it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Layout {
    /// Short name: letters, digits, `-` and `_`.
    pub id: String,
    /// Scene files, read as one, relative to the study's folder.
    pub scene: Vec<PathBuf>,
    /// The view file, relative to the study's folder.
    pub view: PathBuf,
    /// Radiance times this is what PNG codes; one value for all qualities, so that qualities do not differ in brightness.
    pub exposure: f64,
    /// The constant ambient radiance `-av`, W/(sr m2) per channel; one value for all qualities.
    #[serde(default)]
    pub ambient: [f64; 3],
    /// The importance map of the qualities that are modulated, relative to the study's folder.
    #[serde(default)]
    pub importance: Option<PathBuf>,
    /// How many there are of each kind that is counted, by the kind's id.
    #[serde(default)]
    pub true_counts: BTreeMap<String, u32>,
}

/// One way to render.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Quality {
    /// Name, as in HQ, CBQ: letters, digits, `-` and `_`.
    pub name: String,
    /// Higher is better; the picture of the lower rank is the right answer to "which was worse".
    pub rank: u32,
    /// The component regular expression.
    pub crex: String,
    /// Samples per pixel.
    pub spp: u32,
    /// The seed of the samples.
    pub seed: u64,
    /// Whether the layout's importance map modulates the groups in `{ }`.
    #[serde(default)]
    pub modulated: bool,
    /// The importance that each member of each `{ }` needs, left to right; empty for the even steps.
    #[serde(default)]
    pub thresholds: Vec<f32>,
    /// Further options in rpict's spelling, one word each: `["-lw", "0.002"]`.
    #[serde(default)]
    pub options: Vec<String>,
}

/// A picture of the study: a layout in a quality.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Stimulus {
    /// The layout's id.
    pub layout: String,
    /// The quality's name.
    pub quality: String,
}

impl Stimulus {
    /// The picture's name in manifest and log: layout, underscore, quality in lower case.
    #[must_use]
    pub fn id(&self) -> String {
        format!("{}_{}", self.layout, self.quality.to_lowercase())
    }

    /// The picture's file, relative to the study's folder.
    #[must_use]
    pub fn file(&self) -> PathBuf {
        PathBuf::from("pictures").join(format!("{}.png", self.id()))
    }
}

/// Everything besides the content of files and the renderer itself that decides what a picture looks like.
///
/// Two equal requests on equal files make the same picture.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Request {
    /// Scene files, relative to the study's folder.
    pub scene: Vec<PathBuf>,
    /// View file, relative to the study's folder.
    pub view: PathBuf,
    /// Pixels across.
    pub width_px: u32,
    /// Pixels down.
    pub height_px: u32,
    /// The component regular expression.
    pub crex: String,
    /// Samples per pixel.
    pub spp: u32,
    /// The seed of the samples.
    pub seed: u64,
    /// Radiance times this is what PNG codes.
    pub exposure: f64,
    /// `-av`, W/(sr m2) per channel.
    pub ambient: [f64; 3],
    /// The importance map, relative to the study's folder.
    pub importance: Option<PathBuf>,
    /// Thresholds of the members of `{ }`.
    pub thresholds: Vec<f32>,
    /// Further options in rpict's spelling.
    pub options: Vec<String>,
}

impl Request {
    pub(super) fn new(layout: &Layout, quality: &Quality, display: &DisplayGeometry) -> Self {
        Self {
            scene: layout.scene.clone(),
            view: layout.view.clone(),
            width_px: display.width_px,
            height_px: display.height_px,
            crex: quality.crex.clone(),
            spp: quality.spp,
            seed: quality.seed,
            exposure: layout.exposure,
            ambient: layout.ambient,
            importance: if quality.modulated { layout.importance.clone() } else { None },
            thresholds: quality.thresholds.clone(),
            options: quality.options.clone(),
        }
    }
}
