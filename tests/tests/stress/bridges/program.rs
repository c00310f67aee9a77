//! Blocks, joints, fill and vehicle of a bridge as a conic program: the greatest λ with N, T, M at every joint and H at
//! every chord.

use super::bridge::{Axle, Bridge};
use super::fill::{Point, area_moment};
use crate::conic::{Extreme, Rows};

/// A block that can move.
struct Block {
    polygon: Vec<Point>,
}

/// A straight joint between two blocks (`None` is the ground). The second block is on the right of the direction
/// between its ends.
struct Contact {
    on: [Option<usize>; 2],
    ends: [Point; 2],
    friction: f64,
}

/// A face of a block, and true if fill presses sideways on it.
type Face = (usize, [Point; 2], bool);

/// All parts of the bridge.
#[derive(Default)]
struct Parts {
    blocks: Vec<Block>,
    contacts: Vec<Contact>,
    /// Upper faces of outermost rings and tops of piers, from left to right; true if fill presses sideways there.
    faces: Vec<Face>,
    /// Blocks that are lost.
    gone: Vec<usize>,
    springings: [f64; 2],
}

impl Parts {
    /// Returns the part of a face that is not below another face.
    fn visible(&self, face: &[Point; 2]) -> [f64; 2] {
        let y = |face: &[Point; 2], x: f64| {
            face[0][1] + (face[1][1] - face[0][1]) * (x - face[0][0]) / (face[1][0] - face[0][0])
        };
        let mut range = [face[0][0], face[1][0]];
        for (_, other, _) in &self.faces {
            let (low, high) = (other[0][0].max(range[0]), other[1][0].min(range[1]));
            let middle = (low + high) / 2.0;
            if high - low > 1e-9 && y(other, middle) > y(face, middle) + 1e-9 {
                if low <= range[0] { range[0] = high } else { range[1] = low }
            }
        }
        range
    }

    fn block(&mut self, polygon: Vec<Point>) -> usize {
        self.blocks.push(Block { polygon });
        self.blocks.len() - 1
    }
}

impl Bridge {
    /// Returns the vertex on the line of joint k of a span at a share of the thickness, with the left springing at x.
    fn vertex(&self, span: usize, x: f64, k: usize, share: f64) -> Point {
        let s = &self.spans[span];
        let radius = (s.span * s.span / 4.0 + s.rise * s.rise) / (2.0 * s.rise);
        let half = (s.span / 2.0).atan2(radius - s.rise);
        let from_middle = 1.0 - 2.0 * k as f64 / s.voussoirs as f64;
        let thickness = s.thickness[0] + (s.thickness[1] - s.thickness[0]) * from_middle.abs();
        let (angle, r) = (half * from_middle, radius + share * thickness);
        [x + s.span / 2.0 - r * angle.sin(), s.rise - radius + r * angle.cos()]
    }

    fn parts(&self) -> Parts {
        let mut parts = Parts::default();
        let (mut x, mut before) = (0.0, None);
        for (index, span) in self.spans.iter().enumerate() {
            let at = |k: usize, ring: usize| self.vertex(index, x, k, ring as f64 / span.rings as f64);
            let mut last = Vec::new();
            let n = span.voussoirs;
            for r in 0..span.rings {
                let first = parts.blocks.len();
                for k in 0..n {
                    parts.block(vec![at(k, r), at(k + 1, r), at(k + 1, r + 1), at(k, r + 1)]);
                }
                for k in 0..n {
                    let left = if k == 0 { before } else { Some(first + k - 1) };
                    let ends = self.remaining(index, r, k, [at(k, r), at(k, r + 1)]);
                    parts.contacts.push(Contact { on: [left, Some(first + k)], ends, friction: self.friction });
                    if r > 0 {
                        let ends = [at(k + 1, r), at(k, r)];
                        let on = [Some(first + k - n), Some(first + k)];
                        parts.contacts.push(Contact { on, ends, friction: self.ring_friction });
                    }
                    if r + 1 == span.rings && self.gone.contains(&(index, k)) {
                        parts.gone.push(first + k);
                        parts.faces.extend(self.uncovered(index, k, first, &at));
                    } else if r + 1 == span.rings {
                        parts.faces.push((first + k, [at(k, r + 1), at(k + 1, r + 1)], true));
                    }
                }
                last.push((first + n - 1, self.remaining(index, r, n, [at(n, r), at(n, r + 1)])));
            }
            let end = [at(n, 0), at(n, span.rings)];
            let next_x = x + span.span + self.piers.get(index).map_or(0.0, |pier| pier.1);
            before = (index < self.piers.len()).then(|| self.pier(&mut parts, index, end, next_x));
            for (block, ends) in last {
                parts.contacts.push(Contact { on: [Some(block), before], ends, friction: self.friction });
            }
            parts.springings[1] = end[0][0];
            x = next_x;
        }
        let gone = std::mem::take(&mut parts.gone);
        parts.contacts.retain(|contact| !contact.on.iter().flatten().any(|block| gone.contains(block)));
        gone.iter().for_each(|block| parts.blocks[*block].polygon.clear());
        parts
    }

    /// Returns the faces that are exposed if voussoir k of the outermost ring is lost: the side of the left neighbour,
    /// the ring below, and the side of the right neighbour, as far as they face upwards. `first` is the first block of
    /// the ring.
    fn uncovered(&self, span: usize, k: usize, first: usize, at: &dyn Fn(usize, usize) -> Point) -> Vec<Face> {
        let (n, outer) = (self.spans[span].voussoirs, self.spans[span].rings);
        let stays = |k: usize| !self.gone.contains(&(span, k));
        let mut faces = Vec::new();
        let left = [at(k, outer), at(k, outer - 1)];
        if stays(k - 1) && left[0][0] < left[1][0] {
            faces.push((first + k - 1, left, false));
        }
        faces.push((first + k - n, [at(k, outer - 1), at(k + 1, outer - 1)], true));
        let right = [at(k + 1, outer - 1), at(k + 1, outer)];
        if stays(k + 1) && right[0][0] < right[1][0] {
            faces.push((first + k + 1, right, false));
        }
        faces
    }

    /// Returns the remaining part of a joint that has lost mortar.
    fn remaining(&self, span: usize, ring: usize, joint: usize, [a, b]: [Point; 2]) -> [Point; 2] {
        let height = (b[0] - a[0]).hypot(b[1] - a[1]);
        let (mut from, mut to) = (0.0_f64, height);
        for lost in self.lost.iter().filter(|lost| (lost.0, lost.1, lost.2) == (span, ring, joint)) {
            if lost.3 { from = from.max(lost.4) } else { to = to.min(height - lost.4) }
        }
        [from, to].map(|s| [a[0] + (b[0] - a[0]) * s / height, a[1] + (b[1] - a[1]) * s / height])
    }

    /// Adds cap and courses of a pier between the springing faces of two spans and returns the cap.
    fn pier(&self, parts: &mut Parts, index: usize, [inner, outer]: [Point; 2], next_x: f64) -> usize {
        let (height, width, foot, courses) = self.piers[index];
        let (next_inner, next_outer) = (self.vertex(index + 1, next_x, 0, 0.0), self.vertex(index + 1, next_x, 0, 1.0));
        let cap = parts.block(vec![inner, next_inner, next_outer, outer]);
        parts.faces.push((cap, [outer, next_outer], false));
        let middle = (inner[0] + next_inner[0]) / 2.0;
        let level = |i: usize| {
            let share = i as f64 / courses as f64;
            let half = (width + (foot - width) * share) / 2.0;
            [[middle - half, -height * share], [middle + half, -height * share]]
        };
        let mut above = cap;
        for i in 0..courses {
            let ([tl, tr], [bl, br]) = (level(i), level(i + 1));
            let course = parts.block(vec![bl, br, tr, tl]);
            let ends = self.bed_left(index, i, [tr, tl]);
            parts.contacts.push(Contact { on: [Some(course), Some(above)], ends, friction: self.friction });
            above = course;
        }
        let [left, right] = level(courses);
        let ends = self.bed_left(index, courses, [right, left]);
        parts.contacts.push(Contact { on: [None, Some(above)], ends, friction: self.friction });
        cap
    }

    /// Returns the remaining part of a bed joint that has lost mortar, between its right and its left end.
    fn bed_left(&self, pier: usize, joint: usize, [mut right, mut left]: [Point; 2]) -> [Point; 2] {
        for (_, _, from_left, depth) in self.bed.iter().filter(|bed| (bed.0, bed.1) == (pier, joint)) {
            if *from_left { left[0] += depth } else { right[0] -= depth }
        }
        [right, left]
    }

    /// Returns the live forces, downwards: block, x, force.
    fn live(&self, parts: &Parts) -> Vec<(usize, f64, f64)> {
        let at = |face: &[Point; 2], x: f64| {
            face[0][1] + (face[1][1] - face[0][1]) * (x - face[0][0]) / (face[1][0] - face[0][0])
        };
        let mut out = Vec::new();
        for Axle { at: distance, force, length, wheel } in &self.axles {
            let x = self.at + distance;
            let covers = |face: &&Face| (parts.visible(&face.1)[0]..=parts.visible(&face.1)[1]).contains(&x);
            let Some(under) = parts.faces.iter().find(covers) else { continue };
            let reach = self.reach([x, at(&under.1, x)]);
            let carrying = if self.effective { self.width.min(wheel + 2.0 * reach) } else { self.width };
            let force = force * self.width / carrying;
            let (from, to) = (x - length / 2.0 - reach, x + length / 2.0 + reach);
            if to <= from {
                out.push((under.0, x, force));
                continue;
            }
            let depth = self.road_at(x) - at(&under.1, x);
            for (from, to, share) in self.patches([x, length / 2.0, reach, depth]) {
                for (block, face, _) in &parts.faces {
                    let [left, right] = parts.visible(face);
                    let (low, high) = (left.max(from), right.min(to));
                    if high > low {
                        out.push((*block, (low + high) / 2.0, force * share * (high - low) / (to - from)));
                    }
                }
            }
        }
        out
    }

    /// Returns patches of uniform pressure as (from, to, share) for a patch at x with this half width.
    fn patches(&self, [x, half, reach, depth]: [f64; 4]) -> Vec<(f64, f64, f64)> {
        let most = half + reach;
        if !self.half_plane || reach <= 0.0 || depth <= 0.0 {
            return vec![(x - most, x + most, 1.0)];
        }
        // Share of the load to the left of u; the share of a line load if the patch has no width.
        let left = |u: f64| {
            let of = |u: f64| u * (u / depth).atan();
            match half {
                0.0 => (u / depth).atan() + u * depth / (u * u + depth * depth),
                _ => (of(u + half) - of(u - half)) / (2.0 * half),
            }
        };
        let place = |i: i32| most * f64::from(2 * i - 40) / 40.0;
        let whole = left(most) - left(-most);
        (0..40).map(|i| (x + place(i), x + place(i + 1), (left(place(i + 1)) - left(place(i))) / whole)).collect()
    }

    /// Returns the greatest λ; `None` if there is no λ or no greatest one.
    pub fn load_factor(&self) -> Option<f64> {
        let parts = self.parts();
        let (lowest, highest) = match self.springings_only {
            true => (0.0, parts.springings[1]),
            false => (f64::NEG_INFINITY, f64::INFINITY),
        };
        let reactions: Vec<_> = (parts.faces.iter().filter(|face| face.2))
            .filter_map(|(block, face, _)| {
                let (low, high) = (face[0][0].max(lowest), face[1][0].min(highest));
                (low < high).then(|| self.reaction(*face, [low, high]).map(|reaction| (*block, reaction)))?
            })
            .collect();
        let (joints, blocks) = (parts.contacts.len(), parts.blocks.len());
        let variables = 3 * joints + reactions.len() + 1;
        let mut rows = Rows::new(variables);
        // Equilibrium: 3 rows per block, the forces on the block are zero.
        let centres: Vec<[f64; 3]> = parts.blocks.iter().map(|block| area_moment(&block.polygon)).collect();
        let mut right = vec![[0.0; 3]; blocks];
        let mut dead = |block: usize, [x, _]: Point, weight: f64| {
            right[block][1] += weight;
            right[block][2] += weight * x;
        };
        for (block, [area, mx, my]) in centres.iter().enumerate().filter(|(_, [area, ..])| *area > 0.0) {
            dead(block, [mx / area, my / area], 9.81 * self.density * area * self.width);
        }
        for (block, face, _) in &parts.faces {
            let [low, high] = parts.visible(face);
            let [mass, moment] = self.column(*face, [low.max(lowest), high.min(highest)]);
            if mass > 0.0 {
                dead(*block, [moment / mass, 0.0], 9.81 * mass);
            }
        }
        let mut columns: Vec<Vec<(usize, [f64; 3])>> = vec![Vec::new(); variables];
        for (j, contact) in parts.contacts.iter().enumerate() {
            let [a, b] = contact.ends;
            let (h, p) = ((b[0] - a[0]).hypot(b[1] - a[1]), [(a[0] + b[0]) / 2.0, (a[1] + b[1]) / 2.0]);
            let t = [(b[0] - a[0]) / h, (b[1] - a[1]) / h];
            // The normal points from the first block to the second.
            let n = [t[1], -t[0]];
            let moment = |f: [f64; 2]| p[0] * f[1] - p[1] * f[0];
            for (side, sign) in [(0, -1.0), (1, 1.0)] {
                let Some(block) = contact.on[side] else { continue };
                columns[3 * j].push((block, [sign * n[0], sign * n[1], sign * moment(n)]));
                columns[3 * j + 1].push((block, [sign * t[0], sign * t[1], sign * moment(t)]));
                columns[3 * j + 2].push((block, [0.0, 0.0, sign]));
            }
        }
        for (i, (block, reaction)) in reactions.iter().enumerate() {
            columns[3 * joints + i].push((*block, [reaction.sense, 0.0, -reaction.point[1] * reaction.sense]));
        }
        for (block, x, force) in self.live(&parts) {
            columns[variables - 1].push((block, [0.0, -force, -force * x]));
        }
        for (variable, column) in columns.iter().enumerate() {
            for (block, entries) in column {
                (0..3).for_each(|d| rows.entry(3 * block + d, variable, entries[d]));
            }
        }
        rows.right = right.iter().flat_map(|r| [r[0], r[1], r[2]]).collect();
        rows.linear_from = rows.right.len();
        self.strengths(&parts, &mut rows);
        for (i, (_, reaction)) in reactions.iter().enumerate() {
            rows.row(&[(3 * joints + i, 1.0)], reaction.bounds[1]);
            rows.row(&[(3 * joints + i, -1.0)], -reaction.bounds[0]);
        }
        rows.row(&[(variables - 1, -1.0)], 0.0);
        if let Some(strength) = self.crushing {
            self.crushing(&parts, strength, &mut rows);
        }
        match rows.extreme(variables - 1, 1.0) {
            Extreme::Value(factor) => Some(factor),
            _ => None,
        }
    }

    /// Adds |T| ≤ μ N and |M| ≤ N h/2.
    fn strengths(&self, parts: &Parts, rows: &mut Rows) {
        for (j, contact) in parts.contacts.iter().enumerate() {
            let [a, b] = contact.ends;
            let h = (b[0] - a[0]).hypot(b[1] - a[1]);
            for sign in [-1.0, 1.0] {
                rows.row(&[(3 * j + 1, sign), (3 * j, -contact.friction)], 0.0);
                rows.row(&[(3 * j + 2, sign), (3 * j, -h / 2.0)], 0.0);
            }
        }
    }

    /// Adds N² ≤ f_c A (N − 2 |M|/h) as cones.
    fn crushing(&self, parts: &Parts, strength: f64, rows: &mut Rows) {
        rows.cones_from = rows.right.len();
        let typical = rows.typical();
        for (j, contact) in parts.contacts.iter().enumerate() {
            let [a, b] = contact.ends;
            let h = (b[0] - a[0]).hypot(b[1] - a[1]);
            rows.stress_block([3 * j, 3 * j + 2], h, [strength * h * self.width, 0.0], typical);
        }
    }
}
