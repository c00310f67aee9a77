//! What a whole joint can carry: the facets of its law integrated over its height.
//!
//! With forces (N_0, N_1) at the joint's ends and T along it (N = N_0 + N_1, M = (N_1 − N_0) h/2),
//! A = h × width, tension bound F_t = f_t A and crushing bound F_c = f_c A:
//! - opening: N_0 ≥ −F_t/2 and N_1 ≥ −F_t/2, which is |M| ≤ (N + F_t) h/2;
//! - crushing: (N + F_t)² ≤ (F_c + F_t)(2 N_i + F_t) at both ends i, which is the rectangular stress
//!   block |M| ≤ (N + F_t)(F_c − N) h / (2 (F_c + F_t));
//! - sliding: a_n N + a_t T ≤ b A for each facet with a_t ≠ 0.
//!
//! These are exact: with b = 0 the two ends span every distribution; with b > 0 the admissible T of
//! a distribution of t_n depends on N only as long as each sense of sliding has one facet.
//! Source of the stress block: Livesley (1978), rectangular block; the cone form is ours.
//!
//! Flow over the jumps dual to (N_0, N_1, T), which are the openings of the two ends and the slip:
//! (ġ_0, ġ_1, ġ_t) = −Σ γ_i d_i, γ ≥ 0. A row's d is its facet's own; opening and crushing are
//! associated.

use super::facet::{Facet, FacetMode};
use super::yield_polygon::{YieldPolygon, dot};

/// A linear row over (N_0, N_1, T) \[N\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ForceRow {
    /// Coefficients of N_0, N_1 and T.
    pub normal: [f64; 3],
    /// Right-hand side \[N\].
    pub bound: f64,
    /// What happens when it yields.
    pub mode: FacetMode,
    /// Flow d over the openings of both ends and the slip when it yields; its normal where
    /// associated.
    pub flow: [f64; 3],
}

impl ForceRow {
    /// A row with associated flow.
    pub fn associated(mode: FacetMode, normal: [f64; 3], bound: f64) -> Self {
        ForceRow { normal, bound, mode, flow: normal }
    }
}

/// The stress block of a joint that crushes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StressBlock {
    /// F_t \[N\].
    pub tension: f64,
    /// F_c + F_t \[N\].
    pub total: f64,
}

/// What a joint can carry.
#[derive(Debug, Clone, PartialEq)]
pub struct JointStrength {
    /// Linear rows: opening (unless a stress block is present, which implies them), sliding.
    pub rows: Vec<ForceRow>,
    /// Crushing, where strength is finite: applies to both ends.
    pub block: Option<StressBlock>,
}

impl JointStrength {
    /// Whether rows leave T free of bounds, or fix it to zero.
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

    /// The same without crushing and cohesion that forces of this size never come near; `None` where it has none such.
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
        Some(JointStrength { rows, block })
    }
}

/// Crushing strength over force from which it changes no digit that a certificate looks at: it enters as its inverse.
const UNCRUSHED: f64 = 1e8;
/// Cohesion over force from which a joint is not expected to slide: it does not enter where it is not reached.
const STUCK: f64 = 1e3;

/// The rows of a joint that opens at this tension \[N\].
fn opening(tension: f64) -> [ForceRow; 2] {
    [[-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]].map(|normal| ForceRow::associated(FacetMode::Opening, normal, tension / 2.0))
}

/// The three ways a joint treats T.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Tangential {
    /// T has no bound: no tangential rows.
    Stuck,
    /// T = 0: no tangential variable.
    Free,
    /// Bounds on T.
    Friction,
}

/// A coefficient of friction from which on a joint does not slide at all: T would be bounded only where N is
/// less than the rounding of T.
const NO_SLIDING: f64 = 1e11;

/// Whether a facet bounds T with a sense of its own, other than by friction too great to be told from none.
fn bounds_sliding(facet: &Facet, sense: f64) -> bool {
    facet.normal[1] * sense > 0.0 && -facet.normal[0] < NO_SLIDING * facet.normal[1].abs()
}

/// The strength of one square metre of a joint with some law, of which that of any area is a multiple.
#[derive(Debug, Clone, PartialEq)]
pub struct UnitStrength(JointStrength);

impl UnitStrength {
    /// Integrates facets. An error says what cannot be integrated.
    pub fn of(facets: &[Facet]) -> Result<Self, String> {
        integrate(facets).map(UnitStrength)
    }

    /// What a joint of an area \[m²\] carries.
    pub fn over(&self, area: f64) -> JointStrength {
        let UnitStrength(JointStrength { rows, block }) = self;
        JointStrength {
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
        // A facet counts where it bounds the polygon in more than a corner.
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
        match bounding[..] {
            [] if on_side.is_empty() => {}
            [] | [_] => {
                let f = bounding.first().copied().unwrap_or(on_side[0]);
                rows.push(ForceRow {
                    normal: [f.normal[0], f.normal[0], f.normal[1]],
                    bound: f.bound,
                    mode: FacetMode::Sliding,
                    flow: [f.flow[0], f.flow[0], f.flow[1]],
                });
            }
            _ => {
                return Err(format!(
                    "{} facets bound sliding in one sense; limit analysis integrates one",
                    bounding.len()
                ));
            }
        }
    }
    let block = greatest.is_finite().then_some(StressBlock { tension, total: greatest - least });
    Ok(JointStrength { rows, block })
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

    /// What never crushes opens as before; a joint that can be reached is left alone.
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

    #[test]
    fn two_facets_in_one_sense_are_refused() {
        let mut facets = mohr_coulomb(0.1, 10.0, 1.0, 0.5);
        facets.push(Facet::associated(FacetMode::Sliding, [0.0, 1.0], 2.0));
        assert!(of_area(&facets, 1.0).is_err());
    }
}
