//! Input that can be computed but is probably a mistake: the case gets a note.

use voussoir::study::load;
use voussoir_tests::study;

/// Returns the notes of the first case, with some text of an arch changed.
fn notes(changes: &[(&str, &str)]) -> Vec<String> {
    let text = "name = \"arch\"\n[scene]\nscene = \"arch\"\nprofile = { shape = \"segmental\", span = 4.0, rise = 1.0 }\n\
                thickness = 0.4\nwidth = 1.0\nvoussoirs = 7\nends = \"jointed\"\nmaterial = \"stone\"\njoint = \"dry\"\n\
                [materials.stone]\nlaw = \"rigid\"\ndensity = 2200.0\n[joints.dry]\nlaw = \"coulomb_associated\"\n\
                friction = 0.6\n[[stages]]\nname = \"dead\"\ngravity = 9.81\n";
    let text = changes.iter().fold(text.to_string(), |text, (from, to)| {
        assert!(text.contains(from), "{from}");
        text.replace(from, to)
    });
    study(&text).cases[0].notes.clone()
}

#[test]
fn implausible_values_are_noted() {
    assert_eq!(notes(&[]), Vec::<String>::new());
    let heavy = notes(&[("density = 2200.0", "density = 22.0")]);
    assert!(heavy.len() == 1 && heavy[0].contains("\"22 kN/m3\""), "{heavy:?}");
    assert_eq!(notes(&[("density = 2200.0", "density = \"22 kN/m3\"")]), Vec::<String>::new());
    assert_eq!(notes(&[("density = 2200.0", "density = 0.0")]), Vec::<String>::new());
    let rough = notes(&[("friction = 0.6", "friction = 2.0")]);
    assert!(rough.len() == 1 && rough[0].contains("63°"), "{rough:?}");
    let thick = notes(&[("thickness = 0.4", "thickness = 4.5"), ("rise = 1.0", "rise = 2.0")]);
    assert!(thick.len() == 1 && thick[0].contains("more than the span"), "{thick:?}");
}

/// Loads that point upwards, supports that move by more than the thickness of the ring, and fills with almost no
/// friction are noted.
#[test]
fn implausible_loads_settlements_and_fills_are_noted() {
    let live = |load: &str, more: &str| {
        let stage = format!("gravity = 9.81\n[[stages]]\nname = \"live\"\n{more}\nloads = [{load}]\n");
        notes(&[("gravity = 9.81\n", &stage)])
    };
    let point = |y: f64| format!("{{ kind = \"point\", span_fraction = 0.5, force = [0.0, {y:?}] }}");
    let upwards = |said: &[String]| said.iter().filter(|note| note.contains("points upwards")).count();
    assert_eq!(upwards(&live(&point(-1e3), "")), 0);
    assert_eq!(upwards(&live(&point(1e3), "")), 1);
    assert_eq!(upwards(&live(&point(1e3), "factor = -1.0")), 0, "a factor below zero turns it round");
    let moved = |by: f64| live("", &format!("settlement = [{{ support = \"right\", displacement = [{by:?}, 0.0] }}]"));
    let far = |said: &[String]| said.iter().filter(|note| note.contains("more than the thickness of 0.400 m")).count();
    assert_eq!((far(&moved(0.39)), far(&moved(0.41))), (0, 1));
    let bridge = "scene = \"bridge\"\nwidth = 1.0\nspans = [{ profile = { shape = \"segmental\", span = 4.0, rise = 1.0 }, \
                  thickness = 0.4, voussoirs = 7 }]";
    let arch = "scene = \"arch\"\nprofile = { shape = \"segmental\", span = 4.0, rise = 1.0 }\nthickness = 0.4\nwidth = 1.0\n\
                voussoirs = 7\nends = \"jointed\"";
    for (angle, count) in [(0.61, 1), (35.0, 0)] {
        let fill =
            format!("[scene.fill]\ncover = 0.3\ndensity = 1800.0\nfriction_angle = {angle:?}\n[materials.stone]");
        let said = notes(&[("[materials.stone]", &fill), (arch, bridge)]);
        assert_eq!(said.iter().filter(|note| note.contains("in degrees")).count(), count, "{said:?}");
    }
}

/// Implausible densities of fill, of its layers and of its backing are noted.
#[test]
fn implausible_densities_of_fill_are_noted() {
    let fill = "[scene.fill]\ncover = 0.3\ndensity = 18.0\nhaunching = { level = 0.5, density = 23.0 }\n\
                layers = [{ to_level = 1.0, density = 17.0 }]\n[materials.stone]";
    let arch = "scene = \"arch\"\nprofile = { shape = \"segmental\", span = 4.0, rise = 1.0 }\nthickness = 0.4\nwidth = 1.0\n\
                voussoirs = 7\nends = \"jointed\"";
    let bridge = "scene = \"bridge\"\nwidth = 1.0\nspans = [{ profile = { shape = \"segmental\", span = 4.0, rise = 1.0 }, \
                  thickness = 0.4, voussoirs = 7 }]";
    let said = notes(&[("[materials.stone]", fill), (arch, bridge)]);
    for (key, weight) in [("density", "18"), ("haunching.density", "23"), ("layers.0.density", "17")] {
        let found =
            |note: &&String| note.starts_with(&format!("scene.fill.{key} = {weight} kg/m3")) && note.contains("kN/m3");
        assert_eq!(said.iter().filter(found).count(), 1, "{key}: {said:?}");
    }
}

/// Returns the notes for two blocks on a ground; the left edge of the second is at `x` below and `top` above.
fn blocks(x: f64, top: f64, more: &str) -> Vec<String> {
    let text = format!(
        "name = \"blocks\"\n[scene]\nscene = \"blocks\"\nwidth = 1.0\nmaterial = \"s\"\njoint = \"d\"\n\
         [[scene.blocks]]\nname = \"g\"\nvertices = [[0, 0], [2, 0], [2, -1], [0, -1]]\nfixed = true\n\
         [[scene.blocks]]\nname = \"a\"\nvertices = [[0, 0], [1, 0], [1, 1], [0, 1]]\n\
         [[scene.blocks]]\nname = \"b\"\nvertices = [[{x:?}, 0], [2, 0], [2, 1], [{top:?}, 1]]\n{more}\
         [materials.s]\nlaw = \"rigid\"\ndensity = 2000\n[joints.d]\nlaw = \"coulomb\"\nfriction = 0.6\n\
         [[stages]]\nname = \"dead\"\ngravity = 9.81\n"
    );
    load(&text, "blocks.toml", &[]).unwrap_or_else(|wrong| panic!("{wrong}")).cases[0].notes.clone()
}

#[test]
fn blocks_that_nearly_touch_or_float_are_named() {
    for (x, top, gap) in
        [(1.0000001, 1.002, Some("2.000 mm")), (1.001, 1.001, Some("1.000 mm")), (1.0, 1.0, None), (1.1, 1.1, None)]
    {
        let said = blocks(x, top, "");
        match gap {
            Some(gap) => {
                assert!(said.len() == 1 && said[0].contains(gap) && said[0].contains("\"a\" and \"b\""), "{said:?}")
            }
            None => assert_eq!(said, Vec::<String>::new(), "{x}"),
        }
    }
    let floats = "[[scene.blocks]]\nname = \"c\"\nvertices = [[0.2, 2], [0.8, 2], [0.8, 2.5], [0.2, 2.5]]\n";
    let said = blocks(1.0, 1.0, floats);
    assert!(said.len() == 1 && said[0].contains("\"c\"") && said[0].contains("nothing holds"), "{said:?}");
}

/// An axle off the arch has no effect, and a note reports it; if all axles are off the arch, it is a mistake.
#[test]
fn an_axle_off_the_arch_counts_nothing() {
    let axles = |at: f64| {
        let arch = voussoir_tests::Arch::default().study();
        let point = "{ kind = \"point\", span_fraction = 0.25, force = [0.0, -1000.0] }";
        let load = format!("{{ kind = \"axles\", at = {at:?}, positions = [0.0, 1.8], forces = [1000.0, 1000.0] }}");
        load_text(&voussoir_tests::changed(&arch, point, &load))
    };
    let on = axles(0.2).expect("both on it");
    assert_eq!((on.0, on.1), (2, Vec::new()));
    let crossing = axles(-0.15).expect("one on it");
    assert!(
        crossing.0 == 1 && crossing.1[0].contains("axle 0") && crossing.1[0].contains("counts nothing"),
        "{crossing:?}"
    );
    assert!(axles(1.5).expect_err("none on it").contains("hits no block"));
}

/// Returns the number of forces of the last stage and the notes, or the first mistake.
fn load_text(text: &str) -> Result<(usize, Vec<String>), String> {
    let study = load(text, "axles.toml", &[]).map_err(|wrong| wrong.mistakes()[0].to_string())?;
    let case = &study.cases[0];
    Ok((case.stages.last().map_or(0, |stage| stage.forces.len()), case.notes.clone()))
}
