# SPDX-License-Identifier: GPL-2.0-or-later
"""Friction at walls whose normal turns."""

import numpy as np
import pytest
from lammps_decks import run, spheres
from plugin_decks import Bodies, contact, good, head, materials
from triangles import plate

R, OVERLAP, TURN, STEPS, DT = 1e-3, 1e-4, 0.01, 300, 1e-7  # [m], [rad], [s]
PERIOD = 2 * np.pi * STEPS * DT / TURN


def in_lammps(folder):
    law = "hertz 1e8 0.3 tangential history 0.5"
    deck = spheres((0, 0, R - OVERLAP), pair=law, diameter=2 * R)
    deck += f"timestep {DT!r}\nvariable angle equal {2 * np.pi / PERIOD!r}*step*dt\n"
    deck += f"region wall plane 0 0 0 0 0 1 rotate v_angle 0 0 0 0 1 0\nfix wall all wall/ep/region wall {law}\n"
    deck += f"fix go all move rotate 0 0 0 0 1 0 {PERIOD!r}\nrun {STEPS}\n"
    dump = "write_dump all custom end.txt id x y z fx fy fz modify format float %.17g\n"
    return run(deck + dump, folder)[1].ravel()


def in_liggghts(folder, loop):
    body = Bodies(np.array([3]), np.array([R]), np.array([[0, 0, R - OVERLAP]]), np.zeros((1, 3)))
    text = head() + "read_data box.data\nneighbor 5e-4 bin\n" + materials("ep/hertz", friction=0.5)
    text += contact("ep/hertz", wall="mesh")
    text += f"timestep {DT!r}\nfix turn all move/mesh mesh plate rotate origin 0 0 0 axis 0 1 0 period {PERIOD!r}\n"
    text += f"fix go all move rotate 0 0 0 0 1 0 {PERIOD!r}\nthermo_modify lost error norm no\n"
    text += f"dump out all custom {STEPS} out.bin id x y z fx fy fz\nrun {STEPS}\n"
    files = {"box.data": body.data([(-0.02, 0.02)] * 3), "plate.stl": plate((-0.003, 0.004), (-0.003, 0.004))}
    return good(folder, text, files=files, env={"EPDEM_LOOP": loop} if loop else None).last[0, 1:]


@pytest.mark.parametrize(
    ("engine", "loop"),
    [
        pytest.param("lammps", "", marks=pytest.mark.lammps),
        pytest.param("liggghts", "", marks=pytest.mark.liggghts),
        pytest.param("liggghts", "generic", marks=pytest.mark.liggghts),
    ],
)
def test_a_sphere_that_turns_with_its_wall_as_one_body_has_no_friction(engine, loop, tmp_path):
    """The arm of the sphere ends in the middle of the overlap, where the wall has another velocity than at its surface.
    A slip of TURN overlap/2 gives a friction of 4e-3 of the normal force."""
    end = in_lammps(tmp_path) if engine == "lammps" else in_liggghts(tmp_path, loop)
    n, F = end[:3] / np.linalg.norm(end[:3]), end[3:]
    assert n[0] == pytest.approx(np.sin(TURN), rel=1e-3)
    assert np.linalg.norm(F - F @ n * n) < 1e-4 * F @ n
