//! The curve as a picture.

use std::fmt::Write as _;

use super::curve::{Curve, Loss, Point};

/// The plot's place in the picture, and the picture's width: left, top, right, bottom, all.
const PLOT: [f64; 4] = [70.0, 60.0, 640.0, 440.0];
const WIDTH: f64 = 1060.0;

/// Height of a line of the list, and how many characters it holds within the picture's width.
const LINE: f64 = 18.0;
const CHARACTERS: usize = 48;

/// Numbers of points nearer to each other than this are written as one run.
const APART: f64 = 16.0;

/// Colours for light and for dark surroundings; data colours are of Okabe and Ito's palette for colour-blind eyes ("Color
/// Universal Design", 2008), and shapes differ too.
const STYLE: &str = "\
svg{color:#222;background:#fff;font:13px system-ui,sans-serif}text{fill:currentColor}\
.axis{stroke:currentColor;fill:none}.grid{stroke:currentColor;opacity:.15}\
.no{fill:#0072b2}.thresholds{fill:#d55e00}.continuous{fill:#009e73}.filter{fill:#aa3377}.deadline{fill:#7a6a00}.off{opacity:.35}\
.front{stroke:currentColor;fill:none;stroke-width:1.5}.knee{stroke:#cc79a7;fill:none;stroke-width:3}\
@media(prefers-color-scheme:dark){svg{color:#ddd;background:#16181c}.no{fill:#56b4e9}.thresholds{fill:#e69f00}\
.continuous{fill:#4fd1a5}.filter{fill:#cc79a7}.deadline{fill:#f0e442}}";

/// What a mark stands for: its class, its words.
const KINDS: [(&str, &str); 5] = [
    ("no", "circle: as the crex says, everywhere"),
    ("thresholds", "square: importance map by thresholds"),
    ("continuous", "triangle: importance map as numbers of samples"),
    ("filter", "diamond: planes smoothed"),
    ("deadline", "cross: within a time limit"),
];

fn kind(point: &Point) -> &'static str {
    match point {
        Point { deadline_s: Some(_), .. } => "deadline",
        Point { filter, .. } if !filter.is_empty() => "filter",
        Point { importance, .. } => importance.word(),
    }
}

/// Places of numbers in the plot.
struct Scale {
    time: [f64; 2],
    most: f64,
    loss: Loss,
}

impl Scale {
    fn of(points: &[&Point], loss: Loss) -> Self {
        let times = points.iter().map(|point| point.cpu_s);
        let (low, high) = times.fold((f64::INFINITY, 0.0_f64), |(low, high), time| (low.min(time), high.max(time)));
        let margin = (high / low).ln().max(0.1) * 0.04;
        let most = points.iter().map(|point| loss.of(point)).fold(1e-6_f64, f64::max) * 1.05;
        Self { time: [low.ln() - margin, high.ln() + margin], most, loss }
    }

    fn x(&self, cpu_s: f64) -> f64 {
        PLOT[0] + (PLOT[2] - PLOT[0]) * (cpu_s.ln() - self.time[0]) / (self.time[1] - self.time[0])
    }

    fn y(&self, loss: f64) -> f64 {
        PLOT[3] - (PLOT[3] - PLOT[1]) * loss / self.most
    }

    fn place(&self, point: &Point) -> (f64, f64) {
        (self.x(point.cpu_s), self.y(self.loss.of(point)))
    }
}

/// The curve's loss against processor seconds on a logarithmic axis, the front as a line with its points numbered and listed, the
/// knee ringed. Reads in light and in dark surroundings.
#[must_use]
pub fn svg(curve: &Curve, title: &str) -> String {
    let shown = |point: &&Point| point.cpu_s > 0.0 && point.cpu_s.is_finite() && curve.loss().of(point).is_finite();
    let points: Vec<&Point> = curve.points().iter().filter(shown).collect();
    let front: Vec<&Point> = curve.front().filter(shown).collect();
    let entries: Vec<(bool, String)> = legend(&points, &front, curve.loss());
    let height = (PLOT[3] + 60.0).max(PLOT[1] + LINE * (entries.len() as f64 + 1.0));
    let mut text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {height}\" width=\"{WIDTH}\" height=\"{height}\" \
         role=\"img\"><title>{0}</title><style>{STYLE}</style><rect width=\"100%\" height=\"100%\" fill=\"none\"/>\
         <text x=\"{1}\" y=\"28\" font-size=\"{2:.1}\">{0}</text>",
        escaped(title),
        PLOT[0],
        // A letter is about .6 of its size wide.
        (16.0_f64).min((WIDTH - PLOT[0]) / (0.6 * title.chars().count().max(1) as f64))
    );
    if points.is_empty() {
        text.push_str("</svg>\n");
        return text;
    }
    let scale = Scale::of(&points, curve.loss());
    axes(&mut text, &scale);
    let path: Vec<String> =
        front.iter().map(|point| scale.place(point)).map(|(x, y)| format!("{x:.1},{y:.1}")).collect();
    put(&mut text, format_args!("<polyline class=\"front\" points=\"{}\"/>", path.join(" ")));
    points.iter().for_each(|point| mark(&mut text, &scale, point));
    numbers(&mut text, &scale, &front);
    for (row, (bold, words)) in entries.iter().enumerate() {
        let (x, y) = (PLOT[2] + 30.0, PLOT[1] + LINE * row as f64);
        let weight = if *bold { " font-weight=\"bold\"" } else { "" };
        put(&mut text, format_args!("<text x=\"{x}\" y=\"{y:.1}\"{weight}>{}</text>", escaped(words)));
    }
    text.push_str("</svg>\n");
    text
}

fn axes(text: &mut String, scale: &Scale) {
    let [left, top, right, bottom] = PLOT;
    for time in decades(scale.time) {
        let x = scale.x(time);
        put(text, format_args!("<path class=\"grid\" d=\"M{x:.1} {top}V{bottom}\"/>"));
        put(text, format_args!("<text x=\"{x:.1}\" y=\"{}\" text-anchor=\"middle\">{time}</text>", bottom + 18.0));
    }
    let step = nice_step(scale.most / 6.0);
    let ticks = (scale.most / step).floor() as u32;
    for loss in (0..=ticks).map(|tick| f64::from(tick) * step) {
        let y = scale.y(loss);
        let digits = (-step.log10().floor()).max(0.0) as usize;
        put(text, format_args!("<path class=\"grid\" d=\"M{left} {y:.1}H{right}\"/>"));
        put(
            text,
            format_args!("<text x=\"{}\" y=\"{:.1}\" text-anchor=\"end\">{loss:.digits$}</text>", left - 8.0, y + 4.0),
        );
    }
    put(text, format_args!("<path class=\"axis\" d=\"M{left} {top}V{bottom}H{right}\"/>"));
    let (middle, below) = (f64::midpoint(left, right), bottom + 42.0);
    put(text, format_args!("<text x=\"{middle}\" y=\"{below}\" text-anchor=\"middle\">processor seconds</text>"));
    let middle = f64::midpoint(top, bottom);
    put(
        text,
        format_args!(
            "<text x=\"22\" y=\"{middle}\" text-anchor=\"middle\" transform=\"rotate(-90 22 {middle})\">{}</text>",
            match scale.loss {
                Loss::Jod => "predicted loss, JOD",
                Loss::Flip => "mean FLIP",
                Loss::RelMse => "relative mean squared error",
            }
        ),
    );
}

/// 1, 2 and 5 times powers of ten within a range of logarithms.
fn decades([low, high]: [f64; 2]) -> Vec<f64> {
    let (first, last) =
        ((low / std::f64::consts::LN_10).floor() as i32, (high / std::f64::consts::LN_10).ceil() as i32);
    let all = (first..=last).flat_map(|power| {
        // Powers below zero divide, so that .2 is printed as that.
        [1.0, 2.0, 5.0].map(|digit| if power < 0 { digit / 10_f64.powi(-power) } else { digit * 10_f64.powi(power) })
    });
    all.filter(|time| (low..=high).contains(&time.ln())).collect()
}

/// The least of 1, 2, 5 times a power of ten that is not below `least`.
fn nice_step(least: f64) -> f64 {
    let power = 10_f64.powf(least.log10().floor());
    [1.0, 2.0, 5.0, 10.0].into_iter().map(|digit| digit * power).find(|&step| step >= least).unwrap_or(10.0 * power)
}

fn mark(text: &mut String, scale: &Scale, point: &Point) {
    let (x, y) = scale.place(point);
    let kind = kind(point);
    let class = format!("{kind}{}", if point.front { "" } else { " off" });
    let shape = match kind {
        "no" => format!("<circle class=\"{class}\" cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"4\">"),
        "thresholds" => {
            format!("<rect class=\"{class}\" x=\"{:.1}\" y=\"{:.1}\" width=\"7\" height=\"7\">", x - 3.5, y - 3.5)
        }
        "continuous" => format!("<path class=\"{class}\" d=\"M{x:.1} {:.1}l5 9h-10z\">", y - 5.5),
        "filter" => format!("<path class=\"{class}\" d=\"M{x:.1} {:.1}l5 5.5l-5 5.5l-5 -5.5z\">", y - 5.5),
        _ => {
            format!("<path class=\"{class}\" d=\"M{:.1} {:.1}h3v-3.5h3v3.5h3v3h-3v3.5h-3v-3.5h-3z\">", x - 4.5, y - 1.5)
        }
    };
    let name = shape[1..].split(' ').next().unwrap_or("path");
    let tip = format!("{:.3} s, {}: {}", point.cpu_s, scale.loss.words(scale.loss.of(point)), point.how());
    put(text, format_args!("{shape}<title>{}</title></{name}>", escaped(&tip)));
    if point.knee {
        put(text, format_args!("<circle class=\"knee\" cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"9\"/>"));
    }
}

/// The numbers of the front's points beside them; those of points that lie together as a run, such as 5-7.
fn numbers(text: &mut String, scale: &Scale, front: &[&Point]) {
    let place = |point: &Point| scale.place(point);
    let mut rest = front;
    let mut first = 1;
    while let Some(&point) = rest.first() {
        let (x, y) = place(point);
        let near = |other: &&&Point| {
            let (other_x, other_y) = place(other);
            (other_x - x).hypot(other_y - y) < APART
        };
        let together = rest.iter().take_while(near).count();
        let (x, y) = (x + 7.0, y - 6.0);
        let last = first + together - 1;
        let run = if together == 1 { first.to_string() } else { format!("{first}-{last}") };
        put(text, format_args!("<text x=\"{x:.1}\" y=\"{y:.1}\" font-size=\"11\">{run}</text>"));
        (rest, first) = (&rest[together..], last + 1);
    }
}

/// Words in lines that the picture's width holds, those after the first indented; broken at spaces, and within what is too long to
/// have one.
fn wrapped(words: &str) -> Vec<String> {
    let letters: Vec<char> = words.chars().collect();
    let (mut lines, mut rest, mut room) = (Vec::new(), letters.as_slice(), CHARACTERS);
    while !rest.is_empty() {
        let full = &rest[..room.min(rest.len())];
        let space =
            full.iter().rposition(|&letter| letter == ' ').filter(|&at| full.len() < rest.len() && at > room / 2);
        let (line, more) = rest.split_at(space.map_or(full.len(), |at| at + 1));
        let indent = if lines.is_empty() { "" } else { "\u{2003}" };
        lines.push(format!("{indent}{}", line.iter().collect::<String>().trim_end()));
        (rest, room) = (more, CHARACTERS - 4);
    }
    lines
}

/// The lines of the list, each with whether it is bold: the front, and what the marks are.
fn legend(points: &[&Point], front: &[&Point], loss: Loss) -> Vec<(bool, String)> {
    let mut lines = vec![(true, "The front: nothing quicker is as good".to_owned())];
    for (number, point) in (1..).zip(front) {
        let knee = if point.knee { " (knee)" } else { "" };
        let words = format!("{number}{knee}  {:.3} s, {}: {}", point.cpu_s, loss.words(loss.of(point)), point.how());
        lines.extend(wrapped(&words).into_iter().map(|line| (point.knee, line)));
    }
    lines.push((false, String::new()));
    let there = KINDS.iter().filter(|(name, _)| points.iter().any(|point| kind(point) == *name));
    lines.extend(there.map(|(_, words)| (false, (*words).to_owned())));
    if points.len() > front.len() {
        lines.push((false, "pale: not on the front".to_owned()));
    }
    lines
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

fn put(text: &mut String, what: std::fmt::Arguments<'_>) {
    // Writing to a string does not fail.
    let _ = text.write_fmt(what);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_numbers() {
        assert_eq!(decades([0.15_f64.ln(), 3.0_f64.ln()]), [0.2, 0.5, 1.0, 2.0]);
        assert_eq!([0.4, 0.5, 1.1, 7.0].map(nice_step), [0.5, 0.5, 2.0, 10.0]);
    }

    #[test]
    fn crexes_do_not_break_the_picture() {
        let point = |crex: &str, cpu_s, loss_jod| Point {
            crex: crex.to_owned(),
            spp: 1,
            wall_s: cpu_s,
            cpu_s,
            rays: 1,
            loss_jod,
            ..Point::default()
        };
        let curve =
            Curve::new(vec![point("<MRSGD>T*", 1.0, 1.0), point("", 0.5, 2.0), point("D", 0.0, f64::NAN)], Loss::Jod);
        let text = svg(&curve, "a < b");
        assert!(text.contains("&lt;MRSGD&gt;T*") && text.contains("a &lt; b") && text.contains("direct light, 1 spp"));
        assert!(!text.contains("NaN") && !text.contains("<MRSGD>"));
        assert!(svg(&Curve::new(vec![], Loss::Jod), "nothing").ends_with("</svg>\n"));
    }

    #[test]
    fn long_words_go_on_below_and_numbers_do_not_lie_on_each_other() {
        let point = |crex: &str, cpu_s, loss_jod| Point { crex: crex.to_owned(), cpu_s, loss_jod, ..Point::default() };
        let long = "{T}*{M}{T}*{G}{T}*".repeat(8);
        let curve =
            Curve::new(vec![point("D", 1.0, 3.0), point("D2", 1.001, 2.999), point(&long, 4.0, 0.5)], Loss::Jod);
        let text = svg(&curve, "a scene");
        let lines = |text: &str| -> Vec<String> {
            let marked = text.split("<text x=\"670\"").skip(1);
            marked.map(|rest| rest.split_once('>').unwrap().1.split_once('<').unwrap().0.to_owned()).collect()
        };
        let lines = lines(&text);
        assert!(lines.iter().all(|line| line.chars().count() <= CHARACTERS), "{lines:?}");
        let whole: String = lines.iter().map(|line| line.trim_start_matches('\u{2003}')).collect();
        assert!(whole.contains(&long));
        assert!(text.contains(">1-2</text>") && text.contains(">3</text>"));
        let words = "12  0.154 s, 1.57 JOD: T{RSGM}, thresholds, 4 spp";
        assert_eq!(wrapped(words), ["12  0.154 s, 1.57 JOD: T{RSGM}, thresholds, 4", "\u{2003}spp"]);
    }
}
