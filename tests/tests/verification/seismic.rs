//! The kinematic analysis against closed forms: stacks of blocks that turn about a corner, and the conversion by hand.

use serde_json::{Value, json};
use std::f64::consts::PI;
use voussoir_tests::{assert_close, changed};

const GRAVITY: f64 = 9.81;

/// Returns a study of blocks of (width, height) on each other, which are flush at the right side, x = 0. `stiffness` in Pa/m.
fn stack(blocks: &[[f64; 2]], stiffness: f64) -> String {
    let mut level = 0.0;
    let mut list = String::new();
    for (index, [width, height]) in blocks.iter().enumerate() {
        let top = level + height;
        list += &format!(
            "[[scene.blocks]]\nname = \"{index}\"\nvertices = [[{:?}, {level:?}], [0.0, {level:?}], [0.0, {top:?}], [{:?}, {top:?}]]\n",
            -width, -width
        );
        level = top;
    }
    format!(
        "name = \"stack\"\nkind = \"seismic\"\n[seismic]\nground_acceleration = 2.0\nperiods = [0.15, 0.5, 2.0]\n\
         confidence_factor = 1.2\n[scene]\nscene = \"blocks\"\nwidth = 1.0\nmaterial = \"stone\"\njoint = \"dry\"\n\
         [materials.stone]\nlaw = \"rigid\"\ndensity = 2000.0\n[joints.dry]\nlaw = \"coulomb\"\nfriction = 0.7\n\
         normal_stiffness = {stiffness:?}\nshear_stiffness = {:?}\n[[stages]]\nname = \"dead\"\ngravity = 9.81\n\
         [[stages]]\nname = \"push\"\nuntil = \"collapse\"\nloads = [{{ kind = \"body\", acceleration = [9.81, 0.0] }}]\n\
         [[scene.blocks]]\nname = \"ground\"\nfixed = true\nvertices = [[-9.0, -1.0], [9.0, -1.0], [9.0, 0.0], [-9.0, 0.0]]\n{list}",
        stiffness / 2.0
    )
}

fn seismic(text: &str) -> (Vec<Value>, Value) {
    let (study, results) = voussoir_tests::written::results(text);
    let found = voussoir_tests::written::findings(&study, &results);
    assert!(found.is_empty(), "{found:?}");
    (results["seismic"].as_array().expect("entries").clone(), results)
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

/// Returns the greatest difference of α on the falling branch from tan(β − θ), for a part of `width` and `height` that turns by θ
/// about its lower corner. Its centroid moves by R (sin β − sin(β − θ)).
fn error(entry: &Value, part: [f64; 2]) -> f64 {
    error_of(entry, part, 1.2, 1.0)
}

/// As [`error`], with α = a* `divisor`/g, if the centroid moves by d* `share`.
fn error_of(entry: &Value, [width, height]: [f64; 2], divisor: f64, share: f64) -> f64 {
    let (radius, sine) = (width.hypot(height) / 2.0, width / width.hypot(height));
    let curve: Vec<[f64; 2]> = serde_json::from_value(entry["curve"].clone()).expect("a curve");
    let peak = (0..curve.len()).max_by(|a, b| curve[*a][1].total_cmp(&curve[*b][1])).expect("a peak");
    assert!(curve.len() > peak + 20, "{} points", curve.len());
    let off = |&[d, a]: &[f64; 2]| (a * divisor / GRAVITY - (sine - d * share / radius).asin().tan()).abs();
    curve[peak + 1..].iter().map(off).fold(0.0, f64::max)
}

/// A block and three blocks of the same outline turn as one part: α₀ = b/h, e* = 1, d₀* = b/2, and α = tan(β − θ). The
/// difference is caused by the compliance of the joints alone: it is ten times less if they are ten times as stiff.
#[test]
fn stacks_follow_the_closed_form_of_their_capacity_curve() {
    for blocks in [vec![[0.5, 3.0]], vec![[0.5, 1.0]; 3]] {
        let of = |stiffness: f64| seismic(&stack(&blocks, stiffness)).0;
        let (soft, stiff) = (of(1e13), of(1e14));
        assert_eq!(stiff.iter().map(|entry| &entry["direction"]).collect::<Vec<_>>(), ["right", "left"]);
        for (soft, stiff) in soft.iter().zip(&stiff) {
            assert_close(number(&stiff["activation_multiplier"]), 0.5 / 3.0, 1e-12);
            assert_close(number(&stiff["oscillator"]["mass"]), 3000.0, 1e-9);
            assert_close(number(&stiff["oscillator"]["mass_fraction"]), 1.0, 1e-12);
            let [soft, fine] = [soft, stiff].map(|entry| error(entry, [0.5, 3.0]));
            assert!(fine < 1e-8 && (8.0..12.0).contains(&(soft / fine)), "{soft} {fine}");
            assert_eq!(stiff["capacity"]["reaches_zero"], true);
            assert_close(number(&stiff["capacity"]["zero_displacement"]), 0.25, 1e-8);
        }
    }
}

/// Two narrow blocks turn on a block at rest. The block at rest does not change e* and d*, so the curve is the closed form for
/// the two narrow blocks.
#[test]
fn a_block_at_rest_does_not_change_the_curve_of_the_others() {
    let of = |stiffness: f64| seismic(&stack(&[[3.0, 1.0], [0.5, 1.0], [0.5, 1.0]], stiffness)).0;
    for (soft, stiff) in of(1e11).iter().zip(&of(1e12)) {
        assert_close(number(&stiff["activation_multiplier"]), 0.25, 1e-12);
        assert_close(number(&stiff["oscillator"]["mass"]), 2000.0, 1e-9);
        assert_close(number(&stiff["oscillator"]["mass_fraction"]), 1.0, 1e-12);
        let [soft, fine] = [soft, stiff].map(|entry| error(entry, [0.5, 2.0]));
        assert!(fine < 1e-6 && (8.0..12.0).contains(&(soft / fine)), "{soft} {fine}");
    }
}

/// Two piers of 0.6 m × 2.4 m turn by θ, and the lintel of 3.2 m × 0.5 m moves twice as far as their centroids without turning.
/// By virtual work α = tan(β − θ) with tan β = 0.6/2.4. With masses in proportion to the areas
/// e* = (2 · 1.44 · 1 + 1.6 · 2)²/((2 · 1.44 · 1 + 1.6 · 4) · 4.48).
#[test]
fn the_portal_follows_the_closed_form_of_its_capacity_curve() {
    let text = include_str!("../../../studies/cases/seismic_portal.toml");
    let (mass, first, second) = (4.48, 2.88 + 3.2, 2.88 + 6.4);
    let effective = first * first / second;
    let of = |normal: &str, shear: &str| {
        seismic(&changed(&changed(text, "1e10 Pa/m", normal), "4e9 Pa/m", shear)).0.into_iter().map(|entry| {
            assert_close(number(&entry["activation_multiplier"]), 0.25, 1e-12);
            assert_close(number(&entry["oscillator"]["mass_fraction"]), effective / mass, 1e-12);
            // d* of the centroid of a pier is d* Σ m δ/Σ m δ² for δ = 1.
            error_of(&entry, [0.6, 2.4], effective / mass * 1.35, first / second)
        })
    };
    for (soft, fine) in of("1e11 Pa/m", "4e10 Pa/m").zip(of("1e12 Pa/m", "4e11 Pa/m")) {
        assert!(fine < 1e-5 && (8.0..12.0).contains(&(soft / fine)), "{soft} {fine}");
    }
}

/// The values of three blocks by hand: a₀* = α₀ g/FC, d_u* = 0.4 b/2, d_s* = 0.4 d_u*, a_s* = g tan(β − θ_s)/FC,
/// T_s = 2π √(d_s*/a_s*), and the demand a_g F₀ T_C T_s/4π² for T_C < T_s < T_D.
#[test]
fn the_values_of_three_blocks_by_hand() {
    let (entries, _) = seismic(&stack(&[[0.5, 1.0]; 3], 1e13));
    let entry = &entries[0];
    assert_close(number(&entry["oscillator"]["activation_acceleration"]), GRAVITY / 6.0 / 1.2, 1e-12);
    let radius = 0.5f64.hypot(3.0) / 2.0;
    let ultimate = 0.4 * 0.25;
    let secant = 0.4 * ultimate;
    let acceleration = GRAVITY / 1.2 * ((0.25 - secant) / radius).asin().tan();
    let period = 2.0 * PI * (secant / acceleration).sqrt();
    assert!((0.5..2.0).contains(&period));
    let own = &entry["capacity"];
    assert_close(number(&own["ultimate_displacement"]), ultimate, 1e-7);
    assert_close(number(&own["secant_displacement"]), secant, 1e-7);
    // The curve is linear between its points.
    assert_close(number(&own["secant_acceleration"]), acceleration, 1e-5);
    assert_close(number(&own["secant_period"]), period, 1e-5);
    let demand = 2.0 * 2.5 * 0.5 / (4.0 * PI * PI) * period;
    let [force, displacement] = entry["checks"].as_array().expect("checks").as_slice() else { panic!("{entry}") };
    assert_close(number(&force["ratio"]), GRAVITY / 6.0 / 1.2 / (2.0 / 2.0), 1e-12);
    assert_eq!((&force["met"], &force["unit"]), (&json!(true), &json!("m/s2")));
    assert_close(number(&displacement["demand"]), demand, 1e-5);
    assert_eq!(displacement["met"], ultimate >= demand);
    let near = changed(&stack(&[[0.5, 1.0]; 3], 1e13), "periods", "limit_state = \"near_collapse\"\nperiods");
    assert_close(number(&seismic(&near).0[0]["capacity"]["ultimate_displacement"]), 0.6 * 0.25, 1e-7);
}

/// Rigid blocks without compliance have no path: there is no capacity curve, and the check of accelerations decides.
#[test]
fn rigid_blocks_have_no_capacity_curve() {
    let text = stack(&[[0.5, 1.0]; 3], 1e13);
    let rigid: String =
        text.lines().filter(|line| !line.contains("_stiffness")).map(|line| format!("{line}\n")).collect();
    let (entries, results) = seismic(&rigid);
    assert_eq!(results["cases"].as_array().map(Vec::len), Some(2));
    for entry in &entries {
        assert_eq!(
            (&entry["capacity"], &entry["path_case"], &entry["curve"]),
            (&Value::Null, &Value::Null, &json!([]))
        );
        assert_eq!(entry["checks"].as_array().map(Vec::len), Some(1));
    }
}

/// `verify` finds every altered number of the analysis.
#[test]
fn altered_numbers_are_found() {
    let (study, results) = voussoir_tests::written::results(&stack(&[[0.5, 1.0]; 3], 1e12));
    for place in [
        "activation_multiplier",
        "oscillator/mass",
        "oscillator/mass_fraction",
        "oscillator/activation_acceleration",
        "capacity/zero_displacement",
        "capacity/ultimate_displacement",
        "capacity/secant_displacement",
        "capacity/secant_acceleration",
        "capacity/secant_period",
        "checks/0/demand",
        "checks/1/ratio",
        "curve/9/1",
    ] {
        let mut forged = results.clone();
        let value = forged.pointer_mut(&format!("/seismic/1/{place}")).unwrap_or_else(|| panic!("no {place}"));
        *value = json!(number(value) * 1.01);
        assert!(!voussoir_tests::written::findings(&study, &forged).is_empty(), "{place}");
    }
    let mut forged = results.clone();
    forged["seismic"][0]["checks"][0]["met"] =
        json!(!results["seismic"][0]["checks"][0]["met"].as_bool().expect("a word"));
    assert!(!voussoir_tests::written::findings(&study, &forged).is_empty());
}
