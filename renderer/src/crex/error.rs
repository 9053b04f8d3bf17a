//! What can be wrong with a crex, said so that its writer can put it right.

use std::fmt;

use super::ast::{Group, MAX_NESTING, Span};

/// What is wrong.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ErrorKind {
    /// Characters that the language does not have.
    UnknownCharacter,
    /// Letters of components in lower case, and what was surely meant.
    LowerCase {
        /// The same letters in upper case.
        suggestion: String,
    },
    /// An opening bracket whose group never ends.
    Unclosed(Group),
    /// A closing bracket where no group is open.
    Unopened(Group),
    /// A closing bracket while a group of another kind is open.
    Mismatched {
        /// Whose closing bracket was found.
        found: Group,
        /// The group that is open.
        open: Group,
        /// The byte at which that group began.
        opened_at: usize,
    },
    /// A group without members.
    Empty(Group),
    /// A multiplier with nothing before it.
    NothingToMultiply,
    /// A multiplier of 0.
    Zero,
    /// A multiplier over 2^32 - 1.
    TooLarge,
    /// `*` inside a `{ }` or `[ ]`.
    StarInside(Group),
    /// `{ }` inside a `{ }` or `[ ]`.
    ImportanceInside(Group),
    /// Deeper nesting than [`MAX_NESTING`].
    TooDeep,
}

/// Something wrong with a crex, and where.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Error {
    /// What is wrong.
    pub kind: ErrorKind,
    /// The part of the text to underline.
    pub span: Span,
    /// That part of the text, cut short if it is long.
    pub found: String,
}

/// `( )` and so on, for messages.
fn spaced(group: Group) -> String {
    let (open, close) = group.brackets();
    format!("`{open} {close}`")
}

impl Error {
    pub(super) fn new(kind: ErrorKind, span: Span, text: &str) -> Self {
        const SHOWN: usize = 24;
        let covered = span.of(text);
        let mut found: String = covered.chars().take(SHOWN).flat_map(char::escape_debug).collect();
        if covered.chars().nth(SHOWN).is_some() {
            found.push('…');
        }
        Self { kind, span, found }
    }

    /// What is wrong, in a sentence without a full stop.
    #[must_use]
    pub fn message(&self) -> String {
        let found = &self.found;
        match &self.kind {
            ErrorKind::UnknownCharacter => format!("`{found}` means nothing in a crex"),
            ErrorKind::LowerCase { suggestion } => {
                format!("`{found}` is in lower case: did you mean `{suggestion}`?")
            }
            ErrorKind::Unclosed(group) => format!("`{}` is never closed", group.brackets().0),
            ErrorKind::Unopened(group) => format!("`{}` closes a group that was never opened", group.brackets().1),
            ErrorKind::Mismatched { found, open, opened_at } => {
                format!("`{}` cannot close the `{}` opened at byte {opened_at}", found.brackets().1, open.brackets().0)
            }
            ErrorKind::Empty(group) => format!("{} holds nothing", spaced(*group)),
            ErrorKind::NothingToMultiply => format!("`{found}` has nothing before it to repeat"),
            ErrorKind::Zero => format!("a multiplier of {found} would run nothing"),
            ErrorKind::TooLarge => format!("the multiplier {found} is over {}", u32::MAX),
            ErrorKind::StarInside(group) => format!("`*` cannot stand inside {}", spaced(*group)),
            ErrorKind::ImportanceInside(Group::Importance) => "`{ }` cannot stand inside another `{ }`".to_owned(),
            ErrorKind::ImportanceInside(group) => {
                format!("`{{ }}` cannot stand inside {}, where every group is a {0}", spaced(*group))
            }
            ErrorKind::TooDeep => format!("nesting is deeper than {MAX_NESTING} groups"),
        }
    }

    /// What was expected instead.
    #[must_use]
    pub fn expected(&self) -> String {
        match &self.kind {
            ErrorKind::UnknownCharacter => {
                "a component (D G S T R M), a group (`( )` `< >` `{ }` `[ ]`), `*` or a whole number".to_owned()
            }
            ErrorKind::LowerCase { .. } => "components in upper case: D G S T R M".to_owned(),
            ErrorKind::Unclosed(group) => format!("a `{}` after the group's last member", group.brackets().1),
            ErrorKind::Unopened(group) => format!("a `{}` before the group's first member", group.brackets().0),
            ErrorKind::Mismatched { open, .. } => format!("`{}`", open.brackets().1),
            ErrorKind::Empty(_) => "at least one component or group between the brackets".to_owned(),
            ErrorKind::NothingToMultiply => "a component or a group, and then its multiplier".to_owned(),
            ErrorKind::Zero | ErrorKind::TooLarge => format!("a whole number from 1 to {}", u32::MAX),
            ErrorKind::StarInside(_) => "a whole number instead, or the `*` behind the closing bracket".to_owned(),
            ErrorKind::ImportanceInside(_) => "groups in `{ }` beside each other, not within each other".to_owned(),
            ErrorKind::TooDeep => {
                format!("at most {MAX_NESTING} groups within each other, counting `T2*` as `(T2)*`")
            }
        }
    }

    /// A crex that parses and shows how it is done.
    #[must_use]
    pub fn example(&self) -> String {
        let around = |group: Group, inside: &str| {
            let (open, close) = group.brackets();
            format!("{open}{inside}{close}")
        };
        match &self.kind {
            ErrorKind::UnknownCharacter => "T{RSGM}".to_owned(),
            ErrorKind::LowerCase { suggestion } => suggestion.clone(),
            ErrorKind::Unclosed(group) | ErrorKind::Unopened(group) | ErrorKind::Empty(group) => {
                format!("T{}", around(*group, "RS"))
            }
            ErrorKind::Mismatched { open, .. } => format!("T{}", around(*open, "RS")),
            ErrorKind::NothingToMultiply => "T2".to_owned(),
            ErrorKind::Zero | ErrorKind::TooLarge => "T3".to_owned(),
            ErrorKind::StarInside(Group::Importance) => "(T{RS3})*".to_owned(),
            ErrorKind::StarInside(group) => format!("(T{})*", around(*group, "RS3")),
            ErrorKind::ImportanceInside(Group::Importance) => "{T}{RS}".to_owned(),
            ErrorKind::ImportanceInside(group) => format!("{{T}}{}", around(*group, "RS")),
            ErrorKind::TooDeep => "((T2)3R)*".to_owned(),
        }
    }

    /// The whole report: the message, the line of `text` with the span underlined, what was expected, an example.
    /// `text` must be the text that was parsed.
    #[must_use]
    pub fn render(&self, text: &str) -> String {
        format!(
            "error: {}\n{}expected: {}\nexample:  {}\n",
            self.message(),
            underline(text, self.span),
            self.expected(),
            self.example()
        )
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} (bytes {} to {})", self.message(), self.span.start, self.span.end)
    }
}

impl std::error::Error for Error {}

/// The line of `text` that holds the start of `span`, with its line and column (in characters, from 1), and carets
/// below the span; two lines of output. Long lines are cut around the span; control characters show as spaces.
#[must_use]
pub(super) fn underline(text: &str, span: Span) -> String {
    const BEFORE: usize = 40;
    const AFTER: usize = 70;
    let start = (0..=span.start.min(text.len())).rev().find(|&at| text.is_char_boundary(at)).unwrap_or(0);
    let line_start = text[..start].rfind('\n').map_or(0, |at| at + 1);
    let line_end = text[start..].find('\n').map_or(text.len(), |at| start + at);
    let line_number = text[..start].matches('\n').count() + 1;
    let column = text[line_start..start].chars().count();
    let covered = text[start..line_end].char_indices().take_while(|(at, _)| start + at < span.end).count().max(1);

    let from = column.saturating_sub(BEFORE);
    let (head, mut tail) = (if from > 0 { "…" } else { "" }, "");
    let mut shown: String = text[line_start..line_end].chars().skip(from).take(BEFORE + AFTER).collect();
    let shown_chars = shown.chars().count();
    if text[line_start..line_end].chars().nth(from + shown_chars).is_some() {
        tail = "…";
    }
    shown = shown.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    let carets = covered.min((shown_chars + 1).saturating_sub(column - from)).max(1);
    let label = format!("  {line_number}:{}: ", column + 1);
    let indent = label.len() + head.chars().count() + column - from;
    format!("{label}{head}{shown}{tail}\n{:indent$}{}\n", "", "^".repeat(carets))
}
