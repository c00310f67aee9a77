//! Pictures of cases: an animated drawing of each case, and its load-displacement curve.

use crate::figures::{curve_svg, mechanism_of_case, scene_of_case};
use crate::output::StudyOutput;
use crate::writers::page::figure;
use maud::{Markup, PreEscaped, html};
use voussoir_plot::svg::own_ids;
use voussoir_study::results::format::headline;

/// The caption of a load-displacement curve.
pub(super) const CURVE: &str = "Load against displacement. The displacement is that of the loaded blocks as rigid bodies, in the \
direction of the load, from the unloaded scene.";

/// Explains the pictures.
const MEANING: &str = "A thrust line shows where the resultant force crosses the joints. While it stays within the blocks an \
arch without tension can stand; at a face of a block a hinge can form. A hinge is drawn where the blocks still touch; the joint \
opens on the other side. In walls a bar at each joint shows where its force acts, its direction and its size. A strut is a set \
of forces that balances the load alone, without weight: a scene with a strut carries any load.";

/// The picture of the case with this index. The script animates it. Without the script, and in print, the mechanism is
/// a second drawing.
pub(super) fn of_case(study: &StudyOutput, place: usize) -> Markup {
    let Some((assembly, stages)) = study.scene(place) else { return html! {} };
    let case = &study.results.cases[place];
    let (own, id) = (study.case_title(case), case.label.id);
    let scene = scene_of_case(study, place).map(|svg| own_ids(&svg, &format!("scene-{id}"))).unwrap_or_default();
    let mechanism = mechanism_of_case(study, place).map(|svg| own_ids(&svg, &format!("mechanism-{id}")));
    let moves = case.proof.motion.is_some() || !case.path.states.is_empty();
    let turns = study.scenes.get(place).is_some_and(|scene| scene.space.is_some());
    html! {
        div class="case" {
            @if turns {
                figure class="space" data-case=(id) hidden {
                    figcaption { "The blocks. Drag them, or use the arrow keys, to turn them." }
                }
            }
            figure class="scene" data-case=[moves.then_some(id)] {
                (PreEscaped(scene))
                figcaption { "The scene with its loads, forces and joints that move." }
            }
            @if let Some(svg) = mechanism {
                figure class="still" {
                    (PreEscaped(svg))
                    figcaption { "The blocks as they move; displacements are exaggerated." }
                }
            }
            @if let Some(svg) = curve_svg(&own, assembly, stages, case) { (figure(&svg, CURVE)) }
        }
    }
}

/// The pictures of the other cases, collapsed; `worst` is the case that is already shown.
pub(super) fn others(study: &StudyOutput, worst: Option<usize>, drawn: usize) -> Markup {
    let cases = &study.results.cases;
    let chosen: Vec<usize> =
        (0..cases.len()).filter(|place| Some(*place) != worst && study.drawn(cases[*place].label.id)).collect();
    let few = match chosen.len() {
        count if count > drawn => Some(format!("{count} cases: the first {drawn} are drawn here.")),
        count if count + 1 < cases.len() => Some(format!("{count} of {} cases are drawn here.", cases.len())),
        _ => None,
    };
    let title = |place: usize| {
        let stages = study.scene(place).map_or(&[][..], |(_, stages)| stages);
        format!("{}: {}", study.case_title(&cases[place]), headline(&cases[place], stages))
    };
    html! {
        h2 { "Figures" }
        p { (MEANING) }
        @if !chosen.is_empty() && let Some(few) = few { p { (few) } }
        @for &place in chosen.iter().take(drawn) {
            details { summary { (title(place)) } (of_case(study, place)) }
        }
    }
}
