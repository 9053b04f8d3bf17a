//! What the experimenter states before a session: the participant's code, the geometry, the conditions.
//!
//! A field left empty is recorded as not measured: nothing here has a default that looks like a measurement.

use std::collections::BTreeMap;

use stimuli::Study;

use crate::participant::check_code;

/// A condition that may be stated, and how it is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Condition {
    /// Its name in the journal, unit included.
    pub name: &'static str,
    /// The question.
    pub label: &'static str,
    /// Whether the answer is a number.
    pub number: bool,
    /// What an empty field means, in words.
    pub if_empty: &'static str,
}

const fn number(name: &'static str, label: &'static str) -> Condition {
    Condition { name, label, number: true, if_empty: "not measured" }
}

const fn words(name: &'static str, label: &'static str) -> Condition {
    Condition { name, label, number: false, if_empty: "not measured" }
}

/// Everything that is asked besides the code and the confirmation; the first two give the pixels per degree.
pub const CONDITIONS: [Condition; 10] = [
    number("picture_width_mm", "Width of the picture on the display, mm"),
    number("distance_mm", "From the eye to the display, mm"),
    number("white_cd_m2", "Luminance of white, cd/m2"),
    number("black_cd_m2", "Luminance of black, cd/m2"),
    number("ambient_lx", "Light in the room, lx"),
    words("gamma", "Gamma, or how the display was calibrated"),
    words("acuity", "Visual acuity, and how it was tested"),
    words("colour_vision", "Colour vision, and how it was tested"),
    Condition { if_empty: "not given", ..number("age_years", "Age, years (optional)") },
    Condition { if_empty: "not given", ..words("gender", "Gender (optional)") },
];

/// How far the pixels per degree may be from the study's, as a share of it.
pub const GEOMETRY_TOLERANCE: f64 = 0.05;

/// The set-up screen's content.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Form {
    /// The participant's code.
    pub code: String,
    /// The answers to [`CONDITIONS`], in their order; empty is not measured.
    pub answers: [String; CONDITIONS.len()],
    /// Night light, HDR and colour management are off.
    pub neutral: bool,
}

/// What was stated, as it goes into the journal: a number or words each, or nothing where it was not measured.
pub type Conditions = BTreeMap<String, Option<String>>;

impl Form {
    /// Every condition as not measured: a program states nothing.
    #[must_use]
    pub fn nothing_stated() -> Conditions {
        CONDITIONS.iter().map(|condition| (condition.name.to_owned(), None)).collect()
    }

    /// The pixels per degree of what was typed: none while width or distance is not a number above 0.
    #[must_use]
    pub fn pixels_per_degree(&self, study: &Study) -> Option<f64> {
        let metres = |index: usize| parse(&self.answers[index]).map(|mm| mm * 1e-3).filter(|&metres| metres > 0.0);
        let mut display = study.display.clone();
        (display.width_m, display.distance_m) = (metres(0)?, metres(1)?);
        Some(display.pixels_per_degree())
    }

    /// What the typed geometry amounts to, in a sentence.
    #[must_use]
    pub fn advice(&self, study: &Study) -> String {
        let wanted = study.display.pixels_per_degree();
        let width_m = parse(&self.answers[0]).map(|mm| mm * 1e-3).filter(|&metres| metres > 0.0);
        let Some(width_m) = width_m else {
            return format!("The study is made for {wanted:.2} pixels per degree. Without a width: not measured.");
        };
        let distance_mm = study.display.distance_for_width_m(width_m) * 1e3;
        let found = self.pixels_per_degree(study).map_or("not measured".to_owned(), |found| format!("{found:.2}"));
        format!("Pixels per degree: {found}. The study's {wanted:.2} are at {distance_mm:.0} mm.")
    }

    /// The conditions, if the form can be left.
    ///
    /// # Errors
    /// What must be changed first, in a sentence.
    pub fn finish(&self, study: &Study) -> Result<Conditions, String> {
        check_code(&self.code).map_err(|error| error.to_string())?;
        let mut conditions = Conditions::new();
        for (condition, answer) in CONDITIONS.iter().zip(&self.answers) {
            let answer = answer.trim();
            if condition.number && !answer.is_empty() && parse(answer).is_none_or(|value| value < 0.0) {
                return Err(format!("{}: `{answer}` is not a number of 0 or more", condition.label));
            }
            conditions.insert(condition.name.to_owned(), (!answer.is_empty()).then(|| answer.to_owned()));
        }
        if let Some(found) = self.pixels_per_degree(study) {
            let wanted = study.display.pixels_per_degree();
            if (found / wanted - 1.0).abs() > GEOMETRY_TOLERANCE {
                return Err(format!(
                    "{found:.2} pixels per degree are more than 5 % off the study's {wanted:.2}. {}",
                    self.advice(study)
                ));
            }
            conditions.insert("pixels_per_degree".to_owned(), Some(format!("{found:.3}")));
        } else {
            conditions.insert("pixels_per_degree".to_owned(), None);
        }
        if !self.neutral {
            return Err("Confirm that night light, HDR and colour management are off.".to_owned());
        }
        conditions.insert("colours_unaltered".to_owned(), Some("confirmed".to_owned()));
        Ok(conditions)
    }
}

fn parse(text: &str) -> Option<f64> {
    text.trim().replace(',', ".").parse().ok().filter(|value: &f64| value.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::example;

    fn paper() -> (Study, Form) {
        let mut study = example::study(4);
        (study.display.width_px, study.display.width_m, study.display.distance_m) = (1280, 0.3372, 0.6);
        let mut form = Form { code: "P01".to_owned(), neutral: true, ..Form::default() };
        form.answers[0] = "337,2".to_owned();
        form.answers[1] = "600".to_owned();
        (study, form)
    }

    /// 17 inches, 1280 x 1024, at 60 cm: 39.75 pixels per degree.
    #[test]
    fn the_papers_display_has_39_75_pixels_per_degree() {
        let (study, form) = paper();
        assert!((form.pixels_per_degree(&study).unwrap() - 39.75).abs() < 0.01);
        let conditions = form.finish(&study).unwrap();
        assert!(conditions["pixels_per_degree"].as_deref().unwrap().starts_with("39.75"));
        assert_eq!(conditions["ambient_lx"], None, "not measured is not a number");
    }

    #[test]
    fn a_display_that_is_too_near_or_too_far_is_refused_with_the_right_distance() {
        let (study, mut form) = paper();
        form.answers[1] = "640".to_owned();
        let why = form.finish(&study).unwrap_err();
        assert!(why.contains("5 %") && why.contains("600 mm"), "{why}");
        form.answers[1] = "620".to_owned();
        assert!(form.finish(&study).is_ok());
        form.answers[1] = String::new();
        assert_eq!(form.finish(&study).unwrap()["pixels_per_degree"], None);
    }

    #[test]
    fn nonsense_is_named() {
        let (study, form) = paper();
        let mut wrong = form.clone();
        wrong.answers[4] = "dim".to_owned();
        assert!(wrong.finish(&study).unwrap_err().contains("Light in the room"));
        let unconfirmed = Form { neutral: false, ..form.clone() };
        assert!(unconfirmed.finish(&study).unwrap_err().contains("night light"));
        let nameless = Form { code: String::new(), ..form };
        assert!(nameless.finish(&study).unwrap_err().contains("code"));
    }
}
