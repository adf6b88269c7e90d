# SPDX-License-Identifier: GPL-2.0-or-later
"""Scenes of parts from case file to plan: amounts, sizes, walls, and the masses that a fill has."""

import math
import re
import shutil
import struct
import tomllib
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from parts_cases import BED, CASES, FLOOR, GLASS, STEEL, bead, driven, mm, own, parts, tetrahedron, timed, write_stl
from scipy import stats

from epdem import Scene
from epdem.case import toml
from epdem.case.scene import load, parse
from epdem.errors import CaseError
from epdem.scenes.judge.warnings import planned_warnings
from epdem.scenes.plan.plan import plan
from epdem.studies.soften import soften
from epdem.studies.sweep import run as study

STL = {"name": "bowl", "kind": "stl", "file": "wall.stl", "material": "steel"}
BODY = bead("ball", mm(0, 0, 20), "2 mm", "steel")


def fills(data: dict, place: Path | str = "case") -> dict[tuple[str, float], int]:
    """Number of spheres by material and radius; of a given time step, for the search of one takes seconds."""
    data = data | {"numerics": {"time_step": "1e-6 s"}}
    found = [(f.particles[0], f.count) for f in plan(parse(data, place)).insertions]
    return {(part.material, round(part.radius, 9)): count for part, count in found}


def test_a_sieve_table_gives_the_masses_that_the_laboratory_weighed():
    numbers = fills(own("sieve_cylinder"), CASES / "sieve_cylinder.toml")
    # openings 3.55, 2.80, 2.24, 1.80 mm: diameters halfway between them; 70 % of 8 g, density 2500 kg/m^3
    for diameter, share in ((3.175, 0.184), (2.52, 0.461), (2.02, 0.355)):
        one = 2500 * math.pi / 6 * (diameter * 1e-3) ** 3
        assert numbers["powder", diameter / 2000] * one == pytest.approx(0.7 * 8e-3 * share, abs=1.01 * one)
    assert numbers["beads", 0.0018] * 1200 * 4 / 3 * math.pi * 0.0018**3 == pytest.approx(2.4e-3, abs=3e-5)


@pytest.mark.parametrize(
    ("sizes", "distribution"),
    [
        ({"mean": "1.5 mm", "deviation": "0.2 mm"}, stats.norm(1.5e-3, 0.2e-3)),
        ({"median": "1.5 mm", "ratio": 1.2}, stats.lognorm(math.log(1.2), scale=1.5e-3)),
    ],
)
def test_sizes_are_distributed_as_said_between_the_limits(sizes, distribution):
    radius = sizes | {"from": "1.1 mm", "to": "1.9 mm", "classes": 4}
    region = BED["region"] | {"z": mm(0, 4000)}
    fill = BED | {"particles": [{"material": "glass", "radius": radius}], "region": region, "count": 10_000}
    room = {"x": mm(-10, 10), "y": mm(-10, 10), "z": ["0 mm", "4 m"]}
    numbers = fills(parts(fill=[fill], room=room))
    share = np.diff(distribution.cdf(np.array([1.1, 1.3, 1.5, 1.7, 1.9]) * 1e-3))
    expected = dict(zip((0.0012, 0.0014, 0.0016, 0.0018), 10_000 * share / share.sum(), strict=True))
    assert {r: n for (_, r), n in numbers.items()} == pytest.approx(expected, abs=1.0)


@pytest.mark.parametrize(
    ("amount", "expected"),
    [({"mass": "1 g"}, 1e-3 / (2500 * 4 / 3 * math.pi * 1.5e-3**3)), ({"fraction": 0.1}, 0.1 * 18 * 18 * 38 / 14.137)],
)
def test_an_amount_by_mass_or_share_of_the_room_is_that_many_spheres(amount, expected):
    fill = {key: value for key, value in BED.items() if key != "count"} | amount
    assert sum(fills(parts(fill=[fill])).values()) == pytest.approx(expected, abs=0.51)


def test_a_table_of_spheres_comes_before_what_is_filled_in(tmp_path):
    (tmp_path / "s.csv").write_text("x,y,z,radius,vz\n0,0,0.01,0.001,-1\n0.004,0,0.01,0.002,0\n")
    table = {"name": "table", "file": "s.csv", "material": "glass"}
    p = plan(parse(parts(fill=[table], body=[BODY | {"frozen": True}]), tmp_path / "case.toml"))
    assert [(s.radius, s.velocity[2], s.frozen) for s in p.scene.table] == [
        (0.001, -1.0, False),
        (0.002, 0.0, False),
        (0.002, 0.0, True),
    ]
    assert p.count == 3 and (p.smallest, p.largest) == (0.001, 0.002)


def test_walls_made_here_lie_where_they_are_said_to():
    cone = {"name": "cone", "kind": "cone", "axis": "y", "from": "-8 mm", "to": "8 mm", "diameters": mm(4, 8)}
    box = {"name": "box", "kind": "box", "x": mm(-9, 9), "y": mm(-8, 8), "z": mm(0, 7)}
    walls = [cone | {"center": mm(1, 10), "ends": ["to"]}, box | {"open": ["+z", "-x"]}]
    found = plan(parse(parts(wall=[w | {"material": "steel"} for w in walls]))).triangles
    x, y, z = np.moveaxis(found["cone"], 2, 0)
    radius = np.hypot(x - 1e-3, z - 10e-3)
    side = (radius > 1e-9) & (np.abs(y - 8e-3) > 1e-12)
    assert radius[side] == pytest.approx(2e-3 + 2e-3 * (y[side] + 8e-3) / 16e-3, rel=1e-9)
    assert (radius[~side].max(), radius.min()) == pytest.approx((4e-3, 0.0))
    edges = np.diff(found["box"], axis=1)
    area = 0.5 * np.linalg.norm(np.cross(edges[:, 0], edges[:, 1]), axis=1).sum()
    assert area == pytest.approx((18 * 16 + 16 * 7 + 2 * 18 * 7) * 1e-6)


def broken(kind: str) -> np.ndarray:
    """A tetrahedron of 10 mm with one fault."""
    t = tetrahedron(10.0)
    if kind == "open":
        return t[1:]
    if kind == "flipped":
        t[2] = t[2, ::-1]
    if kind == "degenerate":
        t = np.concatenate([t, [[[0, 0, 0], [5, 5, 0], [10, 10, 0]]]])
    if kind == "doubled":
        t = np.concatenate([t, t[:1]])
    if kind == "no number":
        t[1, 2, 0] = np.nan
    if kind == "many":
        t = np.concatenate([t, [[[0, 0, 0], [10, 0, 0], [5, 5, 5]]]])
    return t


@pytest.mark.parametrize(
    ("kind", "change", "words"),
    [
        ("open", {"closed": True}, r"bowl.file: open along 3 edges, one at \(0.*\) m; close the mesh"),
        ("flipped", {}, r"bowl.file: .*flipped against each other at \d edges, one at"),
        ("degenerate", {}, r"bowl.file: 1 degenerate triangles .* the first is number 5 at \(0.005, 0.005, 0\) m"),
        ("doubled", {}, r"bowl.file: 3 edges belong to more than two triangles, one at \(0, 0.005, 0\) m"),
        ("no number", {}, r"wall.stl': triangle 2 has corners that are not numbers; export it anew"),
        ("many", {}, r"bowl.file: 1 edges belong to more than two triangles, one at \(0.005, 0, 0\) m"),
        ("good", {"scale": 1.0}, r"beyond scene.room; check its unit \(scale = 1; 0.001 if the file is in mm\)"),
        ("good", {"scale": 1e-6}, r"smaller than a sphere; check its unit"),
        ("none", {}, r"file = '.*wall.stl': not an STL file|no triangles"),
    ],
)
def test_a_bad_stl_is_found_before_the_run_with_place_and_number(kind, change, words, tmp_path):
    if kind == "none":
        (tmp_path / "wall.stl").write_text("solid nothing\nendsolid nothing\n")
    else:
        write_stl(tmp_path / "wall.stl", broken(kind))
    data = parts(wall=[FLOOR, STL | {"scale": 1e-3} | change])
    with pytest.raises(CaseError, match=words):
        plan(parse(data, tmp_path / "case.toml"))


def binary_stl(triangles: np.ndarray, count: int, name: bytes) -> bytes:
    """A binary STL file whose header names `count` triangles."""
    corners = [struct.pack("<12fH", 0, 0, 0, *t.ravel(), 0) for t in triangles]
    return name.ljust(80) + struct.pack("<I", count) + b"".join(corners)


@pytest.mark.parametrize("count", [3, 5, 2**32 - 1])
@pytest.mark.parametrize("name", [b"a bowl", b"solid bowl"])
def test_an_stl_file_whose_header_lies_about_its_triangles_is_refused(count, name, tmp_path):
    (tmp_path / "wall.stl").write_bytes(binary_stl(tetrahedron(10.0), count, name))
    data = parts(wall=[FLOOR, STL | {"scale": 1e-3}])
    says = rf"not an STL file \(284 bytes; the {count} triangles of its header have {84 + 50 * count}"
    with pytest.raises(CaseError, match=says):
        plan(parse(data, tmp_path / "case.toml"))


def test_an_stl_file_may_be_binary_or_a_text_in_any_encoding(tmp_path):
    found = []
    write_stl(tmp_path / "wall.stl", tetrahedron(10.0))
    text = (tmp_path / "wall.stl").read_text()
    named = text.replace("solid wall", "solid Gehäuse").encode("latin-1")
    for raw in (text.encode(), named, binary_stl(tetrahedron(10.0), 4, b"solid bowl"), text.upper().encode()):
        (tmp_path / "wall.stl").write_bytes(raw)
        data = parts(wall=[FLOOR, STL | {"scale": 1e-3}])
        found.append(plan(parse(data, tmp_path / "case.toml")).triangles["bowl"])
    assert found[1] == pytest.approx(found[0]) and found[2] == pytest.approx(found[0])
    assert found[3] == pytest.approx(found[0])


def test_a_good_stl_is_scaled_turned_and_moved(tmp_path):
    write_stl(tmp_path / "wall.stl", tetrahedron(5.0))
    wall = STL | {"scale": 1e-3, "rotate": {"axis": [0.0, 0.0, 2.0], "angle": "90 deg"}, "closed": True}
    wall |= {"position": mm(1, 0, 2)}
    mesh = plan(parse(parts(wall=[wall]), tmp_path / "case.toml")).triangles["bowl"]
    corners = {tuple(float(x) for x in np.round(c * 1e3, 9) + 0.0) for c in mesh.reshape(-1, 3)}
    assert corners == {(1, 0, 2), (1, 5, 2), (-4, 0, 2), (1, 0, 7)}  # x goes to y, y to -x


def test_the_example_of_the_page_is_a_scene():
    (example,) = re.findall(r"^```toml\n(.*?)^```$", (CASES.parent / "docs/parts.md").read_text(), re.M | re.S)
    p = plan(parse(parts() | tomllib.loads(example)))
    mass = 2500 * 4 / 3 * math.pi * 1e-9
    assert p.count == round(2e-3 / mass) + 1 and [x.name for x in p.phases] == ["settle", "hit"]


def test_values_of_a_pair_of_materials_count_for_spheres_and_walls():
    data = parts(body=[BODY])
    data["contact"] = {"friction": 0.3, "pairs": [{"between": ["glass", "steel"], "friction": 0.1, "restitution": 0.4}]}
    data["viscous"] = {"restitution": 0.8}
    m = plan(parse(data)).model
    assert [t.name for t in m.types] == ["glass", "steel"] and m.wall_types["steel"] == 2
    assert m.friction == ((0.3, 0.1), (0.1, 0.3)) and m.viscous == ((0.8, 0.4), (0.4, 0.8))


def test_a_hopper_is_a_wall_of_revolution():
    preset = own("hopper_beads")
    mesh = plan(parse(preset)).triangles["hopper"]
    s = preset["scene"]
    r, outlet, top = (float(s[k].split()[0]) / n for k, n in (("bin_diameter", 2), ("outlet", 2), ("bin_height", 1)))
    low = -(r - outlet) / math.tan(math.radians(float(s["half_angle"].split()[0])))
    profile = [[f"{x!r} mm", f"{z!r} mm"] for x, z in ((outlet, low), (r, 0.0), (r, top))]
    wall = {"name": "bin", "kind": "revolved", "material": "steel", "profile": profile}
    room = {k: ["-1 m", "1 m"] for k in "xyz"}
    assert np.abs(plan(parse(parts(wall=[wall], room=room))).triangles["bin"] - mesh).max() < 1e-12


def test_points_of_a_sweep_find_the_files_that_their_case_names(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    data = tomllib.loads(toml.portable_text(CASES / "sieve_cylinder.toml"))
    assert fills(data, tmp_path / "case.toml") == fills(own("sieve_cylinder"), CASES / "sieve_cylinder.toml")
    assert str(CASES.parent) not in (CASES / "sieve_cylinder.toml").read_text()


def test_a_copy_of_a_case_finds_its_files(tmp_path, monkeypatch):
    """In Python, and softened into another folder; a file that changes makes the points of a sweep run again."""
    shutil.copytree(CASES / "parts", tmp_path / "lab/parts")
    text = (CASES / "sieve_cylinder.toml").read_text()
    path, table = tmp_path / "lab/case.toml", tmp_path / "lab/parts/sieve.csv"
    path.write_text(text.replace('"parts/sieve.csv"', "'parts/sieve.csv'"))
    monkeypatch.chdir(tmp_path)
    scene = Scene.from_toml("lab/case.toml").replace({"numerics.seed": 2})
    assert scene.model.scene.fill == load(path).scene.fill
    twin = soften(path, 10.0, folder=tmp_path).text
    assert parse(tomllib.loads(twin), tmp_path / "twin.toml").scene.fill == load(path).scene.fill
    assert soften(path, 10.0, folder=path.parent).text.count("'parts/sieve.csv'") == 1

    def points() -> str:
        return study.plan(path, {"numerics.seed": "1,2"}).inputs(1)

    before = points()
    assert points() == before
    table.write_text(table.read_text().replace("18.4", "18.5"))
    assert points() != before


@pytest.mark.parametrize(("side", "vector"), [("-z", [0.0, 0.0, -1.0]), ("+x", [1.0, 0.0, 0.0])])
def test_a_direction_is_a_side_or_a_vector(side, vector):
    def case_with(direction):
        lid = {"name": "lid", "kind": "plate", "axis": "z", "center": mm(0, 0, 39), "material": "steel"}
        press = driven("lid", direction, "1 N", "0.1 m/s")
        flow = {"name": "out", "kind": "flow", "direction": direction, "at": "1 mm"}
        phase = timed("press", "20 ms", move=[press])
        return parse(parts(wall=[FLOOR, lid | {"size": mm(2, 2)}], phase=[phase], measure=[flow])).scene

    assert case_with(side) == case_with(vector)
    assert case_with(side).phase[0].move[0].direction == vector and case_with(side).measure[0].direction == side


DENSITY = {"glass": 2500.0, "steel": 7800.0}
SETTLE = {"kind": "settle", "box": mm(40, 40, 40), "count": 12, "duration": "20 ms", "walls": "steel"}


def ball(material, radius):
    return DENSITY[material] * 4 / 3 * math.pi * radius**3


def filled(particles, **amount):
    bed = {key: value for key, value in BED.items() if key != "count"}
    return parts(fill=[bed | {"particles": particles} | amount])


def component(material, radius, share):
    return {"material": material, "radius": radius if isinstance(radius, dict) else f"{radius!r} m", "share": share}


@given(
    share=st.floats(0.01, 0.99),
    radii=st.tuples(st.floats(0.2e-3, 3e-3), st.floats(0.2e-3, 3e-3)),
    mass=st.floats(1e-6, 3e-4),
)
def test_a_fill_by_mass_has_the_mass_of_every_component_or_says_so(share, radii, mass):
    """Independent count: mass of a component over the mass of one of its spheres."""
    wanted = {"glass": share * mass, "steel": (1.0 - share) * mass}
    numbers = {m: wanted[m] / ball(m, r) for m, r in zip(wanted, radii, strict=True)}
    data = filled([component("glass", radii[0], share), component("steel", radii[1], 1.0 - share)], mass=f"{mass!r} kg")
    try:
        p = plan(parse(data))
    except CaseError as error:
        assert (min(numbers.values()) < 1.0 and "one sphere" in str(error)) or "would fill" in str(error)
        return
    filled_in = [(f.particles[0], f.count) for f in p.insertions]
    got = {m: sum(n * ball(m, x.radius) for x, n in filled_in if x.material == m) for m in wanted}
    assert min(got.values()) > 0.0
    wrong = any(abs(got[m] - wanted[m]) > 0.01 * mass for m in wanted)
    assert wrong == any("requested" in said for said in planned_warnings(p))


@pytest.mark.parametrize("first", [0, 1])
def test_a_component_below_half_a_sphere_is_refused(first):
    rare = component("steel", 2e-3, 0.1)  # 0.26 g, and 10 % of 0.6 g are requested
    both = [component("glass", 1e-3, 0.9), rare]
    with pytest.raises(CaseError, match=rf"scene.fill.bed.particles.{1 - first}: .* is 0.23 of one sphere of steel"):
        plan(parse(filled(both[::-1] if first else both, mass="0.6 g")))


@pytest.mark.parametrize("kind", ["parts", "poured", "settle"])
def test_a_size_below_half_a_sphere_is_named(kind, tmp_path):
    (tmp_path / "sieve.csv").write_text("opening [mm],retained [%]\n6,0\n4,2\n1,98\n")
    sieve = [component("glass", {"sieve": "sieve.csv"}, 1.0)]  # 5 mm: 1 sphere for 388 of 2.5 mm
    data = filled(sieve, count=12)
    if kind == "poured":
        data = filled(sieve, count=12, rate="1000 Hz")
    elif kind == "settle":
        data = filled(sieve, count=12) | {"scene": SETTLE | {"particles": sieve}}
        data["output"] = {"rows": 10, "particles": 2}
    said = planned_warnings(plan(parse(data, tmp_path / "case.toml")))
    place = "scene.particles.0" if kind == "settle" else "scene.fill.bed.particles.0"
    assert any(s.startswith(f"{place}: 0 spheres with radius 0.0025 m") for s in said)
    assert GLASS != STEEL


@pytest.mark.parametrize("kind", ["compaction", "drum", "hopper", "settle", "peening"])
def test_mixtures_of_a_kind_have_exact_numbers(kind):
    """Numbers in the ratio of share over the mass of a sphere, whole, of their given sum, with every seed."""
    names = {"compaction": "compaction_powder", "drum": "drum_beads", "hopper": "hopper_beads"}
    data = own(names.get(kind, {"settle": "settle_glass", "peening": "peening_steel"}.get(kind, "")))
    material = data["scene"]["particles"][0]["material"]
    radius = parse(data).parts.filled[0].radii()[1]
    shares = {radius: 0.37, 0.7 * radius: 0.5, 0.5 * radius: 0.13}
    data["scene"]["particles"] = [component(material, r, share) for r, share in shares.items()]
    data["scene"]["count"] = 101
    weights = {r: share / r**3 for r, share in shares.items()}
    wanted = {r: 101 * w / sum(weights.values()) for r, w in weights.items()}
    p = plan(parse(data))
    found = {f.particles[0].radius: f.count for f in p.insertions}
    assert all(len(f.particles) == 1 for f in p.insertions) and sum(found.values()) == 101
    assert all(abs(found[r] - n) < 1 for r, n in wanted.items())
