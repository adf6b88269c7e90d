# SPDX-License-Identifier: GPL-2.0-or-later
"""The laws with adhesion in LIGGGHTS against theory: sticking, meshes, contacts across a gap, energy."""

import re

import numpy as np
import pytest
from plugin_adhesion import BOX, EDGE, TIP, R, deck, mass, spheres, theory, walls
from plugin_decks import ADHESIVE, P_Y, good, materials, per_pair
from test_plugin_energy import balance
from test_plugin_energy import deck as gas_deck
from test_plugin_launch import deck as plain_deck
from test_plugin_launch import started
from triangles import plate

from epdem.scenes.plan.meshes import stl_text
from epdem.theory import adhesion
from marks import thorough

pytestmark = pytest.mark.liggghts
every_law = pytest.mark.parametrize("law", ADHESIVE)


@every_law
def test_impacts_on_meshes_are_those_on_a_flat_wall(tmp_path, law):
    """On a face, on the tip and the edge of roofs of triangles, and on a plate that comes up to a sphere at rest."""
    speeds = float(adhesion.sticking_speed(theory(law), m_star=mass())) * np.array([0.5, 1.5, 4.0, 20.0])
    _, v, dt = walls(tmp_path / "flat", law, speeds)
    face = walls(tmp_path / "face", law, speeds, wall="mesh", files={"plate.stl": plate()})
    assert np.abs(face[1] - v).max() < 1e-12 * speeds.max()
    for name, roof in {"tip": TIP, "edge": EDGE}.items():
        files = {"plate.stl": stl_text("roof", np.array(roof))}
        for k, speed in enumerate(speeds):
            _, high, _ = walls(tmp_path / f"{name}{k}", law, [speed], wall="mesh", files=files)
            left = [path[-1] if path[-1] == path[-3] else 0.0 for path in (v[:, k], high[:, 0])]
            assert left[1] == pytest.approx(left[0], rel=2e-4) and (left[0] > 0) == (k > 0)
    moving = deck(
        law,
        wall="mesh",
        dt=dt,
        body=f"fix up all move/mesh mesh plate linear 0 0 {float(speeds[2])!r}\n"
        f"fix move all nve/sphere\nrun {len(v)}\n",
    )
    rest = spheres([[1e-4, 2e-4, R + 0.5 * dt * speeds[2]]], [[0, 0, 0]])
    done = good(tmp_path / "moving", moving, files={"box.data": rest.data(BOX), "plate.stl": plate()})
    left = done.frames()[1][-1, 0, 6] - speeds[2]
    assert left == pytest.approx(v[-1, 2], rel=1e-4)


@every_law
def test_a_sphere_that_is_held_across_a_gap_slides_over_the_triangles_of_a_mesh(tmp_path, law):
    """Drawn away by half the largest gap it swings there; the same bits up to round-off as on a flat wall."""
    gap = float(-theory(law).fold_overlap)
    body = (
        "fix still all move linear 0 0 0\nrun 2\nunfix still\n"
        f"displace_atoms all move 0 0 {1.2 * gap!r}\nfix move all nve/sphere\nrun 3000\n"
    )
    ends = []
    for wall, cells in (("primitive", 1), ("mesh", 1), ("mesh", 80)):
        x = [[1e-4, 2e-4, R - 0.7 * gap], [4e-3, 1.3e-4, R - 0.6 * gap]]
        bodies = spheres(x, [[3.0, 1.1, 0.0], [3.0, -2.3, 0.0]])
        text = deck(law, wall=wall, dt=2e-7, body=body)
        files = {"box.data": bodies.data(BOX), "plate.stl": plate((-0.02, 0.02), (-0.02, 0.02), cells)}
        frames = good(tmp_path / f"{wall}{cells}", text, files=files).frames()[1]
        z = frames[3:, :, 3] - R
        assert z.max() > 0.45 * gap and z.max() < gap  # they stood across a gap, and stayed
        ends.append(frames[:, :, 1:7])
    assert np.abs(ends[1] - ends[0]).max() < 1e-9
    assert np.abs(ends[2] - ends[0]).max() < 1e-9


@pytest.mark.parametrize(
    ("law", "share"),
    [
        ("thornton_ning", -0.8),
        ("jkr", 20.0),
        ("cavity_adhesive", -0.8),
        thorough("jkr", -0.8),
        thorough("thornton_ning", 20.0),
        thorough("cavity_adhesive", 20.0),
    ],
)
def test_a_pair_turned_through_one_revolution_keeps_its_force(tmp_path, law, share):
    """Held at an overlap of `share` gaps, over the borders of two ranks and of the periodic box."""
    c = theory(law, 1, 3, R, 0.7 * R)
    gap = float(-c.fold_overlap)
    delta = share * gap
    start = max(delta, 0.1 * gap)
    results = []
    for ranks in (1, 2):
        body = (
            "fix still all move linear 0 0 0\nrun 2\nunfix still\n"
            f"group right id 2\ndisplace_atoms right move {start - delta!r} 0 0\n"
            f"fix turn all move rotate 0.049 0.0003 0 0 0.3 1 {400 * 1e-6!r}\nrun 400\n"
        )
        bodies = spheres([[0.049 - 0.4 * R, 0, 0], [0.049 + 1.3 * R - start, 0, 0]], np.zeros((2, 3)))
        bodies.type[1], bodies.radius[1] = 3, 0.7 * R
        top = {"boundary": "p f f", "ranks": (ranks, 1, 1)}
        text = deck(law, dt=1e-6, body=body, top=top)
        frames = good(tmp_path / str(ranks), text, ranks=ranks, files={"box.data": bodies.data(BOX)}).frames()[1]
        results.append(frames)
        force = frames[2:, :, 7:10]
        size = np.linalg.norm(force[:, 0], axis=1)
        branch, dent = c.branch(c.radius(max(start, delta)))
        expected = float(branch.force(branch.radius(delta - dent)))
        assert size[1:] == pytest.approx(abs(expected), rel=1e-6)
        assert np.abs(force[:, 0] + force[:, 1]).max() < 1e-12 * size.max()
    assert np.array_equal(results[0], results[1])


def books(folder, law, steps, ranks=1):
    """Rows of step, kinetic, plastic, elastic, adhesive energy [J] of a gas of spheres."""
    text = gas_deck(law, steps=steps, every=97, ranks=ranks, more=["adhesiveWork"])
    return balance(folder, text, ranks, columns=5, speed=3.0)


@every_law
def test_the_energy_balance_closes_with_what_adhesion_takes(tmp_path, law):
    """Without friction no term is a remainder; the sum over 2e4 steps, and the same on two ranks."""
    rows = books(tmp_path / "one", law, 20000)
    kinetic, plastic, elastic, adhesive = rows[:, 1:].T
    assert np.abs((kinetic + plastic + adhesive + elastic) / kinetic[0] - 1).max() < 1e-3
    assert adhesive[-1] > (1e-6 if law == "cavity_adhesive" else 0.01) * kinetic[0]  # which holds less adhesion
    assert plastic[-1] == 0 if law == "jkr" else plastic[-1] > 0.05 * kinetic[0]
    two = books(tmp_path / "two", law, 2000, ranks=2)
    assert np.allclose(rows[: len(two) - 1], two[:-1], rtol=1e-11, atol=1e-16)


def test_surface_energies_give_the_work_of_adhesion(tmp_path):
    """2 sqrt(gamma_i gamma_j)."""
    gamma = "fix g all property/global surfaceEnergy peratomtype 9 16 25\n"
    table = [[2 * np.sqrt(a * b) for b in (9.0, 16.0, 25.0)] for a in (9.0, 16.0, 25.0)]
    pairs = "fix g all property/global workOfAdhesion peratomtypepair 3 " + " ".join(str(x) for r in table for x in r)
    base = materials("ep/any")
    ends = []
    for name, text in (("one", gamma), ("pair", pairs + "\n")):
        both = plain_deck("ep/thornton_ning", properties=base + text, steps=200)
        done = started(tmp_path / name, both + "dump d all custom 1 out.bin id x y z vx vy vz\nrun 0\n")
        ends.append(done.last)
    assert np.array_equal(*ends) and np.abs(ends[0][:, 6]).min() > 0


@pytest.mark.parametrize("share", [0.95, 1.05])
def test_cohesion_that_is_stronger_than_the_bodies_is_warned_of_and_they_collapse(tmp_path, share):
    """sjkr pulls with its density times 2 pi R* alpha, the plastic line of thornton rises by pi p_y R*: half of p_y."""
    density = float(share * P_Y[0] / 2)
    properties = materials("ep/any") + per_pair("cohesionEnergyDensity", density)
    text = plain_deck("ep/thornton", properties=properties, models="cohesion sjkr", tangential="off", steps=4000)
    two = spheres([[0, 0, 4 * R], [2 * R - 1e-6, 0, 4 * R]], np.zeros((2, 3)))
    text = text.replace("run ", "dump d all custom 400 out.bin id x\nrun ")
    done = good(tmp_path, text, files={"box.data": two.data(BOX)})
    overlap = 2 * R - np.abs(np.diff(done.frames()[1][:, :, 1])).min()
    warnings = [line for line in done.text.splitlines() if "WARNING" in line and "cohesionEnergyDensity" in line]
    if share < 1:
        assert warnings == [] and overlap < 0.05 * R
        return
    assert overlap > 0.2 * R
    assert len(warnings) == 1 and f"= {density:.9g} of types 1 and 1 pulls contacts in harder" in warnings[0]
    limit = float(re.search(r"above (\S+) the spheres collapse", warnings[0])[1])
    assert limit == pytest.approx(P_Y[0] / 2, rel=0.03)


LATER = """fix t all particletemplate/sphere 15485863 atom_type 1 density constant 2700 radius constant {!r}
fix d all particledistribution/discrete 15485867 1 t 1.0
region in block -0.03 -0.02 -0.01 0.01 0.02 0.03 units box
fix in all insert/pack seed 49979687 distributiontemplate d insert_every once region in particles_in_region 1
"""


@pytest.mark.parametrize("smallest", [R, 0.9 * R], ids=["there", "inserted"])
def test_the_distance_factor_follows_from_the_properties_and_is_said(smallest, tmp_path):
    """1.6088 (Gamma^2 R*/E*^2)^(1/3) of the smallest sphere at a wall over its radius, and half a hundredth. The first
    rank has no sphere; spheres that will be inserted count, too."""
    for law in ADHESIVE:
        bodies = spheres([[k * 0.01, 0, R] for k in range(3)], np.zeros((3, 3)))
        bodies.type[:] = 1, 2, 3
        before = LATER.format(smallest) * (smallest < R)
        body = "fix move all nve/sphere\nrun 1\n"
        text = deck(law, dt=1e-7, body=body, before=before, top={"ranks": (2, 1, 1)})
        said = good(tmp_path / law, text, files={"box.data": bodies.data(BOX)}, ranks=2).text
        (line,) = [ln for ln in said.splitlines() if ln.startswith(f"epdem: ep/{law} pulls")]
        gaps = [-float(theory(law, i, j, smallest).fold_overlap) for i in (1, 2, 3) for j in (1, 2, 3)]
        assert float(line.split()[-1]) == pytest.approx(1.005 + max(gaps) / smallest, abs=1e-8)
        assert f"up to {max(gaps):.4g}" in line
