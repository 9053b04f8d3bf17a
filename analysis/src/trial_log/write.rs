//! Rows to bytes. The caller owns the file: it writes, flushes and syncs when it must.

use super::Trial;

/// The header line of a log, with its line end.
#[must_use]
pub fn header_line() -> String {
    let names: Vec<&str> = super::COLUMNS.iter().map(|column| column.name).collect();
    names.join(",") + "\n"
}

/// One trial as a line of the log, with its line end. Numbers are written so that they read back to the same bits.
#[must_use]
pub fn row_line(trial: &Trial) -> String {
    let mut writer = csv::WriterBuilder::new().has_headers(false).from_writer(Vec::new());
    writer.serialize(trial).expect("a trial is a flat record of plain values");
    let bytes = writer.into_inner().expect("writing to memory cannot fail");
    String::from_utf8(bytes).expect("a record of UTF-8 fields is UTF-8")
}
