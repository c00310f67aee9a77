//! Scenes with closed forms, for tests.

use voussoir_core::law::{FacetMode, ForceRow, JointStrength, StressBlock};
use voussoir_core::limit::{LimitJoint, LimitProblem};
use voussoir_core::model::geometry::{Vec2, turned};

/// The strengths of the joints of a scene.
#[derive(Debug, Clone, Copy)]
pub struct Dry {
    /// Friction coefficient; without it joints do not slide.
    pub friction: Option<f64>,
    /// True if sliding opens joints: associated flow.
    pub associated: bool,
    /// Force that crushes a joint \[N\].
    pub crushing: Option<f64>,
}

/// Joints that neither slide nor crush.
pub const STUCK: Dry = Dry { friction: None, associated: true, crushing: None };

impl Dry {
    fn strength(self) -> JointStrength {
        let mut rows = Vec::new();
        if self.crushing.is_none() {
            rows.extend(
                [[-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]]
                    .map(|normal| ForceRow::associated(FacetMode::Opening, normal, 0.0)),
            );
        }
        for (mu, sense) in self.friction.into_iter().flat_map(|mu| [(mu, 1.0), (mu, -1.0)]) {
            let mut row = ForceRow::associated(FacetMode::Sliding, [-mu, -mu, sense], 0.0);
            if !self.associated {
                row.flow = [0.0, 0.0, sense];
            }
            rows.push(row);
        }
        let block = self.crushing.map(|total| StressBlock { tension: 0.0, total });
        JointStrength { rows, block, envelopes: Vec::new() }
    }

    /// Creates a joint whose tangent points from the first end to the second.
    fn joint(self, index: usize, (minus, plus): (Option<usize>, Option<usize>), ends: [[f64; 2]; 2]) -> LimitJoint {
        let ends = ends.map(|[x, y]| Vec2::new(x, y));
        let tangent = (ends[1] - ends[0]).normalize();
        LimitJoint {
            joint: index,
            fill: None,
            minus,
            plus,
            ends,
            normal: -turned(tangent),
            tangent,
            strength: self.strength(),
        }
    }
}

/// A block of 1 N on the ground, pushed by λ N at half its height: λ = b/h (1 − W/F) if it rocks, μ if it slides.
pub fn block(width: f64, height: f64, dry: Dry) -> LimitProblem {
    LimitProblem {
        group_of: vec![Some(0)],
        groups: 1,
        joints: vec![dry.joint(0, (None, Some(0)), [[width / 2.0, 0.0], [-width / 2.0, 0.0]])],
        fixed: vec![[0.0, -1.0, 0.0]],
        varying: vec![[1.0, 0.0, -height / 2.0]],
        pole: Vec2::zeros(),
        length: width.hypot(height),
        non_associated: !dry.associated,
    }
}

/// Two half lintels without weight and a vertical load of λ N between them. The thrust is free and each of the three
/// joints carries at most F h/8, so that λ = F h/L.
pub fn lintel(span: f64, height: f64, crushing: f64) -> LimitProblem {
    let dry = Dry { crushing: Some(crushing), ..STUCK };
    let at = |x: f64| [[x, 0.0], [x, height]];
    let half = span / 2.0;
    LimitProblem {
        group_of: vec![Some(0), Some(1)],
        groups: 2,
        joints: vec![
            dry.joint(0, (None, Some(0)), at(-half)),
            dry.joint(1, (Some(0), Some(1)), at(0.0)),
            dry.joint(2, (Some(1), None), at(half)),
        ],
        fixed: vec![[0.0; 3]; 2],
        varying: vec![[0.0, -0.5, 0.0]; 2],
        pole: Vec2::zeros(),
        length: span,
        non_associated: false,
    }
}

/// A semicircular ring of voussoirs between two radii with a total weight of 1 N and a live load of λ N on the voussoir
/// at a quarter of the span.
pub fn ring(voussoirs: usize, inner: f64, outer: f64, dry: Dry) -> LimitProblem {
    let angle = |place: f64| std::f64::consts::PI * (1.0 - place / voussoirs as f64);
    let at = |place: f64, radius: f64| [radius * angle(place).cos(), radius * angle(place).sin()];
    let joint = |index: usize| {
        let groups = (index.checked_sub(1), Some(index).filter(|index| *index < voussoirs));
        dry.joint(index, groups, [at(index as f64, inner), at(index as f64, outer)])
    };
    let weight = 1.0 / voussoirs as f64;
    let middle = |group: usize| at(group as f64 + 0.5, (inner + outer) / 2.0)[0];
    let quarter = voussoirs / 4;
    let load = |group: usize, force: f64| [0.0, -force, -force * middle(group)];
    LimitProblem {
        group_of: (0..voussoirs).map(Some).collect(),
        groups: voussoirs,
        joints: (0..=voussoirs).map(joint).collect(),
        fixed: (0..voussoirs).map(|group| load(group, weight)).collect(),
        varying: (0..voussoirs).map(|group| load(group, f64::from(u8::from(group == quarter)))).collect(),
        pole: Vec2::zeros(),
        length: 2.0 * outer,
        non_associated: !dry.associated,
    }
}
