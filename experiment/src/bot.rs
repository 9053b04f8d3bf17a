//! A simulated observer before a real window: it looks at what the session shows and presses keys when its time comes.

use crate::conduct::Conductor;
use crate::input::Key;
use crate::observer::{Act, Observer};
use crate::session::{Input, Screen, Session};

/// An observer, and what it is about to do.
#[derive(Debug)]
pub struct Bot {
    /// Its code.
    pub participant: String,
    observer: Observer,
    /// What it will do, and when, session seconds.
    pending: Option<(f64, Act)>,
    /// Escape is held since then, in the experimenter's place.
    leaving_since_s: Option<f64>,
}

impl Bot {
    /// A bot that has not looked yet.
    #[must_use]
    pub fn new(participant: String, observer: Observer) -> Self {
        Self { participant, observer, pending: None, leaving_since_s: None }
    }

    /// Does what is due at `now_s`.
    pub fn act(&mut self, conductor: &mut Conductor<'_>, now_s: f64) {
        if let Some(since_s) = self.leaving_since_s {
            if now_s - since_s > Session::HOLD_S && conductor.session().abort_asked() {
                self.leaving_since_s = None;
                conductor.step(Input::Key { key: Key::F10, now_s });
            }
            return;
        }
        let Some((_, act)) = self.pending.take_if(|(at_s, _)| *at_s <= now_s) else { return };
        match act {
            Act::Write(text) => conductor.step(Input::Text(text)),
            Act::Press(keys) => keys.into_iter().for_each(|key| conductor.step(Input::Key { key, now_s })),
            Act::Leave => {
                self.leaving_since_s = Some(now_s);
                conductor.step(Input::Key { key: Key::Escape, now_s });
            }
        }
    }

    /// Looks at the screen and decides, once it waits for an answer.
    pub fn look(&mut self, conductor: &Conductor<'_>, now_s: f64) {
        let session = conductor.session();
        let screen = session.screen();
        if matches!(screen, Screen::Fixation | Screen::Picture(_) | Screen::Gap) || !session.is_shown() {
            return;
        }
        if self.pending.is_none() && self.leaving_since_s.is_none() {
            let action = self.observer.act(&screen, session.trial());
            self.pending = Some((now_s + action.after_s, action.act));
        }
    }
}
