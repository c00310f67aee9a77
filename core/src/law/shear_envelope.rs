//! The greatest shear of a whole joint if several facets bound sliding in one sense.
//!
//! Let s(t_n) be the greatest admissible t_t of the law: concave and linear between its corners. The shear of a joint is
//! ∫ s(t_n), and its greatest value T⁺ for given normal forces N_0, N_1 depends on how the pressure is distributed. Every
//! admissible pressure is a sum of steps: the least pressure n_0 everywhere, the segment j of s, Δn_j wide, on a part of
//! the joint, and beyond the last corner any pressure, which may be concentrated. Because s is concave, the steepest
//! segments come first:
//!
//! ```text
//! T⁺ = max  t_0 A + Σ Δt_j A θ_j + ρ (R_0 + R_1)          θ_j: share of the joint that has reached segment j
//!      N  =  n_0 A + Σ Δn_j A θ_j + R_0 + R_1              R_i ≥ 0: pressure beyond the last corner, at end i
//!      M  =  Σ Δn_j A θ_j c_j + (R_1 − R_0) h/2            c_j: centre of the part
//! ```
//!
//! Linear duality: with a price p(x) of pressure, linear along the joint, segment j lies where p(x) ≤ Δt_j/Δn_j, and
//! p ≥ ρ. Each price bounds the shear of all distributions:
//!
//! ```text
//! T ≤ p_0 N_0 + p_1 N_1 + ∫ (t_0 − p n_0) + Σ ∫ max(0, Δt_j − p Δn_j)
//! ```
//!
//! so T⁺ is the least of these bounds, and the distribution that belongs to the best price is a proof from inside. Source:
//! our own; for one segment and no friction it is the rectangular stress block of Livesley (1978).

use super::facet::FacetMode;
use super::force_row::ForceRow;

use super::yield_polygon::YieldPolygon;

/// Logarithm of the steepest fall of a price over the spread of the slopes.
const STEEPEST: f64 = 40.0;
/// Number of halvings of the range of this logarithm, down to rounding.
const HALVINGS: usize = 60;
/// Number of prices that are tried for the deepest bound, each four times as steep as the one before.
const STEEPNESSES: i32 = 30;

/// A linear piece of the envelope \[N\]; its slope is Δt/Δn.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Segment {
    normal: f64,
    shear: f64,
}

impl Segment {
    fn slope(&self) -> f64 {
        self.shear / self.normal
    }
}

/// The concave envelope of the shear of a joint in one sense, for the whole joint \[N\].
#[derive(Debug, Clone, PartialEq)]
pub struct ShearEnvelope {
    /// Sense of the shear, 1 or −1: bounds hold for `sense` · T.
    pub sense: f64,
    /// N and T at the least pressure.
    start: [f64; 2],
    /// Segments by decreasing slope.
    segments: Vec<Segment>,
    /// Slope beyond the last corner; `None` if the pressure is bounded.
    beyond: Option<f64>,
}

/// A part of a joint with one traction, or a point with a force.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShearPiece {
    /// Ends of the part as shares of the height from the middle, −1/2 to 1/2; both are equal at a point.
    pub ends: [f64; 2],
    /// N and `sense` · T of the part \[N\].
    pub force: [f64; 2],
}

/// A distribution of admissible tractions over a joint, with the greatest shear for its normal forces.
#[derive(Debug, Clone, PartialEq)]
pub struct ShearDistribution {
    /// Parts with different tractions, and the points at which pressure beyond the last corner acts.
    pub pieces: Vec<ShearPiece>,
    /// Prices p_0 and p_1 of pressure at the ends: the slopes of the greatest shear by N_0 and N_1.
    pub price: [f64; 2],
}

impl ShearDistribution {
    /// Returns N_0, N_1 and `sense` · T \[N\].
    pub fn resultants(&self) -> [f64; 3] {
        self.pieces.iter().fold([0.0; 3], |[n_0, n_1, t], piece| {
            let [n, shear] = piece.force;
            let lever = (piece.ends[0] + piece.ends[1]) / 2.0;
            [n_0 + n * (0.5 - lever), n_1 + n * (0.5 + lever), t + shear]
        })
    }
}

/// The place of each segment, a part of the joint, and the pressure beyond the last corner at both ends \[N\].
struct Layout {
    parts: Vec<[f64; 2]>,
    beyond: [f64; 2],
    price: [f64; 2],
}

impl ShearEnvelope {
    /// Returns the envelopes of one square metre in both senses of a polygon of tractions, if they have several pieces.
    pub fn both(polygon: &YieldPolygon) -> Vec<Self> {
        [1.0, -1.0].into_iter().filter_map(|sense| Self::of(polygon, sense)).collect()
    }

    /// Returns the envelope of a polygon of tractions in one sense, for one square metre. `None` if it has one piece or
    /// none, or if the shear has no bound.
    fn of(polygon: &YieldPolygon, sense: f64) -> Option<Self> {
        if polygon.rays.iter().any(|ray| ray[0] <= 1e-12 && sense * ray[1] > 0.0) {
            return None;
        }
        let mut corners: Vec<[f64; 2]> = polygon.vertices.iter().map(|[n, t]| [*n, sense * t]).collect();
        corners.sort_by(|a, b| a[0].total_cmp(&b[0]).then(b[1].total_cmp(&a[1])));
        let scale = corners.iter().flatten().fold(0.0f64, |most, x| most.max(x.abs()));
        let least = corners.first()?[0];
        let start = corners.iter().filter(|c| c[0] <= least + 1e-12 * scale).max_by(|a, b| a[1].total_cmp(&b[1]))?;
        let beyond = polygon.rays.iter().filter(|ray| ray[0] > 1e-12).map(|ray| sense * ray[1] / ray[0]);
        let beyond = beyond.max_by(f64::total_cmp);
        let (mut segments, mut at) = (Vec::new(), *start);
        loop {
            let slope = |c: &[f64; 2]| (c[1] - at[1]) / (c[0] - at[0]);
            let right = corners.iter().filter(|c| c[0] > at[0] + 1e-12 * scale);
            let Some(next) = right.max_by(|a, b| slope(a).total_cmp(&slope(b))) else { break };
            if beyond.is_some_and(|beyond| slope(next) <= beyond) {
                break;
            }
            segments.push(Segment { normal: next[0] - at[0], shear: next[1] - at[1] });
            at = *next;
        }
        let pieces = segments.len() + usize::from(beyond.is_some());
        (pieces > 1).then_some(ShearEnvelope { sense, start: *start, segments, beyond })
    }

    /// Returns the envelope of a joint with this area \[m²\] from that of one square metre.
    pub fn over(&self, area: f64) -> Self {
        let segments = self.segments.iter();
        ShearEnvelope {
            start: self.start.map(|x| x * area),
            segments: segments.map(|s| Segment { normal: s.normal * area, shear: s.shear * area }).collect(),
            ..self.clone()
        }
    }

    /// Returns the distribution with the greatest shear among those with these normal forces. If no distribution has
    /// them, it has others close to them.
    pub fn greatest(&self, [n_0, n_1]: [f64; 2]) -> ShearDistribution {
        let (more, wanted) = (self.above_least(n_0 + n_1), (n_1 - n_0).abs() / 2.0);
        let mut layout = self.level(more, wanted).unwrap_or_else(|| self.tilted(more, wanted));
        // Layouts press the second end more.
        if n_0 > n_1 {
            layout.parts.iter_mut().for_each(|[from, to]| (*from, *to) = (-*to, -*from));
            layout.beyond.reverse();
            layout.price.reverse();
        }
        ShearDistribution { pieces: self.pieces(&layout), price: layout.price }
    }

    /// Returns the part of a normal force above the least pressure, as far as the envelope admits it.
    fn above_least(&self, normal: f64) -> f64 {
        let widths: f64 = self.segments.iter().map(|s| s.normal).sum();
        let most = if self.beyond.is_some() { f64::INFINITY } else { widths };
        (normal - self.start[0]).clamp(0.0, most)
    }

    /// Returns the pieces of a layout.
    fn pieces(&self, layout: &Layout) -> Vec<ShearPiece> {
        let mut cuts: Vec<f64> = [-0.5, 0.5].into_iter().chain(layout.parts.iter().flatten().copied()).collect();
        cuts.sort_by(f64::total_cmp);
        let mut pieces = Vec::new();
        for ends in cuts.windows(2).filter(|ends| ends[1] > ends[0]) {
            let middle = (ends[0] + ends[1]) / 2.0;
            let reached = |part: &[f64; 2]| part[0] < middle && middle < part[1];
            let here = self.segments.iter().zip(&layout.parts).filter(|(_, part)| reached(part));
            let [n, t] = here.fold(self.start, |[n, t], (segment, _)| [n + segment.normal, t + segment.shear]);
            let share = ends[1] - ends[0];
            pieces.push(ShearPiece { ends: [ends[0], ends[1]], force: [n * share, t * share] });
        }
        if let Some(slope) = self.beyond {
            let points = [-0.5, 0.5].into_iter().zip(layout.beyond).filter(|(_, force)| *force != 0.0);
            pieces.extend(points.map(|(at, n)| ShearPiece { ends: [at; 2], force: [n, slope * n] }));
        }
        pieces
    }

    /// Returns the row that cuts off a force (N_0, N_1, T) beyond the envelope at the greatest distance, if a row does.
    /// If one end is about to open, the envelope is steep, and the row at the same N_0 and N_1 cuts off little.
    pub fn deepest_row(&self, force: [f64; 3]) -> Option<ForceRow> {
        let [n_0, n_1, _] = force;
        let exact = self.greatest([n_0, n_1]).price;
        let more = self.above_least(n_0 + n_1);
        let tried = (-STEEPNESSES / 2..STEEPNESSES / 2).map(|power| {
            let fall = self.spread() * 4f64.powi(power);
            let mut price = self.tilt(more, fall).price;
            if n_0 > n_1 {
                price.reverse();
            }
            price
        });
        let depth = |row: &ForceRow| {
            let [a, b, c] = row.normal;
            (a * force[0] + b * force[1] + c * force[2] - row.bound) / (1.0 + a * a + b * b).sqrt()
        };
        let rows = std::iter::once(exact).chain(tried).map(|price| self.row(price));
        rows.max_by(|a, b| depth(a).total_cmp(&depth(b))).filter(|row| depth(row) > 0.0)
    }

    /// Returns the difference of the greatest and the least slope.
    fn spread(&self) -> f64 {
        (self.segments[0].slope() - self.least_slope()).max(f64::MIN_POSITIVE)
    }

    /// Returns the row sense · T − p_0 N_0 − p_1 N_1 ≤ c of a price.
    pub fn row(&self, price: [f64; 2]) -> ForceRow {
        let [p_0, p_1] = price;
        let base = self.start[1] - (p_0 + p_1) / 2.0 * self.start[0];
        let gains = self.segments.iter().map(|s| {
            let (a, b) = (s.shear - p_0 * s.normal, s.shear - p_1 * s.normal);
            let (low, high) = (a.min(b), a.max(b));
            match (low >= 0.0, high <= 0.0) {
                (true, _) => (a + b) / 2.0,
                (_, true) => 0.0,
                _ => high / 2.0 * (high / (high - low)),
            }
        });
        ForceRow::associated(FacetMode::Sliding, [-p_0, -p_1, self.sense], base + gains.sum::<f64>())
    }

    /// Returns the layout with the same price everywhere, if one has the moment `wanted`.
    fn level(&self, more: f64, wanted: f64) -> Option<Layout> {
        let mut left = more;
        let mut parts = vec![[0.0; 2]; self.segments.len()];
        for (segment, part) in self.segments.iter().zip(&mut parts) {
            if left < segment.normal {
                let share = left / segment.normal;
                let centre = if left > 0.0 { wanted / left } else { 0.0 };
                *part = [centre - share / 2.0, (centre + share / 2.0).min(0.5)];
                let fits = wanted <= left * (1.0 - share) / 2.0;
                return fits.then(|| Layout { parts, beyond: [0.0; 2], price: [segment.slope(); 2] });
            }
            left -= segment.normal;
            *part = [-0.5, 0.5];
        }
        let price = self.least_slope();
        (wanted <= left / 2.0).then(|| Layout {
            parts,
            beyond: [left / 2.0 - wanted, left / 2.0 + wanted],
            price: [price; 2],
        })
    }

    /// Returns the layout with a price that falls towards the second end, with the moment `wanted`.
    fn tilted(&self, more: f64, wanted: f64) -> Layout {
        let fall = |power: f64| self.spread() * power.exp();
        let (mut low, mut high) = (-STEEPEST, STEEPEST);
        for _ in 0..HALVINGS {
            let middle = (low + high) / 2.0;
            match self.moment(&self.tilt(more, fall(middle))) < wanted {
                true => low = middle,
                false => high = middle,
            }
        }
        self.tilt(more, fall(low))
    }

    /// Returns the moment of a layout over the height \[N\].
    fn moment(&self, layout: &Layout) -> f64 {
        let of =
            |(segment, part): (&Segment, &[f64; 2])| segment.normal * (part[1] - part[0]) * (part[0] + part[1]) / 2.0;
        let parts: f64 = self.segments.iter().zip(&layout.parts).map(of).sum();
        parts + (layout.beyond[1] - layout.beyond[0]) / 2.0
    }

    /// Returns the layout whose price falls by `fall` over the joint.
    fn tilt(&self, more: f64, fall: f64) -> Layout {
        let share = |segment: &Segment, price: f64| (0.5 - (price - segment.slope()) / fall).clamp(0.0, 1.0);
        let pressed = |price: f64| self.segments.iter().map(|s| s.normal * share(s, price)).sum::<f64>();
        let least = self.beyond.map(|beyond| beyond + fall / 2.0);
        let price = match least {
            Some(least) if pressed(least) <= more => least,
            _ => self.price_at(more, fall, pressed),
        };
        let parts: Vec<[f64; 2]> = self.segments.iter().map(|s| [0.5 - share(s, price), 0.5]).collect();
        let left = self.beyond.map_or(0.0, |_| (more - pressed(price)).max(0.0));
        Layout { parts, beyond: [0.0, left], price: [price + fall / 2.0, price - fall / 2.0] }
    }

    /// Returns the price at the middle for which the segments press with `more`: `pressed` is linear between the prices
    /// at which a segment begins or ends to spread.
    fn price_at(&self, more: f64, fall: f64, pressed: impl Fn(f64) -> f64) -> f64 {
        let ends = self.segments.iter().flat_map(|s| [s.slope() - fall / 2.0, s.slope() + fall / 2.0]);
        let mut ends: Vec<f64> = ends.collect();
        ends.sort_by(f64::total_cmp);
        let at = ends.partition_point(|price| pressed(*price) > more).clamp(1, ends.len() - 1);
        let (a, b) = (ends[at - 1], ends[at]);
        let (over, under) = (pressed(a), pressed(b));
        if over > under { a + (b - a) * ((over - more) / (over - under)).clamp(0.0, 1.0) } else { a }
    }

    /// Returns the least slope of the envelope.
    fn least_slope(&self) -> f64 {
        self.beyond.unwrap_or_else(|| self.segments[self.segments.len() - 1].slope())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::law::Facet;
    use crate::random::Random;

    fn envelopes(facets: &[Facet]) -> Vec<ShearEnvelope> {
        ShearEnvelope::both(&YieldPolygon::of(facets))
    }

    /// Teeth that are climbed with friction 1 up to t_n = 10, and sheared off at 4 + 0.6 t_n.
    fn teeth() -> Vec<Facet> {
        let pairs = [Facet::friction(1.0, 0.0, 1.0), Facet::friction(0.6, 4.0, 0.6)];
        pairs.into_iter().flatten().chain([Facet::opening(0.0)]).collect()
    }

    /// By hand, for pressure beyond the corner R at the end: N − 2M/h = Δn θ².
    #[test]
    fn the_shear_of_teeth_falls_with_the_moment() {
        let [envelope, mirrored] = &envelopes(&teeth())[..] else { panic!("both senses have two pieces") };
        let share = 0.4f64.sqrt();
        let eccentric = 10.0 * share + 0.6 * (20.0 - 10.0 * share);
        for (normal, moment, shear) in [
            (5.0, 0.0, 5.0),
            (5.0, 1.25, 5.0),
            (20.0, 0.0, 16.0),
            (20.0, 5.0, 16.0),
            (20.0, 8.0, eccentric),
            (20.0, 10.0, 12.0),
        ] {
            for (moment, envelope) in [(moment, envelope), (-moment, envelope), (moment, mirrored)] {
                let asked = [normal / 2.0 - moment, normal / 2.0 + moment];
                let [n_0, n_1, t] = envelope.greatest(asked).resultants();
                assert!((n_0 - asked[0]).abs().max((n_1 - asked[1]).abs()) < 1e-12, "{normal} {moment}: {n_0} {n_1}");
                assert!((t - shear).abs() < 1e-7, "{normal} {moment}: {t}, not {shear}");
            }
        }
    }

    /// A law with one facet in each sense has no envelope, also if it crushes; without a bound in one sense only the other
    /// has one.
    #[test]
    fn one_piece_needs_no_envelope() {
        let [left, right] = Facet::friction(0.6, 1.0, 0.6);
        assert!(envelopes(&[Facet::opening(0.1), left, right]).is_empty());
        assert!(envelopes(&[Facet::opening(0.1), Facet::crushing(10.0), left, right]).is_empty());
        let one_sense: Vec<Facet> = teeth().into_iter().filter(|facet| facet.normal[1] >= 0.0).collect();
        let senses: Vec<f64> = envelopes(&one_sense).iter().map(|envelope| envelope.sense).collect();
        assert_eq!(senses, [1.0]);
    }

    /// Duality: every row holds for every distribution of admissible tractions, and the row at the price of a greatest
    /// shear holds with equality. Tractions of the distribution are within all facets, and its normal forces are those that
    /// were asked for.
    #[test]
    fn no_row_is_below_a_distribution_and_the_best_touches_it() {
        let mut random = Random::new(7);
        for scene in 0..300 {
            let mut facets = vec![Facet::opening(random.between(0.0, 1.0))];
            if scene % 2 == 0 {
                facets.push(Facet::crushing(random.between(5.0, 20.0)));
            }
            for _ in 0..3 {
                let steepest = if scene % 3 == 0 { -0.4 } else { 0.1 };
                facets.extend(Facet::friction(random.between(steepest, 1.5), random.between(1.0, 8.0), 0.0));
            }
            let polygon = YieldPolygon::of(&facets);
            for envelope in ShearEnvelope::both(&polygon) {
                let corners: f64 = envelope.segments.iter().map(|s| s.normal).sum();
                let width = if envelope.beyond.is_some() { 3.0 * corners } else { corners };
                let more = width * random.between(0.0, 1.0);
                let greatest = if envelope.beyond.is_some() { more } else { more * (1.0 - more / width) };
                let moment = 0.999 * greatest / 2.0 * random.between(-1.0, 1.0);
                let normal = envelope.start[0] + more;
                let asked = [normal / 2.0 - moment, normal / 2.0 + moment];
                let found = envelope.greatest(asked);
                let [n_0, n_1, t] = found.resultants();
                let scale = corners + normal.abs() + t.abs();
                assert!(
                    (n_0 - asked[0]).abs().max((n_1 - asked[1]).abs()) < 1e-11 * scale,
                    "{scene}: {asked:?} {n_0} {n_1}"
                );
                for piece in &found.pieces {
                    let share = piece.ends[1] - piece.ends[0];
                    let excess = |f: &Facet| {
                        f.normal[0] * piece.force[0] + f.normal[1] * envelope.sense * piece.force[1] - f.bound * share
                    };
                    assert!(facets.iter().all(|facet| excess(facet) < 1e-11 * scale), "{scene}: {piece:?}");
                }
                let slack = |price: [f64; 2]| {
                    let row = envelope.row(price);
                    row.bound - row.normal[0] * n_0 - row.normal[1] * n_1 - t
                };
                let steep = 1.0 + found.price[0].abs().max(found.price[1].abs());
                assert!(slack(found.price).abs() < 1e-9 * scale * steep, "{scene}: {}", slack(found.price));
                for _ in 0..20 {
                    let least = envelope.beyond.unwrap_or(-2.0);
                    let price = [(); 2].map(|()| random.between(least, 3.0));
                    assert!(slack(price) > -1e-11 * scale, "{scene}: {price:?} {}", slack(price));
                }
            }
        }
    }

    /// The deepest row cuts off a force beyond the envelope and no force within it.
    #[test]
    fn the_deepest_row_cuts_off_what_is_beyond() {
        let envelope = &envelopes(&teeth())[0];
        for (n_0, n_1) in [(0.0, 20.0), (1e-9, 20.0), (3.0, 12.0), (5.0, 5.0), (8.0, 0.1)] {
            let [_, _, shear] = envelope.greatest([n_0, n_1]).resultants();
            assert_eq!(envelope.deepest_row([n_0, n_1, 0.999 * shear]), None, "{n_0} {n_1}");
            let row = envelope.deepest_row([n_0, n_1, 1.01 * shear]).expect("a row");
            assert!(row.normal[0] * n_0 + row.normal[1] * n_1 + 1.01 * shear > row.bound, "{n_0} {n_1}");
        }
    }
}
