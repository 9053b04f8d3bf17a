//! `prism1` and `prism2`: a thin sheet that sends light on in directions of the scene's own choice.

use glam::DVec3;

use super::Event;
use super::lobe::{Lobe, Spread};
use crate::color::Rgb;

/// Such a sheet at a hit: up to two ways on, each a unit vector and the fraction of radiance that comes from there; a
/// fraction of 0 is none.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Prism {
    /// The ways.
    pub ways: [(DVec3, f64); 2],
}

impl Prism {
    /// Gives each way to `spawn`, in a fixed order.
    pub fn scatter(&self, mut spawn: impl FnMut(Lobe)) {
        for (direction, fraction) in self.ways {
            if fraction > 0.0 {
                let (event, spread) = (Event::PrismTransmission, Spread::Ideal(direction));
                spawn(Lobe { event, spread, coefficient: Rgb::splat(fraction), medium: None });
            }
        }
    }
}
