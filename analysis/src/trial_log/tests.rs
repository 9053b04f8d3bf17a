//! Rows go out and come back; broken logs say where and why.

use std::path::Path;

use proptest::prelude::*;

use super::*;

fn sample() -> Trial {
    Trial {
        study: "corridor".into(),
        session_id: "s01".into(),
        participant: "p01".into(),
        arm: "HQ/CBQ".into(),
        phase: Phase::Critical,
        trial: 3,
        first_stimulus: "a-hq".into(),
        second_stimulus: "b-cbq".into(),
        first_layout: "a".into(),
        second_layout: "b".into(),
        first_quality: "HQ".into(),
        second_quality: "CBQ".into(),
        first_count: Some(11),
        second_count: Some(9),
        first_count_answer: Some(10),
        second_count_answer: Some(9),
        worse_answer: Some(Interval::Second),
        correct: Some(true),
        confidence: Some(2),
        rt_s: Some(2.25),
        first_onset_s: Some(12.5),
        first_duration_s: Some(6.0001),
        second_onset_s: Some(19.5),
        second_duration_s: Some(5.9999),
        onset_source: OnsetSource::SwapReturn,
        first_missed_frames: Some(0),
        first_max_frame_ms: Some(16.7),
        second_missed_frames: Some(1),
        second_max_frame_ms: Some(33.4),
        refresh_hz: Some(60.0),
        vsync: Vsync::Verified,
        seed: u64::MAX,
        plan_hash: "ab".repeat(32),
        stimuli_hash: "01".repeat(32),
        version: "0.1.0".into(),
        started_utc: "2005-11-29T09:30:00Z".into(),
        ..Trial::default()
    }
}

fn read(text: impl AsRef<[u8]>) -> Result<Vec<Trial>, String> {
    let mut reader = Reader::new(text.as_ref(), Path::new("log.csv")).map_err(|error| error.to_string())?;
    let mut rows = Vec::new();
    let mut row = Trial::default();
    while reader.read_into(&mut row).map_err(|error| error.to_string())? {
        rows.push(row.clone());
    }
    Ok(rows)
}

/// A log of two rows, whose second row has `column` set to `text`.
fn log_with(column_name: &str, text: &str) -> String {
    let row = row_line(&sample());
    let mut fields: Vec<&str> = row.trim_end().split(',').collect();
    fields[column(column_name).expect("a column")] = text;
    header_line() + &row + &fields.join(",") + "\n"
}

#[test]
fn the_columns_are_the_contract_in_order() {
    let contract = "study, session_id, participant, arm, simulated, phase, trial, first_stimulus, second_stimulus, \
        first_layout, second_layout, first_quality, second_quality, first_count, second_count, first_count_answer, \
        second_count_answer, worse_answer, correct, confidence, rt_s, first_onset_s, first_duration_s, \
        second_onset_s, second_duration_s, onset_source, first_missed_frames, first_max_frame_ms, \
        second_missed_frames, second_max_frame_ms, refresh_hz, vsync, interrupted, interrupt_reason, resume_gap_s, \
        known_task, seed, plan_hash, stimuli_hash, version, started_utc";
    let names: Vec<&str> = COLUMNS.iter().map(|column| column.name).take(41).collect();
    assert_eq!(names.join(", "), contract);
}

#[test]
fn the_header_names_the_fields_of_a_row_in_order() {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.serialize(sample()).unwrap();
    let text = String::from_utf8(writer.into_inner().unwrap()).unwrap();
    assert_eq!(text, header_line() + &row_line(&sample()));
}

#[test]
fn a_row_comes_back_as_it_was() {
    assert_eq!(read(header_line() + &row_line(&sample())).unwrap(), [sample()]);
}

#[test]
fn empty_is_none_and_not_zero() {
    let row = Trial { correct: None, first_count: None, refresh_hz: None, known_task: None, ..sample() };
    assert_eq!(read(header_line() + &row_line(&row)).unwrap(), [row]);
}

#[test]
fn a_log_without_the_demo_column_is_none() {
    let text = (header_line() + &row_line(&sample())).replace(",demo", "").replace("Z,false", "Z");
    assert_eq!(read(text).unwrap(), [sample()]);
}

#[test]
fn moved_columns_and_a_byte_order_mark_do_no_harm() {
    let swap = |line: String| line.trim_end().split(',').rev().collect::<Vec<_>>().join(",") + "\n";
    let text = format!("\u{feff}{}{}", swap(header_line()), swap(row_line(&sample())));
    assert_eq!(read(text).unwrap(), [sample()]);
}

#[test]
fn the_lower_quality_follows_from_the_answer() {
    let row = |answer, correct| Trial { worse_answer: answer, correct, ..sample() };
    assert_eq!(row(Some(Interval::Second), Some(true)).lower_quality(), Some(Interval::Second));
    assert_eq!(row(Some(Interval::Second), Some(false)).lower_quality(), Some(Interval::First));
    assert_eq!(row(Some(Interval::First), None).lower_quality(), None);
    assert_eq!(row(Some(Interval::Second), None).layout_chosen(), Some("b"));
}

#[test]
fn a_wrong_field_is_reported_with_line_and_column() {
    let cases = [
        ("simulated", "ja", "log.csv, line 3, column 5 (simulated): expected true or false, found \"ja\""),
        (
            "phase",
            "",
            "log.csv, line 3, column 6 (phase): expected practice, critical, informed or check, found an empty field",
        ),
        ("trial", "-1", "column 7 (trial): expected a whole number from 0 to 4294967295, found \"-1\""),
        ("worse_answer", "left", "column 18 (worse_answer): expected first or second or nothing, found \"left\""),
        ("first_duration_s", "NaN", "column 23 (first_duration_s): expected a finite number or nothing, found \"NaN\""),
        ("participant", " ", "column 3 (participant): expected a name, found an empty field"),
        (
            "plan_hash",
            "abc",
            "column 38 (plan_hash): expected a SHA-256 of 64 hexadecimal digits, found \"abc\": was the log edited?",
        ),
        (
            "started_utc",
            "yesterday",
            "column 41 (started_utc): expected a moment as 2005-11-29T09:30:00Z, found \"yesterday\"",
        ),
        ("started_utc", "2005-11-29T09:30:00", "column 41 (started_utc)"),
    ];
    for (column, text, message) in cases {
        let error = read(log_with(column, text)).unwrap_err();
        assert!(error.contains(message), "{column}={text}: {error}");
    }
}

#[test]
fn a_missing_or_doubled_column_is_named() {
    let error = read(header_line().replace("simulated,", "")).unwrap_err();
    assert!(
        error.starts_with(
            "log.csv, line 1, column 5 (simulated): the column is missing (true when a simulated observer answered)"
        ),
        "{error}"
    );
    let error = read(header_line().replace("arm,", "study,")).unwrap_err();
    assert!(error.contains("line 1, column 4 (study): the column is there twice"), "{error}");
}

#[test]
fn half_a_row_says_where_it_ends() {
    let text = header_line() + &row_line(&sample());
    let half = &text[..header_line().len() + 36];
    let error = read(half).unwrap_err();
    assert!(error.contains("line 2, column 6 (phase): the row ends here, after 6 of 42 columns"), "{error}");
    // Every cut is noticed, wherever it falls, but for the cut that only takes the line end.
    for cut in header_line().len() + 1..text.len() - 1 {
        assert!(read(&text[..cut]).is_err(), "cut at {cut}");
    }
}

#[test]
fn wrong_encodings_are_named() {
    let text = header_line() + &row_line(&sample());
    let utf16: Vec<u8> = [0xff, 0xfe].into_iter().chain(text.encode_utf16().flat_map(u16::to_le_bytes)).collect();
    assert!(read(utf16).unwrap_err().contains("line 1, column 1: this is UTF-16: save the log as UTF-8"));
    let latin1: Vec<u8> = log_with("participant", "J\u{fc}rg").chars().map(|c| c as u8).collect();
    let error = read(latin1).unwrap_err();
    assert!(error.starts_with("log.csv, line 3, column 3 (participant): not UTF-8"), "{error}");
    assert!(read(text.replace(',', ";")).unwrap_err().contains("semicolons"));
    assert!(read("").unwrap_err().contains("the log is empty"));
}

#[test]
fn the_sidecar_describes_every_column() {
    let json: serde_json::Value =
        serde_json::from_str(&Sidecar::new("l.csv", "corridor", "0.1.0", None).to_json()).unwrap();
    let columns = json["columns"].as_array().unwrap();
    assert_eq!(columns.len(), COLUMNS.len());
    assert!(columns.iter().all(|column| !column["meaning"].as_str().unwrap().is_empty()));
    let timed = columns.iter().filter(|column| column["name"].as_str().unwrap().ends_with("_s"));
    assert!(timed.clone().count() == 6 && timed.clone().all(|column| column["unit"] == "s"));
}

proptest! {
    #[test]
    fn any_text_and_number_survives_the_file(
        name in "[^\\s\u{0}\r\n][^\u{0}]{0,20}", rt in proptest::num::f64::NORMAL, seed: u64, reason in "[^\u{0}]{0,30}"
    ) {
        let row = Trial { participant: name, rt_s: Some(rt), seed, interrupt_reason: reason, ..sample() };
        prop_assert_eq!(read(header_line() + &row_line(&row)).unwrap(), vec![row]);
    }
}
