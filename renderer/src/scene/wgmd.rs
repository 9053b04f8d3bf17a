//! `WGMDfunc`, before its functions and modifiers have been asked what it is at a hit.

use std::sync::Arc;

use glam::DVec3;

use super::program::reflection;
use crate::color::Rgb;
use crate::material::{Event, Facet, Interaction, Sheen, Wgmd};
use crate::pattern::{self, Evaluator, Field, Finish, Place, Step};

/// What a part wears.
#[derive(Clone, Debug)]
pub(super) enum Wear {
    /// What the material itself wears: `inherit`.
    Main,
    /// Its own patterns and textures; none is `void`.
    Own(Arc<[Step]>),
}

/// A glossy part.
#[derive(Clone, Debug)]
pub(super) struct Gloss {
    pub(super) wear: Wear,
    /// The fraction.
    pub(super) coefficient: Field,
    /// Roughness along the axis and across it.
    pub(super) roughness: Field,
}

/// The parts of a `WGMDfunc`.
#[derive(Clone, Debug)]
pub(super) struct Parts {
    /// Diffuse reflection in front and behind, and diffuse transmission.
    pub(super) diffuse: [Rgb; 3],
    /// What the diffuse transmission wears.
    pub(super) through: Wear,
    /// `None` where the coefficient is written as 0.
    pub(super) reflected: Option<Gloss>,
    /// Likewise.
    pub(super) passed: Option<Gloss>,
    /// Along which the first roughnesses count.
    pub(super) axis: Field,
}

impl Wear {
    fn finish(&self, place: &Place<'_>, main: (Rgb, DVec3), evaluator: &mut Evaluator<'_>) -> Finish {
        match self {
            Self::Main => Finish { tint: main.0, bend: main.1 },
            Self::Own(steps) => {
                let mut finish = Finish::default();
                pattern::apply(steps, place, evaluator, &mut finish);
                finish
            }
        }
    }
}

impl Gloss {
    /// `None` where a function fails: then the part is black, as in rpict.
    fn at(&self, place: &Place<'_>, main: (Rgb, DVec3), evaluator: &mut Evaluator<'_>) -> Option<Sheen> {
        /// Radiance's FTINY: a fraction below is nothing.
        const LEAST: f64 = 1e-6;
        /// Where a fraction or a roughness saturates.
        const MOST: f64 = 1e30;
        let finish = self.wear.finish(place, main, evaluator);
        let reflection = reflection(place, finish.bend, finish.tint);
        let [coefficient, ..] = self.coefficient.reflected(place, Some(&reflection), evaluator)?;
        if coefficient <= LEAST {
            return None;
        }
        let [along, across, _] = self.roughness.reflected(place, Some(&reflection), evaluator)?;
        let color = finish.tint.max(Rgb::ZERO) * coefficient.min(MOST);
        let roughness = [along, across].map(|roughness| roughness.clamp(0.0, MOST));
        Some(Sheen { facet: Facet { color, normal: reflection.normal }, roughness })
    }
}

impl Parts {
    /// The material at a hit, whose own patterns and textures are `main`.
    pub(super) fn at(&self, place: &Place<'_>, main: (Rgb, DVec3), evaluator: &mut Evaluator<'_>) -> Option<Wgmd> {
        let front = place.dir.dot(place.normal) < 0.0;
        let normal = |bend: DVec3| {
            let bent = bend != DVec3::ZERO;
            let interaction = if bent {
                Interaction::bent(place.dir, place.normal, bend)
            } else {
                Interaction::new(place.dir, place.normal)
            };
            interaction.normal
        };
        let [before, behind, through] = self.diffuse;
        let color = if front { before } else { behind } * main.0.max(Rgb::ZERO);
        let diffuse = Facet { color, normal: normal(main.1) };
        let mut diffuse_through = Facet { color: Rgb::ZERO, normal: normal(DVec3::ZERO) };
        if through != Rgb::ZERO {
            let finish = self.through.finish(place, main, evaluator);
            diffuse_through = Facet { color: through * finish.tint.max(Rgb::ZERO), normal: normal(finish.bend) };
        }
        let black = Sheen { facet: Facet { color: Rgb::ZERO, normal: normal(DVec3::ZERO) }, roughness: [0.0; 2] };
        let mut sheen =
            |gloss: &Option<Gloss>| gloss.as_ref().and_then(|gloss| gloss.at(place, main, evaluator)).unwrap_or(black);
        let sheens = [sheen(&self.reflected), sheen(&self.passed)];
        let axis = self.axis.values(place, evaluator).map_or(DVec3::ZERO, DVec3::from);
        let axis = place.turned_back(&self.axis.to_local, axis);
        Some(Wgmd::new((place.dir, place.normal), [diffuse, diffuse_through], sheens, axis))
    }

    /// What can happen to light.
    pub(super) fn events(&self) -> Vec<Event> {
        let mut events = vec![Event::DiffuseReflection];
        if self.reflected.is_some() {
            events.extend([Event::SmoothReflection, Event::RoughReflection]);
        }
        if self.passed.is_some() {
            events.extend([Event::SmoothTransmission, Event::RoughTransmission]);
        }
        events
    }
}
