//! How often each component runs, and the crex that says so.

use crate::component::{Component, ComponentSet, PerComponent};

/// How many events of a component a path may have, roughly: the crex's groups decide the details.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Level {
    /// It never runs.
    #[default]
    Absent,
    /// It runs so often, and after each run everything of level [`Level::All`] until nothing is left.
    Times(u32),
    /// It runs until nothing is left.
    All,
}

impl Level {
    /// The level to try next for a component; `None` after [`Level::All`]. Transmission is followed to its end at once: what
    /// lies behind a pane is worth nothing until its last pane is passed. Diffuse light falls off slowly from event to
    /// event, and each costs as much as the one before, so it is taken in small steps.
    #[must_use]
    pub fn next(self, component: Component) -> Option<Self> {
        match (component, self) {
            (_, Self::All) => None,
            (Component::Transmitted, _) => Some(Self::All),
            (Component::Diffuse, Self::Absent | Self::Times(0)) => Some(Self::Times(1)),
            (Component::Diffuse, Self::Times(times)) if times < 4 => Some(Self::Times(2 * times)),
            (_, Self::Absent) => Some(Self::Times(1)),
            (_, Self::Times(_)) => Some(Self::All),
        }
    }
}

/// A level for each component, and the order in which they came to be wanted: those worth most for their time first.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Levels {
    levels: PerComponent<Level>,
    order: Vec<Component>,
}

impl Levels {
    /// Every one of `components` until nothing is left: the full solution.
    #[must_use]
    pub fn full(components: ComponentSet) -> Self {
        components.iter().fold(Self::default(), |levels, component| levels.with(component, Level::All))
    }

    /// The level of a component.
    #[must_use]
    pub fn level(&self, component: Component) -> Level {
        self.levels[component]
    }

    /// The same with another level for one component, which comes last in order if it was absent.
    #[must_use]
    pub fn with(&self, component: Component, level: Level) -> Self {
        let mut made = self.clone();
        made.levels[component] = level;
        if level == Level::Absent {
            made.order.retain(|&known| known != component);
        } else if !made.order.contains(&component) {
            made.order.push(component);
        }
        made
    }

    /// The components that run, in order.
    #[must_use]
    pub fn components(&self) -> &[Component] {
        &self.order
    }

    /// The crex: `(..)*` over the components of level [`Level::All`], repeated after each run of the others; of those the
    /// diffuse one is outermost, since its level counts what costs most.
    #[must_use]
    pub fn crex(&self) -> String {
        self.spelled(ComponentSet::EMPTY)
    }

    /// The same with the components of `modulated` in `{ }`.
    #[must_use]
    pub fn spelled(&self, modulated: ComponentSet) -> String {
        let all: Vec<Component> =
            self.order.iter().copied().filter(|&component| self.levels[component] == Level::All).collect();
        let mut text = letters(&all, modulated);
        if !all.is_empty() {
            // `T*`, `{T}*`, `(TR)*`, `(T{RS})*`
            let one_group = all.len() == 1;
            text = if one_group { format!("{text}*") } else { format!("({text})*") };
        }
        let mut counted: Vec<Component> = self.order.clone();
        counted.sort_by_key(|&component| component == Component::Diffuse);
        for component in counted {
            let Level::Times(times) = self.levels[component] else { continue };
            let letter = letters(&[component], modulated);
            text = match (text.is_empty(), times) {
                (true, 1) => letter,
                (true, _) => format!("{letter}{times}"),
                (false, 1) => format!("{text}{letter}{text}"),
                (false, _) => format!("{text}({letter}{text}){times}"),
            };
        }
        text
    }
}

/// Letters in a row, neighbours in `modulated` together in `{ }`.
fn letters(components: &[Component], modulated: ComponentSet) -> String {
    let mut text = String::new();
    let mut inside = false;
    for &component in components {
        let wanted = modulated.contains(component);
        if wanted != inside {
            text.push(if wanted { '{' } else { '}' });
            inside = wanted;
        }
        text.push(component.letter());
    }
    if inside {
        text.push('}');
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::crex;
    use Component::{Diffuse, Glossy, Mirror, Reflected, Specular, Transmitted};

    fn levels(wanted: &[(Component, Level)]) -> Levels {
        wanted.iter().fold(Levels::default(), |levels, &(component, level)| levels.with(component, level))
    }

    #[test]
    fn levels_are_spelled() {
        let cases = [
            (levels(&[]), ""),
            (levels(&[(Transmitted, Level::All)]), "T*"),
            (levels(&[(Diffuse, Level::Times(2))]), "D2"),
            (levels(&[(Reflected, Level::All), (Transmitted, Level::All)]), "(RT)*"),
            (levels(&[(Transmitted, Level::All), (Diffuse, Level::Times(1))]), "T*DT*"),
            (
                levels(&[(Diffuse, Level::Times(4)), (Transmitted, Level::All), (Specular, Level::All)]),
                "(TS)*(D(TS)*)4",
            ),
            (
                levels(&[(Diffuse, Level::Times(1)), (Mirror, Level::Times(1)), (Transmitted, Level::All)]),
                "T*MT*DT*MT*",
            ),
        ];
        for (levels, text) in cases {
            assert_eq!(levels.crex(), text);
        }
        let levels = levels(&[
            (Transmitted, Level::All),
            (Reflected, Level::All),
            (Glossy, Level::All),
            (Diffuse, Level::Times(2)),
        ]);
        let modulated = [Reflected, Glossy, Diffuse].into_iter().collect();
        assert_eq!(levels.spelled(modulated), "(T{RG})*({D}(T{RG})*)2");
        assert_eq!(levels.spelled(ComponentSet::ALL), "({TRG})*({D}({TRG})*)2");
    }

    #[test]
    fn every_spelling_parses_without_a_warning_about_itself() {
        let ladders = Component::ALL.map(|component| {
            let mut ladder = vec![Level::Absent];
            while let Some(level) = ladder.last().unwrap().next(component) {
                ladder.push(level);
            }
            ladder
        });
        let all: usize = ladders.iter().map(Vec::len).product();
        // All combinations, each with another half of the components modulated.
        for index in 0..all {
            let mut rest = index;
            let mut made = Levels::default();
            for (component, ladder) in Component::ALL.into_iter().zip(&ladders) {
                made = made.with(component, ladder[rest % ladder.len()]);
                rest /= ladder.len();
            }
            let modulated = Component::ALL.into_iter().filter(|&c| index >> c as usize & 1 == 1).collect();
            for text in [made.crex(), made.spelled(modulated)] {
                let ast = crex::parse(&text).unwrap_or_else(|_| panic!("{text}"));
                assert_eq!(crex::warnings(&ast, &crex::Setting::default()), [], "{text}");
                let run = crex::Program::new(&ast).components();
                assert_eq!(run, made.components().iter().copied().collect(), "{text}");
            }
        }
    }
}
