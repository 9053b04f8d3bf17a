//! Points of quality and time, and what they say.

use serde::Serialize;

/// How a rendering heeded the importance map.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Modulated {
    /// It had none.
    #[default]
    No,
    /// Members of `{ }` ran where the map reaches their thresholds.
    Thresholds,
    /// They ran for as many samples as the map says.
    Continuous,
}

impl Modulated {
    /// The word in files.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::No => "no",
            Self::Thresholds => "thresholds",
            Self::Continuous => "continuous",
        }
    }
}

/// A rendering: what it cost and how far it lies from the reference.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Point {
    /// What ran.
    pub crex: String,
    /// How it heeded the map.
    pub importance: Modulated,
    /// Letters of the components whose planes were smoothed; none if it is empty.
    pub filter: String,
    /// The bound within which it was rendered, seconds; whatever its crex did not need went into more samples.
    pub deadline_s: Option<f64>,
    /// Samples of each pixel.
    pub spp: u32,
    /// Seconds from start to end of the rendering; loading and writing are not in it.
    pub wall_s: f64,
    /// Processor seconds of the whole program in that time: what stays comparable on a busy machine.
    pub cpu_s: f64,
    /// Rays traced, primary ones included, shadow rays not.
    pub rays: u64,
    /// Loss in JOD: 10 less what ColorVideoVDP gives.
    pub loss_jod: f64,
    /// Mean FLIP.
    pub flip: f64,
    /// Relative mean squared error of luminance.
    pub rel_mse: f64,
    /// Whether no other point is both quicker and better (processor seconds, the curve's loss).
    pub front: bool,
    /// Whether it is the knee of the front.
    pub knee: bool,
}

/// Which of a point's losses decides what is better.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Loss {
    /// That in JOD.
    #[default]
    Jod,
    /// Mean FLIP.
    Flip,
    /// Relative mean squared error.
    RelMse,
}

impl Loss {
    /// The loss of a point.
    #[must_use]
    pub fn of(self, point: &Point) -> f64 {
        match self {
            Self::Jod => point.loss_jod,
            Self::Flip => point.flip,
            Self::RelMse => point.rel_mse,
        }
    }

    /// A loss with its unit, or its name.
    #[must_use]
    pub fn words(self, loss: f64) -> String {
        match self {
            Self::Jod => format!("{loss:.2} JOD"),
            Self::Flip => format!("{loss:.3} FLIP"),
            Self::RelMse => format!("{loss:.4} relative MSE"),
        }
    }
}

/// All renderings of a scene, the quickest first.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Curve {
    points: Vec<Point>,
    loss: Loss,
}

/// What half the time costs.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Half {
    /// The best rendering.
    pub best: Point,
    /// The best one of those that take at most half its time.
    pub half: Point,
}

impl Curve {
    /// Finds the front and the knee. Points whose numbers are not finite do not compete.
    ///
    /// The knee is the point of the front farthest below the chord between its ends, time on a logarithmic axis and loss on a
    /// linear one, each scaled to the front's extent (V. Satopaa and others, "Finding a 'Kneedle' in a Haystack", ICDCSW
    /// 2011, without its smoothing). A front of fewer than three points, or one that nowhere lies below its chord, has none.
    #[must_use]
    pub fn new(mut points: Vec<Point>, loss: Loss) -> Self {
        points.sort_by(|a, b| {
            (a.cpu_s, loss.of(a)).partial_cmp(&(b.cpu_s, loss.of(b))).unwrap_or(std::cmp::Ordering::Equal)
        });
        let mut least = f64::INFINITY;
        for point in &mut points {
            (point.front, point.knee) = (point.cpu_s.is_finite() && loss.of(point) < least, false);
            if point.front {
                least = loss.of(point);
            }
        }
        let mut curve = Self { points, loss };
        if let Some(knee) = curve.find_knee() {
            curve.points[knee].knee = true;
        }
        curve
    }

    fn find_knee(&self) -> Option<usize> {
        let front: Vec<(usize, f64, f64)> = (0..)
            .zip(&self.points)
            .filter(|(_, point)| point.front && point.cpu_s > 0.0)
            .map(|(index, point)| (index, point.cpu_s.ln(), self.loss.of(point)))
            .collect();
        let (&(_, start, high), &(_, end, low)) = (front.first()?, front.last()?);
        if front.len() < 3 || end <= start || high <= low {
            return None;
        }
        // Below the chord from (0, 1) to (1, 0): x + y < 1.
        let below =
            |&(_, time, loss): &(usize, f64, f64)| 1.0 - (time - start) / (end - start) - (loss - low) / (high - low);
        let knee = front.iter().max_by(|a, b| below(a).total_cmp(&below(b)))?;
        (below(knee) > 1e-9).then_some(knee.0)
    }

    /// By which loss points are better.
    #[must_use]
    pub fn loss(&self) -> Loss {
        self.loss
    }

    /// The points, the quickest first.
    #[must_use]
    pub fn points(&self) -> &[Point] {
        &self.points
    }

    /// Those of the front.
    pub fn front(&self) -> impl DoubleEndedIterator<Item = &Point> {
        self.points.iter().filter(|point| point.front)
    }

    /// The knee of the front.
    #[must_use]
    pub fn knee(&self) -> Option<&Point> {
        self.points.iter().find(|point| point.knee)
    }

    /// What is lost at half the time of the best rendering; `None` if no rendering took so little.
    #[must_use]
    pub fn half(&self) -> Option<Half> {
        let best = self.front().next_back()?;
        let half = self.front().rfind(|point| point.cpu_s <= 0.5 * best.cpu_s)?;
        Some(Half { best: best.clone(), half: half.clone() })
    }

    /// A table with a head, one line a point.
    #[must_use]
    pub fn csv(&self) -> String {
        let mut text =
            "crex,importance,filter,deadline_s,spp,wall_s,cpu_s,rays,loss_jod,flip,rel_mse,front,knee\n".to_owned();
        for point in &self.points {
            let Point { crex, filter, spp, wall_s, cpu_s, rays, loss_jod, flip, rel_mse, front, knee, .. } = point;
            let deadline = point.deadline_s.map(|seconds| seconds.to_string()).unwrap_or_default();
            text.push_str(&format!(
                "{crex},{},{filter},{deadline},{spp},{wall_s:.4},{cpu_s:.4},{rays},{loss_jod:.5},{flip:.6},{rel_mse:.6},{front},{knee}\n",
                point.importance.word()
            ));
        }
        text
    }
}

impl Point {
    /// How it was rendered, in words: crex, samples, and what else was asked for.
    #[must_use]
    pub fn how(&self) -> String {
        let mut text = if self.crex.is_empty() { "direct light".to_owned() } else { self.crex.clone() };
        match self.importance {
            Modulated::No => {}
            modulated => text.push_str(&format!(", {}", modulated.word())),
        }
        if !self.filter.is_empty() {
            text.push_str(&format!(", {} smoothed", self.filter));
        }
        match self.deadline_s {
            Some(seconds) => text.push_str(&format!(", within {seconds} s")),
            None => text.push_str(&format!(", {} spp", self.spp)),
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn point(cpu_s: f64, loss_jod: f64) -> Point {
        Point { crex: "D".to_owned(), spp: 1, wall_s: cpu_s, cpu_s, rays: 1, loss_jod, ..Point::default() }
    }

    fn front(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
        let curve = Curve::new(points.iter().map(|&(time, loss)| point(time, loss)).collect(), Loss::Jod);
        curve.front().map(|point| (point.cpu_s, point.loss_jod)).collect()
    }

    #[test]
    fn the_front_is_what_nothing_beats() {
        let points = [(4.0, 0.5), (1.0, 3.0), (2.0, 3.0), (2.0, 1.0), (8.0, 0.6), (16.0, 0.0)];
        assert_eq!(front(&points), [(1.0, 3.0), (2.0, 1.0), (4.0, 0.5), (16.0, 0.0)]);
    }

    #[test]
    fn the_knee_is_farthest_below_the_chord_in_log_time() {
        // In log2 time 0, 1, 2, 4 of 4 and loss 1, 1/3, 1/6, 0 of 3: below the chord by 0, 5/12, 1/3, 0.
        let curve =
            Curve::new([(1.0, 3.0), (2.0, 1.0), (4.0, 0.5), (16.0, 0.0)].map(|(t, l)| point(t, l)).to_vec(), Loss::Jod);
        assert_eq!(curve.knee().map(|point| point.cpu_s), Some(2.0));
        // What halves with each doubling is straight and has no knee; nor have two points.
        let straight = Curve::new([(1.0, 2.0), (2.0, 1.0), (4.0, 0.0)].map(|(t, l)| point(t, l)).to_vec(), Loss::Jod);
        assert_eq!(straight.knee(), None);
        assert_eq!(Curve::new(vec![point(1.0, 2.0), point(2.0, 1.0)], Loss::Jod).knee(), None);
        assert_eq!(Curve::new(vec![], Loss::Jod).knee(), None);
    }

    #[test]
    fn half_the_time_is_the_best_that_fits() {
        let curve =
            Curve::new([(1.0, 3.0), (3.0, 1.0), (5.0, 0.5), (8.0, 0.0)].map(|(t, l)| point(t, l)).to_vec(), Loss::Jod);
        let Half { best, half } = curve.half().unwrap();
        assert_eq!((best.cpu_s, half.cpu_s), (8.0, 3.0));
        assert_eq!(Curve::new(vec![point(4.0, 1.0), point(5.0, 0.5)], Loss::Jod).half(), None);
    }

    #[test]
    fn each_loss_has_a_front_of_its_own() {
        let made = |cpu_s, losses: [f64; 3]| Point {
            cpu_s,
            loss_jod: losses[0],
            flip: losses[1],
            rel_mse: losses[2],
            ..Point::default()
        };
        let points = vec![made(1.0, [1.0, 0.5, 0.1]), made(2.0, [2.0, 0.4, 0.3]), made(4.0, [0.5, 0.6, 0.2])];
        for (loss, times) in [(Loss::Jod, vec![1.0, 4.0]), (Loss::Flip, vec![1.0, 2.0]), (Loss::RelMse, vec![1.0])] {
            let curve = Curve::new(points.clone(), loss);
            assert_eq!(curve.front().map(|point| point.cpu_s).collect::<Vec<_>>(), times, "{loss:?}");
        }
    }

    #[test]
    fn a_point_says_how_it_was_rendered() {
        let mut point = Point { spp: 4, ..Point::default() };
        assert_eq!(point.how(), "direct light, 4 spp");
        (point.crex, point.importance, point.filter) = ("D".into(), Modulated::Continuous, "DG".into());
        assert_eq!(point.how(), "D, continuous, DG smoothed, 4 spp");
        point.deadline_s = Some(0.5);
        assert_eq!(point.how(), "D, continuous, DG smoothed, within 0.5 s");
    }

    proptest! {
        /// By the definition, whatever the points.
        #[test]
        fn a_point_is_on_the_front_just_if_no_other_dominates_it(
            points in prop::collection::vec((1_u8..20, 0_u8..20), 1..30),
        ) {
            let points: Vec<(f64, f64)> = points.into_iter().map(|(t, l)| (f64::from(t), f64::from(l))).collect();
            let found = front(&points);
            for &(time, loss) in &points {
                let beaten = points.iter().any(|&(t, l)| t <= time && l <= loss && (t, l) != (time, loss));
                prop_assert_eq!(found.contains(&(time, loss)), !beaten);
            }
            prop_assert!(found.windows(2).all(|pair| pair[0].0 < pair[1].0 && pair[0].1 > pair[1].1));
        }
    }
}
