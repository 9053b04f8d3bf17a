//! What a study file may not say, beyond what its types hold.

use std::collections::HashSet;
use std::path::{Component, Path};

use super::locate::Step;
use super::{AnalysisPlan, Layout, Practice, Quality, Stimulus, Study, Viewing};

/// Something wrong, and where.
pub(super) struct Problem {
    pub(super) path: Vec<Step>,
    pub(super) message: String,
    pub(super) help: String,
}

#[derive(Default)]
struct Problems(Vec<Problem>);

impl Problems {
    fn add(&mut self, path: &[Step], message: impl Into<String>, help: impl Into<String>) {
        self.0.push(Problem { path: path.to_vec(), message: message.into(), help: help.into() });
    }

    fn name(&mut self, path: &[Step], name: &str) {
        let fits = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
        if name.is_empty() || !name.chars().all(fits) {
            self.add(path, format!("`{name}` is no name"), "Use letters, digits, `-` and `_`.");
        }
    }

    fn unique<'a>(&mut self, list: &'static str, key: &'static str, names: impl Iterator<Item = &'a str>) {
        let mut seen = HashSet::new();
        for (i, name) in names.enumerate() {
            if !seen.insert(name.to_lowercase()) {
                let path = [Step::Key(list), Step::Index(i), Step::Key(key)];
                self.add(&path, format!("`{name}` is here twice"), "Letter case makes no difference; rename one.");
            }
        }
    }

    /// `value` must be finite, and above `least` or, if `inclusive`, at it.
    fn number(&mut self, path: &[Step], value: f64, least: f64, inclusive: bool) {
        if !value.is_finite() || value < least || (value == least && !inclusive) {
            let word = if inclusive { "at least" } else { "more than" };
            self.add(path, format!("expected a number {word} {least}, found {value}"), "");
        }
    }

    fn inside(&mut self, path: &[Step], file: &Path) {
        let plain = |part: Component<'_>| matches!(part, Component::Normal(_) | Component::CurDir);
        if file.as_os_str().is_empty() || !file.components().all(plain) {
            let help = "Give a path that starts at the study's folder and stays in it.";
            self.add(path, format!("`{}` leaves the study's folder", file.display()), help);
        }
    }

    fn text(&mut self, path: &[Step], text: &str) {
        if text.trim().is_empty() {
            self.add(path, "this text is empty", "Write what the participant shall read.");
        }
    }
}

use Step::{Index, Key, Name};

/// Everything that is wrong with a study, in no particular order.
pub(super) fn problems(study: &Study) -> Vec<Problem> {
    let mut found = Problems::default();
    found.name(&[Key("id")], &study.id);
    display_and_timing(study, &mut found);
    check_importance(study, &mut found);
    texts(study, &mut found);
    for (i, layout) in study.layouts.iter().enumerate() {
        check_layout(study, i, layout, &mut found);
    }
    for (i, quality) in study.qualities.iter().enumerate() {
        check_quality(i, quality, &mut found);
    }
    found.unique("layouts", "id", study.layouts.iter().map(|layout| layout.id.as_str()));
    found.unique("qualities", "name", study.qualities.iter().map(|quality| quality.name.as_str()));
    found.unique("arms", "name", study.arms.iter().map(|arm| arm.name.as_str()));
    check_kinds(study, &mut found);
    check_references(study, &mut found);
    check_plan(study, &mut found);
    found.0
}

fn display_and_timing(study: &Study, found: &mut Problems) {
    let display = &study.display;
    for (key, pixels) in [("width_px", display.width_px), ("height_px", display.height_px)] {
        found.number(&[Key("display"), Key(key)], f64::from(pixels), 1.0, true);
    }
    for (key, metres) in [("width_m", display.width_m), ("distance_m", display.distance_m)] {
        found.number(&[Key("display"), Key(key)], metres, 0.0, false);
    }
    let timing = &study.timing;
    found.number(&[Key("timing"), Key("interval_s")], timing.interval_s, 0.0, false);
    for (key, seconds) in [("fixation_s", timing.fixation_s), ("gap_s", timing.gap_s)] {
        found.number(&[Key("timing"), Key(key)], seconds, 0.0, true);
    }
}

fn check_importance(study: &Study, found: &mut Problems) {
    let Some(plan) = &study.importance else { return };
    let at = |key| [Key("importance"), Key(key)];
    found.number(&at("fovea_deg"), plan.fovea_deg, 0.0, true);
    if !(0.0..=1.0).contains(&plan.saliency_weight) {
        let help = "0 is the task map alone, 1 the saliency map alone.";
        found.add(&at("saliency_weight"), "the weight lies in 0 .. 1", help);
    }
    for (i, layout) in study.layouts.iter().enumerate() {
        let Some(map) = &layout.importance else { continue };
        if study.layouts[..i].iter().any(|earlier| earlier.importance.as_ref() == Some(map)) {
            let path = [Key("layouts"), Index(i), Key("importance")];
            found.add(&path, format!("`{}` is made for another layout too", map.display()), "Rename one.");
        }
        if plan.saliency_weight < 1.0 && layout.true_counts.values().all(|&count| count == 0) {
            let message = "this layout has a task map, and nothing in it counts";
            found.add(&[Key("layouts"), Index(i)], message, "Say in `true_counts` what there is.");
        }
    }
}

fn texts(study: &Study, found: &mut Problems) {
    let wording = &study.wording;
    for (key, text) in [
        ("language", &wording.language),
        ("instructions", &wording.instructions),
        ("practice", &wording.practice),
        ("ready", &wording.ready),
        ("count_first", &wording.count_first),
        ("count_second", &wording.count_second),
        ("worse", &wording.worse),
        ("noticed", &wording.noticed),
        ("known_task", &wording.known_task),
        ("check", &wording.check),
        ("end", &wording.end),
        ("demo_notice", &wording.demo_notice),
    ] {
        found.text(&[Key("wording"), Key(key)], text);
    }
    if let Some(free) = &wording.free {
        for (key, text) in [("instructions", &free.instructions), ("practice", &free.practice), ("ready", &free.ready)]
        {
            found.text(&[Key("wording"), Key("free"), Key(key)], text);
        }
    }
    found.text(&[Key("consent"), Key("version")], &study.consent.version);
    found.text(&[Key("consent"), Key("text")], &study.consent.text);
}

fn check_layout(study: &Study, i: usize, layout: &Layout, found: &mut Problems) {
    let at = |key| [Key("layouts"), Index(i), Key(key)];
    found.name(&at("id"), &layout.id);
    if layout.scene.is_empty() {
        found.add(&at("scene"), "a layout needs at least one scene file", "As in `scene = [\"room.rad\"]`.");
    }
    for file in &layout.scene {
        found.inside(&at("scene"), file);
    }
    found.inside(&at("view"), &layout.view);
    if let Some(map) = &layout.importance {
        found.inside(&at("importance"), map);
    }
    found.number(&at("exposure"), layout.exposure, 0.0, false);
    for &channel in &layout.ambient {
        found.number(&at("ambient"), channel, 0.0, true);
    }
    for id in layout.true_counts.keys() {
        if !study.task.kinds.iter().any(|kind| &kind.id == id) {
            let path = [Key("layouts"), Index(i), Key("true_counts"), Name(id.clone())];
            let help = "Count one of the kinds of [[task.kinds]], or add this one there.";
            found.add(&path, format!("no kind of item is called `{id}`"), help);
        }
    }
}

fn check_quality(i: usize, quality: &Quality, found: &mut Problems) {
    let at = |key| [Key("qualities"), Index(i), Key(key)];
    found.name(&at("name"), &quality.name);
    found.number(&at("spp"), f64::from(quality.spp), 1.0, true);
    if !quality.thresholds.iter().all(|t| (0.0..=1.0).contains(t)) {
        found.add(&at("thresholds"), "a threshold lies in 0 .. 1", "An importance map has values from 0 to 1.");
    }
}

fn check_kinds(study: &Study, found: &mut Problems) {
    let mut seen = HashSet::new();
    for (i, kind) in study.task.kinds.iter().enumerate() {
        let path = [Key("task"), Key("kinds"), Index(i), Key("id")];
        found.name(&path, &kind.id);
        if !seen.insert(&kind.id) {
            found.add(&path, format!("`{}` is here twice", kind.id), "Rename one.");
        }
    }
}

fn check_references(study: &Study, found: &mut Problems) {
    for (i, id) in study.critical_layouts.iter().enumerate() {
        check_layout_name(study, &[Key("critical_layouts"), Index(i)], id, found);
    }
    if study.critical_layouts[0] == study.critical_layouts[1] {
        let help = "The two pictures of a pair show different layouts.";
        found.add(&[Key("critical_layouts")], "the same layout twice", help);
    }
    for (i, arm) in study.arms.iter().enumerate() {
        for (j, name) in arm.qualities.iter().enumerate() {
            check_quality_name(study, &[Key("arms"), Index(i), Key("qualities"), Index(j)], name, found);
        }
        found.number(&[Key("arms"), Index(i), Key("n")], f64::from(arm.n), 1.0, true);
        if arm.viewing == Viewing::Free && study.wording.free.is_none() {
            let help = "Add [wording.free] with instructions, practice and ready.";
            found.add(&[Key("arms"), Index(i), Key("viewing")], "there are no texts for free viewing", help);
        }
        let ranks = arm.qualities.each_ref().map(|name| study.quality(name).map(|quality| quality.rank));
        if arm.has_right_answer() && ranks[0].is_some() && ranks[0] == ranks[1] {
            let help = "Give different ranks to two qualities that are compared: else no answer is right.";
            found.add(&[Key("arms"), Index(i), Key("qualities")], "these two have the same rank", help);
        }
    }
    if study.arms.is_empty() {
        found.add(&[Key("arms")], "a study needs at least one arm", "Add an [[arms]].");
    }
    for (i, Practice { first, second }) in study.practice.iter().enumerate() {
        for (key, stimulus) in [("first", first), ("second", second)] {
            check_stimulus(study, &[Key("practice"), Index(i), Key(key)], stimulus, found);
        }
    }
    if let Some(check) = &study.check {
        check_layout_name(study, &[Key("check"), Key("layout")], &check.layout, found);
        for (j, name) in check.qualities.iter().enumerate() {
            check_quality_name(study, &[Key("check"), Key("qualities"), Index(j)], name, found);
        }
        if check.qualities[0] == check.qualities[1] {
            let help = "The check shows that a difference can be seen at all.";
            found.add(&[Key("check"), Key("qualities")], "the same quality twice", help);
        }
    }
    for stimulus in study.stimuli() {
        let modulated = study.quality(&stimulus.quality).is_some_and(|quality| quality.modulated);
        let Some(i) = study.layouts.iter().position(|layout| layout.id == stimulus.layout) else { continue };
        if modulated && study.layouts[i].importance.is_none() {
            let message = format!("quality {} is modulated and this layout has no importance map", stimulus.quality);
            found.add(&[Key("layouts"), Index(i)], message, "As in `importance = \"maps/a.png\"`.");
        }
    }
}

fn check_stimulus(study: &Study, path: &[Step], stimulus: &Stimulus, found: &mut Problems) {
    check_layout_name(study, &[path, &[Key("layout")]].concat(), &stimulus.layout, found);
    check_quality_name(study, &[path, &[Key("quality")]].concat(), &stimulus.quality, found);
}

fn check_layout_name(study: &Study, path: &[Step], id: &str, found: &mut Problems) {
    if study.layout(id).is_none() {
        let known = study.layouts.iter().map(|layout| layout.id.as_str());
        found.add(path, format!("there is no layout `{id}`"), one_of(known));
    }
}

fn check_quality_name(study: &Study, path: &[Step], name: &str, found: &mut Problems) {
    if study.quality(name).is_none() {
        let known = study.qualities.iter().map(|quality| quality.name.as_str());
        found.add(path, format!("there is no quality `{name}`"), one_of(known));
    }
}

fn one_of<'a>(names: impl Iterator<Item = &'a str>) -> String {
    format!("Use one of: {}.", names.collect::<Vec<_>>().join(", "))
}

fn check_plan(study: &Study, found: &mut Problems) {
    let (plan, limits) = (&study.analysis, &study.exclusions);
    if !(plan.alpha > 0.0 && plan.alpha < 0.5) {
        found.add(&[Key("analysis"), Key("alpha")], "alpha lies between 0 and 0.5", "Usual is 0.05.");
    }
    if !(plan.bound_proportion > 0.0 && plan.bound_proportion < 0.5) {
        let help = "It is a distance of the proportion correct from 1/2.";
        found.add(&[Key("analysis"), Key("bound_proportion")], "the bound lies between 0 and 0.5", help);
    }
    let proportion = AnalysisPlan::proportion_of_jod(plan.bound_jod);
    let apart = (proportion - plan.bound_proportion).abs();
    if apart.is_nan() || apart > 6e-4 {
        let message = format!("{} JOD is {proportion:.4}, not {}", plan.bound_jod, plan.bound_proportion);
        let help = "The two state the same bound; change one.";
        found.add(&[Key("analysis"), Key("bound_jod")], message, help);
    }
    for (key, limit) in
        [("max_onset_error_ms", limits.max_onset_error_ms), ("max_duration_error_ms", limits.max_duration_error_ms)]
    {
        found.number(&[Key("exclusions"), Key(key)], limit, 0.0, true);
    }
}

#[cfg(test)]
mod tests {
    use std::path::{Path, PathBuf};

    use super::super::Study;

    /// The shipped study, which is also the example of a right study.
    fn shipped() -> String {
        std::fs::read_to_string(PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("corridor/study.toml")).unwrap()
    }

    /// What is said about the shipped study after one replacement, which must be possible.
    fn said(from: &str, to: &str) -> String {
        let text = shipped();
        assert!(text.contains(from), "{from}");
        Study::parse(&text.replacen(from, to, 1), Path::new("study.toml")).unwrap_err().to_string()
    }

    /// The line of the shipped study on which `text` first occurs.
    fn line_of(text: &str) -> usize {
        let study = shipped();
        study[..study.find(text).unwrap()].matches('\n').count() + 1
    }

    #[test]
    fn the_shipped_study_is_right() {
        let study = Study::parse(&shipped(), Path::new("study.toml")).unwrap();
        assert!((study.display.pixels_per_degree() - 39.75).abs() < 0.005, "17 inches, 1280 x 1024, 60 cm");
        let pictures: Vec<_> = study.stimuli().iter().map(super::Stimulus::id).collect();
        assert_eq!(
            pictures[..6],
            ["a_hq", "a_cbq", "a_sel", "b_hq", "b_cbq", "b_sel"],
            "each once, critical ones first"
        );
    }

    #[test]
    fn a_mistake_is_reported_where_it_is_written() {
        for (from, to, message) in [
            ("interval_s = 6.0", "interval_s = -6.0", "more than 0, found -6"),
            ("crex = \"(TRSGMD)*\"\nspp = ", "crex = \"(TRSGMD)*\"\nspp = 0 #", "at least 1, found 0"),
            ("qualities = [\"HQ\", \"CBQ\"]", "qualities = [\"HQ\", \"SUPER\"]", "there is no quality `SUPER`"),
            ("[check]\nlayout = \"a\"", "[check]\nlayout = \"z\"", "there is no layout `z`"),
            ("view = \"corridor.vf\"", "view = \"../corridor.vf\"", "leaves the study's folder"),
            ("view = \"corridor.vf\"", "view = \"/etc/passwd\"", "leaves the study's folder"),
            ("bound_jod = 0.5", "bound_jod = 1.0", "1 JOD is 0.2500, not 0.132"),
            ("exposure = ", "exposure = nan #", "more than 0, found NaN"),
            ("demo = true", "demo = treu", "invalid"),
            ("fovea_deg = 2.0", "fovea_deg = -2.0", "at least 0, found -2"),
            ("falloff = \"mar\"", "falloff = \"linear\"", "unknown variant `linear`"),
            (
                "fovea_deg = 2.0\nfalloff",
                "fovea_deg = 2.0\nsaliency_weight = 2.0\nfalloff",
                "the weight lies in 0 .. 1",
            ),
            ("importance = \"maps/b.png\"", "importance = \"maps/a.png\"", "made for another layout too"),
            ("seed = 2005", "sede = 2005", "unknown field `sede`"),
        ] {
            let said = said(from, to);
            assert!(said.contains(message), "{to}: {said}");
            let offset = from.matches('\n').count();
            assert!(said.contains(&format!("study.toml:{}:", line_of(from) + offset)), "{to}: {said}");
        }
    }

    #[test]
    fn every_mistake_is_reported_at_once() {
        let text = shipped().replacen("seed = 2005", "seed = 2005 ", 1);
        let text = text.replace("interval_s = 6.0", "interval_s = 0").replace("gap_s = 1.0", "gap_s = -1");
        let said = Study::parse(&text, Path::new("s")).unwrap_err().to_string();
        assert_eq!(said.lines().filter(|line| line.starts_with("s:")).count(), 2, "{said}");
    }

    #[test]
    fn names_that_differ_by_case_alone_would_share_a_picture() {
        assert!(said("name = \"CBQ\"", "name = \"hq\"").contains("here twice"));
    }

    #[test]
    fn a_modulated_quality_needs_a_map() {
        assert!(said("importance = \"maps/a.png\"\n", "").contains("no importance map"));
    }
}
