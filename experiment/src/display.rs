//! What was found out about the display and the machine before a session, as it goes into the journal.

use analysis::trial_log::{OnsetSource, Vsync};
use serde::{Deserialize, Serialize};

use crate::timing::Refresh;

/// What is known of the display's timing.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DisplayFacts {
    /// Where onsets come from.
    pub onset_source: OnsetSource,
    /// The measured refresh rate, Hz; `None` unless swaps were found to follow it.
    pub refresh_hz: Option<f64>,
    /// Whether they were.
    pub vsync: Vsync,
}

/// The framebuffer held against the files.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct PixelCheck {
    /// Pictures that were drawn and read back.
    pub pictures: u32,
    /// Bytes of red, green and blue that were not the file's.
    pub differing_bytes: u64,
}

/// Everything that was found.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Display {
    /// The monitor's name in the system; `None` where it has none.
    pub monitor: Option<String>,
    /// The window, physical pixels.
    pub window_px: [usize; 2],
    /// Physical pixels for one of the window system's points.
    pub scale: f32,
    /// The refresh; `None` where it was not measured.
    pub refresh: Option<Refresh>,
    /// The framebuffer; `None` where it was not read.
    pub pixels: Option<PixelCheck>,
    /// Why the experimenter lets a main study run on a display that is not verified; `None` where it need not or must not.
    pub allowed_unverified: Option<String>,
}

impl Display {
    /// Whether swaps are paced by the display.
    #[must_use]
    pub fn is_verified(&self) -> bool {
        self.refresh.as_ref().is_some_and(|refresh| refresh.hz.is_some())
    }

    /// What every row says.
    #[must_use]
    pub fn facts(&self) -> DisplayFacts {
        DisplayFacts {
            onset_source: OnsetSource::SwapReturn,
            refresh_hz: self.refresh.as_ref().and_then(|refresh| refresh.hz),
            vsync: if self.is_verified() { Vsync::Verified } else { Vsync::Unverified },
        }
    }

    /// The refresh in a sentence.
    #[must_use]
    pub fn refresh_in_words(&self) -> String {
        match &self.refresh {
            None => "Refresh not measured: unverified.".to_owned(),
            Some(Refresh { hz: Some(hz), .. }) => format!("Swaps are paced by the display at {hz:.3} Hz."),
            Some(Refresh { why_not, free_hz, .. }) => {
                let free = free_hz.map_or(String::new(), |hz| format!(" ({hz:.0} swaps a second)"));
                format!("Refresh unverified{free}: {}.", why_not.as_deref().unwrap_or("not measured"))
            }
        }
    }

    /// Why a study must not run here; a demonstration and a stated reason may.
    #[must_use]
    pub fn refuses(&self, demo: bool) -> Option<String> {
        if demo || self.is_verified() || self.allowed_unverified.is_some() {
            return None;
        }
        Some(format!(
            "A main study needs a display whose refresh is verified. {} Use another display or driver, switch off \
             compositing and variable refresh; or state with --allow-unverified why it may run all the same, which is \
             written into the data.",
            self.refresh_in_words()
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn measured(hz: Option<f64>) -> Display {
        let why_not = hz.is_none().then(|| "swaps do not wait".to_owned());
        let refresh = Refresh { os_hz: None, free_hz: Some(250.0), free_share: 1.0, held_share: 0.2, hz, why_not };
        Display { refresh: Some(refresh), ..Display::default() }
    }

    #[test]
    fn a_main_study_refuses_what_is_not_verified_unless_told_why() {
        assert!(measured(None).refuses(false).is_some_and(|why| why.contains("--allow-unverified")));
        assert!(Display::default().refuses(false).is_some(), "not measured is not verified");
        assert_eq!(measured(None).refuses(true), None);
        assert_eq!(measured(Some(60.0)).refuses(false), None);
        let allowed = Display { allowed_unverified: Some("a pilot".to_owned()), ..measured(None) };
        assert_eq!(allowed.refuses(false), None);
        assert_eq!((allowed.facts().vsync, allowed.facts().refresh_hz), (Vsync::Unverified, None));
    }
}
