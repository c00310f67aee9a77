//! Strength of a whole joint: the facets of its law integrated over its height.
//!
//! The forces are N_0 and N_1 at the ends of the joint and T along it (N = N_0 + N_1, M = (N_1 − N_0) h/2). With A = h
//! × width, tensile strength F_t = f_t A and crushing strength F_c = f_c A:
//! - opening: N_0 ≥ −F_t/2 and N_1 ≥ −F_t/2, which is |M| ≤ (N + F_t) h/2;
//! - crushing: (N + F_t)² ≤ (F_c + F_t)(2 N_i + F_t) at both ends i, which is the rectangular stress
//!   block |M| ≤ (N + F_t)(F_c − N) h / (2 (F_c + F_t));
//! - sliding: a_n N + a_t T ≤ b A for each facet with a_t ≠ 0.
//!
//! These conditions are exact if each sense of sliding has one facet: for b = 0 the two ends span every distribution of
//! tractions, and for b > 0 the admissible T of a distribution of t_n depends on N alone. If several facets bound
//! sliding in one sense, the sliding rows are necessary, and [`ShearEnvelope`] is exact. Source of the stress block:
//! Livesley (1978), rectangular block; the cone form is our own.
//!
//! Flow uses the jumps that are dual to (N_0, N_1, T): the openings of the two ends and the slip, (ġ_0, ġ_1, ġ_t) = −Σ
//! γ_i d_i, γ_i ≥ 0. The d of a sliding row is the flow of its facet; opening and crushing are associated.

use super::facet::{Facet, FacetMode};
use super::force_row::ForceRow;
use super::shear_envelope::ShearEnvelope;
use super::yield_polygon::{YieldPolygon, dot};

/// The stress block of a joint that crushes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StressBlock {
    /// F_t \[N\].
    pub tension: f64,
    /// F_c + F_t \[N\].
    pub total: f64,
}

/// Strength of a joint.
#[derive(Debug, Clone, PartialEq)]
pub struct JointStrength {
    /// Linear rows: sliding, and opening unless there is a stress block, which implies opening.
    pub rows: Vec<ForceRow>,
    /// Crushing, if the compressive strength is finite; it applies to both ends.
    pub block: Option<StressBlock>,
    /// The exact bounds of T in each sense that several facets bound; the sliding rows alone are too weak there.
    pub envelopes: Vec<ShearEnvelope>,
}

impl JointStrength {
    /// Returns how the rows bound T.
    pub fn tangential(&self) -> Tangential {
        let mut sliding = self.rows.iter().filter(|row| row.normal[2] != 0.0).peekable();
        if sliding.peek().is_none() {
            Tangential::Stuck
        } else if sliding.all(|row| row.normal[0] == 0.0 && row.bound == 0.0) {
            Tangential::Free
        } else {
            Tangential::Friction
        }
    }

    /// Returns the strength without crushing and cohesion that forces of this size \[N\] cannot reach. `None` if
    /// nothing changes.
    pub fn within_reach(&self, force: f64) -> Option<JointStrength> {
        let block = self.block.filter(|block| block.total - block.tension <= UNCRUSHED * force);
        let slides = |row: &&ForceRow| row.mode == FacetMode::Sliding && row.bound > STUCK * force;
        if block == self.block && !self.rows.iter().any(|row| slides(&row)) {
            return None;
        }
        let mut rows: Vec<ForceRow> = self.rows.iter().filter(|row| !slides(row)).copied().collect();
        if let Some(gone) = self.block.filter(|_| block.is_none()) {
            rows.splice(0..0, opening(gone.tension));
        }
        let bounded = |sense: f64| rows.iter().any(|row| row.normal[2] * sense > 0.0);
        let envelopes = self.envelopes.iter().filter(|envelope| bounded(envelope.sense)).cloned().collect();
        Some(JointStrength { rows, block, envelopes })
    }
}

/// Ratio of crushing strength to force above which crushing is left out: it enters by its inverse, below every
/// tolerance of a certificate.
const UNCRUSHED: f64 = 1e8;
/// Ratio of cohesion to force above which sliding is left out: a bound that is not reached has no effect.
const STUCK: f64 = 1e3;

/// Returns the rows of a joint that opens at this tension \[N\].
fn opening(tension: f64) -> [ForceRow; 2] {
    [[-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]].map(|normal| ForceRow::associated(FacetMode::Opening, normal, tension / 2.0))
}

/// The three kinds of bounds on T.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Tangential {
    /// T is unbounded: there are no tangential rows.
    Stuck,
    /// T = 0: there is no tangential variable.
    Free,
    /// Rows bound T.
    Friction,
}

/// Coefficient of friction above which a joint does not slide: T would be bounded only if N were below the rounding
/// error of T.
const NO_SLIDING: f64 = 1e11;

/// Returns true if a facet bounds T in this sense with a friction that is distinguishable from unlimited friction.
fn bounds_sliding(facet: &Facet, sense: f64) -> bool {
    facet.normal[1] * sense > 0.0 && -facet.normal[0] < NO_SLIDING * facet.normal[1].abs()
}

/// Strength of one square metre of a joint with a law. The strength of any area is a multiple of it.
#[derive(Debug, Clone, PartialEq)]
pub struct UnitStrength(JointStrength);

impl UnitStrength {
    /// Integrates facets. An error gives the reason why limit analysis does not support them.
    pub fn of(facets: &[Facet]) -> Result<Self, String> {
        integrate(facets).map(UnitStrength)
    }

    /// Returns the strength of a joint with this area \[m²\].
    pub fn over(&self, area: f64) -> JointStrength {
        let UnitStrength(JointStrength { rows, block, envelopes }) = self;
        JointStrength {
            envelopes: envelopes.iter().map(|envelope| envelope.over(area)).collect(),
            rows: rows.iter().map(|row| ForceRow { bound: row.bound * area, ..*row }).collect(),
            block: block.map(|block| StressBlock { tension: block.tension * area, total: block.total * area }),
        }
    }
}

fn integrate(facets: &[Facet]) -> Result<JointStrength, String> {
    let polygon = YieldPolygon::of(facets);
    let (least, greatest) = (polygon.least_normal(), polygon.greatest_normal());
    if least == f64::NEG_INFINITY {
        return Err("its tensile strength is unlimited".into());
    }
    let tension = -least;
    let mut rows = Vec::new();
    if greatest.is_infinite() {
        rows.extend(opening(tension));
    }
    for sense in [1.0, -1.0] {
        let on_side: Vec<&Facet> = facets.iter().filter(|f| bounds_sliding(f, sense)).collect();
        // A facet counts if it bounds the polygon along an edge, not only in a corner.
        let bounding: Vec<&Facet> = on_side
            .iter()
            .copied()
            .filter(|f| {
                let touching =
                    |v: &&[f64; 2]| dot(f.normal, **v) >= f.bound - 1e-9 * f.bound.abs().max(dot(**v, **v).sqrt());
                let corners = polygon.vertices.iter().filter(touching).count();
                let along = polygon.rays.iter().filter(|r| dot(f.normal, **r).abs() < 1e-12).count();
                corners + along >= 2
            })
            .collect();
        // If every facet of a sense touches the polygon in a corner only, the first one bounds sliding there.
        let kept = if bounding.is_empty() { on_side.into_iter().take(1).collect() } else { bounding };
        rows.extend(kept.into_iter().map(|f| ForceRow {
            normal: [f.normal[0], f.normal[0], f.normal[1]],
            bound: f.bound,
            mode: f.mode,
            flow: [f.flow[0], f.flow[0], f.flow[1]],
        }));
    }
    let envelopes = ShearEnvelope::both(&polygon);
    let block = greatest.is_finite().then_some(StressBlock { tension, total: greatest - least });
    Ok(JointStrength { rows, block, envelopes })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of_area(facets: &[Facet], area: f64) -> Result<JointStrength, String> {
        Ok(UnitStrength::of(facets)?.over(area))
    }

    fn mohr_coulomb(f_t: f64, f_c: f64, c: f64, mu: f64) -> Vec<Facet> {
        let [left, right] = Facet::friction(mu, c, mu);
        vec![Facet::opening(f_t), Facet::crushing(f_c), left, right]
    }

    #[test]
    fn dry_friction_has_opening_rows_and_two_sliding_rows() {
        let [left, right] = Facet::friction(0.6, 0.0, 0.0);
        let strength = of_area(&[Facet::opening(0.0), left, right], 2.0).unwrap();
        assert_eq!(strength.block, None);
        assert_eq!(strength.rows.len(), 4);
        assert_eq!(strength.tangential(), Tangential::Friction);
        assert!(strength.rows.iter().all(|row| row.bound == 0.0));
    }

    #[test]
    fn rows_carry_the_flow_of_their_facets() {
        let [left, right] = Facet::friction(0.6, 3.0, 0.25);
        let strength = of_area(&[Facet::opening(0.0), left, right], 2.0).unwrap();
        for row in &strength.rows {
            match row.mode {
                FacetMode::Sliding => assert_eq!(row.flow, [-0.25, -0.25, row.normal[2]]),
                _ => assert_eq!(row.flow, row.normal),
            }
        }
    }

    #[test]
    fn the_tension_bound_is_the_polygon_s_apex_where_cohesion_ends_first() {
        let strength = of_area(&mohr_coulomb(5.0, 100.0, 1.0, 0.5), 1.0).unwrap();
        let block = strength.block.unwrap();
        assert!((block.tension - 2.0).abs() < 1e-12 && (block.total - 102.0).abs() < 1e-12);
    }

    #[test]
    fn the_stress_block_is_the_parabola_of_the_design() {
        let (f_t, f_c, h, area) = (0.3, 10.0, 0.6, 1.2);
        let block = of_area(&mohr_coulomb(f_t, f_c, 4.0, 0.5), area).unwrap().block.unwrap();
        for n in [0.0, 1.0, 5.0, 11.0] {
            let limit = (n + f_t * area) * (f_c * area - n) * h / (2.0 * area * (f_c + f_t));
            let (n_0, n_1) = (n / 2.0 - limit / h, n / 2.0 + limit / h);
            let slack = |end: f64| block.total * (2.0 * end + block.tension) - (n + block.tension).powi(2);
            assert!(slack(n_0).abs() < 1e-9 && slack(n_1) > -1e-9);
        }
    }

    #[test]
    fn frictionless_and_stuck_joints_are_recognised() {
        let [left, right] = Facet::friction(0.0, 0.0, 0.0);
        assert_eq!(of_area(&[Facet::opening(0.0), left, right], 1.0).unwrap().tangential(), Tangential::Free);
        let stuck = of_area(&[Facet::opening(0.0)], 1.0).unwrap();
        assert_eq!((stuck.tangential(), stuck.block, stuck.rows.len()), (Tangential::Stuck, None, 2));
    }

    #[test]
    fn friction_beyond_rounding_does_not_slide() {
        for (mu, rows) in [(1e9, 4), (1e12, 2), (1e30, 2)] {
            let [left, right] = Facet::friction(mu, 0.0, mu);
            let strength = of_area(&[Facet::opening(0.0), left, right], 1.0).unwrap();
            assert_eq!(strength.rows.len(), rows, "{mu:e}");
        }
    }

    /// If crushing or cohesion is out of reach, opening and friction remain; if both are within reach, nothing changes.
    #[test]
    fn strengths_out_of_reach_leave_opening_and_friction() {
        let [left, right] = Facet::friction(0.6, 0.0, 0.6);
        let facets = [Facet::opening(0.0), Facet::crushing(1e15), left, right];
        let strong = of_area(&facets, 1.0).unwrap();
        assert_eq!(strong.within_reach(1e8), None);
        let dry = of_area(&[Facet::opening(0.0), left, right], 1.0).unwrap();
        assert_eq!(strong.within_reach(1e3), Some(dry));
        let glued = of_area(&mohr_coulomb(0.0, 1e6, 1e12, 0.6), 1.0).unwrap();
        let left = glued.within_reach(1e3).unwrap();
        assert_eq!((left.tangential(), left.block), (Tangential::Stuck, glued.block));
    }

    /// A second facet in one sense gives an envelope in that sense; a facet that touches the polygon nowhere does not.
    #[test]
    fn a_second_facet_gives_an_envelope_in_its_sense() {
        for (bound, senses) in [(2.0, vec![1.0]), (1e3, vec![])] {
            let mut facets = mohr_coulomb(0.1, 10.0, 1.0, 0.5);
            facets.push(Facet::associated(FacetMode::Sliding, [0.0, 1.0], bound));
            let found: Vec<f64> = of_area(&facets, 1.0).unwrap().envelopes.iter().map(|e| e.sense).collect();
            assert_eq!(found, senses, "{bound}");
        }
    }
}
