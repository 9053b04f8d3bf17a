//! What a reader of scenes may do, and how much.

/// How to read a scene.
#[derive(Clone, Copy, Default)]
pub struct Options<'a> {
    /// Runs commands that are not known natively; without it such a command is an error. A scene then runs whatever it
    /// likes with the user's rights.
    pub commands: Option<&'a dyn Commands>,
    /// How large a scene may become.
    pub limits: Limits,
}

/// Runs a command line for a scene.
pub trait Commands {
    /// Runs `line` in `folder` (empty: the caller's own) and gives what it wrote to its standard output.
    ///
    /// # Errors
    /// Why it failed, in words.
    fn run(&self, line: &str, folder: &str) -> Result<Vec<u8>, String>;
}

/// Ends for scenes that would grow without: an array of 10^12 copies is one line of text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Primitives in all.
    pub primitives: u64,
    /// Arguments of all primitives.
    pub values: u64,
    /// Texts that commands read, each counted once for every folder in which its commands run.
    pub files: usize,
    /// How deep texts read each other.
    pub depth: usize,
}

impl Default for Limits {
    /// About 4 GB.
    fn default() -> Self {
        Self { primitives: 10_000_000, values: 200_000_000, files: 20_000, depth: 64 }
    }
}
