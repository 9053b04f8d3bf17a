//! Bytes to rows, in one pass and constant memory.

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use csv::{ByteRecord, ErrorKind, StringRecord};

use super::columns::{COLUMNS, REQUIRED};
use super::field::{any, hash, moment, name, optional, required};
use super::{Error, Place, Trial};

/// Reads a log row by row.
///
/// Columns are found by name, so a spreadsheet that moved them does no harm; further columns are left alone. A byte
/// order mark of UTF-8 is skipped.
pub struct Reader<R> {
    file: PathBuf,
    records: csv::Reader<R>,
    /// Where each of [`COLUMNS`] stands in this log; the last one may be absent.
    places: Vec<Option<usize>>,
    headers: Vec<String>,
    bytes: ByteRecord,
    line: u64,
}

impl Reader<File> {
    /// Opens a log.
    ///
    /// # Errors
    /// When it cannot be read, or its header line is not a log's.
    pub fn open(path: &Path) -> Result<Self, Error> {
        let file = File::open(path).map_err(|source| Error::Io { file: path.to_owned(), source })?;
        Self::new(file, path)
    }
}

impl<R: Read> Reader<R> {
    /// Reads a log from `source`; `file` is its name in errors.
    ///
    /// # Errors
    /// When it cannot be read, or its header line is not a log's.
    pub fn new(source: R, file: &Path) -> Result<Self, Error> {
        let records = csv::ReaderBuilder::new().has_headers(false).buffer_capacity(1 << 18).from_reader(source);
        let mut reader = Self {
            file: file.to_owned(),
            records,
            places: Vec::new(),
            headers: Vec::new(),
            bytes: ByteRecord::new(),
            line: 1,
        };
        reader.read_header()?;
        Ok(reader)
    }

    /// The file's name, as given.
    pub fn file(&self) -> &Path {
        &self.file
    }

    /// The place of the row read last, in the named column.
    #[must_use]
    pub fn place(&self, column: &str) -> Place {
        let index = self.headers.iter().position(|header| header == column);
        let column = index.map(|index| (index + 1, column.to_owned()));
        Place { file: self.file.clone(), line: self.line, column }
    }

    /// Reads the next row into `trial`, whose memory is used again; false at the end of the log.
    ///
    /// # Errors
    /// When the log cannot be read or the row is not one, with file, line and column.
    pub fn read_into(&mut self, trial: &mut Trial) -> Result<bool, Error> {
        match self.records.read_byte_record(&mut self.bytes) {
            Ok(false) => return Ok(false),
            Ok(true) => {}
            Err(error) => return Err(self.csv_error(error)),
        }
        self.line = self.bytes.position().map_or(self.line, csv::Position::line);
        for (index, place) in self.places.iter().enumerate() {
            let Some(place) = *place else { continue };
            let field = self.bytes.get(place).unwrap_or_default();
            let result =
                std::str::from_utf8(field).map_err(|_| not_utf8(field)).and_then(|text| set(trial, index, text));
            if let Err(message) = result {
                return Err(self.content(Some(place), message));
            }
        }
        Ok(true)
    }

    fn read_header(&mut self) -> Result<(), Error> {
        let mut header = ByteRecord::new();
        match self.records.read_byte_record(&mut header) {
            Ok(true) => {}
            Ok(false) => return Err(self.content(Some(0), "the log is empty: expected a header line".to_owned())),
            Err(error) => return Err(self.csv_error(error)),
        }
        if header.get(0).is_some_and(|field| field.starts_with(&[0xff, 0xfe]) || field.starts_with(&[0xfe, 0xff])) {
            return Err(self.content(Some(0), "this is UTF-16: save the log as UTF-8".to_owned()));
        }
        let header = match StringRecord::from_byte_record(header) {
            Ok(header) => header,
            Err(error) => {
                let at = error.utf8_error().field();
                let message = not_utf8(error.into_byte_record().get(at).unwrap_or_default());
                return Err(self.content(Some(at), message));
            }
        };
        self.headers = header.iter().map(|name| name.trim_start_matches('\u{feff}').to_owned()).collect();
        if let [only] = self.headers.as_slice()
            && only.contains(';')
        {
            let message = "fields are set apart by semicolons: expected commas; export the log again as plain CSV";
            self.headers.clear();
            return Err(self.content(Some(0), message.to_owned()));
        }
        for (index, column) in COLUMNS.iter().enumerate() {
            let mut found = (0..self.headers.len()).filter(|&at| self.headers[at] == column.name);
            let place = found.next();
            if let Some(second) = found.next() {
                return Err(self.content(Some(second), "the column is there twice".to_owned()));
            }
            if place.is_none() && index < REQUIRED {
                let message = format!(
                    "the column is missing ({}): a log has the {REQUIRED} columns from `study` to `started_utc`",
                    column.meaning
                );
                let column = Some((index + 1, column.name.to_owned()));
                return Err(Error::Content {
                    place: Place { file: self.file.clone(), line: self.line, column },
                    message,
                });
            }
            self.places.push(place);
        }
        Ok(())
    }

    fn content(&self, column: Option<usize>, message: String) -> Error {
        let column = column.map(|index| (index + 1, self.headers.get(index).cloned().unwrap_or_default()));
        Error::Content { place: Place { file: self.file.clone(), line: self.line, column }, message }
    }

    fn csv_error(&mut self, error: csv::Error) -> Error {
        let line = error.position().map_or(self.line, csv::Position::line);
        self.line = line;
        match error.into_kind() {
            ErrorKind::Io(source) => Error::Io { file: self.file.clone(), source },
            ErrorKind::UnequalLengths { expected_len, len, .. } if len < expected_len => {
                let last = usize::try_from(len).unwrap_or(1).saturating_sub(1);
                let message = format!(
                    "the row ends here, after {len} of {expected_len} columns: was it cut off while it was written? \
                     Its trial was not finished: remove the half row, or resume the session"
                );
                self.content(Some(last), message)
            }
            ErrorKind::UnequalLengths { expected_len, len, .. } => {
                let message = format!("{len} fields, expected {expected_len}: is a comma in a field unquoted?");
                self.content(usize::try_from(expected_len).ok(), message)
            }
            other => self.content(Some(0), format!("not a CSV row: {other:?}")),
        }
    }
}

fn not_utf8(field: &[u8]) -> String {
    let shown = String::from_utf8_lossy(&field[..field.len().min(40)]).into_owned();
    format!("not UTF-8 (near {shown:?}): save the log as UTF-8")
}

/// Puts the text of the column `index` of [`COLUMNS`] where it belongs.
fn set(trial: &mut Trial, index: usize, text: &str) -> Result<(), String> {
    match index {
        0 => name(text, &mut trial.study)?,
        1 => name(text, &mut trial.session_id)?,
        2 => name(text, &mut trial.participant)?,
        3 => name(text, &mut trial.arm)?,
        4 => trial.simulated = required(text)?,
        5 => trial.phase = required(text)?,
        6 => trial.trial = required(text)?,
        7 => name(text, &mut trial.first_stimulus)?,
        8 => name(text, &mut trial.second_stimulus)?,
        9 => any(text, &mut trial.first_layout),
        10 => any(text, &mut trial.second_layout),
        11 => any(text, &mut trial.first_quality),
        12 => any(text, &mut trial.second_quality),
        13 => trial.first_count = optional(text)?,
        14 => trial.second_count = optional(text)?,
        15 => trial.first_count_answer = optional(text)?,
        16 => trial.second_count_answer = optional(text)?,
        17 => trial.worse_answer = optional(text)?,
        18 => trial.correct = optional(text)?,
        19 => trial.confidence = optional(text)?,
        20 => trial.rt_s = optional(text)?,
        21 => trial.first_onset_s = optional(text)?,
        22 => trial.first_duration_s = optional(text)?,
        23 => trial.second_onset_s = optional(text)?,
        24 => trial.second_duration_s = optional(text)?,
        25 => trial.onset_source = required(text)?,
        26 => trial.first_missed_frames = optional(text)?,
        27 => trial.first_max_frame_ms = optional(text)?,
        28 => trial.second_missed_frames = optional(text)?,
        29 => trial.second_max_frame_ms = optional(text)?,
        30 => trial.refresh_hz = optional(text)?,
        31 => trial.vsync = required(text)?,
        32 => trial.interrupted = required(text)?,
        33 => any(text, &mut trial.interrupt_reason),
        34 => trial.resume_gap_s = optional(text)?,
        35 => trial.known_task = optional(text)?,
        36 => trial.seed = required(text)?,
        37 => hash(text, &mut trial.plan_hash)?,
        38 => hash(text, &mut trial.stimuli_hash)?,
        39 => name(text, &mut trial.version)?,
        40 => moment(text, &mut trial.started_utc)?,
        41 => trial.demo = required(text)?,
        _ => {}
    }
    Ok(())
}
