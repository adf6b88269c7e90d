# SPDX-License-Identifier: GPL-2.0-or-later
"""Features of a scene of parts, by what they change; tests draw one of each, so that every pair of features occurs."""

from copy import deepcopy
from pathlib import Path

from hypothesis import strategies as st
from parts_cases import CASE, FLOOR, GLASS

DENSITY = {"glass": 2500.0, "steel": 7800.0, "rubber": 1100.0}
RUBBER = {"young_modulus": "50 MPa", "poisson_ratio": 0.4, "density": "1100 kg/m^3", "yield_stress": "0.8 MPa"}
REGION = {"x": ["-6.5 mm", "6.5 mm"], "y": ["-6.5 mm", "6.5 mm"], "z": ["2 mm", "30 mm"]}  # inside the tube
SIEVE = "opening [mm],retained [%]\n2.4,0\n2.0,40\n1.6,60\n"
TABLE = "x,y,z,radius,material\n0,0,0.034,0.001,steel\n0.004,0,0.034,0.001,glass\n"


def plate(name, material, z, **keys):
    shape = {"kind": "plate", "axis": "z", "center": ["0 mm", "0 mm", f"{z} mm"], "size": ["18 mm", "18 mm"]}
    return {"name": name, "material": material} | shape | keys


LID = plate("lid", "rubber", 35.5)
TUBE = {"name": "tube", "kind": "cylinder", "from": "-2 mm", "to": "32 mm", "diameter": "19.5 mm", "material": "steel"}
TURNING = {"name": "screen", "kind": "cone", "from": "-4 mm", "to": "-1 mm", "diameters": ["6 mm", "19 mm"]}
TURNING |= {"material": "steel", "angular_velocity": "60 rpm"}
GATE = {"name": "gate", "kind": "plane", "axis": "z", "at": "1 mm", "material": "rubber", "phases": ["first"]}
BOX = {"name": "tray", "kind": "box", "x": ["-9.5 mm", "9.5 mm"], "y": ["-9.5 mm", "9.5 mm"], "z": ["-1 mm", "1 mm"]}
WALLS = {
    "planes": [],
    "plates of two worn materials": [
        plate("left", "steel", -1, wear="2 mm^2/N"),
        plate("right", "rubber", -2, wear="5e-6 m^2/N"),
    ],
    "plate with stress": [plate("tray", "rubber", -1, stress=True)],
    "tube": [TUBE],
    "cone that turns": [TURNING],
    "gate": [GATE],
    "open box": [BOX | {"open": ["+z"], "material": "glass"}],
}
LAWS = {
    "hertz": {"name": "hertz"},
    "thornton": {"name": "thornton"},
    "cavity": {"name": "cavity"},
    "cavity, finite strain": {"name": "cavity", "finite_strain": True},
    "cavity, compaction": {"name": "cavity", "finite_strain": True, "compaction": True},
    "johnson, one strength": {"name": "johnson", "yield_pressure": "0.2 MPa"},
    "meyer": {"name": "meyer", "hardening_exponent": 0.3},
    "jkr": {"name": "jkr", "work_of_adhesion": "0.02 J/m^2"},
    "thornton_ning": {"name": "thornton_ning", "work_of_adhesion": "0.02 J/m^2"},
}
PAIRS = [{"between": ["glass", "wall"], "friction": 0.7}, {"between": ["glass", "steel"], "friction": 0.1}]
CONTACTS = {
    "no friction": {},
    "friction": {"friction": 0.4},
    "wall friction": {"friction": 0.4, "wall_friction": 0.1},
    "friction of pairs": {"friction": 0.4, "pairs": PAIRS},
    "partial slip": {"friction": 0.4, "tangential": "partial_slip"},
    "rolling": {"friction": 0.4, "rolling": {"model": "epsd2", "coefficient": 0.05}},
    "cohesion": {"cohesion": "1e3 J/m^3"},
}
DASHPOTS = {"no dashpot": None, "dashpot": {"restitution": 0.6}}
MIXTURES = {
    "one radius": [{"material": "glass", "radius": "1 mm"}],
    "two materials": [
        {"material": "glass", "radius": "1 mm", "share": 0.7},
        {"material": "steel", "radius": "0.8 mm", "share": 0.3},
    ],
    "rare component first": [
        {"material": "steel", "radius": "1.6 mm", "share": 0.02},
        {"material": "glass", "radius": "1 mm", "share": 0.98},
    ],
    "range": [{"material": "glass", "radius": {"from": "0.7 mm", "to": "1.3 mm"}}],
    "log-normal": [
        {"material": "glass", "radius": {"median": "1 mm", "ratio": 1.3, "from": "0.5 mm", "to": "2 mm", "classes": 7}}
    ],
    "sieve": [{"material": "glass", "radius": {"sieve": "sieve.csv"}}],
}
AMOUNTS = {
    "count": {"count": 60},
    "mass": {"mass": "0.9 g"},
    "fraction": {"fraction": 0.06},
    "poured": {"count": 60, "rate": "10 kHz"},
}
BALL = {"name": "ball", "material": "rubber", "radius": "1.5 mm", "position": ["-4 mm", "0 mm", "33 mm"]}
BODIES = {
    "none": {},
    "body": {"body": [BALL | {"velocity": ["0 m/s", "0 m/s", "-1 m/s"], "spin": ["0 rad/s", "10 rad/s", "0 rad/s"]}]},
    "frozen body": {"body": [BALL | {"frozen": True}]},
    "late body": {"body": [BALL | {"phase": "second"}]},
    "table": {"fill": [{"name": "table", "file": "table.csv"}]},
}
FIRST, SECOND = {"name": "first", "duration": "6 ms"}, {"name": "second", "duration": "4 ms"}
LINEAR = {"wall": "lid", "kind": "linear", "velocity": ["0 m/s", "0 m/s", "-0.1 m/s"]}
VIBRATE = {"wall": "lid", "kind": "vibrate", "amplitude": ["0 mm", "0 mm", "0.2 mm"], "frequency": "300 Hz"}
PRESS = {"wall": "lid", "kind": "press", "direction": [0, 0, -1], "force": "10 mN", "highest_speed": "0.1 m/s"}
PHASES = {
    "rest": [{}, {}],
    "wall moves": [{}, {"move": [LINEAR]}],
    "wall vibrates": [{"move": [VIBRATE]}, {"move": [VIBRATE]}],
    "wall presses": [{}, {"move": [PRESS]}],
    "until a force": [{"until": {"wall": "lid", "force": "5 mN"}, "move": [LINEAR]}, {}],
    "until rest": [{"until": {"kinetic_energy": "1 nJ"}}, {}],
    "own step": [{"time_step": "4e-6 s"}, {}],
    "not recorded": [{"record": False}, {}],
}
OUTPUTS = {
    "frames": {"rows": 20, "particles": 4},
    "frames that do not divide the rows": {"rows": 17, "particles": 5},
    "energy": {"rows": 20, "particles": 4, "energy": True},
    "loads": {"rows": 20, "particles": 4, "loads": True},
    "contacts": {"rows": 20, "particles": 4, "contacts": 2},
    "restarts": {"rows": 20, "particles": 4, "restarts": 2},
    "rows alone": {"rows": 20, "particles": 0},
}
MEASURES = {
    "none": None,
    "force": {"kind": "force", "wall": "floor", "component": "z"},
    "torque": {"kind": "torque", "wall": "lid"},
    "flow": {"kind": "flow", "at": "20 mm"},
    "height": {"kind": "height", "material": "glass"},
    "porosity": {"kind": "porosity", "region": {"x": ["-9 mm", "9 mm"], "y": ["-9 mm", "9 mm"], "z": ["2 mm", "9 mm"]}},
    "speeds of impacts": {"kind": "impact_speed", "bins": 4},
    "plastic work": {"kind": "plastic_work", "bins": 4},
}
ROOMS = {"open": {}, "periodic": {"periodic": True}}
SLOTS = {
    "room": ROOMS,
    "walls": WALLS,
    "law": LAWS,
    "contact": CONTACTS,
    "dashpot": DASHPOTS,
    "mixture": MIXTURES,
    "amount": AMOUNTS,
    "bodies": BODIES,
    "phases": PHASES,
    "output": OUTPUTS,
    "measure": MEASURES,
}
CHOICES = st.fixed_dictionaries({slot: st.sampled_from(list(options)) for slot, options in SLOTS.items()})


def files(folder: Path) -> None:
    """The files that cases with these features name."""
    (folder / "sieve.csv").write_text(SIEVE)
    (folder / "table.csv").write_text(TABLE)


def case_of(chosen: dict[str, str]) -> dict:
    """The TOML data of a case with these features."""
    walls = [FLOOR | {"at": "-5 mm"}, LID, *WALLS[chosen["walls"]]]
    fill = {"name": "bed", "region": REGION, "particles": MIXTURES[chosen["mixture"]]} | AMOUNTS[chosen["amount"]]
    bodies = BODIES[chosen["bodies"]]
    first, second = PHASES[chosen["phases"]]
    scene = (
        CASE["scene"]
        | ROOMS[chosen["room"]]
        | {"wall": walls, "fill": [fill, *bodies.get("fill", [])], "body": bodies.get("body", [])}
    )
    data = CASE | {"materials": CASE["materials"] | {"glass": GLASS, "rubber": RUBBER}, "law": LAWS[chosen["law"]]}
    data |= {"scene": scene | {"phase": [FIRST | first, SECOND | second]}, "output": OUTPUTS[chosen["output"]]}
    data |= {"numerics": {"time_step": "5e-6 s"}, "contact": CONTACTS[chosen["contact"]]}
    if dashpot := DASHPOTS[chosen["dashpot"]]:
        data["viscous"] = dashpot
    if measure := MEASURES[chosen["measure"]]:
        data["scene"]["measure"] = [{"name": "measured"} | measure]
    return deepcopy(data)
