//! Every number of every arm as a table for other programs.

use serde_json::Value;

use super::Report;

pub(super) fn write(report: &Report) -> String {
    let mut out = csv::Writer::from_writer(Vec::new());
    let mut row = |table: &str, arm: &str, quantity: &str, value: &str| {
        out.write_record([table, arm, quantity, value]).expect("writing to memory cannot fail");
    };
    row("table", "arm", "quantity", "value");
    for (table, arms) in [("analysed", &report.arms), ("without exclusions", &report.without_exclusions)] {
        for arm in arms {
            let value = serde_json::to_value(arm).expect("an arm is names and numbers");
            flatten("", &value, &mut |quantity, value| row(table, &arm.arm, quantity, value));
        }
    }
    for contrast in &report.contrasts {
        let value = serde_json::to_value(contrast).expect("a contrast is names and numbers");
        let name = format!("{} - {}", contrast.first, contrast.second);
        flatten("", &value, &mut |quantity, value| row("contrasts", &name, quantity, value));
    }
    let bytes = out.into_inner().expect("writing to memory cannot fail");
    String::from_utf8(bytes).expect("a record of UTF-8 fields is UTF-8")
}

/// Numbers and truths under their paths; words stay in the other formats.
fn flatten(path: &str, value: &Value, row: &mut impl FnMut(&str, &str)) {
    let below = |name: &str| if path.is_empty() { name.to_owned() } else { format!("{path}.{name}") };
    match value {
        Value::Object(fields) => fields.iter().for_each(|(name, value)| flatten(&below(name), value, row)),
        Value::Array(items) => {
            items.iter().enumerate().for_each(|(i, value)| flatten(&below(&i.to_string()), value, row))
        }
        Value::Number(number) => row(path, &number.to_string()),
        Value::Bool(truth) => row(path, &truth.to_string()),
        Value::Null | Value::String(_) => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_stand_under_their_paths() {
        let mut rows = Vec::new();
        let value = serde_json::json!({"a": {"p": 0.5, "word": "x"}, "b": [1, true], "none": null});
        flatten("", &value, &mut |path, value| rows.push(format!("{path}={value}")));
        assert_eq!(rows, ["a.p=0.5", "b.0=1", "b.1=true"]);
    }
}
