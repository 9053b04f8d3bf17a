//! Where in the execution of a crex rays run: what a ray costs depends on where it was spawned, and so on that.

use std::fmt;
use std::str::FromStr;

use crate::component::Component;
use crate::work::Stage;

use super::cost::RayKind;

/// Runs of a letter that are told apart; later ones count as the last of these.
const LAST_RUN: u64 = 16;

/// The primary rays, or a letter of a crex and how often it has run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Place {
    kind: RayKind,
    /// Byte offset of the letter.
    letter: usize,
    /// From 1.
    run: u64,
}

impl Place {
    /// Of the primary rays.
    pub const PRIMARY: Self = Self { kind: RayKind::Primary, letter: 0, run: 1 };

    /// Of a component whose letter stands at a byte of the crex, in its run of that number, from 1.
    #[must_use]
    pub fn new(component: Component, letter: usize, run: u64) -> Self {
        Self { kind: RayKind::Of(component), letter, run: run.clamp(1, LAST_RUN) }
    }

    /// Of a stage.
    #[must_use]
    pub fn of(stage: &Stage) -> Self {
        Self::new(stage.component, stage.span.0, stage.run)
    }

    /// What kind of ray runs there.
    #[must_use]
    pub fn kind(self) -> RayKind {
        self.kind
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.kind {
            RayKind::Primary => write!(f, "primary"),
            RayKind::Of(component) => write!(f, "{component}@{} run {}", self.letter, self.run),
        }
    }
}

/// Not the text of a place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NoPlace;

impl FromStr for Place {
    type Err = NoPlace;

    fn from_str(text: &str) -> Result<Self, NoPlace> {
        if text == "primary" {
            return Ok(Self::PRIMARY);
        }
        let (component, rest) = text.split_once('@').ok_or(NoPlace)?;
        let (letter, run) = rest.split_once(" run ").ok_or(NoPlace)?;
        let mut letters = component.chars();
        let component = letters.next().and_then(Component::from_letter).ok_or(NoPlace)?;
        let place = Self::new(component, letter.parse().map_err(|_| NoPlace)?, run.parse().map_err(|_| NoPlace)?);
        // One spelling for each place.
        if place.to_string() == text { Ok(place) } else { Err(NoPlace) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_has_one_spelling() {
        for place in [Place::PRIMARY, Place::new(Component::Diffuse, 0, 1), Place::new(Component::Mirror, 17, 5)] {
            assert_eq!(place.to_string().parse(), Ok(place));
        }
        assert_eq!(Place::new(Component::Diffuse, 3, 1000), Place::new(Component::Diffuse, 3, LAST_RUN));
        for text in
            ["", "D", "D@", "D@1", "D@1 run ", "D@1 run 0", "D@01 run 1", "DD@1 run 1", "D@1 run 17", "x@1 run 1"]
        {
            assert_eq!(text.parse::<Place>(), Err(NoPlace), "{text}");
        }
    }
}
