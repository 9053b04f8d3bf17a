//! A study that is another one with some things changed: `extends = "study.toml"`, a file in the same folder.
//!
//! Tables are taken over key by key; anything else, lists too, replaces what the other file has. So a pre-study shows the
//! pictures of its main study without saying again how they are made.

use std::path::Path;

use serde::Deserialize;
use toml::{Table, Value};

use super::{Study, locate, validate};
use crate::error::{Error, Mistake, Result};

/// The name of the file that a study extends, if it extends one.
pub(super) fn base_of(text: &str) -> Option<String> {
    let table: Table = toml::from_str(text).ok()?;
    table.get("extends").map(|base| base.as_str().unwrap_or_default().to_owned())
}

/// Reads a study file that extends `base`.
pub(super) fn read(text: &str, file: &Path, base: &str) -> Result<Study> {
    let wrong = |message: &str, help: &str| Error::Wrong(vec![Mistake::at(file, text, 0, message, help)]);
    if base.is_empty() || base.contains(['/', '\\']) {
        return Err(wrong("`extends` names no file of this folder", "As in `extends = \"study.toml\"`."));
    }
    let base_file = file.with_file_name(base);
    let base_text = std::fs::read_to_string(&base_file).map_err(|source| Error::io("read", &base_file, source))?;
    if base_of(&base_text).is_some() {
        return Err(wrong("the study that is extended extends another one", "Extend that one."));
    }
    Study::parse(&base_text, &base_file)?;
    let parse = |text: &str, file: &Path| {
        toml::from_str::<Table>(text).map_err(|error| {
            let byte = error.span().map_or(0, |span| span.start);
            Error::Wrong(vec![Mistake::at(file, text, byte, error.message(), "")])
        })
    };
    let mut merged = parse(&base_text, &base_file)?;
    let mut own = parse(text, file)?;
    own.remove("extends");
    merge(&mut merged, own);
    let study = Study::deserialize(merged)
        .map_err(|error| wrong(error.message(), &format!("This file was read on top of {base}.")))?;
    let mut mistakes = Vec::new();
    for problem in validate::problems(&study) {
        // What is written here is wrong here; what is not, in the other file.
        let here = locate::byte_of(text, &problem.path);
        let mistake = if here > 0 {
            Mistake::at(file, text, here, problem.message, problem.help)
        } else {
            let there = locate::byte_of(&base_text, &problem.path);
            Mistake::at(&base_file, &base_text, there, problem.message, problem.help)
        };
        mistakes.push(mistake);
    }
    if mistakes.is_empty() { Ok(study) } else { Err(Error::Wrong(mistakes)) }
}

fn merge(below: &mut Table, above: Table) {
    for (key, value) in above {
        match (below.get_mut(&key), value) {
            (Some(Value::Table(below)), Value::Table(above)) => merge(below, above),
            (_, value) => {
                below.insert(key, value);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn beside_the_shipped_study(text: &str) -> Result<Study> {
        let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("corridor/study.toml");
        let folder = tempfile::tempdir().unwrap();
        std::fs::copy(shipped, folder.path().join("study.toml")).unwrap();
        let file = folder.path().join("other.toml");
        std::fs::write(&file, text).unwrap();
        Study::load(&file)
    }

    #[test]
    fn what_is_not_said_is_as_in_the_other_study() {
        let text = "extends = \"study.toml\"\nid = \"other\"\n[timing]\ngap_s = 2.0\n\
                    [[arms]]\nname = \"HQ/LQ\"\nqualities = [\"HQ\", \"LQ\"]\nn = 8\n";
        let study = beside_the_shipped_study(text).unwrap();
        assert_eq!((study.id.as_str(), study.timing.gap_s, study.timing.interval_s), ("other", 2.0, 6.0));
        assert_eq!(study.arms.len(), 1);
        assert!(study.layouts.len() > 1 && !study.wording.worse.is_empty());
    }

    #[test]
    fn mistakes_are_reported_in_the_file_that_has_them() {
        let said = |text: &str| beside_the_shipped_study(text).unwrap_err().to_string();
        let late = said("extends = \"study.toml\"\n[timing]\ngap_s = -1.0\n");
        assert!(late.contains("other.toml:3:"), "{late}");
        assert!(said("extends = \"study.toml\"\nsede = 1\n").contains("sede"));
        assert!(said("extends = \"../study.toml\"\n").contains("no file of this folder"));
        assert!(said("extends = \"other.toml\"\n").contains("extends another"));
        let free = said(
            "extends = \"study.toml\"\n[[arms]]\nname = \"f\"\nqualities = [\"HQ\", \"LQ\"]\nn = 8\nviewing = \"free\"\n",
        );
        assert!(free.contains("other.toml:6:") && free.contains("wording.free"), "{free}");
    }
}
