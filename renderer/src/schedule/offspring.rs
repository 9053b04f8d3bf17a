//! What rays spawn on average along complete paths.

use crate::component::{Component, PerComponent};

/// Rays of one kind and what they spawned, counted over paths that ran through the whole crex.
///
/// How many children a ray has falls from generation to generation: late ones weigh less and meet `-lw`. Where a path is
/// cut short, its early generations are counted and its late ones are missing, and the mean is far too high; over complete
/// paths the mean is just what turns the first generation into the sum of all.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Offspring {
    parents: u64,
    spawned: PerComponent<u64>,
}

impl Offspring {
    /// So many rays with their children, by component.
    #[must_use]
    pub fn new(parents: u64, spawned: PerComponent<u64>) -> Self {
        Self { parents, spawned }
    }

    /// Takes in others.
    pub fn add(&mut self, other: &Self) {
        self.parents = self.parents.saturating_add(other.parents);
        for (component, count) in self.spawned.iter_mut() {
            *count = count.saturating_add(other.spawned[component]);
        }
    }

    /// Rays counted.
    #[must_use]
    pub fn parents(&self) -> u64 {
        self.parents
    }

    /// Their children, by component.
    #[must_use]
    pub fn spawned(&self) -> &PerComponent<u64> {
        &self.spawned
    }

    /// Children of `component` that a ray has on average; 0 before the first ray.
    #[must_use]
    pub fn per_ray(&self, component: Component) -> f64 {
        if self.parents == 0 { 0.0 } else { self.spawned[component] as f64 / self.parents as f64 }
    }
}
