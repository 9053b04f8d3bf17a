//! `mist`: volumes of a participating medium (Radiance reference manual).
//!
//! A ray remembers which mists it is in. What several mists take away adds up; how they scatter the one defined last
//! says. (In rpict a ray that leaves a mist with an albedo of its own forgets that of a mist around it.)

use glam::Vec3;

use super::{NameId, Scene, SourceId};
use crate::color::Rgb;
use crate::geometry::SurfaceId;
use crate::material::{ArgumentError, MistArguments, MistId};

/// Kinds of mist that a scene may have, at most.
pub(super) const MOST_MISTS: usize = 32;

/// A kind of mist.
#[derive(Clone, Debug)]
pub(super) struct Mist {
    arguments: MistArguments,
    /// The lights whose light it scatters, by the names of the surfaces: mirrors or prisms that relay it, then the light.
    names: Vec<Vec<NameId>>,
    /// Their numbers.
    lights: Vec<u32>,
}

/// Mists that a point lies in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Mists(u32);

impl Mists {
    /// None.
    pub const NONE: Self = Self(0);

    /// Whether there is none.
    #[must_use]
    pub fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// Whether `mist` is one of them.
    #[must_use]
    pub fn contains(self, mist: MistId) -> bool {
        self.0 >> mist.0 & 1 == 1
    }

    /// With `mist`.
    #[must_use]
    pub fn with(self, mist: MistId) -> Self {
        Self(self.0 | 1 << mist.0)
    }

    /// Without `mist`.
    #[must_use]
    pub fn without(self, mist: MistId) -> Self {
        Self(self.0 & !(1 << mist.0))
    }

    fn ids(self) -> impl Iterator<Item = usize> {
        (0..MOST_MISTS).filter(move |&index| self.0 >> index & 1 == 1)
    }
}

/// How mists scatter light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Haze {
    /// The part of what is taken away that is scattered rather than absorbed.
    pub albedo: Rgb,
    /// Henyey and Greenstein's eccentricity: 0 scatters every way alike, towards 1 more and more ahead.
    pub eccentricity: f64,
}

impl Scene {
    /// Whether the scene has mist anywhere.
    #[must_use]
    pub fn has_mist(&self) -> bool {
        !self.mists.is_empty()
    }

    /// Extinction in some mists, per unit of length.
    #[must_use]
    pub fn extinction(&self, mists: Mists) -> Vec3 {
        mists.ids().map(|index| self.mists[index].arguments.extinction.as_vec3()).sum()
    }

    /// How some mists scatter.
    #[must_use]
    pub fn haze(&self, mists: Mists) -> Haze {
        let mut haze = Haze { albedo: Rgb::ZERO, eccentricity: 0.0 };
        for index in mists.ids() {
            let arguments = &self.mists[index].arguments;
            haze.albedo = arguments.albedo.unwrap_or(haze.albedo);
            haze.eccentricity = arguments.eccentricity.unwrap_or(haze.eccentricity);
        }
        haze
    }

    /// The numbers of the lights whose light some mists scatter, each once.
    pub fn scattered_lights(&self, mists: Mists) -> impl Iterator<Item = u32> {
        mists.ids().flat_map(move |index| {
            let listed_before = move |light: &u32| {
                mists.ids().take_while(|&other| other < index).any(|other| self.mists[other].lights.contains(light))
            };
            self.mists[index].lights.iter().copied().filter(move |light| !listed_before(light))
        })
    }

    /// Adds a kind of mist.
    pub(super) fn add_mist(&mut self, reals: &[f64], paths: &[String]) -> Result<Option<MistId>, ArgumentError> {
        let arguments = MistArguments::from_reals(reals)?;
        let names = paths.iter().map(|path| path.split('>').map(|name| self.names.id(name)).collect()).collect();
        let id = u32::try_from(self.mists.len()).ok().filter(|_| self.mists.len() < MOST_MISTS).map(MistId);
        if id.is_some() {
            self.mists.push(Mist { arguments, names, lights: Vec::new() });
        }
        Ok(id)
    }

    /// Finds the lights that mists name: of several of a name the last.
    pub(super) fn find_scattered_lights(&mut self) {
        let mut mists = std::mem::take(&mut self.mists);
        for mist in &mut mists {
            mist.lights.clear();
            for path in &mist.names {
                let found = self.lights.iter().rposition(|light| {
                    let relays = light.relay().iter().map(|&surface| self.surfaces[surface.index()].name);
                    relays.chain([self.light_name(light.source())]).eq(path.iter().copied())
                });
                let number = found.and_then(|index| u32::try_from(index).ok());
                mist.lights.extend(number.filter(|number| !mist.lights.contains(number)));
            }
        }
        self.mists = mists;
    }

    fn light_name(&self, source: SourceId) -> NameId {
        match source {
            SourceId::Surface(SurfaceId(index)) => self.surfaces[index as usize].name,
            SourceId::Far(far) => self.far[far.index()].name,
        }
    }

    /// Whether a mist's light, as the primitive names it, is there, relays aside.
    pub(super) fn is_light(&self, path: &str) -> bool {
        let name = path.rsplit('>').next().unwrap_or(path);
        self.lights.iter().any(|light| self.name(self.light_name(light.source())) == name)
    }
}
