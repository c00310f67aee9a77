//! Keys of the scene `bridge`.

use super::damage::DAMAGE;
use super::fill::FRICTION;
use super::piers::MAX_COURSES;
use super::rings::{MAX_RINGS, MAX_VOUSSOIRS};
use crate::scenes::POINT;
use crate::scenes::keys::{JOINT, MATERIAL, PLANE, WIDTH};
use crate::scenes::mesh::MESH;
use crate::scenes::profile::{PROFILE, SPRINGING};
use crate::scenes::thickness::THICKNESS;
use voussoir_core::plugin::{Need, Parameter, PluginKind, Quantity, Range, Shape};

const fn key(name: &'static str, shape: Shape, need: Need, doc: &'static str) -> Parameter {
    Parameter { name, doc, shape, need }
}

const OWN_MATERIAL: Parameter = Parameter { doc: "material of its blocks", ..MATERIAL }.optional("that of the scene");
const COUNT: Shape = Shape::Integer { min: 1, max: MAX_VOUSSOIRS as i64 };
const FRICTION_ANGLE: Parameter =
    Parameter::number("friction_angle", Quantity::Degrees, FRICTION, "angle of internal friction");
const COHESION: Parameter = Parameter::number("cohesion", Quantity::Stress, Range::NON_NEGATIVE, "cohesion");
const DENSITY: Parameter = Parameter::number("density", Quantity::Density, Range::NON_NEGATIVE, "of the fill");
const ANGLE: Range = Range::new(0.0, false, 90.0, true);

const SPAN: &[Parameter] = &[
    key("profile", PROFILE, Need::Required, "shape of the intrados"),
    key(
        "thickness",
        THICKNESS,
        Need::Optional("the profile is a list of points"),
        "thickness of all rings together, along the joints; { crown, springing } grows with the arc length between them",
    ),
    key(
        "voussoirs",
        Shape::Either(&[COUNT, Shape::List { of: &COUNT, min: 1, max: MAX_RINGS }]),
        Need::Optional("voussoir_length is given, or the profile is a list of points"),
        "number of voussoirs in a ring, or a list of numbers from the innermost ring outwards",
    ),
    Parameter::number(
        "voussoir_length",
        Quantity::Length,
        Range::POSITIVE,
        "least length of a voussoir along the lower face of its ring",
    )
    .optional("voussoirs is given"),
    key(
        "rings",
        Shape::Integer { min: 1, max: MAX_RINGS as i64 },
        Need::Default("1"),
        "number of rings, equally thick",
    ),
    key(
        "radial_joints",
        Shape::Choice(&["aligned", "offset"]),
        Need::Default("\"aligned\""),
        "aligned: radial joints of neighbouring rings meet; offset: every other ring begins with half a voussoir",
    ),
    key(
        "ends",
        Shape::Choice(&["bonded", "jointed"]),
        Need::Default("\"jointed\""),
        "bonded: the springing faces move with the supports; jointed: they follow the interface law",
    ),
    key(
        "springing",
        SPRINGING,
        Need::Optional("the end joints are normal to the intrados"),
        "inclination of the support plane above the horizontal, rising outwards; one number or [left, right]",
    ),
    Parameter::number("level", Quantity::Length, Range::ANY, "level of its springings").default("0.0"),
    OWN_MATERIAL,
];

const PIER: &[Parameter] = &[
    Parameter::number("height", Quantity::Length, Range::POSITIVE, "height below the lower of the springings on it"),
    Parameter::number(
        "width",
        Quantity::Length,
        Range::POSITIVE,
        "at the springings: the distance of their intrados ends",
    ),
    Parameter::number("base_width", Quantity::Length, Range::POSITIVE, "at its foot")
        .optional("that at the springings"),
    key(
        "courses",
        Shape::Integer { min: 1, max: MAX_COURSES as i64 },
        Need::Default("1"),
        "number of courses, equally high",
    ),
    key(
        "footing",
        Shape::Choice(&["fixed", "bonded"]),
        Need::Default("\"fixed\""),
        "fixed: it stands on fixed ground with a joint like any other; bonded: its lowest course is one with the ground",
    ),
    OWN_MATERIAL,
];

const LAYER: &[Parameter] = &[
    Parameter::number("to_level", Quantity::Length, Range::ANY, "its upper level, above y = 0"),
    DENSITY,
    FRICTION_ANGLE.optional("that of the fill"),
    COHESION.optional("that of the fill"),
    Parameter::number("angle", Quantity::Degrees, ANGLE, "of the spread of loads in it, from the vertical")
        .optional("that of the dispersion"),
];

const HAUNCHING: &[Parameter] = &[
    Parameter::number("level", Quantity::Length, Range::ANY, "its upper level, above y = 0"),
    Parameter::number("density", Quantity::Density, Range::NON_NEGATIVE, "of the backing")
        .optional("that of the voussoirs"),
    Parameter::number("strength", Quantity::Stress, Range::NON_NEGATIVE, "horizontal pressure up to which it resists")
        .default("0.0"),
];

const FILL: &[Parameter] = &[
    Parameter::number(
        "cover",
        Quantity::Length,
        Range::NON_NEGATIVE,
        "depth of a level road above the highest crown's extrados",
    )
    .optional("road is given"),
    key(
        "road",
        Shape::List { of: &POINT, min: 1, max: usize::MAX },
        Need::Optional("level, by cover"),
        "points of the road from left to right, level beyond them",
    ),
    DENSITY,
    FRICTION_ANGLE.optional("no resistance is asked for"),
    COHESION.default("0.0"),
    key(
        "extent",
        Shape::Choice(&["extrados", "springings"]),
        Need::Default("\"extrados\""),
        "extrados: fill stands on the whole extrados; springings: it ends above the outermost intrados springings",
    ),
    key(
        "dispersion",
        Shape::Plugin(PluginKind::Dispersion),
        Need::Optional("loads do not spread"),
        "how live loads spread: { law = \"uniform\", angle = 30.0 }",
    ),
    key(
        "resistance",
        Shape::Plugin(PluginKind::FillResistance),
        Need::Optional("the fill does not resist"),
        "how the fill resists the rings: { law = \"fill_pressure\", passive_factor = 0.33 }",
    ),
    key("haunching", Shape::Table(HAUNCHING), Need::Optional("none"), "solid backing in the haunches up to a level"),
    key(
        "layers",
        Shape::List { of: &Shape::Table(LAYER), min: 0, max: usize::MAX },
        Need::Default("[]"),
        "layers from the lowest; above the last stands the fill itself",
    ),
];

/// Keys of the scene.
pub(super) const PARAMETERS: &[Parameter] = &[
    WIDTH,
    PLANE,
    MATERIAL,
    JOINT,
    Parameter { name: "ring_joint", doc: "interface law of the joints between rings", ..JOINT }
        .optional("that of joint"),
    key("spans", Shape::List { of: &Shape::Table(SPAN), min: 1, max: 1000 }, Need::Required, "from left to right"),
    key(
        "piers",
        Shape::List { of: &Shape::Table(PIER), min: 0, max: 1000 },
        Need::Default("[]"),
        "one between two spans",
    ),
    key("fill", Shape::Table(FILL), Need::Optional("bare rings"), "fill between the rings and the road"),
    key(
        "damage",
        Shape::List { of: &DAMAGE, min: 0, max: usize::MAX },
        Need::Default("[]"),
        "joints that have lost mortar or are repointed, lost voussoirs: { kind = \"lost_mortar\", depth = 0.05 }",
    ),
    MESH,
];
