//! The pieces that a page is made of, whatever it is written as.

use super::plot::Figure;
use super::words::Finding;
use crate::pictures::Picture;

/// A piece of a page.
pub(super) enum Block {
    /// The page's own heading.
    Title(String),
    /// What nobody may overlook.
    Banner(String),
    /// A verdict: arm, finding, sentence.
    Verdict(String, Finding, String),
    /// A heading of level 2 or 3.
    Heading(u8, String),
    /// A paragraph.
    Text(String),
    /// Sentences that stand by themselves.
    List(Vec<String>),
    /// Names and values.
    Facts(Vec<(String, String)>),
    /// A table.
    Table(Table),
    /// Drawings that belong together.
    Figures(Vec<Figure>),
    /// The pictures that were shown.
    Pictures(Vec<Picture>),
}

/// A table of texts.
pub(super) struct Table {
    pub(super) caption: String,
    pub(super) columns: Vec<&'static str>,
    pub(super) rows: Vec<Vec<String>>,
}
