//! Everything that the program says: results on standard output, messages and progress on standard error.

use std::fmt::Display;
use std::io::{self, ErrorKind, Write};
use std::process::ExitCode;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use renderer::picture;
use renderer::schedule::{Clock, MonotonicClock};
use serde::Serialize;

/// Why a command ends without its result.
#[derive(Debug)]
pub(crate) enum Failure {
    /// The command line is wrong, or help was asked for.
    Usage(clap::Error),
    /// The input is wrong: exit code 2.
    Input(String),
    /// The machine could not: exit code 1.
    Cannot(String),
    /// The result is printed already; exit code 2.
    Told,
}

impl Failure {
    /// Wrong input, by its message.
    pub(crate) fn input(message: impl Display) -> Self {
        Self::Input(message.to_string())
    }

    /// Says what is wrong and gives the exit code.
    pub(crate) fn report(self) -> ExitCode {
        match self {
            Self::Usage(error) => {
                // A closed pipe is all that can go wrong here, and then nobody listens.
                let _ = error.print();
                ExitCode::from(if error.use_stderr() { 2 } else { 0 })
            }
            Self::Input(message) => {
                say("error", &message);
                ExitCode::from(2)
            }
            Self::Cannot(message) => {
                say("error", &message);
                ExitCode::from(1)
            }
            Self::Told => ExitCode::from(2),
        }
    }
}

impl From<picture::Error> for Failure {
    fn from(error: picture::Error) -> Self {
        if error.is_input() { Self::Input(error.to_string()) } else { Self::Cannot(error.to_string()) }
    }
}

/// A message on standard error: `error: ...`, `warning: ...`, `note: ...`. A message that already says so is not told twice.
pub(crate) fn say(kind: &str, message: &str) {
    let mut stderr = io::stderr().lock();
    let message = message.trim_end();
    let prefix = if message.starts_with(&format!("{kind}:")) { String::new() } else { format!("{kind}: ") };
    // Without standard error there is nowhere to complain.
    let _ = writeln!(stderr, "{prefix}{message}");
}

/// Text for standard output.
pub(crate) fn print(text: &str) -> Result<(), Failure> {
    let mut stdout = io::stdout().lock();
    match stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        Err(error) => Err(Failure::Cannot(format!("standard output: {error}"))),
        Ok(()) => Ok(()),
    }
}

/// One JSON object for standard output.
pub(crate) fn print_json(value: &impl Serialize) -> Result<(), Failure> {
    let text = serde_json::to_string(value).map_err(|error| Failure::Cannot(error.to_string()))?;
    print(&format!("{text}\n"))
}

/// A bar on standard error, if that is a terminal and the work takes over a second.
pub(crate) struct Progress<'a> {
    bar: ProgressBar,
    clock: &'a MonotonicClock,
    begun_s: f64,
}

impl<'a> Progress<'a> {
    /// Parts of the work that the bar tells apart.
    const STEPS: u64 = 1000;

    pub(crate) fn new(clock: &'a MonotonicClock) -> Self {
        let bar = ProgressBar::with_draw_target(Some(Self::STEPS), ProgressDrawTarget::stderr_with_hz(5));
        let style = ProgressStyle::with_template("{wide_bar} {percent:>3} % {elapsed} left {eta}");
        bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
        Self { bar, clock, begun_s: clock.now_s() }
    }

    /// Shows how much is done, from 0 to 1.
    pub(crate) fn set(&self, fraction: f64) {
        if self.clock.now_s() - self.begun_s > 1.0 {
            self.bar.set_position((fraction * Self::STEPS as f64) as u64);
        }
    }

    /// Takes the bar away.
    pub(crate) fn done(&self) {
        self.bar.finish_and_clear();
    }
}
