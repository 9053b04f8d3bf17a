//! Reports keep to `report.schema.json`, and the schema names every key that a report has.

use analysis::proportion::Proportion;
use analysis::report::{self, Options};
use analysis::tally::ArmTally;
use serde_json::Value;

use crate::logs::{paper, write};
use crate::reports::plan;

/// What of a value does not fit a schema: the few keywords of JSON Schema 2020-12 that the file uses, with every key that a
/// schema with `properties` does not name counted as a misfit, so that the file stays complete.
fn misfits(root: &Value, schema: &Value, value: &Value, path: &str, found: &mut Vec<String>) {
    if let Some(reference) = schema["$ref"].as_str() {
        let schema = root.pointer(reference.trim_start_matches('#')).unwrap();
        return misfits(root, schema, value, path, found);
    }
    if let Some(words) = schema["enum"].as_array()
        && !words.contains(value)
    {
        found.push(format!("{path}: {value} is none of {words:?}"));
    }
    let kind = match value {
        Value::Null => "null",
        Value::Bool(_) => "boolean",
        Value::Number(number) if number.is_f64() => "number",
        Value::Number(_) => "integer",
        Value::String(_) => "string",
        Value::Array(_) => "array",
        Value::Object(_) => "object",
    };
    let fits = |kinds: &str| kinds == kind || (kinds == "number" && kind == "integer");
    let allowed = match &schema["type"] {
        Value::String(name) => fits(name),
        Value::Array(names) => names.iter().filter_map(Value::as_str).any(fits),
        _ => true,
    };
    if !allowed {
        found.push(format!("{path}: {kind}, expected {}", schema["type"]));
    }
    if let (Some(fields), Some(properties)) = (value.as_object(), schema["properties"].as_object()) {
        for name in schema["required"].as_array().into_iter().flatten().filter_map(Value::as_str) {
            if !fields.contains_key(name) {
                found.push(format!("{path}.{name} is missing"));
            }
        }
        for (name, value) in fields {
            match properties.get(name) {
                Some(schema) => misfits(root, schema, value, &format!("{path}.{name}"), found),
                None if path.contains("layout_chosen") && (name == "layout" || name == "other") => {}
                None => found.push(format!("{path}.{name} is not in the schema")),
            }
        }
    }
    if let (Some(items), Some(schema)) = (value.as_array(), schema.get("items")) {
        items.iter().enumerate().for_each(|(i, value)| misfits(root, schema, value, &format!("{path}[{i}]"), found));
    }
}

fn check(report: &report::Report) {
    let schema: Value = serde_json::from_str(include_str!("../../report.schema.json")).unwrap();
    let value: Value = serde_json::from_str(&report.to_json()).unwrap();
    let mut found = Vec::new();
    misfits(&schema, &schema, &value, "", &mut found);
    assert!(found.is_empty(), "{}", found.join("\n"));
}

#[test]
fn reports_of_logs_fit() {
    let folder = tempfile::tempdir().unwrap();
    let mut rows = paper();
    rows[3].interrupted = true;
    let log = write(folder.path(), "log.csv", &rows);
    for plan in [None, Some(plan())] {
        check(&report::of_logs(std::slice::from_ref(&log), &Options { plan, ..Options::default() }).unwrap());
    }
}

#[test]
fn reports_of_counts_fit_at_every_extreme() {
    for (k, n) in [(0, 0), (0, 1), (1, 1), (0, 16), (9, 16), (16, 16), (0, 1_000_000), (500_000_001, 1_000_000_000)] {
        let arms = [
            ("told".to_owned(), ArmTally::of_correct(Proportion { k, n })),
            ("alike".to_owned(), ArmTally::of_second_chosen(Proportion { k, n })),
        ];
        for plan in [None, Some(plan())] {
            check(&report::of_counts(&arms, Vec::new(), &Options { plan, ..Options::default() }));
        }
    }
}

#[test]
fn reports_of_ladders_fit() {
    let ladders = crate::sentences::ladders();
    assert!(ladders.iter().all(|report| report.ladder.is_some()));
    ladders.iter().for_each(check);
}

#[test]
fn the_check_itself_finds_what_is_wrong() {
    let schema: Value = serde_json::from_str(include_str!("../../report.schema.json")).unwrap();
    let mut found = Vec::new();
    let wrong = serde_json::json!({"simulated": 1, "arms": [{"verdict": {"finding": "maybe"}}], "extra": 0});
    misfits(&schema, &schema, &wrong, "", &mut found);
    for part in [".simulated: integer", ".demo is missing", ".extra is not in", ".finding: \"maybe\" is none of"] {
        assert!(found.iter().any(|said| said.contains(part)), "{part}: {found:?}");
    }
}
