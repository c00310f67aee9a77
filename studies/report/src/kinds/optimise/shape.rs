//! The volume of the blocks as a function of the parameters, and points that keep it.

use super::request::{Axis, Request};
use voussoir_core::model::Assembly;
use voussoir_core::model::geometry::area_and_centroid;
use voussoir_study::results::CaseResult;
use voussoir_study::study::Study;

/// Step of differences, as a share of a range.
const STEP: f64 = 1e-6;
/// Greatest relative error of the volume of a point.
const KEPT: f64 = 1e-9;
/// Greatest number of Newton steps to a point with the volume.
const MAX_STEPS: usize = 30;

/// Returns the volume of the blocks that are not fixed \[m³\].
fn volume(assembly: &Assembly) -> f64 {
    let free = assembly.bodies.iter().filter(|body| !body.fixed && !body.vertices.is_empty());
    free.map(|body| area_and_centroid(&body.vertices).0 * assembly.width).sum()
}

/// Returns true if a result of a search keeps the requested volume.
pub(super) fn keeps_volume(study: &Study, base: usize, request: &Request, axes: &[Axis], result: &CaseResult) -> bool {
    let Some(wanted) = request.volume else { return true };
    let of = |axis: &Axis| result.label.parameters.get(axis.keys.first()?)?.as_f64();
    let point: Option<Vec<f64>> = axes.iter().map(of).collect();
    let case = point.and_then(|point| study.at(base, &Request::values(axes, &point)).ok());
    case.is_some_and(|case| (volume(&case.assembly) - wanted).abs() <= 10.0 * KEPT * wanted)
}

/// The surface of points with a volume, in shares of the ranges.
pub(super) struct Level<'a> {
    /// The volume \[m³\].
    pub wanted: f64,
    /// The study and the id of its case.
    pub study: &'a Study,
    pub base: usize,
    pub axes: &'a [Axis],
}

impl Level<'_> {
    fn volume(&self, shares: &[f64]) -> Option<f64> {
        let case = self.study.at(self.base, &Request::values(self.axes, &point(self.axes, shares))).ok()?;
        Some(volume(&case.assembly))
    }

    /// Returns the volume relative to the requested one, and its derivatives.
    pub fn slope(&self, shares: &[f64]) -> Option<(f64, Vec<f64>)> {
        let own = self.volume(shares)?;
        let along = |j: usize| {
            let step = if shares[j] + STEP <= 1.0 { STEP } else { -STEP };
            let mut moved = shares.to_vec();
            moved[j] += step;
            Some((self.volume(&moved)? - own) / step / self.wanted)
        };
        Some((own / self.wanted - 1.0, (0..shares.len()).map(along).collect::<Option<Vec<f64>>>()?))
    }

    /// Returns a near point with the volume by Newton steps along the derivatives; `None` if no such point is near.
    pub fn projected(&self, shares: &[f64]) -> Option<Vec<f64>> {
        let mut shares = shares.to_vec();
        for _ in 0..MAX_STEPS {
            let (excess, slope) = self.slope(&shares)?;
            if excess.abs() <= KEPT {
                return Some(shares);
            }
            // Parameters at the end of their range that would leave it stay there.
            let down = -excess.signum();
            let free = |j: &usize| if slope[*j] * down > 0.0 { shares[*j] < 1.0 } else { shares[*j] > 0.0 };
            let moving: Vec<usize> = (0..shares.len()).filter(free).collect();
            let size: f64 = moving.iter().map(|j| slope[*j] * slope[*j]).sum();
            if size <= f64::MIN_POSITIVE {
                return None;
            }
            for j in moving {
                shares[j] = (shares[j] - excess * slope[j] / size).clamp(0.0, 1.0);
            }
        }
        None
    }
}

/// Returns the values at shares of the ranges.
pub(super) fn point(axes: &[Axis], shares: &[f64]) -> Vec<f64> {
    let value = |(axis, share): (&Axis, &f64)| {
        let [from, to] = axis.range;
        if *share == 1.0 { to } else { from + (to - from) * share }
    };
    axes.iter().zip(shares).map(value).collect()
}
