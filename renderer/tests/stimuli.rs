//! `crex stimuli` from outside, on a study of tiny pictures.

#![allow(clippy::unwrap_used, reason = "a test that cannot start has failed")]

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use renderer::picture::Provenance;
use renderer::picture::grey::{self, Bits};
use renderer::raster::Raster;
use stimuli::{Manifest, Stimulus, Study};

/// The shipped corridor.
fn corridor() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../stimuli/corridor")
}

fn crex_stimuli(study: &Path, words: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_crex"));
    command.arg("stimuli").arg(study).args(words).stdin(Stdio::null()).output().unwrap()
}

fn code(output: &Output) -> i32 {
    output.status.code().unwrap()
}

fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).unwrap()
}

fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

/// A folder with the corridor's study file, but pictures of 20 x 16 pixels of a lamp, a wall and a pane.
fn tiny_study() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    let text = std::fs::read_to_string(corridor().join("study.toml")).unwrap();
    let text = text.replace("width_px = 1280", "width_px = 20").replace("height_px = 1024", "height_px = 16");
    let lines = text.lines().map(|line| if line.starts_with("spp = ") { "spp = 2" } else { line });
    write("study.toml", &lines.collect::<Vec<_>>().join("\n"));
    for view in ["corridor.vf", "practice.vf"] {
        std::fs::copy(corridor().join(view), folder.path().join(view)).unwrap();
    }
    write(
        "materials.rad",
        "void plastic grey 0 0 5 .5 .5 .5 0 0\nvoid light lamp 0 0 3 9 9 9\nvoid glass pane 0 0 3 .9 .9 .9\n",
    );
    write("shell.rad", "!genbox grey room 4 20 4 -i | xform -t -1 -5 0\n!xform -t 0 9 0 pane.rad\n");
    write("pane.rad", "pane polygon pane 0 0 12 0 0 0  3 0 0  3 0 3  0 0 3\n");
    // One item of each kind that the study counts, all at one place.
    let kinds =
        ["extinguisher", "hose_reel", "blanket", "call_point", "exit_sign", "hydrant_sign", "detector", "sprinkler"];
    let items: String = kinds.iter().map(|kind| format!("grey sphere {kind}.1.body 0 0 4 2.2 6 1 .2\n")).collect();
    for layout in ["layout_a.rad", "layout_b.rad", "practice_a.rad", "practice_b.rad"] {
        write(layout, &format!("lamp sphere lamp 0 0 4 1.3 5 2 .2\n{items}"));
    }
    folder
}

#[test]
fn pictures_are_rendered_once_and_again_when_something_changed() {
    let folder = tiny_study();
    let study = folder.path();
    let check = crex_stimuli(study, &["--check"]);
    assert_eq!(code(&check), 1);
    assert!(stdout(&check).contains("a_hq: missing"), "{}", stdout(&check));
    assert!(!study.join("pictures").exists(), "a check renders nothing");

    let made = crex_stimuli(study, &[]);
    assert_eq!(code(&made), 0, "{}", stderr(&made));
    let check = crex_stimuli(study, &["--check"]);
    assert_eq!(code(&check), 0, "{}", stdout(&check));
    let first = Manifest::load(study).unwrap();
    let shown: Vec<String> = Study::load(study).unwrap().stimuli().iter().map(Stimulus::id).collect();
    assert!(shown.iter().all(|id| first.pictures.contains_key(id)) && shown.len() == first.pictures.len());

    let again = crex_stimuli(study, &[]);
    assert!(stderr(&again).contains("every picture is what would be made"), "{}", stderr(&again));
    assert_eq!(Manifest::load(study).unwrap(), first);

    // A file that only another scene file names is an input too.
    let pane = std::fs::read_to_string(study.join("pane.rad")).unwrap();
    std::fs::write(study.join("pane.rad"), pane.replace("0 0 3\n", "0 0 2.9\n")).unwrap();
    let check = crex_stimuli(study, &["--check"]);
    assert!(stdout(&check).contains("a_hq: stale: changed since are pane.rad"), "{}", stdout(&check));
    let one = crex_stimuli(study, &["--only", "b_hq"]);
    assert_eq!(code(&one), 0, "{}", stderr(&one));
    let second = Manifest::load(study).unwrap();
    assert_ne!(second.pictures["b_hq"], first.pictures["b_hq"]);
    assert_eq!(second.pictures["a_hq"], first.pictures["a_hq"]);
}

#[test]
fn the_manifest_says_what_was_traced_and_the_same_comes_out_again() {
    let folder = tiny_study();
    let study = folder.path();
    let made = crex_stimuli(study, &["--only", "a_cbq", "--threads", "1"]);
    assert_eq!(code(&made), 0, "{}", stderr(&made));
    let first = Manifest::load(study).unwrap();
    let record = &first.pictures["a_cbq"];
    assert_eq!(record.rays["primary"], 20 * 16 * 2);
    assert!(record.rays.get("D").is_none_or(|&rays| rays == 0), "T{{RSGM}} traces no D");
    assert!(record.rays["T"] > 0);
    let inputs: Vec<_> = record.inputs.keys().map(|path| path.to_str().unwrap()).collect();
    assert_eq!(inputs, ["corridor.vf", "layout_a.rad", "maps/a.png", "materials.rad", "pane.rad", "shell.rad"]);
    assert!(record.mean_luminance_cd_m2 > 0.0);

    std::fs::write(study.join(&record.file), "painted over").unwrap();
    let check = crex_stimuli(study, &["--check", "--only", "a_cbq"]);
    assert_eq!(code(&check), 1);
    assert!(stdout(&check).contains("a_cbq: altered"), "{}", stdout(&check));
    assert_eq!(code(&crex_stimuli(study, &["--only", "a_cbq", "--threads", "2"])), 0);
    assert_eq!(Manifest::load(study).unwrap().pictures, first.pictures, "two threads make the same bytes as one");
}

#[test]
fn wrong_input_is_told_and_renders_nothing() {
    let folder = tiny_study();
    let study = folder.path();
    let text = std::fs::read_to_string(study.join("study.toml")).unwrap();
    let altered = |from: &str, to: &str| {
        assert!(text.contains(from));
        std::fs::write(study.join("study.toml"), text.replace(from, to)).unwrap();
    };
    for (from, to, said) in [
        ("width_px = 20", "width_px = 21", "square"),
        ("crex = \"T{RSGM}\"", "crex = \"T{RSGm}\"", "`m`"),
        ("\"-lw\"", "\"-lww\"", "did you mean `-lw`"),
        ("\"shell.rad\"", "\"shed.rad\"", "shed.rad"),
        ("rank = 3", "rank = -3", "study.toml:"),
    ] {
        altered(from, to);
        let output = crex_stimuli(study, &["--only", "a_cbq"]);
        assert_eq!(code(&output), 2, "{to}: {}", stderr(&output));
        assert!(stderr(&output).contains(said), "{to}: {}", stderr(&output));
    }
    altered("rank = 3", "rank = 3");
    let output = crex_stimuli(study, &["--only", "a_uhq"]);
    assert_eq!(code(&output), 2);
    assert!(stderr(&output).contains("a_hq, a_cbq"), "{}", stderr(&output));
    assert_eq!(code(&crex_stimuli(&study.join("nowhere"), &[])), 2);
    assert!(!study.join("pictures").exists() && Manifest::load(study).unwrap().pictures.is_empty());
}

#[test]
fn maps_are_made_before_the_pictures_that_they_modulate() {
    let folder = tiny_study();
    let study = folder.path();
    let made = crex_stimuli(study, &["--only", "a_hq"]);
    assert_eq!(code(&made), 0, "{}", stderr(&made));
    assert!(!study.join("maps").exists(), "nothing that is not needed is made");
    let made = crex_stimuli(study, &["--only", "a_cbq", "--only", "b_cbq"]);
    assert_eq!(code(&made), 0, "{}", stderr(&made));
    let map = grey::read(&study.join("maps/a.png")).unwrap();
    assert_eq!((map.width(), map.height()), (20, 16));
    let (low, high) = map.values().iter().fold((1.0_f32, 0.0_f32), |(l, h), &v| (l.min(v), h.max(v)));
    assert!(high == 1.0 && low < 0.9, "1 at the items, less elsewhere: {low} to {high}");
    let first = Manifest::load(study).unwrap();
    let inputs: Vec<_> = first.maps[Path::new("maps/a.png")].inputs.keys().map(|path| path.to_str().unwrap()).collect();
    assert_eq!(inputs, ["corridor.vf", "layout_a.rad", "materials.rad", "pane.rad", "shell.rad"]);

    // Another plan makes other maps, and those stale what they modulate; a map that was painted over is made again.
    let text = std::fs::read_to_string(study.join("study.toml")).unwrap();
    std::fs::write(study.join("study.toml"), text.replace("falloff = \"mar\"", "falloff = \"cortical\"")).unwrap();
    let check = crex_stimuli(study, &["--check", "--only", "a_cbq"]);
    assert_eq!(code(&check), 1);
    assert!(stdout(&check).contains("maps/a.png: stale: changed since are the plan of the map"), "{}", stdout(&check));
    let made = crex_stimuli(study, &["--only", "a_cbq"]);
    assert!(stderr(&made).contains("a_cbq, stale: changed since are maps/a.png"), "{}", stderr(&made));
    let white = Raster::filled(20, 16, 1.0);
    grey::write(&study.join("maps/a.png"), &white, Bits::Eight, &Provenance::default()).unwrap();
    let check = crex_stimuli(study, &["--check", "--only", "a_cbq"]);
    assert!(stdout(&check).contains("maps/a.png: altered"), "{}", stdout(&check));

    // Without a plan the maps are taken as they are drawn.
    let drawn = text.replace("[importance]\nfovea_deg = 2.0\nfalloff = \"mar\"\n", "");
    assert_ne!(drawn, text);
    std::fs::write(study.join("study.toml"), drawn).unwrap();
    let made = crex_stimuli(study, &["--only", "a_cbq"]);
    assert_eq!(code(&made), 0, "{}", stderr(&made));
    assert!(grey::read(&study.join("maps/a.png")).unwrap().values().iter().all(|&value| value == 1.0));
}

#[test]
fn several_machines_make_what_one_makes() {
    let (alone, together) = (tiny_study(), tiny_study());
    let (alone, together) = (alone.path(), together.path());
    assert_eq!(code(&crex_stimuli(alone, &[])), 0);
    let early = crex_stimuli(together, &["--shard", "1/3"]);
    assert_eq!(code(&early), 2);
    assert!(stderr(&early).contains("--maps"), "{}", stderr(&early));
    assert!(!together.join("pictures").exists());
    assert_eq!(code(&crex_stimuli(together, &["--maps"])), 0);
    for shard in ["3/3", "1/3"] {
        assert_eq!(code(&crex_stimuli(together, &["--shard", shard])), 0);
    }
    assert!(Manifest::load(together).unwrap().pictures.is_empty(), "parts are no pictures");
    let early = crex_stimuli(together, &["--merge"]);
    assert_eq!(code(&early), 2);
    assert!(stderr(&early).contains("part 2 of 3 is missing"), "{}", stderr(&early));
    // A machine that died is replaced; what is there is kept.
    let picture = Manifest::load(alone).unwrap().pictures["a_hq"].file.clone();
    let part = |number: u32| together.join(format!("{}.{number}-of-3.part", picture.display()));
    let before = std::fs::metadata(part(1)).unwrap().modified().unwrap();
    for shard in ["1/3", "2/3"] {
        assert_eq!(code(&crex_stimuli(together, &["--shard", shard])), 0);
    }
    assert_eq!(std::fs::metadata(part(1)).unwrap().modified().unwrap(), before);
    let merged = crex_stimuli(together, &["--merge"]);
    assert_eq!(code(&merged), 0, "{}", stderr(&merged));
    let [one, other] = [alone, together].map(|study| Manifest::load(study).unwrap());
    assert_eq!((one.pictures, one.maps), (other.pictures, other.maps));
    assert!(!part(1).exists());
    assert_eq!(code(&crex_stimuli(together, &["--check"])), 0);
    // Parts of another scene than the study shows now are not joined.
    assert_eq!(code(&crex_stimuli(together, &["--force", "--only", "a_hq", "--shard", "1/1"])), 0);
    let shell = std::fs::read_to_string(together.join("shell.rad")).unwrap();
    std::fs::write(together.join("shell.rad"), shell.replace("0 9 0", "0 8 0")).unwrap();
    assert_eq!(code(&crex_stimuli(together, &["--maps"])), 0);
    let stale = crex_stimuli(together, &["--merge", "--only", "a_hq"]);
    assert_eq!(code(&stale), 2);
    assert!(stderr(&stale).contains("another picture than the study asks for now"), "{}", stderr(&stale));
}
