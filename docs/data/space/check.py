"""Checks the assemblies of this folder with nothing but the standard library: python3 check.py

For each file it prints the load factor and four errors, relative to the loads: of equilibrium, of friction, of the flow rule, and the power
that is left at all points. With associated flow the last error is the distance of the two bounds.
"""

import gzip
import json
import math
import pathlib


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def velocity(node, point):
    v = node["velocity"]
    if node["is_support"] or not v:
        return [0.0] * 3
    arm = [x - c for x, c in zip(point, node["centroid"])]
    return [x + y for x, y in zip(v[:3], cross(v[3:], arm))]


def check(path):
    text = gzip.open(path, "rt").read() if path.suffix == ".gz" else path.read_text()
    data = json.loads(text)["data"]
    about, graph = data["attributes"], data["graph"]["data"]
    nodes, factor = graph["node"], about["field_factor"]
    sums = {k: [w + factor * p for w, p in zip(n["fixed_load"], n["varying_load"])] for k, n in nodes.items()}
    loads = sum(math.hypot(*wrench[:3]) for wrench in sums.values())
    friction = flow = power = largest = 0.0
    for minus, edges in graph["edge"].items():
        for plus, edge in edges.items():
            for interface in (own["data"] for own in edge["interfaces"]):
                s, t = interface["frame"]["data"]["xaxis"], interface["frame"]["data"]["yaxis"]
                n = cross(s, t)
                mu = interface["friction"]
                dilatancy = mu if about["flow_read_as"] == "associated" else interface["dilatancy"]
                for point, own in zip(interface["points"], interface["forces"]):
                    normal = own["c_np"] - own["c_nn"]
                    force = [normal * n[i] + own["c_u"] * s[i] + own["c_v"] * t[i] for i in range(3)]
                    for name, sign in ((plus, 1.0), (minus, -1.0)):
                        arm = [x - c for x, c in zip(point, nodes[name]["centroid"])]
                        for i, part in enumerate(force + cross(arm, force)):
                            sums[name][i] += sign * part
                    jump = [a - b for a, b in zip(velocity(nodes[plus], point), velocity(nodes[minus], point))]
                    opening, slip = dot(jump, n), math.hypot(dot(jump, s), dot(jump, t))
                    largest = max(largest, math.hypot(opening, slip))
                    friction = max(friction, math.hypot(own["c_u"], own["c_v"]) - mu * normal)
                    flow = max(flow, dilatancy * slip - opening)
                    power += abs(dot(force, jump) + (mu - dilatancy) * normal * slip)
    free = [k for k, n in nodes.items() if not n["is_support"]]
    unbalanced = max(abs(part) for k in free for part in sums[k])
    errors = [unbalanced / loads, friction / loads, flow / largest, power / (loads * largest)]
    print(f"{path.name:24} {about['load_factor']:.12f}", *(f"{error:8.1e}" for error in errors))
    return max(errors[:3])


if __name__ == "__main__":
    files = sorted(pathlib.Path(__file__).parent.glob("*.json*"))
    assert files and max(check(path) for path in files) < 1e-12
