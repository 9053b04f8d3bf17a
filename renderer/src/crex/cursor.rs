//! A walk along a [`Program`]: what runs next, given how many rays the runs so far have traced.

use super::ast::{Repeat, Span};
use super::program::{Op, Program, STAR_LIMIT};
use crate::component::{ComponentSet, PerComponent};
use crate::work::{GroupId, Stage, StageKey, Work};

/// What a scheduler under a time limit decides about as a whole.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Task {
    /// The `[ ]` to run whole, or none for a single run of a component.
    pub group: Option<GroupId>,
    /// The components that it runs, each on the rays visible in its bin now.
    pub components: ComponentSet,
    /// Where each of them runs first: the byte offset of its letter, and which run of that letter it will be, from 1.
    pub places: PerComponent<(usize, u64)>,
    /// Only rays of pixels with at least this importance run.
    pub threshold: Option<f32>,
}

/// A repeat that is under way.
#[derive(Clone, Copy, Debug)]
struct Repeating {
    /// Where its body begins.
    begin: u32,
    /// Which run of the body this is, from 0.
    iteration: u32,
    /// Rays traced when this run began.
    traced_before: u64,
}

/// A walk along a program. One walk runs over one set of bins: the whole picture's, or those of an image tile.
///
/// Call [`next`](Self::next); do the work; after a [`Work::Run`] tell [`report`](Self::report) how many rays it traced;
/// again. A step takes no memory, apart from its stage's key in nests of more than seven repeats.
#[derive(Clone, Debug)]
pub struct Cursor<'p> {
    program: &'p Program,
    thresholds: Box<[f32]>,
    at: usize,
    repeating: Vec<Repeating>,
    /// How often each letter has run.
    runs: Box<[u64]>,
    /// Rays traced so far.
    traced: u64,
    /// Where the `*`s that had to be stopped stand.
    stopped: Vec<Span>,
    /// The outermost so many repeats hold a `*` that had to be stopped: none of them goes on.
    ending: usize,
}

impl<'p> Cursor<'p> {
    /// A walk from the beginning, with the program's own thresholds.
    #[must_use]
    pub fn new(program: &'p Program) -> Self {
        Self {
            program,
            thresholds: program.thresholds().into(),
            at: 0,
            repeating: Vec::with_capacity(program.repeat_depth),
            runs: vec![0; program.letters.len()].into(),
            traced: 0,
            stopped: Vec::new(),
            ending: 0,
        }
    }

    /// The same walk with these thresholds for the members of the crex's `{ }`, from left to right.
    ///
    /// # Errors
    /// As [`Program::check_thresholds`].
    pub fn with_thresholds(self, thresholds: &[f32]) -> Result<Self, super::ThresholdError> {
        self.program.check_thresholds(thresholds)?;
        Ok(Self { thresholds: thresholds.into(), ..self })
    }

    /// The program that it walks.
    #[must_use]
    pub fn program(&self) -> &'p Program {
        self.program
    }

    /// What to do next; none at the end.
    #[allow(clippy::should_implement_trait, reason = "an iterator would hide that reports must come in between")]
    pub fn next(&mut self) -> Option<Work> {
        match self.settle()? {
            Op::Release => {
                self.at += 1;
                Some(Work::Release)
            }
            Op::Run(letter) => Some(Work::Run(self.stage(letter))),
            Op::OpenTimed(_) => {
                self.at += 1;
                self.next()
            }
            Op::Begin | Op::End { .. } | Op::CloseTimed => unreachable!("settled on work"),
        }
    }

    /// The task that begins with the next piece of work; none in the middle of a `[ ]`, before a [`Work::Release`] and at
    /// the end.
    pub fn task(&mut self) -> Option<Task> {
        let op = self.settle()?;
        let threshold = |index: Option<u32>| index.map(|index| self.thresholds[index as usize]);
        match op {
            Op::OpenTimed(id) => Some(Task {
                group: Some(id),
                components: self.program.group_components(id),
                places: self.group_places(),
                threshold: threshold(self.program.group_threshold(id)),
            }),
            Op::Run(number) => {
                let letter = &self.program.letters[number as usize];
                let mut places = PerComponent::default();
                places[letter.component] = self.place(number);
                let components = ComponentSet::EMPTY.with(letter.component);
                let threshold = threshold(letter.threshold);
                letter.group.is_none().then_some(Task { group: None, components, places, threshold })
            }
            _ => None,
        }
    }

    /// Where a letter will run next.
    fn place(&self, number: u32) -> (usize, u64) {
        (self.program.letters[number as usize].span.start, self.runs[number as usize] + 1)
    }

    /// Where the components of the `[ ]` that the walk stands before will run first.
    fn group_places(&self) -> PerComponent<(usize, u64)> {
        let mut places = PerComponent::default();
        let inside = self.program.ops[self.at..].iter().take_while(|op| !matches!(op, Op::CloseTimed));
        for op in inside {
            let Op::Run(number) = *op else { continue };
            let place = &mut places[self.program.letters[number as usize].component];
            if *place == (0, 0) {
                *place = self.place(number);
            }
        }
        places
    }

    /// Tells how many rays the last [`Work::Run`] traced; 0 for one that was skipped.
    pub fn report(&mut self, rays: u64) {
        self.traced = self.traced.saturating_add(rays);
    }

    /// Where the `*`s stand that had not ended after [`STAR_LIMIT`] runs of their bodies and so were stopped; each of
    /// them deserves a warning. The repeats around such a `*` end with it.
    #[must_use]
    pub fn stopped(&self) -> &[Span] {
        &self.stopped
    }

    /// Goes on to the next instruction that is work.
    fn settle(&mut self) -> Option<Op> {
        loop {
            let op = *self.program.ops.get(self.at)?;
            match op {
                Op::Begin => {
                    let begin = u32::try_from(self.at).expect("a program has fewer than 2^32 instructions");
                    self.repeating.push(Repeating { begin, iteration: 0, traced_before: self.traced });
                    self.at += 1;
                }
                Op::End { repeat, quiet, span } => self.end_run(repeat, quiet, span),
                Op::CloseTimed => self.at += 1,
                Op::Run(_) | Op::OpenTimed(_) | Op::Release => return Some(op),
            }
        }
    }

    /// Ends a run of the innermost repeat's body: back to its beginning, or past its end.
    fn end_run(&mut self, repeat: Repeat, quiet: u32, span: Span) {
        let depth = self.repeating.len();
        let repeating = self.repeating.last_mut().expect("every repeat that ends has begun");
        let idle = self.traced == repeating.traced_before;
        let done = repeating.iteration + 1;
        let again = match repeat {
            Repeat::UntilEmpty if !idle && done == STAR_LIMIT => {
                self.stopped.push(span);
                self.ending = depth;
                false
            }
            Repeat::UntilEmpty => !idle,
            Repeat::Times(times) => done < times.get() && (!idle || done < quiet),
        };
        if again && depth > self.ending {
            repeating.iteration = done;
            repeating.traced_before = self.traced;
            self.at = repeating.begin as usize + 1;
        } else {
            self.repeating.pop();
            self.ending = self.ending.min(depth - 1);
            self.at += 1;
        }
    }

    /// The stage of the letter that the walk stands on, and past it.
    fn stage(&mut self, number: u32) -> Stage {
        let letter = self.program.letters[number as usize];
        let key = self.key();
        let run = &mut self.runs[number as usize];
        *run += 1;
        self.at += 1;
        Stage {
            key,
            component: letter.component,
            span: (letter.span.start, letter.span.end),
            run: *run,
            threshold: letter.threshold.map(|index| self.thresholds[index as usize]),
            held: letter.hold.is_some(),
            group: letter.group,
        }
    }

    fn key(&self) -> StageKey {
        let at = u32::try_from(self.at).expect("a program has fewer than 2^32 instructions");
        let len = 2 * self.repeating.len() + 1;
        StageKey::from_words((0..len).map(|word| match self.repeating.get(word / 2) {
            Some(repeating) if word % 2 == 0 => repeating.begin,
            Some(repeating) => repeating.iteration,
            None => at,
        }))
    }
}
