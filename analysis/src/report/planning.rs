//! Planning a study: how many people, and what a number of people can show.

use serde::Serialize;

use super::block::{Block, Table};
use super::numbers::percent;
use super::plot::{self, Figure};
use super::target::Target;
use super::words::planning as words;
use super::{html, markdown};
use crate::order;
use crate::plan::Bound;
use crate::power::{Question, Reach, sample_size};

/// Beyond this many people the probability that both equivalence tests pass is not enumerated.
const BOTH_LIMIT: u64 = 200;

/// What is asked.
#[derive(Clone, Debug, PartialEq)]
pub struct Request {
    /// The question.
    pub question: Question,
    /// Powers aimed at, in (0, 1).
    pub targets: Vec<f64>,
    /// Level, in (0, 1).
    pub alpha: f64,
    /// A number of people to judge.
    pub n: Option<u64>,
}

/// The answer.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Planning {
    /// The question.
    #[serde(flatten)]
    pub question: Question,
    /// Level.
    pub alpha: f64,
    /// People for each target.
    pub sizes: Vec<Target>,
    /// The exact power with the number of people given.
    pub power: Option<f64>,
    /// What the number of people given can and cannot show.
    pub reach: Option<Reach>,
    /// Exact power by number of people.
    pub curve: Vec<(u64, f64)>,
    /// In words.
    pub sentences: Vec<String>,
}

impl Planning {
    /// Answers a request.
    #[must_use]
    pub fn new(request: &Request) -> Self {
        let Request { question, alpha, .. } = *request;
        let sizes: Vec<Target> = request
            .targets
            .iter()
            .map(|&power| {
                let people = sample_size(question, power, alpha);
                let balanced = people.map(|people| people.held_from.next_multiple_of(4));
                let both_pass = balanced.filter(|n| *n <= BOTH_LIMIT).and_then(|n| match question {
                    Question::Equivalence { truth, bound } => {
                        Some(order::power_of_both(n / 2, truth, 0.0, bound, alpha))
                    }
                    Question::Superiority { .. } => None,
                });
                Target { power, people, balanced, both_pass }
            })
            .collect();
        let reach = request.n.and_then(|n| Reach::new(n, alpha));
        let largest = sizes.iter().filter_map(|target| target.balanced).chain(request.n).max().unwrap_or(100);
        let most = (largest + largest / 4).clamp(20, 4_000);
        let step = (most / 1_000).max(1);
        let curve = (1..=most).step_by(step as usize).map(|n| (n, question.power(n, alpha))).collect();
        let mut planning = Self {
            question,
            alpha,
            sizes,
            power: request.n.map(|n| question.power(n, alpha)),
            reach,
            curve,
            sentences: Vec::new(),
        };
        planning.sentences = planning.say(request.n);
        planning
    }

    fn say(&self, n: Option<u64>) -> Vec<String> {
        let mut said: Vec<String> = self.sizes.iter().map(|target| words::size(self.question, target)).collect();
        if let (Some(n), Some(power)) = (n, self.power) {
            said.push(words::power(self.question, n, power));
        }
        if let Some(reach) = &self.reach {
            said.push(super::words::reach(reach, self.alpha, None));
        }
        said
    }

    fn blocks(&self) -> Vec<Block> {
        let rows = self.sizes.iter().map(|target| {
            let number = |n: Option<u64>| n.map_or_else(|| "more than a million".to_owned(), |n| n.to_string());
            vec![
                percent(target.power),
                number(target.people.map(|people| people.first_reached)),
                number(target.people.map(|people| people.held_from)),
                number(target.balanced),
            ]
        });
        let columns = vec!["power", "first reached with", "held from", "multiple of 4"];
        vec![
            Block::Title(words::title(self.question)),
            Block::List(self.sentences.clone()),
            Block::Table(Table { caption: "People in an arm".to_owned(), columns, rows: rows.collect() }),
            Block::Figures(vec![self.figure()]),
        ]
    }

    fn figure(&self) -> Figure {
        plot::power_curve(&self.curve, &self.sizes.iter().map(|target| target.power).collect::<Vec<_>>())
    }

    /// As JSON.
    #[must_use]
    pub fn to_json(&self) -> String {
        serde_json::to_string_pretty(self).expect("numbers and words") + "\n"
    }

    /// As Markdown.
    #[must_use]
    pub fn to_markdown(&self) -> String {
        markdown::write(&self.blocks())
    }

    /// As one HTML page.
    #[must_use]
    pub fn to_html(&self) -> String {
        html::write(&self.blocks())
    }

    /// The curve: people, power.
    #[must_use]
    pub fn to_csv(&self) -> String {
        self.curve.iter().fold("people,power\n".to_owned(), |text, (n, power)| text + &format!("{n},{power}\n"))
    }
}

/// The bound of an equivalence question in both units, from either.
#[must_use]
pub fn bound_of(proportion: Option<f64>, jod: Option<f64>) -> Option<Bound> {
    match (proportion, jod) {
        (Some(proportion), _) => Bound::from_proportion(proportion),
        (None, Some(jod)) => Bound::from_proportion(stimuli::study::AnalysisPlan::proportion_of_jod(jod)),
        (None, None) => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plan(question: Question) -> Planning {
        Planning::new(&Request { question, targets: vec![0.8, 0.9], alpha: 0.05, n: Some(16) })
    }

    #[test]
    fn the_paper_s_sixteen() {
        let found = plan(Question::Superiority { truth: 0.75 });
        assert!((found.power.unwrap() - 0.405).abs() < 5e-4);
        let held: Vec<u64> = found.sizes.iter().map(|target| target.people.unwrap().held_from).collect();
        assert_eq!((held, found.sizes[1].balanced), (vec![35, 42], Some(44)));
        assert_eq!(found.curve[15].0, 16);
        assert_eq!(found.curve[15].1, found.power.unwrap());
    }

    /// The first sixteen people cannot show equivalence within a fifth: power 0, never less.
    #[test]
    fn equivalence_needs_both_tests() {
        let found = plan(Question::Equivalence { truth: 0.5, bound: 0.2 });
        assert_eq!(found.power, Some(0.0));
        assert_eq!(found.sizes[0].balanced, Some(60));
        let both = found.sizes[0].both_pass.unwrap();
        assert!(both > 0.5 && both <= 0.85, "{both}");
    }

    #[test]
    fn every_format_holds_the_answer() {
        let found = plan(Question::Superiority { truth: 0.75 });
        let json: serde_json::Value = serde_json::from_str(&found.to_json()).unwrap();
        assert_eq!((&json["question"], &json["truth"]), (&"superiority".into(), &0.75.into()));
        assert_eq!(json["sizes"][1]["people"]["held_from"], 42);
        assert!(found.to_html().contains("<h1>") && found.to_markdown().starts_with("# "));
        assert!(found.to_csv().starts_with("people,power\n1,0\n"));
    }

    #[test]
    fn bounds_in_either_unit() {
        assert!((bound_of(None, Some(1.0)).unwrap().proportion - 0.25).abs() < 1e-12);
        assert_eq!(bound_of(Some(0.25), None).unwrap().proportion, 0.25);
        assert_eq!(bound_of(None, None), None);
        assert_eq!(bound_of(Some(0.6), None), None);
    }
}
