//! Inputs on which a fuzzer once broke a reader (`fuzz/`), and the seeds that it starts from: none may break it again.

#![allow(clippy::unwrap_used, reason = "a test that cannot start has failed")]

#[allow(unreachable_pub, reason = "a crate of its own elsewhere")]
#[path = "../fuzz/src/lib.rs"]
mod readers;

use std::path::Path;

/// Gives every file of `fuzz/seeds/NAME` and `fuzz/regressions/NAME` to a reader.
fn replay(name: &str, read: fn(&[u8])) {
    let mut files = 0;
    for kind in ["seeds", "regressions"] {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz").join(kind).join(name);
        let Ok(entries) = std::fs::read_dir(folder) else { continue };
        for entry in entries {
            read(&std::fs::read(entry.unwrap().path()).unwrap());
            files += 1;
        }
    }
    assert!(files > 0, "no file for {name}");
}

#[test]
fn scenes() {
    replay("rad", readers::rad);
}

#[test]
fn function_files() {
    replay("cal", readers::cal);
}

#[test]
fn views() {
    replay("view", readers::view);
}

#[test]
fn octrees() {
    replay("octree", readers::octree);
}

#[test]
fn meshes() {
    replay("mesh", readers::mesh);
}

#[test]
fn objects() {
    replay("obj", readers::obj);
}

#[test]
fn crexes() {
    replay("crex", readers::crex);
}

#[test]
fn rad_input_files() {
    replay("rif", readers::rif);
}

#[test]
fn pictures() {
    replay("picture", readers::picture);
}
