//! Sentences about the plan, and what departs from it.

use stimuli::Sha256;

use super::head;
use crate::plan::Plan;
use crate::provenance::Provenance;

/// What departs from the plan, or cannot be held against one. `analysed` are the arms' participants, `manifest` the digest
/// of the manifest of the pictures that the report shows.
#[must_use]
pub fn deviations(
    plan: Option<&Plan>,
    provenance: &Provenance,
    analysed: &[(String, u64)],
    manifest: Option<Sha256>,
) -> Vec<String> {
    let mut found = Vec::new();
    if let (Some(manifest), Some(shown)) = (manifest.map(|manifest| manifest.to_string()), &provenance.stimuli_hash)
        && manifest != *shown
    {
        found.push(format!(
            "The pictures of the study's folder (manifest {}) are not those that were shown (manifest {}).",
            head(&manifest),
            head(shown)
        ));
    }
    if provenance.session_versions.len() > 1 {
        found.push(format!(
            "Several versions of the program wrote the logs: {}.",
            provenance.session_versions.join(", ")
        ));
    }
    let Some(plan) = plan else {
        found.push(
            "No analysis plan was given: the level is .05, no equivalence bound is tested, and only interrupted trials and \
             participants who knew the purpose are left out."
                .to_owned(),
        );
        return found;
    };
    if let Some(study) = provenance.study.as_ref().filter(|study| **study != plan.study) {
        found.push(format!("The analysis plan is of study {}, the logs are of study {study}.", plan.study));
    }
    let hash = plan.hash().to_string();
    for log in &provenance.logs {
        match &log.analysis_plan_hash {
            Some(recorded) if *recorded == hash => {}
            Some(recorded) => found.push(format!(
                "The analysis plan ({}) is not the one that {} recorded before its first trial ({}).",
                head(&hash),
                log.file,
                head(recorded)
            )),
            None => found.push(format!(
                "{} records no analysis plan, so it cannot be shown that the plan was fixed beforehand.",
                log.file
            )),
        }
    }
    if provenance.logs.is_empty() {
        found.push(
            "Published counts record no analysis plan: it cannot be shown that the plan was fixed beforehand."
                .to_owned(),
        );
    }
    for (arm, planned) in &plan.arms {
        let people = analysed.iter().find(|(name, _)| name == arm).map_or(0, |(_, people)| *people);
        if people != u64::from(*planned) {
            found.push(format!("Arm {arm}: {people} people analysed, {planned} planned."));
        }
    }
    for (arm, _) in analysed {
        if plan.arms.iter().all(|(planned, _)| planned != arm) {
            found.push(format!("Arm {arm} is not in the plan."));
        }
    }
    found
}

/// Said where nothing departs.
#[must_use]
pub fn kept() -> String {
    "Nothing departs from the analysis plan, which every log recorded before its first trial.".to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::{Bound, Rules};
    use crate::provenance::LogRecord;

    fn plan() -> Plan {
        Plan {
            study: "corridor".into(),
            alpha: 0.05,
            bound: Bound::from_proportion(0.2).unwrap(),
            rules: Rules::default(),
            picture_s: 6.0,
            gap_s: 1.0,
            arms: vec![("HQ/CBQ".into(), 16)],
        }
    }

    fn from(recorded: Option<String>) -> Provenance {
        let log = LogRecord { file: "a.csv".into(), sha256: String::new(), rows: 1, analysis_plan_hash: recorded };
        Provenance { study: Some("corridor".into()), logs: vec![log], ..Provenance::default() }
    }

    #[test]
    fn nothing_departs() {
        let good = from(Some(plan().hash().to_string()));
        assert!(deviations(Some(&plan()), &good, &[("HQ/CBQ".into(), 16)], None).is_empty());
        assert_eq!(kept(), "Nothing departs from the analysis plan, which every log recorded before its first trial.");
    }

    #[test]
    fn every_departure_has_its_sentence() {
        let say = |plan: Option<&Plan>, provenance: &Provenance, people: u64| {
            deviations(plan, provenance, &[("HQ/CBQ".into(), people)], None).join("\n")
        };
        assert!(say(None, &from(None), 16).starts_with("No analysis plan was given: the level is .05"));
        assert_eq!(
            say(Some(&plan()), &from(None), 16),
            "a.csv records no analysis plan, so it cannot be shown that the plan was fixed beforehand."
        );
        let other = say(Some(&plan()), &from(Some("0".repeat(64))), 16);
        assert!(
            other.ends_with("is not the one that a.csv recorded before its first trial (000000000000)."),
            "{other}"
        );
        let hash = Some(plan().hash().to_string());
        let elsewhere = Plan { study: "cornell".into(), ..plan() };
        assert!(
            say(Some(&elsewhere), &from(hash.clone()), 16)
                .contains("plan is of study cornell, the logs are of study corridor.")
        );
        assert_eq!(say(Some(&plan()), &from(hash.clone()), 15), "Arm HQ/CBQ: 15 people analysed, 16 planned.");
        let more = deviations(Some(&plan()), &from(hash.clone()), &[("HQ/CBQ".into(), 16), ("HQ/LQ".into(), 3)], None);
        assert_eq!(more, ["Arm HQ/LQ is not in the plan."]);
        let shown = Provenance { stimuli_hash: Some("0".repeat(64)), ..from(hash.clone()) };
        let other = deviations(Some(&plan()), &shown, &[("HQ/CBQ".into(), 16)], Some(Sha256::of(b"")));
        assert_eq!(
            other,
            ["The pictures of the study's folder (manifest e3b0c44298fc) are not those that were shown (manifest \
              000000000000)."]
        );
        let versions = Provenance { session_versions: vec!["0.1.0".into(), "0.2.0".into()], ..from(hash) };
        assert_eq!(say(Some(&plan()), &versions, 16), "Several versions of the program wrote the logs: 0.1.0, 0.2.0.");
        assert!(say(Some(&plan()), &Provenance::default(), 16).starts_with("Published counts record no analysis plan"));
    }
}
