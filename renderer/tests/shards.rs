//! Parts of pictures from outside: `crex render --shard`, `crex merge`, and pictures whose planes do not lie in memory.

#![allow(clippy::unwrap_used, reason = "a test that cannot start has failed")]

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use renderer::component::ComponentSet;
use renderer::film::{Film, Plane};
use renderer::part::{Part, PartFile, Tail, join};
use renderer::picture::Provenance;
use renderer::picture::grey::{self, Bits};
use renderer::raster::Raster;
use renderer::render::{Account, Shard, tile, tile_count};
use serde_json::Value;

/// Walls that reflect diffusely and a little as gloss, a mirror and a pane.
const ROOM: &str = "\
void light lamp 0 0 3 20 20 20
void plastic white 0 0 5 .6 .5 .4 .05 .1
void mirror silver 0 0 3 .8 .8 .8
void glass pane 0 0 3 .9 .9 .9
white bubble shell 0 0 4 0 0 1.5 3
silver polygon m 0 0 12 -1 1.5 .5 1 1.5 .5 1 1.5 2 -1 1.5 2
pane polygon p 0 0 12 -1 0 .5 0 0 .5 0 0 2 -1 0 2
lamp polygon l 0 0 12 -.5 -1 3 -.5 0 3 .5 0 3 .5 -1 3
";

/// 90 x 68 pixels: 6 x 5 tiles, those at the right and at the bottom cut.
const VIEW: [&str; 16] =
    ["-vp", "0", "-1.9", "1.2", "-vd", "0", "1", "-.1", "-vh", "80", "-vv", "65", "-x", "90", "-y", "90"];

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("room.rad"), ROOM).unwrap();
    folder
}

fn crex(folder: &Path, words: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_crex")).args(words).current_dir(folder).env_remove("RAYPATH").output().unwrap()
}

fn render(folder: &Path, more: &[&str]) -> Output {
    crex(folder, &[&["render", "room.rad"], &VIEW[..], more].concat())
}

fn good(output: &Output) {
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
}

/// The message of wrong input.
fn refused(output: &Output) -> String {
    assert_eq!(output.status.code(), Some(2), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn read(folder: &Path, name: &str) -> Vec<u8> {
    fs::read(folder.join(name)).unwrap()
}

fn json(folder: &Path, name: &str) -> Value {
    serde_json::from_slice(&read(folder, name)).unwrap()
}

/// Renders all parts but those `without`, and gives their names, the last first.
fn parts(folder: &Path, all: u32, without: &[u32], more: &[&str]) -> Vec<String> {
    let numbers = (1..=all).rev().filter(|number| !without.contains(number));
    let part = |number| {
        let (shard, name) = (format!("{number}/{all}"), format!("{number}-of-{all}.part"));
        good(&render(folder, &[&["--shard", &shard, "-o", &name], more].concat()));
        name
    };
    numbers.map(part).collect()
}

fn merge(folder: &Path, parts: &[String], more: &[&str]) -> Output {
    let parts: Vec<&str> = parts.iter().map(String::as_str).collect();
    crex(folder, &[&["merge"], &parts[..], more].concat())
}

/// Whether two objects of `--stats` say the same of the rays.
fn assert_same_rays(one: &Value, two: &Value) {
    for key in ["crex", "executed", "width", "height", "spp", "seed", "left", "scene", "modulation"] {
        assert_eq!(one[key], two[key], "{key}");
    }
    let rows = |stats: &Value| -> Vec<Value> {
        let bare = |row: &Value| {
            Value::from(
                [&row["stage"], &row["span"], &row["run"], &row["group"], &row["rays"], &row["spawned"]]
                    .map(Clone::clone)
                    .to_vec(),
            )
        };
        stats["stages"].as_array().unwrap().iter().map(bare).collect()
    };
    assert_eq!(rows(one), rows(two));
}

#[test]
fn merged_parts_are_the_picture_of_one_machine_to_the_byte() {
    let folder = folder();
    let folder = folder.path();
    let words = [
        "--crex",
        "(TRSGM{D})*",
        "--spp",
        "3",
        "-lr",
        "-6",
        "-lw",
        ".1",
        "-av",
        ".1",
        ".1",
        ".1",
        "--exposure",
        ".5",
        "--importance",
        "map.png",
    ];
    let map: Vec<f32> = (0..90 * 68).map(|pixel| (pixel % 90) as f32 / 89.0).collect();
    let map = Raster::from_values(90, 68, map).unwrap();
    grey::write(&folder.join("map.png"), &map, Bits::Sixteen, &Provenance::default()).unwrap();
    let whole =
        [&["-o", "whole.exr", "-o", "whole.hdr", "-o", "whole.png", "--stats", "whole.json"][..], &words].concat();
    good(&render(folder, &whole));
    // 40 parts are more than there are tiles.
    for all in [1, 2, 7, 40] {
        let mut names = parts(folder, all, &[], &[&words[..], &["--threads", "1"]].concat());
        names.rotate_left(all as usize / 3);
        good(&merge(folder, &names, &["-o", "made.exr", "-o", "made.hdr", "-o", "made.png", "--stats", "made.json"]));
        for kind in ["exr", "hdr", "png"] {
            assert!(
                read(folder, &format!("whole.{kind}")) == read(folder, &format!("made.{kind}")),
                "{all} parts, {kind}"
            );
        }
        assert_same_rays(&json(folder, "whole.json"), &json(folder, "made.json"));
    }
}

#[test]
fn planes_on_disk_make_the_same_files_as_planes_in_memory() {
    let folder = folder();
    let folder = folder.path();
    let words = |memory: &'static str, name: &'static str| {
        let words = ["--crex", "T{RSGM}D", "--spp", "2", "--memory", memory, "--parts", name, "-av", ".1", ".1", ".1"];
        let outputs = ["exr", "hdr", "png"].map(|kind| format!("{name}.{kind}"));
        let ran = format!("{name}_ran.png");
        let outputs: Vec<&str> = outputs.iter().flat_map(|name| ["-o", name]).collect();
        let output =
            render(folder, &[&words[..], &outputs, &["--stats", &format!("{name}.json"), "--ran", &ran]].concat());
        good(&output);
    };
    words("512", "memory");
    words("0", "disk");
    for kind in [".exr", ".hdr", ".png", "_ran.png", "/direct.exr", "/D.exr", "/M.exr", "/ambient.exr"] {
        let [one, two] = ["memory", "disk"].map(|name| read(folder, &format!("{name}{kind}")));
        assert!(one == two, "{kind}");
    }
    assert_same_rays(&json(folder, "memory.json"), &json(folder, "disk.json"));
    let names = |name: &str| -> Vec<_> {
        let mut names: Vec<_> = fs::read_dir(folder.join(name)).unwrap().map(|it| it.unwrap().file_name()).collect();
        names.sort();
        names
    };
    assert_eq!(names("memory"), names("disk"));
    // Standard output has no folder for the planes.
    let [one, two] = ["512", "0"].map(|memory| render(folder, &["--crex", "D", "--memory", memory, "-o", "-"]).stdout);
    assert!(!one.is_empty() && one == two);
    let left: Vec<_> = fs::read_dir(folder).unwrap().map(|it| it.unwrap().file_name()).collect();
    assert!(left.iter().all(|name| !name.to_string_lossy().contains("planes")), "{left:?}");
}

#[test]
fn a_component_that_no_part_reached_has_no_layer() {
    let folder = folder();
    let folder = folder.path();
    // Nothing spawns M where the view shows the wall behind the eye.
    let words = ["--crex", "M", "-vd", "0", "-1", "0"];
    good(&render(folder, &[&["-o", "whole.exr"], &words[..]].concat()));
    let names = parts(folder, 3, &[], &words);
    assert!(Part::open(&folder.join(&names[0])).unwrap().head().planes.contains(&"M".to_owned()));
    good(&merge(folder, &names, &["-o", "made.exr"]));
    assert!(read(folder, "whole.exr") == read(folder, "made.exr"));
    let layers = renderer::picture::read(&folder.join("made.exr")).unwrap().layers;
    assert_eq!(layers.iter().map(|layer| layer.name.as_str()).collect::<Vec<_>>(), ["direct"]);
}

#[test]
fn what_is_missing_or_double_is_named_and_nothing_written() {
    let folder = folder();
    let folder = folder.path();
    let names = parts(folder, 6, &[2, 4, 5], &["--crex", "D"]);
    fs::write(folder.join("out.exr"), "before").unwrap();
    let output = merge(folder, &names, &["-o", "out.exr", "--json"]);
    assert!(refused(&output).contains("parts 2,4-5 of 6 are missing"), "{}", refused(&output));
    let report: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(
        report,
        serde_json::json!({"parts": 6, "missing": [2, 4, 5], "array": "2,4-5", "double": [], "complete": false})
    );

    let mut all = names.clone();
    all.extend(["2", "4", "5"].map(|number| {
        let name = format!("{number}-of-6.part");
        good(&render(folder, &["--shard", &format!("{number}/6"), "-o", &name, "--crex", "D"]));
        name
    }));
    fs::copy(folder.join("4-of-6.part"), folder.join("again.part")).unwrap();
    let twice = [&all[..], &["again.part".to_owned()]].concat();
    let message = refused(&merge(folder, &twice, &["-o", "out.exr"]));
    assert!(message.contains("part 4 of 6 is there 2 times: 4-of-6.part, again.part"), "{message}");
    let output = merge(folder, &twice, &["--check", "--json"]);
    let report: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!((&report["double"], output.status.code()), (&serde_json::json!([4]), Some(2)));
    assert_eq!(read(folder, "out.exr"), b"before");
    good(&merge(folder, &all, &["--check"]));
    good(&merge(folder, &all, &["-o", "out.exr"]));
    assert_ne!(read(folder, "out.exr"), b"before");
}

#[test]
fn parts_of_different_pictures_are_not_joined() {
    let folder = folder();
    let folder = folder.path();
    let one = parts(folder, 2, &[2], &["--crex", "D"]);
    let second = |name: &str, more: &[&str]| {
        good(&render(folder, &[&["--shard", "2/2", "-o", name], more].concat()));
        let output = merge(folder, &[&one[..], &[name.to_owned()]].concat(), &["-o", "out.exr"]);
        assert!(!folder.join("out.exr").exists());
        output
    };
    for (more, what) in [
        (&["--crex", "DD"][..], "the crex is `D` in the first, `DD`"),
        (&["--crex", "D", "--seed", "7"], "the seed is `0` in the first, `7`"),
        (&["--crex", "D", "--spp", "2"], "the samples"),
        (&["--crex", "D", "-lw", ".5"], "the options"),
        (&["--crex", "D", "-vp", "0", "-1.8", "1.2"], "the view"),
        (&["--crex", "D", "-x", "80"], "the size"),
        (&["--crex", "D", "--exposure", "2"], "the exposure"),
    ] {
        let message = refused(&second("other.part", more));
        assert!(message.contains("parts of different pictures") && message.contains(what), "{message}");
    }
    let message =
        refused(&merge(folder, &[&one[..], &parts(folder, 3, &[1, 2], &["--crex", "D"])].concat(), &["-o", "out.exr"]));
    assert!(message.contains("the number of parts is `2`"), "{message}");
    fs::write(folder.join("room.rad"), ROOM.replace(".6 .5 .4", ".6 .5 .3")).unwrap();
    let message = refused(&second("other.part", &["--crex", "D"]));
    assert!(message.contains("the files read is `room.rad"), "{message}");
    // Another version's part.
    let mut head = Part::open(&folder.join(&one[0])).unwrap().head().clone();
    (head.shard, head.provenance.software) = ([2, 2], "crex 99.0.0".to_owned());
    let mut part = PartFile::create(&folder.join("other.part"), &head).unwrap();
    let components = head.planes().unwrap().into_iter().filter_map(|plane| match plane {
        Plane::Layer(component) => Some(component),
        _ => None,
    });
    let components: ComponentSet = components.collect();
    for index in Shard::new(2, 2).unwrap().of(0..tile_count(head.width, head.height)) {
        let tile = tile(head.width, head.height, index);
        part.add(&Film::new(tile.width, tile.height, components, false)).unwrap();
    }
    part.finish(&Tail::new(&Account::default(), 1, 0.0, None)).unwrap();
    let message = refused(&merge(folder, &[&one[..], &["other.part".to_owned()]].concat(), &["-o", "out.exr"]));
    assert!(message.contains("the version is") && message.contains("crex 99.0.0"), "{message}");
    assert!(!folder.join("out.exr").exists());
}

#[test]
fn damage_anywhere_in_a_part_is_found() {
    let folder = folder();
    let folder = folder.path();
    let names = parts(folder, 2, &[], &["--crex", "D"]);
    let bytes = read(folder, &names[0]);
    // Wherever a byte is changed or the end cut off: the part does not open, or does not read.
    let step = bytes.len() / 60;
    for at in (0..bytes.len()).step_by(step) {
        let mut changed = bytes.clone();
        changed[at] ^= 0x10;
        for (what, bytes) in [("changed at", &changed[..]), ("cut at", &bytes[..at])] {
            fs::write(folder.join("bad.part"), bytes).unwrap();
            let parts: Result<Vec<_>, _> =
                ["bad.part", &names[1]].iter().map(|name| Part::open(&folder.join(name))).collect();
            let seen = match parts.and_then(join) {
                Err(error) => error.is_input(),
                Ok(joined) => joined.bands().any(|band| band.is_err_and(|error| error.is_input())),
            };
            assert!(seen, "{what} byte {at} of {}", bytes.len());
        }
    }
    fs::write(folder.join("bad.part"), ROOM).unwrap();
    let message = refused(&crex(folder, &["merge", "bad.part", "-o", "out.exr"]));
    assert!(message.contains("bad.part: is no part of a picture"), "{message}");
    fs::write(folder.join("bad.part"), &bytes[..bytes.len() / 2]).unwrap();
    let message = refused(&crex(folder, &["merge", "bad.part", "-o", "out.exr"]));
    assert!(message.contains("is not whole: render it again"), "{message}");
    assert!(!folder.join("out.exr").exists());
}

#[test]
fn wrong_words_make_no_part() {
    let folder = folder();
    let folder = folder.path();
    for (words, message) in [
        (&["--shard", "0/2", "-o", "a.part"][..], "expected I/N"),
        (&["--shard", "3/2", "-o", "a.part"], "expected I/N"),
        (&["--shard", "1/9000000", "-o", "a.part"], "expected I/N"),
        (&["--shard", "1/2"], "-o"),
        (&["--shard", "1/2", "-o", "-"], "standard output"),
        (&["--shard", "1/2", "-o", "a.part", "-o", "b.part"], "one part"),
        (&["--shard", "1/2", "-o", "a.part", "--time", "1"], "--time needs the whole picture"),
        (&["--shard", "1/2", "-o", "a.part", "--filter", "D", "--spp", "2"], "--filter needs the whole picture"),
        (&["--shard", "1/2", "-o", "a.part", "--parts", "p"], "--parts needs the whole picture"),
        (&["--shard", "1/2", "-o", "a.part", "--exposure", "0"], "--exposure"),
    ] {
        let told = refused(&render(folder, &[words, &["--crex", "D"]].concat()));
        assert!(told.contains(message), "{words:?}: {told}");
    }
    assert_eq!(fs::read_dir(folder).unwrap().count(), 1, "the scene alone");
    good(&render(folder, &["--shard", "1/1", "-o", "part.exr", "--crex", "D"]));
    assert!(refused(&crex(folder, &["merge", "part.exr", "-o", "part.exr"])).contains("cannot be written over"));
    assert!(refused(&crex(folder, &["merge", "none.part", "-o", "a.exr"])).contains("none.part"));
    assert_eq!(crex(folder, &["merge", "part.exr"]).status.code(), Some(2));
}
