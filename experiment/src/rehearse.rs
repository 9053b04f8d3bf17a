//! A session without a window: a simulated observer, and time that jumps from one event to the next.

use analysis::trial_log::{OnsetSource, Vsync};

use crate::clock::Time;
use crate::conduct::Conductor;
use crate::display::DisplayFacts;
use crate::error::{Error, Result};
use crate::input::Key;
use crate::observer::{Act, Observer};
use crate::session::{Input, Outcome, Screen, Session};

/// No display was there, so nothing is claimed about one.
pub const NO_DISPLAY: DisplayFacts =
    DisplayFacts { onset_source: OnsetSource::Estimated, refresh_hz: None, vsync: Vsync::Unverified };

/// The frame period of the display that is not there, seconds.
const FRAME_S: f64 = 1.0 / 60.0;

/// Drives a session with an observer to its end; says how it ended. `look` sees the session after every event.
///
/// # Errors
/// If a record cannot be saved: a rehearsal does not wait for somebody to free the disk.
pub fn run(
    conductor: &mut Conductor<'_>,
    observer: &mut Observer,
    time: &mut Time,
    look: &mut dyn FnMut(&Conductor<'_>),
) -> Result<Outcome> {
    loop {
        look(conductor);
        if let Some(outcome) = conductor.finished() {
            return Ok(outcome);
        }
        if let Screen::Trouble(why) = conductor.session().screen() {
            return Err(Error::Machine(why.to_owned()));
        }
        // A screen is drawn and seen at once; a timed one changes when it is due.
        conductor.step(Input::Frame { shows_s: time.now_s(), frame_s: FRAME_S });
        conductor.step(Input::Swapped { at_s: time.now_s(), frame_s: FRAME_S });
        if let Some(due_s) = conductor.session().due_s() {
            time.until(due_s);
            continue;
        }
        let session = conductor.session();
        if matches!(session.screen(), Screen::Fixation | Screen::Picture(_) | Screen::Gap | Screen::Trouble(_)) {
            continue; // it was drawn and not yet seen
        }
        let action = observer.act(&session.screen(), session.trial());
        let now_s = time.until(time.now_s() + action.after_s);
        match action.act {
            Act::Write(text) => conductor.step(Input::Text(text)),
            Act::Press(keys) => keys.into_iter().for_each(|key| conductor.step(Input::Key { key, now_s })),
            Act::Leave => leave(conductor, time, now_s),
        }
    }
}

/// The experimenter's two steps that end a session.
fn leave(conductor: &mut Conductor<'_>, time: &mut Time, now_s: f64) {
    conductor.step(Input::Key { key: Key::Escape, now_s });
    let now_s = time.until(now_s + Session::HOLD_S);
    conductor.step(Input::Frame { shows_s: now_s, frame_s: FRAME_S });
    conductor.step(Input::Key { key: Key::F10, now_s });
}

#[cfg(test)]
mod tests;
