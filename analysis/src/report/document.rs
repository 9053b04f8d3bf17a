//! What the pages say, in order: the one source of the HTML and the Markdown.

use super::Report;
use super::arm::{ArmReport, Tests};
use super::block::{Block, Table};
use super::numbers::{p_value, percent, range, short};
use super::plot::{self, Row};
use super::sources;
use super::words;

/// Exclusions that a page lists; the JSON has more.
const ON_THE_PAGE: usize = 200;

/// The whole report.
pub(super) fn of(report: &Report) -> Vec<Block> {
    let mut blocks = vec![Block::Title(report.title())];
    if report.simulated {
        blocks.push(Block::Banner("Simulated observers answered: these are not data of people.".to_owned()));
    }
    if report.demo {
        blocks.push(Block::Banner("A demonstration, not a study.".to_owned()));
    }
    for arm in &report.arms {
        blocks.push(Block::Verdict(arm.arm.clone(), arm.verdict.finding, arm.verdict.sentence.clone()));
    }
    if report.arms.is_empty() {
        blocks.push(Block::Text("No critical trial was analysed.".to_owned()));
    }
    results(report, &mut blocks);
    for arm in &report.arms {
        one_arm(report, arm, &mut blocks);
    }
    between(report, &mut blocks);
    people(report, &mut blocks);
    task(report, &mut blocks);
    shown(report, &mut blocks);
    plan(report, &mut blocks);
    blocks.push(Block::Heading(2, "How the numbers are made".to_owned()));
    blocks.push(Block::Facts(sources::methods(report)));
    blocks.push(Block::Heading(2, "Provenance".to_owned()));
    blocks.extend(sources::logs(report).map(Block::Table));
    blocks.push(Block::Facts(sources::provenance(report)));
    blocks
}

fn results(report: &Report, blocks: &mut Vec<Block>) {
    if report.arms.is_empty() {
        return;
    }
    blocks.push(Block::Heading(2, "Results".to_owned()));
    let mut rows = Vec::new();
    for arm in &report.arms {
        if let (Some(counts), Some(intervals)) = (arm.counts(), &arm.tests.intervals) {
            let label = format!("{}: right answers", arm.arm);
            rows.push(Row { label, counts, interval: intervals.clopper_pearson, main: true });
        }
        if let Some(chosen) = &arm.second_chosen
            && let Some(intervals) = &chosen.tests.intervals
        {
            let counts = crate::proportion::Proportion { k: chosen.k, n: chosen.n };
            let label = format!("{}: chose the second", arm.arm);
            rows.push(Row { label, counts, interval: intervals.clopper_pearson, main: !arm.right_answer });
        }
    }
    let bound = report.plan.as_ref().map(|plan| plan.bound.proportion);
    if !rows.is_empty() {
        blocks.push(Block::Figures(vec![plot::intervals(&rows, bound, 1.0 - report.alpha, false)]));
    }
    blocks.push(Block::Table(tests("Tests against one half", &report.arms)));
    let effects: Vec<Vec<String>> = report.arms.iter().filter_map(effects).collect();
    if !effects.is_empty() {
        let columns = vec![
            "arm",
            "h",
            "w",
            "g",
            "d\u{2032}",
            "d\u{2032} interval",
            "JOD",
            "BF01 uniform",
            "BF01 50-100 %",
            "BF01 Jeffreys",
        ];
        let caption = "Effect sizes of right answers, and Bayes factors in favour of guessing".to_owned();
        blocks.push(Block::Table(Table { caption, columns, rows: effects }));
    }
    let rows: Vec<Vec<String>> = report.arms.iter().filter_map(equivalence).collect();
    if !rows.is_empty() {
        let columns = vec!["arm", "bound", "raw p", "order-corrected share", "its interval", "corrected p", "shown"];
        let caption = "Equivalence within the planned bound; both tests must pass".to_owned();
        blocks.push(Block::Table(Table { caption, columns, rows }));
    }
}

/// The tests of every count of every arm.
fn tests(caption: &str, arms: &[ArmReport]) -> Table {
    let mut rows = Vec::new();
    for arm in arms {
        if let Some(correct) = arm.correct {
            rows.push(row(&arm.arm, "right answers", correct, arm.n, &arm.tests));
        }
        if let Some(second) = &arm.second_chosen {
            rows.push(row(&arm.arm, "second interval chosen", second.k, second.n, &second.tests));
        }
        for layout in &arm.layout_chosen {
            let what = format!("layout {} chosen, not {}", layout.layout, layout.other);
            rows.push(row(&arm.arm, &what, layout.chosen.k, layout.chosen.n, &layout.chosen.tests));
        }
    }
    let columns = vec![
        "arm",
        "counted",
        "k of n",
        "share",
        "chi-square (df)",
        "p",
        "exact p",
        "Clopper-Pearson",
        "Wilson",
        "Jeffreys",
    ];
    Table { caption: caption.to_owned(), columns, rows }
}

fn row(arm: &str, what: &str, k: u64, n: u64, tests: &Tests) -> Vec<String> {
    let share = if n == 0 { String::new() } else { percent(k as f64 / n as f64) };
    let chi = tests.chi_square.map(|chi| format!("{} ({})", short(chi.statistic), chi.df)).unwrap_or_default();
    let chi_p = tests.chi_square.map(|chi| p_value(chi.p, chi.log10_p)).unwrap_or_default();
    let exact = tests.binomial.map(|exact| p_value(exact.p, exact.log10_p)).unwrap_or_default();
    let mut cells = vec![arm.to_owned(), what.to_owned(), format!("{k} of {n}"), share, chi, chi_p, exact];
    let intervals = tests.intervals.map(|found| [found.clopper_pearson, found.wilson, found.jeffreys]);
    match intervals {
        Some(all) => cells.extend(all.map(range)),
        None => cells.extend([const { String::new() }; 3]),
    }
    cells
}

/// A number to three digits after the point; what everybody or nobody answered lies beyond any.
fn number(value: f64) -> String {
    if value.is_finite() {
        format!("{value:.3}")
    } else if value > 0.0 {
        "beyond any".to_owned()
    } else {
        "below any".to_owned()
    }
}

fn effects(arm: &ArmReport) -> Option<Vec<String>> {
    let (effect, bayes) = (arm.tests.effect?, arm.tests.bayes?);
    let [low, high] = effect.d_prime_interval.map(number);
    let factor = |factor: crate::bayes::BayesFactor| {
        if factor.log10_bf01.abs() > 6.0 { format!("10^{:.1}", factor.log10_bf01) } else { short(factor.bf01) }
    };
    Some(vec![
        arm.arm.clone(),
        number(effect.h),
        number(effect.w),
        number(effect.g),
        number(effect.d_prime),
        format!("{low} to {high}"),
        number(effect.jod),
        factor(bayes.uniform),
        factor(bayes.above_half),
        factor(bayes.jeffreys),
    ])
}

fn equivalence(arm: &ArmReport) -> Option<Vec<String>> {
    let found = arm.equivalence?;
    let mut cells = vec![
        arm.arm.clone(),
        format!("±{} % ({:.2} JOD)", short(100.0 * found.bound.proportion), found.bound.jod),
        p_value(found.raw.p, found.raw.log10_p),
    ];
    match found.corrected {
        Some(test) => {
            let share = if test.proportion.is_nan() { "unknown".to_owned() } else { percent(test.proportion) };
            cells.extend([share, range(test.interval), p_value(test.p, test.p.log10())]);
        }
        None => cells.extend(["unknown".to_owned(), String::new(), String::new()]),
    }
    cells.push(if found.claimed { "yes" } else { "not shown" }.to_owned());
    Some(cells)
}

fn one_arm(report: &Report, arm: &ArmReport, blocks: &mut Vec<Block>) {
    blocks.push(Block::Heading(2, format!("Arm {}", arm.arm)));
    blocks
        .push(Block::Facts(arm.sentences.iter().map(|said| (said.about.to_owned(), said.sentence.clone())).collect()));
    let Some(counts) = arm.counts().filter(|counts| counts.n > 0) else { return };
    let bound = report.plan.as_ref().map(|plan| plan.bound);
    let mut figures = vec![
        plot::posterior(&arm.arm, counts, bound.map(|bound| bound.proportion)),
        plot::power_by_truth(arm.n, bound, report.alpha),
        plot::power_by_people(arm.n, arm.needed, report.alpha),
    ];
    if let Some(order) = &arm.order {
        let table = order.second_chosen;
        let level = 1.0 - report.alpha;
        let halves = [("lower quality second", table.lower_second), ("lower quality first", table.lower_first)];
        let rows: Vec<Row> = halves
            .into_iter()
            .filter(|(_, counts)| counts.n > 0)
            .map(|(label, counts)| {
                let interval = crate::interval::clopper_pearson(counts, level);
                Row { label: label.to_owned(), counts, interval, main: true }
            })
            .collect();
        let mut figure = plot::intervals(&rows, None, level, true);
        figure.caption = format!(
            "{}: how often the second interval was chosen, by order. People who see the difference differ between the rows; \
             a lean shifts both to one side.",
            arm.arm
        );
        figures.push(figure);
    }
    blocks.push(Block::Figures(figures));
}

fn between(report: &Report, blocks: &mut Vec<Block>) {
    if report.arms.is_empty() {
        return;
    }
    blocks.push(Block::Heading(2, "Between arms".to_owned()));
    let mut said: Vec<String> = report.contrasts.iter().map(|contrast| contrast.sentence.clone()).collect();
    if said.is_empty() {
        said.push("Fewer than two arms have a right answer: there is nothing to contrast.".to_owned());
    }
    said.push(report.multiplicity.sentence.clone());
    blocks.push(Block::List(said));
    if let Some(ladder) = &report.ladder {
        blocks.push(Block::Heading(2, "The ladder of qualities".to_owned()));
        blocks.push(Block::Text(ladder.sentence.clone()));
        let rows = ladder.steps.iter().map(|step| {
            let [low, high] = step.jod_interval.map(number);
            vec![
                step.quality.clone(),
                short(step.seconds),
                words::counted(step.counts),
                number(step.jod),
                format!("{low} to {high}"),
            ]
        });
        blocks.push(Block::Table(Table {
            caption: format!("How far each quality is seen below {} (Thurstone's Case V)", ladder.reference),
            columns: vec!["quality", "seconds a picture", "right answers", "JOD", "JOD interval"],
            rows: rows.collect(),
        }));
        blocks.extend(plot::ladder(ladder, 1.0 - report.alpha).map(|figure| Block::Figures(vec![figure])));
    }
}

fn people(report: &Report, blocks: &mut Vec<Block>) {
    blocks.push(Block::Heading(2, "People and exclusions".to_owned()));
    if report.provenance.logs.is_empty() {
        blocks.push(Block::Text("Counts were given, not trials: nothing could be left out.".to_owned()));
        return;
    }
    blocks.push(Block::Figures(vec![plot::flow(&report.flow)]));
    if report.exclusions.is_empty() {
        return;
    }
    let rows = report.exclusions.iter().take(ON_THE_PAGE).map(|excluded| {
        let detail = if excluded.detail.is_empty() { String::new() } else { format!(": {}", excluded.detail) };
        vec![
            excluded.session_id.clone(),
            excluded.participant.clone(),
            excluded.arm.clone(),
            format!("{}{detail}", excluded.reason.words()),
            format!("{}, line {}", excluded.file, excluded.line),
        ]
    });
    let total: u64 = report.flow.excluded.iter().map(|(_, count)| count).sum();
    let listed = report.exclusions.len().min(ON_THE_PAGE);
    let caption =
        if listed as u64 == total { "Left out".to_owned() } else { format!("Left out: the first {listed} of {total}") };
    let columns = vec!["session", "participant", "arm", "because", "where"];
    blocks.push(Block::Table(Table { caption, columns, rows: rows.collect() }));
    blocks.push(Block::Table(tests("The same tests with every answered critical trial", &report.without_exclusions)));
}

fn task(report: &Report, blocks: &mut Vec<Block>) {
    let counting = report.arms.iter().flat_map(|arm| {
        arm.counting.iter().map(|(quality, found)| {
            vec![
                arm.arm.clone(),
                quality.clone(),
                found.n.to_string(),
                format!("{:+.2}", found.mean_error),
                found.sd.map(|sd| format!("{sd:.2}")).unwrap_or_default(),
                format!("{:.2}", found.mean_distance),
                percent(found.exact_share),
            ]
        })
    });
    let counting: Vec<Vec<String>> = counting.collect();
    let confidence = report.arms.iter().flat_map(|arm| {
        arm.confidence.iter().map(|(confidence, counts)| {
            vec![arm.arm.clone(), confidence.to_string(), counts.n.to_string(), words::counted(*counts)]
        })
    });
    let confidence: Vec<Vec<String>> = confidence.collect();
    if counting.is_empty() && confidence.is_empty() {
        return;
    }
    blocks.push(Block::Heading(2, "The task".to_owned()));
    if !counting.is_empty() {
        let columns = vec![
            "arm",
            "quality",
            "pictures",
            "mean error",
            "its standard deviation",
            "mean distance",
            "counted exactly",
        ];
        let caption = "Counts of task objects less the true counts".to_owned();
        blocks.push(Block::Table(Table { caption, columns, rows: counting }));
    }
    if !confidence.is_empty() {
        let columns = vec!["arm", "confidence, 1 to 4", "people", "of them right"];
        blocks.push(Block::Table(Table {
            caption: "Right answers by confidence".to_owned(),
            columns,
            rows: confidence,
        }));
    }
}

fn shown(report: &Report, blocks: &mut Vec<Block>) {
    if !report.stimuli.is_empty() {
        blocks.push(Block::Heading(2, "What was shown".to_owned()));
        blocks.push(Block::Pictures(report.stimuli.clone()));
    }
    let Some(timing) = &report.timing else { return };
    blocks.push(Block::Heading(2, "Timing".to_owned()));
    blocks.push(Block::Facts(timing_facts(timing)));
    blocks.extend(plot::timing(timing).map(|figure| Block::Figures(vec![figure])));
}

fn timing_facts(timing: &crate::timing::Timing) -> Vec<(String, String)> {
    let mut facts = Vec::new();
    let mut fact = |name: &str, value: String| facts.push((name.to_owned(), value));
    if let Some([low, high]) = timing.duration_s {
        fact("pictures stood for", format!("{low:.4} to {high:.4} s ({} pictures)", timing.pictures));
    }
    if let Some(worst) = timing.worst_error_ms {
        // Clocks tell microseconds.
        let worst = if worst < 1e-3 { "under 0.001".to_owned() } else { short(worst) };
        fact("farthest from the planned duration", format!("{worst} ms"));
    }
    fact(
        "pictures with a missed frame",
        if timing.frames_known == 0 {
            "unknown".to_owned()
        } else {
            format!("{} of {}", timing.with_missed_frames, timing.frames_known)
        },
    );
    if let Some(longest) = timing.longest_frame_ms {
        fact("longest frame", format!("{} ms", short(longest)));
    }
    fact("trials on a verified display", format!("{} of {}", timing.verified, timing.rows));
    if let Some([low, high]) = timing.refresh_hz {
        fact("refresh rate", format!("{low:.2} to {high:.2} Hz"));
    }
    let [swaps, presented, estimated] = timing.onset_sources;
    fact(
        "onsets by trial",
        format!("{swaps} from swap returns, {presented} from presentation times, {estimated} estimated"),
    );
    facts
}

fn plan(report: &Report, blocks: &mut Vec<Block>) {
    blocks.push(Block::Heading(2, "Plan and deviations".to_owned()));
    if let Some(plan) = &report.plan {
        let rules = &plan.rules;
        let mut facts = vec![
            ("level".to_owned(), plan.alpha.to_string()),
            (
                "equivalence bound".to_owned(),
                format!("±{} of the proportion, {:.2} JOD", plan.bound.proportion, plan.bound.jod),
            ),
        ];
        let mut left_out = Vec::new();
        let mut rule = |on: bool, what: String| {
            if on {
                left_out.push(what);
            }
        };
        rule(rules.interrupted, "interrupted trials".to_owned());
        rule(rules.unverified_display, "unverified displays".to_owned());
        rule(rules.knew_task, "participants who knew the purpose".to_owned());
        if let Some(limit) = rules.onset_error_s {
            rule(true, format!("second onsets off by more than {} ms", short(1e3 * limit)));
        }
        if let Some(limit) = rules.duration_error_s {
            rule(true, format!("durations off by more than {} ms", short(1e3 * limit)));
        }
        if let Some(limit) = rules.count_error {
            rule(true, format!("counts off by more than {limit}"));
        }
        facts.push((
            "left out".to_owned(),
            if left_out.is_empty() { "nothing".to_owned() } else { left_out.join(", ") },
        ));
        let people: Vec<String> = plan.arms.iter().map(|(arm, people)| format!("{arm}: {people}")).collect();
        facts.push(("people planned".to_owned(), people.join(", ")));
        blocks.push(Block::Facts(facts));
    }
    if report.deviations.is_empty() {
        blocks.push(Block::Text(words::kept()));
    } else {
        blocks.push(Block::List(report.deviations.clone()));
    }
}
