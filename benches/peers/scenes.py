"""Scenes that Voussoir and other programs are measured on: a study file, and the same polygons as a linear program."""

import math
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import scipy.sparse as sp

sys.path.append(str(Path(__file__).resolve().parent.parent))
import studies
from studies import BRICK, RING

WALL_FRICTION = 0.65
# One case, no figures.
QUIET = 'figures = "none"\n[[variants]]\nname = "voussoir"\nset = {}'
WALLS = {
    "wall 1": [[0.5, 1, 1, 1, 1, 0.5], [1] * 5] * 3,
    "wall 2": [[0.5, 1, 1, 1, 1, 0.5], [1] * 5] * 5,
    "wall 3": [[1] * 4, [0.5, 1, 1, 1, 0.5], [1] * 4]
    + [[0.5, 1, -1, 1, 0.5], [1, 0.5, -1, 0.5, 1]] * 2
    + [[0.5, 1, -1, 1, 0.5], [1] * 4, [0.5, 1, 1, 1, 0.5], [1] * 4],
    "wall 4": [[0.5, 1, 1, 1, 1, 0.5], [1] * 5, [0.5, 1, 1, 1, 1, 0.5]]
    + [[1, -1, 1, -1, 1], [0.5, 0.5, -1, 0.5, 0.5, -1, 0.5, 0.5]] * 2
    + [[1, -1, 1, -1, 1], [0.5, 1, 1, 1, 1, 0.5], [1] * 5, [0.5, 1, 1, 1, 1, 0.5]],
}


@dataclass
class Scene:
    """A scene as a study and as data of linear programs, forces in units of the greatest weight."""

    name: str
    study: str
    equilibrium: sp.csc_matrix  # E r + w + λ p = 0, three rows a block; r = (N0, N1, T) of each joint, N > 0 presses
    fixed: np.ndarray
    varying: np.ndarray
    friction: float
    unit: float  # what λ = 1 of `varying` is in the study's factor


def program(polygons, joints, fixed, varying):
    """Matrices from polygons, joints (minus, plus, end 0, end 1, normal from minus to plus) and wrenches of blocks."""
    rows, columns, values = [], [], []
    for index, (minus, plus, ends, normal) in enumerate(joints):
        tangent = (-normal[1], normal[0])
        forces = [(ends[0], normal), (ends[1], normal), (ends[0], tangent)]
        for k, (at, force) in enumerate(forces):
            wrench = (force[0], force[1], at[0] * force[1] - at[1] * force[0])
            for block, sign in ((plus, 1.0), (minus, -1.0)):
                if block is not None:
                    for i in range(3):
                        rows.append(3 * block + i)
                        columns.append(3 * index + k)
                        values.append(sign * wrench[i])
    shape = (3 * len(polygons), 3 * len(joints))
    return sp.csc_matrix((values, (rows, columns)), shape=shape), np.array(fixed).ravel(), np.array(varying).ravel()


def area_and_centre(polygon):
    """Of a simple polygon, anticlockwise."""
    twice, x, y = 0.0, 0.0, 0.0
    for (ax, ay), (bx, by) in zip(polygon, polygon[1:] + polygon[:1]):
        cross = ax * by - bx * ay
        twice, x, y = twice + cross, x + cross * (ax + bx), y + cross * (ay + by)
    return twice / 2, (x / (3 * twice), y / (3 * twice))


def ring_joints(count):
    """Inside and outside ends of the ring's joints, and their angles from the vertical."""
    s, r, t = RING["span"], RING["rise"], RING["thickness"]
    radius = (s * s / 4 + r * r) / (2 * r)
    half = math.asin(s / 2 / radius) if r <= s / 2 else math.pi - math.asin(s / 2 / radius)
    angles = [-half + 2 * half * k / count for k in range(count + 1)]
    at = lambda radius_, a: (radius_ * math.sin(a), radius_ * math.cos(a) - radius + r)
    return [at(radius, a) for a in angles], [at(radius + t, a) for a in angles], angles


def ring(count):
    """A segmental ring of equal voussoirs with straight sides, jointed to its abutments; a load above quarter span."""
    inside, outside, angles = ring_joints(count)
    polygons = [[inside[k + 1], outside[k + 1], outside[k], inside[k]] for k in range(count)]
    weights, load_x = [], -RING["span"] / 4
    for polygon in polygons:
        area, centre = area_and_centre(polygon)
        weights.append((area * RING["density"] * 9.81, centre))
    unit = max(w for w, _ in weights)
    fixed = [(0.0, -w / unit, -w / unit * c[0]) for w, c in weights]
    loaded = next(k for k in range(count) if outside[k][0] <= load_x < outside[k + 1][0])
    varying = [(0.0, -1.0, -load_x) if k == loaded else (0.0, 0.0, 0.0) for k in range(count)]
    joints = []
    for k, a in enumerate(angles):
        normal = (math.cos(a), -math.sin(a))
        joints.append((k - 1 if k > 0 else None, k if k < count else None, (inside[k], outside[k]), normal))
    text = studies.ring(count, output=QUIET)
    matrices = program(polygons, joints, fixed, varying)
    return Scene(f"ring of {count}", text, *matrices, RING["friction"], unit / 1000.0)


def wall(rows, name, law="coulomb_associated", solver="auto"):
    """A wall of courses from below, lengths in bricks, an opening where negative; pushed sideways by its weight."""
    length, height = BRICK
    polygons, courses = [], []
    for level, row in enumerate(rows):
        left, course = 0.0, []
        for part in row:
            right = left + abs(part) * length
            if part > 0:
                course.append((left, right, len(polygons)))
                low, high = level * height, (level + 1) * height
                polygons.append([(left, low), (right, low), (right, high), (left, high)])
            left = right
        courses.append(course)
    joints = []
    for level, course in enumerate(courses):
        low, high = level * height, (level + 1) * height
        for (_, x, a), (start, _, b) in zip(course, course[1:]):
            if abs(x - start) < 1e-9:
                joints.append((a, b, ((x, low), (x, high)), (1.0, 0.0)))
        for left, right, block in course:
            below = courses[level - 1] if level else [(left, right, None)]
            for start, end, under in below:
                a, b = max(left, start), min(right, end)
                if b - a > 1e-9:
                    joints.append((under, block, ((a, low), (b, low)), (0.0, 1.0)))
    measured = [area_and_centre(polygon) for polygon in polygons]
    unit = max(area for area, _ in measured)
    fixed = [(0.0, -a / unit, -a / unit * c[0]) for a, c in measured]
    varying = [(a / unit, 0.0, -a / unit * c[1]) for a, c in measured]
    text = studies.wall(f"rows = {rows}", studies.friction(WALL_FRICTION, law), name, solver=solver, output=QUIET)
    return Scene(name, text, *program(polygons, joints, fixed, varying), WALL_FRICTION, 1.0)


def running_bond(bricks, courses):
    """Courses of a wall: so many bricks in every second one, a half brick at both ends of the others."""
    return [[1] * bricks if level % 2 == 0 else [0.5] + [1] * (bricks - 1) + [0.5] for level in range(courses)]


def friction_rows(count, friction):
    """±T − μ (N0 + N1) ≤ 0 for each joint."""
    one = sp.csc_matrix([[-friction, -friction, 1.0], [-friction, -friction, -1.0]])
    return sp.kron(sp.identity(count), one, format="csc")
