"""Compares five joint laws on one arch. One of them is defined here."""

import voussoir


@voussoir.law("worn")
class Worn:
    """Half of the friction coefficient, without dilatancy."""

    def facets(self):
        sides = [voussoir.Facet("sliding", [-0.3, sense], 0.0, flow=[0.0, sense]) for sense in (1, -1)]
        return [voussoir.Facet("opening", [-1, 0], 0.0), *sides]


laws = {
    "no sliding": {"law": "unilateral", "tangential": "stuck"},
    "friction, associated": {"law": "coulomb_associated", "friction": 0.6},
    "friction": {"law": "coulomb", "friction": 0.6},
    "friction and 10 MPa": {"law": "mohr_coulomb", "friction": 0.6, "compressive_strength": "10 MPa"},
    "worn": {"law": "python_facets", "class": "worn"},
}
for name, law in laws.items():
    case = voussoir.run("arch.toml", set={"joints.dry": law})[0]
    print(f"{name:22} {case.status:10} {case.load_factor:9.2f}  {case.mechanism['kind']}")
