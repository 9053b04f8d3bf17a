//! All shapes of a scene in a bounding volume hierarchy. The only file that names obvhs.
//!
//! The hierarchy is traversed in `f32`, in a frame where the scene fills [-1, 1]^3; its boxes are rounded outward and
//! padded by more than that arithmetic can err, and the leaves are met in `f64`. So no hit is lost, whatever the unit or
//! the place of the scene, and the answer is the one of testing every shape.

use std::ops::ControlFlow;
use std::time::Duration;

use glam::{DVec3, Vec3A};
use obvhs::bvh2::Bvh2;
use obvhs::{BvhBuildParams, aabb::Aabb};

use super::block::{Part, fan};
use super::coincident::{Box3, Coincident};
use super::lanes::Level;
use super::line::Line;
use super::outliers::outliers;
use super::shape::{Probe, Shape};
use super::wide::Wide;
use super::widen::{Pair, widen};
use super::{Hit, Ray, SurfaceId};
use crate::math::tolerance;

/// Growth of every box, in a frame where the scene's half extent is 1. The slab test in `f32` errs by at most 7e-7 there:
/// three roundings (6e-8 each) of distances up to 2, and as much for the rounded origin and direction.
const PADDING: f64 = 4e-6;

/// Polygons of more vertices are met one by one.
const MOST_VERTICES: usize = 6;

/// What a surface does to a shadow ray that meets it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Passage {
    /// Stops it.
    Opaque,
    /// Lets it go straight on, weakened perhaps: glass, smooth trans, an illum without alternate.
    Straight,
    /// Bends it: dielectric.
    Refracting,
}

/// A shape as the aggregate needs it.
#[derive(Clone, Debug)]
pub struct Item {
    /// The geometry.
    pub shape: Shape,
    /// Its number in the scene.
    pub surface: SurfaceId,
    /// What it does to shadow rays.
    pub passage: Passage,
    /// Among coincident surfaces alike in opacity and side the one of higher precedence is met.
    pub precedence: u32,
}

/// What lies on the way of a shadow ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shadow {
    /// Nothing but the straight crossings that were listed.
    Clear,
    /// An opaque surface, with nothing before it that bends rays.
    Blocked,
    /// Something that bends rays: the caller has to follow the ray by [`Aggregate::closest`].
    Refracted,
}

/// The shapes of a scene, ready for rays. Shared freely between threads.
pub struct Aggregate {
    bvh: Wide,
    /// Those of the hierarchy in its order, then the outliers.
    items: Vec<Item>,
    /// How many are in the hierarchy.
    in_bvh: usize,
    /// Centre of the hierarchy's bounds.
    centre: DVec3,
    /// Half the largest extent of the hierarchy's bounds.
    half_extent: f64,
    /// Half the diagonal of the hierarchy's bounds.
    radius: f64,
    has_straight: bool,
    has_refracting: bool,
}

impl std::fmt::Debug for Aggregate {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} shapes", self.items.len())
    }
}

/// A ray within the bounds of the scene, in the hierarchy's frame.
struct Entry {
    line: Line,
    /// Distance from the real origin to the ray's.
    skipped: f64,
}

impl Aggregate {
    /// Builds the hierarchy. Deterministic: the same items give the same tree.
    #[must_use]
    pub fn new(items: impl IntoIterator<Item = Item>) -> Self {
        Self::at_level(items, Level::best())
    }

    /// The same, walked by the instructions of a level.
    pub(super) fn at_level(items: impl IntoIterator<Item = Item>, level: Level) -> Self {
        let mut slots: Vec<Option<Item>> = items.into_iter().map(Some).collect();
        let bounds: Vec<[DVec3; 2]> = slots.iter().flatten().map(|item| item.shape.bounds()).collect();
        let (outliers, [low, high]) = outliers(&bounds);
        let (centre, half) =
            if bounds.is_empty() { (DVec3::ZERO, DVec3::ZERO) } else { (low + (high - low) * 0.5, (high - low) * 0.5) };
        // A scene that is smaller than a digit of its coordinates has no extent to divide by.
        let half_extent = half.max_element().max(f64::EPSILON * centre.abs().max_element()).max(f64::MIN_POSITIVE);
        let inner: Vec<usize> = (0..bounds.len()).filter(|index| outliers.binary_search(index).is_err()).collect();
        let boxes: Vec<Box3> = inner
            .iter()
            .map(|&index| {
                let [low, high] = bounds[index];
                let padded = [(low - centre) / half_extent - PADDING, (high - centre) / half_extent + PADDING];
                [round_down(padded[0]), round_up(padded[1])]
            })
            .collect();
        let coincident = Coincident::new(&boxes);
        let bvh = if boxes.is_empty() {
            Bvh2::default()
        } else {
            // Leaves are made of what fits into blocks.
            let build = BvhBuildParams { max_prims_per_leaf: 1, ..BvhBuildParams::medium_build() };
            let boxes: Vec<Aabb> = coincident.boxes().map(|[low, high]| Aabb::new(low, high)).collect();
            obvhs::bvh2::builder::build_bvh2(&boxes, build, &mut Duration::default())
        };
        let own = bvh.nodes.len() as u32;
        let pair = |index: u32| match bvh.nodes.get(index as usize) {
            Some(node) if node.prim_count == 0 => {
                let Aabb { min: low, max: high } = *node.aabb();
                Pair { low, high, first: node.first_index, is_leaf: false }
            }
            Some(node) => coincident.pair(bvh.primitive_indices[node.first_index as usize], own),
            None => coincident.pair(index - own, own),
        };
        let parts = |slot: u32, found: &mut Vec<Part>| {
            let item = slots[inner[slot as usize]].as_ref();
            let Some(vertices) = item.and_then(|it| it.shape.vertices()).filter(|it| it.len() <= MOST_VERTICES) else {
                return;
            };
            found.extend(fan(slot, vertices.iter().map(|&vertex| ((vertex - centre) / half_extent).as_vec3())));
        };
        let root = (!bvh.nodes.is_empty()).then(|| pair(0));
        let (bvh, order) = widen(root, pair, level, parts);
        let order = order.into_iter().map(|at| inner[at as usize]).chain(outliers);
        let items: Vec<Item> = order.filter_map(|index| slots[index].take()).collect();
        let has = |passage| items.iter().any(|item| item.passage == passage);
        Self {
            in_bvh: inner.len(),
            centre,
            half_extent,
            radius: half.length(),
            has_straight: has(Passage::Straight),
            has_refracting: has(Passage::Refracting),
            items,
            bvh,
        }
    }

    /// Number of shapes.
    #[must_use]
    pub fn len(&self) -> usize {
        self.items.len()
    }

    /// Whether there is no shape at all.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.items.is_empty()
    }

    /// Centre of the bounds of all shapes but outliers (a few that are far larger or further away than all others).
    #[must_use]
    pub fn centre(&self) -> DVec3 {
        self.centre
    }

    /// Half the diagonal of those bounds, in the scene's unit.
    #[must_use]
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// The nearest surface that the ray meets. Of coincident surfaces the opaque one is met rather than a
    /// transparent one, then the one seen from the front, then the one of higher precedence.
    #[must_use]
    pub fn closest(&self, ray: &Ray) -> Option<Hit> {
        let probe = Probe::new(ray.origin, ray.dir);
        let window = tolerance::least_distance(ray.origin, self.radius);
        let mut best: Option<(f64, usize)> = None;
        let mut crowded = false;
        let _ = self.walk::<true>(ray, &probe, |slot| {
            let item = &self.items[slot];
            let t_max = best.map_or(ray.t_max, |(t, _)| t + window);
            let met = item.shape.meet(&probe, ray.leaving == Some(item.surface), window, t_max);
            let Some(t) = met else { return ControlFlow::Continue(None) };
            if let Some((nearest, _)) = best {
                crowded |= (t - nearest).abs() <= window;
                if t >= nearest {
                    return ControlFlow::Continue(None);
                }
            }
            best = Some((t, slot));
            // What coincides with it counts, wherever its box begins.
            ControlFlow::Continue(Some(t + window))
        });
        let (nearest, mut slot) = best?;
        if crowded {
            slot = self.preferred(ray, &probe, nearest, window).unwrap_or(slot);
        }
        Some(self.hit(ray, nearest, slot))
    }

    /// Whether any surface that `counts` says so of meets the ray.
    #[must_use]
    pub fn occluded(&self, ray: &Ray, mut counts: impl FnMut(SurfaceId) -> bool) -> bool {
        let probe = Probe::new(ray.origin, ray.dir);
        let t_min = tolerance::least_distance(ray.origin, self.radius);
        let walk = self.walk::<false>(ray, &probe, |slot| {
            let item = &self.items[slot];
            let found = counts(item.surface)
                && item.shape.meet(&probe, ray.leaving == Some(item.surface), t_min, ray.t_max).is_some();
            if found { ControlFlow::Break(()) } else { ControlFlow::Continue(None) }
        });
        walk.is_break()
    }

    /// What a shadow ray meets before `ray.t_max`; the surface that it aims at, `target`, is no obstacle.
    ///
    /// `crossings` is cleared and, if the answer is [`Shadow::Clear`], filled with the surfaces that it goes straight
    /// through, nearest first, coincident ones only once. Reuse it between calls: then nothing is allocated.
    pub fn shadow(&self, ray: &Ray, target: Option<SurfaceId>, crossings: &mut Vec<Hit>) -> Shadow {
        crossings.clear();
        let probe = Probe::new(ray.origin, ray.dir);
        let window = tolerance::least_distance(ray.origin, self.radius);
        let mut blocked_at = f64::INFINITY;
        let mut bent_at = f64::INFINITY;
        let _ = self.walk::<false>(ray, &probe, |slot| {
            let item = &self.items[slot];
            if Some(item.surface) == target {
                return ControlFlow::Continue(None);
            }
            let leaving = ray.leaving == Some(item.surface);
            match item.passage {
                Passage::Opaque => {
                    if let Some(t) = item.shape.meet(&probe, leaving, window, ray.t_max.min(blocked_at)) {
                        blocked_at = t;
                        // Only what bends the ray before this point can still change the answer.
                        return if self.has_refracting {
                            ControlFlow::Continue(Some(t))
                        } else {
                            ControlFlow::Break(())
                        };
                    }
                }
                Passage::Refracting => {
                    let nearest = item.shape.meet(&probe, leaving, window, ray.t_max.min(blocked_at).min(bent_at));
                    bent_at = nearest.unwrap_or(bent_at);
                }
                Passage::Straight => self.cross(ray, &probe, slot, leaving, window, crossings),
            }
            ControlFlow::Continue(None)
        });
        // Coincident surfaces: the opaque one is met, the bending one is not.
        if bent_at < blocked_at - window {
            crossings.clear();
            return Shadow::Refracted;
        }
        if blocked_at < f64::INFINITY {
            crossings.clear();
            return Shadow::Blocked;
        }
        crossings.sort_unstable_by(|a, b| a.t.total_cmp(&b.t).then(b.surface.cmp(&a.surface)));
        crossings.dedup_by(|later, earlier| later.t - earlier.t <= window);
        Shadow::Clear
    }

    /// Whether no surface lets shadow rays through, so that [`Self::shadow`] never lists a crossing.
    #[must_use]
    pub fn is_opaque(&self) -> bool {
        !self.has_straight && !self.has_refracting
    }

    /// Lists every crossing of one straight surface: a sphere has two.
    fn cross(&self, ray: &Ray, probe: &Probe, slot: usize, leaving: bool, window: f64, crossings: &mut Vec<Hit>) {
        let shape = &self.items[slot].shape;
        let mut from = window;
        while let Some(t) = shape.meet(probe, leaving, from, ray.t_max) {
            crossings.push(self.hit(ray, t, slot));
            if leaving || shape.is_flat() {
                return;
            }
            from = t;
        }
    }

    /// The one of the coincident surfaces around `nearest` that is met.
    fn preferred(&self, ray: &Ray, probe: &Probe, nearest: f64, window: f64) -> Option<usize> {
        let t_max = (nearest + window).next_up().min(ray.t_max);
        let mut best: Option<((bool, bool, u32, SurfaceId), usize)> = None;
        let _ = self.walk::<false>(&ray.up_to(t_max), probe, |slot| {
            let item = &self.items[slot];
            if let Some(t) = item.shape.meet(probe, ray.leaving == Some(item.surface), window, t_max) {
                let front = self.hit(ray, t, slot).is_front(ray.dir);
                let rank = (item.passage == Passage::Opaque, front, item.precedence, item.surface);
                if best.is_none_or(|(other, _)| rank > other) {
                    best = Some((rank, slot));
                }
            }
            ControlFlow::Continue(None)
        });
        best.map(|(_, slot)| slot)
    }

    fn hit(&self, ray: &Ray, t: f64, slot: usize) -> Hit {
        let item = &self.items[slot];
        if let Shape::Placed(placed) = &item.shape
            && let Some(hit) = placed.hit(ray, tolerance::least_distance(ray.origin, self.radius))
        {
            return hit;
        }
        let (point, normal) = item.shape.settle(ray.at(t));
        Hit { t, point, normal, surface: item.surface }
    }

    /// Moves the ray to the point where it enters the padded bounds, and into the hierarchy's frame.
    #[inline]
    fn enter(&self, ray: &Ray, probe: &Probe, t_max: f64) -> Option<Entry> {
        if self.in_bvh == 0 {
            return None;
        }
        // Where the origin is outside, its `f32` image could be off by more than the padding.
        let reach = self.half_extent * (1.0 + 2.0 * PADDING);
        let from_centre = ray.origin - self.centre;
        let (mut skipped, mut error) = (0.0_f64, 0.0);
        if from_centre.abs().max_element() > reach {
            let mut last = t_max;
            let inverse = ray.dir.recip();
            let (to_low, to_high) = ((-from_centre - reach) * inverse, (-from_centre + reach) * inverse);
            for (low, high) in to_low.to_array().into_iter().zip(to_high.to_array()) {
                // NaN, from 0 times infinity, is a ray along a face: it does not limit.
                skipped = skipped.max(low.min(high));
                last = last.min(low.max(high));
            }
            // Far away the rounding of both is comparable to the scene: a miss must be a clear one.
            let rounding = 8.0 * f64::EPSILON * from_centre.length();
            if skipped > last + rounding {
                return None;
            }
            skipped = (skipped - rounding).max(0.0);
            error = 2.0 * rounding / self.half_extent;
        }
        let origin = (from_centre + ray.dir * skipped) / self.half_extent;
        let mut entry = Entry { line: Line::new(origin, ray.dir, probe, error)?, skipped };
        entry.line.t_max = entry.limit(t_max, self.half_extent);
        Some(entry)
    }

    /// Offers every item that the ray may meet to `visit`, if `ORDERED` about nearest first. It answers with the distance beyond
    /// which nothing matters any more, if that fell, or stops the walk.
    #[inline]
    fn walk<const ORDERED: bool>(
        &self,
        ray: &Ray,
        probe: &Probe,
        mut visit: impl FnMut(usize) -> ControlFlow<(), Option<f64>>,
    ) -> ControlFlow<()> {
        let mut t_max = ray.t_max;
        for slot in self.in_bvh..self.items.len() {
            t_max = visit(slot)?.unwrap_or(t_max);
        }
        let Some(entry) = self.enter(ray, probe, t_max) else { return ControlFlow::Continue(()) };
        self.bvh.walk::<ORDERED>(&entry.line, |slot, t_max| {
            if let Some(t) = visit(slot)? {
                *t_max = entry.limit(t, self.half_extent);
            }
            ControlFlow::Continue(())
        })
    }
}

impl Entry {
    /// A distance in the hierarchy's frame, rounded up.
    fn limit(&self, t: f64, half_extent: f64) -> f32 {
        (((t - self.skipped) / half_extent) as f32).next_up()
    }
}

fn round_down(corner: DVec3) -> Vec3A {
    Vec3A::from_array(corner.to_array().map(|x| {
        let nearest = x as f32;
        if f64::from(nearest) > x { nearest.next_down() } else { nearest }
    }))
}

fn round_up(corner: DVec3) -> Vec3A {
    -round_down(-corner)
}
