use proptest::prelude::*;

use super::*;
use crate::example;

#[test]
fn the_papers_two_arms_have_four_cells_and_two() {
    let plan = Plan::draw(&example::study(16), 1);
    let totals = plan.totals();
    assert_eq!(plan.slots.len(), 32);
    let of = |arm: &str| totals.iter().filter(|cell| cell.arm == arm).map(|cell| cell.n).collect::<Vec<_>>();
    assert_eq!(of("HQ/CBQ"), [4, 4, 4, 4]);
    assert_eq!(of("HQ/HQ"), [8, 8]);
}

#[test]
fn no_pair_shows_one_layout_twice_and_every_pair_has_its_arms_qualities() {
    let study = example::study(8);
    for slot in Plan::draw(&study, 1).slots {
        let Pair { first, second } = &slot.critical;
        assert_ne!(first.layout, second.layout);
        let arm = study.arms.iter().find(|arm| arm.name == slot.arm).unwrap();
        let mut shown = [first.quality.clone(), second.quality.clone()];
        let mut asked = arm.qualities.clone();
        shown.sort();
        asked.sort();
        assert_eq!(shown, asked);
    }
}

#[test]
fn the_hash_binds_the_seed_and_the_study() {
    let study = example::study(16);
    let plan = Plan::draw(&study, 1);
    assert_eq!(plan.hash(), Plan::draw(&study, 1).hash());
    let other_seed = Study { seed: study.seed + 1, ..study.clone() };
    assert_ne!(plan.hash(), Plan::draw(&other_seed, 1).hash());
    assert_ne!(plan.slots, Plan::draw(&other_seed, 1).slots);
    let other_title = Study { title: "another".to_owned(), ..study };
    assert_ne!(plan.hash(), Plan::draw(&other_title, 1).hash());
}

#[test]
fn slots_are_found_by_their_number() {
    let plan = Plan::draw(&example::study(4), 1);
    assert_eq!(plan.slot(0), None);
    assert_eq!(plan.slot(1).unwrap().number, 1);
    assert_eq!(plan.slot(8).unwrap().number, 8);
    assert_eq!(plan.slot(9), None);
}

proptest! {
    /// Whatever the seed and wherever one stops: the cells of an arm differ by at most one, and so does what each arm has
    /// of its share, within a block.
    #[test]
    fn balance_holds_at_every_moment(seed: u64, n in 1_u32..40) {
        let study = Study { seed, ..example::study(n) };
        let plan = Plan::draw(&study, 1);
        prop_assert_eq!(plan.slots.len(), 2 * n as usize);
        let cells: BTreeMap<_, _> = study.arms.iter().map(|a| (a.name.clone(), cells(a, &study.critical_layouts))).collect();
        for stop in 0..=plan.slots.len() {
            let mut arms = BTreeMap::new();
            for slot in &plan.slots[..stop] {
                let pairs: &mut BTreeMap<Pair, u32> = arms.entry(slot.arm.clone()).or_default();
                *pairs.entry(slot.critical.clone()).or_insert(0) += 1;
            }
            for (arm, pairs) in &arms {
                let counts = cells[arm].iter().map(|cell| pairs.get(cell).copied().unwrap_or(0));
                prop_assert!(counts.clone().max().unwrap() - counts.min().unwrap() <= 1);
            }
            let sizes = study.arms.iter().map(|a| arms.get(&a.name).map_or(0, |pairs| pairs.values().sum::<u32>()));
            prop_assert!(sizes.clone().max().unwrap() - sizes.min().unwrap() <= 2);
        }
    }

    /// Arms of different sizes get exactly their numbers.
    #[test]
    fn unequal_arms_are_filled(seed: u64, a in 1_u32..30, b in 1_u32..30) {
        let mut study = Study { seed, ..example::study(1) };
        study.arms[0].n = a;
        study.arms[1].n = b;
        let plan = Plan::draw(&study, 1);
        for arm in &study.arms {
            let n = plan.slots.iter().filter(|slot| slot.arm == arm.name).count();
            prop_assert_eq!(n, arm.n as usize);
        }
    }
}
