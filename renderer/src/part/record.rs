//! What a part says of itself: the two lines of JSON in its file.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::component::{Component, PerComponent};
use crate::crex::Span;
use crate::film::Plane;
use crate::picture::Provenance;
use crate::render::{Account, Shard};
use crate::schedule::StageRow;
use crate::work::{GroupId, Stage, StageKey, WorkReport};

/// What a part is of: all that its picture depends on. Parts of one picture differ in `shard` alone.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Head {
    /// Which part, from 1, and of how many.
    pub shard: [u32; 2],
    /// Pixels in a row of the whole picture.
    pub width: usize,
    /// Rows of the whole picture.
    pub height: usize,
    /// Names of the planes that follow for each tile.
    pub planes: Vec<String>,
    /// Samples for each pixel.
    pub samples: u32,
    /// Seed of all random numbers.
    pub seed: u64,
    /// What HDR and PNG store is radiance times this.
    pub exposure: f64,
    /// A hash of what the scene was made from.
    pub scene: String,
    /// What `{ }` heeded.
    pub modulation: String,
    /// How the picture is made, as the picture's file will say.
    pub provenance: Provenance,
}

impl Head {
    /// The part; `None` if its numbers make no sense.
    #[must_use]
    pub fn shard(&self) -> Option<Shard> {
        Shard::new(self.shard[0], self.shard[1])
    }

    /// The planes; `None` if a name is none, or stands twice.
    #[must_use]
    pub fn planes(&self) -> Option<Vec<Plane>> {
        let planes = self.planes.iter().map(|name| Plane::from_name(name)).collect::<Option<Vec<_>>>()?;
        let twice = planes.iter().enumerate().any(|(index, plane)| planes[..index].contains(plane));
        (!twice && planes.contains(&Plane::Direct)).then_some(planes)
    }

    /// In what two parts cannot belong to one picture, with both values; `None` if they can.
    #[must_use]
    pub fn difference(&self, other: &Self) -> Option<String> {
        let (one, two) = (&self.provenance, &other.provenance);
        let text = |text: &Option<String>| text.clone().unwrap_or_default();
        let size = |head: &Self| format!("{} x {}", head.width, head.height);
        let all = [
            ("the version", one.software.clone(), two.software.clone()),
            ("the crex", text(&one.crex), text(&two.crex)),
            ("the size", size(self), size(other)),
            ("the number of parts", self.shard[1].to_string(), other.shard[1].to_string()),
            ("the seed", self.seed.to_string(), other.seed.to_string()),
            ("the samples", self.samples.to_string(), other.samples.to_string()),
            ("the options", text(&one.options), text(&two.options)),
            ("the view", text(&one.view), text(&two.view)),
            ("the exposure", self.exposure.to_string(), other.exposure.to_string()),
            ("the files read", inputs(one), inputs(two)),
            ("the scene", self.scene.clone(), other.scene.clone()),
            ("what { } heeds", self.modulation.clone(), other.modulation.clone()),
            ("the planes", self.planes.join(" "), other.planes.join(" ")),
        ];
        let (name, one, two) = all.into_iter().find(|(_, one, two)| one != two)?;
        Some(format!("{name} is `{one}` in the first, `{two}` in the other"))
    }
}

/// The files read, by name and the beginning of their digests.
fn inputs(provenance: &Provenance) -> String {
    let short = |digest: &str| digest.chars().take(12).collect::<String>();
    let files: Vec<String> =
        provenance.inputs.iter().map(|input| format!("{} {}", input.name, short(&input.sha256))).collect();
    files.join(", ")
}

/// What was done for a part.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Tail {
    /// What its primary rays did.
    primary: Report,
    /// What its stages did.
    stages: Vec<Row>,
    /// Rays that were spawned and not traced, by component.
    left: BTreeMap<String, u64>,
    /// Where the `*`s stand that were stopped.
    stopped: Vec<[usize; 2]>,
    /// Threads that traced.
    pub threads: usize,
    /// Seconds from the program's start to the last tile, by the clock.
    pub wall_s: f64,
    /// Most memory that the process had by then, bytes, where the system tells.
    pub peak_bytes: Option<u64>,
}

/// A [`WorkReport`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Report {
    rays: u64,
    spawned: BTreeMap<String, u64>,
    seconds: f64,
}

/// A [`StageRow`] of a run without a time limit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Row {
    key: Vec<u32>,
    component: char,
    span: [usize; 2],
    run: u64,
    threshold: Option<f32>,
    held: bool,
    group: Option<u32>,
    report: Report,
}

impl Tail {
    /// The tail for an account.
    #[must_use]
    pub fn new(account: &Account, threads: usize, wall_s: f64, peak_bytes: Option<u64>) -> Self {
        Self {
            primary: Report::of(&account.primary),
            stages: account.stages.iter().map(Row::of).collect(),
            left: counts(&account.left),
            stopped: account.stopped.iter().map(|span| [span.start, span.end]).collect(),
            threads,
            wall_s,
            peak_bytes,
        }
    }

    /// The account; `None` if a letter is no component.
    #[must_use]
    pub fn account(&self) -> Option<Account> {
        Some(Account {
            primary: self.primary.read()?,
            stages: self.stages.iter().map(Row::read).collect::<Option<_>>()?,
            left: per_component(&self.left)?,
            stopped: self.stopped.iter().map(|&[start, end]| Span { start, end }).collect(),
        })
    }
}

impl Report {
    fn of(report: &WorkReport) -> Self {
        Self { rays: report.rays, spawned: counts(&report.spawned), seconds: report.seconds }
    }

    fn read(&self) -> Option<WorkReport> {
        Some(WorkReport { rays: self.rays, spawned: per_component(&self.spawned)?, seconds: self.seconds })
    }
}

impl Row {
    fn of(row: &StageRow) -> Self {
        let Stage { key, component, span, run, threshold, held, group } = &row.stage;
        Self {
            key: key.words().to_vec(),
            component: component.letter(),
            span: [span.0, span.1],
            run: *run,
            threshold: *threshold,
            held: *held,
            group: group.map(|GroupId(number)| number),
            report: Report::of(&row.report),
        }
    }

    fn read(&self) -> Option<StageRow> {
        let stage = Stage {
            key: StageKey::from_words(self.key.iter().copied()),
            component: Component::from_letter(self.component)?,
            span: (self.span[0], self.span[1]),
            run: self.run,
            threshold: self.threshold,
            held: self.held,
            group: self.group.map(GroupId),
        };
        Some(StageRow::ran(stage, self.report.read()?))
    }
}

fn counts(rays: &PerComponent<u64>) -> BTreeMap<String, u64> {
    rays.iter().filter(|(_, count)| **count > 0).map(|(component, &count)| (component.to_string(), count)).collect()
}

fn per_component(counts: &BTreeMap<String, u64>) -> Option<PerComponent<u64>> {
    let mut rays = PerComponent::default();
    for (letter, &count) in counts {
        let mut letters = letter.chars();
        let component = letters.next().and_then(Component::from_letter).filter(|_| letters.next().is_none())?;
        rays[component] = count;
    }
    Some(rays)
}
