//! An [`Ast`] lowered to a few instructions that a [`Cursor`](super::Cursor) walks.

use std::num::NonZeroU32;
use std::ops::Range;

use thiserror::Error;

use super::ast::{Ast, Atom, Group, Item, Repeat, Span};
use crate::component::{Component, ComponentSet};
use crate::work::{GroupId, Stage};

/// Runs of a `*`'s body after which it stops with a warning.
pub const STAR_LIMIT: u32 = 1_000_000;

/// Stages that the repeats of a `k` may still run once they trace nothing. See [`Program`].
pub(super) const QUIET_STAGES: u64 = 1000;

/// One instruction.
#[derive(Clone, Copy, Debug)]
pub(super) enum Op {
    /// Run a component: the letter of this number.
    Run(u32),
    /// A repeat begins.
    Begin,
    /// A run of the innermost repeat's body has ended. One that traced nothing is followed by another only while fewer
    /// than `quiet` have run.
    End { repeat: Repeat, quiet: u32, span: Span },
    /// An outermost `[ ]` begins.
    OpenTimed(GroupId),
    /// An outermost `[ ]` ends.
    CloseTimed,
    /// The outermost `< >` or `[ ]` ends.
    Release,
}

/// A component's letter in the text, and how its groups make it run.
#[derive(Clone, Copy, Debug)]
pub(super) struct Letter {
    pub(super) component: Component,
    pub(super) span: Span,
    /// Which threshold, counted over all `{ }` from the left.
    pub(super) threshold: Option<u32>,
    /// The outermost group around it that holds what is spawned.
    pub(super) hold: Option<Hold>,
    pub(super) group: Option<GroupId>,
}

/// An outermost `< >` or `[ ]`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Hold {
    /// Which one, counted over the text.
    number: u32,
    /// Repeats around it.
    repeats: usize,
}

/// One run of an outermost `< >` or `[ ]`: stages of equal holding ran in the same one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Holding<'k> {
    number: u32,
    iterations: &'k [u32],
}

/// An outermost `[ ]`.
#[derive(Clone, Copy, Debug)]
struct TimedGroup {
    span: Span,
    components: ComponentSet,
    threshold: Option<u32>,
}

/// A crex that is ready to run.
///
/// # Repeats that do nothing
/// A run of an item that traces no ray leaves every bin as it was, so the item's next runs trace none either. Such runs
/// are stages all the same (`D3` is three stages on any scene), but only so many: once a run of its body has traced
/// nothing, a `k` goes on to its `k`th run or until its runs so far come to 1000 stages, whichever is first. So
/// `T4294967295` costs as much time and memory as its rays need, and no picture depends on the rule. The stages of
/// image tiles that run a crex each by itself still add up to those of one execution over the whole picture.
#[derive(Clone, Debug)]
pub struct Program {
    text: String,
    pub(super) ops: Vec<Op>,
    pub(super) letters: Vec<Letter>,
    groups: Vec<TimedGroup>,
    thresholds: Vec<f32>,
    /// Repeats within each other, at most.
    pub(super) repeat_depth: usize,
}

impl Program {
    /// Lowers a crex.
    #[must_use]
    pub fn new(ast: &Ast) -> Self {
        let program = Self {
            text: ast.text().to_owned(),
            ops: Vec::new(),
            letters: Vec::new(),
            groups: Vec::new(),
            thresholds: Vec::new(),
            repeat_depth: 0,
        };
        let mut lowering = Lowering { program, repeats: 0, holds: 0 };
        lowering.items(ast.items(), Place { threshold: None, hold: None, group: None });
        lowering.program
    }

    /// The crex's text, to which all spans refer.
    #[must_use]
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The importance that each member of each `{ }` needs, in [0, 1], from left to right: i / (n + 1) for the ith of n
    /// members, rounded to the nearest f32.
    #[must_use]
    pub fn thresholds(&self) -> &[f32] {
        &self.thresholds
    }

    /// Checks thresholds that are to replace [`Self::thresholds`].
    ///
    /// # Errors
    /// If there is not one for each member of each `{ }`, or one of them is not a number in [0, 1].
    pub fn check_thresholds(&self, given: &[f32]) -> Result<(), ThresholdError> {
        if given.len() != self.thresholds.len() {
            return Err(ThresholdError::Count { given: given.len(), needed: self.thresholds.len() });
        }
        match given.iter().position(|threshold| !(0.0..=1.0).contains(threshold)) {
            Some(at) => Err(ThresholdError::Range { number: at + 1, value: given[at] }),
            None => Ok(()),
        }
    }

    /// The components that the crex names.
    #[must_use]
    pub fn components(&self) -> ComponentSet {
        self.letters.iter().map(|letter| letter.component).collect()
    }

    /// How many outermost `[ ]` there are: [`GroupId`]s below this number are valid.
    #[must_use]
    pub fn group_count(&self) -> usize {
        self.groups.len()
    }

    /// Which run of which outermost `< >` or `[ ]` a stage of this program belongs to, if to any.
    #[must_use]
    pub fn holding<'k>(&self, stage: &'k Stage) -> Option<Holding<'k>> {
        let place = self.letters.binary_search_by_key(&stage.span.0, |letter| letter.span.start).ok()?;
        let Hold { number, repeats } = self.letters[place].hold?;
        Some(Holding { number, iterations: stage.key.words().get(..2 * repeats)? })
    }

    /// The text of an outermost `[ ]`, with its brackets, as it was written. Panics for a group of another program.
    #[must_use]
    pub fn group_text(&self, group: GroupId) -> &str {
        self.groups[group.0 as usize].span.of(&self.text)
    }

    /// The components that run in an outermost `[ ]`. What they spawn is held until the group ends, so each of them runs
    /// its bin once, however often it is named. Panics for a group of another program.
    #[must_use]
    pub fn group_components(&self, group: GroupId) -> ComponentSet {
        self.groups[group.0 as usize].components
    }

    /// Which of the thresholds an outermost `[ ]` obeys, if it stands in a `{ }`.
    pub(super) fn group_threshold(&self, group: GroupId) -> Option<u32> {
        self.groups[group.0 as usize].threshold
    }
}

/// Thresholds that do not fit a crex.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum ThresholdError {
    /// There are too many or too few.
    #[error(
        "{given} thresholds given where the members of the crex's {{ }} need {needed}: one each, from left to right"
    )]
    Count {
        /// How many were given.
        given: usize,
        /// How many members the `{ }` of the crex have.
        needed: usize,
    },
    /// One is out of range.
    #[error("threshold {number} is {value}: expected a number from 0 (every pixel) to 1 (only pixels of importance 1)")]
    Range {
        /// Which one, from 1.
        number: usize,
        /// What was given.
        value: f32,
    },
}

/// What the groups around an item make of it.
#[derive(Clone, Copy)]
struct Place {
    threshold: Option<u32>,
    hold: Option<Hold>,
    group: Option<GroupId>,
}

struct Lowering {
    program: Program,
    /// Repeats open.
    repeats: usize,
    /// Outermost `< >` and `[ ]` so far.
    holds: u32,
}

impl Lowering {
    /// Lowers items in order; gives the stages that a run of them makes when it traces nothing.
    fn items(&mut self, items: &[Item], place: Place) -> u64 {
        items.iter().map(|item| self.item(item, place)).fold(0, u64::saturating_add)
    }

    fn item(&mut self, item: &Item, place: Place) -> u64 {
        // `T2*` is `(T2)*`: the last multiplier is the outermost. A multiplier of 1 is no repeat.
        let repeats =
            || item.multipliers().iter().filter(|multiplier| multiplier.repeat != Repeat::Times(NonZeroU32::MIN));
        for _ in repeats() {
            self.push(Op::Begin);
            self.repeats += 1;
        }
        self.program.repeat_depth = self.program.repeat_depth.max(self.repeats);

        let mut stages = self.atom(item, place);

        for multiplier in repeats() {
            let mut quiet = 1;
            if let Repeat::Times(times) = multiplier.repeat {
                let allowed = (QUIET_STAGES / stages.max(1)).clamp(1, u64::from(times.get()));
                quiet = u32::try_from(allowed).expect("at most QUIET_STAGES");
                stages = stages.saturating_mul(allowed);
            }
            self.push(Op::End { repeat: multiplier.repeat, quiet, span: multiplier.span });
            self.repeats -= 1;
        }
        stages
    }

    fn atom(&mut self, item: &Item, place: Place) -> u64 {
        match item.atom() {
            &Atom::Component(component) => {
                let Place { threshold, hold, group } = place;
                let number = index(self.program.letters.len());
                self.program.letters.push(Letter { component, span: item.atom_span(), threshold, hold, group });
                self.push(Op::Run(number));
                1
            }
            Atom::Group(Group::Inherit, items) => self.items(items, place),
            Atom::Group(Group::Importance, items) => self.importance(items, place),
            Atom::Group(Group::Hold, items) => self.holding(items, place),
            Atom::Group(Group::Timed, items) => self.timed(items, item.atom_span(), place),
        }
    }

    /// Each member has a threshold of its own.
    fn importance(&mut self, items: &[Item], place: Place) -> u64 {
        let first = self.program.thresholds.len();
        let parts = (items.len() + 1) as f32;
        self.program.thresholds.extend((1..=items.len()).map(|i| i as f32 / parts));
        let member = |i| Place { threshold: Some(index(first + i)), ..place };
        items.iter().enumerate().map(|(i, item)| self.item(item, member(i))).fold(0, u64::saturating_add)
    }

    /// Only the outermost group that holds releases.
    fn holding(&mut self, items: &[Item], place: Place) -> u64 {
        if place.hold.is_some() {
            return self.items(items, place);
        }
        let hold = Hold { number: self.holds, repeats: self.repeats };
        self.holds += 1;
        let stages = self.items(items, Place { hold: Some(hold), ..place });
        self.push(Op::Release);
        stages
    }

    /// Only the outermost `[ ]` is a task.
    fn timed(&mut self, items: &[Item], span: Span, place: Place) -> u64 {
        if place.group.is_some() {
            return self.items(items, place);
        }
        let id = GroupId(index(self.program.groups.len()));
        let threshold = place.threshold;
        self.program.groups.push(TimedGroup { span, components: ComponentSet::EMPTY, threshold });
        let letters = self.program.letters.len();
        self.push(Op::OpenTimed(id));
        let stages = self.holding(items, Place { group: Some(id), ..place });
        self.push(Op::CloseTimed);
        let members: Range<usize> = letters..self.program.letters.len();
        self.program.groups[id.0 as usize].components =
            self.program.letters[members].iter().map(|letter| letter.component).collect();
        stages
    }

    fn push(&mut self, op: Op) {
        self.program.ops.push(op);
    }
}

/// A place in a list of this program. A text of over 4 GiB would be needed to pass 2^32.
fn index(place: usize) -> u32 {
    u32::try_from(place).expect("a crex has fewer than 2^32 instructions")
}
