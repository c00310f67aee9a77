//! Flow that is not associated, turned into it from associated flow, with which every step is a monotone
//! problem.

use super::model::{Control, Model, State};
use crate::contact::facet::with_flow_between;
use crate::contact::yield_polygon::YieldPolygon;

impl Model<'_> {
    /// Takes slip to be associated; the laws as they were.
    pub fn associated(&mut self) -> Vec<YieldPolygon> {
        let own = self.polygons.clone();
        self.blend(&own, 0.0);
        own
    }

    /// Turns the flow from the facets' normals (0) to the given laws' own (1).
    fn blend(&mut self, laws: &[YieldPolygon], own: f64) {
        let turned = |law: &YieldPolygon| YieldPolygon::new(&with_flow_between(&law.facets, own));
        self.polygons = laws.iter().map(turned).collect();
    }

    /// A state at a factor by turning the flow of associated slip, which has one where any has, step by
    /// step into the laws' own.
    pub fn turned(&mut self, start: &State, factor: f64) -> Option<State> {
        let own = self.polygons.clone();
        let mut guess = start.clone();
        let mut found = None;
        for share in [0.0, 0.3, 0.55, 0.75, 0.9, 1.0] {
            self.blend(&own, share);
            guess.factor = factor;
            found = self.newton(start, guess.clone(), &Control::Factor(factor)).ok().map(|(state, _)| state);
            match &found {
                Some(state) => guess = state.clone(),
                None if share == 0.0 => break,
                None => {}
            }
        }
        self.polygons = own;
        found
    }
}
