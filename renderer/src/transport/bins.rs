//! The bins: for each component, what its rays have yet to be made of.

use glam::DVec3;

use crate::color::Rgb;
use crate::component::{Component, ComponentSet, PerComponent};
use crate::geometry::SurfaceId;
use crate::material::Spread;
use crate::work::BinOccupancy;

use super::ray::RayPath;

/// Rays that one lobe of one hit spawned. They get their directions when the bin runs, so memory follows the number of
/// hits and not the number of rays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpawnRecord {
    /// Where the rays start.
    pub origin: DVec3,
    /// The surface that they leave.
    pub leaving: SurfaceId,
    /// How many there are, at least 1.
    pub count: u32,
    /// Their directions.
    pub spread: Spread,
    /// The ripple of each.
    pub ripple: Rgb,
    /// The path of each; of `count` rays, number i has the sample number `sample * count + i`.
    pub path: RayPath,
}

/// The rays of one component that wait.
#[derive(Clone, Debug, Default)]
struct RayBin {
    visible: Vec<SpawnRecord>,
    visible_rays: u64,
    held: Vec<SpawnRecord>,
    held_rays: u64,
}

/// The bins of all components over some pixels.
#[derive(Clone, Debug, Default)]
pub struct RayBins {
    bins: PerComponent<RayBin>,
    /// Components that have a bin.
    stored: ComponentSet,
    /// Rays of the others, which nothing will run.
    dropped: PerComponent<u64>,
    /// Room for the records of a bin while it runs.
    spare: Vec<SpawnRecord>,
}

impl RayBins {
    /// Empties all bins, keeping their memory, and gives bins to the components in `stored` only: rays of the others,
    /// which nothing will run, are merely counted.
    pub fn clear(&mut self, stored: ComponentSet) {
        self.stored = stored;
        self.dropped = PerComponent::default();
        for (_, bin) in self.bins.iter_mut() {
            bin.visible.clear();
            bin.held.clear();
            (bin.visible_rays, bin.held_rays) = (0, 0);
        }
    }

    /// Whether a component has a bin.
    #[must_use]
    pub fn stores(&self, component: Component) -> bool {
        self.stored.contains(component)
    }

    /// Counts rays of a component without a bin.
    pub fn count_dropped(&mut self, component: Component, rays: u32) {
        self.dropped[component] += u64::from(rays);
    }

    /// Puts a record into a component's bin: `held` ones stay hidden until [`Self::release`].
    pub fn push(&mut self, component: Component, record: SpawnRecord, held: bool) {
        let bin = &mut self.bins[component];
        let rays = u64::from(record.count);
        if held {
            bin.held.push(record);
            bin.held_rays += rays;
        } else {
            bin.visible.push(record);
            bin.visible_rays += rays;
        }
    }

    /// Takes every visible record out of a component's bin. Give the vector to [`Self::give_back`] when it has been
    /// worked off.
    pub fn take(&mut self, component: Component) -> Vec<SpawnRecord> {
        let bin = &mut self.bins[component];
        bin.visible_rays = 0;
        std::mem::replace(&mut bin.visible, std::mem::take(&mut self.spare))
    }

    /// Returns the memory of [`Self::take`]; what is still in the vector is dropped.
    pub fn give_back(&mut self, mut records: Vec<SpawnRecord>) {
        records.clear();
        if records.capacity() > self.spare.capacity() {
            self.spare = records;
        }
    }

    /// Makes all held rays visible.
    pub fn release(&mut self) {
        for (_, bin) in self.bins.iter_mut() {
            bin.visible.append(&mut bin.held);
            bin.visible_rays += std::mem::take(&mut bin.held_rays);
        }
    }

    /// Rays now visible, by component.
    #[must_use]
    pub fn occupancy(&self) -> BinOccupancy {
        PerComponent::from_fn(|component| self.bins[component].visible_rays)
    }

    /// All rays that were spawned and not taken, held ones and those without a bin included, by component.
    #[must_use]
    pub fn left(&self) -> PerComponent<u64> {
        PerComponent::from_fn(|component| {
            let bin = &self.bins[component];
            bin.visible_rays + bin.held_rays + self.dropped[component]
        })
    }

    /// The components that have a bin.
    #[must_use]
    pub fn stored(&self) -> ComponentSet {
        self.stored
    }

    /// The visible records of a component's bin.
    #[must_use]
    pub fn visible(&self, component: Component) -> &[SpawnRecord] {
        &self.bins[component].visible
    }

    /// The records that wait in a component's bin, held ones included.
    pub fn waiting(&self, component: Component) -> impl Iterator<Item = &SpawnRecord> {
        let bin = &self.bins[component];
        bin.visible.iter().chain(&bin.held)
    }
}
