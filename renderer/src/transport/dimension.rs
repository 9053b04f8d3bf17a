//! The dimensions of the random numbers of a ray and its hit: every use has its own, so that none is used twice.

/// The place of a primary ray in its pixel.
pub(super) const PIXEL: u32 = 0;

/// The direction of a spawned ray; trial number i, after directions below the surface, takes the i-th from here.
pub(super) const DIRECTION: u32 = 1;

/// Whether a spawn is among those that are traced to learn what its kind costs.
pub(super) const PROBE: u32 = 31;

/// Russian roulette for the lobe of each step of a path (`PathKey::then`).
pub(super) const ROULETTE: u32 = 32;

/// Which way the number of samples is rounded that run the members of `{ }`.
pub(super) const IMPORTANCE: u32 = 48;

/// Which lights are tested for shadow.
pub(super) const CHOICE: u32 = 49;

/// The material of a mixture.
pub(super) const MIXTURE: u32 = 50;

/// The point of the lens.
pub(super) const LENS: u32 = 51;

/// Where and from which point of a light mist scatters, from here on.
pub(super) const MIST: u32 = 0x4000_0000;

/// The point on light number i, the i-th from here.
pub(super) const LIGHT: u32 = 64;
