//! Small scenes of every status.

/// Stiffness of a joint for paths.
pub const COMPLIANT: &str = "normal_stiffness = 1e10\nshear_stiffness = 4e9\n";

fn head(scene: &str, friction: f64, joint: &str) -> String {
    format!(
        "name = \"scene\"\n[scene]\n{scene}material = \"stone\"\njoint = \"dry\"\n[materials.stone]\nlaw = \"rigid\"\n\
         density = 2200.0\n[joints.dry]\nlaw = \"mohr_coulomb\"\nfriction = {friction:?}\n{joint}[[stages]]\n\
         name = \"dead\"\ngravity = 9.81\n"
    )
}

fn live(end: &str, load: &str) -> String {
    format!("[[stages]]\nname = \"live\"\n{end}loads = [{{ {load} }}]\n")
}

/// An arch of 7 voussoirs with a point load at a quarter of its span.
pub fn arch(thickness: f64, joint: &str, end: &str) -> String {
    head(&arch_scene(thickness, 7), 0.6, joint)
        + &live(end, "kind = \"point\", span_fraction = 0.25, force = [0.0, -1000.0]")
}

fn arch_scene(thickness: f64, voussoirs: usize) -> String {
    format!(
        "scene = \"arch\"\nprofile = {{ shape = \"segmental\", span = 4.0, rise = 1.0 }}\nthickness = {thickness:?}\n\
         width = 1.0\nvoussoirs = {voussoirs}\nmesh = {{ elements = [1, 1], order = 2 }}\n"
    )
}

fn wall(friction: f64, load: &str) -> String {
    let scene =
        "scene = \"wall\"\nwidth = 1.0\nbrick = [0.4, 0.2]\nrows = [[0.5, 1, 1, 0.5], [1, 1, 1], [0.5, 1, 1, 0.5]]\n";
    head(scene, friction, "") + &live("until = \"collapse\"\n", load)
}

/// A block on rough ground.
fn block(friction: f64, end: &str, force: &str) -> String {
    let scene = "scene = \"blocks\"\nwidth = 1.0\n\
        blocks = [{ name = \"ground\", fixed = true, vertices = [[-2.0, -1.0], [2.0, -1.0], [2.0, 0.0], [-2.0, 0.0]] }, \
        { name = \"stone\", vertices = [[-0.5, 0.0], [0.5, 0.0], [0.5, 0.5], [-0.5, 0.5]] }]\n";
    head(scene, friction, "")
        + &live(end, &format!("kind = \"point\", block = \"stone\", point = [0.0, 0.5], force = {force}"))
}

/// Scenes of linear strengths, by name.
pub fn scenes() -> Vec<(&'static str, String)> {
    let collapse = "until = \"collapse\"\n";
    let push = "kind = \"body\", acceleration = [9.81, 0.0]";
    let point = |at: f64, force: &str| format!("kind = \"point\", span_fraction = {at:?}, force = {force}");
    vec![
        ("arch", arch(0.5, "", collapse)),
        ("arch to a factor below its collapse", arch(0.5, "", "factor = 2.0\n")),
        ("arch to a factor above its collapse", arch(0.5, "", "factor = 1000.0\n")),
        ("arch too thin for its weight", arch(0.02, "", collapse)),
        ("thin arch", arch(0.05, "", collapse)),
        ("arch with cohesion", arch(0.4, "cohesion = 2e4\ntensile_strength = 1e4\n", collapse)),
        ("arch of 40 voussoirs", head(&arch_scene(0.4, 40), 0.7, "") + &live(collapse, &point(0.3, "[0.0, -1.0]"))),
        ("arch that slides", head(&arch_scene(0.8, 9), 0.3, "") + &live(collapse, &point(0.5, "[0.0, -1000.0]"))),
        ("arch pushed sideways", head(&arch_scene(0.5, 9), 0.6, "") + &live(collapse, push)),
        ("wall", wall(0.65, push)),
        ("wall that slides", wall(0.2, push)),
        ("block pushed", block(0.4, collapse, "[1000.0, 0.0]")),
        ("block tipped", block(2.0, collapse, "[1000.0, 0.0]")),
        ("block pressed", block(0.4, collapse, "[100.0, -1000.0]")),
        ("block lifted", block(0.4, collapse, "[0.0, 1000.0]")),
    ]
}
