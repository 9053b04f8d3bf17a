//! How the numbers are made, and where they come from.

use super::Report;
use super::block::Table;
use super::numbers::{grouped, short};

/// What each number is, for a reader who wants to make it again.
pub(super) fn methods(report: &Report) -> Vec<(String, String)> {
    let level = short(100.0 * (1.0 - report.alpha));
    let mut facts = vec![
        ("unit", "One participant is one count: the critical trial. Later trials are never pooled with it.".to_owned()),
        ("chi-square", "Pearson's statistic of the two counts against equal shares, one degree of freedom, p by the survival function; no continuity correction, as in 2005.".to_owned()),
        ("exact p", "Twice the smaller tail of the binomial distribution at one half. This test decides; chi-square stands beside it.".to_owned()),
        ("intervals", format!("{level} %: Clopper-Pearson (exact, drawn), Wilson's score interval, and equal tails of the posterior under Jeffreys' prior.")),
        ("effect sizes", "h = asin(2p - 1), w = |2p - 1|, g = p - 1/2, d\u{2032} = sqrt 2 z(p) with its value at the Clopper-Pearson limits, JOD = z(p) / z(3/4).".to_owned()),
        ("lean and order", "With H and F the shares answering \"second\" where the lower quality came second and first: d\u{2032} = (z(H) - z(F)) / sqrt 2, c = -(z(H) + z(F)) / 2.".to_owned()),
        ("equivalence", "Two one-sided exact binomial tests at the bound, and the same question for the order-corrected proportion \u{3a6}((z(H) - z(F)) / 2) by profile likelihood with the lean free. Only where both pass at a bound that the logs show to have been fixed beforehand is it claimed.".to_owned()),
        ("between arms", "Newcombe's hybrid score interval of the difference; Fisher's exact test; Barnard's with the pooled score statistic.".to_owned()),
        ("Bayes factors", "Probability of the data at one half, divided by that under each of three priors of the proportion.".to_owned()),
        ("power", "Exact, by summing the binomial distribution over the rejected counts.".to_owned()),
    ];
    if report.ladder.is_some() {
        facts.push(("ladder", format!("1/2 + (1/2 - lapse) F(x) with x minus the logarithm of the seconds, by maximum likelihood; the threshold's {level} % interval is equal tails of a posterior that is flat in threshold, logarithm of the width, and lapse up to .1. With one reference for all qualities, Thurstone's scale is each quality's own z(p).")));
    }
    facts.into_iter().map(|(name, text)| (name.to_owned(), text)).collect()
}

/// The logs with their digests; none for published counts.
pub(super) fn logs(report: &Report) -> Option<Table> {
    let logs = &report.provenance.logs;
    let rows = logs.iter().map(|log| {
        let plan = log.analysis_plan_hash.as_ref().map(|hash| hash.chars().take(12).collect());
        vec![log.file.clone(), grouped(log.rows), log.sha256.clone(), plan.unwrap_or_else(|| "none".to_owned())]
    });
    let columns = vec!["log", "rows", "SHA-256", "analysis plan recorded"];
    (!logs.is_empty()).then(|| Table { caption: "Logs".to_owned(), columns, rows: rows.collect() })
}

/// Names and values of what else the numbers come from.
pub(super) fn provenance(report: &Report) -> Vec<(String, String)> {
    let from = &report.provenance;
    let mut rows: Vec<(String, String)> =
        from.counts.iter().map(|counts| ("counts as typed".to_owned(), counts.clone())).collect();
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
