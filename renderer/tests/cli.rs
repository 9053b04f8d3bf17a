//! The program `crex` from outside: exit codes, what goes to which stream, what messages say.

#![allow(clippy::unwrap_used, reason = "a test that cannot start has failed")]

use std::path::Path;
use std::process::{Command, Output, Stdio};

use renderer::picture::{self, Compression, Picture, Provenance, Quantity};
use renderer::raster::Raster;
use serde_json::Value;

/// A display file.
const DISPLAY: &str =
    "peak_cd_m2 = 250\nblack_cd_m2 = 0.5\nwidth_px = 1280\nheight_px = 1024\nwidth_m = 0.3372\ndistance_m = 0.6\n";

fn crex(words: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_crex")).args(words).stdin(Stdio::null()).output().unwrap()
}

fn code(output: &Output) -> i32 {
    output.status.code().unwrap()
}

fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

fn json(output: &Output) -> Value {
    let text = std::str::from_utf8(&output.stdout).unwrap();
    assert_eq!(text.lines().count(), 1, "one object and nothing else: {text}\n{}", stderr(output));
    serde_json::from_str(text).unwrap()
}

fn grey(path: &Path, height: usize, values: &[f32]) {
    let pixels = values.iter().map(|&value| [value; 3]).collect();
    let beauty = Raster::from_values(values.len() / height, height, pixels).unwrap();
    let made = Picture { quantity: Quantity::Radiance, beauty, layers: vec![], provenance: Provenance::default() };
    picture::write(path, &made, Compression::Zip).unwrap();
}

#[test]
fn a_wrong_command_line_is_exit_2_and_help_exit_0() {
    for words in [&["nonsense"][..], &["plan"], &["compare", "a.exr"], &["plan", "T", "--nonsense"], &[]] {
        let output = crex(words);
        assert_eq!(code(&output), 2, "{words:?}");
        assert!(output.stdout.is_empty());
    }
    for words in [["--help"], ["--version"]] {
        let output = crex(&words);
        assert_eq!(code(&output), 0);
        assert!(output.stderr.is_empty());
    }
}

#[test]
fn plan_gives_the_contracts_tree() {
    let output = crex(&["plan", "T{R2<S>}*", "--json"]);
    assert_eq!(code(&output), 0);
    let expected = serde_json::json!({"sequence": [
        {"component": "T"},
        {"repeat": "*", "item": {"group": "{}", "items": [
            {"repeat": 2, "item": {"component": "R"}},
            {"group": "<>", "items": [{"component": "S"}]},
        ]}},
    ]});
    let plan = json(&output);
    assert_eq!(plan["tree"], expected);
    assert_eq!((&plan["valid"], &plan["crex"]), (&Value::Bool(true), &Value::from("T{R2<S>}*")));
}

#[test]
fn plan_says_what_scenes_can_spawn() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("a.rad");
    std::fs::write(&scene, "void glass pane 0 0 3 .9 .9 .9\npane sphere s 0 0 4 0 0 0 1\n").unwrap();
    let output = crex(&["plan", "TD", scene.to_str().unwrap(), "--json"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let plan = json(&output);
    assert_eq!(plan["components"], serde_json::json!(["T", "R"]));
    assert!(plan["warnings"][0].as_str().unwrap().contains("spawns D"), "{plan}");
    let words = crex(&["plan", "TD", scene.to_str().unwrap()]);
    assert!(String::from_utf8(words.stdout).unwrap().contains("can spawn T R; no material spawns D S G M"));
}

#[test]
fn plan_tells_errors_with_their_bytes_and_exits_2() {
    let output = crex(&["plan", "T(R", "--json"]);
    assert_eq!(code(&output), 2);
    let plan = json(&output);
    assert_eq!((&plan["valid"], &plan["tree"]), (&Value::Bool(false), &Value::Null));
    assert_eq!(plan["errors"][0]["start"], 1);
    let output = crex(&["plan", "T(R"]);
    assert_eq!(code(&output), 2);
    assert!(output.stdout.is_empty());
    assert!(stderr(&output).contains('^'), "{}", stderr(&output));
}

#[test]
fn compare_gives_the_contracts_object() {
    let folder = tempfile::tempdir().unwrap();
    let (a, b) = (folder.path().join("a.exr"), folder.path().join("b.exr"));
    grey(&a, 2, &[1.0, 3.0, 1.0, 3.0]);
    grey(&b, 2, &[2.0, 3.0, 2.0, 3.0]);
    let (a, b) = (a.to_str().unwrap(), b.to_str().unwrap());
    let output = crex(&["compare", a, b, "--json"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let report = json(&output);
    let near = |key: &str, value: f64| assert!((report[key].as_f64().unwrap() - value).abs() < 1e-7, "{key}: {report}");
    near("rmse", 0.5f64.sqrt());
    near("rel_mse", 0.5 / 1.04);
    near("mean_ratio", 1.25);
    near("max_abs", 1.0);
    assert_eq!(
        (&report["identical"], &report["flip"], &report["jod"]),
        (&Value::Bool(false), &Value::Null, &Value::Null)
    );
    assert_eq!((&report["width"], &report["height"]), (&Value::from(2), &Value::from(2)));
    assert_eq!(json(&crex(&["compare", a, a, "--json"]))["identical"], true);
}

#[test]
fn compare_sees_as_people_do_on_a_display() {
    let folder = tempfile::tempdir().unwrap();
    let (a, b, display) =
        (folder.path().join("a.exr"), folder.path().join("b.exr"), folder.path().join("display.toml"));
    let values = |bump: f32| (0..64 * 64).map(|i| 0.5 + bump * f32::from(i % 64 / 8 % 2 == 0)).collect::<Vec<f32>>();
    grey(&a, 64, &values(0.0));
    grey(&b, 64, &values(0.2));
    std::fs::write(&display, DISPLAY).unwrap();
    let (a, b, display) = (a.to_str().unwrap(), b.to_str().unwrap(), display.to_str().unwrap());
    let same = json(&crex(&["compare", a, a, "--json", "--display", display]));
    assert_eq!((same["flip"].as_f64().unwrap(), same["jod"].as_f64().unwrap()), (0.0, 10.0));
    let differs = json(&crex(&["compare", a, b, "--json", "--display", display]));
    assert!(differs["flip"].as_f64().unwrap() > 0.02, "{differs}");
    assert!(differs["jod"].as_f64().unwrap() < 9.5, "{differs}");
}

#[test]
fn compare_judges_a_part_by_itself_and_shows_where_the_two_differ() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    for (name, right) in [("a.exr", 0.4), ("b.exr", 0.2)] {
        let values: Vec<f32> = (0..64 * 64).map(|i| if i % 64 < 32 { 0.4 } else { right }).collect();
        grey(Path::new(&path(name)), 64, &values);
    }
    let map = (0..32 * 32).map(|i| if i % 32 < 8 { 1.0 } else { 0.25 }).collect();
    let map = Raster::from_values(32, 32, map).unwrap();
    picture::grey::write(Path::new(&path("map.png")), &map, picture::grey::Bits::Eight, &Provenance::default())
        .unwrap();
    std::fs::write(path("display.toml"), DISPLAY).unwrap();
    let (a, b, display, map) = (path("a.exr"), path("b.exr"), path("display.toml"), path("map.png"));
    let words = ["compare", &a, &b, "--json", "--display", &display, "--map", &map, "--difference", &path("where.png")];
    let output = crex(&words);
    let report = json(&output);
    let number = |value: &serde_json::Value| value.as_f64().unwrap();
    assert_eq!(number(&report["region"]["share"]), 0.25);
    assert_eq!(
        (number(&report["region"]["jod"]), number(&report["region"]["flip"])),
        (10.0, 0.0),
        "the left quarter is alike"
    );
    assert!(number(&report["jod"]) < 9.5, "{report}");
    assert!(String::from_utf8_lossy(&output.stderr).contains("map.png has 32 x 32 pixels, the pictures 64 x 64"));
    let shown = picture::read(Path::new(&path("where.png"))).unwrap().beauty;
    let light = |x: usize| shown.at(x, 20).iter().sum::<f32>();
    assert!(light(50) > 2.0 * light(5), "bright where they differ: {} {}", light(50), light(5));
    let all = json(&crex(&["compare", &a, &b, "--json", "--display", &display, "--map", &map, "--at-least", "0.2"]));
    assert!((number(&all["region"]["jod"]) - number(&all["jod"])).abs() < 1e-5);
    let none = crex(&["compare", &a, &b, "--display", &display, "--map", &map, "--at-least", "2"]);
    assert_eq!(none.status.code(), Some(2));
    assert_eq!(crex(&["compare", &a, &b, "--map", &map]).status.code(), Some(2), "a region is judged on a display");
}

#[test]
fn compare_refuses_what_it_cannot_compare() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    grey(Path::new(&path("a.exr")), 2, &[1.0; 4]);
    grey(Path::new(&path("wide.exr")), 2, &[1.0; 8]);
    grey(Path::new(&path("a.png")), 2, &[1.0; 4]);
    std::fs::write(path("text.exr"), "not a picture").unwrap();
    for (other, word) in [
        ("wide.exr", "2 x 2 pixels, the picture 4 x 2"),
        ("a.png", "compare two of a kind"),
        ("text.exr", "is not a picture"),
        ("missing.exr", "cannot be read"),
    ] {
        let output = crex(&["compare", &path("a.exr"), &path(other)]);
        assert_eq!(code(&output), 2, "{other}");
        assert!(output.stdout.is_empty());
        assert!(stderr(&output).contains(word), "{}", stderr(&output));
    }
}

#[test]
fn a_place_that_cannot_be_written_to_is_found_before_rendering() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).display().to_string();
    std::fs::write(path("ball.rad"), "void plastic grey 0 0 5 .5 .5 .5 0 0\ngrey sphere ball 0 0 4 0 5 0 1\n").unwrap();
    std::fs::create_dir(path("taken")).unwrap();
    let (scene, picture) = (path("ball.rad"), path("a.png"));
    let words = ["render", &scene, "-vp", "0", "0", "0", "-x", "8", "-y", "8", "--crex", "T", "-o", &picture];
    for (option, name) in [
        ("--profile", "taken"),
        ("--profile", "missing/costs.json"),
        ("--stats", "taken"),
        ("--stats", "missing/stats.json"),
        ("-o", "missing/b.png"),
    ] {
        let place = path(name);
        let output = crex(&[&words[..], &["--time", "0.1", option, &place]].concat());
        assert_eq!(code(&output), 1, "{option} {name}: {}", stderr(&output));
        assert!(stderr(&output).contains(&place), "{}", stderr(&output));
        let names = std::fs::read_dir(folder.path()).unwrap().count();
        assert_eq!(names, 2, "nothing was rendered for {option} {name}, and nothing is left");
    }
}

#[test]
fn a_chosen_crex_is_recorded_and_replayed_without_choosing() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).display().to_string();
    let room = "void light lamp 0 0 3 9 9 9\nlamp sphere sun 0 0 4 0 1 1.5 .2\nvoid plastic grey 0 0 5 .5 .5 .5 0 0\n\
                grey sphere shell 0 0 4 0 0 0 4\nvoid mirror silver 0 0 3 .9 .9 .9\n\
                silver polygon m 0 0 12 -1 3 -1 1 3 -1 1 3 1 -1 3 1\n";
    std::fs::write(path("room.rad"), room).unwrap();
    let scene = path("room.rad");
    let words =
        ["render", &scene, "-vp", "0", "0", "0", "-vd", "0", "1", "0", "-x", "24", "-y", "24", "--crex", "auto"];
    let (first, again, stats) = (path("a.exr"), path("b.exr"), path("stats.json"));
    let output = crex(&[&words[..], &["--time", "0.5", "--stats", &stats, "-o", &first]].concat());
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let recorded: Value = serde_json::from_str(&std::fs::read_to_string(&stats).unwrap()).unwrap();
    let chosen = recorded["crex"].as_str().unwrap();
    renderer::crex::compile(chosen).unwrap();
    assert!(stderr(&output).contains(&format!("\"{chosen}\"")), "{}", stderr(&output));
    for crex_given in ["auto", chosen] {
        let words = [&words[..words.len() - 1], &[crex_given, "--replay", &stats, "-o", &again]].concat();
        let output = crex(&words);
        assert_eq!(code(&output), 0, "{}", stderr(&output));
        assert!(!stderr(&output).contains("looked at"), "{}", stderr(&output));
        let [one, other] = [&first, &again].map(|name| picture::read(Path::new(name)).unwrap());
        assert_eq!((one.beauty, one.layers), (other.beauty, other.layers));
    }
    // Without a time there is nothing to choose for.
    let output = crex(&[&words[..], &["-o", &again]].concat());
    assert_eq!(code(&output), 2);
    assert!(stderr(&output).contains("--time"), "{}", stderr(&output));
}
