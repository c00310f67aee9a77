//! Random bridges as blocks carry the same load mirrored, rotated with their gravity, far from the origin and in
//! another size. Fill forces and joints that have lost mortar, which the scene `blocks` does not have, are left out.

use super::bridge::Bridge;
use toml::Value;
use voussoir::core::limit::Status;
use voussoir::study::as_blocks;
use voussoir_tests::{answered, keep};

/// Relative difference of equal loads: twice the allowed difference of the bounds, plus a margin.
const SAME: f64 = 4e-9;

/// p ↦ size · R p + shift, where R is a rotation, after x ↦ −x if `mirrored`.
#[derive(Clone, Copy)]
struct Twin {
    mirrored: bool,
    angle: f64,
    size: f64,
    shift: [f64; 2],
}

impl Twin {
    fn turned(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let (sin, cos) = self.angle.sin_cos();
        let x = if self.mirrored { -x } else { x };
        [cos * x - sin * y, sin * x + cos * y]
    }

    fn place(&self, point: [f64; 2]) -> [f64; 2] {
        let turned = self.turned(point);
        [0, 1].map(|d| self.size * turned[d] + self.shift[d])
    }

    /// Transforms the value of a key: weights grow with the cube of the size, so strengths grow with the size.
    fn entry(&self, key: &str, value: &mut Value) {
        let force = self.size.powi(3);
        match (key, &mut *value) {
            ("vertices", Value::Array(points)) => points.iter_mut().for_each(|point| change(point, |p| self.place(p))),
            ("point", Value::Array(_)) => change(value, |p| self.place(p)),
            ("force", Value::Array(_)) => change(value, |f| self.turned(f).map(|x| x * force)),
            ("gravity" | "acceleration", Value::Array(_)) => change(value, |a| self.turned(a)),
            ("gravity", number) => {
                let [x, y] = self.turned([0.0, -float(number)]);
                *number = Value::Array(vec![x.into(), y.into()]);
            }
            ("width" | "cohesion" | "tensile_strength" | "compressive_strength", number) => {
                *number = (self.size * float(number)).into();
            }
            (_, Value::Array(list)) => list.iter_mut().for_each(|inner| self.entry("", inner)),
            (_, Value::Table(table)) => table.iter_mut().for_each(|(key, inner)| self.entry(key, inner)),
            _ => {}
        }
    }
}

fn float(value: &Value) -> f64 {
    value.as_float().or(value.as_integer().map(|n| n as f64)).expect("a number")
}

fn change(pair: &mut Value, of: impl Fn([f64; 2]) -> [f64; 2]) {
    let list = pair.as_array_mut().expect("a pair");
    let [x, y] = of([float(&list[0]), float(&list[1])]);
    *list = vec![x.into(), y.into()];
}

/// 4 bridges as blocks, one of which needs its fill, carry the same load mirrored, rotated, shifted and in another
/// size. `VOUSSOIR_BRIDGES` sets the number, `VOUSSOIR_FIRST` the first seed; `KEEP=FOLDER` writes the bridges that
/// stall.
#[test]
fn bridges_as_blocks_carry_the_same_mirrored_turned_away_and_in_another_size() {
    let number = |name: &str| std::env::var(name).ok().and_then(|text| text.parse::<u64>().ok());
    let (first, count) = (number("VOUSSOIR_FIRST").unwrap_or(5115), number("VOUSSOIR_BRIDGES").unwrap_or(4));
    let (compared, stalled) = compare(first, count);
    println!("{compared} compared, {stalled} stalled");
    assert!(compared as u64 >= 2 * count && stalled * 100 <= compared);
}

/// Rings with crushing, for which the conic program needs tangents, are solved as blocks.
#[test]
fn bridges_that_once_stalled_as_blocks_are_answered() {
    assert_eq!(compare(5188, 1), (4, 0));
}

/// Compares the twins of some bridges from a seed on. Returns the numbers of compared and of stalled bridges.
fn compare(first: u64, count: u64) -> (usize, usize) {
    let plain = Twin { mirrored: false, angle: 0.0, size: 1.0, shift: [0.0, 0.0] };
    let twins = [
        Twin { mirrored: true, ..plain },
        Twin { angle: 0.7, shift: [30.0, -8.0], ..plain },
        Twin { mirrored: true, angle: -2.0, size: 1.0 / 0.3048, ..plain },
        Twin { size: 1e-2, ..plain },
    ];
    let (mut compared, mut stalled) = (0, 0);
    for seed in first..first + count {
        let text: String = Bridge::random(seed)
            .study()
            .lines()
            .filter(|line| !line.contains("lost_mortar"))
            .map(|l| format!("{l}\n"))
            .collect();
        let Ok(study) = voussoir::study::load(&text, "bridge.toml", &[]) else { continue };
        let Ok(blocks) = as_blocks(&study.cases[0], "bridge") else { continue };
        let own = answered(&blocks);
        if own.status != Status::Stalled && study.cases[0].assembly.fill_reactions().is_empty() {
            let bridge = answered(&text);
            let [a, b] = [bridge.load_factor, own.load_factor].map(|factor| factor.unwrap_or(0.0));
            // As blocks all weights are loads of one stage: less than the full weights may be carried although the full
            // weights are not.
            let first = own.stages.len() == 1 && own.status == Status::Collapse && b < 1.0;
            let none = bridge.status == Status::NoEquilibrium && first;
            let same = none || (bridge.status == own.status && (a - b).abs() <= SAME * a.abs());
            assert!(same, "{seed}: {a} {b} {:?} {:?}\n{text}", bridge.status, own.status);
        }
        for (index, twin) in twins.iter().enumerate() {
            let mut study: Value = toml::from_str(&blocks).expect("TOML");
            twin.entry("", &mut study);
            let other = answered(&toml::to_string(&study).expect("TOML"));
            if other.status == Status::Stalled || own.status == Status::Stalled {
                println!("{seed}, {index}: {:?} {:?}", own.notes, other.notes);
                keep(&format!("{seed}.toml"), &blocks);
                stalled += 1;
                continue;
            }
            let [a, b] = [&own, &other].map(|result| result.load_factor.unwrap_or(0.0));
            assert!(
                own.status == other.status && (a - b).abs() <= SAME * a.abs(),
                "{seed}, {index}: {a} {b}\n{blocks}"
            );
            compared += 1;
        }
    }
    (compared, stalled)
}
