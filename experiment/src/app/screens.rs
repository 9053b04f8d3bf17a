//! What each screen looks like. Texts come from the study file; the experimenter's own are English.

use analysis::trial_log::Interval;
use egui::{Align, Color32, FontId, Layout, RichText, Stroke, TextEdit, TextStyle, Ui, Vec2};
use stimuli::Study;

use crate::session::{Outcome, Page, Screen};
use crate::setup::{CONDITIONS, Form};

/// Even grey, so that no screen is much brighter or darker than the pictures; black text on it has a contrast of 5.3:1.
pub const BACKGROUND: Color32 = Color32::from_gray(128);
const INK: Color32 = Color32::BLACK;

/// The last screen of a session that was broken off.
const ENDED: &str = "The session has ended. Thank you.";

/// The widest line of text, points.
const COLUMN: f32 = 860.0;

/// Large type, dark on grey.
pub fn style(context: &egui::Context) {
    context.set_theme(egui::Theme::Light);
    context.all_styles_mut(|style| {
        style.visuals.panel_fill = BACKGROUND;
        style.visuals.override_text_color = Some(INK);
        style.visuals.extreme_bg_color = Color32::WHITE;
        style.visuals.widgets.inactive.bg_stroke = Stroke::new(1.5, INK);
        style.visuals.widgets.hovered.bg_stroke = Stroke::new(2.0, INK);
        style.visuals.selection.stroke = Stroke::new(2.5, INK);
        style.visuals.weak_text_color = Some(Color32::from_gray(64));
        style.text_styles = [
            (TextStyle::Heading, FontId::proportional(32.0)),
            (TextStyle::Body, FontId::proportional(24.0)),
            (TextStyle::Button, FontId::proportional(22.0)),
            (TextStyle::Monospace, FontId::monospace(22.0)),
            (TextStyle::Small, FontId::proportional(18.0)),
        ]
        .into();
        style.spacing.item_spacing = Vec2::new(12.0, 12.0);
        style.spacing.icon_width = 22.0;
        style.spacing.icon_width_inner = 14.0;
        style.animation_time = 0.0;
    });
}

/// A column of text in the middle of the window.
fn column(ui: &mut Ui, add: impl FnOnce(&mut Ui)) {
    egui::CentralPanel::default().show(ui, |ui| {
        let width = COLUMN.min(ui.available_width());
        let margin = (ui.available_width() - width) / 2.0;
        ui.add_space((ui.available_height() * 0.16).min(160.0));
        ui.horizontal(|ui| {
            ui.add_space(margin);
            ui.allocate_ui_with_layout(Vec2::new(width, 0.0), Layout::top_down(Align::Min), |ui| {
                ui.set_width(width);
                add(ui);
            });
        });
    });
}

fn body(ui: &mut Ui, text: &str) {
    ui.label(RichText::new(text.trim()).text_style(TextStyle::Body).line_height(Some(34.0)));
}

fn hints(ui: &mut Ui, lines: &[&String]) {
    ui.add_space(24.0);
    for line in lines {
        ui.label(RichText::new(*line).strong());
    }
}

/// Gives what is drawn without words a name for those who cannot see it, and for tests.
pub(super) fn name(ui: &Ui, name: &str) {
    let response = ui.interact(ui.ctx().content_rect(), ui.scope_id().with(name), egui::Sense::hover());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, name));
}

/// The fixation mark: a cross of 2 x 24 points.
pub(super) fn fixation(ui: &Ui) {
    let centre = ui.ctx().content_rect().center();
    let stroke = Stroke::new(2.0, INK);
    ui.painter().hline(centre.x - 12.0..=centre.x + 12.0, centre.y, stroke);
    ui.painter().vline(centre.x, centre.y - 12.0..=centre.y + 12.0, stroke);
}

/// Every text that a participant may meet.
pub(super) fn texts(study: &Study) -> Vec<&str> {
    study.wording.all().chain([study.consent.text.as_str(), ENDED]).collect()
}

/// A screen of text for a participant of `arm`. `noticed` is what is being typed where words are asked for.
pub(super) fn text(ui: &mut Ui, study: &Study, arm: &str, screen: &Screen<'_>, noticed: &mut String) {
    let [instructions, practice, ready] = study.wording.before_trials(study.viewing(arm));
    let (words, keys) = (&study.wording, &study.wording.hints);
    column(ui, |ui| match screen {
        Screen::Consent => {
            body(ui, &study.consent.text);
            hints(ui, &[&keys.agree, &keys.decline]);
        }
        Screen::Page(page) => {
            body(
                ui,
                match page {
                    Page::Instructions => instructions,
                    Page::Practice => practice,
                    Page::Ready => ready,
                    Page::Check => &words.check,
                },
            );
            hints(ui, &[&keys.go_on]);
        }
        Screen::Count(interval, typed) => {
            body(ui, if *interval == Interval::First { &words.count_first } else { &words.count_second });
            ui.add_space(12.0);
            ui.label(RichText::new(format!("{typed}_")).text_style(TextStyle::Heading));
            hints(ui, &[&keys.count]);
        }
        Screen::Worse => {
            body(ui, &words.worse);
            hints(ui, &[&keys.first, &keys.second]);
        }
        Screen::Confidence => {
            body(ui, words.confidence.as_deref().unwrap_or_default());
            hints(ui, &[&keys.confidence]);
        }
        Screen::Noticed => {
            let label = ui.label(RichText::new(words.noticed.trim()).text_style(TextStyle::Body));
            let edit = TextEdit::singleline(noticed).desired_width(f32::INFINITY).char_limit(2000);
            ui.add(edit).labelled_by(label.id).request_focus();
            hints(ui, &[&keys.noticed]);
        }
        Screen::KnownTask => {
            body(ui, &words.known_task);
            hints(ui, &[&keys.yes, &keys.no]);
        }
        Screen::Trouble(why) => {
            ui.heading("Please call the experimenter.");
            body(
                ui,
                &format!("The answer could not be saved: {why}\nNothing is lost yet. Make room, then press Enter."),
            );
        }
        Screen::End(outcome) => {
            body(ui, if *outcome == Outcome::Completed { &words.end } else { ENDED });
        }
        Screen::Fixation | Screen::Picture(_) | Screen::Gap => {}
    });
}

/// The line that is on every screen of text of a demonstration.
pub(super) fn demo_notice(ui: &Ui, study: &Study) {
    if study.demo {
        line_at_the_foot(ui, &study.wording.demo_notice);
    }
}

/// The second step of an abort: shown over whatever is there, so that nothing that is being shown ends.
pub(super) fn abort_notice(ui: &Ui) {
    line_at_the_foot(ui, "Experimenter: F10 ends this session. Any other key goes on.");
}

/// A line in the middle of the window, over what is there.
pub(super) fn line_in_the_middle(ui: &Ui, text: &str) {
    line_at(ui, text, ui.ctx().content_rect().center().y);
}

fn line_at_the_foot(ui: &Ui, text: &str) {
    line_at(ui, text, ui.ctx().content_rect().bottom() - 24.0);
}

fn line_at(ui: &Ui, text: &str, middle: f32) {
    let screen = ui.ctx().content_rect();
    let font = TextStyle::Small.resolve(ui.style());
    let painter = ui.painter();
    let galley = painter.layout_no_wrap(text.to_owned(), font, INK);
    let corner = egui::pos2(screen.center().x - galley.size().x / 2.0, middle - galley.size().y / 2.0);
    let back = egui::Rect::from_min_size(corner, galley.size()).expand(6.0);
    painter.rect_filled(back, 0.0, BACKGROUND);
    painter.galley(corner, galley, INK);
}

/// What the experimenter did on the set-up screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum SetUp {
    /// Still typing.
    Stay,
    /// Wants to begin.
    Begin,
}

/// The experimenter's screen. It never names the arm, nor what the study is about: the participant may be looking.
pub(super) fn set_up(ui: &mut Ui, study: &Study, form: &mut Form, facts: &str, problem: &str) -> SetUp {
    let mut act = SetUp::Stay;
    let frame = egui::Frame::central_panel(ui.style()).inner_margin(32.0);
    egui::CentralPanel::default().frame(frame).show(ui, |ui| {
        egui::ScrollArea::vertical().show(ui, |ui| {
            ui.heading(format!("Study {}", study.id)); // its title may say what it is about
            ui.label(RichText::new(facts).small());
            egui::Grid::new("set-up").num_columns(2).spacing([16.0, 6.0]).show(ui, |ui| {
                let mut field = |label: &str, text: &mut String, hint: &str| {
                    let label = ui.label(label);
                    let edit = TextEdit::singleline(text).hint_text(hint).desired_width(360.0).char_limit(60);
                    let response = ui.add(edit).labelled_by(label.id);
                    ui.end_row();
                    response
                };
                let code = field("Participant's code (no name)", &mut form.code, "P01");
                if code.ctx.memory(|memory| memory.focused().is_none()) {
                    code.request_focus();
                }
                for (condition, answer) in CONDITIONS.iter().zip(&mut form.answers) {
                    field(condition.label, answer, condition.if_empty);
                }
            });
            ui.label(form.advice(study));
            ui.checkbox(&mut form.neutral, "Night light, HDR and colour management are off.");
            if ui.button("Begin (Enter)").clicked() {
                act = SetUp::Begin;
            }
            if !problem.is_empty() {
                ui.label(RichText::new(problem).strong());
            }
        });
    });
    act
}

/// A line in the middle of the window: preparing, or why there is no session.
pub(super) fn message(ui: &mut Ui, heading: &str, text: &str) {
    column(ui, |ui| {
        ui.heading(heading);
        body(ui, text);
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Relative luminance of an sRGB grey and the contrast of two colours (WCAG 2.2, success criterion 1.4.3).
    fn contrast(one: Color32, other: Color32) -> f64 {
        let luminance = |colour: Color32| {
            let linear = |code: u8| {
                let code = f64::from(code) / 255.0;
                if code <= 0.04045 { code / 12.92 } else { ((code + 0.055) / 1.055).powf(2.4) }
            };
            0.2126 * linear(colour.r()) + 0.7152 * linear(colour.g()) + 0.0722 * linear(colour.b())
        };
        let (a, b) = (luminance(one), luminance(other));
        (a.max(b) + 0.05) / (a.min(b) + 0.05)
    }

    #[test]
    fn every_text_has_a_contrast_of_4_5_at_least() {
        assert!((contrast(Color32::WHITE, Color32::BLACK) - 21.0).abs() < 1e-9);
        let context = egui::Context::default();
        style(&context);
        let visuals = &context.global_style().visuals;
        let (ink, hint) = (visuals.text_color(), visuals.weak_text_color());
        for (text, back) in [
            (ink, BACKGROUND),
            (ink, visuals.extreme_bg_color),
            (hint, visuals.extreme_bg_color),
            (ink, visuals.panel_fill),
        ] {
            assert!(contrast(text, back) >= 4.5, "{text:?} on {back:?}: {}", contrast(text, back));
        }
        for widget in [&visuals.widgets.inactive, &visuals.widgets.hovered, &visuals.widgets.active] {
            assert!(contrast(ink, widget.weak_bg_fill) >= 4.5, "{widget:?}");
        }
    }
}
