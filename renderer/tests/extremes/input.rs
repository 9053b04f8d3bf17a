//! Numbers that are none, and texts that ask for more than there is.

use renderer::crex;
use renderer::rad::{self, MemoryFiles, Options, Source, ViewSpec};
use renderer::scene::Scene;

use crate::look::scene;
use crate::table::{Case, Row, group};

/// A scene text that is refused.
fn refused(words: &str, text: &str) -> Row {
    Row::message(words, scene(text).map(|_| ()))
}

/// A sphere whose radius is written so.
fn radius(word: &str) -> Row {
    let text = format!("void plastic p 0 0 5 1 1 1 0 0\np sphere s 0 0 4 0 0 0 {word}\n");
    refused(if word.contains("e4") { "beyond the range of a number" } else { "number" }, &text)
}

fn plastic(reals: &str, words: &str) -> Row {
    refused(words, &format!("void plastic p 0 0 5 {reals}\np sphere s 0 0 4 0 0 0 1\n"))
}

/// A text whose commands and instances read these files.
fn reading(words: &str, text: &str, files: &[(&str, &str)]) -> Row {
    let files = files.iter().fold(MemoryFiles::new(), |files, &(name, text)| files.with(name, text));
    let read = rad::read(&[Source::new("scene.rad", text)], &files, &Options::default());
    let built = read.and_then(|document| Scene::from_rad_with(&document, &files));
    Row::message(words, built.map(|_| ()).map_err(|errors| errors[0].to_string()))
}

fn view(text: &str) -> Row {
    let read = ViewSpec::default().take_header("a.vf", text);
    Row::message("no finite number", read.map(|_| ()).map_err(|errors| errors[0].to_string()))
}

fn language(words: &str, text: &str) -> Row {
    let parsed = crex::parse(text);
    Row::message(words, parsed.map(|_| ()).map_err(|errors| errors[0].message()))
}

const PAINT: &str = "void plastic p 0 0 5 1 1 1 0 0\n";

fn command(words: &str, line: &str) -> Row {
    reading(words, &format!("{PAINT}!{line}\n"), &[("unit.rad", "p sphere s 0 0 4 0 0 0 1\n")])
}

pub(crate) fn cases() -> Vec<Case> {
    group(
        "input",
        &[
            ("nan", || radius("nan")),
            ("-inf", || radius("-inf")),
            ("infinity", || radius("infinity")),
            ("1e400", || radius("1e400")),
            ("-1e400", || radius("-1e400")),
            ("0x10", || radius("0x10")),
            ("1e-400 is 0", || {
                let text = format!("{PAINT}p sphere s 0 0 4 0 0 0 1e-400\n");
                let warnings = scene(&text).unwrap().warnings;
                Row::message("radius is zero", Err(warnings[0].message.clone()))
            }),
            ("a coordinate of 1e76", || refused("at most 1e75", &format!("{PAINT}p sphere s 0 0 4 0 0 1e76 1\n"))),
            ("a colour of 1e31", || plastic("1e31 1 1 0 0", "from 0 to 1e30")),
            ("a colour of -1e-9", || plastic("-1e-9 1 1 0 0", "from 0 to 1e30")),
            ("a specularity of 1.0000001", || plastic("1 1 1 1.0000001 0", "from 0 to 1")),
            ("an index of 0", || {
                refused("from 0.001 to 1000", "void dielectric d 0 0 5 1 1 1 0 0\nd sphere s 0 0 4 0 0 0 1\n")
            }),
            ("an index of 1e200", || {
                refused("from 0.001 to 1000", "void dielectric d 0 0 5 1 1 1 1e200 0\nd sphere s 0 0 4 0 0 0 1\n")
            }),
            ("a source of 361 degrees", || {
                refused("expected 0 to 360", "void glow g 0 0 4 1 1 1 0\ng source s 0 0 4 0 0 1 361\n")
            }),
            ("nan in a view", || view("VIEW= -vp 0 nan 0\n")),
            ("1e400 in a view", || view("rpict -vh 1e400\n")),
            ("inf in a transform", || command("`-t` wants 3 numbers", "xform -t inf 0 0 unit.rad")),
            ("a transform beyond all numbers", || command("beyond the range", "xform -s 1e200 -s 1e200 unit.rad")),
            ("an array of 10^12", || command("1000000000000 primitives", "xform -a 1000000000000 -t 1 0 0 unit.rad")),
            ("arrays of 10^6 in each other, 4 deep", || {
                let nested = ["-a 1000000 -t 1 0 0"; 4].join(" ");
                command("far too many primitives", &format!("xform {nested} unit.rad"))
            }),
            ("a file that reads itself", || {
                reading(
                    "a file cannot read itself",
                    "!cat a.rad\n",
                    &[("a.rad", "!xform b.rad\n"), ("b.rad", "!cat a.rad\n")],
                )
            }),
            ("files that double each other, 60 deep", || {
                let names: Vec<String> = (0..=60).map(|i| format!("f{i}.rad")).collect();
                let texts: Vec<String> = (0..60).map(|i| format!("!cat f{0}.rad f{0}.rad\n", i + 1)).collect();
                let last = "void sphere s 0 0 4 0 0 0 1\n".to_owned();
                let texts: Vec<&str> = texts.iter().chain([&last]).map(String::as_str).collect();
                let files: Vec<(&str, &str)> = names.iter().map(String::as_str).zip(texts).collect();
                reading("more than the limit", "!cat f0.rad\n", &files)
            }),
            ("an alias of itself", || refused("`a`", "void alias a a\n")),
            ("two aliases of each other", || refused("`b`", "void alias a b\nvoid alias b a\n")),
            ("an instance that holds itself", || {
                reading(
                    "an instance of itself",
                    "void instance i 1 a.rad 0 0\n",
                    &[("a.rad", "void instance i 1 b.rad 0 0\n"), ("b.rad", "void instance i 1 a.rad 0 0\n")],
                )
            }),
            ("gensurf of 10^6 x 10^6", || command("more than 4000000", "gensurf p s 's' 't' '0' 1000000 1000000")),
            ("genrev of 10^12 segments", || command("from 1 to", "genrev p r 't' '1' 1e12")),
            ("genworm of 10^12 segments", || command("from 1 to", "genworm p w 't' '0' '0' '.1' 1e12")),
            ("gensurf of a function without end", || {
                command("deeper than", "gensurf p s 's' 't' 'f(s)' 9 9 -e 'f(x)=f(x+1)'")
            }),
            ("gensurf of a function that takes 10^6 steps", || {
                command("too many", "gensurf p s 's' 't' 'f(17)' 900 900 -e 'f(n)=if(n-1.5,f(n-1)+f(n-2),1)'")
            }),
            ("a sum that overflows in a function", || {
                command("leave the range of numbers", "genrev p r '1e300*t' '10^300*10^300' 3")
            }),
            ("a crex of 10^6 brackets", || {
                language("deep", &format!("{}T{}", "(".repeat(1_000_000), ")".repeat(1_000_000)))
            }),
            ("a crex that repeats 10^30 times", || language("is over 4294967295", "T1000000000000000000000000000000")),
            ("an octree that counts 32767 arguments and ends", || {
                let mut bytes = b"#?RADIANCE\nFORMAT=Radiance_octree\n\n".to_vec();
                bytes.extend([1, 31]);
                bytes.extend(b"0\x000\x000\x001\x00\x00");
                // No objects yet, an empty tree, one type; then a polygon of void, its name, no strings, and the count.
                bytes.extend([0, 0, 0, 0, 0]);
                bytes.extend(b"polygon\x00\x00\x00\xff\xff\xff\xffname\x00\x00\x00\x7f\xff");
                let read = rad::read_octree(&Source::new("a.oct", bytes), &MemoryFiles::new(), &Options::default());
                Row::message(
                    "the file cannot hold 32767 real arguments",
                    read.map(|_| ()).map_err(|errors| errors[0].to_string()),
                )
            }),
        ],
    )
}
