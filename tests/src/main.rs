//! What crosses crates, as one test binary: `cargo test -p tests -- house` runs a part of it.

mod house;
mod patterns;
mod reference;

fn main() {
    let arguments = libtest_mimic::Arguments::from_args();
    let trials = [house::trials(), patterns::trials(), reference::trials()].into_iter().flatten().collect();
    libtest_mimic::run(&arguments, trials).exit();
}
