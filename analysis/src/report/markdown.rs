//! The report as Markdown.

use std::fmt::Write;

use super::block::{Block, Table};

pub(super) fn write(blocks: &[Block]) -> String {
    let mut out = String::new();
    for block in blocks {
        match block {
            Block::Title(text) => out += &format!("# {}\n\n", plain(text)),
            Block::Banner(text) => out += &format!("> **{}**\n\n", plain(text)),
            Block::Verdict(arm, _, sentence) => out += &format!("**{}** — {}\n\n", plain(arm), plain(sentence)),
            Block::Heading(level, text) => {
                out += &format!("{} {}\n\n", "#".repeat(usize::from(*level)), plain(text));
            }
            Block::Text(text) => out += &format!("{}\n\n", plain(text)),
            Block::List(items) => {
                items.iter().for_each(|item| out += &format!("- {}\n", plain(item)));
                out.push('\n');
            }
            Block::Facts(facts) => {
                facts.iter().for_each(|(name, value)| out += &format!("- {}: {}\n", plain(name), plain(value)));
                out.push('\n');
            }
            Block::Table(table) => write_table(&mut out, table),
            Block::Figures(figures) => {
                figures.iter().for_each(|figure| {
                    out += &format!("*{}* {}\n\n", plain(&figure.caption), plain(&figure.description))
                });
            }
            Block::Pictures(pictures) => {
                out += "| picture | layout | quality | crex | cost |\n|---|---|---|---|---|\n";
                for picture in pictures {
                    let cells =
                        [&picture.id, &picture.layout, &picture.quality, &picture.crex, &super::html::cost(picture)];
                    let _ = writeln!(out, "| {} |", cells.map(|cell| plain(cell)).join(" | "));
                }
                out.push('\n');
            }
        }
    }
    out
}

fn write_table(out: &mut String, table: &Table) {
    let _ = write!(
        out,
        "{}\n\n| {} |\n|{}\n",
        plain(&table.caption),
        table.columns.join(" | "),
        "---|".repeat(table.columns.len())
    );
    for row in &table.rows {
        let cells: Vec<String> = row.iter().map(|cell| plain(cell)).collect();
        let _ = writeln!(out, "| {} |", cells.join(" | "));
    }
    out.push('\n');
}

/// Text that Markdown takes as it is: it can neither leave its line nor its table cell.
fn plain(text: &str) -> String {
    let mut out = String::new();
    for character in text.chars() {
        match character {
            '|' | '*' | '_' | '`' | '<' | '[' | '\\' => {
                out.push('\\');
                out.push(character);
            }
            '\n' | '\r' => out.push(' '),
            _ => out.push(character),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    #[test]
    fn names_cannot_break_the_table() {
        assert_eq!(super::plain("a|b\n<i>"), "a\\|b \\<i>");
    }
}
