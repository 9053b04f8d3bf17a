//! Runs the commands of scene text: which files, which generators, which transforms; then the primitives in order.
//!
//! In two steps, so that a line of text cannot ask for more than fits: first everything is read once and its size
//! computed (an array of 10^12 copies is only a number here), then the primitives are made.

use std::collections::HashMap;
use std::rc::Rc;

use super::command::{self, Word};
use super::document::{SourceFile, Span, error_at};
use super::files::{Files, Found};
use super::generate;
use super::options::Options;
use super::parse::parse;
use super::place::Placement;
use super::statement::Statement;
use super::xform::{self, BadWords, Run};
use super::{Source, decode};
use crate::diagnostic::{Error, Problems};

/// A text's statements and what its commands stand for, by statement.
pub(super) struct Node {
    statements: Rc<[Statement]>,
    commands: HashMap<usize, Plan>,
    size: Size,
}

/// What a command gives.
enum Plan {
    /// Output of a generator.
    Made(Rc<[Statement]>),
    /// Files, one after the other.
    Texts(Vec<Rc<Node>>),
    /// Copies of something, each placed.
    Placed(Span, Vec<(Run, Rc<Plan>)>),
}

/// How much there will be.
#[derive(Clone, Copy, Default)]
struct Size {
    statements: u64,
    values: u64,
}

impl Size {
    fn plus(self, other: Self) -> Self {
        Self {
            statements: self.statements.saturating_add(other.statements),
            values: self.values.saturating_add(other.values),
        }
    }

    fn times(self, copies: u64) -> Self {
        Self { statements: self.statements.saturating_mul(copies), values: self.values.saturating_mul(copies) }
    }

    fn of(statements: &[Statement]) -> Self {
        let mut size = Self::default();
        for statement in statements {
            let values = match statement {
                Statement::Primitive(draft) => draft.strings.len() + draft.reals.len(),
                Statement::Command(_) => continue,
                Statement::Alias(_) | Statement::Broken(_) => 0,
            };
            size = size.plus(Self { statements: 1, values: values as u64 });
        }
        size
    }
}

impl Plan {
    fn size(&self) -> Size {
        match self {
            Self::Made(statements) => Size::of(statements),
            Self::Texts(nodes) => nodes.iter().fold(Size::default(), |size, node| size.plus(node.size)),
            Self::Placed(_, runs) => {
                runs.iter().fold(Size::default(), |size, (run, input)| size.plus(input.size().times(run.copies())))
            }
        }
    }
}

/// Reads texts and plans their commands.
pub(super) struct Loader<'a> {
    files: &'a dyn Files,
    options: &'a Options<'a>,
    pub(super) sources: Vec<SourceFile>,
    pub(super) problems: Problems,
    pub(super) warnings: Vec<Error>,
    /// Texts that were read, by name.
    parsed: HashMap<String, (u32, Rc<[Statement]>)>,
    /// Texts whose commands are planned, by text and by the folder in which they run.
    nodes: HashMap<(u32, String), Rc<Node>>,
    /// The texts that are being planned, outermost first.
    active: Vec<u32>,
    /// Whether a command gave nothing because of an error: names that it would define are missing then.
    pub(super) incomplete: bool,
    /// What generators have made so far: it is in memory, whatever becomes of it.
    made: Size,
}

/// What has gone wrong is in the problems already.
struct Reported;

impl<'a> Loader<'a> {
    pub(super) fn new(files: &'a dyn Files, options: &'a Options<'a>) -> Self {
        Self {
            files,
            options,
            sources: Vec::new(),
            problems: Problems::default(),
            warnings: Vec::new(),
            parsed: HashMap::new(),
            nodes: HashMap::new(),
            active: Vec::new(),
            incomplete: false,
            made: Size::default(),
        }
    }

    /// Reads a text that was asked for.
    pub(super) fn text(&mut self, source: &Source) -> Option<Rc<Node>> {
        let (index, statements) = self.parse(&source.name, &source.bytes, None).ok()?;
        self.node(index, statements, &source.folder, None).ok()
    }

    /// Whether the whole is within the limits.
    pub(super) fn admit(&mut self, nodes: &[Rc<Node>]) {
        let size = nodes.iter().fold(Size::default(), |size, node| size.plus(node.size));
        if let Some(message) = self.excess(size)
            && self.problems.is_empty()
        {
            let name = self.sources.first().map_or("", |source| source.name.as_str());
            self.problems.add(Error::of_file(name, message.replace("this command", "the scene")));
        }
    }

    fn excess(&self, size: Size) -> Option<String> {
        let limits = &self.options.limits;
        let (found, limit, what) = if size.statements > limits.primitives {
            (size.statements, limits.primitives, "primitives")
        } else if size.values > limits.values {
            (size.values, limits.values, "arguments")
        } else {
            return None;
        };
        let found = if found == u64::MAX { "far too many".to_owned() } else { found.to_string() };
        Some(format!("this command makes {found} {what}, more than the limit of {limit}"))
    }

    fn report(&mut self, span: Span, message: impl Into<String>) -> Reported {
        self.problems.add(error_at(&self.sources, span, message));
        Reported
    }

    fn parse(&mut self, name: &str, bytes: &[u8], by: Option<Span>) -> Result<(u32, Rc<[Statement]>), Reported> {
        let source = SourceFile { name: name.to_owned(), text: decode(bytes), read_by: by };
        let index = u32::try_from(self.sources.len()).ok().filter(|_| u32::try_from(source.text.len()).is_ok());
        let Some(index) = index else {
            self.problems.add(Error::of_file(name, "the file is larger than 4 GiB"));
            return Err(Reported);
        };
        self.sources.push(source);
        let statements = parse(index, &self.sources, &mut self.problems);
        Ok((index, statements.into()))
    }

    fn node(
        &mut self,
        source: u32,
        statements: Rc<[Statement]>,
        folder: &str,
        by: Option<Span>,
    ) -> Result<Rc<Node>, Reported> {
        let key = (source, folder.to_owned());
        if let Some(node) = self.nodes.get(&key) {
            return Ok(node.clone());
        }
        let limits = &self.options.limits;
        if let Some(by) = by {
            if self.active.len() >= limits.depth {
                let message = format!("files read each other more than {} deep", limits.depth);
                return Err(self.report(by, message));
            }
            if self.nodes.len() >= limits.files {
                let message = format!("the scene reads more than {} files", limits.files);
                return Err(self.report(by, message));
            }
        }
        self.active.push(source);
        let mut node = Node { size: Size::of(&statements), statements, commands: HashMap::new() };
        for index in 0..node.statements.len() {
            let Statement::Command(span) = node.statements[index] else { continue };
            if self.problems.full() {
                break;
            }
            if let Ok(plan) = self.plan(span, folder) {
                let size = plan.size();
                if let Some(message) = self.excess(size) {
                    self.report(span, message);
                    self.incomplete = true;
                    continue;
                }
                if size.statements == 0 {
                    self.warnings.push(error_at(&self.sources, span, "this command gives no primitives"));
                }
                node.size = node.size.plus(size);
                node.commands.insert(index, plan);
            } else {
                self.incomplete = true;
            }
        }
        self.active.pop();
        let node = Rc::new(node);
        self.nodes.insert(key, node.clone());
        Ok(node)
    }

    /// Reads the command at `span` and all that it needs.
    fn plan(&mut self, span: Span, folder: &str) -> Result<Plan, Reported> {
        let text = &self.sources[span.source as usize].text;
        // Without the `!`.
        let line = text.get(span.start as usize + 1..span.end as usize).unwrap_or_default().to_owned();
        let stages = match command::split(&line) {
            Ok(stages) => stages,
            Err(bad) => {
                if self.options.commands.is_some() {
                    return self.run(span, &line, folder);
                }
                return Err(self.report(within(span, bad.start, bad.end), bad.message));
            }
        };
        let foreign = stages.iter().rposition(|stage| !is_native(&stage.words[0].text));
        let mut input: Option<Plan> = None;
        let mut stages = stages.as_slice();
        if let Some(last) = foreign {
            input = Some(self.foreign(span, &line, &stages[last], folder)?);
            stages = &stages[last + 1..];
        }
        for stage in stages {
            let (program, words) = (&stage.words[0], &stage.words[1..]);
            let at_end = within(span, stage.end, stage.end);
            let planned = match program.text.as_str() {
                "xform" => self.xform(span, words, input.take(), folder),
                "cat" => self.cat(span, words, input.take(), folder),
                name => {
                    let mut read = |word: &Word| self.read_words(word, folder);
                    match generate::run(name, words, span, &mut read) {
                        Ok(drafts) => self.keep(span, drafts.into_iter().map(Statement::Primitive).collect()),
                        Err(bad) => Err(Some(bad)),
                    }
                }
            };
            input = Some(planned.map_err(|bad| match bad {
                None => Reported,
                Some(BadWords { word: Some(word), message }) => {
                    self.report(within(span, word.start, word.end), format!("{}: {message}", program.text))
                }
                Some(BadWords { word: None, message }) => self.report(at_end, format!("{}: {message}", program.text)),
            })?);
        }
        input.ok_or(Reported)
    }

    /// What a generator made, unless all of them together make too much.
    fn keep(&mut self, span: Span, made: Rc<[Statement]>) -> Result<Plan, Option<BadWords>> {
        self.made = self.made.plus(Size::of(&made));
        match self.excess(self.made) {
            None => Ok(Plan::Made(made)),
            Some(message) => {
                self.report(span, message.replace("this command makes", "the commands up to this one make"));
                self.problems.close();
                Err(None)
            }
        }
    }

    /// A program that is not one of ours: refused, or run by the caller's leave up to the end of its stage.
    fn foreign(&mut self, span: Span, line: &str, stage: &command::Stage, folder: &str) -> Result<Plan, Reported> {
        if self.options.commands.is_some() {
            return self.run(span, line.get(..stage.end).unwrap_or(line), folder);
        }
        let program = &stage.words[0];
        let message = format!(
            "the command `{}` is not run: no shell is run for a scene, and the commands known without one are {}; \
             to run any other, allow commands",
            program.text,
            NATIVE.iter().chain(&generate::NAMES).copied().collect::<Vec<_>>().join(", ")
        );
        Err(self.report(within(span, program.start, program.end), message))
    }

    fn run(&mut self, span: Span, line: &str, folder: &str) -> Result<Plan, Reported> {
        let Some(commands) = self.options.commands else { return Err(Reported) };
        match commands.run(line, folder) {
            Ok(bytes) => {
                let (source, statements) = self.parse(&format!("output of `{}`", line.trim()), &bytes, Some(span))?;
                Ok(Plan::Texts(vec![self.node(source, statements, folder, Some(span))?]))
            }
            Err(message) => Err(self.report(span, format!("the command failed: {message}"))),
        }
    }

    fn xform(
        &mut self,
        span: Span,
        words: &[Word],
        piped: Option<Plan>,
        folder: &str,
    ) -> Result<Plan, Option<BadWords>> {
        let runs = xform::runs(words, &mut |word| self.read_words(word, folder)).map_err(Some)?;
        let piped = piped.map(Rc::new);
        let mut placed = Vec::with_capacity(runs.len());
        for run in runs {
            let input = if run.files.is_empty() {
                let nothing = "has nothing to transform: name a file, or pipe something into it";
                piped.clone().ok_or_else(|| Some(BadWords::at(None, nothing)))?
            } else {
                Rc::new(self.texts(span, &run.files, run.keeps_folder, folder)?)
            };
            placed.push((run, input));
        }
        Ok(Plan::Placed(span, placed))
    }

    /// `cat`: the files' text, as if it stood here.
    fn cat(&mut self, span: Span, words: &[Word], piped: Option<Plan>, folder: &str) -> Result<Plan, Option<BadWords>> {
        match (words.is_empty(), piped) {
            (true, Some(piped)) => Ok(piped),
            (true, None) => Err(Some(BadWords::at(None, "wants at least one file"))),
            (false, _) => self.texts(span, words, true, folder),
        }
    }

    /// Scene files; commands in them run in their own folder, or in this one.
    fn texts(
        &mut self,
        span: Span,
        names: &[Word],
        keeps_folder: bool,
        folder: &str,
    ) -> Result<Plan, Option<BadWords>> {
        let mut nodes = Vec::with_capacity(names.len());
        for word in names {
            let at = within(span, word.start, word.end);
            let found = self.find(word, folder).map_err(Some)?;
            if let Some(position) =
                self.active.iter().position(|&source| self.sources[source as usize].name == found.name)
            {
                let chain = self.active[position..].iter().map(|&source| self.sources[source as usize].name.as_str());
                let message =
                    format!("{} -> {}: a file cannot read itself", chain.collect::<Vec<_>>().join(" -> "), found.name);
                return Err(Some(BadWords::at(Some(word), message)));
            }
            let (source, statements) = match self.parsed.get(&found.name) {
                Some((source, statements)) => (*source, statements.clone()),
                None => {
                    let parsed = self.parse(&found.name, &found.bytes, Some(at)).map_err(|Reported| None)?;
                    self.parsed.insert(found.name.clone(), parsed.clone());
                    parsed
                }
            };
            let inner = if keeps_folder { folder } else { &found.folder };
            nodes.push(self.node(source, statements, inner, Some(at)).map_err(|Reported| None)?);
        }
        Ok(Plan::Texts(nodes))
    }

    fn find(&self, word: &Word, folder: &str) -> Result<Found, BadWords> {
        self.files.find(&word.text, folder).map_err(|why| BadWords::at(Some(word), format!("`{}` {why}", word.text)))
    }

    fn read_words(&self, word: &Word, folder: &str) -> Result<String, BadWords> {
        Ok(decode(&self.find(word, folder)?.bytes))
    }
}

/// Commands, besides the generators, that need no shell.
const NATIVE: [&str; 2] = ["xform", "cat"];

fn is_native(program: &str) -> bool {
    NATIVE.contains(&program) || generate::NAMES.contains(&program)
}

/// A stretch of a command line as a stretch of its source; the line starts after the command's `!`.
fn within(span: Span, start: usize, end: usize) -> Span {
    let offset =
        |at: usize| span.end.min(span.start.saturating_add(1).saturating_add(u32::try_from(at).unwrap_or(u32::MAX)));
    Span { start: offset(start), end: offset(end), ..span }
}

/// The placements that hold for what is being emitted, innermost first.
struct Chain<'a> {
    placement: &'a Placement,
    span: Span,
    outer: Option<&'a Chain<'a>>,
}

/// Makes the statements of a text in order, commands replaced by what they give. Primitives that a transform carries
/// beyond the range of numbers go to `lost`, with the command that did it.
pub(super) fn emit(node: &Node, sink: &mut dyn FnMut(Statement), lost: &mut dyn FnMut(Span, &str)) {
    emit_node(node, None, sink, lost);
}

fn emit_node(
    node: &Node,
    chain: Option<&Chain<'_>>,
    sink: &mut dyn FnMut(Statement),
    lost: &mut dyn FnMut(Span, &str),
) {
    // Commands may stand for nothing, however often.
    if node.size.statements == 0 {
        return;
    }
    for (index, statement) in node.statements.iter().enumerate() {
        match node.commands.get(&index) {
            Some(plan) => emit_plan(plan, chain, sink, lost),
            None => emit_statement(statement, chain, sink, lost),
        }
    }
}

fn emit_plan(
    plan: &Plan,
    chain: Option<&Chain<'_>>,
    sink: &mut dyn FnMut(Statement),
    lost: &mut dyn FnMut(Span, &str),
) {
    match plan {
        Plan::Made(statements) => statements.iter().for_each(|made| emit_statement(made, chain, sink, lost)),
        Plan::Texts(nodes) => nodes.iter().for_each(|node| emit_node(node, chain, sink, lost)),
        Plan::Placed(span, runs) => {
            for (run, input) in runs {
                if input.size().statements == 0 {
                    continue;
                }
                for copy in 0..run.copies() {
                    let placement = run.placement(copy);
                    let chain = Chain { placement: &placement, span: *span, outer: chain };
                    emit_plan(input, Some(&chain), sink, lost);
                }
            }
        }
    }
}

fn emit_statement(
    statement: &Statement,
    chain: Option<&Chain<'_>>,
    sink: &mut dyn FnMut(Statement),
    lost: &mut dyn FnMut(Span, &str),
) {
    let mut statement = statement.clone();
    if let Statement::Primitive(draft) = &mut statement {
        let mut next = chain;
        while let Some(link) = next {
            if !link.placement.apply(draft) {
                lost(link.span, &draft.name);
                break;
            }
            next = link.outer;
        }
    }
    sink(statement);
}
