"""The results of every kind of study against the schema that `voussoir schema results` prints."""

import json
import subprocess
import sys

import jsonschema
import pytest

import voussoir
from test_voussoir import ARCH, with_


def command(*words, folder):
    done = subprocess.run([sys.executable, "-m", "voussoir", *words], capture_output=True, text=True, cwd=folder)
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def schema(tmp_path_factory):
    schema = json.loads(command("schema", "results", folder=tmp_path_factory.mktemp("schema")))
    # Kinds of other crates may add entries; the kinds that are tested here have no others.
    schema["additionalProperties"] = False
    jsonschema.Draft202012Validator.check_schema(schema)
    return jsonschema.Draft202012Validator(schema)


def variants(**laws):
    return [{"name": name, "set": {"joints.dry.law": law}} for name, law in laws.items()]


DEAD, LIVE = ARCH["stages"]
SPREAD = {"name": "spread", "settlement": [{"support": "left", "displacement": [-0.01, 0.0]}]}
JOINTED = {**ARCH["scene"], "ends": "jointed"}
SOFT = {"law": "coulomb", "friction": 0.6, "normal_stiffness": "20 GPa/m", "shear_stiffness": "10 GPa/m"}
ELASTIC = {"law": "elastic", "young_modulus": "5 GPa", "poisson_ratio": 0.3, "density": 2200.0}
LAWS = variants(associated="coulomb_associated", sliding="coulomb")
RISES = {"scene.profile.rise": {"list": [1.0, 2.99]}}

# Studies, each with a key that its results or one of its cases must have.
STUDIES = {
    "a collapse load": (ARCH, "mechanism"),
    "a sweep with variants": (with_(variants=LAWS, sweep=RISES), "associated_load_factor"),
    "a load that is carried": (with_(stages=[DEAD, {k: v for k, v in LIVE.items() if k != "until"}]), "joints"),
    "sensitivities": (with_(output={"sensitivities": True}), "sensitivities"),
    "an event path": (
        with_(
            scene={**ARCH["scene"], "voussoirs": 7, "mesh": {"elements": [2, 2]}},
            materials={"stone": ELASTIC},
            joints={"dry": {"law": "coulomb", "friction": 0.6}},
            solver={"solver": "event_path"},
            output={"curve": True, "states": 4},
        ),
        "events",
    ),
    "finite displacements after a settlement": (
        with_(
            scene={**JOINTED, "voussoirs": 7},
            joints={"dry": SOFT},
            stages=[DEAD, SPREAD, LIVE],
            solver={"solver": "newton_path", "kinematics": "finite"},
        ),
        "followed_to",
    ),
    "a comparison": (with_(kind="compare", variants=LAWS), "comparison"),
    "a map": (
        with_(kind="map", variants=LAWS, sweep={**RISES, "joints.dry.friction": {"list": [0.4, 0.6]}}),
        "comparison",
    ),
    "an optimum": (
        with_(kind="optimise", optimise={"parameter": "scene.profile.rise", "from": 1.0, "to": 4.0, "scan": 5}),
        "optima",
    ),
    "a kinematic analysis": (
        with_(
            kind="seismic",
            seismic={"ground_acceleration": "0.2 g", "periods": [0.15, 0.5, 2.0]},
            stages=[
                {"name": "dead", "gravity": 9.81},
                {"name": "push", "until": "collapse", "loads": [{"kind": "body", "acceleration": [9.81, 0.0]}]},
            ],
        ),
        "seismic",
    ),
}


def valid(schema, results, key):
    """The results are valid and have this key. They are not valid without a status or with an unknown key."""
    errors = [f"{error.json_path}: {error.message[:200]}" for error in schema.iter_errors(results)]
    assert not errors, errors[:10]
    assert key in results or any(case.get(key) for case in results["cases"])
    if results["cases"]:
        case = {name: value for name, value in results["cases"][0].items() if name != "status"}
        assert not schema.is_valid({**results, "cases": [case]})
        assert not schema.is_valid({**results, "cases": [{**results["cases"][0], "stray": 1}]})


@pytest.mark.parametrize("name", STUDIES)
def test_results_are_valid(schema, name):
    study, key = STUDIES[name]
    valid(schema, json.loads(voussoir.run(study).files["results.json"]), key)


@pytest.mark.parametrize(("template", "key"), [("bridge", "worsts"), ("point", "rows"), ("wall", "motion")])
def test_results_of_templates_are_valid(schema, template, key, tmp_path):
    command("new", template, folder=tmp_path)
    valid(schema, json.loads(voussoir.run(tmp_path / f"{template}.toml").files["results.json"]), key)


def test_results_of_a_report_are_valid(schema, tmp_path):
    command("new", "arch", folder=tmp_path)
    (tmp_path / "report.toml").write_text(
        """name = "report"
kind = "report"
[report]
studies = ["arch.toml"]
text = ["One claim."]
[report.series]
loads = { study = "arch", x = "1" }
[[report.claims]]
id = "1"
claim = "The arch carries 698 kN"
tests = [{ of = "the arch", value = "max(loads)", unit = "kN", holds = "abs(value - 698.0) < 0.1" }]
"""
    )
    command("run", "report.toml", "--quiet", folder=tmp_path)
    valid(schema, json.loads((tmp_path / "results/report/results.json").read_text()), "claims")
    valid(schema, json.loads((tmp_path / "results/report/arch/results.json").read_text()), "mechanism")
