//! Which crex an execution amounted to, as the paper's Figures 6 to 8 name it.

use crate::component::Component;
use crate::crex::{Holding, Program};

use super::rows::StageRow;

/// A crex without `*` that traces, on the same scene and map, the very rays that an execution traced.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Executed {
    /// Its text.
    pub crex: String,
    /// The thresholds of its `{ }`, from left to right.
    pub thresholds: Vec<f32>,
}

/// The crex that the rows of an execution of `program` amount to. Stages that traced nothing are left out, runs of the
/// same letter become a multiplier, and a stage under a threshold has a `{ }` of its own.
#[must_use]
pub fn executed(program: &Program, rows: &[StageRow]) -> Executed {
    let mut writer = Writer { executed: Executed::default(), holding: None, last: None };
    for row in rows.iter().filter(|row| row.report.rays > 0) {
        let holding = program.holding(&row.stage);
        if writer.holding != holding {
            writer.close();
            writer.open(holding);
        }
        writer.run(row.stage.component, row.stage.threshold);
    }
    writer.close();
    writer.executed
}

struct Writer<'k> {
    executed: Executed,
    /// The group that is open.
    holding: Option<Holding<'k>>,
    /// What has run last and how often in a row; not yet written.
    last: Option<(Component, Option<f32>, u32)>,
}

impl<'k> Writer<'k> {
    fn run(&mut self, component: Component, threshold: Option<f32>) {
        match &mut self.last {
            Some((last, needed, times)) if (*last, *needed) == (component, threshold) => *times += 1,
            _ => {
                self.write_last();
                self.last = Some((component, threshold, 1));
            }
        }
    }

    fn write_last(&mut self) {
        let Some((component, threshold, times)) = self.last.take() else {
            return;
        };
        let mut item = component.to_string();
        if times > 1 {
            item.push_str(&times.to_string());
        }
        if let Some(threshold) = threshold {
            item = format!("{{{item}}}");
            self.executed.thresholds.push(threshold);
        }
        self.executed.crex.push_str(&item);
    }

    fn open(&mut self, holding: Option<Holding<'k>>) {
        self.holding = holding;
        if holding.is_some() {
            self.executed.crex.push('<');
        }
    }

    fn close(&mut self) {
        self.write_last();
        if self.holding.take().is_some() {
            self.executed.crex.push('>');
        }
    }
}
