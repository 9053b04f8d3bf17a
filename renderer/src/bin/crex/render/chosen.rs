//! `--crex auto`: a crex chosen for a time limit, before anything is rendered.

use renderer::crex::{self, Program};
use renderer::picture::display::Display;
use renderer::propose::{self, Levels, Profile};
use renderer::schedule::{Clock, MonotonicClock};

use super::{Args, Prepared};
use crate::console::{self, Failure};
use crate::timed;

/// What stands in place of a crex.
pub(crate) const AUTO: &str = "auto";

/// The part of the time left that choosing may take.
const CHOOSING: f64 = 0.1;

/// The part of what is left then that tracing has: the rest is for filling in and writing.
const TRACING: f64 = 0.9;

/// The same words with a crex in place of `auto`: the recorded one for `--replay`, and none yet for a time limit.
pub(crate) fn with_crex(args: &Args) -> Result<Args, Failure> {
    let crex = match (&args.replay, args.time, args.views.is_some() || args.shard.is_some()) {
        (Some(file), _, _) => timed::recorded_crex(file)?,
        (None, Some(_), false) => String::new(),
        _ => {
            let advice = "give --time SECONDS, or ask `crex auto SCENE...` for a crex and give that";
            return Err(Failure::input(format!("--crex auto is chosen for one picture within a time limit: {advice}")));
        }
    };
    Ok(Args { crex, ..args.clone() })
}

/// Chooses the crex of least predicted loss that is predicted to fit, and says so. Where there is no time to choose, or nothing that
/// was looked at fits, it is the full solution, of which the time limit skips what does not fit.
pub(crate) fn choose(prepared: &mut Prepared, seconds: f64, clock: &MonotonicClock) -> Result<(), Failure> {
    let settings = prepared.request.settings.clone();
    let threads = timed::threads(&settings) as f64;
    let left_s = || seconds - clock.now_s();
    let choosing_s = CHOOSING * left_s();
    let until_s = clock.now_s() + choosing_s;
    let display = Display::of_the_paper();
    let question = prepared.question(&settings, &display, None);
    let components = prepared.scene().components(settings.limits.glossy_threshold);
    let mut chosen = (Levels::full(components).crex(), "the full solution: there is no time to choose".to_owned());
    if let Some(mut profile) = Profile::within(question, choosing_s * threads)? {
        let proposal = propose::propose_while(&mut profile, &|| clock.now_s() < until_s)?;
        let best = proposal.within_seconds(TRACING * left_s() * threads);
        let (loss, took) = (best.forecast.loss_jod, best.forecast.seconds / threads);
        let seen = proposal.seen.len();
        if best.crex.is_empty() && seen > 1 {
            chosen.1 = format!("the full solution: none of {seen} crexes looked at is predicted to fit");
        } else {
            let why =
                format!("of {seen} looked at; predicted {took:.2} s of tracing, {loss:.2} JOD from the full solution");
            chosen = (best.crex.clone(), why);
        }
    }
    let (text, why) = chosen;
    console::say("note", &format!("--crex auto is \"{text}\": {why}"));
    prepared.request.program = Program::new(&crex::parse(&text).expect("every spelling of levels parses"));
    prepared.request.provenance.crex = Some(text);
    Ok(())
}
