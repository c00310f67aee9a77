#!/usr/bin/env python3
"""What is asked of run times, all measured in one session beside the peers that are installed.

    cargo build --release -p voussoir
    python3 benches/goals.py [--voussoir target/release/voussoir] [--runs 3] [--only WORDS]

writes docs/notebook/goals.csv and from it the part of docs/notebook/performance.md between its two marks; with `--page` nothing is measured. Whole
processes of `voussoir run` are measured as in `scaling.py`, certified cases in memory by `voussoir bench`. Peers are those of
`peers/`, which say what they need; without them their columns stay empty. Processor time, least of `--runs`, peers by turns.
"""

import argparse
import importlib.metadata
import json
import subprocess
import sys
from pathlib import Path

from measured import ROOT, circumstances, read_rows, run, short, write_part, write_rows
from studies import NO_WRITERS, RING, friction, ring, square, sweep

TABLE = ROOT / "docs/notebook/goals.csv"
KEYS = ["work", "seconds", "memory_mb", "answer", "certified", "peer", "peer_seconds", "peer_error", "least", "most_seconds", "most_mb", "date", "machine", "commit"]

ELASTIC = 'law = "elastic"\nyoung_modulus = 15e9\npoisson_ratio = 0.3'
ASSOCIATED, COULOMB = friction(RING["friction"]), friction(RING["friction"], "coulomb")
ELASTIC_PATHS = "elastic ring of 13 to collapse, `{}`, certified"


def rigid(voussoirs, output=NO_WRITERS, rest=""):
    return ring(voussoirs, output=output, rest=rest)


def elastic(voussoirs, solver, joint=ASSOCIATED, elements="[4, 6]", grading=""):
    """The ring with nine-node elements, along a voussoir and across it."""
    mesh = f"mesh = {{ elements = {elements}, order = 2{grading} }}"
    return ring(voussoirs, joint, more=mesh, material=ELASTIC, solver=solver, output=NO_WRITERS)


def finite(voussoirs, joint, elements="[4, 6]", grading=""):
    text = elastic(voussoirs, "newton_path", joint, elements, grading)
    return text.replace('solver = "newton_path"', 'solver = "newton_path"\nkinematics = "finite"')


# Work, study, goal: most seconds, most megabytes; without one the time is reported only.
PROCESSES = [
    ("20 000 voussoirs, study file to certified result", lambda: rigid(20_000), 0.3, None),
    ("1 000 000 voussoirs, `fields = false`", lambda: rigid(1_000_000, f"{NO_WRITERS}\nfields = false"), 6, 2500),
    ("1 000 000 voussoirs, results.json streamed", lambda: rigid(1_000_000), 15, 3000),
    ("wall of 100 × 100 bricks", lambda: square(100), 15, None),
    ("elastic ring of 200, `event_path`", lambda: elastic(200, "event_path"), None, None),
    ("elastic ring of 200, `newton_path`", lambda: elastic(200, "newton_path"), None, None),
    ("elastic ring of 400, `event_path`", lambda: elastic(400, "event_path"), None, None),
    ("elastic ring of 400, `newton_path`", lambda: elastic(400, "newton_path"), None, None),
    ("finite displacements, ring of 13, 4 × 6", lambda: finite(13, COULOMB), 0.1, None),
    ("the same, sliding that dilates", lambda: finite(13, ASSOCIATED), 0.1, None),
    ("finite displacements, ring of 13, 8 × 12 graded", lambda: finite(13, COULOMB, "[8, 12]", ", grading = 8.0"), 1, None),
    ("the same, sliding that dilates, 8 × 12 graded", lambda: finite(13, ASSOCIATED, "[8, 12]", ", grading = 8.0"), 1, None),
    ("1000 cases of an arch", lambda: rigid(13, rest=sweep(1000)), 0.1, None),
]

# Work, scene of `peers/limit_load.py`, error of the peer, goal: least ratio.
LIMIT_LOADS = [
    ("limit load, 14 joints, certified", "ring:13", 1e-9, 8),
    ("limit load, 5001 joints, certified", "ring:5000", 1e-9, 20),
    ("wall of 10 × 10 bricks, certified", "wall:10", 1e-6, 2),
    ("wall of 20 × 20 bricks, certified", "wall:20", 1e-6, 2),
    ("wall of 40 × 40 bricks, certified", "wall:40", 1e-6, 2),
]


def beside_piqp(program, rounds, wanted):
    """Certified limit loads in memory, and PIQP's time to the error asked for."""
    sys.path.append(str(ROOT / "benches/peers"))
    import limit_load
    from contestants import CONTESTANTS

    package, solve = CONTESTANTS["PIQP"]
    peer = f"PIQP {importlib.metadata.version(package)}"
    for work, word, error, least in LIMIT_LOADS:
        if not wanted(work):
            continue
        scene = limit_load.scene_of(word)
        reference, results = limit_load.measure(scene, program, {"PIQP": solve}, rounds)
        own = min(seconds for seconds, _ in results["Voussoir, certified"])
        reached = [found for found in results["PIQP"] if found[1] <= error]
        seconds, off = min(reached) if reached else ("", min(found[1] for found in results["PIQP"]))
        yield {"work": work, "seconds": own, "answer": reference, "certified": True, "peer": f"{peer} to {error:g}", "peer_seconds": seconds, "peer_error": off, "least": least}


def beside_getfem(program, rounds):
    """Both paths of the elastic ring of 13 in memory and GetFEM's least time to 1e-3 on the same mesh, by a Python that has it."""
    code = f"""import json, sys; sys.path.append({str(ROOT / "benches/peers")!r})
import elastic_path as path
solvers = ["event_path", "newton_path"]
factors = {{s: path.by_voussoir({program!r}, path.elastic(13, s))[0] for s in solvers}}
print(json.dumps([factors, path.measure(13, {program!r}, True, {rounds})[1]]))"""
    for python in [sys.executable, "/usr/bin/python3"]:
        said = subprocess.run([python, "-c", code], capture_output=True, text=True)
        if said.returncode:
            continue
        factors, results = json.loads(said.stdout.splitlines()[-1])
        seconds, error = min(found for found in results["GetFEM, best setting"] if found[1] <= 1e-3)
        for solver, factor in factors.items():
            own, _ = min(results[f"{solver}, certified"])
            work = ELASTIC_PATHS.format(solver)
            peer = {"peer": "GetFEM 5.4.2 to 0.001", "peer_seconds": seconds, "peer_error": error}
            yield {"work": work, "seconds": own, "answer": factor, "certified": True} | peer
        return
    print("GetFEM is not installed, left out (Debian: python3-getfem, for /usr/bin/python3)")


def measured(program, runs, wanted):
    said = circumstances()

    def row(found):
        print(found["work"], found["seconds"], found["answer"], flush=True)
        return dict.fromkeys(KEYS, "") | found | said

    # Processes first: memory of this one, which grows by what peers import, counts for those that it starts.
    for work, text, most_seconds, most_mb in PROCESSES:
        if wanted(work):
            seconds, memory, factor, _, certified = run(program, text(), runs)
            found = {"work": work, "seconds": seconds, "memory_mb": memory, "answer": factor, "certified": certified}
            yield row(found | {"most_seconds": most_seconds, "most_mb": most_mb})
    if wanted(ELASTIC_PATHS):
        yield from map(row, beside_getfem(program, runs))
    try:
        yield from map(row, beside_piqp(program, runs, wanted))
    except ImportError as missing:
        print(f"{missing}: no limit loads beside PIQP")


def verdict(row):
    """The goal of a row in words, and how far it is met."""
    if row["least"]:
        if not row["peer_seconds"]:
            return f"{row['least']} ×", "peer missing" if not row["peer"] else "never as exact: met"
        ratio = float(row["peer_seconds"]) / float(row["seconds"])
        return f"≥ {row['least']} ×", f"{ratio:.3g} ×, " + ("met" if ratio >= float(row["least"]) else f"missed by {float(row['least']) / ratio:.2g}")
    goals, within = [], []
    for key, most, unit in [("seconds", "most_seconds", "s"), ("memory_mb", "most_mb", "MB")]:
        if row[most]:
            goals.append(f"{row[most]} {unit}")
            within.append(float(row[key]) / float(row[most]))
    if not within:
        ratio = float(row["peer_seconds"]) / float(row["seconds"]) if row["peer_seconds"] else None
        return "", f"{ratio:.3g} ×" if ratio else ""
    return ", ".join(goals), "met" if max(within) <= 1 else f"missed by {max(within):.2g}"


def tables(rows):
    first = rows[0]
    yield f"Made by `benches/goals.py` in one session, {first['date']}, commit {first['commit']}, {first['machine']}. Processor time; whole processes from study"
    yield "file to results, limit loads beside PIQP in memory with scene and certificate. Raw: [goals.csv](goals.csv).\n"
    yield "| work | time | memory | answer, certified | peer | goal | |\n|---|---|---|---|---|---|---|"
    for row in rows:
        seconds = float(row["seconds"])
        time = f"{short(1e3 * seconds)} ms" if seconds < 1 else f"{short(seconds)} s"
        memory = f"{float(row['memory_mb']):.0f} MB" if row["memory_mb"] else ""
        peer = row["peer"]
        if row["peer_seconds"]:
            peer += f": {short(1e3 * float(row['peer_seconds']))} ms, error {float(row['peer_error']):.0e}"
        elif peer:
            peer += f": never ({float(row['peer_error']):.0e})"
        answer = f"{float(row['answer']):.12g}" if row["answer"] else ""
        yield f"| {row['work']} | {time} | {memory} | {answer}{', yes' if row['certified'] == 'True' else ', NO'} | {peer} | {' | '.join(verdict(row))} |"


def main():
    options = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    options.add_argument("--voussoir", default=str(ROOT / "target/release/voussoir"))
    options.add_argument("--runs", type=int, default=3)
    options.add_argument("--only", default="", help="works whose name contains this; others stay as the CSV has them")
    options.add_argument("--page", action="store_true", help="only write the page from the CSV")
    given = options.parse_args()
    program = str(Path(given.voussoir).resolve())
    if not given.page:
        found = list(measured(program, given.runs, lambda work: given.only in work))
        known = {row["work"]: row for row in (read_rows(TABLE) if TABLE.exists() else [])} | {row["work"]: row for row in found}
        paths = [[ELASTIC_PATHS.format(solver)] for solver in ["event_path", "newton_path"]]
        order = [entry[0] for entry in LIMIT_LOADS + paths + PROCESSES]
        write_rows(TABLE, KEYS, [known[work] for work in order if work in known])
    write_part("goals", tables(read_rows(TABLE)))


if __name__ == "__main__":
    main()
