"""Tests of stored results in Python: tables, plots and notebooks, with and without pandas and matplotlib."""

import base64
import json
import math
import subprocess
import sys
import xml.dom.minidom

import numpy as np
import pytest

import voussoir
from test_voussoir import ARCH, elastic, swept, with_


def stored(study, folder):
    """The results of a study, as run and as read from the folder that the run writes."""
    run = voussoir.run(study)
    run.write(folder)
    return run, voussoir.load(folder)


@pytest.fixture(scope="module")
def sweep(tmp_path_factory):
    return stored(swept(), tmp_path_factory.mktemp("sweep"))


@pytest.fixture(scope="module")
def chart():
    """Axes without a screen."""
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    from matplotlib import pyplot

    yield lambda: pyplot.subplots()[1]
    pyplot.close("all")


def test_a_folder_is_read_as_it_was_run(sweep):
    run, read = sweep
    assert read.raw == run.raw and len(read) == 24 and read.name == "arch" and read.certified
    assert dict(read.files) == run.files and read.answer == run.answer
    assert list(read.figures) == list(run.figures) and read.case(3).load_factor == run.case(3).load_factor
    assert read.worst.load_factor == min(case.load_factor for case in run) and "load_factor" in read.table


def test_folders_that_are_no_results_are_refused(tmp_path):
    with pytest.raises(FileNotFoundError, match="it has no results.json"):
        voussoir.load(tmp_path)
    (tmp_path / "unfinished.jsonl").write_text("")
    with pytest.raises(FileNotFoundError, match="has not finished"):
        voussoir.load(tmp_path)
    for text in ("{", "[]", "{}", '{"format": 1, "cases": []}'):
        (tmp_path / "results.json").write_text(text)
        with pytest.raises(ValueError, match="is not a results file"):
            voussoir.load(tmp_path)
    (tmp_path / "results.json").write_text('{"format": 99, "cases": [], "study": "x"}')
    with pytest.raises(ValueError, match="format 99; this version reads format 1"):
        voussoir.load(tmp_path)
    with pytest.raises(FileNotFoundError):
        voussoir.load(tmp_path / "nothing")


def test_a_failed_certificate_is_not_hidden(tmp_path):
    run, _ = stored(ARCH, tmp_path)
    changed = json.loads(run.files["results.json"])
    changed["cases"][0]["certificate"]["passed"] = False
    (tmp_path / "results.json").write_text(json.dumps(changed))
    assert not voussoir.load(tmp_path).certified


def test_the_table_is_results_csv(sweep):
    pandas = pytest.importorskip("pandas")
    for results in sweep:
        table = results.df
        assert list(table) == results.files["results.csv"].decode().splitlines()[0].split(",")
        assert list(table["load_factor [-]"]) == [case.load_factor for case in results]
        assert table.attrs["units"]["scene.profile.rise [m]"] == "m" and "status" not in table.attrs["units"]
        assert list(table["certificate_passed"]) == [True] * 24 and table["hinge_joints"].iloc[0].split(" ")
        assert table.groupby("joints.dry.friction")["load_factor [-]"].min().shape == (2,)
        assert pandas.api.types.is_integer_dtype(table["id"])


def test_texts_that_look_like_numbers_stay_texts(tmp_path):
    pytest.importorskip("pandas")
    names = ["NA", "007", "true"]
    study = with_(variants=[{"name": name, "set": {"joints.dry.friction": 0.5}} for name in names])
    table = stored(study, tmp_path)[1].df
    assert list(table["variant"]) == names and table["flow_read_as"].isna().all()


def test_a_table_in_parquet_has_the_same_columns(tmp_path):
    pytest.importorskip("pandas"), pytest.importorskip("polars")
    both = {"writers": ["results_csv", "results_parquet"], "figures": False}
    by_csv = stored({**swept(), "output": both}, tmp_path / "csv")[1].df
    by_parquet = stored({**swept(), "output": {**both, "writers": ["results_parquet"]}}, tmp_path / "parquet")[1].df
    same = [name for name in by_csv if name != "seconds [s]"]
    assert list(by_parquet) == list(by_csv) and by_parquet.attrs == by_csv.attrs
    for name in same:
        assert list(by_parquet[name].dropna()) == list(by_csv[name].dropna()), name
    neither = stored({**ARCH, "output": {"writers": [], "figures": False}}, tmp_path / "neither")[1]
    with pytest.raises(ValueError, match='add "results_csv" to the writers'):
        neither.df


def test_missing_packages_are_named(sweep, monkeypatch, tmp_path):
    results = voussoir.run(ARCH)
    results.write(tmp_path)
    for name in ("pandas", "polars", "matplotlib"):
        monkeypatch.setitem(sys.modules, name, None)
    with pytest.raises(ImportError, match="pip install pandas"):
        results.df
    with pytest.raises(ImportError, match="pip install matplotlib"):
        results.plot()
    # All else works, in a new process too.
    assert "<table>" in results._repr_html_() and results.case(0).field["force"].shape[1] == 2
    code = (
        "import sys; sys.modules.update(dict.fromkeys(['pandas', 'polars', 'matplotlib']));"
        "import voussoir; r = voussoir.load(sys.argv[1]); print(len(r._repr_html_()) > 1000, r.answer)"
    )
    said = subprocess.run([sys.executable, "-c", code, str(tmp_path)], capture_output=True, text=True)
    assert said.stdout.startswith("True Collapse, λ = 698.0"), said


def test_plots_of_a_sweep(sweep, chart):
    for results in sweep:
        axes = results.plot(ax=chart())
        assert axes.get_xlabel() == "scene.profile.rise [m]" and len(axes.lines) == 2
        first = [case for case in results if case.parameters["joints.dry.friction"] == 0.5]
        drawn = dict(zip(*axes.lines[0].get_data()))
        assert drawn == {case.parameters["scene.profile.rise"]: case.load_factor for case in first}
        assert [text.get_text() for text in axes.get_legend().get_texts()] == ["friction = 0.5", "friction = 0.6"]
    with pytest.raises(ValueError, match="no map"):
        results.plot("map", ax=chart())
    with pytest.raises(ValueError, match="no curve"):
        results.plot("curve")
    with pytest.raises(ValueError, match="choose curve, map, mechanism, sweep"):
        results.plot("pie")
    with pytest.raises(ValueError, match="no variant 'x'"):
        results.plot(variant="x")
    # A refused plot leaves no empty figure.
    from matplotlib import pyplot

    before = pyplot.get_fignums()
    with pytest.raises(ValueError):
        results.plot("curve")
    assert pyplot.get_fignums() == before


def test_plots_of_a_curve(chart, tmp_path):
    study = elastic(law="unilateral", tangential="stuck")
    results = stored({**study, "output": {"curve": True}}, tmp_path)[1]
    axes = results.plot(ax=chart())
    np.testing.assert_array_equal(np.column_stack(axes.lines[0].get_data()), results[0].curve)
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("displacement [m]", "load_factor [-]")
    with pytest.raises(KeyError, match="no case 9"):
        results.plot("curve", case=9)


def test_plots_of_a_driven_point(chart, tmp_path):
    joint = {"law": "coulomb_associated", "friction": 0.6, "normal_stiffness": 1e10, "shear_stiffness": 1e10}
    path = [{"steps": 1, "traction": {"n": 1e6}}, {"steps": 10, "gap": {"t": -1e-3}}]
    study = {"name": "p", "kind": "point", "joints": {"dry": joint}, "point": {"joint": "dry", "path": path}}
    results = stored(study, tmp_path)[1]
    axes = results.plot(ax=chart())
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("gap_t [m]", "traction_t [Pa]")
    assert axes.lines[0].get_ydata()[-1] == pytest.approx(0.6e6)
    with pytest.raises(ValueError, match="has no blocks"):
        results.plot("mechanism", case=0, ax=chart())


def test_plots_of_a_map(chart, tmp_path):
    weak = {"name": "weak", "set": {"joints.dry.friction": 0.4}}
    axes_of = {"scene.profile.rise": {"list": [2.0, 2.5, 3.0]}, "scene.thickness": {"list": [0.5, 0.6]}}
    study = with_(kind="map", variants=[{"name": "dry"}, weak], sweep=axes_of, output={"figures": False})
    results = stored(study, tmp_path)[1]
    axes = results.plot(ax=chart())
    drawn = axes.collections[0].get_array()
    factors = {(case.variant, *case.parameters.values()): case.load_factor for case in results}
    for i, rise in enumerate([2.0, 2.5, 3.0]):
        for j, thickness in enumerate([0.5, 0.6]):
            ratio = factors["weak", rise, thickness] / factors["dry", rise, thickness]
            assert drawn[j][i] == pytest.approx(ratio, rel=1e-12)
    loads = results.plot("map", variant="dry", ax=chart()).collections[0].get_array()
    assert loads[1][2] == factors["dry", 3.0, 0.6]
    with pytest.raises(ValueError, match="give the id of a case"):
        results.plot("mechanism", ax=chart())


def test_plots_of_an_envelope(chart, tmp_path):
    envelope = {"parameter": "stages.1.loads.0.span_fraction", "from": 0.1, "to": 0.5, "scan": 5}
    results = stored(with_(kind="envelope", envelope=envelope), tmp_path)[1]
    worst = results.raw["worsts"][0]
    assert results.worst.id == worst["case"] and results.worst.load_factor == worst["result"]
    axes = results.plot(ax=chart())
    assert axes.lines[-1].get_xydata().tolist() == [[worst["value"], worst["result"]]]
    assert results.plot("mechanism", ax=chart()).get_title().startswith(f"case {worst['case']}: collapse")


def test_plots_of_a_mechanism(chart, tmp_path):
    run, read = stored(ARCH, tmp_path)
    for results in (run, read):
        blocks = results.blocks(0)
        assert [block.name for block in blocks] == [body["body"] for body in results[0].raw["motion"]]
        # The bridge of the tree: fifteen voussoirs between two supports.
        assert sum(not block.fixed for block in blocks) == 15
        # The first support has no shape.
        shown = [block for block in blocks if len(block.vertices)]
        axes = results.plot("mechanism", ax=chart())
        assert len(axes.lines) == 4, "one mark for each hinge"
        assert len(axes.patches) == len(shown) + 15
    # Blocks are rigid: their corners keep their distances.
    from voussoir._plot import moved

    corners, centre = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 2.0]]), np.array([0.5, 1.0])
    for twist in ([0.1, 0.2, 0.0], [0.1, 0.2, 1e-9], [0.0, 0.0, math.pi / 2]):
        away = moved(corners, centre, np.array(twist))
        sides = np.linalg.norm(np.diff(away, axis=0), axis=1)
        np.testing.assert_allclose(sides, [1.0, 2.0], rtol=1e-12)
    np.testing.assert_allclose(moved(corners, centre, np.array([0.0, 0.0, math.pi / 2]))[0], [1.5, 0.5], atol=1e-12)
    with pytest.raises(ValueError, match="not a case"):
        voussoir._voussoir.blocks(("toml", read.files["resolved.toml"].decode(), "", []), "{}")


def test_notebooks_show_answer_picture_and_table(sweep, tmp_path):
    for results in (*sweep, voussoir.run(ARCH)):
        shown = results._repr_html_()
        assert shown.index(results.answer[:20]) < shown.index("<img") < shown.index("<table>")
        picture = base64.b64decode(shown.split("base64,")[1].split('"')[0])
        assert xml.dom.minidom.parseString(picture).documentElement.tagName == "svg"
    assert "24 cases, of which 20 are shown" in sweep[1]._repr_html_()
    hostile = with_(variants=[{"name": "<img src=x onerror=1>"}])
    text = voussoir.run(hostile)._repr_html_()
    assert "&lt;img src=x" in text and "<img src=x" not in text


def test_figures_of_studies_in_a_report_keep_apart(tmp_path):
    run, read = stored(ARCH, tmp_path)
    (tmp_path / "part/figures").mkdir(parents=True)
    (tmp_path / "part/figures/scene.svg").write_text("<svg/>")
    (tmp_path / "figures/scene.svg").write_text("<svg></svg>")
    figures = voussoir.load(tmp_path).figures
    assert figures["part/scene"].svg == "<svg/>" and figures["scene"].svg == "<svg></svg>"
