//! Counts over all cases of a study, and the choice of cases for tables and charts.

use super::case_result::CaseResult;
use super::output_entry::OutputColumn;
use super::rank::load_rank;
use std::collections::{BTreeMap, BTreeSet};
use voussoir_core::limit::Status;

/// Up to this number of cases, tables and charts show every case.
pub const MAX_SHOWN: usize = 1000;
/// For more cases: number of groups of neighbours, of which the least and the greatest load factor are shown.
const RUNS: usize = 400;
/// For more cases: greatest number of uncertified cases that are shown in addition.
const UNCERTIFIED: usize = 100;

/// The data of a case that counts and charts need.
#[derive(Debug, Clone, Copy)]
struct Brief {
    id: usize,
    variant: u32,
    status: Status,
    certified: bool,
    rank: Option<f64>,
}

impl Brief {
    /// Returns the load factor for comparisons; infinite without one.
    fn load(&self) -> f64 {
        self.rank.unwrap_or(f64::INFINITY)
    }
}

/// Returns the least and the greatest load factor of a group, or its first and last case.
fn ends_of(run: &[Brief]) -> [Option<&Brief>; 2] {
    let finite = || run.iter().filter(|brief| brief.load().is_finite());
    let least = finite().min_by(|a, b| a.load().total_cmp(&b.load()));
    let greatest = finite().max_by(|a, b| a.load().total_cmp(&b.load()));
    [least.or(run.first()), greatest.or(run.last())]
}

/// Counts over all cases.
#[derive(Debug, Clone, Default)]
pub struct Totals {
    /// Number of cases.
    pub cases: usize,
    /// Number of certified cases.
    pub certified: usize,
    /// Number of cases of each status.
    pub statuses: Vec<(Status, usize)>,
    /// Number of cases that snap before they reach their load factor.
    pub snapping: usize,
    /// The lowest first limit point of the cases that snap.
    pub lowest_snap: Option<f64>,
    /// Number of open cases. Only their bounds are proved.
    pub open: usize,
    /// True if some case has a load-displacement curve.
    pub curves: bool,
    /// True if some case has forces of joints.
    pub joints: bool,
    /// True if some case has sensitivities.
    pub sensitivities: bool,
    /// True if some case has a stored path.
    pub stored_paths: bool,
    /// True if some case has the name of a scene.
    pub scenes: bool,
    /// Outputs of plug-ins, in the order in which cases have them.
    pub outputs: Vec<OutputColumn>,
    briefs: Vec<Brief>,
    variants: Vec<Option<String>>,
}

impl Totals {
    /// Counts these cases.
    pub fn of(cases: &[CaseResult]) -> Self {
        let mut totals = Totals::default();
        cases.iter().for_each(|case| totals.add(case));
        totals
    }

    /// Adds a case.
    pub fn add(&mut self, case: &CaseResult) {
        self.cases += 1;
        self.certified += usize::from(case.certificate.passed);
        match self.statuses.iter_mut().find(|(status, _)| *status == case.status) {
            Some((_, count)) => *count += 1,
            None => self.statuses.push((case.status, 1)),
        }
        if let Some(snap) = case.snaps_from() {
            self.snapping += 1;
            self.lowest_snap = Some(self.lowest_snap.map_or(snap, |lowest| lowest.min(snap)));
        }
        self.open += usize::from(!case.certificate.passed && case.status == Status::Open);
        self.curves |= case.path.curve.is_some();
        self.joints |= !case.carried.joints.is_empty();
        self.sensitivities |= !case.sensitivities.is_empty();
        self.stored_paths |= case.stored_path.is_some();
        self.scenes |= case.label.scene.is_some();
        for entry in &case.outputs {
            let column = OutputColumn::of(entry);
            if !self.outputs.contains(&column) {
                self.outputs.push(column);
            }
        }
        let variant = self.variants.iter().position(|own| *own == case.label.variant).unwrap_or_else(|| {
            self.variants.push(case.label.variant.clone());
            self.variants.len() - 1
        });
        self.briefs.push(Brief {
            id: case.label.id,
            variant: variant as u32,
            status: case.status,
            certified: case.certificate.passed,
            rank: load_rank(case),
        });
    }

    /// Returns true if tables and charts show every case.
    pub fn all_shown(&self) -> bool {
        self.cases <= MAX_SHOWN
    }

    /// Number of cases with a status.
    pub fn of_status(&self, status: Status) -> usize {
        self.statuses.iter().find(|(own, _)| *own == status).map_or(0, |(_, count)| *count)
    }

    /// Ids of all cases.
    pub fn ids(&self) -> impl Iterator<Item = usize> {
        self.briefs.iter().map(|brief| brief.id)
    }

    /// The id of the case with the least load factor.
    pub fn least(&self) -> Option<usize> {
        ends_of(&self.briefs)[0].filter(|brief| brief.load().is_finite()).map(|brief| brief.id)
    }

    /// Returns the ids of the cases that tables and charts show. Up to [`MAX_SHOWN`] cases: all. Otherwise: the least
    /// and the greatest load factor of every group of neighbours, the first, the last, the least of each variant, and
    /// the first uncertified cases.
    pub fn shown(&self) -> BTreeSet<usize> {
        if self.all_shown() {
            return self.ids().collect();
        }
        let runs = self.briefs.chunks(self.cases.div_ceil(RUNS)).flat_map(ends_of).flatten();
        let mut alike: BTreeMap<(u32, bool), &Brief> = BTreeMap::new();
        for brief in &self.briefs {
            let own = alike.entry((brief.variant, brief.status == Status::Stalled)).or_insert(brief);
            if brief.load() < own.load() {
                *own = brief;
            }
        }
        let uncertified = self.briefs.iter().filter(|brief| !brief.certified).take(UNCERTIFIED);
        let ends = self.briefs.first().into_iter().chain(self.briefs.last());
        runs.chain(alike.into_values()).chain(uncertified).chain(ends).map(|brief| brief.id).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::blank;

    /// A small number of cases is shown completely; of many cases fewer than 1000 are shown, among them the least, the
    /// greatest, both ends and the stalled case.
    #[test]
    fn the_worst_cases_are_always_shown() {
        let factor = |id: usize| if id == 77_777 { 0.5 } else { 2.0 + (id as f64 * 0.1).sin() };
        let case = |id: usize| CaseResult { load_factor: Some(factor(id)), ..blank(id, Status::Collapse) };
        let few = Totals::of(&(0..MAX_SHOWN).map(case).collect::<Vec<_>>());
        assert_eq!(few.shown().len(), MAX_SHOWN);
        let mut many: Vec<CaseResult> = (0..100_000).map(case).collect();
        many[4321].status = Status::Stalled;
        many[4321].certificate.passed = false;
        let totals = Totals::of(&many);
        let shown = totals.shown();
        assert!(
            shown.len() <= MAX_SHOWN && [0, 4321, 77_777, 99_999].iter().all(|id| shown.contains(id)),
            "{}",
            shown.len()
        );
        assert_eq!((totals.of_status(Status::Stalled), totals.of_status(Status::Collapse)), (1, 99_999));
    }
}
