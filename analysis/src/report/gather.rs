//! From sessions to a report.

use std::collections::BTreeMap;

use super::arm::ArmReport;
use super::between::{ContrastReport, Multiplicity};
use super::ladder::Ladder;
use super::{Flow, LISTED, Options, Report, words};
use crate::exclude::{Conduct, Excluded, Reason, Times, judge};
use crate::plan::{PlannedBound, Rules};
use crate::provenance::Provenance;
use crate::sessions::{Session, Visitor};
use crate::tally::Tally;
use crate::timing::Gathering;
use crate::trial_log::Trial;

/// What is gathered while logs are read.
pub(super) struct Gather {
    rules: Rules,
    times: Option<Times>,
    pub(super) kept: Tally,
    pub(super) all: Tally,
    excluded: Vec<Excluded>,
    reasons: BTreeMap<Reason, u64>,
    sessions: u64,
    timing: Gathering,
    simulated: bool,
    demo: bool,
}

impl Gather {
    pub(super) fn new(options: &Options) -> Self {
        let plan = options.plan.as_ref();
        Self {
            rules: plan.map(|plan| plan.rules.clone()).unwrap_or_default(),
            times: plan.map(|plan| Times { picture_s: plan.picture_s, gap_s: plan.gap_s }),
            kept: Tally::default(),
            all: Tally::default(),
            excluded: Vec::new(),
            reasons: BTreeMap::new(),
            sessions: 0,
            timing: Gathering::new(plan.map(|plan| plan.picture_s)),
            simulated: false,
            demo: false,
        }
    }

    fn leave_out(&mut self, session: &Session, reason: Reason, detail: String) {
        *self.reasons.entry(reason).or_default() += 1;
        if self.excluded.len() < LISTED {
            self.excluded.push(Excluded {
                session_id: session.id.clone(),
                participant: session.participant.clone(),
                arm: session.arm.clone(),
                reason,
                detail,
                file: session.file.display().to_string(),
                line: session.line,
            });
        }
    }

    pub(super) fn report(self, mut provenance: Provenance, options: &Options) -> Report {
        let plan = options.plan.as_ref();
        provenance.report_version = env!("CARGO_PKG_VERSION").to_owned();
        provenance.analysis_plan_hash = plan.map(|plan| plan.hash().to_string());
        let alpha = plan.map_or(0.05, |plan| plan.alpha);
        let recorded = provenance.analysis_plan_hash.is_some()
            && !provenance.logs.is_empty()
            && provenance.logs.iter().all(|log| log.analysis_plan_hash == provenance.analysis_plan_hash);
        let bound = plan.map(|plan| PlannedBound { bound: plan.bound, recorded });
        let published = provenance.logs.is_empty();
        let arms = |tally: &Tally| -> Vec<ArmReport> {
            tally.arms.iter().map(|(name, arm)| ArmReport::new(name, arm, alpha, bound, published)).collect()
        };
        let kept = arms(&self.kept);
        let people: Vec<(String, u64)> = kept.iter().map(|arm| (arm.arm.clone(), arm.n)).collect();
        let excluded: u64 = self.reasons.values().sum();
        Report {
            simulated: self.simulated,
            demo: self.demo,
            alpha,
            contrasts: ContrastReport::all(&kept, alpha),
            multiplicity: Multiplicity::new(&kept, alpha),
            ladder: options.pictures.as_ref().and_then(|(pictures, _)| Ladder::new(&kept, pictures, alpha)),
            deviations: words::deviations(plan, &provenance, &people, options.pictures.as_ref().map(|(_, hash)| *hash)),
            flow: Flow {
                sessions: self.sessions,
                excluded: self.reasons.into_iter().collect(),
                analysed: if published { people.iter().map(|(_, n)| n).sum() } else { self.sessions - excluded },
                by_arm: people,
            },
            without_exclusions: if excluded == 0 { kept.clone() } else { arms(&self.all) },
            arms: kept,
            exclusions: self.excluded,
            timing: if published { None } else { Some(self.timing.finish()) },
            plan: options.plan.clone(),
            stimuli: options.pictures.as_ref().map(|(pictures, _)| pictures.clone()).unwrap_or_default(),
            provenance,
        }
    }
}

impl Visitor for Gather {
    fn trial(&mut self, trial: &Trial) {
        self.simulated = trial.simulated;
        self.demo = trial.demo;
        self.timing.add(trial);
    }

    fn session(&mut self, session: &Session) {
        self.sessions += 1;
        let Some(trial) = &session.critical else {
            self.leave_out(session, Reason::NoCriticalAnswer, String::new());
            return;
        };
        self.all.add(session);
        let conduct = Conduct::of(trial, session.knew_task, session.repeated);
        match judge(&conduct, &self.rules, self.times) {
            Some((reason, detail)) => self.leave_out(session, reason, detail),
            None => self.kept.add(session),
        }
    }
}
