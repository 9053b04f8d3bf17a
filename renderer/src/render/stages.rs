//! A picture stage by stage: all parcels wait for each other, and all their rays are held at once.

use rayon::prelude::*;

use crate::component::PerComponent;
use crate::film::{Film, Planes};
use crate::schedule::Scheduler;
use crate::transport::{Parcel, Workspace};
use crate::work::{Work, WorkReport};

use super::outcome::{Outcome, add_counts, add_report, finish, occupancy};
use super::{RenderError, Renderer, Rendering, Snapshot};

impl Renderer<'_> {
    pub(super) fn render_globally(
        &self,
        show: &mut (dyn FnMut(Snapshot<'_>) + Send),
    ) -> Result<Rendering, RenderError> {
        let tracer = self.tracer();
        let mut scheduler = Scheduler::new(self.program, self.thresholds)?;
        let ranges = self.ranges(0..self.settings.samples);
        let mut parcels: Vec<Parcel> = self
            .tiles()
            .into_iter()
            .flat_map(|tile| ranges.iter().map(move |range| (tile, range)))
            .map(|(tile, range)| self.parcel(tile, range))
            .collect();
        let samples = self.samples();
        let primary =
            self.all_parcels(&mut parcels, |parcel, workspace| parcel.trace_primary(&tracer, &samples, workspace));
        let mut film = self.film();
        self.develop(&parcels, &mut film);
        show(Snapshot { stage: None, report: &primary, film: &film });
        while let Some(work) = scheduler.next(&occupancy(&parcels)) {
            match work {
                Work::Release => parcels.par_iter_mut().for_each(Parcel::release),
                Work::Run(stage) => {
                    let report =
                        self.all_parcels(&mut parcels, |parcel, workspace| parcel.run(&tracer, &stage, workspace));
                    scheduler.report(&report);
                    self.develop(&parcels, &mut film);
                    show(Snapshot { stage: Some(&stage), report: &report, film: &film });
                }
            }
        }
        let mut left = PerComponent::default();
        parcels.iter().for_each(|parcel| add_counts(&mut left, &parcel.left()));
        let stopped = scheduler.stopped().to_vec();
        Ok(finish(film, Outcome { primary, rows: scheduler.into_rows(), left, stopped }))
    }

    /// Does something with every parcel, and adds up what it did, in their order.
    pub(super) fn all_parcels(
        &self,
        parcels: &mut [Parcel],
        work: impl Fn(&mut Parcel, &mut Workspace) -> WorkReport + Sync,
    ) -> WorkReport {
        let reports: Vec<WorkReport> = parcels
            .par_iter_mut()
            .map_init(Workspace::default, |workspace, parcel| self.timed(|| work(parcel, workspace)))
            .collect();
        let mut sum = WorkReport::default();
        reports.iter().for_each(|report| add_report(&mut sum, report));
        sum
    }

    /// Makes the picture of what the parcels have brought so far.
    pub(super) fn develop(&self, parcels: &[Parcel], film: &mut Film) {
        let ranges = self.ranges(0..self.settings.samples).len();
        let mut sums = Planes::default();
        for (tile, parcels) in self.tiles().into_iter().zip(parcels.chunks_exact(ranges)) {
            sums.clear(tile.pixels(), self.stored(), self.has_ambient());
            parcels.iter().for_each(|parcel| parcel.add_to(&mut sums, self.settings.ambient));
            film.store(tile, &sums, self.settings.samples);
        }
    }
}
