//! The values that pass between the scheduler, which knows the crex, and the tracer, which knows rays.

use std::cmp::Ordering;
use std::fmt;
use std::hash::{Hash, Hasher};

use crate::component::{Component, PerComponent};

/// Rays (not spawn records) now visible in each component's bin.
pub type BinOccupancy = PerComponent<u64>;

/// Where in a crex's execution a stage stands.
///
/// A word for every enclosing repeat (which one, and its iteration) and a last one for the letter itself, all numbered in
/// the order of the text. Keys of one program compare as its stages run, whichever image tile they come from, so the
/// stages of many tiles merge by key into those of one execution over the whole picture.
#[derive(Clone)]
pub struct StageKey(Words);

/// Words that nearly always fit beside each other; only nests of more than seven repeats go to the heap.
#[derive(Clone)]
enum Words {
    Inline { len: u8, words: [u32; StageKey::INLINE] },
    Heap(Box<[u32]>),
}

impl StageKey {
    const INLINE: usize = 15;

    /// The key made of these words.
    #[must_use]
    pub fn from_words(from: impl ExactSizeIterator<Item = u32>) -> Self {
        let len = from.len();
        if len > Self::INLINE {
            return Self(Words::Heap(from.collect()));
        }
        let mut words = [0; Self::INLINE];
        words.iter_mut().zip(from).for_each(|(word, given)| *word = given);
        Self(Words::Inline { len: u8::try_from(len).expect("at most INLINE words"), words })
    }

    /// Its words, from the crex's root down.
    #[must_use]
    pub fn words(&self) -> &[u32] {
        match &self.0 {
            Words::Inline { len, words } => &words[..usize::from(*len)],
            Words::Heap(words) => words,
        }
    }
}

impl PartialEq for StageKey {
    fn eq(&self, other: &Self) -> bool {
        self.words() == other.words()
    }
}

impl Eq for StageKey {}

impl PartialOrd for StageKey {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for StageKey {
    fn cmp(&self, other: &Self) -> Ordering {
        self.words().cmp(other.words())
    }
}

impl Hash for StageKey {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.words().hash(state);
    }
}

impl fmt::Debug for StageKey {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_list().entries(self.words()).finish()
    }
}

/// An outermost `[ ]` of a crex, numbered from 0 in the order of the text; its text is `Program::group_text`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct GroupId(pub u32);

/// One run of one component.
#[derive(Clone, Debug, PartialEq)]
pub struct Stage {
    /// Its place in the execution.
    pub key: StageKey,
    /// What runs.
    pub component: Component,
    /// Byte offsets of the component's letter in the crex text, end exclusive. No two letters share them.
    pub span: (usize, usize),
    /// How often this letter of the text has run in this execution, from 1.
    pub run: u64,
    /// Only rays of pixels with at least this importance run; the others stay in their bin, visible.
    pub threshold: Option<f32>,
    /// Rays spawned by this stage stay hidden until [`Work::Release`].
    pub held: bool,
    /// The outermost `[ ]` that it belongs to.
    pub group: Option<GroupId>,
}

/// What the tracer is to do next.
#[derive(Clone, Debug, PartialEq)]
pub enum Work {
    /// Trace every visible ray of a component's bin that the threshold admits.
    Run(Stage),
    /// Make all held rays visible: the outermost `< >` or `[ ]` has ended.
    Release,
}

/// What a [`Work::Run`] did.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WorkReport {
    /// Rays traced.
    pub rays: u64,
    /// Rays (not records) spawned, by component.
    pub spawned: PerComponent<u64>,
    /// Seconds that it took, by the renderer's clock.
    pub seconds: f64,
}
