//! A crex text cut into tokens. Every character but white space belongs to exactly one token.

use super::ast::{Group, Span};
use crate::component::Component;

/// What a token is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum TokenKind {
    /// `D G S T R M`.
    Letter(Component),
    /// One of `( < { [`.
    Open(Group),
    /// One of `) > } ]`.
    Close(Group),
    /// `*`.
    Star,
    /// Digits, greedily.
    Digits,
    /// Neighbouring lower-case letters, each of a component.
    LowerCase,
    /// Neighbouring characters that the language does not have.
    Unknown,
}

/// A token and the bytes that it covers.
#[derive(Clone, Copy, Debug)]
pub(super) struct Token {
    pub(super) kind: TokenKind,
    pub(super) span: Span,
}

/// The tokens of `text`, in order.
pub(super) fn tokens(text: &str) -> impl Iterator<Item = Token> {
    let mut characters = text.char_indices().peekable();
    std::iter::from_fn(move || {
        let (start, first) = characters.by_ref().find(|(_, character)| !character.is_whitespace())?;
        let kind = kind_of(first);
        let mut end = start + first.len_utf8();
        if matches!(kind, TokenKind::Digits | TokenKind::LowerCase | TokenKind::Unknown) {
            while let Some((at, more)) = characters.next_if(|&(_, next)| !next.is_whitespace() && kind_of(next) == kind)
            {
                end = at + more.len_utf8();
            }
        }
        Some(Token { kind, span: Span::new(start, end) })
    })
}

/// What one character, white space apart, begins.
fn kind_of(character: char) -> TokenKind {
    if let Some(component) = Component::from_letter(character) {
        return TokenKind::Letter(component);
    }
    for group in Group::ALL {
        let (open, close) = group.brackets();
        if character == open {
            return TokenKind::Open(group);
        }
        if character == close {
            return TokenKind::Close(group);
        }
    }
    match character {
        '*' => TokenKind::Star,
        '0'..='9' => TokenKind::Digits,
        _ if Component::from_letter(character.to_ascii_uppercase()).is_some() => TokenKind::LowerCase,
        _ => TokenKind::Unknown,
    }
}
