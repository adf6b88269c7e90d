# SPDX-License-Identifier: GPL-2.0-or-later
"""Heat and currents of scenes: flow into walls, its balance, restart; networks with closed forms."""

import itertools

import numpy as np
import pandas as pd
import pytest
from parts_cases import BED, FLOOR, GLASS, STEEL, bead, mm, mps, own, parts, timed
from scene_runs import assert_goes_on, ran, run, write_case

from epdem.case.scene import parse
from epdem.engines import scene_engine
from epdem.scenes.judge.warnings import planned_warnings
from epdem.scenes.plan.plan import plan
from epdem.scenes.tables.columns import last_frame
from epdem.scenes.tables.network import node_currents

HEAT = {"thermal_conductivity": "1 W/(m K)", "specific_heat": "800 J/(kg K)"}
METAL = {"thermal_conductivity": "50 W/(m K)", "specific_heat": "500 J/(kg K)"}
HOSTS = pytest.mark.parametrize(
    "host", [pytest.param(name, marks=getattr(pytest.mark, name)) for name in ("lammps", "liggghts")]
)
FLOW = {"name": "q", "wall": "floor", "heat_flow": True, "title": "heat flow into the floor"}
WARM = FLOOR | {"temperature": "350 K"}


def warm(**scene):
    """A bed that falls onto a warm floor."""
    data = parts(**{"wall": [WARM], "fill": [BED | {"temperature": "300 K"}], "row": [FLOW]} | scene)
    data["materials"] = {"glass": GLASS | HEAT, "steel": STEEL | METAL}
    return data


SLIP = {"friction": 0.3, "tangential": "partial_slip"}
PLATE = {"name": "floor", "kind": "plate", "axis": "z", "center": mm(0, 0, 0), "size": mm(20, 20)}


@HOSTS
@pytest.mark.parametrize(
    ("law", "contact", "floor", "ranks"),
    [
        ({"name": "thornton"}, SLIP, FLOOR, 1),
        ({"name": "thornton_ning", "work_of_adhesion": "0.02 J/m^2"}, {}, PLATE | {"material": "steel"}, 2),
    ],
    ids=["plane", "adhesion at a mesh"],
)
def test_heat_of_a_bed_is_its_work_and_the_flow_from_the_floor(host, law, contact, floor, ranks, tmp_path):
    """From a bed at 1e-3 K: the works are small beside the heat of room temperature. A frozen body conducts, too."""
    body = bead("post", mm(0, 0, 2.99), "3 mm", "steel", frozen=True, temperature="0.01 K")
    bed = BED | {"temperature": "1 mK", "velocity": mps(0, 0, -2)}
    bed["region"] = BED["region"] | {"z": mm(7, 38)}
    data = warm(wall=[floor | {"temperature": "0.02 K"}], body=[body], fill=[bed], periodic=True)
    data |= {"law": law, "contact": contact | {"heat_share": 0.8}}
    found = ran(data, tmp_path, host, ranks=ranks).results
    last = last_frame(found.particles)
    c, start = np.where(last["radius"].to_numpy()[:, None] == 3e-3, (500.0, 0.01), (800.0, 1e-3)).T
    gained = (last["mass"] * c * (last["temperature"] - start)).sum()
    works = last["plastic_work"].sum() + (friction := last.get("friction_work", pd.Series()).sum())
    rows = found.rows
    into = (rows["q"].to_numpy()[1:] * np.diff(rows["time"])).sum()
    assert works > 0 and abs(into) > 1e-3 * works and (friction > 0) == bool(contact)
    assert gained + into == pytest.approx(0.8 * works, rel=1e-6)
    post = last[last["radius"] == 3e-3]
    assert post["temperature"].item() > 0.01 and post[["vx", "vy", "vz"]].to_numpy().max() == 0


@HOSTS
def test_the_flow_has_the_radius_of_growth(host, tmp_path):
    """A sphere that six planes dent grows at each of them; the table of contacts has its radii by another route."""
    planes = [
        {"name": f"{axis}{side}", "kind": "plane", "axis": axis, "at": f"{sign * 1.9} mm", "material": "steel"}
        for axis in "xyz"
        for side, sign in (("low", -1), ("high", 1))
    ]
    planes[4] |= {"temperature": "350 K"}
    room = {axis: mm(-3, 3) for axis in "xyz"}
    body = bead("ball", mm(0, 0, 0), "2 mm", "glass", frozen=True, temperature="300 K")
    data = warm(room=room, wall=planes, fill=[], body=[body], row=[FLOW | {"wall": "zlow"}])
    data["law"] = {"name": "cavity", "compaction": True}
    data["output"] = {"rows": 20, "particles": 2, "contacts": 2}
    data["scene"]["phase"] = [timed("rest", "2 ms")]
    found = ran(data, tmp_path, host).results
    contacts = last_frame(found.contacts).set_index("wall")
    contact = contacts.loc["zlow"]
    assert contact["added_overlap"] > 0.01 * contact["overlap"]
    ball = last_frame(found.particles)["temperature"].item()
    expected = 2 * (2 / (1 + 1 / 50)) * contact["contact_radius"] * (ball - 350)
    assert found.rows["q"].iloc[-1] == pytest.approx(expected, rel=1e-5)
    assert contact["heat_flow"] == pytest.approx(-expected, rel=1e-12)
    assert (contacts["heat_flow"].drop("zlow") == 0.0).all()  # at adiabatic walls


@pytest.mark.lammps
@pytest.mark.liggghts
def test_hosts_and_loops_agree(monkeypatch, tmp_path):
    """Spheres of a table that fall onto a warm floor: temperatures and flow in LAMMPS and in both loops of LIGGGHTS."""
    places = [(3.1 * (n % 3) - 3 + 0.1 * n, 3.1 * (n // 3 % 3) - 3, 1.6 + 3.05 * (n // 9)) for n in range(18)]
    body = [
        bead(f"s{n}", [f"{x:.3f} mm" for x in place], "1.5 mm", "glass")
        | {"temperature": f"{300 + n} K", "velocity": mps(0.1, 0, -0.5)}
        for n, place in enumerate(places)
    ]
    data = warm(body=body, fill=[])
    data |= {"contact": SLIP, "output": data["output"] | {"contacts": 4}}
    data["scene"]["phase"] = [timed("fall", "4 ms")]
    tables = []
    for host, loop in (("lammps", ""), ("liggghts", ""), ("liggghts", "generic")):
        monkeypatch.setenv("EPDEM_LOOP", loop)
        found = run(write_case(data, tmp_path), host, out=tmp_path / (host + loop)).results
        T, pairs = found.particles.set_index(["step", "id"])["temperature"], found.contacts.query("j > 0")
        one, other = (T[pd.MultiIndex.from_frame(pairs[["step", body]])].to_numpy() for body in "ij")
        expected = 2 * pairs["contact_radius"] * (other - one)
        assert len(pairs) and pairs["heat_flow"].to_numpy() == pytest.approx(expected.to_numpy(), rel=1e-12)
        tables.append([last_frame(found.particles).sort_values("id")["temperature"], found.rows["q"]])
    assert tables[0][1].abs().max() > 0
    for temperatures, q in tables[1:]:
        assert temperatures.to_numpy() - 300 == pytest.approx(tables[0][0].to_numpy() - 300, rel=1e-6)
        assert q.to_numpy() == pytest.approx(tables[0][1].to_numpy(), rel=1e-6, abs=1e-9)


@HOSTS
def test_late_spheres_have_their_temperatures(host, tmp_path):
    drop = bead("late", mm(0, 0, 35), "2 mm", "steel", temperature="400 K", phase="drop")
    body = drop | {"name": "early", "position": mm(8, 8, 38), "temperature": "320 K"}
    del body["phase"]
    phases = [timed("fall", "10 ms"), timed("drop", "2 ms")]
    bed = BED | {"temperature": "300 K", "region": BED["region"] | {"z": mm(2, 30)}}
    data = warm(body=[drop, body], phase=phases, fill=[bed])
    found = ran(data, tmp_path, host).results.particles
    last = last_frame(found)
    steel = last[last["radius"] == 2e-3].sort_values("z")["temperature"].to_numpy()
    assert steel == pytest.approx([400.0, 320.0], rel=1e-9)
    assert last[last["radius"] != 2e-3]["temperature"].to_numpy() == pytest.approx(np.full(40, 300.0), rel=1e-9)


@HOSTS
def test_a_scene_goes_on_bitwise(host, tmp_path):
    """From a restart file of each phase; spheres come with the second one."""
    ball = bead("late", mm(0, 0, 35), "2 mm", "steel")
    phases = [timed("fall", "40 ms"), timed("drop", "40 ms")]
    data = warm(body=[ball | {"temperature": "400 K", "phase": "drop"}], phase=phases, periodic=True)
    data["output"] = {"rows": 20, "particles": 20, "restarts": 10}
    whole, _ = assert_goes_on(plan(parse(data)), tmp_path, host, of=slice(None, None, 3))
    assert whole["particles"]["temperature"].max() == 400.0 and whole["rows"]["q"].abs().max() > 0


@pytest.mark.parametrize(("host", "file"), [("lammps", "in.scene"), ("liggghts", "setup.in")])
def test_a_scene_without_temperatures_has_no_word_of_heat(host, file):
    data = warm(wall=[FLOOR], fill=[BED], row=[])
    plain = parts(wall=[FLOOR], fill=[BED], row=[])
    decks = [scene_engine(host).files(plan(parse(x))) for x in (data, plain)]
    assert decks[0] == decks[1] and not any("heat" in text or "temperature" in text for text in decks[0].values())
    with_heat = scene_engine(host).files(plan(parse(warm())))[file]
    assert "heat/ep 0.9 1.0 800.0 50.0 500.0 wall wall_floor 350.0 50.0" in with_heat


def warm_kind(name, **keys):
    data = own(name)
    data["materials"] = {name: material | HEAT for name, material in data["materials"].items()}
    data["scene"] |= {"temperature": "300 K", "wall_temperature": "350 K"} | keys
    return data


@pytest.mark.parametrize(
    "name", ["drum_beads", "hopper_beads", "settle_glass", "peening_steel", "compaction_powder", "press_tablet"]
)
def test_every_kind_takes_temperatures(name):
    p = plan(parse(warm_kind(name)))
    assert set(p.heat.walls) == {w.name for w in p.scene.wall} and set(p.heat.walls.values()) == {350.0}
    assert {f.temperature for f in p.insertions} == {300.0}
    assert set(p.heat_flows.values()) == {w.name for w in p.scene.planes} | {*p.scene.meshes}


def test_losses_that_heat_nothing_are_named():
    data = warm()
    for friction, named in (({"friction": 0.3}, True), ({"friction": 0.3, "tangential": "partial_slip"}, False)):
        data["contact"] = friction
        assert any("heat nothing" in w for w in planned_warnings(plan(parse(data)))) == named


CELLS = {  # places of a cell in its sides; the next spheres; contacts of a sphere with the next layer; layers of a cell
    "sc": ([(0, 0, 0)], 1.0, 1, 1),
    "bcc": ([(0, 0, 0), (0.5, 0.5, 0.5)], np.sqrt(0.75), 4, 2),
    "fcc": ([(0, 0, 0), (0.5, 0.5, 0), (0.5, 0, 0.5), (0, 0.5, 0.5)], np.sqrt(0.5), 4, 2),
}


@pytest.mark.parametrize("kind", CELLS)
def test_a_lattice_between_two_walls_is_layers_in_series(kind):
    """Periodic to the sides; the lowest and highest layers touch a wall of 3 V and one of 1 V."""
    places, distance, bonds, layers = CELLS[kind]
    n, height, g, g_wall = 3, 4, 0.7, 1.9
    cells = itertools.product(range(n), range(n), range(height))
    at = np.array([np.add(cell, place) for cell in cells for place in places], float)
    apart = at[:, None] - at[None]
    apart[..., :2] -= n * np.round(apart[..., :2] / n)
    one, other = np.nonzero(np.triu(np.abs(np.linalg.norm(apart, axis=2) - distance) < 1e-9))
    lowest, highest = (np.flatnonzero(at[:, 2] == z) for z in (at[:, 2].min(), at[:, 2].max()))
    i = np.concatenate([one, lowest, highest]) + 2
    j = np.concatenate([other + 2, np.zeros(len(lowest), int), np.ones(len(highest), int)])
    conductance = np.concatenate([np.full(len(one), g), np.full(len(lowest) + len(highest), g_wall)])
    found = node_currents(i, j, conductance, np.array([3.0, 1.0, *np.full(len(at), np.nan)]))
    spheres, count = len(lowest), height * layers
    expected = 2.0 / (2 / (spheres * g_wall) + (count - 1) / (spheres * bonds * g))
    assert found[:2] == pytest.approx([expected, -expected], rel=1e-10)
    assert not found[2:].any()


def test_what_touches_no_wall_carries_no_current():
    """Nodes 0 and 1 are walls; 2 and 3 touch each other alone, 4 joins the walls; 4 and 5 are released."""
    i, j, g = np.array([2, 4, 4, 4]), np.array([3, 0, 1, 5]), np.array([1.0, 2.0, 2.0, 0.0])
    found = node_currents(i, j, g, np.array([1.0, 0.0, *np.full(4, np.nan)]))
    assert found.tolist() == [1.0, -1.0, 0.0, 0.0, 0.0, 0.0]


ROOF = FLOOR | {"name": "roof", "at": "3.98 mm"}


def held(floor=0.0, roof=2.0, **changes):
    """A frozen sphere of glass between two planes of steel."""
    ball = bead("ball", mm(0, 0, 1.99), "2 mm", "glass")
    walls = [w | ({} if V is None else {"potential": f"{V} V"}) for w, V in ((FLOOR, floor), (ROOF, roof))]
    data = parts(wall=walls, fill=[], body=[ball | {"frozen": True}], phase=[timed("rest", "2 ms")])
    data["law"] = {"name": "hertz"}
    data["output"] = {"rows": 20, "particles": 2, "contacts": 2} | changes
    metals = ((GLASS, "3 S/m"), (STEEL, "7 S/m"))
    glass, steel = ({k: v for k, v in m.items() if k != "yield_stress"} for m, _ in metals)
    glass, steel = (m | {"electrical_conductivity": s} for m, (_, s) in zip((glass, steel), metals, strict=True))
    return data | {"materials": {"glass": glass, "steel": steel}}


@pytest.mark.parametrize(
    "engine", [pytest.param(name, marks=getattr(pytest.mark, name)) for name in ("lammps", "liggghts")]
)
def test_a_sphere_between_two_planes_is_two_contacts_in_series(engine, tmp_path):
    """2 k a each, a = sqrt(R delta), 2/k = 1/3 + 1/7."""
    found = ran(held(), tmp_path, engine).results.currents
    expected = (2 / (1 / 3 + 1 / 7)) * np.sqrt(2e-3 * 1e-5)
    assert found["conductance"].to_numpy() == pytest.approx(np.full(3, expected), rel=1e-6)
    assert found["roof_current"].to_numpy() == pytest.approx(2 * found["conductance"].to_numpy(), rel=1e-12)
    assert found["floor_current"].to_numpy() == pytest.approx(-found["roof_current"].to_numpy(), rel=1e-9)
