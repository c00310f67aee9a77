//! Continuation strategies: the derivatives of a constraint agree with differences of its value.

use super::findings::Recorder;
use super::options::Options;
use super::samples::table;
use voussoir_core::path::{Continuation, Increment, MOST_MONITORS};
use voussoir_core::plugin::{Card, PluginKind, Sample};
use voussoir_core::random::Random;

/// Number of increments of each sample.
const INCREMENTS: usize = 200;
/// Step of differences; increments are of size one.
const STEP: f64 = 1e-5;
/// Greatest relative error of a derivative.
const SAME: f64 = 1e-6;
/// Number of entries of an increment.
const ENTRIES: usize = 4 + MOST_MONITORS;

/// Checks every sample of a strategy, or the strategy with its defaults; does nothing for other plug-ins.
pub(super) fn check(recorder: &mut Recorder, card: &Card, _: &Options) {
    if card.kind != PluginKind::Continuation {
        return;
    }
    let defaults = [Sample::keys("")];
    for sample in if card.samples.is_empty() { &defaults[..] } else { card.samples } {
        recorder.sample(sample);
        let Some(table) = table(card, sample.table) else {
            recorder.fail("samples", "the sample is no TOML".into());
            continue;
        };
        match serde_json::from_value::<Box<dyn Continuation>>(table) {
            Ok(strategy) => check_sample(recorder, strategy.as_ref()),
            Err(_) if card.samples.is_empty() => {
                recorder.leave_out("derivatives: the strategy needs keys, and its card has no sample");
            }
            Err(why) => recorder.fail("samples", format!("the sample cannot be read: {why}")),
        }
    }
}

fn check_sample(recorder: &mut Recorder, strategy: &dyn Continuation) {
    let first = strategy.first_step();
    recorder.hold("finite", first.is_finite() && first > 0.0, || format!("its first step is {first}"));
    let largest = strategy.largest_step();
    recorder.hold("finite", largest > 0.0, || format!("its largest step is {largest}"));
    let monitors = strategy.monitors().len();
    recorder.hold("monitors", monitors <= MOST_MONITORS, || {
        format!("it has {monitors} monitors, not {MOST_MONITORS} at most")
    });
    let mut random = Random::new(31);
    for round in 0..INCREMENTS {
        let [at, before] = [(); 2].map(|()| [(); ENTRIES].map(|()| random.between(-1.0, 1.0)));
        // The root mean square of motions is not negative.
        let [at, before] = [at, before].map(|mut own: [f64; ENTRIES]| {
            own[2] = own[2].abs() + 0.1;
            own
        });
        let previous = (round % 2 == 1).then(|| increment(&before));
        let value = |entries: &[f64; ENTRIES]| strategy.constraint(&increment(entries), previous.as_ref()).value;
        let said = strategy.constraint(&increment(&at), previous.as_ref());
        recorder.hold("purity", value(&at).to_bits() == said.value.to_bits(), || {
            "two equal calls give different values".into()
        });
        let own = entries(&said.derivative);
        recorder.hold("finite", own.iter().chain([&said.value]).all(|x| x.is_finite()), || {
            format!("the constraint at {:?} is {said:?}", increment(&at))
        });
        for (index, own) in own.iter().enumerate() {
            let moved = |step: f64| {
                let mut entries = at;
                entries[index] += step;
                value(&entries)
            };
            let [ahead, behind] = [(moved(STEP) - said.value) / STEP, (said.value - moved(-STEP)) / STEP];
            let size = own.abs().max(ahead.abs()).max(1.0);
            // At a kink the difference has no limit.
            if (ahead - behind).abs() > 100.0 * STEP * size {
                continue;
            }
            let central = (ahead + behind) / 2.0;
            recorder.hold("derivatives", (own - central).abs() <= SAME * size, || {
                format!("the derivative by {} at {:?} is {own}, not {central}", NAMES[index.min(4)], increment(&at))
            });
        }
    }
}

const NAMES: [&str; 5] = ["factor", "displacement", "motion", "dissipation", "a monitor"];

fn increment(entries: &[f64; ENTRIES]) -> Increment {
    let [factor, displacement, motion, dissipation, monitored @ ..] = *entries;
    Increment { factor, displacement, motion, dissipation, monitored }
}

fn entries(increment: &Increment) -> [f64; ENTRIES] {
    let Increment { factor, displacement, motion, dissipation, monitored } = *increment;
    let mut entries = [factor, displacement, motion, dissipation, 0.0, 0.0, 0.0, 0.0];
    entries[4..].copy_from_slice(&monitored);
    entries
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde::{Deserialize, Serialize};
    use voussoir_core::path::{Constraint, Monitor};
    use voussoir_core::plugin::cards_of;
    use voussoir_solvers as _;

    /// A spherical strategy with a fault.
    #[derive(Debug, Serialize, Deserialize)]
    struct Faulty {
        fault: String,
    }

    #[typetag::serde(name = "faulty_strategy")]
    impl Continuation for Faulty {
        fn monitors(&self) -> Vec<Monitor> {
            let count = if self.fault == "monitors" { MOST_MONITORS + 1 } else { 0 };
            vec![Monitor::Opening { joint: 0, at: None }; count]
        }

        fn constraint(&self, increment: &Increment, _: Option<&Increment>) -> Constraint {
            let value = increment.motion.hypot(increment.factor);
            let mut derivative = Increment {
                motion: increment.motion / value,
                factor: increment.factor / value,
                ..Increment::default()
            };
            match self.fault.as_str() {
                "sign" => derivative.factor *= -1.0,
                "missing" => derivative.motion = 0.0,
                "factor" => derivative.motion *= 1.001,
                "not finite" => derivative.dissipation = f64::NAN,
                _ => {}
            }
            Constraint { value, derivative }
        }

        fn passes_limit_points(&self) -> bool {
            true
        }

        fn first_step(&self) -> f64 {
            if self.fault == "step" { 0.0 } else { 0.1 }
        }
    }

    fn failed(card: &Card) -> Vec<&'static str> {
        let mut recorder = Recorder::new(card);
        check(&mut recorder, card, &Options::default());
        let report = recorder.report();
        assert!(report.done["derivatives"] > 1000, "{report}");
        report.findings.iter().map(|finding| finding.check).collect()
    }

    #[test]
    fn faults_of_strategies_are_found() {
        let of = |fault: &str| {
            let samples: &'static [Sample] = vec![Sample::keys(format!("fault = \"{fault}\"").leak())].leak();
            failed(&Card { kind: PluginKind::Continuation, tag: "faulty_strategy", samples, ..Card::BLANK })
        };
        assert_eq!(of("none"), Vec::<&str>::new());
        for fault in ["sign", "missing", "factor"] {
            assert_eq!(of(fault), ["derivatives"], "{fault}");
        }
        assert_eq!((of("step"), of("monitors")), (vec!["finite"], vec!["monitors"]));
        assert!(of("not finite").contains(&"finite"));
    }

    #[test]
    fn the_strategies_of_the_project_conform() {
        let strategies = cards_of(PluginKind::Continuation);
        assert!(strategies.len() >= 5);
        strategies.into_iter().for_each(|card| assert_eq!(failed(card), Vec::<&str>::new(), "{}", card.tag));
    }
}
