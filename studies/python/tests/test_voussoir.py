"""Tests of the public interface of the Python package."""

import json
import signal
import subprocess
import sys
import threading
import time
from concurrent.futures import ProcessPoolExecutor

import numpy as np
import pytest

import voussoir

ARCH = {
    "name": "arch",
    "scene": {
        "scene": "arch",
        "profile": {"shape": "segmental", "span": 9.42, "rise": 2.99},
        "thickness": 0.6,
        "width": 5.81,
        "voussoirs": 15,
        "ends": "bonded",
        "material": "stone",
        "joint": "dry",
    },
    "materials": {"stone": {"law": "rigid", "density": 2200.0}},
    "joints": {"dry": {"law": "coulomb_associated", "friction": 0.6}},
    "stages": [
        {"name": "dead", "gravity": 9.81},
        {
            "name": "live",
            "until": "collapse",
            "loads": [{"kind": "point", "span_fraction": 0.25, "force": [0.0, "-1 kN"]}],
        },
    ],
}


def with_(**keys):
    return {**ARCH, **keys}


def elastic(**joint):
    """The arch with elastic blocks and compliant joints, which needs a path."""
    scene = {**ARCH["scene"], "voussoirs": 5, "mesh": {"elements": [2, 2]}, "ends": "jointed"}
    stone = {"law": "elastic", "young_modulus": "5 GPa", "poisson_ratio": 0.3, "density": 2200.0}
    return with_(scene=scene, materials={"stone": stone}, joints={"dry": joint})


def test_a_dictionary_a_text_and_a_file_are_the_same(tmp_path):
    results = voussoir.run(ARCH)
    # Strathmashie, rise 2.99 m: the value in the README and in its doctest.
    assert results[0].status == "collapse" and abs(results[0].load_factor - 698.0227) < 1e-4
    assert results.certified and results[0].certified and results[0].mechanism["kind"] == "four_hinge"
    path = tmp_path / "arch.toml"
    path.write_bytes(results.files["resolved.toml"])
    for study in (path, str(path), path.read_text()):
        assert voussoir.run(study)[0].load_factor == results[0].load_factor
    weak = voussoir.run(path, set={"joints.dry.friction": 0.3})
    assert weak[0].load_factor == voussoir.run(ARCH, set={"joints.dry.friction": 0.3})[0].load_factor
    assert weak[0].load_factor <= results[0].load_factor


def test_arrays():
    case = voussoir.run(ARCH)[0]
    field, motion = case.field, case.motion
    assert field["force"].shape == (len(field["joint"]), 2) and field["force"].dtype == np.float64
    assert motion["velocity"].shape == (len(motion["body"]), 3)
    assert case.bounds.shape == (2,) and abs(case.bounds[0] - case.load_factor) < 1e-6 * case.load_factor
    assert case.thrust_line.shape[1] == 2
    # Joints are in compression.
    assert np.all(field["force"][:, 0] >= -1e-6)
    path = voussoir.run({**elastic(law="unilateral", tangential="stuck"), "output": {"curve": True, "figures": False}})[0]
    assert path.curve.ndim == 2 and path.curve.shape[1] == 2 and len(path.curve) > 2
    assert path.curve[:, 1].max() == pytest.approx(path.load_factor)
    with pytest.raises(AttributeError, match="the case has no strength"):
        path.strength


def standing(*factors):
    """A block of 4 m x 6 m on a joint into which water enters, pushed by factors of a thrust."""
    corners = [[0.0, 0.0], [4.0, 0.0], [4.0, 6.0], [0.0, 6.0]]
    thrust = {"kind": "point", "block": "dam", "point": [0.0, 2.0], "force": ["180 kN", 0.0]}
    return {
        "name": "dam",
        "scene": {
            "scene": "blocks",
            "width": 1.0,
            "material": "concrete",
            "joint": "base",
            "mesh": {"elements": [1, 20], "order": 2},
            "blocks": [
                {"name": "rock", "vertices": [[-1.0, -1.0], [5.0, -1.0], [5.0, 0.0], [-1.0, 0.0]], "fixed": True},
                {"name": "dam", "vertices": corners},
            ],
        },
        "materials": {"concrete": {"law": "rigid", "density": 2400.0}},
        "joints": {
            "base": {"law": "uplift_joint", "friction": 0.9, "normal_stiffness": "10 GPa/m", "shear_stiffness": "4 GPa/m"}
        },
        "stages": [
            {"name": "weight", "gravity": 10.0, "fields": {"water_level": "0 m"}},
            {"name": "water", "fields": {"water_level": "6 m"}, "loads": [thrust]},
        ],
        "sweep": {"stages.1.factor": {"list": list(factors)}},
    }


def test_outputs_of_plug_ins_are_arrays_and_columns():
    results = voussoir.run(standing(0.5, 1.0))
    lengths = [case.outputs["crack_length"] for case in results]
    assert [length.shape for length in lengths] == [(1,), (1,)] and 0 <= lengths[0][0] < lengths[1][0] < 4
    assert set(np.unique(results[1].outputs["open"])) == {0.0, 1.0}
    assert results.df["total_crack_length [m]"].tolist() == [float(length[0]) for length in lengths]
    table = voussoir.sweep(standing(0.5, 1.0))
    assert list(table["uplift_joint.total_crack_length"]) == [float(length[0]) for length in lengths]
    assert voussoir.run(ARCH)[0].outputs == {}


def test_mistakes_are_exceptions_with_text_and_place(tmp_path):
    path = tmp_path / "wrong.toml"
    path.write_bytes(voussoir.run(ARCH).files["resolved.toml"].replace(b"friction", b"frictoin"))
    with pytest.raises(voussoir.StudyError) as found:
        voussoir.check(path)
    said = subprocess.run([sys.executable, "-m", "voussoir", "check", path], capture_output=True, text=True)
    # The command line shows the line of the file between the mistake and its help.
    first, *rest = str(found.value).splitlines()
    assert said.returncode == 2 and first in said.stderr
    assert rest == ['  help: did you mean "friction"?'] and '= help: did you mean "friction"?' in said.stderr
    mistake = found.value.mistakes[0]
    assert mistake["file"] == str(path) and mistake["line"] > 1 and mistake["key"].startswith("joints.dry")
    with pytest.raises(voussoir.StudyError, match="joints.dry.friction"):
        voussoir.run(with_(joints={"dry": {"law": "coulomb", "friction": -0.5}}))
    with pytest.raises(voussoir.StudyError, match="is null"):
        voussoir.run(with_(name=None))
    with pytest.raises(TypeError, match="a study cannot hold"):
        voussoir.run(with_(name=object()))
    with pytest.raises(ValueError):
        voussoir.run(with_(scene={**ARCH["scene"], "width": float("nan")}))
    with pytest.raises(FileNotFoundError):
        voussoir.run("there_is_none.toml")
    with pytest.raises(ValueError, match="there is no case 7"):
        voussoir.run(ARCH, cases=[7])


def test_figures_and_tables_show_themselves(tmp_path):
    results = voussoir.run(ARCH)
    figures = results.figures
    assert figures and all(figure._repr_svg_().lstrip().startswith("<svg") for figure in figures.values())
    assert "<td>collapse</td>" in results._repr_html_() and "698.0227" in results.table
    assert results.report.startswith("<!DOCTYPE html>")
    figure = next(iter(figures.values()))
    figure.save(tmp_path / "figure.svg")
    results.write(tmp_path / "out")
    assert voussoir.verify(tmp_path / "out") == []
    stored = json.loads((tmp_path / "out/results.json").read_text())
    stored["cases"][0]["load_factor"] *= 1.001
    (tmp_path / "out/results.json").write_text(json.dumps(stored))
    assert any("load_factor" in finding for finding in voussoir.verify(tmp_path / "out"))


def same(one, other):
    """Checks that two tables are equal bit by bit, except the running times of cases."""
    assert list(one) == list(other)
    for name in one:
        if name != "seconds":
            np.testing.assert_array_equal(np.array(one[name]), np.array(other[name]), err_msg=name)


def swept(count=12):
    return with_(
        sweep={
            "scene.profile.rise": {"from": 2.0, "to": 4.0, "count": count},
            "joints.dry.friction": {"list": [0.5, 0.6]},
        }
    )


def test_a_sweep_is_read_back_from_parquet_by_others(tmp_path):
    duckdb, polars = pytest.importorskip("duckdb"), pytest.importorskip("polars")
    table = voussoir.sweep(swept())
    path = tmp_path / "sweep.parquet"
    table.write_parquet(path)
    factors = list(table["load_factor"])
    assert polars.read_parquet(path)["load_factor"].to_list() == factors
    assert [row[0] for row in duckdb.sql(f"select load_factor from '{path}' order by id").fetchall()] == factors
    statuses = duckdb.sql(f"select status, count(*) from '{path}' group by status").fetchall()
    assert sum(count for _, count in statuses) == table.count


def test_tables_of_the_command_line_are_read_back_from_parquet(tmp_path):
    duckdb, polars = pytest.importorskip("duckdb"), pytest.importorskip("polars")
    run = lambda *words: subprocess.run([sys.executable, "-m", "voussoir", *words], cwd=tmp_path).returncode
    assert run("new", "arch") == 0
    # A table that is held in memory, and one that is written in several groups of rows.
    for count in (5, 5200):
        rises = f'sweep={{"scene.profile.rise"={{from=2.0, to=4.0, count={count}}}}}'
        sets = ["--set", rises, "--set", 'output.writers=["results_parquet"]', "--set", "output.figures=false"]
        assert run("run", "arch.toml", "--quiet", "--out", f"p{count}", *sets) == 0
        path = tmp_path / f"p{count}" / "results.parquet"
        cases = json.loads(path.with_name("results.json").read_text())["cases"]
        factors, passed = [c["load_factor"] for c in cases], [c["certificate"]["passed"] for c in cases]
        table = polars.read_parquet(path)
        assert table["load_factor [-]"].to_list() == factors and table["certificate_passed"].to_list() == passed
        read = duckdb.sql(f"select \"load_factor [-]\", certificate_passed from '{path}' order by id").fetchall()
        assert read == list(zip(factors, passed))


def test_sweeps_are_columns_and_the_same_whoever_works():
    pandas, polars = pytest.importorskip("pandas"), pytest.importorskip("polars")
    seen = []
    table = voussoir.sweep(swept(), progress=lambda done, of: seen.append((done, of)))
    assert table.count == 24 and seen[-1] == (24, 24)
    assert list(table)[:5] == ["id", "scene.profile.rise", "joints.dry.friction", "status", "load_factor"]
    whole = voussoir.run(swept())
    assert [case.load_factor for case in whole] == list(table["load_factor"])
    assert [case.case_hash for case in whole] == table["case_hash"]
    frame = pandas.DataFrame(table)
    assert frame.groupby("joints.dry.friction").load_factor.min().shape == (2,)
    assert polars.DataFrame(table).filter(polars.col("status") == "collapse").height == 24
    assert len(table.rows()) == 24 and "<table>" in table._repr_html_()
    with ProcessPoolExecutor(2) as pool:
        spread = voussoir.sweep(swept(), client=pool, chunk=5)
    same(spread, table)
    assert list(voussoir.sweep(swept(), jobs=2)["load_factor"]) == list(table["load_factor"])
    with pytest.raises(voussoir.StudyError, match="profile"):
        voussoir.sweep(swept(), set={"scene.profile.span": -1.0})
    with pytest.raises(ValueError, match="use voussoir.run"):
        voussoir.sweep({**swept(), "kind": "compare", "variants": [{"name": "a"}, {"name": "b"}]})


def test_progress_cancels_and_raises():
    events = []
    voussoir.run(swept(), progress=lambda event: events.append(event["event"]))
    assert events[0] == "begins" and events.count("answered") == 24
    some = voussoir.run(swept(200), progress=lambda event: event["event"] != "answered")
    assert 0 < len(some) < 400 and not some.certified

    def fails(event):
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        voussoir.run(swept(), progress=fails)


def test_ctrl_c_works_and_other_threads_go_on():
    long = swept(3000)
    del long["sweep"]["joints.dry.friction"]
    counted = [0]
    stop = threading.Event()

    def count():
        while not stop.is_set():
            counted[0] += 1
            time.sleep(0.001)

    thread = threading.Thread(target=count)
    # A process that a shell starts in the background ignores Ctrl-C.
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    thread.start()
    threading.Timer(1.0, lambda: signal.raise_signal(signal.SIGINT)).start()
    started = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        while time.monotonic() - started < 30.0:
            voussoir.sweep(long)
    assert time.monotonic() - started < 30.0
    signal.signal(signal.SIGINT, before)
    stop.set()
    thread.join()
    assert counted[0] > 20


@voussoir.law("test_friction")
class Friction:
    """Friction without tension."""

    units = {"friction": "-", "stiffness": "Pa/m"}

    def __init__(self, friction, stiffness=None):
        self.friction, self.stiffness = friction, stiffness

    def facets(self):
        mu = self.friction
        return [
            voussoir.Facet("opening", [-1, 0], 0.0),
            voussoir.Facet("sliding", [-mu, 1], 0.0),
            voussoir.Facet("sliding", [-mu, -1], 0.0),
        ]


@voussoir.law("test_unilateral")
class Unilateral:
    """No tension, unlimited elastic shear: t_n = k <-g_n>, t_t = -k g_t."""

    stiffness = [1e11, 1e11]

    def respond(self, gap, state):
        traction = -gap * self.stiffness
        opened = gap[:, 0] > 0.0
        traction[opened, 0] = 0.0
        return {"traction": traction, "state": state, "stored": np.sum(traction**2 / self.stiffness, axis=1) / 2}


@voussoir.law("test_limp")
class Limp(Unilateral):
    """No stiffness at the untouched state, so that a path cannot begin."""

    def respond(self, gap, state):
        return np.zeros_like(gap), state


def test_laws_written_in_python_are_those_of_the_tree():
    table = {"law": "python_facets", "class": "test_friction", "parameters": {"friction": 0.6}}
    own = voussoir.run(with_(joints={"dry": table}))[0]
    assert own.certified and own.load_factor == voussoir.run(ARCH)[0].load_factor
    # The same on a path from event to event.
    stiff = {"normal_stiffness": 1e10, "shear_stiffness": 1e10}
    table["parameters"]["stiffness"] = [1e10, 1e10]
    theirs = voussoir.run(elastic(law="coulomb_associated", friction=0.6, **stiff))[0]
    assert voussoir.run(elastic(**table))[0].load_factor == theirs.load_factor and theirs.certified


def test_a_response_in_python_ends_at_the_limit_load():
    own = voussoir.run(elastic(law="python_response", **{"class": "test_unilateral"}))[0]
    # Shear is elastic without limit, so the path ends at the collapse load of rigid blocks that cannot slide.
    rigid = voussoir.run(with_(scene=elastic()["scene"], joints={"dry": {"law": "unilateral", "tangential": "stuck"}}))[0]
    assert own.solver == "newton_path" and rigid.solver == "limit_chain"
    assert own.load_factor == pytest.approx(rigid.load_factor, rel=1e-6), own.notes


@voussoir.law("test_warm_maxwell")
class WarmMaxwell:
    """Springs with dampers in series, and a joint that widens with the temperature."""

    stiffness = [1e9, 1e9]
    state_names = ["creep n [m]", "creep t [m]"]
    fields = ["temperature"]
    retardation, widening = 3600.0, 1e-5

    def respond(self, gap, state, context):
        ends = [context.previous_fields["temperature"], context.fields["temperature"]]
        free = [np.stack([self.widening * (np.nan_to_num(end, nan=293.15) - 293.15), np.zeros_like(end)], axis=1) for end in ends]
        rate = (context.time_step / self.retardation)[:, None]
        creep = (state + rate * (gap - free[1])) / (1.0 + rate)
        strain = gap - free[1] - creep
        traction = -self.stiffness[0] * strain
        before = -self.stiffness[0] * (context.previous_gap - free[0] - state)
        return {
            "traction": traction,
            "state": creep,
            "stored": np.sum(self.stiffness[0] * strain**2, axis=1) / 2,
            "dissipated": -np.sum(traction * (creep - state), axis=1),
            "supplied": np.sum((traction + before) / 2 * (free[1] - free[0]), axis=1),
        }


def test_a_law_in_python_reads_time_and_fields():
    square = lambda y, size: [[-size / 2, y], [size / 2, y], [size / 2, y + size], [-size / 2, y + size]]
    study = {
        "name": "warm",
        "scene": {
            "scene": "blocks", "width": 1.0, "material": "stone", "joint": "dry",
            "blocks": [
                {"name": "ground", "fixed": True, "vertices": square(-1.0, 1.0)},
                {"name": "block", "vertices": square(0.0, 1.0)},
            ],
        },
        "materials": {"stone": {"law": "rigid", "density": 2000.0}},
        "joints": {"dry": {"law": "python_response", "class": "test_warm_maxwell"}},
        "stages": [
            {"name": "weight", "gravity": 10.0, "fields": {"temperature": 293.15}},
            {"name": "rest", "duration": 7200.0, "fields": {"temperature": 303.15}},
        ],
        "solver": {"solver": "newton_path"},
    }  # fmt: skip
    case = voussoir.run(study)[0]
    assert case.status == "stands" and case.certified, case.notes
    # Under a constant weight of 20 kN a Maxwell joint closes by W/(k A) (1 + T/τ), and 10 K widen it by 1e-4 m.
    assert case.displacements["displacement"][-1, 1] == pytest.approx(-20e3 / 1e9 * (1 + 2.0) + 1e-4, rel=1e-6)


class Sheared:
    """Elastic in both directions, with friction and no tension."""

    units = {"friction": "-", "normal": "Pa/m", "shear": "Pa/m"}
    sources = ["Coulomb 1773"]
    claims = ["dissipative"]
    state_names = ["slip [m]"]
    branches = ["elastic", "open", "dissipating"]
    known_paths = [{
        "source": "by hand: 1 MPa of pressure carries 0.5 MPa of shear; back by 1e-4 m elastically",
        "steps": [
            ((-1e-4, 0.0), (1e6, 0.0)),
            ((-1e-4, 2e-4), (1e6, -0.5e6)),
            ((-1e-4, 1.5e-4), (1e6, 0.0)),
        ],
    }]  # fmt: skip

    def __init__(self, friction, normal, shear):
        self.friction, self.stiffness = friction, [normal, shear]

    def respond(self, gap, state):
        normal = np.maximum(-self.stiffness[0] * gap[:, 0], 0.0)
        trial = -self.stiffness[1] * (gap[:, 1] - state[:, 0])
        shear = np.clip(trial, -self.friction * normal, self.friction * normal)
        slip = gap[:, 1] + shear / self.stiffness[1]
        stored = normal**2 / self.stiffness[0] / 2 + shear**2 / self.stiffness[1] / 2
        dissipated = np.abs(shear * (slip - state[:, 0]))
        # Without this line rounding counts as slip.
        held = np.abs(trial) <= self.friction * normal
        slip, dissipated = np.where(held, state[:, 0], slip), np.where(held, 0.0, dissipated)
        closed = gap[:, 0] <= 0.0
        tangent = np.zeros((len(gap), 2, 2))
        tangent[:, 0, 0] = np.where(closed, -self.stiffness[0], 0.0)
        tangent[:, 1, 1] = np.where(closed & held, -self.stiffness[1], 0.0)
        tangent[:, 1, 0] = np.where(closed & ~held, -self.friction * np.sign(trial) * self.stiffness[0], 0.0)
        return {
            "traction": np.stack([normal, shear], axis=1), "state": slip[:, None], "stored": stored,
            "dissipated": dissipated, "tangent": tangent,
        }  # fmt: skip


class Forgetful(Sheared):
    """It does not store its slip."""

    def respond(self, gap, state):
        return {**super().respond(gap, state), "state": state}


def test_conformance_of_laws_in_python():
    keys = {"friction": 0.5, "normal": 1e10, "shear": 1e10}
    report = voussoir.conform(Sheared, **keys)
    assert report.passed and report.done["tangent"] > 1000 and report.done["units"] > 1000, report
    report = voussoir.conform(Forgetful, **keys)
    assert not report.passed and {"regions", "known_path"} <= {finding.check for finding in report.findings}, report
    study = next(finding.study for finding in report.findings if finding.study)
    assert 'law = "python_response"' in study
    assert voussoir.conform(Friction, friction=0.6).findings[0].check == "card"  # it names no source
    assert voussoir.conform("coulomb").passed
    both = voussoir.conform("point")  # a load and a study kind
    assert both.passed and both.kind == "load kind, study kind" and both.done["verify"] == 1, both
    with pytest.raises(ValueError, match="no plug-in has the tag"):
        voussoir.conform("coulom")
    with pytest.raises(ValueError, match='gives no unit for "friction"'):
        voussoir.conform(type("Unitless", (Sheared,), {"units": {}}), **keys)
    with pytest.raises(ValueError, match="no unit of a key"):
        voussoir.conform(type("Barred", (Sheared,), {"units": {**Sheared.units, "normal": "bar/m"}}), **keys)


def test_mistakes_in_laws_are_told():
    def wrong(**joint):
        with pytest.raises(voussoir.StudyError) as found:
            voussoir.check(with_(joints={"dry": joint}))
        return str(found.value)

    assert "no class is registered" in wrong(law="python_facets", **{"class": "nobody"})
    assert "cannot be made" in wrong(law="python_facets", parameters={"x": 1}, **{"class": "test_friction"})
    assert "is not stiff" in wrong(law="python_response", **{"class": "test_limp"})
    assert "stiffness" in wrong(law="python_response", parameters={"friction": 0.6}, **{"class": "test_friction"})
    with pytest.raises(ValueError, match="a facet is"):
        voussoir.Facet("closing", [1, 0], 0.0)
    with pytest.raises(ValueError, match="not negative"):
        voussoir.Facet("sliding", [1, 0], -1.0)


def test_schema_plugins_and_the_command_line(tmp_path):
    assert voussoir.schema()["title"] == "Voussoir study"
    assert "python_facets" in voussoir.plugins("laws") and "limit_chain" in voussoir.plugins()
    assert voussoir.check(ARCH)["count"] == 1
    run = lambda *words: subprocess.run([sys.executable, "-m", "voussoir", *words], capture_output=True, text=True, cwd=tmp_path)
    assert run("new", "arch").returncode == 0
    ran = run("run", "arch.toml", "--json")
    assert ran.returncode == 0 and json.loads(ran.stdout)["load_factor"] == voussoir.run(ARCH)[0].load_factor
    assert run("verify", "results/arch").returncode == 0
    assert run("rum").returncode == 2 and run("--version").stdout.startswith(f"voussoir {voussoir.__version__}")


def test_a_point_study():
    joint = {"law": "coulomb_associated", "friction": 0.6, "normal_stiffness": 1e10, "shear_stiffness": 1e10}
    path = [{"steps": 1, "traction": {"n": 1e6}}, {"steps": 10, "gap": {"t": -1e-3}}]
    study = {"name": "p", "kind": "point", "joints": {"dry": joint}, "point": {"joint": "dry", "path": path}}
    case = voussoir.run(study)[0]
    assert case.rows.shape == (12, len(case.columns)) and case.certified
    sheared = case.rows[:, case.columns.index("traction_t [Pa]")]
    assert sheared[-1] == pytest.approx(0.6e6)
