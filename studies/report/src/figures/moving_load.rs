//! The load of an envelope on its way, with the mechanism at each place: a drawing that moves.

use super::displaced::displaced;
use super::drawing::{extent, outline_width, supports};
use super::envelope::line_name;
use super::hinge_closure::close_hinges;
use super::scene_canvas::{SceneCanvas, hatching};
use super::symbols::{LOAD, OUTLINE, STONE, Symbol};
use crate::output::StudyOutput;
use voussoir_core::model::geometry::Vec2;
use voussoir_core::model::{Assembly, Stage};
use voussoir_plot::colours::QUIET;
use voussoir_study::results::CaseResult;
use voussoir_study::results::format::{format_number, snap_words};

/// Places shown at the most.
const MOST: usize = 60;
/// How long each is shown \[s\].
const EACH: f64 = 0.4;

/// A place of the load: what stands there and how it moves.
struct Place<'a> {
    value: f64,
    case: &'a CaseResult,
    assembly: &'a Assembly,
    stage: &'a Stage,
    /// Outlines of the blocks as they move.
    moved: Vec<Vec<Vec2>>,
}

/// The places of an envelope one after another, of the vehicle and way it lists first; `None` where the results are no
/// envelope's, or no animation is wanted. What does not play shows the worst place.
pub fn moving_load_svg(study: &StudyOutput) -> Option<String> {
    let places = (study.output.animation && study.output.figures.anything()).then(|| places(study))??;
    let further: Vec<Vec2> = places
        .iter()
        .flat_map(|place| {
            let road = place.stage.spreads.iter().flat_map(|spread| spread.on_road);
            place.moved.iter().flatten().copied().chain(road).collect::<Vec<_>>()
        })
        .collect();
    let first = places.first()?;
    let (low, high) = extent(first.assembly, &further);
    let worst = (0..places.len()).min_by(|a, b| rank(&places[*a]).total_cmp(&rank(&places[*b])))?;
    // The second line is each place's own.
    let titles = [format!("{}: the load on its way", study.name), " ".into()];
    let mut canvas = SceneCanvas::new(low, high, [46.0, 60.0, 46.0, 30.0], &titles);
    surroundings(&mut canvas, first.assembly);
    let count = places.len() as f64;
    for (index, place) in places.iter().enumerate() {
        let (from, to) = (index as f64 / count, (index + 1) as f64 / count);
        canvas.open(&[("visibility", &if index == worst { "visible" } else { "hidden" })]);
        canvas.visible_during([from, to], EACH * count);
        frame(&mut canvas, place);
        canvas.close();
    }
    let caption = ["Displacements are exaggerated; at each place the mechanism has a scale of its own.".to_string()];
    Some(canvas.finish::<Symbol>(&[], &caption))
}

/// The load factor at a place; infinite where there is none.
fn rank(place: &Place) -> f64 {
    place.case.load_factor.unwrap_or(f64::INFINITY)
}

/// The places of the first line of the curve, from left to right.
fn places<'a>(study: &StudyOutput<'a>) -> Option<Vec<Place<'a>>> {
    let curve = study.results.own.curve.as_ref()?;
    let line = line_name(curve.first()?, &study.keys);
    let mut found: Vec<(f64, usize)> = curve
        .iter()
        .filter(|entry| line_name(entry, &study.keys) == line)
        .filter_map(|entry| {
            let place = study.results.cases.iter().position(|case| case.label.id == entry.case)?;
            Some((entry.value, place))
        })
        .collect();
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    let step = found.len().div_ceil(MOST).max(1);
    let of = |(value, index): (f64, usize)| {
        let (assembly, stages) = study.scene(index)?;
        let case = &study.results.cases[index];
        let motion = case.proof.motion.as_deref().unwrap_or_default();
        let placements = displaced(assembly, motion).map(|(placements, _)| match &case.mechanism {
            Some(mechanism) => close_hinges(assembly, mechanism, placements),
            None => placements,
        });
        let moved = assembly.bodies.iter().enumerate().filter(|(_, body)| !body.fixed).map(|(index, body)| {
            let at = |vertex: &Vec2| placements.as_ref().map_or(*vertex, |placements| placements[index].of(*vertex));
            body.vertices.iter().map(at).collect()
        });
        Some(Place { value, case, assembly, stage: stages.last()?, moved: moved.collect() })
    };
    let places: Vec<_> = found.into_iter().step_by(step).filter_map(of).collect();
    (!places.is_empty()).then_some(places)
}

/// What does not move: ground, supports, road.
fn surroundings(canvas: &mut SceneCanvas, assembly: &Assembly) {
    let ground = assembly.bodies.iter().filter(|body| body.fixed).map(|body| body.vertices.as_slice());
    canvas.shapes(ground, &hatching(), OUTLINE, 1.0, "");
    supports(canvas, assembly);
    if let Some(bridge) = &assembly.bridge {
        let road: Vec<_> = bridge.road.iter().map(|point| canvas.at(*point)).collect();
        canvas.line(&road, QUIET, 1.2, "");
    }
}

/// The load at one place, and how the blocks move there.
fn frame(canvas: &mut SceneCanvas, place: &Place) {
    let digits = |factor: f64| format_number(factor, 4);
    let snaps = snap_words(place.case.load_factor, place.case.path.first_limit_point, digits);
    let factor = snaps.or(place.case.load_factor.map(digits)).unwrap_or_else(|| "none".into());
    canvas.last_title(&format!("x = {:.3} m, load factor at collapse: {factor}", place.value));
    let width = outline_width(canvas, place.assembly);
    canvas.shapes(place.moved.iter().map(Vec::as_slice), STONE, OUTLINE, width, "");
    for spread in &place.stage.spreads {
        for (from, to) in spread.on_road.iter().zip(&spread.below) {
            let ends = [canvas.at(*from), canvas.at(*to)];
            canvas.line(&ends, LOAD, 0.8, "3 3");
        }
        let [a, b] = spread.on_road.map(|point| canvas.at(point));
        canvas.line(&[a, b], LOAD, 4.0, "");
        let tip = [(a[0] + b[0]) / 2.0, (a[1] + b[1]) / 2.0];
        canvas.arrow([tip[0], tip[1] - 46.0], tip, LOAD, 2.0, 8.0);
    }
}
