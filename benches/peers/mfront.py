"""Behaviours that MFront writes and compiles, run as `law = "external"`, against Hooke's law and `mohr_coulomb_solid`.

    python3 mfront.py --voussoir ../../target/release/voussoir

Voussoir must be compiled with `--features external`; `mfront` and `tfel-config` of TFEL 4 or later must be on the path (TFEL is in no
registry of Debian or PyPI: https://github.com/thelfer/tfel, cmake and make). Without them the script says so and ends well.

Both laws go through the same 24 steps of strain and stress; told is the greatest difference of a stress from the other route's,
relative to the greatest stress of the step.
"""

import argparse
import csv
import shutil
import subprocess
import tempfile
from pathlib import Path

YOUNG, POISSON, COHESION, FRICTION, DILATANCY = 5e9, 0.3, 1e6, 40.0, 10.0
BEHAVIOURS = {
    "ElasticityOfHooke": """@DSL Default;
@Behaviour ElasticityOfHooke;
@UnitSystem SI;
@ModellingHypothesis Tridimensional;
@MaterialProperty stress young;
young.setGlossaryName("YoungModulus");
@MaterialProperty real nu;
nu.setGlossaryName("PoissonRatio");
@ProvidesSymmetricTangentOperator;
@Integrator {
  const auto lambda = computeLambda(young, nu);
  const auto mu = computeMu(young, nu);
  sig = lambda * trace(eto + deto) * StrainStensor::Id() + 2 * mu * (eto + deto);
  if (computeTangentOperator_) {
    Dt = lambda * Stensor4::IxI() + 2 * mu * Stensor4::Id();
  }
}
""",
    # Abbo and Sloan (1995): corners rounded beyond 29 degrees of Lode's angle, the apex by 1 Pa.
    "RoundedMohrCoulomb": f"""@DSL Implicit;
@Behaviour RoundedMohrCoulomb;
@UnitSystem SI;
@ModellingHypothesis Tridimensional;
@Algorithm NewtonRaphson;
@Epsilon 1e-14;
@Theta 1;
@Brick StandardElastoViscoPlasticity {{
  stress_potential : "Hooke" {{young_modulus : {YOUNG}, poisson_ratio : {POISSON}}},
  inelastic_flow : "Plastic" {{
    criterion : "MohrCoulomb" {{c : {COHESION}, phi : 0.6981317007977318, lodeT : 0.506145483078356, a : 1}},
    flow_criterion : "MohrCoulomb" {{c : {COHESION}, phi : 0.17453292519943295, lodeT : 0.506145483078356, a : 1}},
    isotropic_hardening : "Linear" {{R0 : "0"}}
  }}
}};
""",
}
STUDY = """name = "point"
kind = "point"
[materials.stone]
{law}
density = 2200.0
[point]
material = "stone"
[[point.path]]
steps = 4
stress = {{ xx = -5e5, yy = -5e5, zz = -5e5 }}
[[point.path]]
steps = 8
strain = {{ xx = -1.5e-3, yy = 5e-4, zz = 0.0, xy = 8e-4, yz = 2e-4, zx = -1e-4 }}
[[point.path]]
steps = 4
strain = {{ xx = -1.0e-3 }}
[[point.path]]
steps = 8
strain = {{ xx = -2.5e-3, yy = 1.5e-3, xy = -1e-3 }}
"""
OWN = f"""law = "mohr_coulomb_solid"
young_modulus = {YOUNG}
poisson_ratio = {POISSON}
cohesion = {COHESION}
friction_angle = {FRICTION}
dilatancy_angle = {DILATANCY}
tensile_strength = 1.19e6"""
NAMES = ("xx", "yy", "zz", "xy", "yz", "zx")


def compiled(folder):
    """Name → library, made by MFront below this folder; nothing where it is not installed."""
    if not (shutil.which("mfront") and shutil.which("tfel-config")):
        return {}
    said = subprocess.run(["mfront", "--version"], capture_output=True, text=True).stdout
    print("MFront:", next((line for line in said.splitlines() if "ersion" in line), "of no version"))
    libraries = {}
    for name, text in BEHAVIOURS.items():
        own = folder / name
        own.mkdir()
        (own / f"{name}.mfront").write_text(text)
        command = ["mfront", "--obuild", "--interface=generic", f"{name}.mfront"]
        subprocess.run(command, cwd=own, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        libraries[name] = next((own / "src").glob("lib*.so"))
    return libraries


def driven(program, folder, law, library=None):
    """Rows of the driven point."""
    study, out = folder / "point.toml", folder / "out"
    shutil.rmtree(out, ignore_errors=True)
    study.write_text(STUDY.format(law=law))
    allowed = ["--allow-library", str(library)] if library else []
    subprocess.run([program, "run", str(study), *allowed, "--out", str(out), "--quiet"], check=True)
    with open(out / "results.csv", newline="") as file:
        return list(csv.DictReader(file))


def of(row, what, unit):
    return [float(row[f"{what}_{name} [{unit}]"]) for name in NAMES]


def hooke(row):
    """Stresses from the row's strains, shears being engineering strains."""
    strain = of(row, "strain", "-")
    twice = YOUNG / (1 + POISSON)
    spherical = YOUNG * POISSON / ((1 + POISSON) * (1 - 2 * POISSON)) * sum(strain[:3])
    return [spherical + twice * e for e in strain[:3]] + [twice / 2 * e for e in strain[3:]]


def difference(rows, expected):
    worst = 0.0
    for row, right in zip(rows, expected, strict=True):
        size = max(map(abs, right))
        if size > 0:
            worst = max(worst, max(abs(a - b) for a, b in zip(of(row, "stress", "Pa"), right)) / size)
    return worst


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--voussoir", default="voussoir", help="the program, with its feature `external`")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        libraries = compiled(folder)
        if not libraries:
            print("mfront and tfel-config are not on the path: nothing was compared")
            return
        external = 'law = "external"\nlibrary = "{}"\nbehaviour = "{}"'
        library = libraries["ElasticityOfHooke"]
        law = external.format(library, "ElasticityOfHooke") + f"\nproperties = {{ YoungModulus = {YOUNG}, PoissonRatio = {POISSON} }}"
        rows = driven(options.voussoir, folder, law, library)
        print(f"ElasticityOfHooke: {len(rows)} states, stresses within {difference(rows, map(hooke, rows)):.1e} of Hooke's law")
        library = libraries["RoundedMohrCoulomb"]
        rows = driven(options.voussoir, folder, external.format(library, "RoundedMohrCoulomb"), library)
        own = driven(options.voussoir, folder, OWN)
        apart = difference(rows, (of(row, "stress", "Pa") for row in own))
        yielded = sum(row["region"] == "inelastic" for row in rows)
        print(f"RoundedMohrCoulomb: {len(rows)} states, {yielded} inelastic ({sum(r['region'] != 'elastic' for r in own)} of ours), within {apart:.1e} of mohr_coulomb_solid")


if __name__ == "__main__":
    main()
