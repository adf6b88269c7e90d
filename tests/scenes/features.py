# SPDX-License-Identifier: GPL-2.0-or-later
"""Features of a scene of parts, by what they change; tests draw one of each, so that every pair of features occurs."""

from copy import deepcopy
from pathlib import Path

from hypothesis import strategies as st
from parts_cases import CASE, FLOOR, GLASS, bead, driven, linear, mm, mps, tetrahedron, timed, vibrating

from epdem.scenes.plan.meshes import stl_text

DENSITY = {"glass": 2500.0, "steel": 7800.0, "rubber": 1100.0}
RUBBER = {"young_modulus": "50 MPa", "poisson_ratio": 0.4, "density": "1100 kg/m^3", "yield_stress": "0.8 MPa"}
REGION = {"x": mm(-6.5, 6.5), "y": mm(-6.5, 6.5), "z": mm(2, 30)}  # inside the tube
UPRIGHT = {"diameter": "12 mm", "z": mm(2, 30), "center": mm(0.5, 0)}
SLAB = {"y": mm(-9, 9), "z": mm(-4, 40)}
SIEVE = "opening [mm],retained [%]\n2.4,0\n2.0,40\n1.6,60\n"
TABLE = "x,y,z,radius,material\n0,0,0.034,0.001,steel\n0.004,0,0.034,0.001,glass\n"
# two rows of touching spheres that reach through the faces of a periodic room
FACES = "x,y,z,radius,material\n" + "".join(
    f"0.0099,{along},0.004,0.0015,glass\n{along},0.0099,0.004,0.0015,glass\n"
    for along in ((n - 2.5) * 2.99e-3 for n in range(6))
)
FALLING = "x,y,z,radius,vz\n0,0,0.034,0.001,-0.5\n"
HEAP = "x,y,z,radius,material,vx,vy,vz\n" + "".join(
    f"{x * 2.02e-3},{y * 2.02e-3},{z * 2.02e-3 - 3.9e-3},{r},{material},{0.3 * y},{0.2 - 0.3 * x * z},{0.4 * x - 0.2}\n"
    for x in (-1, 0, 1)
    for y, r in ((-1, 1e-3), (0, 9e-4), (1, 1e-3))
    for z, material in enumerate(("glass", "steel"))
)


def plate(name, material, z, **keys):
    shape = {"kind": "plate", "axis": "z", "center": mm(0, 0, z), "size": mm(18, 18)}
    return {"name": name, "material": material} | shape | keys


LID = plate("lid", "rubber", 35.5)
TUBE = {"name": "tube", "kind": "cylinder", "from": "-2 mm", "to": "32 mm", "diameter": "19.5 mm", "material": "steel"}
TUBE |= {"angular_velocity": "30 rpm"}
TURNING = {"name": "screen", "kind": "cone", "from": "-4 mm", "to": "-1 mm", "diameters": mm(6, 19)}
TURNING |= {"material": "steel", "angular_velocity": "60 rpm"}
GATE = {"name": "gate", "kind": "plane", "axis": "z", "at": "1 mm", "material": "rubber", "phases": ["first"]}
BOX = {"name": "tray", "kind": "box", "x": mm(-9.5, 9.5), "y": mm(-9.5, 9.5), "z": mm(-1, 1)}
DUCT = {"name": "duct", "kind": "cylinder", "axis": "x", "from": "-8 mm", "to": "8 mm", "diameter": "2 mm"}
DUCT |= {"center": mm(1, -3), "ends": ["to"], "material": "steel"}
CONE = {"name": "cap", "kind": "cone", "axis": "y", "from": "-8 mm", "to": "8 mm", "diameters": mm(1, 2)}
CONE |= {"center": mm(-1, -3), "ends": ["from"], "material": "glass"}
FUNNEL = {"name": "funnel", "kind": "revolved", "profile": [mm(9.2, 4), mm(9.6, 20)]}
FUNNEL |= {"center": mm(0.2, 0), "material": "steel"}
STONE = {"name": "stone", "kind": "stl", "file": "stone.stl", "scale": 1e-3, "closed": True, "material": "glass"}
STONE |= {"position": mm(-8.5, -8.5, -4.5), "rotate": {"axis": [0, 0, 1], "angle": "10 deg"}}
WALLS = {
    "planes": [],
    "planes across x and y": [
        {"name": "left", "kind": "plane", "axis": "x", "at": "-9 mm", "material": "rubber"},
        {"name": "front", "kind": "plane", "axis": "y", "at": "-9 mm", "material": "glass"},
    ],
    "plates across x and y": [
        plate("left", "rubber", 10) | {"axis": "x", "center": mm(-9.5, 0, 10)},
        plate("front", "glass", 10) | {"axis": "y", "center": mm(0, -9.5, 10)},
    ],
    "duct": [DUCT | {"stress": True}],
    "cap": [CONE | {"stress": True}],
    "funnel": [FUNNEL | {"stress": True}],
    "stone": [STONE | {"stress": True}],
    "plates of two worn materials": [
        plate("left", "steel", -1, wear="2 mm^2/N"),
        plate("right", "rubber", -2, wear="5e-6 m^2/N"),
    ],
    "plate with stress": [plate("tray", "rubber", -1, stress=True)],
    "tube that turns": [TUBE],
    "cone that turns": [TURNING],
    "gate": [GATE],
    "open box": [BOX | {"open": ["+z"], "material": "glass"}],
    "box with stress": [BOX | {"open": ["+z"], "material": "glass", "stress": True}],
    "worn round walls": [
        DUCT | {"wear": "5e-6 m^2/N"},
        CONE | {"name": "cup", "center": mm(-6, -3), "wear": "5e-6 m^2/N", "material": "steel"},
    ],
    "worn shapes": [
        wall | {"wear": "5e-6 m^2/N", "material": "steel"}
        for wall in (FUNNEL, STONE, BOX | {"open": ["+z", "-x", "+x", "-y", "+y"]})
    ],
}
LAWS = {
    "hertz": {"name": "hertz"},
    "thornton": {"name": "thornton"},
    "cavity": {"name": "cavity"},
    "cavity, finite strain": {"name": "cavity", "finite_strain": True},
    "cavity, compaction": {"name": "cavity", "finite_strain": True, "compaction": True},
    "cavity, bonds": {"name": "cavity", "compaction": True},
    "johnson, one strength": {"name": "johnson", "yield_pressure": "0.2 MPa"},
    "meyer": {"name": "meyer", "hardening_exponent": 0.3},
    "jkr": {"name": "jkr", "work_of_adhesion": "0.02 J/m^2"},
    "thornton_ning": {"name": "thornton_ning", "work_of_adhesion": "0.02 J/m^2"},
    "cavity_adhesive": {"name": "cavity_adhesive", "work_of_adhesion": "5e-4 J/m^2"},
    "cavity_adhesive, compaction": {"name": "cavity_adhesive", "work_of_adhesion": "5e-4 J/m^2", "compaction": True}
    | {"finite_strain": True},
}
PAIRS = [{"between": ["glass", "wall"], "friction": 0.7}, {"between": ["glass", "steel"], "friction": 0.1}]
STRENGTHS = {
    "yield stress": {"yield_stress": "0.05 MPa"},
    "hardness": {"hardness": "0.14 MPa"},
    "yield ratio": {"yield_ratio": 1e-4},
}
CONTACTS = {
    "no friction": {},
    "friction": {"friction": 0.4},
    "wall friction": {"friction": 0.4, "wall_friction": 0.1},
    "friction of pairs": {"friction": 0.4, "pairs": PAIRS},
    "partial slip": {"friction": 0.4, "tangential": "partial_slip"},
    "rolling": {"friction": 0.4, "rolling": {"model": "epsd2", "coefficient": 0.05}},
    "rolling cdt": {"friction": 0.4, "rolling": {"model": "cdt", "coefficient": 0.05}},
    "rolling epsd": {"friction": 0.4, "rolling": {"model": "epsd", "coefficient": 0.05, "damping": 0.2}},
    "partial slip 2": {"friction": 0.4, "tangential": "partial_slip_2"},
    "tangential dashpot": {"friction": 0.4, "tangential": "history", "tangential_restitution": 0.6},
    "cohesion": {"cohesion": "1e3 J/m^3"},
    "cohesion with friction": {"friction": 0.4, "cohesion": "1e3 J/m^3"},
}
DASHPOTS = {
    "no dashpot": {},
    "dashpot": {"viscous": {"restitution": 0.6}},
    "dashpot of a pair": {
        "viscous": {"restitution": 0.6},
        "pairs": [{"between": ["glass", "glass"], "friction": 0.2, "restitution": 0.8}],
    },
}
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
    "range": [{"material": "glass", "radius": {"from": "0.7 mm", "to": "1.3 mm", "classes": 4}}],
    "normal": [
        {
            "material": "glass",
            "radius": {"mean": "1 mm", "deviation": "0.2 mm", "from": "0.6 mm", "to": "1.4 mm", "classes": 4},
        }
    ],
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
    "thrown later": {"count": 60, "phase": "second", "velocity": mps(0, 0.1, -0.2), "exact": True},
    "cylinder": {"count": 60, "exact": False, "region": UPRIGHT},
}
BALL = bead("ball", mm(-4, 0, 33), "1.5 mm", "rubber")
NEXT = mm(-1.02, 0.1, 33)  # 0.018 mm in the ball
THROWN = {"velocity": mps(0, 0, -1), "spin": ["0 rad/s", "10 rad/s", "0 rad/s"]}
BODIES = {
    "none": {},
    "body": {"body": [BALL | THROWN]},
    "bodies that overlap": {"body": [BALL | {"material": "glass"}, BALL | {"name": "next", "position": NEXT}]},
    "frozen body": {"body": [BALL | {"frozen": True}]},
    "late body": {"body": [BALL | THROWN | {"phase": "second"}]},
    "table": {"fill": [{"name": "table", "file": "table.csv"}]},
    "table of glass": {"fill": [{"name": "table", "file": "falling.csv", "material": "glass"}]},
}
ROWS = {
    "none": [],
    "rows of walls": [
        {"name": "pressure", "wall": "lid", "force": "-z", "area": "3.2 cm^2", "title": "pressure on the lid"},
        {"name": "moment", "wall": "lid", "torque": "+x", "title": "torque on the lid"},
        {"name": "place", "wall": "lid", "position": "z", "title": "place of the lid"},
    ],
}
NUMERICS = {
    "time step": {"time_step": "5e-6 s"},
    "lists": {"time_step": "5e-6 s", "skin": "0.7 mm", "sort_interval": 100, "seed": 3},
    "ranks": {"time_step": "5e-6 s", "processors": "xy", "balance": 200},
    "error": {"error": 0.1, "highest_speed": "1 m/s"},
}
FIRST, SECOND = timed("first", "6 ms"), timed("second", "4 ms")
LINEAR = linear("lid", 0, 0, -0.1)
VIBRATE = vibrating("lid", mm(0, 0, 0.2), "300 Hz")
TURN = {"wall": "lid", "kind": "rotate", "axis": [0, 0, 1], "origin": mm(1, 0, 0), "rate": "60 rpm"}
TILT = TURN | {"axis": [1, 0, 0], "rate": "-60 rpm"}
PRESS = driven("lid", [0, 0, -1], "10 mN", "0.1 m/s")
PHASES = {
    "rest": [{}, {}],
    "wall moves": [{}, {"move": [LINEAR]}],
    "wall vibrates": [{"move": [VIBRATE]}, {"move": [VIBRATE]}],
    "wall presses": [{}, {"move": [PRESS]}],
    "wall turns": [{"move": [TURN]}, {}],
    "wall moves, then tilts": [{"move": [LINEAR]}, {"move": [TILT]}],
    "wall turns, then moves": [{"move": [TURN]}, {"move": [LINEAR]}],
    "until a way": [{"until": {"wall": "lid", "travel": "0.3 mm"}, "move": [LINEAR]}, {}],
    "until a lower force": [{"until": {"wall": "lid", "force_below": "5 mN", "after": "1 ms"}}, {"move": [LINEAR]}],
    "until few are left": [{"until": {"count": 30}}, {}],
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
    "pictures": {"rows": 20, "particles": 4, "pictures": 2, "color": "radius"},
}
MEASURES = {
    "none": None,
    "number": {"kind": "count", "region": {"diameter": "8 mm", "z": mm(0, 20)}, "material": "glass"},
    "mass": {"kind": "mass"},
    "force": {"kind": "force", "wall": "floor", "component": "z"},
    "side force": {"kind": "force", "wall": "lid", "component": "x"},
    "torque": {"kind": "torque", "wall": "lid", "component": "y"},
    "whole torque": {"kind": "torque", "wall": "lid", "component": "magnitude"},
    "flow": {"kind": "flow", "at": "20 mm"},
    "flow of glass": {"kind": "flow", "at": "1 mm", "direction": "+x", "material": "glass"},
    "height": {"kind": "height", "material": "glass", "share": 0.8, "region": {"x": mm(-9, 0)} | SLAB},
    "repose": {"kind": "repose", "center": mm(0.1, 0), "region": {"x": mm(-9, 9)} | SLAB},
    "slope over x": {"kind": "repose", "over": "x", "material": "glass"},
    "slope over y": {"kind": "repose", "over": "y"},
    "centre of mass": {"kind": "center_of_mass", "axis": "x", "material": "glass"},
    "centre in a region": {"kind": "center_of_mass", "axis": "y", "region": {"x": mm(-9, 9)} | SLAB},
    "highest of mass": {"kind": "center_of_mass", "axis": "z"},
    "porosity": {"kind": "porosity", "region": {"x": mm(-10, 10), "y": mm(-10, 10), "z": mm(2, 9)}},
    "speeds of impacts": {"kind": "impact_speed", "bins": 4},
    "plastic work": {"kind": "plastic_work", "bins": 4},
}
ROOMS = {
    "closed": {},
    "periodic": {"periodic": True},
    "periodic along x": {"periodic": "x"},
    "periodic along y": {"periodic": "y"},
    "open boundary": {"open_boundary": True, "gravity": "1.62 m/s^2"},
}
CONDUCTING = {"thermal_conductivity": "1 W/(m K)", "specific_heat": "800 J/(kg K)"}
HEAT_FLOW = {"name": "q", "wall": "floor", "heat_flow": True, "title": "heat flow into the floor"}
HEATS = {"no heat": [], "heat": [HEAT_FLOW]}
SLOTS = {
    "room": ROOMS,
    "walls": WALLS,
    "law": LAWS,
    "strength": STRENGTHS,
    "contact": CONTACTS,
    "dashpot": DASHPOTS,
    "mixture": MIXTURES,
    "amount": AMOUNTS,
    "bodies": BODIES,
    "phases": PHASES,
    "output": OUTPUTS,
    "rows": ROWS,
    "measure": MEASURES,
    "numerics": NUMERICS,
    "heat": HEATS,
}
CHOICES = st.fixed_dictionaries({slot: st.sampled_from(list(options)) for slot, options in SLOTS.items()})


def files(folder: Path) -> None:
    """The files that cases with these features name."""
    (folder / "sieve.csv").write_text(SIEVE)
    (folder / "table.csv").write_text(TABLE)
    (folder / "faces.csv").write_text(FACES)
    (folder / "falling.csv").write_text(FALLING)
    (folder / "heap.csv").write_text(HEAP)
    (folder / "stone.stl").write_text(stl_text("stone", tetrahedron(5.0)))


def case_of(chosen: dict[str, str]) -> dict:
    """The TOML data of a case with these features."""
    walls = [FLOOR | {"at": "-5 mm"}, LID, *WALLS[chosen["walls"]]]
    fill = {"name": "bed", "region": REGION, "particles": MIXTURES[chosen["mixture"]]} | AMOUNTS[chosen["amount"]]
    bodies = BODIES[chosen["bodies"]]
    if (chosen["room"], chosen["walls"], chosen["bodies"]) == ("periodic", "planes", "table"):
        bodies = {"fill": [{"name": "table", "file": "faces.csv"}]}
    first, second = PHASES[chosen["phases"]]
    scene = CASE["scene"] | ROOMS[chosen["room"]] | {"wall": walls, "row": ROWS[chosen["rows"]]}
    scene |= {"fill": [fill, *bodies.get("fill", [])], "body": bodies.get("body", [])}
    glass = {key: value for key, value in GLASS.items() if key != "yield_stress"} | STRENGTHS[chosen["strength"]]
    data = CASE | {"materials": CASE["materials"] | {"glass": glass, "rubber": RUBBER}, "law": LAWS[chosen["law"]]}
    data |= {"scene": scene | {"phase": [FIRST | first, SECOND | second]}, "output": OUTPUTS[chosen["output"]]}
    data |= {"numerics": NUMERICS[chosen["numerics"]], "contact": CONTACTS[chosen["contact"]]}
    if chosen["law"] == "cavity, bonds":
        data["contact"] = data["contact"] | {"bond_strength": "0.1 MPa"}
    dashpot = DASHPOTS[chosen["dashpot"]]
    if "viscous" in dashpot:
        data["viscous"] = dashpot["viscous"]
    if pairs := dashpot.get("pairs", []):
        data["contact"] = data["contact"] | {"pairs": [*data["contact"].get("pairs", []), *pairs]}
    if measure := MEASURES[chosen["measure"]]:
        data["scene"]["measure"] = [{"name": "measured"} | measure]
    data = deepcopy(data)
    if flows := HEATS[chosen["heat"]]:
        data["materials"] = {name: material | CONDUCTING for name, material in data["materials"].items()}
        data["contact"]["heat_share"] = 0.8
        for kind, start in (("wall", 350), ("fill", 300), ("body", 320)):
            data["scene"][kind] = [x | {"temperature": f"{start + n} K"} for n, x in enumerate(data["scene"][kind])]
        data["scene"]["row"] = [*data["scene"]["row"], *flows]
    return data
