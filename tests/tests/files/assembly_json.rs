//! Assemblies with their proofs: the file alone proves its numbers, and the scene `assembly` reads it.

use super::units::Written;
use serde_json::Value;
use voussoir::core::space::Vec3;

const REST: &str = "material = \"stone\"\njoint = \"dry\"\n[materials.stone]\nlaw = \"rigid\"\ndensity = 2000.0\n[joints.dry]\nlaw = \"coulomb_associated\"\n\
     friction = 0.6\n[[stages]]\nname = \"weight\"\ngravity = 1.0\n[[stages]]\nname = \"push\"\nuntil = \"collapse\"\n\
     loads = [{ kind = \"body\", acceleration = [1.0, 0.0, 0.0] }]\n";

fn three(value: &Value) -> Vec3 {
    let at = |k: usize| value[k].as_f64().expect("a number");
    Vec3::new(at(0), at(1), at(2))
}

/// Adds a force at a point to force and moment about a centroid.
fn act(sum: &mut [Vec3; 2], force: Vec3, arm: Vec3) {
    sum[0] += force;
    sum[1] += arm.cross(&force);
}

/// Forces of the file are inside their cones and balance the loads of each block at the load factor. The varying loads have unit
/// power on the velocities, and each contact opens by at least μ times its slip. The scene read from the file has the same factor.
#[test]
fn an_assembly_proves_its_load_factor() {
    let scene = "name = \"corner\"\n[scene]\nscene = \"masonry_wall\"\nblock = [2.0, 1.0, 0.5]\ncourses = 3\nblocks = 2\ncorner = { blocks = 2 }\n";
    let written = Written::of(&format!(
        "{scene}{REST}[output]\nfigures = false\nwriters = [\"results_csv\", \"assembly_json\"]\n"
    ));
    let text = written.text("assemblies/case-0000.json");
    let file: Value = serde_json::from_str(&text).expect("JSON");
    let data = &file["data"];
    let factor = data["attributes"]["load_factor"].as_f64().expect("a factor");
    let (nodes, edges) = (&data["graph"]["data"]["node"], &data["graph"]["data"]["edge"]);
    let held = |name: &str| nodes[name]["is_support"] == Value::Bool(true);
    let names: Vec<&String> = nodes.as_object().expect("nodes").keys().collect();
    let mut sums = std::collections::BTreeMap::new();
    let (mut weight, mut power) = (0.0f64, 0.0);
    for name in &names {
        let node = &nodes[name.as_str()];
        let load = |key: &str, from: usize| Vec3::from_fn(|k, _| node[key][from + k].as_f64().expect("a number"));
        let sum = [0, 3].map(|from| load("fixed_load", from) + load("varying_load", from) * factor);
        weight += sum[0].norm();
        if !held(name) {
            power += [0, 3].map(|from| load("varying_load", from).dot(&load("velocity", from))).iter().sum::<f64>();
        }
        sums.insert(name.as_str(), sum);
    }
    assert!((power - 1.0).abs() < 1e-9, "{power}");
    let velocity = |name: &str, point: &Vec3| {
        let node = &nodes[name];
        let of = |from: usize| Vec3::from_fn(|k, _| node["velocity"][from + k].as_f64().expect("a number"));
        if held(name) { Vec3::zeros() } else { of(0) + of(3).cross(&(point - three(&node["centroid"]))) }
    };
    let mut count = 0;
    for (minus, others) in edges.as_object().expect("edges") {
        for (plus, edge) in others.as_object().expect("edges") {
            for interface in edge["interfaces"].as_array().expect("interfaces") {
                let interface = &interface["data"];
                let frame = &interface["frame"]["data"];
                let [s, t] = ["xaxis", "yaxis"].map(|axis| three(&frame[axis]));
                let n = s.cross(&t);
                let points = interface["points"].as_array().expect("points");
                for (point, force) in points.iter().zip(interface["forces"].as_array().expect("forces")) {
                    count += 1;
                    let point = three(point);
                    let of = |key: &str| force[key].as_f64().expect("a number");
                    let normal = of("c_np") - of("c_nn");
                    assert!(of("c_u").hypot(of("c_v")) <= 0.6 * normal + 1e-12 * weight);
                    let on_plus = n * normal + s * of("c_u") + t * of("c_v");
                    for (name, force) in [(plus, on_plus), (minus, -on_plus)] {
                        let arm = point - three(&nodes[name.as_str()]["centroid"]);
                        act(sums.get_mut(name.as_str()).expect("a node"), force, arm);
                    }
                    let jump = velocity(plus, &point) - velocity(minus, &point);
                    let slip = jump.dot(&s).hypot(jump.dot(&t));
                    assert!(jump.dot(&n) >= 0.6 * slip - 1e-12 * (1.0 + slip) / weight.min(1.0), "{jump:?}");
                }
            }
        }
    }
    assert!(count > 100, "{count}");
    for (name, [force, moment]) in sums.into_iter().filter(|(name, _)| !held(name)) {
        assert!(force.norm() + moment.norm() <= 1e-11 * weight, "{name}: {force:?} {moment:?}");
    }
    let study = format!("name = \"read\"\n[scene]\nscene = \"assembly\"\nfile = \"corner.json\"\n{REST}");
    let read: Value =
        serde_json::from_str(&Written::of_files(&study, &|_| Ok(text.clone())).text("results.json")).expect("JSON");
    let again = read["cases"][0]["load_factor"].as_f64().expect("a factor");
    assert!((again - factor).abs() <= 2e-8 * factor, "{again} {factor}");
}
