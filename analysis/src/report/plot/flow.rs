//! From sessions to analysed trials, as boxes.

use super::Figure;
use super::canvas::{Anchor, Canvas, WIDE};
use crate::report::Flow;
use crate::report::numbers::grouped;

/// The flow diagram.
#[must_use]
pub fn flow(flow: &Flow) -> Figure {
    let line = 20.0;
    let reasons: Vec<String> =
        flow.excluded.iter().map(|(reason, count)| format!("{}: {}", grouped(*count), reason.words())).collect();
    let side_height = line * reasons.len().max(1) as f64 + 24.0;
    let box_height = 44.0;
    let middle_gap = side_height + 28.0;
    let arms_top = 8.0 + box_height + middle_gap;
    let has_arms = !flow.by_arm.is_empty();
    let height = arms_top + box_height + if has_arms { 28.0 + box_height } else { 0.0 } + 8.0;
    let mut canvas = Canvas::new(WIDE, height);
    let (left, width) = (8.0, 250.0);
    let middle = left + width / 2.0;
    let node = |canvas: &mut Canvas, at: [f64; 2], size: [f64; 2], text: &str| {
        canvas.rect("box", at, size);
        canvas.text("label strong", [at[0] + size[0] / 2.0, at[1] + size[1] / 2.0 + 4.0], Anchor::Middle, text);
    };
    node(&mut canvas, [left, 8.0], [width, box_height], &format!("{} sessions begun", grouped(flow.sessions)));
    canvas.line("axis", [middle, 8.0 + box_height], [middle, arms_top]);
    let excluded: u64 = flow.excluded.iter().map(|(_, count)| count).sum();
    let side_top = 8.0 + box_height + 14.0;
    let side_left = left + width + 30.0;
    canvas.line("axis", [middle, side_top + side_height / 2.0], [side_left, side_top + side_height / 2.0]);
    canvas.rect("box", [side_left, side_top], [WIDE - 8.0 - side_left, side_height]);
    if reasons.is_empty() {
        canvas.text("label", [side_left + 14.0, side_top + 26.0], Anchor::Start, "none left out");
    }
    for (i, reason) in reasons.iter().enumerate() {
        canvas.text("label", [side_left + 14.0, side_top + 26.0 + line * i as f64], Anchor::Start, reason);
    }
    node(&mut canvas, [left, arms_top], [width, box_height], &format!("{} analysed", grouped(flow.analysed)));
    if has_arms {
        let top = arms_top + box_height + 28.0;
        let each = (WIDE - 16.0 - 12.0 * (flow.by_arm.len() as f64 - 1.0)) / flow.by_arm.len() as f64;
        canvas.line("axis", [middle, arms_top + box_height], [middle, top - 14.0]);
        let centre = |i: usize| left + (each + 12.0) * i as f64 + each / 2.0;
        canvas.line(
            "axis",
            [centre(0).min(middle), top - 14.0],
            [centre(flow.by_arm.len() - 1).max(middle), top - 14.0],
        );
        for (i, (arm, people)) in flow.by_arm.iter().enumerate() {
            canvas.line("axis", [centre(i), top - 14.0], [centre(i), top]);
            let at = [left + (each + 12.0) * i as f64, top];
            node(&mut canvas, at, [each, box_height], &format!("{arm}: {}", grouped(*people)));
        }
    }
    let arms: Vec<String> = flow.by_arm.iter().map(|(arm, people)| format!("{arm}: {people}")).collect();
    Figure {
        svg: canvas.finish(),
        caption: "From sessions to analysed participants.".to_owned(),
        description: format!(
            "{} sessions begun, {excluded} left out ({}), {} analysed ({}).",
            flow.sessions,
            if reasons.is_empty() { "none".to_owned() } else { reasons.join("; ") },
            flow.analysed,
            arms.join("; ")
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exclude::Reason;

    #[test]
    fn the_numbers_add_up_in_words() {
        let data = Flow {
            sessions: 20,
            excluded: vec![(Reason::Interrupted, 1), (Reason::KnewTask, 3)],
            analysed: 16,
            by_arm: vec![("HQ/CBQ".into(), 8), ("HQ/HQ".into(), 8)],
        };
        assert_eq!(
            flow(&data).description,
            "20 sessions begun, 4 left out (1: the trial was interrupted; 3: the participant knew the purpose), 16 analysed \
             (HQ/CBQ: 8; HQ/HQ: 8)."
        );
        assert!(flow(&Flow::default()).svg.contains("none left out"));
    }
}
