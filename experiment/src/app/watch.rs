//! What happens to the window that may spoil a trial.

use crate::input::Interruption;

/// Compares the window with how it was in the pass before.
#[derive(Debug, Default)]
pub(super) struct Watch {
    before: Option<State>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct State {
    focused: bool,
    hidden: bool,
    scale: f32,
    size_px: [usize; 2],
}

impl Watch {
    /// What happened since the last pass.
    pub(super) fn look(&mut self, context: &egui::Context) -> Vec<Interruption> {
        let scale = context.pixels_per_point();
        let size_px = super::pixels::window_px(context);
        let (state, close) = context.input(|input| {
            let viewport = input.viewport();
            let hidden = viewport.occluded == Some(true) || viewport.minimized == Some(true);
            (State { focused: input.focused, hidden, scale, size_px }, viewport.close_requested())
        });
        let mut found = Vec::new();
        if close {
            found.push(Interruption::CloseRequested);
        }
        if let Some(before) = self.before.replace(state) {
            if before.focused && !state.focused {
                found.push(Interruption::FocusLost);
            }
            if !before.hidden && state.hidden {
                found.push(Interruption::Occluded);
            }
            if before.scale != state.scale {
                found.push(Interruption::ScaleChanged);
            }
            if before.size_px != state.size_px {
                found.push(Interruption::ScreenChanged);
            }
        }
        found
    }
}
