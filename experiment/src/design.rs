//! Who sees what: arms, orders and layouts in concealed permuted blocks, all from the study's seed.
//!
//! A *slot* is the place of one participant in the plan. Its arm says which two qualities are compared; its *cell* says
//! which layout carries which quality, and which of the two comes first. An arm of two qualities on two layouts has four
//! cells, an arm of one quality two. Blocks keep the cells of an arm within one of each other at every moment
//! (permuted-block randomisation: Matts & Lachin 1988).

use std::collections::BTreeMap;

use serde::Serialize;
use stimuli::study::Arm;
use stimuli::{Sha256, Stimulus, Study};

use crate::draw::Draws;

/// The pair of one participant, in the order in which it is shown.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
pub struct Pair {
    /// Shown in the first interval.
    pub first: Stimulus,
    /// Shown in the second interval.
    pub second: Stimulus,
}

/// The place of one participant in the plan.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Slot {
    /// From 1, in the order in which slots are handed out.
    pub number: u32,
    /// The arm's name.
    pub arm: String,
    /// The critical pair.
    pub critical: Pair,
    /// The obvious pair afterwards, if the study has one.
    pub check: Option<Pair>,
}

/// The whole allocation. It is a pure function of the study, so that it need not be stored to be kept.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Plan {
    /// In the order in which they are handed out.
    pub slots: Vec<Slot>,
    seed: u64,
    study: Sha256,
}

/// How many slots of an arm have a certain pair.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct CellTotal {
    /// The arm's name.
    pub arm: String,
    /// The pair, by the stimuli's names in the manifest.
    pub first: String,
    /// See `first`.
    pub second: String,
    /// How many slots.
    pub n: u32,
}

impl Plan {
    /// Draws the plan of a study, with `times` as many participants in every arm as the study file says: 1, except for
    /// rehearsals of more participants than the study has.
    #[must_use]
    pub fn draw(study: &Study, times: u32) -> Self {
        let arms: Vec<(usize, u32)> = study.arms.iter().map(|arm| arm.n.saturating_mul(times)).enumerate().collect();
        let order = arm_order(&arms, &mut Draws::new(study.seed, "order of the arms"));
        let mut pairs: Vec<_> = arms
            .iter()
            .map(|&(i, n)| {
                let arm = &study.arms[i];
                let mut draws = Draws::new(study.seed, &format!("cells of arm {}", arm.name));
                blocks(&cells(arm, &study.critical_layouts), n, &mut draws).into_iter()
            })
            .collect();
        let total = u32::try_from(order.len()).unwrap_or(u32::MAX);
        let mut checks = study.check.as_ref().map(|check| {
            let [a, b] = check.stimuli();
            let both = [Pair { first: a.clone(), second: b.clone() }, Pair { first: b, second: a }];
            blocks(&both, total, &mut Draws::new(study.seed, "order of the check")).into_iter()
        });
        let slots = order
            .into_iter()
            .zip(1..)
            .filter_map(|(i, number)| {
                let critical = pairs[i].next()?;
                let check = checks.as_mut().and_then(Iterator::next);
                Some(Slot { number, arm: study.arms[i].name.clone(), critical, check })
            })
            .collect();
        Self { slots, seed: study.seed, study: study.hash() }
    }

    /// The slot of a number.
    #[must_use]
    pub fn slot(&self, number: u32) -> Option<&Slot> {
        self.slots.get(usize::try_from(number.checked_sub(1)?).ok()?)
    }

    /// The digest of the whole sequence, of the seed and of the study: printed before the first participant, it binds
    /// the experimenter to the plan without showing it.
    #[must_use]
    pub fn hash(&self) -> Sha256 {
        let text = serde_json::to_string(self).expect("a plan is names and numbers");
        Sha256::of(text.as_bytes())
    }

    /// How many slots each cell has, arms and cells in order of name: what may be known beforehand.
    #[must_use]
    pub fn totals(&self) -> Vec<CellTotal> {
        let mut counts = BTreeMap::new();
        for slot in &self.slots {
            *counts.entry((&slot.arm, &slot.critical)).or_insert(0) += 1;
        }
        counts
            .into_iter()
            .map(|((arm, pair), n)| CellTotal { arm: arm.clone(), first: pair.first.id(), second: pair.second.id(), n })
            .collect()
    }
}

/// The cells of an arm: each layout once first, each quality once on each layout.
fn cells(arm: &Arm, layouts: &[String; 2]) -> Vec<Pair> {
    let picture = |layout: &String, quality: &String| Stimulus { layout: layout.clone(), quality: quality.clone() };
    let mut cells = Vec::new();
    for (a, b) in [(0, 1), (1, 0)] {
        for (p, q) in [(0, 1), (1, 0)] {
            let first = picture(&layouts[a], &arm.qualities[p]);
            let cell = Pair { first, second: picture(&layouts[b], &arm.qualities[q]) };
            if !cells.contains(&cell) {
                cells.push(cell);
            }
        }
    }
    cells
}

/// `n` draws from `items`, block after block: each block has every item once, in random order; the last may be cut short.
fn blocks<T: Clone>(items: &[T], n: u32, draws: &mut Draws) -> Vec<T> {
    let n = usize::try_from(n).unwrap_or(usize::MAX);
    let mut all = Vec::with_capacity(n);
    while all.len() < n && !items.is_empty() {
        let mut block = items.to_vec();
        draws.shuffle(&mut block);
        block.truncate(n - all.len());
        all.append(&mut block);
    }
    all
}

/// The arms' indices, each as often as it has participants, in blocks that hold every arm in proportion to its size.
///
/// A block has the smallest proportional set twice (arms of equal size: each twice), so that the end of a block cannot
/// always be told from its start by somebody who has learnt the earlier ones.
fn arm_order(arms: &[(usize, u32)], draws: &mut Draws) -> Vec<usize> {
    let common = arms.iter().fold(0, |common, &(_, n)| gcd(common, n));
    let mut order = Vec::new();
    let mut left = common;
    while left > 0 {
        let sets = left.min(2);
        left -= sets;
        let mut block: Vec<usize> = arms
            .iter()
            .flat_map(|&(i, n)| std::iter::repeat_n(i, usize::try_from(n / common * sets).unwrap_or(usize::MAX)))
            .collect();
        draws.shuffle(&mut block);
        order.append(&mut block);
    }
    order
}

fn gcd(a: u32, b: u32) -> u32 {
    if b == 0 { a } else { gcd(b, a % b) }
}

#[cfg(test)]
mod tests;
