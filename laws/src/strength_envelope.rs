//! `strength_envelope`: a joint whose strength is a concave polygon with any number of corners.
#![doc = include_str!("strength_envelope.md")]

use crate::shared::*;
use voussoir_core::law::{Facet, FacetMode, InterfaceLaw};
use voussoir_core::plugin::{Capability, Card, Keys, KnownPath, PluginKind, Property, Sample};

/// A joint with the strength of a polygon.
#[derive(Debug, Clone, Keys)]
#[keys(check = StrengthEnvelope::validate)]
pub struct StrengthEnvelope {
    /// corners (t_n, t_t) of the strength, by increasing pressure
    #[key(names = ["pressure", "shear strength"], unit = ["Pa", "Pa"], range = ["", ">= 0"], len = ">= 1, <= 100")]
    pub corners: Vec<[f64; 2]>,
    /// slope of the strength beyond the last corner
    #[key(unit = "-", range = ">= 0", optional = "the last corner is the greatest pressure")]
    pub residual_friction: Option<f64>,
    /// ψ \[deg\].
    #[key(like = JointKeys, default = 0.0)]
    pub dilatancy_angle: f64,
    /// k_n \[Pa/m\].
    #[key(like = JointKeys)]
    pub normal_stiffness: Option<f64>,
    /// k_t \[Pa/m\].
    #[key(like = JointKeys)]
    pub shear_stiffness: Option<f64>,
}

impl StrengthEnvelope {
    /// Returns each segment's first corner and slope.
    fn segments(&self) -> impl Iterator<Item = ([f64; 2], f64)> + '_ {
        let between =
            self.corners.windows(2).map(|ends| (ends[0], (ends[1][1] - ends[0][1]) / (ends[1][0] - ends[0][0])));
        between.chain(self.residual_friction.and_then(|slope| Some((*self.corners.last()?, slope))))
    }

    fn validate(&self) -> Vec<(String, String)> {
        let mut wrong = Vec::new();
        let mut say = |key: &str, what: &str| wrong.push((key.to_string(), what.to_string()));
        if self.corners.windows(2).any(|ends| ends[0][0] >= ends[1][0]) {
            say("corners", "the pressure must increase from corner to corner");
            return wrong;
        }
        let slopes: Vec<f64> = self.segments().map(|(_, slope)| slope).collect();
        if slopes.is_empty() {
            say("corners", "one corner needs residual_friction");
        }
        if slopes.windows(2).any(|pair| pair[0] <= pair[1]) {
            say("corners", "the slope must fall from segment to segment: the strength is not concave");
        }
        if self.corners.first().is_some_and(|first| first[0] > 0.0) {
            say("corners", "the first pressure must not be positive: a joint without forces must be admissible");
        }
        if self.residual_friction.is_none() && self.corners.last().is_some_and(|last| last[0] <= 0.0) {
            say("corners", "the last pressure must be positive, or residual_friction must be given");
        }
        wrong
    }
}

#[typetag::serde(name = "strength_envelope")]
impl InterfaceLaw for StrengthEnvelope {
    fn facets(&self) -> Option<Vec<Facet>> {
        let dilatancy = tangent(self.dilatancy_angle);
        let sliding = self.segments().flat_map(|([n, t], slope)| {
            let flow = slope.min(dilatancy);
            let mode = if slope < 0.0 { FacetMode::Crushing } else { FacetMode::Sliding };
            [1.0, -1.0].map(|sense| Facet {
                mode,
                normal: [-slope, sense],
                bound: (t - slope * n).max(0.0),
                flow: [-flow, sense],
            })
        });
        let opening = self.corners.first().map(|first| Facet::opening(-first[0]));
        let end = self.corners.last().filter(|_| self.residual_friction.is_none());
        let crushing = end.map(|last| Facet::crushing(last[0]));
        Some(opening.into_iter().chain(sliding).chain(crushing).collect())
    }

    fn stiffness(&self) -> Option<[f64; 2]> {
        stiffness(self.normal_stiffness, self.shear_stiffness)
    }
}

/// Teeth that are climbed with friction 1 and sheared off at 0.4 MPa + 0.6 t_n (Patton).
const TEETH: &str =
    "corners = [[0.0, 0.0], [1e6, 1e6]]\nresidual_friction = 0.6\nnormal_stiffness = 1e10\nshear_stiffness = 5e9";

/// A polygon within the Hoek–Brown strength with σ_ci = 10 MPa, m = 10, s = 1: σ_3 = −1, −0.9, −0.5, 0 and 1 MPa.
const HOEK_BROWN: &str = "corners = [[-1e6, 0.0], [-722458.0, 727954.0], [279519.0, 2214584.0], [1428571.0, 3499271.0], [3554792.0, 5440887.0]]\nresidual_friction = 0.73\ndilatancy_angle = 5.0\nnormal_stiffness = 1e10\nshear_stiffness = 5e9";

/// Friction with cohesion and a sloped cap.
const CAP: &str = "corners = [[-2e5, 3e5], [3e6, 2e6], [5e6, 0.0]]\nnormal_stiffness = 1e10\nshear_stiffness = 5e9";

/// Pressed, sheared off under constant gap, moved back.
const KNOWN_PATHS: &[KnownPath] = &[KnownPath {
    table: TEETH,
    source: "by hand: teeth are sheared off at 0.4 MPa + 0.6 t_n without opening",
    steps: &[
        (&[-2e-4, 0.0], &[2e6, 0.0]),
        (&[-2e-4, 1e-3], &[2e6, -1.6e6]),
        (&[-2e-4, 9e-4], &[2e6, -1.1e6]),
        (&[-5e-5, 9e-4], &[5e5, -5e5]),
    ],
    tolerance: 1e-12,
}];

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::InterfaceLaw,
        tag: "strength_envelope",
        summary: "a concave strength by its corners: teeth (Patton), Hoek–Brown polygons, sloped caps",
        provides: &[Capability::FACETS, Capability::RESPONSE],
        claims: &[Property::DISSIPATIVE],
        samples: &[
            Sample::new(TEETH, 3e-4, &["elastic", "sliding"]),
            Sample::new(HOEK_BROWN, 3e-4, &["elastic", "sliding"]),
            Sample::new(CAP, 6e-4, &["elastic", "sliding"]),
        ],
        known_paths: KNOWN_PATHS,
        sources: &["Patton 1966, Proc. 1st ISRM Congress, Lisbon", "Hoek & Brown 1980, J. Geotech. Eng. Div. 106"],
        file: file!(),
        package: voussoir_core::package!(),
        page: include_str!("strength_envelope.md"),
        ..Card::of::<StrengthEnvelope>()
    }
}
