//! The keys that a session knows, by their place on the keyboard: the same key is the same answer under every layout.

/// A key, by its place. What is printed on it depends on the country; digits are where a digit row or pad has them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Key {
    /// A digit of the row above the letters or of the number pad, 0 to 9.
    Digit(u8),
    /// Enter, on either pad.
    Enter,
    /// The space bar.
    Space,
    /// Backspace.
    Backspace,
    /// Held down, the first of the two steps of an abort.
    Escape,
    /// The second step of an abort.
    F10,
    /// Any other key.
    Other,
}

/// What can happen to a session from outside that may spoil a trial.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Interruption {
    /// Escape was pressed.
    Escape,
    /// The window was asked to close.
    CloseRequested,
    /// Another window took the keyboard.
    FocusLost,
    /// The window was covered or minimised.
    Occluded,
    /// The scale factor changed.
    ScaleChanged,
    /// The window changed its size or its screen.
    ScreenChanged,
    /// The machine slept, or the program was stopped.
    Suspended,
    /// The experimenter ended the session.
    Aborted,
    /// The program or the machine stopped working.
    Crash,
}

impl Interruption {
    /// The word in the log.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Escape => "escape",
            Self::CloseRequested => "close_requested",
            Self::FocusLost => "focus_lost",
            Self::Occluded => "occluded",
            Self::ScaleChanged => "scale_changed",
            Self::ScreenChanged => "screen_changed",
            Self::Suspended => "suspended",
            Self::Aborted => "aborted",
            Self::Crash => "crash",
        }
    }
}
