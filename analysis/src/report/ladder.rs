//! Several qualities against the same reference: the time on a picture below which people begin to notice, and how far
//! below the reference each quality is seen to be.
//!
//! With every quality compared with one reference and not with the others, the maximum-likelihood scale of Thurstone's
//! Case V has a closed form: each quality's own z(p), here in JOD.

use serde::Serialize;

use super::arm::ArmReport;
use super::words;
use crate::pictures::Picture;
use crate::proportion::Proportion;
use crate::psychometric::{Family, Fit, Level, fit};
use crate::special::normal;

/// One step of a ladder.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Step {
    /// The arm.
    pub arm: String,
    /// Its lower quality.
    pub quality: String,
    /// Mean time that making a picture of that quality took, seconds.
    pub seconds: f64,
    /// Right answers.
    pub counts: Proportion,
    /// How far the quality is seen below the reference, JOD; infinite where everybody or nobody was right.
    pub jod: f64,
    /// The same at the ends of the Clopper-Pearson interval.
    pub jod_interval: [f64; 2],
}

/// A ladder with its fitted curves.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Ladder {
    /// The quality that all were shown beside.
    pub reference: String,
    /// The steps, cheapest first.
    pub steps: Vec<Step>,
    /// The fits of all families; their x is minus the logarithm to the base 10 of the seconds.
    pub fits: Vec<Fit>,
    /// What they say, by the cumulative Gaussian.
    pub sentence: String,
}

impl Ladder {
    /// The ladder that arms make whose lower qualities have known, different costs and were shown beside the same
    /// reference; none with fewer than three.
    #[must_use]
    pub fn new(arms: &[ArmReport], pictures: &[Picture], alpha: f64) -> Option<Self> {
        let mut references = arms.iter().filter_map(|arm| arm.reference.as_ref());
        let reference = references.next()?.clone();
        if references.any(|other| *other != reference) {
            return None;
        }
        let mut steps: Vec<Step> = arms.iter().filter_map(|arm| step(arm, pictures)).collect();
        steps.sort_by(|a, b| a.seconds.total_cmp(&b.seconds));
        let levels: Vec<Level> =
            steps.iter().map(|step| Level { x: -step.seconds.log10(), counts: step.counts }).collect();
        let fits: Vec<Fit> = Family::ALL.iter().filter_map(|family| fit(&levels, *family, 1.0 - alpha)).collect();
        let sentence = words::ladder(fits.first()?, &fits, steps.len(), 1.0 - alpha);
        Some(Self { reference, steps, fits, sentence })
    }
}

fn step(arm: &ArmReport, pictures: &[Picture]) -> Option<Step> {
    let quality = arm.lower_quality.clone()?;
    let costs: Vec<f64> = pictures
        .iter()
        .filter(|picture| picture.quality == quality)
        .filter_map(|picture| picture.cost.map(|(seconds, _)| seconds))
        .collect();
    let seconds = costs.iter().sum::<f64>() / costs.len() as f64;
    let counts = arm.counts().filter(|counts| counts.n > 0)?;
    let effect = arm.tests.effect.as_ref()?;
    // One JOD is a d' of sqrt 2 z(3/4).
    let jod_interval = effect.d_prime_interval.map(|d| d / (std::f64::consts::SQRT_2 * normal::quantile(0.75)));
    (seconds > 0.0).then_some(Step { arm: arm.arm.clone(), quality, seconds, counts, jod: effect.jod, jod_interval })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tally::ArmTally;

    fn arm(quality: &str, k: u64) -> ArmReport {
        beside("HQ", quality, k)
    }

    fn beside(reference: &str, quality: &str, k: u64) -> ArmReport {
        let tally = ArmTally {
            lower_quality: Some(quality.to_owned()),
            reference: Some(reference.to_owned()),
            ..ArmTally::of_correct(Proportion { k, n: 100 })
        };
        ArmReport::new(&format!("HQ/{quality}"), &tally, 0.05, None, false)
    }

    fn picture(quality: &str, seconds: f64) -> Picture {
        Picture {
            id: format!("a_{quality}"),
            layout: "a".to_owned(),
            quality: quality.to_owned(),
            crex: "T*".to_owned(),
            rays: Vec::new(),
            cost: Some((seconds, 2)),
            sha256: String::new(),
            thumbnail: None,
        }
    }

    #[test]
    fn the_threshold_is_a_time() {
        let arms = [arm("Q1", 98), arm("Q2", 90), arm("Q3", 75), arm("Q4", 60), arm("Q5", 51)];
        let pictures: Vec<Picture> = (1..=5).map(|i| picture(&format!("Q{i}"), 10.0_f64.powi(i - 3))).collect();
        let ladder = Ladder::new(&arms, &pictures, 0.05).unwrap();
        assert_eq!(ladder.steps[0].quality, "Q1");
        let seconds = 10.0_f64.powf(-ladder.fits[0].curve.threshold);
        assert!((0.5..2.0).contains(&seconds), "{seconds}");
        assert!(ladder.sentence.contains("begin to notice below"), "{}", ladder.sentence);
        // Told by 75 of 100: one JOD, by its definition.
        let step = &ladder.steps[2];
        assert_eq!((step.quality.as_str(), ladder.reference.as_str()), ("Q3", "HQ"));
        assert!((step.jod - 1.0).abs() < 1e-14 && step.jod_interval[0] < 1.0 && 1.0 < step.jod_interval[1]);
        assert!(ladder.steps.windows(2).all(|pair| pair[0].jod > pair[1].jod));
    }

    #[test]
    fn two_qualities_or_unknown_costs_are_no_ladder() {
        let arms = [arm("Q1", 98), arm("Q2", 75), arm("Q3", 51)];
        assert_eq!(Ladder::new(&arms, &[], 0.05), None);
        assert_eq!(Ladder::new(&arms[..2], &[picture("Q1", 1.0), picture("Q2", 2.0)], 0.05), None);
    }

    #[test]
    fn qualities_beside_different_references_are_no_ladder() {
        let pictures = [picture("Q1", 1.0), picture("Q2", 2.0), picture("Q3", 4.0)];
        let arms = [arm("Q1", 98), arm("Q2", 75), arm("Q3", 51)];
        assert!(Ladder::new(&arms, &pictures, 0.05).is_some());
        let arms = [arm("Q1", 98), arm("Q2", 75), beside("Q1", "Q3", 51)];
        assert_eq!(Ladder::new(&arms, &pictures, 0.05), None);
    }
}
