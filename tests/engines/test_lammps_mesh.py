# SPDX-License-Identifier: GPL-2.0-or-later
"""Walls of triangles in LAMMPS: one contact over a face, an edge or a corner, and the motion beside planes and regions,
which the plugin computes without triangles."""

import struct

import numpy as np
import pytest
from lammps_decks import DUMP, column, lammps, needs_lammps, run, spheres
from triangles import fold, tiles, written

from epdem.scenes.plan.meshes import box, stl_text

pytestmark = needs_lammps

R = 0.01  # [m]
FRICTION = "thornton 1e8 0.3 4e5 tangential history 0.3"
HARD = FRICTION.replace("4e5", "8e6")
END = "thermo_style custom step ke f_w[1] f_w[2] f_w[3] f_w[5]\nthermo_modify format float %.17g\n"


def rebounds(wall, start, velocity, steps, law=FRICTION, more=""):
    head = spheres(start, pair=law)
    walk = f"velocity all set {velocity}\nfix motion all nve/sphere\ntimestep 1e-6\nthermo 10\n{END}"
    return f"{head}{wall}{more}{walk}run {steps}\n{DUMP}"


def test_over_an_edge_the_force_points_from_the_edge_to_the_centre(tmp_path):
    """A sphere beside the upper floor of a step; boxes, tiles and ledges in this host: scenes/test_stl_bounds.py."""
    low = -0.035
    riser = [[(0, -0.05, 0), (0, 0.05, 0), (0, 0.05, low)], [(0, -0.05, 0), (0, 0.05, low), (0, -0.05, low)]]
    written(tmp_path, [*tiles((-0.05, 0), (-0.05, 0.05), 3, 3), *riser], "step")
    at = (0.6, 0.79)
    wall = f"fix w all wall/ep mesh step.stl {FRICTION}\n"
    out, _ = run(rebounds(wall, (at[0] * R, 0.0, at[1] * R), "0 0 0", 0), tmp_path)
    force = np.array([column(out, f"f_w[{axis}]")[0] for axis in (1, 3)])
    assert force[0] > 0 and force[0] / force[1] == pytest.approx(at[0] / at[1], rel=1e-9)


SIDES = (-0.06, 0.04)  # of a fold


@pytest.mark.parametrize(("degrees", "speed"), [(7.5, 0.05), (7.5, 1.0), (15, 1.0), (30, 1.0)])
def test_a_concave_fold_conserves_energy(degrees, speed, tmp_path):
    """Elastic spheres that hit beside a fold, obliquely: one contact up to 20 degrees, two above."""
    angle = np.radians(degrees)
    written(tmp_path, fold(angle, SIDES, (-0.5, 0.5)), "fold")
    law = "hertz 1e8 0.3"
    starts = [(x, 0.03 * (k - 9.5)) for k, x in enumerate(np.linspace(-0.25, 0.05, 20).tolist())]
    heights = [1.00001 * max(1.0, (1 + x * float(np.sin(angle))) / float(np.cos(angle))) for x, _ in starts]
    head = spheres(*((x * R, y, z * R) for (x, y), z in zip(starts, heights, strict=True)), pair=law)
    head = head.replace("-0.1 0.1 -0.1 0.1 -0.1 0.1", "-0.5 0.5 -0.5 0.5 -0.5 0.5")
    duration = 0.012 / speed**0.2
    walk = f"velocity all set {speed / 2} 0 {-speed}\nfix motion all nve/sphere\ntimestep {duration / 40000}\n"
    _, rows = run(f"{head}fix w all wall/ep mesh fold.stl {law}\n{walk}run 40000\n{DUMP}", tmp_path)
    assert (rows[:, 6] > 0).all()
    change = np.abs((rows[:, 4:7] ** 2).sum(axis=1) / (1.25 * speed**2) - 1).max()
    assert change < 1e-4, change


def test_a_corner_has_a_contact_with_each_of_its_faces(tmp_path):
    faces = box((-0.05, 0.05, -0.05, 0.05, -0.05, 0.05))
    written(tmp_path, faces, "box")
    at = -0.05 + 0.999 * R
    out, _ = run(rebounds(f"fix w all wall/ep mesh box.stl {FRICTION}\n", (at, at, at), "0 0 0", 0), tmp_path)
    plane, _ = run(
        rebounds(f"fix w all wall/ep zplane -0.05 NULL {FRICTION}\n", (0, 0, at), "0 0 0", 0), tmp_path / "p"
    )
    for axis in (1, 2, 3):
        assert column(out, f"f_w[{axis}]")[0] == pytest.approx(column(plane, "f_w[3]")[0], rel=1e-9)


PERIODIC = "boundary p p f"
ROOM = ((-0.1, 0.1), (-0.1, 0.1))


@pytest.mark.parametrize("ranks", [1, 2])
def test_a_sphere_crosses_a_periodic_face_as_the_middle_of_the_box(ranks, tmp_path):
    """Heavy, it dents tiles along y past a face, and hits a post through the other face."""
    post = np.array([[(0, -0.1, 0), (0, 0.1, 0), (0, 0.1, 0.03)], [(0, -0.1, 0), (0, 0.1, 0.03), (0, -0.1, 0.03)]])
    found = []
    for name, start, at in (("face", (0.06, 0.09), -0.095), ("middle", (-0.07, -0.03), -0.025)):
        wall = [*tiles(*ROOM, 40, 40), *(post + np.array([at, 0.0, 0.0]))]
        folder = written(tmp_path / name, wall)
        fall = "fix fall all gravity 300 vector 0 0 -1\n"
        text = rebounds(f"fix w all wall/ep mesh f.stl {FRICTION}\n", (*start, R), "2 1 0", 40000, FRICTION, fall)
        _, (row,) = run(text.replace("boundary f f f", PERIODIC), folder, ranks=ranks)
        found.append(row)
    one, two = found
    assert one[4] < -0.05 and one[2] < 0 and two[2] < 0.1
    way = one[1:3] - two[1:3] - [0.13, 0.12]
    assert np.abs(way - 0.2 * np.round(way / 0.2)).max() < 1e-9
    assert np.abs(one[3:] - two[3:]).max() <= 1e-9 * np.abs(one[7:]).max()


def test_a_periodic_floor_moves_by_periods_as_an_endless_one(tmp_path):
    folder = written(tmp_path / "mesh", tiles(*ROOM, 4, 4))
    move = "move v_x NULL NULL"
    region = f"region b block INF INF INF INF -0.01 0 side out {move} units box\nfix w all wall/ep/region b {HARD}\n"
    fall = "fix fall all gravity 9.81 vector 0 0 -1\n"
    found = []
    for wall, place in ((region, tmp_path / "block"), (f"fix w all wall/ep mesh f.stl {move} {HARD}\n", folder)):
        text = rebounds(wall, (0.0, 0.0, R), "0 0.3 0", 100000, HARD, fall).replace("boundary f f f", PERIODIC)
        out, (row,) = run("variable x equal 5*step*dt\n" + text, place)
        found.append((column(out, "f_w[3]"), row))
    (one, a), (two, b) = found
    assert a[4] > 0.2 and (one > 0).mean() > 0.9
    assert np.abs(a[1:] - b[1:]).max() <= 1e-6 and np.abs(one - two).max() <= 1e-6 * one.max()


MOTIONS = {
    "linear": ("variable z equal 0.2*step*dt\n", "move NULL NULL v_z"),
    "vibrate": ("variable z equal 0.002*sin(800*step*dt)\n", "move NULL NULL v_z"),
    "rotate": ("variable t equal 20*step*dt\n", "rotate v_t 0.002 0 0 0 0.6 0.8"),
    "both": (
        "variable t equal 20*step*dt\nvariable x equal 0.1*step*dt\n",
        "move v_x NULL NULL rotate v_t 0 0 0 0 0 1",
    ),
}


@pytest.mark.parametrize(("kind", "ranks"), [*((kind, 1) for kind in MOTIONS), ("rotate", 2)])
def test_a_box_of_triangles_moves_as_a_block(kind, ranks, tmp_path):
    """Force, torque, power, and a sphere that the box throws about."""
    variables, motion = MOTIONS[kind]
    limits = (-0.02, 0.025, -0.022, 0.021, -0.018, 0.02)
    folder = written(tmp_path / "mesh", box(limits), "box")
    region = f"region b block {' '.join(map(str, limits))} {motion} units box\nfix w all wall/ep/region b {FRICTION}\n"
    mesh = f"fix w all wall/ep mesh box.stl {motion} {FRICTION}\n"
    words = ((0.001, 0.002, 0.003), "0.9 -0.6 0.4", 30000)
    power = END.replace("ke", "ke f_w[7]")
    one, (a,) = run(variables + rebounds(region, *words).replace(END, power), tmp_path / "block", ranks=ranks)
    two, (b,) = run(variables + rebounds(mesh, *words).replace(END, power), folder, ranks=ranks)
    for name in ("f_w[1]", "f_w[2]", "f_w[3]", "f_w[5]", "f_w[7]"):
        theirs = column(one, name)
        assert np.abs(theirs).max() > 0
        assert np.abs(column(two, name) - theirs).max() <= 1e-6 * np.abs(theirs).max(), name
    assert np.abs(a - b).max() <= 1e-6 * np.abs(a).max()


def binary(triangles, count=None):
    rows = b"".join(struct.pack("<12fH", 0, 0, 0, *map(float, t.ravel()), 0) for t in triangles)
    return b" " * 80 + struct.pack("<I", len(triangles) if count is None else count) + rows


FLOOR = tiles((-0.0625, 0.0625), (-0.0625, 0.0625), 2, 2)


def test_a_binary_file_and_a_text_in_capitals_are_read(tmp_path):
    """Corners that floats hold: the same bits."""
    found = []
    for name, raw in {
        "text": stl_text("f", FLOOR).encode(),
        "binary": binary(FLOOR),
        "capitals": stl_text("f", FLOOR).upper().encode(),
    }.items():
        folder = tmp_path / name
        folder.mkdir()
        (folder / "f.stl").write_bytes(raw)
        _, rows = run(rebounds(f"fix w all wall/ep mesh f.stl {FRICTION}\n", (0, 0, R), "1 0 -1", 3000), folder)
        found.append(rows)
    assert found[0][0, 6] > 0
    assert all(np.array_equal(found[0], rows) for rows in found[1:])


TEXT = stl_text("f", FLOOR).encode()
FLAT = stl_text("f", np.array([[[0, 0, 0], [1, 1, 0], [2, 2, 1e-9]]])).encode()
REFUSED = {  # file, words of the wall, sentence
    "no such file": (b"", FRICTION, "file f.stl: the file cannot be read"),
    "cut": (binary(FLOOR, 9), FRICTION, "not an STL file: 484 bytes, where the 9 triangles of its header have 534"),
    "not a number": (binary(FLOOR * [[[1, 1, np.nan]]]), FRICTION, "triangle 1 has corners that are not numbers"),
    "a word": (TEXT.replace(b"vertex 0", b"vertex o", 1), FRICTION, "a vertex needs three numbers"),
    "two corners": (TEXT.replace(b"  vertex", b"  corner", 1), FRICTION, "line 8: the triangle has not three corners"),
    "half": (TEXT[: len(TEXT) // 2], FRICTION, "the text ends within a triangle"),
    "none": (b"solid facet\nendsolid\n", FRICTION, "there are no triangles"),
    "flat": (FLAT, FRICTION, "triangle 1 at (0, 0, 0) has no area"),
    "no law": (TEXT, "move NULL NULL NULL", "the law is missing behind move"),
    "wear": (TEXT, "wear 0 hertz 1e8 0.3", "wear 0 must be a number above zero"),
}


@pytest.mark.parametrize("what", REFUSED)
def test_a_damaged_file_and_wrong_words_are_one_sentence(what, tmp_path):
    raw, words, sentence = REFUSED[what]
    if raw:
        (tmp_path / "f.stl").write_bytes(raw)
    code, out = lammps(rebounds(f"fix w all wall/ep mesh f.stl {words}\n", (0, 0, R), "0 0 0", 0), tmp_path)
    assert code != 0 and "fix w wall/ep mesh: " + "file f.stl: " * (words == FRICTION) in out, out[-500:]
    assert sentence in out, out[-500:]


WEAR = 1e-9  # of Finnie's law [m^2/N]
TABLE = "compute t all triangles/ep w\ndump t all local {} t.*.txt c_t[1] c_t[2] c_t[3] c_t[4] c_t[5]\n"
TABLE += "dump_modify t format float %.17g\n"


def triangles(folder, step):
    """Number, area, normal stress, shear stress, depth of each triangle."""
    return np.loadtxt(folder / f"t.{step}.txt", skiprows=9, ndmin=2)


def finnie(along, fall, mass):
    """The volume that an elastic sphere without friction wears: Finnie's law over its impulse, which the fall gives."""

    def shallow(v):  # integral of (2 v u - 3 v^2)/sqrt(u^2 + v^2), u: along
        root = np.hypot(along, v)
        return 2 * along * (root - along) - 1.5 * (v * root - along**2 * np.arcsinh(v / along))

    def steep(v):  # integral of u^2/(3 sqrt(u^2 + v^2))
        return along**2 / 3 * np.arcsinh(v / along)

    bound = along / 3
    volume = shallow(min(fall, bound)) + (steep(fall) - steep(bound)) * (fall > bound)
    return 2 * WEAR * mass * volume


@pytest.mark.parametrize(("fall", "digits"), [(0.2, 1e-6), (3.0, 1.1e-5)])
def test_an_impact_wears_by_the_integral_of_finnies_law(fall, digits, tmp_path):
    """Below 18 degrees, and beyond, where LIGGGHTS and the plugin have 0.33333 for 1/3. The error is of first order in
    the time step, so that two steps give its limit."""
    (tmp_path / "f.stl").write_bytes(TEXT)
    law, found = "hertz 1e8 0.3", []
    for steps in (4000, 8000):
        duration = 4e-3 / (1 + fall) ** 0.2
        head = spheres((0.03, 0.01, 1.00001 * R), pair=law)
        walk = f"velocity all set 1 0 {-fall}\nfix motion all nve/sphere\ntimestep {duration / steps!r}\n"
        wall = f"fix w all wall/ep mesh f.stl wear {WEAR} {law}\n"
        _, ((*_, vz, _, _, _),) = run(f"{head}{wall}{TABLE.format(steps)}{walk}run {steps}\n{DUMP}", tmp_path)
        assert vz == pytest.approx(fall, rel=1e-6)
        rows = triangles(tmp_path, steps)
        assert np.count_nonzero(rows[:, 4]) == 1 and rows[:, 1] == pytest.approx(0.0625**2 / 2)
        found.append((rows[:, 1] * rows[:, 4]).sum())
    mass = 7850 * 4 / 3 * np.pi * R**3
    assert 2 * found[1] - found[0] == pytest.approx(finnie(1.0, fall, mass), rel=digits)


def test_the_stress_of_a_triangle_that_turns_has_its_normal(tmp_path):
    """A ramp under a sphere at rest, turned by 30 degrees: without friction the force lies along the normal."""
    written(tmp_path, tiles((-0.06, 0.06), (-0.06, 0.06), 1, 1))
    law, angle = "hertz 1e8 0.3", np.pi / 6
    place = 0.999 * R * np.array([0.0, -np.sin(angle), np.cos(angle)]) + np.array([0.02, 0.0, 0.0])
    wall = f"variable t equal {angle!r}\nfix w all wall/ep mesh f.stl rotate v_t 0 0 0 1 0 0 {law}\n"
    out, _ = run(
        spheres([*map(float, place)], pair=law) + wall + TABLE.format(1) + f"fix motion all nve/sphere\n{END}run 0\n",
        tmp_path,
    )
    force = np.linalg.norm([column(out, f"f_w[{axis}]")[0] for axis in (1, 2, 3)])
    rows = triangles(tmp_path, 0)
    assert (
        rows[:, 2].max() == pytest.approx(force / (0.12**2 / 2), rel=1e-9)
        and rows[:, 3].max() < 1e-9 * rows[:, 2].max()
    )


@pytest.mark.parametrize("ranks", [1, 2])
def test_wear_goes_on_after_a_restart_to_the_bit_and_is_the_sum_over_ranks(ranks, tmp_path):
    (tmp_path / "f.stl").write_bytes(TEXT)
    places = [(x, y, 0.9999 * R) for x in (-0.05, -0.015, 0.02, 0.055) for y in (-0.03, 0.031)]
    wall = "variable t equal 3*step*dt\nvariable x equal 0.2*step*dt\nfix w all wall/ep mesh ../f.stl "
    wall += f"move v_x NULL NULL rotate v_t 0 0 0 0 0 1 wear {WEAR} {FRICTION}\nfix motion all nve/sphere\n"
    wall += "fix fall all gravity 50 vector 0.5 0 -1\ntimestep 2e-6\n" + TABLE.format(300)
    head = spheres(*places, pair=FRICTION) + "velocity all set 1 0.5 -0.3\n" + wall + "run 300\nwrite_restart here\n"
    again = "clear\natom_modify map array\ncomm_modify vel yes\nread_restart here\nneighbor 0.002 bin\n" + wall
    run(f"{head}run 300\n", tmp_path / "whole", ranks=ranks)
    run(f"{head}{again}run 300\n", tmp_path / "again", ranks=ranks)
    run(f"{head}run 300\n", tmp_path / "one")
    half, whole = (triangles(tmp_path / "whole", step) for step in (300, 600))
    assert np.count_nonzero(half[:, 4]) >= 4 and (whole[:, 4] > half[:, 4]).sum() >= 4
    assert np.array_equal(triangles(tmp_path / "again", 600), whole)
    alone = triangles(tmp_path / "one", 600)
    assert (np.abs(whole - alone) <= 1e-9 * alone.max(axis=0)).all()
