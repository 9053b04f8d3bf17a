//! The report as a web page.

use std::fmt::Write;

use super::numbers::{p_value, percent, short};
use super::{ArmReport, Report, Tests};

const STYLE: &str = "body{font:16px/1.5 system-ui,sans-serif;max-width:70rem;margin:2rem auto;padding:0 1rem}\
table{border-collapse:collapse}th,td{padding:.3rem .7rem;border-bottom:1px solid #888;text-align:left}\
code{overflow-wrap:anywhere}";

pub(super) fn write(report: &Report) -> String {
    let title = escape(&report.title());
    let mut out = format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>{title}</title>\n\
         <style>{STYLE}</style>\n</head>\n<body>\n<main>\n<h1>{title}</h1>\n"
    );
    if report.simulated {
        out += "<p><strong>Simulated observers answered: these are not data of people.</strong></p>\n";
    }
    if report.demo {
        out += "<p><strong>A demonstration, not a study.</strong></p>\n";
    }
    for arm in &report.arms {
        let _ = writeln!(out, "<p><strong>{}</strong>: {}</p>", escape(&arm.arm), escape(&arm.verdict.sentence));
    }
    out += "<h2>Arms</h2>\n";
    arms(&mut out, &report.arms);
    list(&mut out, report.arms.iter().flat_map(|arm| arm.notes.iter().map(move |note| format!("{}: {note}", arm.arm))));
    out += "<h2>Exclusions</h2>\n";
    if report.provenance.logs.is_empty() {
        out += "<p>Counts were given, not trials: nothing could be left out.</p>\n";
    } else {
        let _ = writeln!(out, "<p>{} sessions, {} analysed.</p>", report.flow.sessions, report.flow.analysed);
        let reasons = report.flow.excluded.iter();
        list(&mut out, reasons.map(|(reason, count)| format!("{count} left out because {}", reason.words())));
        if !report.exclusions.is_empty() {
            out += "<h3>With every answered trial</h3>\n";
            arms(&mut out, &report.without_exclusions);
        }
    }
    out += "<h2>Plan</h2>\n";
    if report.deviations.is_empty() {
        out += "<p>The analysis plan is the one that every log recorded before its first trial.</p>\n";
    }
    list(&mut out, report.deviations.iter().cloned());
    out += "<h2>Provenance</h2>\n<dl>\n";
    for (name, value) in provenance(report) {
        let _ = writeln!(out, "<dt>{}</dt><dd><code>{}</code></dd>", escape(&name), escape(&value));
    }
    out + "</dl>\n</main>\n</body>\n</html>\n"
}

/// Names and values of what the numbers come from.
pub(super) fn provenance(report: &Report) -> Vec<(String, String)> {
    let from = &report.provenance;
    let mut rows = Vec::new();
    for log in &from.logs {
        rows.push((format!("log {} ({} rows), SHA-256", log.file, log.rows), log.sha256.clone()));
    }
    rows.extend(from.counts.iter().map(|counts| ("counts as typed".to_owned(), counts.clone())));
    let hashes = [
        ("allocation plan, SHA-256", &from.plan_hash),
        ("stimuli manifest, SHA-256", &from.stimuli_hash),
        ("analysis plan, SHA-256", &from.analysis_plan_hash),
    ];
    for (name, hash) in hashes {
        if let Some(hash) = hash {
            rows.push((name.to_owned(), hash.clone()));
        }
    }
    if let Some([first, last]) = &from.started_utc {
        rows.push(("first and last session".to_owned(), format!("{first}, {last}")));
    }
    if !from.session_versions.is_empty() {
        rows.push(("session program".to_owned(), from.session_versions.join(", ")));
    }
    rows.push(("report program".to_owned(), from.report_version.clone()));
    rows
}

fn list(out: &mut String, items: impl Iterator<Item = String>) {
    let items: Vec<String> = items.map(|item| format!("<li>{}</li>", escape(&item))).collect();
    if !items.is_empty() {
        let _ = writeln!(out, "<ul>{}</ul>", items.join("\n"));
    }
}

fn arms(out: &mut String, arms: &[ArmReport]) {
    out.push_str(
        "<table>\n<thead><tr><th>arm<th>counted<th>k of n<th>share<th>chi-square (df)<th>p<th>exact p\
         <th>Clopper-Pearson<th>Wilson</tr></thead>\n<tbody>\n",
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
    out.push_str("</tbody>\n</table>\n");
}

fn row(out: &mut String, arm: &str, what: &str, k: u64, n: u64, tests: &Tests) {
    let share = if n == 0 { String::new() } else { percent(k as f64 / n as f64) };
    let chi = tests.chi_square.map(|chi| format!("{} ({})", short(chi.statistic), chi.df)).unwrap_or_default();
    let chi_p = tests.chi_square.map(|chi| p_value(chi.p, chi.log10_p)).unwrap_or_default();
    let exact = tests.binomial.map(|exact| p_value(exact.p, exact.log10_p)).unwrap_or_default();
    let range = |range: Option<[f64; 2]>| range.map(|[low, high]| format!("[{low:.3}, {high:.3}]")).unwrap_or_default();
    let clopper_pearson = range(tests.intervals.map(|intervals| intervals.clopper_pearson));
    let wilson = range(tests.intervals.map(|intervals| intervals.wilson));
    let _ = writeln!(
        out,
        "<tr><th scope=\"row\">{}<td>{}<td>{k} of {n}<td>{share}<td>{chi}<td>{chi_p}<td>{exact}<td>{clopper_pearson}<td>{wilson}</tr>",
        escape(arm),
        escape(what)
    );
}

/// Text that is only text in HTML.
fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            _ => out.push(character),
        }
    }
    out
}
