//! Sentences about several arms.

use super::percent_level;
use crate::contrast::Contrast;
use crate::report::numbers::{p_equals, percent};

/// The contrast of two arms.
#[must_use]
pub fn contrast(first: &str, second: &str, contrast: &Contrast, level: f64) -> String {
    let [low, high] = contrast.newcombe;
    let interval = format!(
        "{} ({} interval {} to {})",
        signed(contrast.difference),
        percent_level(level),
        signed(low),
        signed(high)
    );
    let tests: Vec<String> = [("Fisher", contrast.fisher_p), ("Barnard", contrast.barnard_p)]
        .into_iter()
        .filter_map(|(name, p)| p.map(|p| format!("{name} {}", p_equals(p, p.log10()))))
        .collect();
    let tests = if tests.is_empty() { "too many people for the exact tests".to_owned() } else { tests.join(", ") };
    if low > 0.0 {
        format!("The lower quality was told more often in {first} than in {second}: difference {interval}; {tests}.")
    } else if high < 0.0 {
        format!("The lower quality was told less often in {first} than in {second}: difference {interval}; {tests}.")
    } else {
        format!(
            "Undecided between {first} and {second}: the difference, {interval}, may go either way; {tests}. \
             Whether one arm's own test rejects and the other's does not says nothing about this."
        )
    }
}

fn signed(share: f64) -> String {
    let text = percent(share.abs());
    if share < 0.0 { format!("-{text}") } else { format!("+{text}") }
}

/// What having several tests means. `adjusted` are the arms of the primary tests with their Holm-adjusted p values.
#[must_use]
pub fn multiplicity(adjusted: &[(String, f64)], alpha: f64) -> String {
    let rest = "Every other p value describes and is not adjusted.";
    match adjusted {
        [] => format!("There is no primary test: no arm has a right answer. {rest}"),
        [(arm, _)] => format!("There is one primary test, the exact test of {arm}; it needs no adjustment. {rest}"),
        several => {
            let list: Vec<String> =
                several.iter().map(|(arm, p)| format!("{arm} {}", p_equals(*p, p.log10()))).collect();
            format!(
                "There are {} primary tests, the exact test of each arm with a right answer. Each verdict is about its own \
                 arm at {alpha}: if everybody guesses, the chance that at least one arm is wrongly said to notice is up to \
                 {}. Holm-adjusted p values keep it at {alpha}: {}. {rest}",
                several.len(),
                percent((alpha * several.len() as f64).min(1.0)),
                list.join(", ")
            )
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::proportion::Proportion;

    fn say(a: u64, b: u64, n: u64) -> String {
        let found = Contrast::new(Proportion { k: a, n }, Proportion { k: b, n }, 0.95).unwrap();
        contrast("free", "task", &found, 0.95)
    }

    #[test]
    fn three_directions() {
        assert_eq!(
            say(9, 8, 16),
            "Undecided between free and task: the difference, +6.2 % (95 % interval -25.6 % to +36.4 %), may go either way; \
             Fisher p = 1, Barnard p = 0.8601. Whether one arm's own test rejects and the other's does not says nothing \
             about this."
        );
        assert!(
            say(16, 8, 16)
                .starts_with("The lower quality was told more often in free than in task: difference +50.0 %")
        );
        assert!(
            say(0, 8, 16).starts_with("The lower quality was told less often in free than in task: difference -50.0 %")
        );
        assert!(say(900_000_000, 100_000_000, 1_000_000_000).ends_with("too many people for the exact tests."));
    }

    #[test]
    fn how_many_tests() {
        assert!(multiplicity(&[], 0.05).starts_with("There is no primary test: no arm has a right answer."));
        let one = [("HQ/CBQ".to_owned(), 0.8036)];
        assert!(
            multiplicity(&one, 0.05).starts_with("There is one primary test, the exact test of HQ/CBQ; it needs no")
        );
        let two = [("free".to_owned(), 0.02), ("task".to_owned(), 0.9)];
        assert_eq!(
            multiplicity(&two, 0.05),
            "There are 2 primary tests, the exact test of each arm with a right answer. Each verdict is about its own arm at \
             0.05: if everybody guesses, the chance that at least one arm is wrongly said to notice is up to 10.0 %. \
             Holm-adjusted p values keep it at 0.05: free p = 0.0200, task p = 0.9000. Every other p value describes and is \
             not adjusted."
        );
    }
}
