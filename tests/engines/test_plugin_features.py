# SPDX-License-Identifier: GPL-2.0-or-later
"""What LIGGGHTS decks use beside a contact model: clumps, moving meshes, stored forces, local computes."""

import numpy as np
import pytest
from plugin_decks import YIELDING, Bodies, deck_of, good, materials
from triangles import plate

pytestmark = pytest.mark.liggghts

BOX = ((-0.05, 0.05), (-0.05, 0.05), (-0.02, 0.1))


def spheres(n=8, speed=2.0):
    """n x n spheres of three types above the plane z = 0, with a sideways velocity."""
    rng = np.random.default_rng(5)
    radius = rng.uniform(1.5e-3, 2.5e-3, n * n)
    grid = np.stack(np.meshgrid(*[np.arange(n)] * 2, indexing="ij"), -1).reshape(-1, 2) * 0.0047 - 0.017
    x = np.column_stack([grid, radius + rng.uniform(0, 2e-5, n * n)])
    v = np.column_stack([rng.uniform(-2, 2, (n * n, 2)), np.full(n * n, -speed)])
    return Bodies(rng.integers(1, 4, n * n), radius, x, v)


def deck(law, *, wall="mesh", after="", steps=400):
    return deck_of(f"ep/{law}", f"{after}run {steps}\n", properties=materials("ep/any"), wall=wall)


def start(folder, text, *, n=8, ranks=1, **files):
    return good(
        folder,
        text,
        ranks=ranks,
        files={
            "box.data": spheres(n).data(BOX),
            "plate.stl": plate(x=(-0.045, 0.045), y=(-0.04, 0.04), cells=2),
            **files,
        },
    )


@pytest.mark.parametrize("law", YIELDING)
def test_force_on_a_stressed_mesh_is_minus_the_sum_of_the_stored_forces(tmp_path, law):
    text = (
        deck(law, steps=60)
        .replace("mesh/surface file", "mesh/surface/stress file")
        .replace("meshes plate", "meshes plate store_force yes")
    )
    text += (
        "compute s all reduce sum f_force_wall[1] f_force_wall[2] f_force_wall[3]\n"
        "thermo_style custom step f_plate[1] c_s[1] f_plate[3] c_s[3]\n"
        "thermo_modify lost error norm no format float %.15g\n"
        "run 1\n"
    )
    lines = start(tmp_path, text).text.splitlines()
    last = [line for line in lines if line.split()[:1] == ["61"]][-1].split()
    mesh_x, sum_x, mesh_z, sum_z = map(float, last[1:])
    assert sum_z > 0
    assert mesh_z == pytest.approx(-sum_z, rel=1e-10) and mesh_x == pytest.approx(-sum_x, rel=1e-9)


def test_the_usual_computes_and_checks_run(tmp_path):
    after = (
        "fix check all check/timestep/gran 100 0.9 0.9\ncompute p all pair/gran/local id pos force force_normal "
        "history contactArea delta\ncompute n all contact/atom\ncompute e all erotate/sphere\n"
        "compute t all reduce sum c_n\nthermo_style custom step atoms ke c_e c_t f_check[1] f_check[2]\n"
        "dump l all local 50 local.txt c_p[1] c_p[2]\ndump c all custom 50 c.txt id c_n f_force_wall[3]\n"
    )
    text = deck("thornton", after=after).replace("meshes plate", "meshes plate store_force yes")
    text = text.replace("compute p all", "compute w all wall/gran/local id force history\ncompute p all")
    text = text.replace("dump l all", "dump w all local 50 wall.txt c_w[1] c_w[2]\ndump l all")
    assert "Loop time" in start(tmp_path, text).text


@pytest.mark.parametrize("law", YIELDING)
def test_stored_wall_history_is_the_largest_overlap(tmp_path, law):
    """dump custom f_history_wall[1]: what the law remembers, which only grows while the sphere touches."""
    text = deck(law, wall="primitive", after="dump h all custom 1 h.bin id z radius f_history_wall[1]\n")
    frames = start(tmp_path, text).frames("h.bin")[1]
    overlap = frames[:, :, 2] - frames[:, :, 1]
    touched = overlap > 0
    largest = np.where(touched, np.maximum.accumulate(np.where(touched, overlap, 0)), 0)
    assert np.allclose(frames[1:, :, 3][touched[1:]], largest[1:][touched[1:]], rtol=1e-9, atol=1e-15)
    assert touched.any()


@pytest.mark.parametrize("law", YIELDING)
def test_an_evaluation_that_is_not_kept_leaves_no_trace(tmp_path, law):
    """Must 6: `run 0` at a deeper overlap evaluates every contact, and must not dent it."""
    end = "run 400\ndump d all custom 1 out.bin id vx vy vz\nrun 0\n"
    detour = "displace_atoms all move 0 0 -2e-5 units box\nrun 0\ndisplace_atoms all move 0 0 2e-5 units box\n"
    plain = start(tmp_path / "plain", deck(law, wall="primitive", steps=40) + end).last
    other = start(tmp_path / "detour", deck(law, wall="primitive", steps=40) + detour + end).last
    assert np.allclose(other, plain, rtol=1e-9, atol=1e-9)
