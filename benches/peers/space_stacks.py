"""Random stacks of blocks in space: voussoir against linear programs of HiGHS.

Friction cones are replaced by pyramids with 32 edges, once inside and once around the cones. The greatest factors of the
two programs are a lower and an upper bound of the factor of voussoir. Blocks are prisms with 3 to 6 sides; scenes are
turned and moved at random, and gravity is inclined. Volumes, centroids, contacts and wrenches are computed here.

With `own`, slip does not open the joints: the collapse states of `limit_sequential` are checked against equilibrium, friction and
flow, and their factor against the upper bound.

    python space_stacks.py PROGRAM SEED COUNT [own]          needs numpy and scipy
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from scipy.optimize import linprog

EDGES = 32
# Relative tolerance of HiGHS.
ROUNDING = 1e-7
# Greatest error of a collapse state.
STATE = 1e-11


def clipped(polygon, a, b):
    """The part of a polygon to the left of the line from a to b."""
    out = []
    for i, p in enumerate(polygon):
        q = polygon[(i + 1) % len(polygon)]
        left, right = side(a, b, p), side(a, b, q)
        if left >= 0:
            out.append(p)
        if left * right < 0:
            out.append(p + (q - p) * left / (left - right))
    return out


def side(a, b, p):
    return (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])


def overlap(one, other):
    for i in range(len(other)):
        one = clipped(one, other[i], other[(i + 1) % len(other)])
    return one


def area_and_centroid(polygon):
    crosses = [side(np.zeros(2), p, polygon[(i + 1) % len(polygon)]) for i, p in enumerate(polygon)]
    area = sum(crosses) / 2
    moment = sum((p + polygon[(i + 1) % len(polygon)]) * crosses[i] for i, p in enumerate(polygon))
    return area, moment / (6 * area)


def regular(centre, radius, sides, angle):
    angles = angle + np.arange(sides) * 2 * np.pi / sides
    return list(centre + radius * np.c_[np.cos(angles), np.sin(angles)])


def stack(random):
    """Blocks (polygon, lower level, upper level), the first is the ground, and contacts (lower, upper, points)."""
    blocks = [(regular(np.zeros(2), 9.0, 4, np.pi / 4), -1.0, 0.0)]
    contacts, below, level = [], [0], 0.0
    for _ in range(random.integers(1, 5)):
        height, count, course = random.uniform(0.3, 1.5), random.integers(1, 3), []
        for k in range(count):
            centre = np.array([(k - (count - 1) / 2) * 1.6, 0.0]) + random.uniform(-0.25, 0.25, 2)
            if count == 1:
                polygon = regular(centre, random.uniform(0.8, 1.3), random.integers(3, 7), random.uniform(0, np.pi))
            else:
                polygon = regular(centre, 0.95, 4, np.pi / 4 + random.uniform(-0.15, 0.15))
            blocks.append((polygon, level, level + height))
            for lower in below:
                common = overlap(blocks[lower][0], polygon)
                if len(common) > 2 and area_and_centroid(common)[0] > 1e-3:
                    points = np.array([[*p, level] for p in common])
                    contacts.append((lower, len(blocks) - 1, points))
            course.append(len(blocks) - 1)
        below, level = course, level + height
    return blocks, contacts


def greatest_factor(scene, friction, gravity, push, around, most=None):
    """The status of HiGHS and the greatest factor with pyramids around or inside the cones."""
    blocks, contacts = scene
    free = len(blocks) - 1
    weights, pushes = np.zeros(6 * free), np.zeros(6 * free)
    for k, (polygon, low, high) in enumerate(blocks[1:]):
        area, centre = area_and_centroid(polygon)
        centroid = np.array([*centre, (low + high) / 2])
        for sums, direction in [(weights, gravity), (pushes, push)]:
            sums[6 * k : 6 * k + 6] = area * (high - low) * np.r_[direction, np.cross(centroid, direction)]
    radius = friction / np.cos(np.pi / EDGES) if around else friction
    columns = []
    for lower, upper, points in contacts:
        for point in points:
            for angle in np.arange(EDGES) * 2 * np.pi / EDGES:
                force = np.array([radius * np.cos(angle), radius * np.sin(angle), 1.0])
                column = np.zeros(6 * free)
                for body, sign in [(upper, 1), (lower, -1)]:
                    if body:
                        column[6 * body - 6 : 6 * body] += sign * np.r_[force, np.cross(point, force)]
                columns.append(column)
    matrix = np.c_[np.array(columns).T, pushes]
    bounds = [(0, None)] * len(columns) + [(0, most)]
    found = linprog(np.r_[np.zeros(len(columns)), -1], A_eq=matrix, b_eq=-weights, bounds=bounds, method="highs")
    return {0: "found", 2: "infeasible", 3: "unbounded"}.get(found.status, "failed"), -found.fun if found.status == 0 else None


def rotation(random):
    matrix, _ = np.linalg.qr(random.normal(size=(3, 3)))
    return matrix * np.sign(np.linalg.det(matrix))


def written(scene, turn, shift):
    """The scene in the format of compas_assembly."""

    def wrapped(**data):
        return {"dtype": "stack/Object", "data": data}

    blocks, contacts = scene
    nodes, edges = {}, {str(k): {} for k in range(len(blocks))}
    for k, (polygon, low, high) in enumerate(blocks):
        n = len(polygon)
        corners = np.array([[*p, z] for z in (low, high) for p in polygon]) @ turn.T + shift
        faces = [list(range(n))[::-1], list(range(n, 2 * n))]
        faces += [[i, (i + 1) % n, n + (i + 1) % n, n + i] for i in range(n)]
        vertex = {str(i): dict(zip("xyz", map(float, corner))) for i, corner in enumerate(corners)}
        face = {str(i): list(map(int, corners)) for i, corners in enumerate(faces)}
        nodes[str(k)] = {"block": wrapped(vertex=vertex, face=face), "is_support": k == 0}
    for lower, upper, points in contacts:
        points = (points @ turn.T + shift).tolist()
        frame = wrapped(point=points[0], xaxis=turn[:, 0].tolist(), yaxis=turn[:, 1].tolist())
        edges[str(lower)][str(upper)] = {"interfaces": [wrapped(points=points, frame=frame)]}
    return wrapped(graph=wrapped(node=nodes, edge=edges))


def answered(program, folder, scene, friction, gravity, push, own, placed):
    turn, shift = placed
    (folder / "stack.json").write_text(json.dumps(written(scene, turn, shift)))
    stages = f"""[[stages]]
name = "weight"
gravity = {(turn @ gravity).tolist()}
[[stages]]
name = "push"
until = "collapse"
loads = [{{ kind = "body", acceleration = {(turn @ push).tolist()} }}]
"""
    (folder / "stack.toml").write_text(f"""name = "stack"
[scene]
scene = "assembly"
file = "stack.json"
material = "stone"
joint = "dry"
[materials.stone]
law = "rigid"
density = 1.0
[joints.dry]
law = "{"coulomb" if own else "coulomb_associated"}"
friction = {friction!r}
{stages}[solver]
solver = "{"limit_sequential" if own else "auto"}"
[output]
figures = false
""")
    results = folder / "results"
    command = [program, "run", folder / "stack.toml", "--out", results, "--quiet"]
    subprocess.run(command, check=False, capture_output=True)
    case = json.loads((results / "results.json").read_text())["cases"][0]
    for file in results.iterdir():
        file.unlink()
    return case


def state_error(case, scene, friction, gravity, push, turn, shift):
    """The greatest relative error of a collapse state: equilibrium, friction, penetration, and power left."""
    # The file lists contacts by their lower block.
    blocks, contacts = scene[0], sorted(scene[1], key=lambda contact: contact[0])
    centroids, volumes = [], []
    for polygon, low, high in blocks:
        area, centre = area_and_centroid(polygon)
        centroids.append(np.array([*centre, (low + high) / 2]))
        volumes.append(area * (high - low))
    load = gravity + case["load_factor"] * push
    sums = [np.r_[volume * load, np.zeros(3)] for volume in volumes]
    motion = [np.r_[turn.T @ entry["velocity"][:3], turn.T @ entry["velocity"][3:]] for entry in case["motion"]]
    total = sum(volumes[1:]) * (1 + abs(case["load_factor"]))
    # The tangent s is horizontal in the frame of the file; all contacts have the same normal.
    across = np.cross([0.0, 0.0, 1.0], turn[:, 2])
    across /= np.linalg.norm(across)
    axes = turn.T @ np.c_[turn[:, 2], across, np.cross(turn[:, 2], across)]
    penetrations, errors, largest, idle = [0.0], [], 0.0, 0.0
    for entry in case["field"]:
        lower, upper, _ = contacts[entry["joint"]]
        point = (np.array(entry["point"]) - shift) @ turn
        n, s, t = entry["force"]
        force = axes @ [n, s, t]
        rates = []
        for body, sign in [(upper, 1), (lower, -1)]:
            arm = point - centroids[body]
            sums[body] = sums[body] + sign * np.r_[force, np.cross(arm, force)]
            rates.append(motion[body][:3] + np.cross(motion[body][3:], arm))
        jump = rates[0] - rates[1]
        slip = np.hypot(jump[0], jump[1])
        errors.append((np.hypot(s, t) - friction * n) / total)
        largest = max(largest, np.linalg.norm(jump))
        idle += friction * n * slip + force @ jump
        penetrations.append(-jump[2])
    balance = max(np.abs(wrench).max() for wrench in sums[1:]) / total
    return max(balance, max(errors), max(penetrations) / largest, idle / largest / total)


def contradiction(case, inside, around, at_rest):
    """Why the answer contradicts the linear programs, or None."""
    status, factor = case["status"], case["load_factor"]
    low = inside[1] if inside[0] == "found" else 0.0
    high = around[1] if around[0] == "found" else np.inf
    if status == "collapse" and not low * (1 - ROUNDING) <= factor <= high * (1 + ROUNDING):
        return f"{factor} is not between {low} and {high}"
    if status == "unbounded" and around[0] == "found":
        return f"unbounded, but at most {high}"
    if status == "no_equilibrium" and at_rest()[0] == "found":
        return "no equilibrium, but the loads at the start are carried"
    return None


def main():
    program, seed, count, own = sys.argv[1], int(sys.argv[2]), int(sys.argv[3]), "own" in sys.argv[4:]
    random = np.random.default_rng(seed)
    statuses, widths, wrong, errors, below = {}, [], 0, [], []
    with tempfile.TemporaryDirectory() as name:
        for number in range(count):
            scene, friction = stack(random), random.uniform(0.2, 0.9)
            tilt, azimuth = random.uniform(0, 0.12), random.uniform(0, 2 * np.pi)
            gravity = np.array([np.sin(tilt) * np.cos(azimuth), np.sin(tilt) * np.sin(azimuth), -np.cos(tilt)])
            push = random.normal(size=3) * [1, 1, 0.3]
            push /= np.linalg.norm(push)
            placed = rotation(random), random.normal(size=3) * 5
            case = answered(program, Path(name), scene, friction, gravity, push, own, placed)
            inside, around = (greatest_factor(scene, friction, gravity, push, side) for side in (False, True))
            if own:
                # Collapse states with the laws' own flow have no lower bound here.
                inside = ("none", None)
            why = contradiction(case, inside, around, lambda: greatest_factor(scene, friction, gravity, push, False, 0.0))
            if own and case["status"] == "collapse" and case["flow_read_as"] is None:
                error = state_error(case, scene, friction, gravity, push, *placed)
                errors.append(error)
                if case["associated_load_factor"]:
                    below.append(case["load_factor"] / case["associated_load_factor"])
                why = why or (f"a state with an error of {error}" if error > STATE else None)
            if why:
                wrong += 1
                print(f"{number}: {why}")
            statuses[case["status"]] = statuses.get(case["status"], 0) + 1
            if case["status"] == "collapse" and inside[0] == around[0] == "found":
                widths.append((around[1] - inside[1]) / case["load_factor"])
    print(f"{count} stacks, {wrong} contradictions; {statuses}")
    if widths:
        print(f"median width of the brackets {np.median(widths):.4f}")
    if errors:
        print(f"{len(errors)} states, greatest error {max(errors):.1e}")
    if below:
        print(f"least ratio of own to associated factor {min(below):.4f}")


main()
