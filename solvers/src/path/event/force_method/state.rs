//! The data of a run of the force method, and how it brings the points of a section up to date.

use super::equations::Equations;
use super::joint::Joint;
use super::progress::Progress;
use super::section::Sections;
use crate::contact::mode::ContactMode;
use crate::path::event::event_run::Hit;
use crate::path::event::trace::Trace;
use crate::path::system::Load;
use nalgebra::Vector3;

/// One load step, or a part of it.
pub struct Run<'s> {
    /// The assembly as sections.
    pub sections: &'s Sections,
    /// State of each section.
    pub joints: Vec<Joint>,
    /// Compatibility of the cycles.
    pub equations: Equations,
    /// How far it has come.
    pub progress: Progress,
    /// Greatest rate of force seen, and of a gap now.
    pub sizes: [f64; 2],
    /// Motions at the beginning.
    pub motions: Vec<f64>,
    /// Sections examined since the last event, with what is near in them.
    pub examined: Vec<(usize, Vec<Hit>)>,
    /// Sections whose tangents are new since the last event.
    pub fresh: Vec<usize>,
    /// Number of contact points of the present event. The rule chooses among their rates if flow is not associated.
    pub arrived: usize,
    /// Modes before the present event.
    pub before: Vec<(usize, ContactMode)>,
    /// Work by the trapezoidal rule, displacement at the load and factor since the last record.
    pub since: [f64; 3],
}

impl<'s> Run<'s> {
    /// From the present state. `None` where a support's reaction works on the way: its own load has no displacement
    /// by which to count that.
    pub fn new(trace: &Trace, sections: &'s Sections, load: &Load) -> Option<Self> {
        if load.opens {
            return None;
        }
        let resultants = sections.resultants(&load.wrench);
        Some(Run {
            sections,
            joints: sections.all.iter().zip(&resultants).map(|(section, l)| Joint::new(section, l)).collect(),
            equations: Equations::new(sections),
            progress: Progress::new(3 * sections.cycles + 1),
            sizes: [0.0; 2],
            motions: trace.state.x[2 * trace.system.contacts..].to_vec(),
            examined: Vec::new(),
            fresh: Vec::new(),
            arrived: trace.arrived(),
            before: Vec::new(),
            since: [0.0, 0.0, trace.state.factor],
        })
    }

    /// Brings forces and dissipation of the points of a section up to date, with a `step` of a twist rate that is
    /// an unknown of its own. Returns by how much each opens, which is left to the caller; nothing where nothing
    /// has moved.
    pub fn update(&mut self, trace: &mut Trace, e: usize, step: Option<(Vector3<f64>, f64)>) -> Vec<f64> {
        let unit = trace.system.units.energy();
        let state = (trace.system.facets.as_slice(), trace.state.points.as_slice());
        let section = &self.sections.all[e];
        let gained = self.joints[e].update(section, state, &self.progress, step, &trace.state.x);
        for (place, change) in section.places.iter().zip(&gained) {
            trace.state.energy.dissipated += change.dissipated * unit;
            (0..2).for_each(|i| trace.state.x[2 * place.contact + i] += change.force[i]);
        }
        gained.into_iter().map(|change| change.opening).collect()
    }

    /// The same; openings grow.
    pub fn update_all(&mut self, trace: &mut Trace, e: usize, step: Option<(Vector3<f64>, f64)>) {
        let openings = self.update(trace, e, step);
        for (place, opening) in self.sections.all[e].places.iter().zip(openings) {
            let point = &mut trace.state.points[place.contact];
            if point.open() {
                point.opening = (point.opening + opening).max(0.0);
            }
        }
    }
}
