//! What a picture says of its own making: everything needed to make the same bits again, and nothing that differs between two
//! runs that would (no date, host, thread count or time).

use serde::{Deserialize, Serialize};

/// How a picture was made. Stored as one line of JSON in EXR and PNG (several custom EXR attributes would be written in an order
/// that changes from run to run) and as header lines in HDR.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Provenance {
    /// Program and version.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub software: String,
    /// The component regular expression.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub crex: Option<String>,
    /// The view in rpict's option spelling, as in a `VIEW=` line.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub view: Option<String>,
    /// The options that shape the picture, in rpict's and the program's spelling.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub options: Option<String>,
    /// The files read, in order.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub inputs: Vec<Input>,
    /// Stored value / radiance (HDR) or display intensity / radiance (PNG), where that is not 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub exposure: Option<f64>,
}

/// A file that a picture was made from.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Input {
    /// The file's name without its folder, which differs from machine to machine.
    pub name: String,
    /// SHA-256 of its bytes in lower-case hexadecimal.
    pub sha256: String,
}

impl Provenance {
    /// One line of JSON in ASCII: the text attributes of EXR hold nothing else.
    pub(super) fn to_json(&self) -> String {
        let json = serde_json::to_string(self).expect("strings and numbers always serialise");
        let mut ascii = String::with_capacity(json.len());
        for character in json.chars() {
            if character.is_ascii() {
                ascii.push(character);
            } else {
                // JSON escapes characters by their UTF-16 units.
                character.encode_utf16(&mut [0; 2]).iter().for_each(|unit| ascii.push_str(&format!("\\u{unit:04x}")));
            }
        }
        ascii
    }

    /// Reads [`Provenance::to_json`]; foreign text gives an empty provenance, since any program may write such an attribute.
    pub(super) fn from_json(text: &str) -> Self {
        serde_json::from_str(text).unwrap_or_default()
    }
}
