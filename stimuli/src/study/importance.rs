//! How the importance maps of a study are made: from what counts, from what catches the eye.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use super::{Layout, Study};

/// The `[importance]` of a study: how the maps that its layouts name are made. Without it they are taken as drawn.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ImportancePlan {
    /// Diameter of the fovea, degrees: within half of it from an item that counts the map is 1.
    pub fovea_deg: f64,
    /// How the map falls off beyond.
    pub falloff: Falloff,
    /// The part of the saliency map in the whole, in [0, 1]; 0 is the task map alone.
    #[serde(default)]
    pub saliency_weight: f64,
}

/// How sight falls off with eccentricity; the formulas stand with the renderer's maps.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Falloff {
    /// The smallest angle that is resolved (Guenter and others 2012).
    Mar,
    /// Cortical magnification (Dougherty and others 2003).
    Cortical,
    /// The highest frequency that is seen (Geisler and Perry 1998).
    GeislerPerry,
}

impl Falloff {
    /// The word for it, here and on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Mar => "mar",
            Self::Cortical => "cortical",
            Self::GeislerPerry => "geisler-perry",
        }
    }
}

/// Everything besides the content of files and the renderer itself that decides what a map looks like.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MapRequest {
    /// Scene files, relative to the study's folder.
    pub scene: Vec<PathBuf>,
    /// View file, relative to the study's folder.
    pub view: PathBuf,
    /// Pixels across.
    pub width_px: u32,
    /// Pixels down.
    pub height_px: u32,
    /// Pixels in a degree at the line of sight.
    pub px_per_deg: f64,
    /// Names of the surfaces that count, `*` standing for any characters.
    pub objects: Vec<String>,
    /// As [`ImportancePlan::fovea_deg`].
    pub fovea_deg: f64,
    /// As [`ImportancePlan::falloff`].
    pub falloff: Falloff,
    /// As [`ImportancePlan::saliency_weight`].
    pub saliency_weight: f64,
    /// Radiance times this is what the saliency map looks at.
    pub exposure: f64,
    /// `-av` of the picture that the saliency map looks at, W/(sr m2) per channel.
    pub ambient: [f64; 3],
}

impl Study {
    /// The maps that are made, by their files, in the order of the layouts; none if maps are taken as drawn.
    #[must_use]
    pub fn maps(&self) -> Vec<(PathBuf, MapRequest)> {
        let Some(plan) = &self.importance else { return Vec::new() };
        self.layouts.iter().filter_map(|layout| Some((layout.importance.clone()?, self.map(layout, plan)))).collect()
    }

    fn map(&self, layout: &Layout, plan: &ImportancePlan) -> MapRequest {
        let there = |id: &str| layout.true_counts.get(id).is_some_and(|&count| count > 0);
        MapRequest {
            scene: layout.scene.clone(),
            view: layout.view.clone(),
            width_px: self.display.width_px,
            height_px: self.display.height_px,
            px_per_deg: self.display.pixels_per_degree(),
            objects: self
                .task
                .kinds
                .iter()
                .filter(|kind| there(&kind.id))
                .map(|kind| format!("{}.*", kind.objects))
                .collect(),
            fovea_deg: plan.fovea_deg,
            falloff: plan.falloff,
            saliency_weight: plan.saliency_weight,
            exposure: layout.exposure,
            ambient: layout.ambient,
        }
    }
}
