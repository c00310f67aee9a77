"""Study files that `scaling.py` and `peers/` measure. Needs nothing but Python."""

STAGES = """[[stages]]
name = "dead"
gravity = 9.81
[[stages]]
name = "live"
until = "collapse"
loads = [{load}]
"""

# The ring that is measured, but for its number of voussoirs and its width.
RING = dict(span=9.42, rise=2.99, thickness=0.60, density=2200.0, friction=0.6)
# A brick of walls, length and height, and the density of walls.
BRICK = (0.4, 0.175)
WALL_DENSITY = 2000.0

RIGID = 'law = "rigid"'
# Nothing but results.json.
NO_WRITERS = "writers = []"
POINT = '{ kind = "point", span_fraction = 0.25, force = [0.0, -1000.0] }'
SIDEWAYS = '{ kind = "body", acceleration = [9.81, 0.0] }'


def friction(coefficient, law="coulomb_associated"):
    """A joint with friction."""
    return f'law = "{law}"\nfriction = {coefficient}'


def study(name, scene, load, density, joint, material=RIGID, solver="auto", width=1.0, output="", rest=""):
    """A study of one scene to collapse; `output` and `rest` end its table of outputs and the file."""
    return f"""name = "{name}"
[scene]
{scene}
width = {width}
material = "stone"
joint = "dry"
[materials.stone]
{material}
density = {density}
[joints.dry]
{joint}
[solver]
solver = "{solver}"
{STAGES.format(load=load)}[output]
{output}
{rest}"""


def ring(voussoirs, joint=friction(RING["friction"]), ends="jointed", more="", **others):
    """The ring, with a load above quarter span."""
    scene = f"""scene = "arch"
profile = {{ shape = "segmental", span = {RING["span"]}, rise = {RING["rise"]} }}
thickness = {RING["thickness"]}
voussoirs = {voussoirs}
ends = "{ends}"
{more}""".rstrip()
    name = others.pop("name", f"ring of {voussoirs}")
    return study(name, scene, POINT, RING["density"], joint, **others)


def wall(courses, joint, name="wall", **others):
    """A wall of bricks, pushed sideways by its weight; `courses` are the keys that say which bricks stand where."""
    scene = f'scene = "wall"\nbrick = [{BRICK[0]}, {BRICK[1]}]\n{courses}'
    return study(name, scene, SIDEWAYS, WALL_DENSITY, joint, **others)


def square(side, coefficient=0.65):
    """A wall of side × side bricks."""
    return wall(f"courses = {side}\nbricks = {side}", friction(coefficient), output=NO_WRITERS)


def sweep(count):
    """So many rises of an arch."""
    return f'[sweep]\n"scene.profile.rise" = {{ from = 2.6, to = 4.0, count = {count} }}\n'
