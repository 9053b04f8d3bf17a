//! The table: what is expected in a case, what came, and whether that holds.

use std::fmt::Debug;

use libtest_mimic::{Failed, Trial};

/// What a case found.
pub(crate) struct Row {
    expected: String,
    got: String,
    holds: bool,
}

impl Row {
    /// A number within a relative distance of another. 0 means: the same number.
    pub(crate) fn near(expected: f64, got: f64, relative: f64) -> Self {
        let bound = if relative == 0.0 { String::new() } else { format!(" within {relative:e}") };
        Self {
            expected: format!("{}{bound}", number(expected)),
            got: number(got),
            holds: (got - expected).abs() <= relative * expected.abs(),
        }
    }

    /// The same value.
    pub(crate) fn same<T: PartialEq + Debug>(expected: T, got: T) -> Self {
        Self { expected: format!("{expected:?}"), got: format!("{got:?}"), holds: expected == got }
    }

    /// Something in words.
    pub(crate) fn says(expected: &str, got: impl Into<String>, holds: bool) -> Self {
        Self { expected: expected.to_owned(), got: got.into(), holds }
    }

    /// A message that must hold some words.
    pub(crate) fn message(words: &str, got: Result<(), String>) -> Self {
        let got = got.err().unwrap_or_else(|| "no error".to_owned());
        let line = got.lines().next().unwrap_or_default();
        Self::says(&format!("error: .. {words} .."), line, got.contains(words))
    }
}

fn number(value: f64) -> String {
    if value == 0.0 || (1e-3..1e6).contains(&value.abs()) { format!("{value:.7}") } else { format!("{value:.6e}") }
}

/// A case of the table.
pub(crate) struct Case {
    group: &'static str,
    name: &'static str,
    run: fn() -> Row,
}

/// What a case is called, and how it is run.
pub(crate) type Named = (&'static str, fn() -> Row);

/// Cases of one group.
pub(crate) fn group(group: &'static str, cases: &[Named]) -> Vec<Case> {
    cases.iter().map(|&(name, run)| Case { group, name, run }).collect()
}

impl Case {
    pub(crate) fn into_trial(self) -> Trial {
        Trial::test(format!("{}::{}", self.group, self.name.replace(' ', "_")), move || {
            let Row { expected, got, holds } = (self.run)();
            if holds { Ok(()) } else { Err(Failed::from(format!("expected {expected}, got {got}"))) }
        })
    }

    fn start(&self) -> String {
        format!("| {} | {} |", self.group, self.name)
    }
}

/// Prints the table in Markdown.
pub(crate) fn print(cases: &[Case]) {
    println!("| group | case | expected | got |\n|---|---|---|---|");
    for case in cases {
        let Row { expected, got, holds } = (case.run)();
        let mark = if holds { "" } else { " **fails**" };
        println!("{} {} | {}{mark} |", case.start(), plain(&expected), plain(&got));
    }
}

/// A bar would start another column.
fn plain(text: &str) -> String {
    text.replace('|', "/")
}

/// Whether the table in the documentation has a row for each case and no others.
pub(crate) fn documented(cases: &[Case]) -> Result<(), Failed> {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/numerics.md");
    let text = std::fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))?;
    let table = text.split_once("| group | case |").map_or("", |(_, table)| table);
    let rows: Vec<&str> = table.lines().skip(2).take_while(|line| line.starts_with('|')).collect();
    for case in cases {
        if !rows.iter().any(|row| row.starts_with(&case.start())) {
            return Err(format!("no row for {}: print the table anew", case.start()).into());
        }
    }
    if rows.len() == cases.len() { Ok(()) } else { Err("the table has rows of cases that are no more".into()) }
}
