//! Text within marks, of pages and of drawings.

/// Text that is only text in HTML. A number keeps its percent sign, a p its value, on one line.
pub(super) fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for character in text.replace(" %", "\u{a0}%").replace("p = ", "p\u{a0}=\u{a0}").chars() {
        match character {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            _ => out.push(character),
        }
    }
    out
}
