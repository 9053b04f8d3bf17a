//! The report as Markdown.

use std::fmt::Write;

use super::numbers::{p_value, percent, short};
use super::{ArmReport, Report, Tests};

pub(super) fn write(report: &Report) -> String {
    let mut out = format!("# {}\n\n", report.title());
    if report.simulated {
        out += "**Simulated observers answered: these are not data of people.**\n\n";
    }
    if report.demo {
        out += "**A demonstration, not a study.**\n\n";
    }
    for arm in &report.arms {
        let _ = writeln!(out, "- **{}**: {}", cell(&arm.arm), arm.verdict.sentence);
    }
    out += "\n## Arms\n\n";
    arms(&mut out, &report.arms);
    for arm in &report.arms {
        for note in &arm.notes {
            let _ = writeln!(out, "- {}: {note}", cell(&arm.arm));
        }
    }
    out += "\n## Exclusions\n\n";
    let flow = &report.flow;
    if report.provenance.logs.is_empty() {
        out += "Counts were given, not trials: nothing could be left out.\n";
    } else {
        let _ = writeln!(out, "{} sessions, {} analysed.\n", flow.sessions, flow.analysed);
        for (reason, count) in &flow.excluded {
            let _ = writeln!(out, "- {count} left out because {}", reason.words());
        }
        if !report.exclusions.is_empty() {
            out += "\n| session | participant | arm | reason | where |\n|---|---|---|---|---|\n";
            for excluded in &report.exclusions {
                let detail = if excluded.detail.is_empty() { String::new() } else { format!(": {}", excluded.detail) };
                let _ = writeln!(
                    out,
                    "| {} | {} | {} | {}{} | {}, line {} |",
                    cell(&excluded.session_id),
                    cell(&excluded.participant),
                    cell(&excluded.arm),
                    excluded.reason.words(),
                    cell(&detail),
                    cell(&excluded.file),
                    excluded.line
                );
            }
            out += "\n### With every answered trial\n\n";
            arms(&mut out, &report.without_exclusions);
        }
    }
    out += "\n## Plan\n\n";
    for deviation in &report.deviations {
        let _ = writeln!(out, "- {deviation}");
    }
    if report.deviations.is_empty() {
        out += "- The analysis plan is the one that every log recorded before its first trial.\n";
    }
    out += "\n## Provenance\n\n";
    for (name, value) in super::html::provenance(report) {
        let _ = writeln!(out, "- {name}: `{value}`");
    }
    out
}

fn arms(out: &mut String, arms: &[ArmReport]) {
    out.push_str(
        "| arm | counted | k of n | share | chi-square (df) | p | exact p | Clopper-Pearson | Wilson |\n\
         |---|---|---|---|---|---|---|---|---|\n",
    );
    for arm in arms {
        if let Some(correct) = arm.correct {
            row(out, &arm.arm, "right answers", correct, arm.n, &arm.tests);
        }
        if let Some(second) = &arm.second_chosen {
            row(out, &arm.arm, "second interval chosen", second.k, second.n, &second.tests);
        }
        for layout in &arm.layout_chosen {
            let what = format!("layout {} chosen, not {}", layout.layout, layout.other);
            row(out, &arm.arm, &what, layout.chosen.k, layout.chosen.n, &layout.chosen.tests);
        }
    }
    out.push('\n');
}

fn row(out: &mut String, arm: &str, what: &str, k: u64, n: u64, tests: &Tests) {
    let share = if n == 0 { String::new() } else { percent(k as f64 / n as f64) };
    let chi = tests.chi_square.map(|chi| format!("{} ({})", short(chi.statistic), chi.df)).unwrap_or_default();
    let chi_p = tests.chi_square.map(|chi| p_value(chi.p, chi.log10_p)).unwrap_or_default();
    let exact = tests.binomial.map(|exact| p_value(exact.p, exact.log10_p)).unwrap_or_default();
    let range = |range: Option<[f64; 2]>| range.map(|[low, high]| format!("[{low:.3}, {high:.3}]")).unwrap_or_default();
    let clopper_pearson = range(tests.intervals.map(|intervals| intervals.clopper_pearson));
    let wilson = range(tests.intervals.map(|intervals| intervals.wilson));
    let (arm, what) = (cell(arm), cell(what));
    let _ = writeln!(
        out,
        "| {arm} | {what} | {k} of {n} | {share} | {chi} | {chi_p} | {exact} | {clopper_pearson} | {wilson} |"
    );
}

/// Text that cannot leave its table cell.
fn cell(text: &str) -> String {
    let mut out = String::new();
    for character in text.chars() {
        match character {
            '|' | '*' | '_' | '`' | '<' | '[' | '\\' => {
                out.push('\\');
                out.push(character);
            }
            '\n' | '\r' => out.push(' '),
            _ => out.push(character),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    #[test]
    fn names_cannot_break_the_table() {
        assert_eq!(super::cell("a|b\n<i>"), "a\\|b \\<i>");
    }
}
