//! The case of 2005 in full, as the program prints it: 9 of 16 against 7, and 8 of 16 where no answer was right.

use std::process::Command;

use serde_json::Value;

fn run(arguments: &[&str]) -> String {
    let counts = ["--counts", "HQ/CBQ=9/16", "--counts", "HQ/HQ=8/16", "--no-right-answer", "HQ/HQ"];
    let output = Command::new(env!("CARGO_BIN_EXE_crex-report")).args(counts).args(arguments).output().unwrap();
    assert_eq!(output.status.code(), Some(0));
    String::from_utf8(output.stdout).unwrap()
}

/// The number to as many digits as the published one has.
#[track_caller]
fn is(found: &Value, published: &str) {
    let digits = published.split_once('.').map_or(0, |(_, digits)| digits.len());
    assert_eq!(format!("{:.digits$}", found.as_f64().unwrap()), published);
}

#[test]
fn every_number_of_the_paper_s_case() {
    let report: Value = serde_json::from_str(&run(&["--json"])).unwrap();
    let arm = &report["arms"][0];
    is(&arm["chi_square"]["statistic"], "0.25");
    is(&arm["chi_square"]["p"], "0.6171");
    is(&arm["chi_square_true_size"], "0.0768");
    is(&arm["binomial"]["p"], "0.8036");
    for (name, low, high) in
        [("clopper_pearson", "0.299", "0.802"), ("wilson", "0.332", "0.769"), ("jeffreys", "0.326", "0.778")]
    {
        is(&arm["intervals"][name][0], low);
        is(&arm["intervals"][name][1], high);
    }
    let effect = &arm["effect"];
    is(&effect["h"], "0.125");
    is(&effect["w"], "0.125");
    is(&effect["g"], "0.0625");
    is(&effect["d_prime"], "0.22");
    is(&effect["d_prime_interval"][0], "-0.75");
    is(&effect["d_prime_interval"][1], "1.20");
    is(&arm["bayes"]["uniform"]["bf01"], "2.97");
    is(&arm["bayes"]["above_half"]["bf01"], "2.16");
    is(&arm["bayes"]["jeffreys"]["bf01"], "4.49");
    let bounds = arm["usual_bounds"].as_array().unwrap();
    for (test, (bound, p)) in bounds.iter().zip([(0.1, "0.473"), (0.15, "0.312"), (0.2, "0.175"), (0.25, "0.0796")]) {
        assert_eq!((&test["bound"], &test["passes"]), (&bound.into(), &false.into()));
        is(&test["p"], p);
    }
    assert_eq!(bounds.len(), 4);
    let power = arm["reach"]["power"].as_array().unwrap();
    for (truth, published) in [(0.7, "0.246"), (0.75, "0.405"), (0.8, "0.598")] {
        is(&power.iter().find(|pair| pair[0] == truth).unwrap()[1], published);
    }
    assert_eq!((&arm["reach"]["least_significant"], &arm["needed"]), (&13.into(), &42.into()));
    // The scene preference: neither of two like pictures, chosen 8 times each.
    let alike = &report["arms"][1];
    assert!(alike["correct"].is_null());
    is(&alike["second_chosen"]["chi_square"]["statistic"], "0");
    is(&alike["second_chosen"]["binomial"]["p"], "1");
    assert_eq!(report["deviations"].as_array().unwrap().len(), 1);
}

#[test]
fn every_sentence_of_the_paper_s_case() {
    let said = run(&[]);
    for sentence in [
        "**HQ/CBQ** \u{2014} Undecided: 9 of 16 (56.2 %) told the lower quality, and the 95 % interval, 29.9 % to 80.2 %, holds \
         50 %. That neither shows that people notice nor that they do not. No equivalence bound was planned, so equivalence \
         cannot be claimed.",
        "Chi-square against equal shares, as in 2005: 0.25 with 1 degree of freedom, p = 0.6171. Exact binomial test, \
         two-sided: p = 0.8036.",
        "A chi-square of 0.25 fits 7 of 16 as well as 9 of 16: where only the statistic was published, the direction is an \
         assumption.",
        "rejects in 7.7 % of experiments in which everybody guesses.",
        "Exact equivalence tests fail at every usual bound (±10 %: p = 0.4728; ±15 %: p = 0.3119; ±20 %: p = 0.1753; ±25 %: \
         p = 0.0796).",
        "The data are 2.97, 2.16 and 4.49 times likelier if everybody guesses than under the uniform prior, the one on 50 % \
         to 100 %, and Jeffreys'. With this many people the first cannot exceed 3.338 in favour of guessing.",
        "With 16 people the exact test needs 13 right answers. Were a person right with probability .75, it would find that \
         in 40.5 % of experiments; for 90 % it takes 42 people.",
        "The picture shown second was called the worse one by 8 of 16 (50.0 %); the 95 % interval, 24.7 % to 75.3 %, holds \
         50 %: a preference is not shown, nor is it ruled out.",
        "Both pictures have the same quality, so no answer is right: this arm shows habits of answering, not what people see.",
    ] {
        assert!(said.contains(sentence), "{sentence}\n\nis not in\n\n{said}");
    }
}
