//! Sentences about a ladder of qualities.

use super::percent_level;
use crate::psychometric::Fit;
use crate::report::numbers::{p_equals, short};

/// What a ladder shows: `main` is the fit that is reported, `all` those of every family.
#[must_use]
pub fn ladder(main: &Fit, all: &[Fit], steps: usize, level: f64) -> String {
    let seconds = |x: f64| short(10.0_f64.powf(-x));
    let [low, high] = main.threshold_interval;
    let dispersion = main.dispersion.map(|value| format!(", dispersion {}", short(value))).unwrap_or_default();
    let fits = match main.p {
        None => "Three steps cannot show whether the curve fits.".to_owned(),
        Some(p) if p < 1.0 - level => format!(
            "The curve does not fit the steps (deviance {}, {}{dispersion}): the threshold is not to be trusted.",
            short(main.deviance),
            p_equals(p, p.log10())
        ),
        Some(p) => format!(
            "That the steps depart from the curve by more than chance is not shown, nor ruled out ({}{dispersion}).",
            p_equals(p, p.log10())
        ),
    };
    let range = format!("{} interval {} to {} s", percent_level(level), seconds(high), seconds(low));
    if !main.bracketed {
        return format!(
            "The ladder of {steps} steps does not bracket the time from which people begin to notice ({range}): its steps \
             are all too easy, all too hard, or too few people saw them. {fits}"
        );
    }
    let others: Vec<String> = all.iter().skip(1).map(|fit| format!("{} s", seconds(fit.curve.threshold))).collect();
    format!(
        "On this ladder of {steps} steps people begin to notice below {} s of rendering ({range}; by the logistic and the \
         Weibull function {}): there they are right halfway between guessing and their best. {fits}",
        seconds(main.curve.threshold),
        others.join(" and ")
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::psychometric::{Curve, Family};

    fn fit(bracketed: bool, p: Option<f64>) -> Fit {
        let curve = Curve { family: Family::Gaussian, threshold: 0.0, width: 1.0, lapse: 0.0 };
        Fit {
            curve,
            threshold_interval: [-1.0, 1.0],
            bracketed,
            deviance: 9.0,
            df: p.map(|_| 2),
            dispersion: p.map(|_| 1.5),
            p,
        }
    }

    #[test]
    fn every_outcome_has_its_sentence() {
        let say = |fit: Fit| ladder(&fit, &[fit, fit, fit], 5, 0.95);
        assert_eq!(
            say(fit(true, Some(0.4))),
            "On this ladder of 5 steps people begin to notice below 1 s of rendering (95 % interval 0.1 to 10 s; by the \
             logistic and the Weibull function 1 s and 1 s): there they are right halfway between guessing and \
             their best. That the steps depart from the curve by more than chance is not shown, nor ruled out (p = 0.4000, \
             dispersion 1.5)."
        );
        assert!(say(fit(true, None)).ends_with("Three steps cannot show whether the curve fits."));
        assert!(
            say(fit(true, Some(0.01)))
                .ends_with("(deviance 9, p = 0.0100, dispersion 1.5): the threshold is not to be trusted.")
        );
        assert!(say(fit(false, None)).starts_with("The ladder of 5 steps does not bracket the time"));
    }
}
