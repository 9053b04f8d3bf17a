//! Data as a BIDS dataset (Brain Imaging Data Structure, <https://bids-specification.readthedocs.io>): a table of trials and
//! one of onsets for each participant, with the meaning of every column beside it.
//!
//! Nothing is added and nothing judged: rows are the log's, an empty field is `n/a`. A person who withdrew is not in it.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use analysis::trial_log::{COLUMNS, Reader, Trial as Row};
use serde_json::{Map, Value, json};
use stimuli::Study;

use crate::enrol::{DataFolder, VERSION};
use crate::error::{Error, Result};
use crate::log::{Event, read_journal};
use crate::setup::Conditions;
use crate::withdraw::STONE;

/// The version of the structure that is written.
const BIDS_VERSION: &str = "1.10.0";
/// What stands where there is no value.
const NONE: &str = "n/a";

/// Writes the dataset into `to`, a folder that must not be there; gives the number of participants.
///
/// # Errors
/// If `to` is there, a log cannot be read, or two codes differ in `-` and `_` alone, which the structure does not allow in
/// a name.
pub fn export(data: &DataFolder, study: &Study, to: &Path) -> Result<usize> {
    if to.exists() {
        return Err(Error::Input(format!("{} is there already; name another folder", to.display())));
    }
    let beside = PathBuf::from(format!("{}.part-{}", to.display(), std::process::id()));
    let sessions = sessions(data)?;
    let task: String = study.id.chars().filter(char::is_ascii_alphanumeric).collect();
    let written = write_all(&beside, study, data, &task, &sessions).and_then(|()| {
        std::fs::rename(&beside, to).map_err(Error::io("rename", &beside))?;
        Ok(sessions.len())
    });
    if written.is_err() {
        let _rest = std::fs::remove_dir_all(&beside); // the first error is what the reader needs
    }
    written
}

/// What a participant's session left.
struct Session {
    code: String,
    rows: Vec<Row>,
    conditions: Conditions,
    refresh_hz: Option<f64>,
    outcome: String,
}

/// The sessions that have rows, by label.
fn sessions(data: &DataFolder) -> Result<BTreeMap<String, Session>> {
    let folder = data.path().join("sessions");
    let mut found: BTreeMap<String, Session> = BTreeMap::new();
    for entry in std::fs::read_dir(&folder).map_err(Error::io("read the folder", &folder))? {
        let path = entry.map_err(Error::io("read the folder", &folder))?.path();
        let code = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let (log, journal) = (path.join(format!("{code}.csv")), path.join(format!("{code}.events.jsonl")));
        if path.join(STONE).exists() || !log.is_file() || !journal.is_file() {
            continue;
        }
        let (mut reader, mut row, mut rows) = (Reader::open(&log)?, Row::default(), Vec::new());
        while reader.read_into(&mut row)? {
            rows.push(row.clone());
        }
        let (mut conditions, mut outcome) = (Conditions::new(), "broken off".to_owned());
        for line in read_journal(&journal)? {
            match line.event {
                Event::Conditions { conditions: stated } => conditions = stated,
                Event::Ended { outcome: word } => outcome = word,
                _ => {}
            }
        }
        let label: String = code.chars().filter(char::is_ascii_alphanumeric).collect();
        let refresh_hz = rows.first().and_then(|row| row.refresh_hz);
        let session = Session { code: code.clone(), rows, conditions, refresh_hz, outcome };
        if let Some(other) = found.insert(label.clone(), session) {
            let other = other.code;
            return Err(Error::Input(format!(
                "{code} and {other} would both be sub-{label}; rename one before exporting"
            )));
        }
    }
    Ok(found)
}

fn write_all(
    to: &Path,
    study: &Study,
    data: &DataFolder,
    task: &str,
    sessions: &BTreeMap<String, Session>,
) -> Result<()> {
    let simulated = if data.is_simulated() { " (SIMULATED: no person answered)" } else { "" };
    let name = format!("{}{simulated}", study.title);
    write_json(
        &to.join("dataset_description.json"),
        &json!({
            "Name": name,
            "BIDSVersion": BIDS_VERSION,
            "DatasetType": "raw",
            "GeneratedBy": [{ "Name": "crex-session", "Version": VERSION, "Description": "written during the sessions" }],
        }),
    )?;
    let readme = format!(
        "{name}\n\nTwo-interval comparisons of rendered pictures. One critical trial a participant; what came after it has \
         the phase `informed` or `check`. Study {}, plan {}. Written by {VERSION}.\n",
        study.id,
        data.plan().hash()
    );
    write(&to.join("README"), &readme)?;
    let mut participants = String::from("participant_id\tage\tgender\tcode\tarm\toutcome\tsimulated\n");
    for (label, session) in sessions {
        let stated = |name: &str| session.conditions.get(name).cloned().flatten();
        let arm = session.rows.first().map(|row| row.arm.clone());
        let fields = [
            Some(format!("sub-{label}")),
            stated("age_years"),
            stated("gender"),
            Some(session.code.clone()),
            arm,
            Some(session.outcome.clone()),
            Some(data.is_simulated().to_string()),
        ];
        participants.push_str(&line(fields.into_iter().map(|field| field.unwrap_or_default())));
        let file = |what: &str| to.join(format!("sub-{label}/beh/sub-{label}_task-{task}_{what}"));
        write(&file("beh.tsv"), &trials(&session.rows))?;
        write_json(&file("beh.json"), &trials_sidecar(study, task, session))?;
        write(&file("events.tsv"), &events(&session.rows))?;
        write_json(&file("events.json"), &events_sidecar(study, session))?;
    }
    write(&to.join("participants.tsv"), &participants)?;
    write_json(
        &to.join("participants.json"),
        &json!({
            "age": { "Description": "age as it was given", "Units": "year" },
            "gender": { "Description": "gender as it was given; not asked for" },
            "code": { "Description": "the pseudonym in the session's own log" },
            "arm": { "Description": "arm of the study that the participant was allotted to" },
            "outcome": { "Description": "how the session ended: completed, declined, aborted or broken off" },
            "simulated": { "Description": "true when a program answered" },
        }),
    )
}

/// A line of a table. What would break it becomes a space; an empty field `n/a`.
fn line(fields: impl Iterator<Item = String>) -> String {
    let fields: Vec<String> =
        fields
            .map(|field| {
                if field.is_empty() { NONE.to_owned() } else { field.replace(char::is_control, " ").replace('"', "'") }
            })
            .collect();
    fields.join("\t") + "\n"
}

fn trials(rows: &[Row]) -> String {
    let mut text = line(COLUMNS.iter().map(|column| column.name.to_owned()));
    for row in rows {
        let row = serde_json::to_value(row).expect("a row is a flat record of plain values");
        text.push_str(&line(COLUMNS.iter().map(|column| match &row[column.name] {
            Value::Null => String::new(),
            Value::String(word) => word.clone(),
            other => other.to_string(),
        })));
    }
    text
}

/// The onset of each picture and of the first question's answer are all that a program knows of events.
fn events(rows: &[Row]) -> String {
    let mut text = String::from("onset\tduration\ttrial_type\ttrial\tphase\tstimulus\n");
    let number = |value: Option<f64>| value.map(|value| value.to_string()).unwrap_or_default();
    for row in rows {
        let phase = serde_json::to_value(row.phase).expect("a phase is a word");
        for (kind, stimulus, onset_s, duration_s) in [
            ("first_picture", &row.first_stimulus, row.first_onset_s, row.first_duration_s),
            ("second_picture", &row.second_stimulus, row.second_onset_s, row.second_duration_s),
        ] {
            if onset_s.is_some() {
                let phase = phase.as_str().unwrap_or_default().to_owned();
                let fields = [number(onset_s), number(duration_s), kind.to_owned(), row.trial.to_string(), phase];
                text.push_str(&line(fields.into_iter().chain([stimulus.clone()])));
            }
        }
    }
    text
}

fn presentation(study: &Study, session: &Session) -> Value {
    let metres = |name: &str| {
        let stated = session.conditions.get(name).cloned().flatten()?;
        stated.replace(',', ".").parse::<f64>().ok().map(|mm| mm * 1e-3)
    };
    let or_none = |value: Option<Value>| value.unwrap_or_else(|| json!(NONE));
    let width_m = metres("picture_width_mm");
    let display = &study.display;
    let height_m = width_m.map(|width| width * f64::from(display.height_px) / f64::from(display.width_px));
    json!({
        "OperatingSystem": std::env::consts::OS,
        "SoftwareName": "crex-session",
        "SoftwareVersion": VERSION,
        "ScreenDistance": or_none(metres("distance_mm").map(|metres| json!(metres))),
        "ScreenRefreshRate": or_none(session.refresh_hz.map(|hz| json!(hz))),
        "ScreenResolution": [display.width_px, display.height_px],
        "ScreenSize": or_none(width_m.zip(height_m).map(|(width, height)| json!([width, height]))),
        "HeadStabilization": "none",
    })
}

fn trials_sidecar(study: &Study, task: &str, session: &Session) -> Value {
    let mut fields = Map::new();
    let arm = session.rows.first().map_or("", |row| row.arm.as_str());
    let instructions = study.wording.before_trials(study.viewing(arm))[0].trim();
    fields.insert("TaskName".to_owned(), json!(task));
    fields.insert("TaskDescription".to_owned(), json!(study.title));
    fields.insert("Instructions".to_owned(), json!(instructions));
    fields.insert("StimulusPresentation".to_owned(), presentation(study, session));
    for column in &COLUMNS {
        let mut meaning = json!({ "Description": format!("{} ({})", column.meaning, column.values) });
        if !column.unit.is_empty() {
            meaning["Units"] = json!(column.unit);
        }
        fields.insert(column.name.to_owned(), meaning);
    }
    Value::Object(fields)
}

fn events_sidecar(study: &Study, session: &Session) -> Value {
    let mut fields = Map::new();
    fields.insert("StimulusPresentation".to_owned(), presentation(study, session));
    let source = "from the session's start; where it comes from is `onset_source` of the trials' table";
    for (name, meaning) in [
        ("onset", json!({ "Description": source, "Units": "s" })),
        ("duration", json!({ "Description": "how long the picture was shown", "Units": "s" })),
        (
            "trial_type",
            json!({ "Description": "which picture of the pair", "Levels": {
                "first_picture": "the picture shown first", "second_picture": "the picture shown second" } }),
        ),
        ("trial", json!({ "Description": "number of the trial, as in the trials' table" })),
        ("phase", json!({ "Description": "part of the session, as in the trials' table" })),
        ("stimulus", json!({ "Description": "the picture, by the manifest's name" })),
    ] {
        fields.insert(name.to_owned(), meaning);
    }
    Value::Object(fields)
}

fn write_json(path: &Path, value: &Value) -> Result<()> {
    write(path, &format!("{value:#}\n"))
}

fn write(path: &Path, text: &str) -> Result<()> {
    let folder = path.parent().unwrap_or(Path::new("."));
    std::fs::create_dir_all(folder).map_err(Error::io("make the folder", folder))?;
    std::fs::write(path, text).map_err(Error::io("write", path))
}
