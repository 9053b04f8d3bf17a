//! `crex auto` and `crex trade` from outside.

#![allow(clippy::unwrap_used, reason = "a test that cannot start has failed")]

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use serde_json::Value;

/// Diffuse walls and a mirror.
const ROOM: &str = "\
void light lamp 0 0 3 20 20 20
void plastic white 0 0 5 .6 .6 .6 0 0
void mirror silver 0 0 3 .8 .8 .8
white bubble shell 0 0 4 0 0 1.5 3
silver polygon m 0 0 12 -1 1.5 .5 1 1.5 .5 1 1.5 2 -1 1.5 2
lamp polygon l 0 0 12 -.5 -1 3 -.5 0 3 .5 0 3 .5 -1 3
";

const VIEW: [&str; 14] = ["-vp", "0", "-1.9", "1.2", "-vd", "0", "1", "-.1", "-vh", "80", "-vv", "60", "-x", "48"];

fn crex(folder: &Path, command: &str, more: &[&str]) -> Output {
    fs::write(folder.join("room.rad"), ROOM).unwrap();
    let words = [&[command, "room.rad"], &VIEW[..], more].concat();
    Command::new(env!("CARGO_BIN_EXE_crex")).args(words).current_dir(folder).env_remove("RAYPATH").output().unwrap()
}

fn json(output: &Output) -> Value {
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

#[test]
fn a_proposal_names_what_the_scene_has() {
    let folder = tempfile::tempdir().unwrap();
    let made = json(&crex(folder.path(), "auto", &["--json", "--spp", "4"]));
    let steps = made["steps"].as_array().unwrap();
    assert_eq!((&steps[0]["crex"], &made["spp"]), (&"".into(), &4.into()));
    let last = steps.last().unwrap();
    assert!(["(MD)*", "(DM)*"].contains(&last["crex"].as_str().unwrap()), "{last}");
    assert_eq!(last["predicted_loss_jod"], 0.0);
    assert!(made["predicted_loss_jod"].as_f64().unwrap() <= 0.2);
    let told = crex(folder.path(), "auto", &[]);
    assert!(told.status.success());
    assert!(String::from_utf8(told.stdout).unwrap().contains("(direct light alone)"));
}

#[test]
fn a_curve_is_written_in_three_forms() {
    let folder = tempfile::tempdir().unwrap();
    let more = ["-o", "c.csv", "-o", "c.json", "-o", "c.svg", "--json", "--spp", "1,2", "--crex", "MD2"];
    let printed = json(&crex(folder.path(), "trade", &more));
    let written: Value = serde_json::from_slice(&fs::read(folder.path().join("c.json")).unwrap()).unwrap();
    assert_eq!(printed, written);
    let points = printed["points"].as_array().unwrap();
    let tried: Vec<_> = points.iter().filter(|point| point["crex"] == "MD2").collect();
    assert_eq!(tried.len(), 2, "what is asked for is tried at each number of samples");
    assert_eq!(printed["reference"]["spp"], 8);
    // The seed decides pictures, and so what the metrics say, in every run.
    let again = json(&crex(folder.path(), "trade", &more));
    let loss = |curve: &Value, spp: u64| {
        let points = curve["points"].as_array().unwrap().iter();
        points.filter(|p| p["crex"] == "MD2" && p["spp"] == spp).map(|p| p["loss_jod"].to_string()).collect::<Vec<_>>()
    };
    assert_eq!((loss(&printed, 1), loss(&printed, 2)), (loss(&again, 1), loss(&again, 2)));
    let table = fs::read_to_string(folder.path().join("c.csv")).unwrap();
    assert_eq!(table.lines().count(), 1 + again["points"].as_array().unwrap().len());
    assert!(fs::read_to_string(folder.path().join("c.svg")).unwrap().starts_with("<svg "));
}

#[test]
fn filters_and_time_limits_are_points_of_the_curve() {
    let folder = tempfile::tempdir().unwrap();
    let more = [
        "--json", "--spp", "1,4", "--crex", "MD", "--filter", "D", "--time", ".05,.2", "--by", "rel-mse", "-o",
        "c.csv", "-o", "c.svg",
    ];
    let curve = json(&crex(folder.path(), "trade", &more));
    let points = curve["points"].as_array().unwrap();
    let of = |filter: &str, timed: bool| -> Vec<&Value> {
        let wanted = |p: &&Value| p["crex"] == "MD" && p["filter"] == filter && p["deadline_s"].is_null() != timed;
        points.iter().filter(wanted).collect()
    };
    assert_eq!(of("", false).len(), 2);
    assert_eq!(of("", true).len(), 2, "each time limit is tried");
    let smoothed = of("D", false);
    assert_eq!(smoothed.len(), 1, "one sample tells no noise");
    let plain = *of("", false).iter().find(|point| point["spp"] == 4).unwrap();
    let noise = |point: &Value| point["rel_mse"].as_f64().unwrap();
    assert!(noise(smoothed[0]) < noise(plain), "smoothing takes noise away: {} of {plain}", smoothed[0]);
    assert!(points.iter().all(|p| p["filter"] == "" || p["crex"].as_str().unwrap().contains('D')));
    // By the loss that is asked for: nothing on the front is beaten in it.
    let front = |p: &&Value| p["front"] == true;
    let (time, loss) = (|p: &Value| p["cpu_s"].as_f64().unwrap(), noise);
    let beaten = |p: &Value| points.iter().any(|q| time(q) <= time(p) && loss(q) < loss(p));
    assert!(points.iter().filter(front).count() > 0 && !points.iter().filter(front).any(beaten));
    let svg = fs::read_to_string(folder.path().join("c.svg")).unwrap();
    assert!(
        svg.contains("relative mean squared error")
            && svg.contains("diamond: planes smoothed")
            && svg.contains("cross: within a time limit")
    );
    let table = fs::read_to_string(folder.path().join("c.csv")).unwrap();
    assert!(table.lines().any(|line| line.starts_with("MD,no,,0.05,4,")), "{table}");
}

#[test]
fn wrong_words_write_nothing() {
    let folder = tempfile::tempdir().unwrap();
    for (command, more, message) in [
        ("trade", &["-o", "c.png"][..], ".csv, .json or .svg"),
        ("trade", &["--spp", "0"], "--spp"),
        ("trade", &["--filter", "Q"], "--filter"),
        ("trade", &["--time", "soon"], "--time"),
        ("trade", &["--crex", "X"], "means nothing in a crex"),
        ("trade", &["--importance", "none.png"], "none.png"),
        ("auto", &["--tolerance", "0"], "--tolerance"),
        ("auto", &["--exposure", "0"], "--exposure"),
        ("auto", &["--display", "none.toml"], "none.toml"),
    ] {
        let output = crex(folder.path(), command, more);
        assert_eq!(output.status.code(), Some(2), "{more:?}: {}", String::from_utf8_lossy(&output.stderr));
        assert!(String::from_utf8_lossy(&output.stderr).contains(message), "{more:?}");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1, "the scene alone");
    }
}
