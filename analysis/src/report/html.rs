//! The report as a web page: one file, no script, no network, both themes, printable.

use std::fmt::Write;

use super::block::{Block, Table};
use super::escape::escape;
use super::numbers::{grouped, short};
use super::plot::Figure;
use super::words::Finding;
use crate::pictures::Picture;

pub(super) fn write(blocks: &[Block]) -> String {
    let title = blocks.iter().find_map(|block| match block {
        Block::Title(title) => Some(escape(title)),
        _ => None,
    });
    let title = title.unwrap_or_default();
    let style = include_str!("style.css");
    let mut out = format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <meta name=\"color-scheme\" content=\"light dark\">\n<title>{title}</title>\n\
         <style>\n{style}</style>\n</head>\n<body>\n<main>\n"
    );
    for block in blocks {
        write_block(&mut out, block);
    }
    out + "</main>\n</body>\n</html>\n"
}

fn write_block(out: &mut String, block: &Block) {
    let _ = match block {
        Block::Title(text) => writeln!(out, "<h1>{}</h1>", escape(text)),
        Block::Banner(text) => writeln!(out, "<p class=\"banner\"><strong>{}</strong></p>", escape(text)),
        Block::Verdict(arm, finding, sentence) => writeln!(
            out,
            "<section class=\"verdict {}\" aria-label=\"Verdict on {}\"><p class=\"arm\">{}</p><p>{}</p></section>",
            class(*finding),
            escape(arm),
            escape(arm),
            escape(sentence)
        ),
        Block::Heading(level, text) => writeln!(out, "<h{level}>{}</h{level}>", escape(text)),
        Block::Text(text) => writeln!(out, "<p>{}</p>", escape(text)),
        Block::List(items) => {
            let items: Vec<String> = items.iter().map(|item| format!("<li>{}</li>", escape(item))).collect();
            writeln!(out, "<ul>\n{}\n</ul>", items.join("\n"))
        }
        Block::Facts(facts) => {
            let pair =
                |(name, value): &(String, String)| format!("<dt>{}</dt><dd>{}</dd>", escape(name), escape(value));
            writeln!(out, "<dl>\n{}\n</dl>", facts.iter().map(pair).collect::<Vec<_>>().join("\n"))
        }
        Block::Table(table) => writeln!(out, "{}", table_of(table)),
        Block::Figures(figures) => {
            let class = if figures.len() > 1 { "figures several" } else { "figures" };
            let figures: Vec<String> = figures.iter().map(figure).collect();
            writeln!(out, "<div class=\"{class}\">\n{}\n</div>", figures.join("\n"))
        }
        Block::Pictures(pictures) => {
            let cards: Vec<String> = pictures.iter().map(card).collect();
            writeln!(out, "<div class=\"stimuli\">\n{}\n</div>", cards.join("\n"))
        }
    };
}

fn class(finding: Finding) -> &'static str {
    match finding {
        Finding::NoData | Finding::NoRightAnswer => "plain",
        Finding::Noticed | Finding::Reversed => "noticed",
        Finding::NoticedWithinBound | Finding::ReversedWithinBound | Finding::Equivalent => "equivalent",
        Finding::Undecided => "undecided",
    }
}

fn figure(figure: &Figure) -> String {
    format!(
        "<figure>{}<figcaption>{} <span class=\"hidden\">{}</span></figcaption></figure>",
        figure.svg,
        escape(&figure.caption),
        escape(&figure.description)
    )
}

fn table_of(table: &Table) -> String {
    let caption = escape(&table.caption);
    let head: Vec<String> =
        table.columns.iter().map(|name| format!("<th scope=\"col\">{}</th>", escape(name))).collect();
    let body: Vec<String> = table
        .rows
        .iter()
        .map(|row| {
            let cells: Vec<String> = row
                .iter()
                .enumerate()
                .map(|(at, cell)| match at {
                    0 => format!("<th scope=\"row\">{}</th>", escape(cell)),
                    _ => format!("<td>{}</td>", escape(cell)),
                })
                .collect();
            format!("<tr>{}</tr>", cells.concat())
        })
        .collect();
    format!(
        "<div class=\"scroll\" role=\"region\" aria-label=\"{caption}\" tabindex=\"0\"><table>\n<caption>{caption}</caption>\n\
         <thead><tr>{}</tr></thead>\n<tbody>\n{}\n</tbody>\n</table></div>",
        head.concat(),
        body.join("\n")
    )
}

fn card(shown: &Picture) -> String {
    let picture = shown.thumbnail.as_ref().map_or_else(
        || "<p class=\"missing\">picture not found</p>".to_owned(),
        |png| {
            format!(
                "<img src=\"data:image/png;base64,{}\" alt=\"{}: layout {}, quality {}\">",
                base64(png),
                escape(&shown.id),
                escape(&shown.layout),
                escape(&shown.quality)
            )
        },
    );
    let crex = if shown.crex.is_empty() {
        "direct light alone".to_owned()
    } else {
        format!("<code>{}</code>", escape(&shown.crex))
    };
    format!(
        "<figure class=\"card\">{picture}<figcaption><strong>{}</strong> {crex}<br>{}</figcaption></figure>",
        escape(&shown.id),
        escape(&cost(shown))
    )
}

/// What making a picture cost, in words.
pub(super) fn cost(shown: &Picture) -> String {
    let rays: u64 = shown.rays.iter().map(|(_, rays)| rays).sum();
    let time = shown.cost.map(|(seconds, threads)| {
        let threads = if threads == 1 { "1 thread".to_owned() } else { format!("{threads} threads") };
        format!(", {} s on {threads}", short(seconds))
    });
    format!("{} rays{}", grouped(rays), time.unwrap_or_default())
}

/// Base 64 (RFC 4648, section 4).
fn base64(bytes: &[u8]) -> String {
    const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut out = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for chunk in bytes.chunks(3) {
        let word = chunk.iter().fold(0_u32, |word, &byte| word << 8 | u32::from(byte)) << (8 * (3 - chunk.len()));
        for at in 0..4 {
            let letter = LETTERS[(word >> (18 - 6 * at) & 63) as usize];
            out.push(if at <= chunk.len() { char::from(letter) } else { '=' });
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashMap;

    /// RFC 4648, section 10.
    #[test]
    fn base64_of_the_standard_s_examples() {
        for (text, coded) in [
            ("", ""),
            ("f", "Zg=="),
            ("fo", "Zm8="),
            ("foo", "Zm9v"),
            ("foob", "Zm9vYg=="),
            ("fooba", "Zm9vYmE="),
            ("foobar", "Zm9vYmFy"),
        ] {
            assert_eq!(base64(text.as_bytes()), coded);
        }
    }

    /// Relative luminance of `#rrggbb` (WCAG 2.2).
    fn luminance(colour: &str) -> f64 {
        let part = |at: usize| {
            let code = f64::from(u8::from_str_radix(&colour[at..at + 2], 16).unwrap()) / 255.0;
            if code <= 0.04045 { code / 12.92 } else { ((code + 0.055) / 1.055).powf(2.4) }
        };
        0.2126 * part(1) + 0.7152 * part(3) + 0.0722 * part(5)
    }

    /// WCAG 2.2, 1.4.3 and 1.4.11: text 4.5 to 1, drawings 3 to 1, in both themes and in print. Browsers' checkers leave the
    /// text of drawings open.
    #[test]
    fn colours_stand_out_in_every_theme() {
        let style = include_str!("style.css");
        let themes: Vec<HashMap<&str, &str>> = style
            .split(":root {")
            .skip(1)
            .map(|block| block.split('}').next().unwrap())
            .map(|block| block.split(';').filter_map(|rule| rule.trim().strip_prefix("--")?.split_once(": ")).collect())
            .collect();
        assert_eq!(themes.len(), 3);
        let ratio = |theme: &HashMap<&str, &str>, front: &str, back: &str| {
            let (a, b) = (luminance(theme[front]), luminance(theme[back]));
            (a.max(b) + 0.05) / (a.min(b) + 0.05)
        };
        let text = [("ink", "paper"), ("ink", "card"), ("ink", "band"), ("muted", "paper"), ("muted", "card")];
        let drawn = ["accent", "equivalent", "noticed", "muted", "undecided"].map(|front| (front, "paper"));
        for theme in &themes {
            for (front, back) in text.into_iter().chain([("warn", "warn-paper"), ("muted", "band")]) {
                assert!(ratio(theme, front, back) >= 4.5, "{front} on {back}: {:.2}", ratio(theme, front, back));
            }
            for (front, back) in drawn.into_iter().chain([("accent", "band")]) {
                assert!(ratio(theme, front, back) >= 3.0, "{front} on {back}: {:.2}", ratio(theme, front, back));
            }
        }
    }

    #[test]
    fn markup_is_text() {
        assert_eq!(escape("<a href='x'>&\""), "&lt;a href=&#39;x&#39;&gt;&amp;&quot;");
    }
}
