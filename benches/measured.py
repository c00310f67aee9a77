"""Whole processes of `voussoir run` measured, and pages written from the CSV of what was measured. Needs nothing but Python."""

import csv
import json
import os
import platform
import subprocess
import sys
import tempfile
from datetime import date
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs/notebook/performance.md"
# Of the first case, by another process: what this one has in memory counts for those that it starts.
FIRST = """import json, sys
case = json.load(open(sys.argv[1]))["cases"][0]
print(json.dumps([case.get("load_factor"), case["status"], case["certificate"]["passed"]]))"""


def run(program, text, runs, jobs=1):
    """Least processor time (user and system), memory in MB, and the first case's load factor, status and certificate."""
    best = None
    with tempfile.TemporaryDirectory() as folder:
        study = Path(folder, "study.toml")
        study.write_text(text)
        for turn in range(runs):
            out = Path(folder, str(turn))
            command = [program, "run", study, "--out", out, "--quiet", "--jobs", str(jobs)]
            process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            _, _, used = os.wait4(process.pid, 0)
            seconds = used.ru_utime + used.ru_stime
            if best is None or seconds < best[0]:
                best = seconds, used.ru_maxrss / 1024
        said = subprocess.run([sys.executable, "-c", FIRST, out / "results.json"], capture_output=True, check=True)
    return *best, *json.loads(said.stdout)


def circumstances():
    """Date, machine and commit."""
    commit = subprocess.run(["git", "rev-parse", "--short", "HEAD"], cwd=ROOT, capture_output=True, text=True).stdout.strip()
    machine = f"{platform.machine()}, {os.cpu_count()} cores, load {os.getloadavg()[0]:.0f}"
    return {"date": date.today().isoformat(), "machine": machine, "commit": commit}


def write_rows(table, keys, rows):
    with table.open("w", newline="") as file:
        writer = csv.DictWriter(file, keys, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def read_rows(table):
    with table.open(newline="") as file:
        return list(csv.DictReader(file))


def write_part(name, lines):
    """The part of the page between the marks of a CSV."""
    begin, end = f"<!-- from {name}.csv: benches/{name}.py -->", f"<!-- end of {name}.csv -->"
    before, rest = PAGE.read_text().split(begin)
    PAGE.write_text(before + begin + "\n" + "\n".join(lines) + "\n" + end + rest.split(end)[1])


def short(x):
    return f"{float(x):.2g}" if float(x) < 10 else f"{float(x):.0f}"
