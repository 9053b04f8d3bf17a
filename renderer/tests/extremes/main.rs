//! Numbers at their extremes: a table of cases whose expected values are closed forms or invariants, through the whole
//! renderer. `cargo test -p renderer --test extremes -- --table` prints the table that `docs/numerics.md` shows.

#![allow(clippy::unwrap_used, reason = "a test that cannot start has failed")]

mod chains;
mod input;
mod laws;
mod lights;
mod look;
mod materials;
mod media;
mod pictures;
mod places;
mod random;
mod shapes;
mod table;
mod views;

use libtest_mimic::{Arguments, Trial};
use table::{Case, documented, print};

fn cases() -> Vec<Case> {
    [
        places::cases(),
        shapes::cases(),
        chains::cases(),
        lights::cases(),
        materials::cases(),
        media::cases(),
        views::cases(),
        input::cases(),
        pictures::cases(),
        laws::cases(),
    ]
    .into_iter()
    .flatten()
    .collect()
}

fn main() {
    if std::env::args().any(|word| word == "--table") {
        return print(&cases());
    }
    let mut trials: Vec<Trial> = cases().into_iter().map(Case::into_trial).collect();
    trials.push(Trial::test("docs::every_case_is_in_the_table", || documented(&cases())));
    libtest_mimic::run(&Arguments::from_args(), trials).exit();
}
