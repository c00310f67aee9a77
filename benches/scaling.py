#!/usr/bin/env python3
"""How run time and memory grow, and what each reduction is worth: whole processes of `voussoir run`.

    cargo build --release -p voussoir
    python3 benches/scaling.py [--voussoir target/release/voussoir] [--most 1e5] [--runs 2]

writes docs/notebook/scaling.csv and docs/notebook/scaling.svg, and from the CSV the part of docs/notebook/performance.md between its two marks. With
`--page` nothing is measured: the page is written from the CSV as it is. Processor time is user + system of the process; least of
`--runs`. Needs nothing but Python.
"""

import argparse
import math

from measured import ROOT, circumstances, read_rows, run, short, write_part, write_rows
from studies import NO_WRITERS, RIGID, RING, friction, ring, square, sweep

TABLE, FIGURE = ROOT / "docs/notebook/scaling.csv", ROOT / "docs/notebook/scaling.svg"
KEYS = ["part", "name", "size", "seconds", "memory_mb", "factor", "status", "date", "machine", "commit"]

FRICTION = friction(RING["friction"])


def arch(voussoirs=13, joint=FRICTION, material=RIGID, solver="auto", mesh="", sweep="", output=NO_WRITERS):
    return ring(voussoirs, joint, more=mesh, material=material, solver=solver, width=5.81, output=output, rest=sweep, name="arch")


ELASTIC = 'law = "elastic"\nyoung_modulus = 5e9\npoisson_ratio = 0.3'
COMPLIANT = 'law = "coulomb_associated"\nfriction = 0.6\nnormal_stiffness = 2e10\nshear_stiffness = 8e9'
SIZES = {
    "voussoirs, `limit_chain`": ([10, 100, 1000, 10_000, 100_000], lambda n: arch(n)),
    "voussoirs, `limit_conic`": ([10, 100, 1000, 10_000, 100_000], lambda n: arch(n, solver="limit_conic")),
    "bricks, `limit_conic`": ([100, 400, 1024, 2500, 10_000], lambda n: square(math.isqrt(n))),
    "compliant joints, `event_path`": ([10, 30, 100, 300], lambda n: arch(n, COMPLIANT, solver="event_path")),
    "compliant joints, `newton_path`": ([10, 30, 100, 300], lambda n: arch(n, COMPLIANT, solver="newton_path")),
    "elastic voussoirs, `event_path`": ([10, 30, 100], lambda n: arch(n, material=ELASTIC, solver="event_path")),
    "elastic voussoirs, `newton_path`": ([10, 30, 100], lambda n: arch(n, material=ELASTIC, solver="newton_path")),
}


FINE = arch(100, material=ELASTIC, mesh="mesh = { elements = [4, 6], order = 2 }", solver="event_path")

# What a study may be spared, and the same question with it: name, spared, not spared.
REDUCTIONS = [
    ("an arch is a chain: `limit_chain`, not `limit_conic`, 1000 voussoirs", arch(1000), arch(1000, solver="limit_conic")),
    ("blocks are rigid where the load does not depend on their stiffness", arch(), arch(material=ELASTIC, solver="event_path")),
    ("no sliding rows where friction is never reached", arch(1000, 'law = "unilateral"', solver="limit_conic"), arch(1000, 'law = "coulomb_associated"\nfriction = 1e3', solver="limit_conic")),
    ("a mesh of 2 × 3 elements where any gives the same load", arch(material=ELASTIC, mesh="mesh = { elements = [2, 3], order = 2 }", solver="event_path"), arch(material=ELASTIC, mesh="mesh = { elements = [4, 6], order = 2 }", solver="event_path")),
    ("from event to event instead of in steps, 13 elastic voussoirs", arch(material=ELASTIC, solver="event_path"), arch(material=ELASTIC, solver="newton_path")),
    ("forces and motions are not written where nobody reads them, 10 000 voussoirs", arch(10_000, output=f"{NO_WRITERS}\nfields = false"), arch(10_000)),
    ("no report and no figures where nobody looks at them", arch(), arch(output="")),
    ("figures of the worst case, not of all, of 200", arch(sweep=sweep(200), output='writers = ["figures"]\nfigures = "worst"'), arch(sweep=sweep(200), output='writers = ["figures"]\nfigures = "all"')),
    ("voussoirs of one shape are condensed once, 100 of them (their thickness varies by 1e-7 else)", FINE, FINE.replace("thickness = 0.6", "thickness = { crown = 0.6, springing = 0.6000001 }")),
]


def measured(program, most, runs):
    said = circumstances()

    def row(part, name, size, answer):
        seconds, memory, factor, status, _ = answer
        print(part, name, size, f"{seconds:.3f} s", f"{memory:.0f} MB", factor, status, flush=True)
        return dict(zip(KEYS, [part, name, size, f"{seconds:.4f}", f"{memory:.1f}", repr(factor), status])) | said

    for name, (sizes, text) in SIZES.items():
        for size in sizes:
            if size <= most:
                yield row("growth", name, size, run(program, text(size), 1 if size >= 1e4 else runs))
    for name, with_it, without in REDUCTIONS:
        for size, text in [("with", with_it), ("without", without)]:
            yield row("reduction", name, size, run(program, text, runs))
    for count in [10, 100, 1000, 10_000]:
        for jobs in [1, 2]:
            answer = run(program, arch(sweep=sweep(count)), 1, jobs)
            yield row("cases", f"cases, {jobs} job{'s' * (jobs > 1)}", count, answer)


def exponent(rows):
    """Of the three greatest sizes, by least squares on logarithms."""
    rows = rows[-3:]
    x, y = [math.log(float(r["size"])) for r in rows], [math.log(float(r["seconds"])) for r in rows]
    mx, my = sum(x) / len(x), sum(y) / len(y)
    return sum((a - mx) * (b - my) for a, b in zip(x, y)) / sum((a - mx) ** 2 for a in x)


def by_name(rows, part):
    names = dict.fromkeys(r["name"] for r in rows if r["part"] == part)
    return {name: [r for r in rows if r["part"] == part and r["name"] == name] for name in names}


def tables(rows):
    first = rows[0]
    yield f"Made by `benches/scaling.py`. Whole processes of `voussoir run`, processor time (user and system), {first['date']}, commit {first['commit']},"
    yield f"{first['machine']} (one of several at work). Every answer but those of cases is certified. Raw: [scaling.csv](scaling.csv).\n"
    yield "| | size: seconds (MB) | exponent |\n|---|---|---|"
    for part in ["growth", "cases"]:
        for name, own in by_name(rows, part).items():
            sizes = "; ".join(f"{int(r['size']):,}: {short(r['seconds'])} ({short(r['memory_mb'])})".replace(",", " ") for r in own)
            yield f"| {name} | {sizes} | {exponent(own):.2f} |"
    yield "\nExponents are fitted to the three greatest sizes.\n\n![Processor time over size](scaling.svg)\n"
    yield "What a study is spared, against the same question with it:\n"
    yield "| reduction | with [s] | without [s] | worth | factors differ by |\n|---|---|---|---|---|"
    for name, own in by_name(rows, "reduction").items():
        a, b = own
        apart = abs(float(a["factor"]) / float(b["factor"]) - 1)
        yield f"| {name} | {short(a['seconds'])} | {short(b['seconds'])} | {float(b['seconds']) / float(a['seconds']):.1f} × | {apart:.0e} |"


def figure(rows):
    """Seconds over size, both logarithmic."""
    lines = {name: own for part in ["growth", "cases"] for name, own in by_name(rows, part).items()}
    points = [(float(r["size"]), float(r["seconds"])) for own in lines.values() for r in own]
    x0, x1 = 0.9, math.log10(max(p[0] for p in points)) + 0.1
    y0, y1 = math.floor(math.log10(min(p[1] for p in points))), math.ceil(math.log10(max(p[1] for p in points)))
    at = lambda size, seconds: (60 + 440 * (math.log10(size) - x0) / (x1 - x0), 330 - 310 * (math.log10(seconds) - y0) / (y1 - y0))
    colours = ["#1b6ca8", "#c8553d", "#2a9d8f", "#8e5ea2", "#e09f3e", "#555555", "#7fb069", "#d1495b", "#30638e"]
    yield '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 760 380" font-family="sans-serif" font-size="12">'
    yield '<rect width="760" height="380" fill="white"/>'
    for power in range(1, int(x1) + 1):
        x = at(10**power, 1)[0]
        yield f'<path d="M{x:.1f} 20V330" stroke="#ddd"/><text x="{x:.1f}" y="347" text-anchor="middle">1e{power}</text>'
    for power in range(y0, y1 + 1):
        y = at(10, 10**power)[1]
        yield f'<path d="M60 {y:.1f}H500" stroke="#ddd"/><text x="54" y="{y + 4:.1f}" text-anchor="end">1e{power}</text>'
    yield '<text x="280" y="368" text-anchor="middle">number</text>'
    yield '<text x="16" y="175" text-anchor="middle" transform="rotate(-90 16 175)">processor time [s]</text>'
    for (name, own), colour, row in zip(lines.items(), colours, range(20)):
        path = [at(float(r["size"]), float(r["seconds"])) for r in own]
        yield f'<polyline fill="none" stroke="{colour}" stroke-width="2" points="{" ".join(f"{x:.1f},{y:.1f}" for x, y in path)}"/>'
        yield from (f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3" fill="{colour}"/>' for x, y in path)
        yield f'<path d="M515 {36 + 22 * row}h18" stroke="{colour}" stroke-width="2"/><text x="538" y="{40 + 22 * row}">{name.replace("`", "")}</text>'
    yield "</svg>"


def main():
    options = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    options.add_argument("--voussoir", default=str(ROOT / "target/release/voussoir"))
    options.add_argument("--most", type=float, default=1e5, help="no greater sizes")
    options.add_argument("--runs", type=int, default=2)
    options.add_argument("--page", action="store_true", help="only write the page from the CSV")
    given = options.parse_args()
    if not given.page:
        write_rows(TABLE, KEYS, measured(given.voussoir, given.most, given.runs))
    rows = read_rows(TABLE)
    FIGURE.write_text("\n".join(figure(rows)) + "\n")
    write_part("scaling", tables(rows))


if __name__ == "__main__":
    main()
