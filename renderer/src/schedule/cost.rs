//! What rays of a kind have cost so far: a running mean weighted by rays, as in section 5.1 of the paper, and its spread.

use crate::component::Component;

/// A kind of ray with costs of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum RayKind {
    /// Rays from the eye.
    Primary,
    /// Rays spawned by an event of this component.
    Of(Component),
}

impl RayKind {
    /// All seven, primary rays first.
    pub const ALL: [Self; 7] = [
        Self::Primary,
        Self::Of(Component::Diffuse),
        Self::Of(Component::Specular),
        Self::Of(Component::Glossy),
        Self::Of(Component::Transmitted),
        Self::Of(Component::Reflected),
        Self::Of(Component::Mirror),
    ];

    /// Its place in [`Self::ALL`].
    #[must_use]
    pub fn index(self) -> usize {
        match self {
            Self::Primary => 0,
            Self::Of(component) => 1 + component as usize,
        }
    }
}

/// The cost of one kind of ray, learnt from observations: sets of rays traced together and timed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Cost {
    /// Rays observed.
    rays: u64,
    /// Observations.
    observations: u64,
    /// Seconds a ray: the mean over all rays.
    mean_s: f64,
    /// Sum over observations of rays x (seconds a ray - mean)^2.
    squares: f64,
    /// Sum over observations of rays^2.
    weight_squares: f64,
}

impl Cost {
    /// Takes in that `rays` rays took `seconds` together. Nothing happens without rays, or with seconds that are not a finite
    /// number of at least 0.
    pub fn observe(&mut self, rays: u64, seconds: f64) {
        if rays == 0 || !seconds.is_finite() || seconds < 0.0 {
            return;
        }
        let weight = rays as f64;
        self.add(&Self {
            rays,
            observations: 1,
            mean_s: seconds / weight,
            squares: 0.0,
            weight_squares: weight * weight,
        });
    }

    /// Takes in all that another has observed: weighted means and squared deviations add up by the rule of Chan, Golub and
    /// LeVeque (1979).
    pub fn add(&mut self, other: &Self) {
        if other.rays == 0 {
            return;
        }
        let (ours, theirs) = (self.rays as f64, other.rays as f64);
        let all = ours + theirs;
        let apart = other.mean_s - self.mean_s;
        self.mean_s += apart * theirs / all;
        self.squares += other.squares + apart * apart * ours * theirs / all;
        self.weight_squares += other.weight_squares;
        self.rays = self.rays.saturating_add(other.rays);
        self.observations = self.observations.saturating_add(other.observations);
    }

    /// The cost of the same rays if all of them had taken so many times as long.
    #[must_use]
    pub fn scaled(self, times: f64) -> Self {
        Self { mean_s: times * self.mean_s, squares: times * times * self.squares, ..self }
    }

    /// A cost as it was stored; none if these are not numbers that observations can amount to.
    pub(super) fn from_parts(rays: u64, observations: u64, mean_s: f64, spread_s: f64, effective: f64) -> Option<Self> {
        let weight = rays as f64;
        let fits = rays > 0
            && observations > 0
            && [mean_s, spread_s].iter().all(|value| value.is_finite() && *value >= 0.0)
            && effective >= 1.0
            && effective <= observations as f64 * (1.0 + 1e-9);
        let unbiased = if effective > 1.0 { (effective - 1.0) / effective } else { 0.0 };
        let squares = spread_s * spread_s * weight * unbiased;
        (fits && squares.is_finite()).then(|| Self {
            rays,
            observations,
            mean_s,
            squares,
            weight_squares: weight * weight / effective,
        })
    }

    /// Rays observed.
    #[must_use]
    pub fn rays(&self) -> u64 {
        self.rays
    }

    /// Observations.
    #[must_use]
    pub fn observations(&self) -> u64 {
        self.observations
    }

    /// Seconds a ray, the mean over all rays observed; 0 before the first.
    #[must_use]
    pub fn mean_s(&self) -> f64 {
        self.mean_s
    }

    /// How many observations of equal size would say as much as these: (sum of rays)^2 / sum of rays^2.
    #[must_use]
    pub fn effective_observations(&self) -> f64 {
        if self.rays == 0 { 0.0 } else { (self.rays as f64).powi(2) / self.weight_squares }
    }

    /// Standard deviation, between observations, of their seconds a ray; weighted by rays and without bias. 0 before
    /// there are two.
    #[must_use]
    pub fn spread_s(&self) -> f64 {
        let effective = self.effective_observations();
        if effective <= 1.0 + 1e-9 {
            return 0.0;
        }
        (self.squares / self.rays as f64 * effective / (effective - 1.0)).max(0.0).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn observed(observations: &[(u64, f64)]) -> Cost {
        let mut cost = Cost::default();
        for &(rays, seconds) in observations {
            cost.observe(rays, seconds);
        }
        cost
    }

    fn near(one: f64, other: f64) -> bool {
        (one - other).abs() <= 1e-9 * (one.abs() + other.abs()) + 1e-15
    }

    #[test]
    fn the_mean_is_weighted_by_rays() {
        // The paper: a frame's cost joins the cache by its number of rays.
        let cost = observed(&[(100, 1.0), (300, 1.0)]);
        assert!(near(cost.mean_s(), 2.0 / 400.0));
        assert_eq!((cost.rays(), cost.observations()), (400, 2));
        // Equal weights: the textbook's standard deviation of 1, 2, 3, 4.
        let cost = observed(&[(1, 1.0), (1, 2.0), (1, 3.0), (1, 4.0)]);
        assert!(near(cost.spread_s(), (5.0f64 / 3.0).sqrt()));
        assert!(near(cost.effective_observations(), 4.0));
        assert_eq!(observed(&[(7, 1.0)]).spread_s(), 0.0);
        assert_eq!(observed(&[(0, 1.0), (1, f64::NAN), (1, -1.0)]), Cost::default());
    }

    proptest! {
        #[test]
        fn observations_add_up_in_any_split(
            observations in prop::collection::vec((1..100_000u64, 0.0..10.0f64), 1..20),
            split in any::<prop::sample::Index>(),
        ) {
            let whole = observed(&observations);
            let (head, tail) = observations.split_at(split.index(observations.len()));
            let mut sum = observed(head);
            sum.add(&observed(tail));
            let rays: u64 = observations.iter().map(|o| o.0).sum();
            let seconds: f64 = observations.iter().map(|o| o.1).sum();
            prop_assert!(near(whole.mean_s() * rays as f64, seconds));
            prop_assert_eq!(sum.rays(), whole.rays());
            prop_assert!(near(sum.mean_s(), whole.mean_s()));
            prop_assert!((sum.spread_s() - whole.spread_s()).abs() <= 1e-6 * whole.spread_s() + 1e-12);
            let stored = Cost::from_parts(
                whole.rays(), whole.observations(), whole.mean_s(), whole.spread_s(), whole.effective_observations(),
            );
            let stored = stored.expect("what was observed can be stored");
            prop_assert!((stored.spread_s() - whole.spread_s()).abs() <= 1e-6 * whole.spread_s() + 1e-12);
            let thrice: Vec<_> = observations.iter().map(|&(rays, seconds)| (rays, 3.0 * seconds)).collect();
            let (thrice, scaled) = (observed(&thrice), whole.scaled(3.0));
            prop_assert!(near(thrice.mean_s(), scaled.mean_s()));
            prop_assert!((thrice.spread_s() - scaled.spread_s()).abs() <= 1e-6 * thrice.spread_s() + 1e-12);
        }
    }
}
