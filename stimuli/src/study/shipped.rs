//! The shipped studies say of their scenes what is true.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use super::{Layout, Study, Viewing};

fn corridor() -> Study {
    Study::load(&PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("corridor")).unwrap()
}

/// The pre-studies show pictures of the main study and nothing else, count or do not count as they say, and hand out the
/// cells of order and layout evenly.
#[test]
fn the_pre_studies_show_the_main_studys_pictures() {
    let main = corridor();
    for (file, viewing) in [("free_viewing.toml", Viewing::Free), ("six_seconds.toml", Viewing::Task)] {
        let study = Study::load(&main.folder.join(file)).unwrap();
        assert_ne!((&study.id, study.seed), (&main.id, main.seed));
        let known = main.stimuli();
        for stimulus in study.stimuli() {
            assert!(known.contains(&stimulus), "{file} shows {}", stimulus.id());
            assert_eq!(study.request(&stimulus), main.request(&stimulus));
        }
        assert!(study.arms.iter().all(|arm| arm.viewing == viewing && arm.n % 4 == 0), "{file}");
        assert_eq!((&study.timing, &study.display), (&main.timing, &main.display));
    }
}

/// Until the critical answer nothing that a participant reads mentions quality or rendering; of free viewing it does not
/// mention counting either.
#[test]
fn nothing_gives_the_purpose_away() {
    let folder = corridor().folder;
    for file in ["study.toml", "free_viewing.toml", "six_seconds.toml"] {
        let study = Study::load(&folder.join(file)).unwrap();
        for arm in &study.arms {
            let mut texts = study.wording.before_trials(arm.viewing).to_vec();
            texts.extend([study.consent.text.as_str(), &study.wording.count_first, &study.wording.count_second]);
            texts.push(&study.wording.demo_notice);
            for text in texts {
                let lower = text.to_lowercase();
                assert!(!["quality", "render", "computer"].iter().any(|word| lower.contains(word)), "{file}: {text}");
            }
        }
    }
    let free = Study::load(&folder.join("free_viewing.toml")).unwrap();
    assert!(!free.consent.text.contains("count"));
}

/// The names that a scene file gives to the items it places: `!xform -n NAME ... items/FILE.rad`.
fn placed(file: &Path) -> Vec<String> {
    let text = std::fs::read_to_string(file).unwrap();
    let items = text.lines().filter(|line| line.starts_with("!xform") && line.contains(" items/"));
    items.map(|line| line.split_whitespace().skip_while(|&word| word != "-n").nth(1).unwrap().to_owned()).collect()
}

/// The names of all items of a layout, each `kind.number`.
fn items(study: &Study, layout: &Layout) -> Vec<String> {
    layout.scene.iter().flat_map(|file| placed(&study.folder.join(file))).collect()
}

#[test]
fn true_counts_are_those_of_the_scenes() {
    let study = corridor();
    for layout in &study.layouts {
        let mut counts: BTreeMap<String, u32> = BTreeMap::new();
        for name in items(&study, layout) {
            let (kind, number) = name.split_once('.').unwrap();
            if let Some(kind) = study.task.kinds.iter().find(|known| known.objects == kind) {
                *counts.entry(kind.id.clone()).or_default() += 1;
                assert_eq!(number, counts[&kind.id].to_string(), "items are numbered from 1: {name}");
            } else {
                assert!(study.task.distractors.iter().any(|known| known == kind), "{name} is no known item");
            }
        }
        assert_eq!(counts, layout.true_counts, "layout {}", layout.id);
        assert_eq!(counts.values().sum::<u32>(), study.true_count(&layout.id).unwrap());
    }
}

#[test]
fn the_critical_layouts_show_every_kind_and_distractors_at_different_places() {
    let study = corridor();
    let [a, b] = study.critical_layouts.each_ref().map(|id| study.layout(id).unwrap());
    for layout in [a, b] {
        for kind in &study.task.kinds {
            assert!(
                layout.true_counts.get(&kind.id).is_some_and(|&n| n > 0),
                "layout {} has no {}",
                layout.id,
                kind.label
            );
        }
        let distractors = items(&study, layout).len() as u32 - study.true_count(&layout.id).unwrap();
        assert!(distractors >= 8, "{distractors}");
    }
    let lines = |layout: &Layout| -> Vec<String> {
        let text = std::fs::read_to_string(study.folder.join(layout.scene.last().unwrap())).unwrap();
        text.lines().filter(|line| line.contains(" items/")).map(str::to_owned).collect()
    };
    let (a, b) = (lines(a), lines(b));
    assert!(a.iter().all(|line| !b.contains(line)), "an item stands at the same place in both layouts");
}
