//! egui's key events to the session's keys, by place on the keyboard.

use crate::input::Key;

/// What happened to a key.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Stroke {
    /// It went down. Repeats of a held key are left out.
    Down(Key),
    /// It went up.
    Up(Key),
}

/// The strokes of this pass, in order.
pub(super) fn strokes(context: &egui::Context) -> Vec<Stroke> {
    context.input(|input| input.events.iter().filter_map(stroke).collect())
}

fn stroke(event: &egui::Event) -> Option<Stroke> {
    let egui::Event::Key { key, physical_key, pressed, repeat, .. } = event else { return None };
    let key = place(physical_key.unwrap_or(*key));
    match (pressed, repeat) {
        (true, false) => Some(Stroke::Down(key)),
        (true, true) => None,
        (false, _) => Some(Stroke::Up(key)),
    }
}

fn place(key: egui::Key) -> Key {
    match key {
        egui::Key::Num0 => Key::Digit(0),
        egui::Key::Num1 => Key::Digit(1),
        egui::Key::Num2 => Key::Digit(2),
        egui::Key::Num3 => Key::Digit(3),
        egui::Key::Num4 => Key::Digit(4),
        egui::Key::Num5 => Key::Digit(5),
        egui::Key::Num6 => Key::Digit(6),
        egui::Key::Num7 => Key::Digit(7),
        egui::Key::Num8 => Key::Digit(8),
        egui::Key::Num9 => Key::Digit(9),
        egui::Key::Enter => Key::Enter,
        egui::Key::Space => Key::Space,
        egui::Key::Backspace => Key::Backspace,
        egui::Key::Escape => Key::Escape,
        egui::Key::F10 => Key::F10,
        _ => Key::Other,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn event(key: egui::Key, physical_key: Option<egui::Key>, pressed: bool, repeat: bool) -> egui::Event {
        egui::Event::Key { key, physical_key, pressed, repeat, modifiers: egui::Modifiers::NONE }
    }

    #[test]
    fn the_place_counts_and_not_what_is_printed_on_it() {
        // The digit row of a French keyboard types other characters without Shift.
        let french = event(egui::Key::Quote, Some(egui::Key::Num4), true, false);
        assert_eq!(stroke(&french), Some(Stroke::Down(Key::Digit(4))));
        let unknown = event(egui::Key::Num7, None, true, false);
        assert_eq!(stroke(&unknown), Some(Stroke::Down(Key::Digit(7))));
    }

    #[test]
    fn a_held_key_is_pressed_once() {
        assert_eq!(stroke(&event(egui::Key::Num1, Some(egui::Key::Num1), true, true)), None);
        let up = event(egui::Key::Escape, Some(egui::Key::Escape), false, false);
        assert_eq!(stroke(&up), Some(Stroke::Up(Key::Escape)));
        assert_eq!(stroke(&egui::Event::Text("1".to_owned())), None);
    }
}
