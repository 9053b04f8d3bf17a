//! `crex importance` from outside.

#![allow(clippy::unwrap_used, reason = "a test that cannot start has failed")]

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use renderer::importance::fovea::{Falloff, Fovea};
use renderer::picture::grey;

/// A lamp behind the eye, a wall, and two balls before it that differ in name and colour.
const SCENE: &str = "void light lamp_light 0 0 3 40 40 40
void plastic wall_paint 0 0 5 .5 .5 .5 0 0
void plastic red 0 0 5 .7 .05 .05 0 0
lamp_light sphere lamp 0 0 4 0 -2 3 .3
wall_paint polygon wall 0 0 12  -9 4 -9  9 4 -9  9 4 9  -9 4 9
red sphere ball.1 0 0 4  -1 3.5 0 .1
wall_paint sphere ball.2 0 0 4  1 3.5 0 .1
";
const VIEW: [&str; 8] = ["-vp", "0", "0", "0", "-vh", "60", "-vv", "60"];

struct Folder(tempfile::TempDir);

impl Folder {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("scene.rad"), SCENE).unwrap();
        Self(folder)
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn crex(&self, words: &[&str]) -> Output {
        let mut command = Command::new(env!("CARGO_BIN_EXE_crex"));
        command.current_dir(self.0.path()).args(words).stdin(Stdio::null()).output().unwrap()
    }

    fn importance(&self, words: &[&str]) -> Output {
        let view = ["importance", "scene.rad", "-x", "60", "-y", "60"];
        self.crex(&[&view[..], &VIEW[..], words].concat())
    }
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// Column and row of the picture in which a point (x, 3.5, 0) shows.
fn column(x: f64) -> f64 {
    30.0 * (1.0 + x / 3.5 / 30_f64.to_radians().tan())
}

#[test]
fn a_task_map_is_the_falloff_of_the_distance_to_the_object() {
    let folder = Folder::new();
    for falloff in Falloff::ALL {
        let words = ["--task", "ball.1", "--px-per-deg", "3", "--falloff", falloff.name(), "-o", "map.exr"];
        let made = folder.importance(&words);
        assert!(made.status.success(), "{}", said(&made));
        let map = grey::read(&folder.path("map.exr")).unwrap();
        let fovea = Fovea { diameter_deg: 2.0, falloff, px_per_deg: 3.0 };
        // The ball is a disc of radius .1 / 3.5 on the picture's plane, 1.5 px; its centre lies on a pixel's corner.
        let centre = column(-1.0);
        let radius = 30.0 * 0.1 / 3.5 / 30_f64.to_radians().tan();
        for x in 0..60 {
            let distance = ((x as f64 + 0.5 - centre).abs() - radius).max(0.0);
            let found = f64::from(*map.at(x, 30));
            let (most, least) = (fovea.importance((distance - 1.5).max(0.0)), fovea.importance(distance + 1.5));
            assert!((least..=most).contains(&found), "{falloff} column {x}: {found} not in {least}..{most}");
        }
    }
}

#[test]
fn objects_go_by_identifier_modifier_and_glob() {
    let folder = Folder::new();
    let map = |task: &str| {
        let made = folder.importance(&["--task", task, "--fovea", "0", "--px-per-deg", "100", "-o", "map.png"]);
        assert!(made.status.success(), "{task}: {}", said(&made));
        grey::read(&folder.path("map.png")).unwrap()
    };
    let is_one = |task: &str, x: f64| *map(task).at(column(x) as usize, 30) == 1.0;
    for (task, left, right) in [
        ("ball.1", true, false),
        ("red", true, false),
        ("ball.?", true, true),
        ("b*2", false, true),
        ("ball.1,ball.2", true, true),
    ] {
        assert_eq!((is_one(task, -1.0), is_one(task, 1.0)), (left, right), "{task}");
    }
}

#[test]
fn saliency_of_a_scene_of_a_picture_and_in_a_mixture() {
    let folder = Folder::new();
    let run = |words: &[&str]| {
        let made = folder.importance(words);
        assert!(made.status.success(), "{words:?}: {}", said(&made));
        said(&made)
    };
    run(&["--saliency", "-o", "salient.exr", "--overlay", "over.png"]);
    let salient = grey::read(&folder.path("salient.exr")).unwrap();
    let of = |x: f64| *salient.at(column(x) as usize, 30);
    assert!(of(-1.0) > 1.2 * of(0.0), "the red ball stands out: {} {}", of(-1.0), of(0.0));
    assert!(folder.path("over.png").exists());

    run(&["--task", "ball.2", "-o", "task.exr"]);
    run(&["--task", "ball.2", "--saliency", "--weight", "0.25", "-o", "mixed.exr"]);
    let (task, mixed) = (grey::read(&folder.path("task.exr")).unwrap(), grey::read(&folder.path("mixed.exr")).unwrap());
    for ((task, salient), mixed) in task.values().iter().zip(salient.values()).zip(mixed.values()) {
        assert!((0.75 * task + 0.25 * salient - mixed).abs() < 1e-6);
    }

    // A picture alone needs no scene, and one of another size is said to be resampled.
    let words = ["importance", "--saliency", "--of", "over.png", "-o", "alone.png", "--bits", "8"];
    assert!(folder.crex(&words).status.success());
    assert_eq!(grey::read(&folder.path("alone.png")).unwrap().width(), 60);
    let noted = run(&["--saliency", "--of", "over.png", "-x", "30", "-y", "30", "-o", "small.png"]);
    assert!(noted.contains("over.png has 60 x 60 pixels, the map 30 x 30: each pixel takes the largest"), "{noted}");
}

#[test]
fn a_map_by_this_command_modulates_a_picture() {
    let folder = Folder::new();
    assert!(folder.importance(&["--task", "ball.1", "-o", "map.png"]).status.success());
    let words =
        ["render", "scene.rad", "-x", "60", "-y", "60", "--crex", "{D}", "--importance", "map.png", "-o", "a.png"];
    let made = folder.crex(&[&words[..], &VIEW[..]].concat());
    assert!(made.status.success() && !said(&made).contains("pixels, the picture"), "{}", said(&made));
}

#[test]
fn what_makes_no_map_is_told() {
    let folder = Folder::new();
    std::fs::write(folder.path("bad.toml"), "width_px = 3\n").unwrap();
    for (words, hint) in [
        (&["-o", "m.png"][..], "--task"),
        (&["--task", "bal.1", "-o", "m.png"], "did you mean `ball.1`"),
        (&["--task", "ball.1", "-o", "m.hdr"], "grey .png or an .exr"),
        (&["--task", "ball.1", "-o", "nowhere/m.png"], "there is no folder"),
        (&["--task", "ball.1", "-o", "m.png", "--fovea", "-2"], "--fovea"),
        (&["--task", "ball.1", "-o", "m.png", "--falloff", "linear"], "geisler-perry"),
        (&["--task", "ball.1", "-o", "m.png", "--px-per-deg", "0"], "--px-per-deg 0"),
        (&["--task", "ball.1", "-o", "m.png", "--weight", ".5"], "--saliency"),
        (&["--task", "ball.1", "--saliency", "-o", "m.png", "--weight", "1.5"], "from 0 to 1"),
        (&["--task", "ball.1", "-o", "m.png", "--display", "bad.toml"], "bad.toml"),
        (&["--saliency", "--of", "none.png", "-o", "m.png"], "none.png"),
        (&["--task", "ball.1", "-o", "m.png", "--bits", "12"], "16"),
    ] {
        let output = folder.importance(words);
        let code = if hint == "there is no folder" { 1 } else { 2 };
        assert_eq!(output.status.code(), Some(code), "{words:?}: {}", said(&output));
        assert!(said(&output).contains(hint), "{words:?}: {}", said(&output));
    }
    assert!(!Path::new(&folder.path("m.png")).exists());
    assert_eq!(folder.crex(&["importance", "--saliency", "-o", "m.png"]).status.code(), Some(2));
}
