//! `crex render` from outside: what it counts, writes, says and refuses.

#![allow(clippy::unwrap_used, reason = "a test that cannot start has failed")]

use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use renderer::picture::grey::{self, Bits};
use renderer::picture::{self, Provenance};
use renderer::raster::Raster;
use serde_json::Value;
use tempfile::TempDir;

/// A small room in which every component occurs: a glossy floor, a pane before a wall, a smooth and a rough ball, a mirror.
const ROOM: &str = "\
void light lamp 0 0 3 20 20 20
void plastic white 0 0 5 .6 .6 .6 0 0
void plastic floor 0 0 5 .5 .4 .3 .1 .1
void metal smooth 0 0 5 .8 .7 .5 .9 0
void metal rough 0 0 5 .8 .7 .5 .8 .2
void glass pane 0 0 3 .9 .9 .9
void mirror silver 0 0 3 .8 .8 .8
floor polygon f 0 0 12 -2 -2 0 2 -2 0 2 2 0 -2 2 0
white polygon ceiling 0 0 12 -2 -2 3 -2 2 3 2 2 3 2 -2 3
white polygon back 0 0 12 -2 2 0 2 2 0 2 2 3 -2 2 3
silver polygon left 0 0 12 -1.9 -1 .2 -1.9 1.5 .2 -1.9 1.5 2 -1.9 -1 2
white polygon right 0 0 12 2 -2 0 2 -2 3 2 2 3 2 2 0
lamp polygon l 0 0 12 -.5 0 2.9 -.5 1 2.9 .5 1 2.9 .5 0 2.9
smooth sphere a 0 0 4 -.6 1 .5 .5
rough sphere b 0 0 4 .6 1 .5 .5
pane polygon p 0 0 12 .3 0 .1 1.5 0 .1 1.5 0 1.5 .3 0 1.5
";

const VIEW: [&str; 12] = ["-vp", "0", "-1.9", "1.2", "-vd", "0", "1", "-.1", "-vh", "80", "-vv", "60"];

struct Folder(TempDir);

impl Folder {
    fn new() -> Self {
        let folder = Self(tempfile::tempdir().unwrap());
        fs::write(folder.path("room.rad"), ROOM).unwrap();
        folder
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// Names in the folder, sorted.
    fn names(&self) -> Vec<String> {
        let names = fs::read_dir(self.0.path()).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
        let mut names: Vec<String> = names.collect();
        names.sort();
        names
    }

    /// `crex render` in the folder.
    fn render(&self, words: &[&str]) -> Output {
        self.command(words).output().unwrap()
    }

    fn command(&self, words: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_crex"));
        command.arg("render").args(words).stdin(Stdio::null()).current_dir(self.0.path()).env_remove("RAYPATH");
        command
    }

    /// Renders the room small and gives its statistics.
    fn stats(&self, crex: &str, more: &[&str]) -> Value {
        let words = [
            &["room.rad", "--crex", crex, "-x", "48", "-y", "33", "-o", "a.exr", "--stats", "a.json"],
            &VIEW[..],
            more,
        ];
        let output = self.render(&words.concat());
        assert!(output.status.success(), "{}", said(&output));
        serde_json::from_slice(&fs::read(self.path("a.json")).unwrap()).unwrap()
    }
}

fn said(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

/// Rays of each stage, in order, as (stage, rays).
fn rays(stats: &Value) -> Vec<(&str, u64)> {
    let rows = stats["stages"].as_array().unwrap().iter();
    rows.map(|row| (row["stage"].as_str().unwrap(), row["rays"].as_u64().unwrap())).collect()
}

/// Rays of a component that the stage of this number spawned.
fn spawned(stats: &Value, stage: usize, component: &str) -> u64 {
    stats["stages"][stage]["spawned"][component].as_u64().unwrap()
}

#[test]
fn a_mistake_on_line_7_is_told_with_file_line_and_column() {
    let folder = Folder::new();
    let broken = ROOM.replace("void mirror silver 0 0 3", "void mirror silver 0 0 2");
    fs::write(folder.path("broken.rad"), broken).unwrap();
    let output = folder.render(&[&["broken.rad", "--crex", "D", "-o", "a.exr"], &VIEW[..]].concat());
    assert_eq!(output.status.code(), Some(2));
    let message = said(&output);
    assert!(message.contains("broken.rad:7:"), "{message}");
    assert!(message.lines().any(|line| line.trim().starts_with('^') || line.trim_end().ends_with('^')), "{message}");
    assert!(output.stdout.is_empty());
    assert!(!folder.path("a.exr").exists());
}

#[test]
fn a_scene_runs_no_command() {
    let folder = Folder::new();
    fs::write(folder.path("keep.txt"), "kept").unwrap();
    fs::write(folder.path("bad.rad"), format!("{ROOM}!rm keep.txt\n")).unwrap();
    let output = folder.render(&[&["bad.rad", "--crex", "D", "-o", "a.exr"], &VIEW[..]].concat());
    assert_eq!(output.status.code(), Some(2));
    assert!(said(&output).contains("bad.rad:17:"), "{}", said(&output));
    assert!(folder.path("keep.txt").exists());
}

#[test]
fn wrong_words_are_exit_2_and_a_missing_folder_exit_1() {
    let folder = Folder::new();
    for (words, code, message) in [
        (&["room.rad", "--crex", "D", "-o", "a.tif"][..], 2, ".exr, .hdr (or .pic) or .png"),
        (&["room.rad", "--crex", "D", "-o", "no/such/a.exr"], 1, "there is no folder no/such"),
        (&["room.rad", "--crex", "X", "-o", "a.exr"], 2, "means nothing in a crex"),
        (&["room.rad", "-o", "a.exr"], 2, "--crex"),
        (&["missing.rad", "--crex", "D", "-o", "a.exr"], 2, "missing.rad"),
        (&["room.rad", "--crex", "D", "-o", "a.exr", "-abb", "2"], 2, "did you mean `-ab`?"),
        (&["room.rad", "--crex", "D", "-o", "a.exr", "-vp", "1", "2"], 2, "`-vp` wants 3 values"),
        (&["room.rad", "--crex", "D", "-o", "a.exr", "--spp", "0"], 2, "--spp"),
        (&["room.rad", "--crex", "T{RS}", "-o", "a.exr", "--thresholds", ".5"], 2, "threshold"),
        (&["room.rad", "--crex", "D", "-o", "a.exr", "--importance", "none.png"], 2, "none.png"),
        (&["room.rad", "--crex", "{D}", "-o", "a.exr", "--continuous"], 2, "--importance"),
        (&["room.rad", "--crex", "D", "-o", "a.exr", "--filter", "D,X"], 2, "letters of components"),
        (&["room.rad", "--crex", "D", "-o", "a.exr", "--filter", "D"], 2, "2 or more to smooth planes"),
        (&["room.rad", "--crex", "D", "-o", "a.exr", "--filter", "D", "--layers", "first"], 2, "--layers first"),
    ] {
        let output = folder.render(words);
        assert_eq!(output.status.code(), Some(code), "{words:?}: {}", said(&output));
        assert!(said(&output).contains(message), "{words:?}: {}", said(&output));
        assert!(output.stdout.is_empty());
        assert_eq!(folder.names(), ["room.rad"], "{words:?}");
    }
}

#[test]
fn inherited_rays_and_held_rays_are_counted_apart() {
    let folder = Folder::new();
    let inherit = folder.stats("(DG)G", &[]);
    let hold = folder.stats("<DG>G", &[]);
    let names = |stats: &Value| rays(stats).into_iter().map(|(name, _)| name.to_owned()).collect::<Vec<_>>();
    assert_eq!(names(&inherit), ["primary", "D", "G", "G"]);
    assert_eq!(names(&hold), ["primary", "D", "G", "G"]);
    let (from_eye, from_d) = (spawned(&inherit, 0, "G"), spawned(&inherit, 1, "G"));
    assert!(from_eye > 0 && from_d > 0);
    // In ( ) the first G also runs what D spawned; in < > the last G runs it, with what the first G spawned.
    assert_eq!(rays(&inherit)[2].1, from_eye + from_d);
    assert_eq!(rays(&inherit)[3].1, spawned(&inherit, 2, "G"));
    assert_eq!(rays(&hold)[1].1, rays(&inherit)[1].1);
    assert_eq!(rays(&hold)[2].1, from_eye);
    assert_eq!(rays(&hold)[3].1, from_d + spawned(&hold, 2, "G"));
}

#[test]
fn a_repeat_inside_a_hold_runs_nothing_the_second_time() {
    let folder = Folder::new();
    let free = folder.stats("D2", &[]);
    let held = folder.stats("<D2>", &[]);
    assert_eq!(rays(&free)[1].1, spawned(&free, 0, "D"));
    assert_eq!(rays(&free)[2].1, spawned(&free, 1, "D"));
    assert!(rays(&free)[2].1 > 0);
    assert_eq!(rays(&held)[1..].iter().map(|row| row.1).collect::<Vec<_>>(), [spawned(&held, 0, "D"), 0]);
    assert_eq!(held["left"]["D"], spawned(&held, 1, "D"));
    assert_eq!((&held["stages"][2]["run"], &held["stages"][2]["span"]), (&Value::from(2), &serde_json::json!([1, 2])));
}

#[test]
fn a_map_of_zeros_and_ones_splits_the_rays() {
    let folder = Folder::new();
    let map = |name: &str, left: f32, right: f32| {
        let values = (0..48 * 33).map(|index| if index % 48 < 24 { left } else { right }).collect();
        let map = Raster::from_values(48, 33, values).unwrap();
        grey::write(&folder.path(name), &map, Bits::Sixteen, &Provenance::default()).unwrap();
        let stats = folder.stats("T{RSGM}", &["--importance", name, "--spp", "4"]);
        let counts: Vec<u64> = rays(&stats).into_iter().map(|row| row.1).collect();
        // What was spawned and not traced is left.
        for (component, member) in [("R", 2), ("S", 3), ("G", 4), ("M", 5)] {
            let all: u64 = (0..6).map(|stage| spawned(&stats, stage, component)).sum();
            assert_eq!(stats["left"][component].as_u64().unwrap(), all - counts[member], "{component}");
        }
        counts
    };
    let (ones, left, right, zeros) =
        (map("1.png", 1.0, 1.0), map("l.png", 1.0, 0.0), map("r.png", 0.0, 1.0), map("0.png", 0.0, 0.0));
    assert!(ones.iter().all(|&count| count > 0), "every component occurs: {ones:?}");
    assert!(left[2..].iter().chain(&right[2..]).any(|&count| count > 0));
    // Outside { } the map changes nothing; inside, nothing runs at 0, and the halves make the whole.
    assert_eq!((ones[..2] == left[..2], ones[..2] == zeros[..2]), (true, true));
    assert_eq!(zeros[2..], [0; 4]);
    let both: Vec<u64> = left.iter().zip(&right).map(|(a, b)| a + b).collect();
    assert_eq!(both[2..], ones[2..]);
    // Thresholds i/5: at .5 the first two members run.
    let middle = map("m.png", 0.5, 0.5);
    assert_eq!((middle[2] > 0, middle[3] > 0, middle[4], middle[5]), (true, true, 0, 0));
}

#[test]
fn layers_add_up_to_the_beauty_and_what_nothing_reached_is_absent() {
    let folder = Folder::new();
    folder.stats("(TRSGM)*D", &["-av", ".1", ".2", ".3", "-ab", "0", "--spp", "4"]);
    let made = picture::read(&folder.path("a.exr")).unwrap();
    let names: Vec<&str> = made.layers.iter().map(|layer| layer.name.as_str()).collect();
    for name in ["direct", "G", "M", "R", "S", "T", "ambient"] {
        assert!(names.contains(&name), "{name} in {names:?}");
    }
    assert!(!names.contains(&"D"), "-ab 0 lets no D ray run");
    for (index, beauty) in made.beauty.values().iter().enumerate() {
        for channel in 0..3 {
            let sum: f64 = made.layers.iter().map(|layer| f64::from(layer.pixels.values()[index][channel])).sum();
            let beauty = f64::from(beauty[channel]);
            assert!((sum - beauty).abs() <= 1e-5 * beauty.abs(), "pixel {index}: {sum} and {beauty}");
        }
    }
    assert_eq!(made.provenance.crex.as_deref(), Some("(TRSGM)*D"));
    assert_eq!(made.provenance.inputs[0].name, "room.rad");
}

#[test]
fn smoothed_planes_are_less_noisy_and_the_others_stay() {
    let folder = Folder::new();
    let made = |more: &[&str]| {
        folder.stats("D", &[&["--spp", "16", "-x", "64", "-y", "48"], more].concat());
        picture::read(&folder.path("a.exr")).unwrap()
    };
    let plain = made(&[]);
    let smoothed = made(&["--filter", "D", "-n", "1"]);
    assert_eq!(made(&["--filter", "D", "-n", "2"]), smoothed);
    for (layer, other) in plain.layers.iter().zip(&smoothed.layers) {
        assert_eq!(layer.name, other.name);
        let apart = |pixels: &Raster<[f32; 3]>| -> f64 {
            let rows = pixels.values().chunks_exact(pixels.width());
            rows.flat_map(|row| row.windows(2).map(|two| f64::from(two[0][1] - two[1][1]).powi(2))).sum()
        };
        let mean = |pixels: &Raster<[f32; 3]>| pixels.values().iter().map(|pixel| f64::from(pixel[1])).sum::<f64>();
        if layer.name == "D" {
            assert!(apart(&other.pixels) < 0.2 * apart(&layer.pixels));
            // The noise of a pixel is some 94 % of the plane's mean, that of the mean of 2816 pixels 1.8 %: some three of those.
            assert!((mean(&other.pixels) / mean(&layer.pixels) - 1.0).abs() < 0.05);
        } else {
            // Sums over the halves instead of the whole may round differently.
            for (a, b) in layer.pixels.values().iter().flatten().zip(other.pixels.values().iter().flatten()) {
                assert!((a - b).abs() <= 1e-6 * a.abs(), "{}: {a} {b}", layer.name);
            }
        }
    }
    for (index, beauty) in smoothed.beauty.values().iter().enumerate() {
        let sum: f64 = smoothed.layers.iter().map(|layer| f64::from(layer.pixels.values()[index][1])).sum();
        assert!((sum - f64::from(beauty[1])).abs() <= 1e-5 * sum.abs());
    }
}

#[test]
fn parts_are_the_layers_as_pictures() {
    let folder = Folder::new();
    folder.stats("(TRSGM)*D", &["-av", ".1", ".1", ".1", "--parts", "parts"]);
    let whole = picture::read(&folder.path("a.exr")).unwrap();
    let mut names: Vec<&str> = whole.layers.iter().map(|layer| layer.name.as_str()).collect();
    assert!(names.contains(&"direct") && names.contains(&"D") && names.contains(&"ambient"), "{names:?}");
    for layer in &whole.layers {
        let part = picture::read(&folder.path("parts").join(format!("{}.exr", layer.name))).unwrap();
        assert_eq!(part.beauty, layer.pixels);
    }
    let mut written: Vec<String> = fs::read_dir(folder.path("parts"))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap().replace(".exr", ""))
        .collect();
    written.sort();
    names.sort_unstable();
    assert_eq!(written, names);
}

#[test]
fn one_thread_and_two_write_the_same_bytes() {
    let folder = Folder::new();
    let files = |threads: &str| {
        let more = ["-o", "a.hdr", "-o", "a.png", "-n", threads, "--spp", "3", "--snapshots", "s", "-lr", "3"];
        folder.stats("(TRSGMD)2", &more);
        let mut files: Vec<Vec<u8>> =
            ["a.exr", "a.hdr", "a.png"].iter().map(|name| fs::read(folder.path(name)).unwrap()).collect();
        let mut names: Vec<PathBuf> =
            fs::read_dir(folder.path("s")).unwrap().map(|entry| entry.unwrap().path()).collect();
        names.sort();
        assert_eq!(names.len(), 13, "primary rays and twelve stages");
        files.extend(names.iter().map(|path| fs::read(path).unwrap()));
        files
    };
    let (one, two) = (files("1"), files("2"));
    assert!(one == two);
    assert_eq!(one[0], one[15], "the last snapshot is the picture");
}

#[test]
fn standard_streams_carry_scene_and_picture_and_nothing_else() {
    let folder = Folder::new();
    let words =
        [&["-", "--crex", "D", "-x", "24", "-y", "24", "-o", "-", "-o", "a.hdr", "-ps", "4"], &VIEW[..]].concat();
    let mut child =
        folder.command(&words).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    child.stdin.take().unwrap().write_all(ROOM.as_bytes()).unwrap();
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success(), "{}", said(&output));
    assert_eq!(output.stdout, fs::read(folder.path("a.hdr")).unwrap());
    assert!(output.stdout.starts_with(b"#?RADIANCE\n"));
    assert_eq!(said(&output).matches("-ps 4 changes nothing here").count(), 1);
}

#[test]
fn statistics_have_the_contracts_keys() {
    let folder = Folder::new();
    let stats = folder.stats("[RS]T", &["--spp", "2", "--seed", "7"]);
    let keys = |value: &Value| value.as_object().unwrap().keys().cloned().collect::<Vec<_>>();
    let mut expected: Vec<&str> =
        "crex executed holds width height spp seed threads wall_s peak_bytes deadline_s left scene modulation timed stages"
            .split(' ')
            .collect();
    expected.sort_unstable();
    let mut found = keys(&stats);
    found.sort();
    assert_eq!(found, expected);
    let mut expected: Vec<&str> =
        "stage span run group rays spawned seconds predicted_s bound_s skipped".split(' ').collect();
    expected.sort_unstable();
    let mut found = keys(&stats["stages"][1]);
    found.sort();
    assert_eq!(found, expected);
    assert_eq!(stats["stages"][1]["group"], "[RS]");
    assert_eq!((&stats["stages"][1]["skipped"], &stats["stages"][3]["group"]), (&Value::Bool(false), &Value::Null));
    assert_eq!((&stats["spp"], &stats["seed"], &stats["deadline_s"]), (&2.into(), &7.into(), &Value::Null));
    assert_eq!(rays(&stats)[0], ("primary", 2 * 48 * 33));
}

#[test]
fn the_size_keeps_pixels_square_unless_told() {
    let folder = Folder::new();
    // The view is 80 x 60 degrees: tan 40 / tan 30 = 1.4534 times as wide as high.
    let square = folder.stats("", &["-x", "400", "-y", "400", "-pa", "1", "-vo", "0"]);
    assert_eq!((&square["width"], &square["height"]), (&400.into(), &275.into()));
    let given = folder.stats("", &["-x", "40", "-y", "40", "-pa", "0"]);
    assert_eq!((&given["width"], &given["height"]), (&40.into(), &40.into()));
}

#[test]
fn what_ran_where_is_shown_with_a_legend() {
    let folder = Folder::new();
    let values = (0..48 * 33).map(|index| 1.0 - (index % 48) as f32 / 47.0).collect();
    let map = Raster::from_values(48, 33, values).unwrap();
    grey::write(&folder.path("map.png"), &map, Bits::Sixteen, &Provenance::default()).unwrap();
    folder.stats("T{RSGM}", &["--importance", "map.png", "--ran", "ran.png"]);
    let ran = picture::read(&folder.path("ran.png")).unwrap().beauty;
    assert_eq!(ran.width(), 48);
    let row: Vec<_> = (0..48).map(|x| *ran.at(x, 16)).collect();
    let mut colours = row.clone();
    colours.dedup();
    // From all members at the left down to T alone, one less at each fifth of the ramp.
    assert_eq!(colours.len(), 5);
    let changes: Vec<usize> = (1..48).filter(|&x| row[x] != row[x - 1]).collect();
    assert_eq!(changes, [10, 19, 29, 38].map(|x| 48 - x).into_iter().rev().collect::<Vec<_>>());
    assert!(ran.height() >= 33 + 5 * 7, "a line of legend for each");
}

#[test]
fn trusted_scenes_run_commands_when_allowed() {
    let folder = Folder::new();
    fs::write(folder.path("more.txt"), "white sphere extra 0 0 4 0 0 1 .2\n").unwrap();
    fs::write(folder.path("runs.rad"), format!("{ROOM}!tail -n 1 more.txt\n")).unwrap();
    let words = [&["runs.rad", "--crex", "", "-x", "8", "-y", "8", "-o", "a.png"], &VIEW[..]].concat();
    assert_eq!(folder.render(&words).status.code(), Some(2));
    let allowed = folder.render(&[&words[..], &["--allow-commands"]].concat());
    assert!(allowed.status.success(), "{}", said(&allowed));
}

/// What a terminal does on Ctrl-C.
#[cfg(unix)]
#[test]
fn an_interruption_leaves_no_file() {
    let folder = Folder::new();
    let words =
        [&["room.rad", "--crex", "(TRSGMD)*", "--spp", "100000", "-o", "a.exr", "-o", "a.png"], &VIEW[..]].concat();
    let mut child = folder.command(&words).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    // Long enough for the handler to stand; the rendering takes hours.
    std::thread::sleep(std::time::Duration::from_millis(700));
    let status = Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    assert!(status.success());
    assert_eq!(child.wait().unwrap().code(), Some(130));
    assert_eq!(folder.names(), ["room.rad"]);
}

#[test]
fn a_scene_in_pieces_is_the_scene() {
    let folder = Folder::new();
    let (materials, surfaces) = ROOM.split_at(ROOM.find("floor polygon").unwrap());
    fs::write(folder.path("materials.rad"), materials).unwrap();
    fs::write(folder.path("surfaces.rad"), surfaces).unwrap();
    let size = ["--crex", "T", "-x", "24", "-y", "24"];
    let whole = folder.render(&[&["room.rad", "-o", "a.png"], &size[..], &VIEW[..]].concat());
    let pieces = folder.render(&[&["materials.rad", "surfaces.rad", "-o", "b.png"], &size[..], &VIEW[..]].concat());
    assert!(whole.status.success() && pieces.status.success(), "{}", said(&pieces));
    let read = |name: &str| picture::read(Path::new(&folder.path(name))).unwrap().beauty;
    assert_eq!(read("a.png"), read("b.png"));
}

#[test]
fn a_time_limit_gives_a_whole_picture_that_replays_to_the_bit() {
    let folder = Folder::new();
    for (seconds, spp) in [("0.01", "1"), ("0.6", "2")] {
        let stats = folder.stats("(TRSMGD)*", &["--time", seconds, "--spp", spp, "--profile", "costs.json"]);
        assert_eq!(stats["deadline_s"].as_f64().unwrap().to_string(), seconds);
        let rounds: u64 =
            stats["timed"]["rounds"].as_array().unwrap().iter().map(|r| r["samples"].as_u64().unwrap()).sum();
        assert!(rounds > 0 || stats["timed"]["units"].as_u64().unwrap() > 0);
        let first = fs::read(folder.path("a.exr")).unwrap();
        fs::rename(folder.path("a.json"), folder.path("was.json")).unwrap();
        let again = folder.stats("(TRSMGD)*", &["--replay", "was.json", "--spp", spp, "--threads", "1"]);
        assert_eq!(first, fs::read(folder.path("a.exr")).unwrap(), "{seconds} s");
        assert_eq!(stats["executed"], again["executed"]);
    }
    let names = folder.names();
    assert!(names.contains(&"costs.json".to_owned()) && !names.iter().any(|name| name.ends_with(".part")), "{names:?}");
    // The profile is of this scene, and so is what was recorded.
    fs::write(folder.path("room.rad"), ROOM.replace(".7 .5", ".6 .5")).unwrap();
    for (option, file, said_to_be) in
        [("--profile", "costs.json", "measured for scene"), ("--replay", "was.json", "scene")]
    {
        let before = fs::read(folder.path(file)).unwrap();
        let words =
            ["room.rad", "--crex", "(TRSMGD)*", "-x", "48", "-y", "33", "-o", "b.exr", option, file, "--spp", "2"];
        let time: &[&str] = if option == "--profile" { &["--time", "1"] } else { &[] };
        let output = folder.render(&[&words[..], &VIEW[..], time].concat());
        assert_eq!(output.status.code(), Some(2), "{}", said(&output));
        assert!(said(&output).contains(said_to_be), "{}", said(&output));
        assert_eq!(before, fs::read(folder.path(file)).unwrap());
    }
    assert!(!folder.path("b.exr").exists());
}

#[test]
fn frames_are_numbered_sharded_and_kept() {
    let folder = Folder::new();
    let view = |x: f64| format!("rvu -vtv -vp {x} -1.9 1.2 -vd 0 1 -.1 -vu 0 0 1 -vh 80 -vv 60\n");
    fs::write(folder.path("path.vf"), format!("# a path\n{}{}{}", view(-0.2), view(0.0), view(0.2))).unwrap();
    let frames = |more: &[&str]| {
        let words = ["room.rad", "--crex", "D", "-x", "24", "-y", "16", "-o", "f.hdr", "--views", "path.vf"];
        let output = folder.render(&[&words[..], more].concat());
        assert!(output.status.success(), "{}", said(&output));
    };
    frames(&["--shard", "2/2"]);
    assert_eq!(folder.names(), ["f_0002.hdr", "path.vf", "room.rad"]);
    fs::write(folder.path("f_0002.hdr"), "kept").unwrap();
    frames(&["--total-time", "0.3"]);
    assert_eq!(folder.names(), ["f_0001.hdr", "f_0002.hdr", "f_0003.hdr", "path.vf", "room.rad"]);
    assert_eq!(fs::read(folder.path("f_0002.hdr")).unwrap(), b"kept");
    // The middle frame is the picture that its view makes alone.
    fs::remove_file(folder.path("f_0002.hdr")).unwrap();
    frames(&[]);
    let words = ["room.rad", "--crex", "D", "-x", "24", "-y", "16", "-o", "alone.hdr"];
    let output = folder.render(&[&words[..], &VIEW[..]].concat());
    assert!(output.status.success(), "{}", said(&output));
    let pixels = |name: &str| picture::read(&folder.path(name)).unwrap().beauty;
    assert_eq!(pixels("f_0002.hdr"), pixels("alone.hdr"));
    fs::write(folder.path("empty.vf"), "# nothing\n").unwrap();
    let output = folder.render(&["room.rad", "--crex", "D", "-o", "g.hdr", "--views", "empty.vf"]);
    assert_eq!(output.status.code(), Some(2), "{}", said(&output));
}

#[test]
fn an_estimate_counts_the_rays_that_the_rendering_traces() {
    let folder = Folder::new();
    let words =
        ["room.rad", "--crex", "TRSMGD", "-x", "48", "-y", "33", "--spp", "4", "--json", "--profile", "costs.json"];
    let mut command = Command::new(env!("CARGO_BIN_EXE_crex"));
    let output = command.arg("estimate").args(words).args(VIEW).current_dir(folder.0.path()).output().unwrap();
    assert!(output.status.success(), "{}", said(&output));
    let estimate: Value = serde_json::from_slice(&output.stdout).unwrap();
    let stats = folder.stats("TRSMGD", &["--spp", "4"]);
    assert_eq!(estimate["primary"]["rays"].as_f64(), Some(48.0 * 33.0 * 4.0));
    let traced = |letter: &str| -> f64 {
        let rows = stats["stages"].as_array().unwrap().iter().filter(|row| row["stage"] == letter);
        rows.map(|row| row["rays"].as_f64().unwrap()).sum()
    };
    let (found, expected) = (estimate["components"]["D"]["rays"].as_f64().unwrap(), traced("D"));
    assert!(found > 0.0 && expected > 0.0);
    assert!(estimate["total_s"]["mean"].as_f64().unwrap() <= estimate["total_s"]["q95"].as_f64().unwrap());
    for letter in ["D", "S", "G", "T", "R", "M"] {
        assert!(estimate["components"][letter]["rays"].as_f64().is_some(), "{letter}");
    }
}
