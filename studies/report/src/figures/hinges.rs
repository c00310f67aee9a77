//! Hinges as an engineer draws them: neighbouring joints that open on one side in one sense are one hinge; on paths
//! the order in which they formed.

use crate::postprocess::joint_events::{JointState, joint_events};
use voussoir_core::certificate::{ContactMode, Hinge, Mechanism};
use voussoir_core::model::Assembly;
use voussoir_study::results::CaseResult;

/// One hinge of one or several neighbouring joints.
#[derive(Debug, Clone, PartialEq)]
pub struct DrawnHinge<'a> {
    /// Its joints, in order.
    pub joints: Vec<&'a Hinge>,
}

impl<'a> DrawnHinge<'a> {
    /// The joint that turns most: where the hinge is drawn.
    pub fn main(&self) -> &'a Hinge {
        let turn = |hinge: &&&Hinge| hinge.rotation.abs();
        self.joints.iter().max_by(|a, b| turn(a).total_cmp(&turn(b))).expect("a hinge has a joint")
    }

    /// Rotation of all its joints.
    pub fn rotation(&self) -> f64 {
        self.joints.iter().map(|hinge| hinge.rotation).sum()
    }

    /// The numbers of its joints: `8+9+10`.
    pub fn label(&self) -> String {
        self.joints.iter().map(|hinge| hinge.joint.to_string()).collect::<Vec<_>>().join("+")
    }
}

/// Hinges from a list of all joints that turn, in order.
pub fn drawn_hinges(hinges: &[Hinge]) -> Vec<DrawnHinge<'_>> {
    let mut drawn: Vec<DrawnHinge> = Vec::new();
    for hinge in hinges {
        let last = drawn.last_mut().filter(|drawn| {
            let last = drawn.joints.last().expect("a hinge has a joint");
            let alike = last.side.is_some() && last.side == hinge.side && last.rotation * hinge.rotation > 0.0;
            alike && hinge.joint == last.joint + 1
        });
        match last {
            Some(drawn) => drawn.joints.push(hinge),
            None => drawn.push(DrawnHinge { joints: vec![hinge] }),
        }
    }
    drawn
}

/// Joints of hinges: neighbours that count as one hinge are joined, `4 8+9+10 14`. In space: the contacts with hinges.
pub fn hinge_list(mechanism: &Mechanism) -> Vec<String> {
    let in_space = mechanism.contacts_with(&[ContactMode::Hinge]).map(|contact| contact.to_string());
    drawn_hinges(&mechanism.hinges).iter().map(DrawnHinge::label).chain(in_space).collect()
}

/// A hinge whose rotation is less than this share of the greatest is deformation to an engineer.
const LITTLE: f64 = 0.2;

/// The hinges among them that an engineer would name.
pub fn named_hinges(hinges: &[Hinge]) -> Vec<DrawnHinge<'_>> {
    let mut drawn = drawn_hinges(hinges);
    let greatest = drawn.iter().map(|hinge| hinge.rotation().abs()).fold(0.0, f64::max);
    drawn.retain(|hinge| hinge.rotation().abs() >= LITTLE * greatest);
    drawn
}

/// Labels of hinges: their joints, and on a path as the how-manieth they formed: `7+8, 2nd`.
pub fn labels(assembly: &Assembly, result: &CaseResult, drawn: &[DrawnHinge]) -> Vec<String> {
    let formed: Vec<usize> = if result.path.events.is_empty() {
        Vec::new()
    } else {
        let events = joint_events(assembly, result).into_iter();
        events.filter(|event| matches!(event.became, Some(JointState::Hinge(_)))).map(|event| event.joint).collect()
    };
    // A joint that closes and opens again formed when it last opened.
    let when = |hinge: &DrawnHinge| formed.iter().rposition(|joint| hinge.joints.iter().any(|own| own.joint == *joint));
    let times: Vec<Option<usize>> = drawn.iter().map(when).collect();
    let known = times.iter().all(Option::is_some) && drawn.len() > 1;
    let rank = |time: &Option<usize>| 1 + times.iter().filter(|other| *other < time).count();
    let word = |hinge: &DrawnHinge, time: &Option<usize>| {
        if known { format!("{}, {}", hinge.label(), ordinal(rank(time))) } else { hinge.label() }
    };
    drawn.iter().zip(&times).map(|(hinge, time)| word(hinge, time)).collect()
}

fn ordinal(rank: usize) -> String {
    let end = match (rank % 10, rank % 100) {
        (1, tens) if tens != 11 => "st",
        (2, tens) if tens != 12 => "nd",
        (3, tens) if tens != 13 => "rd",
        _ => "th",
    };
    format!("{rank}{end}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use voussoir_core::certificate::Side;

    #[test]
    fn neighbours_that_open_alike_are_one_hinge() {
        let hinge = |joint: usize, side: Side, rotation: f64| Hinge {
            joint,
            between: Default::default(),
            side: Some(side),
            point: [0.0; 2],
            rotation,
        };
        let all = [
            hinge(1, Side::Intrados, -8.5),
            hinge(2, Side::Intrados, -1.1),
            hinge(7, Side::Extrados, 1.4),
            hinge(8, Side::Extrados, 16.3),
            hinge(11, Side::Extrados, 0.3),
            hinge(13, Side::Intrados, -8.0),
        ];
        let labels: Vec<String> = drawn_hinges(&all).iter().map(DrawnHinge::label).collect();
        assert_eq!(labels, ["1+2", "7+8", "11", "13"]);
        assert_eq!(drawn_hinges(&all)[1].main().joint, 8);
        assert_eq!(named_hinges(&all).len(), 3);
        assert_eq!([1, 2, 3, 4, 11, 22].map(ordinal), ["1st", "2nd", "3rd", "4th", "11th", "22nd"]);
    }
}
