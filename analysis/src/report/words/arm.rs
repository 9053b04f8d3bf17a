//! Sentences about one arm's numbers.

use super::{bound_words, counted, percent_level};
use crate::bayes::BayesFactors;
use crate::chi_square::ChiSquare;
use crate::equivalence::Tost;
use crate::interval::Intervals;
use crate::order::Order;
use crate::plan::Bound;
use crate::power::Reach;
use crate::proportion::Proportion;
use crate::report::numbers::{p_equals, percent, percent_range, short};
use crate::tally::OrderTable;

/// The test of 2005 as a paper would print it.
#[must_use]
pub fn chi_square(test: &ChiSquare, exact_p: f64, exact_log10_p: f64) -> String {
    format!(
        "Chi-square against equal shares, as in 2005: {} with {} degree of freedom, {}. Exact binomial test, two-sided: {}.",
        short(test.statistic),
        test.df,
        p_equals(test.p, test.log10_p),
        p_equals(exact_p, exact_log10_p)
    )
}

/// What a published chi-square leaves open.
#[must_use]
pub fn published(counts: Proportion, test: &ChiSquare) -> Option<String> {
    (counts.k * 2 != counts.n).then(|| {
        format!(
            "A chi-square of {} fits {} as well as {counts}: where only the statistic was published, the direction is an \
             assumption.",
            short(test.statistic),
            counts.complement()
        )
    })
}

/// Cautions about the chi-square test at this n.
#[must_use]
pub fn notes(n: u64, least_expected: Option<f64>, true_size: Option<f64>, alpha: f64) -> Vec<String> {
    let mut notes = Vec::new();
    if let Some(expected) = least_expected.filter(|expected| *expected < 5.0) {
        notes.push(format!(
            "With n = {n} the expected count of each answer is {expected}, under 5: the chi-square approximation is poor, \
             read the exact test."
        ));
    }
    if let Some(size) = true_size {
        notes.push(format!(
            "With n = {n} the rule \"chi-square beyond its critical value at {alpha}\" rejects in {} of experiments in which \
             everybody guesses.",
            percent(size)
        ));
    }
    notes
}

/// What the Bayes factors say. `most` is the largest that this many people can reach, at a tie, under the uniform prior.
#[must_use]
pub fn bayes(factors: &BayesFactors, most: f64) -> String {
    let all = [factors.uniform, factors.above_half, factors.jeffreys];
    let side = |bf01: f64, log10: f64| {
        if log10 >= 0.0 { times(bf01, log10) } else { times(1.0 / bf01, -log10) }
    };
    let said: Vec<String> = all.iter().map(|factor| side(factor.bf01, factor.log10_bf01)).collect();
    let for_guessing = all.iter().filter(|factor| factor.log10_bf01 >= 0.0).count();
    let priors = "under the uniform prior, the one on 50 % to 100 %, and Jeffreys'";
    let cap = format!("With this many people the first cannot exceed {} in favour of guessing.", short(most));
    match for_guessing {
        3 => format!(
            "The data are {}, {} and {} times likelier if everybody guesses than {priors}. {cap}",
            said[0], said[1], said[2]
        ),
        0 => format!(
            "The data are {}, {} and {} times less likely if everybody guesses than {priors}.",
            said[0], said[1], said[2]
        ),
        _ => {
            let values: Vec<String> = all.iter().map(|factor| factor_value(factor.bf01, factor.log10_bf01)).collect();
            format!(
                "In favour of guessing the Bayes factors are {}, {} and {} {priors}. The priors disagree on the direction, \
                 so the factor decides nothing. {cap}",
                values[0], values[1], values[2]
            )
        }
    }
}

fn times(value: f64, log10: f64) -> String {
    if log10 > 15.0 { format!("10^{log10:.1}") } else { factor_value(value, log10) }
}

fn factor_value(value: f64, log10: f64) -> String {
    if log10.abs() > 15.0 {
        format!("10^{log10:.1}")
    } else if value < 100.0 {
        format!("{value:.2}")
    } else {
        short(value)
    }
}

/// How much of the posterior lies within a bound.
#[must_use]
pub fn posterior(bound: Bound, mass: f64) -> String {
    format!(
        "After these data and from a uniform prior, the proportion of right answers lies within {} of 50 % with probability \
         {}.",
        bound_words(bound),
        percent(mass)
    )
}

/// The equivalence test at the bounds that are usual, where none was planned.
#[must_use]
pub fn usual_bounds(tests: &[Tost]) -> String {
    let list: Vec<String> = tests
        .iter()
        .map(|test| format!("±{} %: {}", short(100.0 * test.bound), p_equals(test.p, test.log10_p)))
        .collect();
    let list = list.join("; ");
    if tests.iter().any(|test| test.passes) {
        format!(
            "Exact equivalence tests at usual bounds, none of them planned ({list}): some would have passed, which after \
             the fact shows nothing."
        )
    } else {
        format!("Exact equivalence tests fail at every usual bound ({list}).")
    }
}

/// What this many people can and cannot show.
#[must_use]
pub fn reach(reach: &Reach, alpha: f64, needed: Option<u64>) -> String {
    let n = reach.n;
    let Some(least) = reach.least_significant else {
        return format!(
            "With {n} people no outcome can be significant at {alpha}: this arm can show nothing either way."
        );
    };
    let power = reach.power.iter().find(|(truth, _)| *truth == 0.75).map_or(0.0, |(_, power)| *power);
    let mut text = format!(
        "With {n} people the exact test needs {least} right answers. Were a person right with probability .75, it would \
         find that in {} of experiments",
        percent(power)
    );
    if let Some(needed) = needed {
        text += &format!("; for 90 % it takes {needed} people");
    }
    match reach.detectable {
        Some(truth) => {
            text += &format!(". It finds a probability of {truth:.3} or more in at least 80 % of experiments.")
        }
        None => text += ".",
    }
    if let Some(bound) = reach.smallest_bound {
        text += &format!(
            " The smallest bound within which {n} people can show equivalence is ±{} %.",
            short(100.0 * bound)
        );
    }
    text
}

/// What is said of a count for which neither answer is right.
#[must_use]
pub fn preference(what: &str, counts: Proportion, intervals: Option<&Intervals>) -> String {
    let Some(intervals) = intervals else { return format!("{what} was never asked about.") };
    let [low, high] = intervals.clopper_pearson;
    let side = if low > 0.5 {
        "lies above 50 %: a preference"
    } else if high < 0.5 {
        "lies below 50 %: a preference for the other"
    } else {
        "holds 50 %: a preference is not shown, nor is it ruled out"
    };
    let (level, range) = (percent_level(intervals.level), percent_range(intervals.clopper_pearson));
    format!("{what} was called the worse one by {}; the {level} interval, {range}, {side}.", counted(counts))
}

/// Sensitivity and bias by order.
#[must_use]
pub fn order(table: &OrderTable, order: Option<&Order>, fisher_p: Option<f64>) -> String {
    let first = Proportion { k: table.lower_first.n - table.lower_first.k, n: table.lower_first.n };
    let shares = format!(
        "The lower quality was told by {} when it came second and by {} when it came first",
        counted(table.lower_second),
        counted(first)
    );
    let Some(order) = order else {
        return format!("{shares}. Only one order was shown: sensitivity and lean cannot be told apart.");
    };
    let fisher = fisher_p.map(|p| format!(" (Fisher's exact test {})", p_equals(p, p.log10()))).unwrap_or_default();
    let corrected = if order.corrected { ", half an answer added to every cell because one is empty" } else { "" };
    let lean = match order.c {
        c if c < -0.005 => "towards the second interval",
        c if c > 0.005 => "towards the first interval",
        _ => "to neither interval",
    };
    format!("{shares}{fisher}: d' = {:.2}, lean c = {:.2}, {lean}{corrected}.", order.d_prime, order.c)
}

/// Right answers by the layout that was of the lower quality.
#[must_use]
pub fn layout_effect(by_layout: &[(String, Proportion)], fisher_p: Option<f64>) -> String {
    let list: Vec<String> =
        by_layout.iter().map(|(layout, counts)| format!("{layout} by {}", counted(*counts))).collect();
    let fisher = fisher_p.map(|p| format!(" (Fisher's exact test {})", p_equals(p, p.log10()))).unwrap_or_default();
    format!("By the layout that was of the lower quality, it was told in {}{fisher}.", list.join(", in "))
}

/// The obvious pair.
#[must_use]
pub fn check(counts: Proportion) -> String {
    if counts.k == counts.n {
        format!("The obvious pair was told by all {}.", counts.n)
    } else {
        format!(
            "The obvious pair was told by {}: who missed even that one cannot be expected to tell the critical pair.",
            counted(counts)
        )
    }
}

/// Trials after the critical one.
#[must_use]
pub fn informed(people: u64, mean_share: f64) -> String {
    format!(
        "After the critical trial {people} people had informed ones; the mean of their own shares of right answers is {}. \
         Trials of one person are not independent, so this is not tested.",
        percent(mean_share)
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bayes;

    const PAPER: Proportion = Proportion { k: 9, n: 16 };

    #[test]
    fn the_paper_s_test() {
        let test = ChiSquare::against_half(PAPER).unwrap();
        assert_eq!(
            chi_square(&test, 0.803_619, -0.095),
            "Chi-square against equal shares, as in 2005: 0.25 with 1 degree of freedom, p = 0.6171. Exact binomial test, \
             two-sided: p = 0.8036."
        );
        assert_eq!(
            published(PAPER, &test).unwrap(),
            "A chi-square of 0.25 fits 7 of 16 as well as 9 of 16: where only the statistic was published, the direction is \
             an assumption."
        );
        let tie = Proportion { k: 8, n: 16 };
        assert_eq!(published(tie, &ChiSquare::against_half(tie).unwrap()), None);
    }

    #[test]
    fn small_expected_counts_are_said() {
        assert!(
            notes(9, Some(4.5), None, 0.05)[0]
                .starts_with("With n = 9 the expected count of each answer is 4.5, under 5")
        );
        assert_eq!(
            notes(16, Some(8.0), Some(0.0768), 0.05),
            [
                "With n = 16 the rule \"chi-square beyond its critical value at 0.05\" rejects in 7.7 % of experiments in which \
              everybody guesses."
            ]
        );
    }

    #[test]
    fn factors_in_three_directions() {
        let say = |k, n| bayes(&BayesFactors::new(Proportion { k, n }), 3.34);
        assert_eq!(
            say(9, 16),
            "The data are 2.97, 2.16 and 4.49 times likelier if everybody guesses than under the uniform \
             prior, the one on 50 % to 100 %, and Jeffreys'. With this many people the first cannot exceed 3.34 in favour of \
             guessing."
        );
        assert_eq!(
            say(16, 16),
            "The data are 3855, 7710 and 9172 times less likely if everybody guesses than under the uniform \
             prior, the one on 50 % to 100 %, and Jeffreys'."
        );
        assert_eq!(
            say(11, 16),
            "In favour of guessing the Bayes factors are 1.13, 0.61 and 1.61 under the uniform prior, the one on 50 % to \
             100 %, and Jeffreys'. The priors disagree on the direction, so the factor decides nothing. With this many people \
             the first cannot exceed 3.34 in favour of guessing."
        );
        assert!(say(1_000_000, 1_000_000).contains("10^301024.0"), "{}", say(1_000_000, 1_000_000));
        let bound = Bound::from_proportion(0.25).unwrap();
        assert_eq!(
            posterior(bound, bayes::posterior_within(PAPER, 0.25)),
            "After these data and from a uniform prior, the proportion of right answers lies within ±25 % (1.00 JOD) of 50 % \
             with probability 95.7 %."
        );
    }

    #[test]
    fn bounds_that_nobody_planned() {
        let tests = |counts| [0.1, 0.15, 0.2, 0.25].map(|bound| Tost::new(counts, bound, 0.05).unwrap());
        assert_eq!(
            usual_bounds(&tests(PAPER)),
            "Exact equivalence tests fail at every usual bound (±10 %: p = 0.4728; ±15 %: p = 0.3119; ±20 %: p = 0.1753; \
             ±25 %: p = 0.0796)."
        );
        assert!(
            usual_bounds(&tests(Proportion { k: 50, n: 100 }))
                .ends_with("some would have passed, which after the fact shows nothing.")
        );
    }

    #[test]
    fn what_numbers_can_show() {
        let say = |n, needed| reach(&Reach::new(n, 0.05).unwrap(), 0.05, needed);
        assert_eq!(
            say(16, Some(42)),
            "With 16 people the exact test needs 13 right answers. Were a person right with probability .75, it would find \
             that in 40.5 % of experiments; for 90 % it takes 42 people. It finds a probability of 0.853 or more in at least \
             80 % of experiments. The smallest bound within which 16 people can show equivalence is ±22.14 %."
        );
        assert_eq!(
            say(4, None),
            "With 4 people no outcome can be significant at 0.05: this arm can show nothing either way."
        );
        assert!(say(6, None).contains("of experiments. It finds a probability"));
        let never = Reach { smallest_bound: None, detectable: None, ..Reach::new(6, 0.05).unwrap() };
        assert!(reach(&never, 0.05, None).ends_with("of experiments."));
    }

    #[test]
    fn preferences() {
        let say = |k, n| {
            let counts = Proportion { k, n };
            preference("The picture shown second", counts, Some(&Intervals::new(counts, 0.95)))
        };
        assert_eq!(
            say(8, 16),
            "The picture shown second was called the worse one by 8 of 16 (50.0 %); the 95 % interval, 24.7 % to 75.3 %, \
             holds 50 %: a preference is not shown, nor is it ruled out."
        );
        assert!(say(15, 16).ends_with("lies above 50 %: a preference."));
        assert!(say(1, 16).ends_with("lies below 50 %: a preference for the other."));
        assert_eq!(preference("Layout a", Proportion::default(), None), "Layout a was never asked about.");
    }

    #[test]
    fn orders_and_layouts() {
        let table =
            |x, n, y, m| OrderTable { lower_second: Proportion { k: x, n }, lower_first: Proportion { k: y, n: m } };
        let say = |table: OrderTable| order(&table, Order::new(&table).as_ref(), Some(1.0));
        assert_eq!(
            say(table(5, 8, 4, 8)),
            "The lower quality was told by 5 of 8 (62.5 %) when it came second and by 4 of 8 (50.0 %) when it came first \
             (Fisher's exact test p = 1): d' = 0.23, lean c = -0.16, towards the second interval."
        );
        assert!(say(table(3, 8, 3, 8)).ends_with("lean c = 0.32, towards the first interval."));
        assert!(say(table(6, 8, 2, 8)).ends_with("0.00, to neither interval."));
        assert!(say(table(8, 8, 4, 8)).ends_with("half an answer added to every cell because one is empty."));
        assert!(
            say(table(8, 8, 0, 0)).ends_with("Only one order was shown: sensitivity and lean cannot be told apart.")
        );
        let by_layout = [("a".to_owned(), Proportion { k: 5, n: 8 }), ("b".to_owned(), Proportion { k: 4, n: 8 })];
        assert_eq!(
            layout_effect(&by_layout, Some(1.0)),
            "By the layout that was of the lower quality, it was told in a by 5 of 8 (62.5 %), in b by 4 of 8 (50.0 %) \
             (Fisher's exact test p = 1)."
        );
    }

    #[test]
    fn what_came_after() {
        assert_eq!(check(Proportion { k: 16, n: 16 }), "The obvious pair was told by all 16.");
        assert!(
            check(Proportion { k: 14, n: 16 })
                .starts_with("The obvious pair was told by 14 of 16 (87.5 %): who missed")
        );
        assert!(informed(16, 0.7).starts_with("After the critical trial 16 people had informed ones; the mean"));
    }
}
