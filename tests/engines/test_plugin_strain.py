# SPDX-License-Identifier: GPL-2.0-or-later
"""Setting computeContactStrain: the largest w a/R* and w overlap/R* of all contacts and steps."""

import re
from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from plugin_decks import LAWS, NU, P_Y, RHO, Bodies, E, X, Y, deck_of, good
from plugin_loop import ADHESIVE, SPACING, Scene, bodies, covering, deck, outcome
from triangles import plate

from epdem.theory import backbones, pair, restitution
from marks import thorough

pytestmark = pytest.mark.liggghts

ON = "computeContactStrain on"
ROWS = (
    "compute strain all reduce max f_contactStrain[1] f_contactStrain[2]\n"
    "thermo_style custom step c_strain[1] c_strain[2]\nthermo_modify lost ignore norm no format float %.17g\n"
)


def rows(text):
    """Rows of step, largest w a/R* and largest w overlap/R*."""
    words = [line.split() for line in text.splitlines()]
    return np.array([row for row in words if len(row) == 3 and row[0].isdigit() and row[1][0] in "-0123456789"], float)


def impact(law, wall, *, steps, every):
    """An aluminium sphere of 5 mm on a steel wall, frictionless."""
    body = f"{ROWS}thermo {every}\nrun {steps}\n"
    return deck_of(f"ep/{law}", body, dt=2e-8, tangential="off", wall=wall, settings=ON)


def files(speed=10.0):
    sphere = Bodies(np.array([1]), np.array([5e-3]), np.array([[0, 0, 5.1e-3]]), np.array([[0, 0, -speed]]))
    return {"box.data": sphere.data(((-0.05, 0.05), (-0.05, 0.05), (-0.01, 0.1))), "plate.stl": plate()}


def expected(law, speed=10.0, radius=5e-3):
    """(largest w a/R*, largest w overlap/R*) of the impact, by the equations; aluminium is the softer body."""
    strength = {"hertz": {}, "thornton": {"p_y": P_Y[0]}, "johnson": {"p_m": P_Y[0]}, "cavity": {"Y": Y[0]}}
    strength["meyer"] = {"p_y": P_Y[0], "x": X[0]}
    theory = backbones.LAWS[law](E_star=1 / ((1 - NU[:2] ** 2) / E[:2]).sum(), R_star=radius, **strength[law])
    hit = restitution.impact(theory, m_star=RHO[0] * 4 / 3 * np.pi * radius**3, speed=speed)
    strong = {"hertz": (1.0, 1.0), "cavity": Y}.get(law, P_Y)  # hertz: no strength, 1/2
    share = float(pair.strain_share(*strong[:2]))
    return share * float(hit.radius_max) / radius, share * float(hit.overlap_max) / radius


@pytest.mark.parametrize(("law", "wall"), [*product(LAWS, ["primitive", "mesh"])])
def test_the_largest_strain_of_an_impact_between_two_rows_is_kept(tmp_path, law, wall):
    """The contact has ended long before the only row after it."""
    found = rows(good(tmp_path, impact(law, wall, steps=20000, every=20000), files=files()).text)
    np.testing.assert_allclose(found[-1, 1:], expected(law), rtol=3e-4)


def test_the_largest_strain_of_a_bed_is_that_of_its_geometry(tmp_path):
    """Thornton: a^2 = R* overlap on loading; overlaps from the positions of all steps; like spheres: w = 1/2."""
    scene = Scene(settings=(ON,), dashpot=False)
    frames, text = outcome(tmp_path, scene, before=ROWS)
    half, edge = SPACING / 2, SPACING * np.sqrt(2) * 0.985 * 3
    apart = frames[:, :, None, 1:4] - frames[:, None, :, 1:4]
    apart -= edge * np.round(apart / edge)
    distance = np.linalg.norm(apart, axis=-1) + 1e3 * np.eye(frames.shape[1])
    overlap = np.maximum.accumulate((2 * half - distance).max(axis=(1, 2))[1:]) / (half / 2)
    found = rows(text)[1:]
    assert len(found) == 60 and overlap[-1] > overlap[0]
    np.testing.assert_allclose(found[:, 2], 0.5 * overlap, rtol=1e-9)
    np.testing.assert_allclose(found[:, 1], 0.5 * np.sqrt(overlap), rtol=1e-9)


SCENES = [*covering()[::3], *(Scene(law=law, loose=True) for law in ADHESIVE)]


@pytest.mark.parametrize("scene", [thorough(s, unless=n % 3 == 0, id=str(s)) for n, s in enumerate(SCENES)])
def test_every_loop_finds_the_same_and_no_force_changes(tmp_path, scene):
    asked = replace(scene, settings=(*scene.settings, ON))
    generic, text = outcome(tmp_path / "generic", asked, loop="generic", before=ROWS)
    lanes, other = outcome(tmp_path / "lanes", asked, before=ROWS)
    plain, _ = outcome(tmp_path / "plain", scene)
    assert np.array_equal(rows(text), rows(other)) and np.array_equal(lanes, generic)
    assert np.array_equal(lanes, plain) and 0.0 < rows(text)[1, 2] <= rows(text)[-1, 2]


def test_the_largest_strain_goes_on_after_a_restart(tmp_path):
    scene = Scene(settings=(ON,))
    whole = rows(outcome(tmp_path / "whole", scene, steps=60, before=ROWS)[1])
    files = {"packing.data": bodies(scene)}
    good(tmp_path, deck(scene, steps=40, before=ROWS, end="write_restart half.bin\n"), files=files)
    rest = rows(good(tmp_path, deck(scene, steps=20, before=ROWS, restart="half.bin")).text)
    assert np.array_equal(rest[-1], whole[-1])


@pytest.mark.parametrize("ranks", [1, 2])
@pytest.mark.parametrize("way", ["through a face", "by delete_atoms", "before a restart"])
def test_the_largest_strain_stays_when_its_sphere_leaves(tmp_path, way, ranks):
    """On two ranks the sphere is the only one of its rank."""
    body, box = {
        "through a face": ("run 20000\n", 0.0053),
        "by delete_atoms": ("run 2000\ngroup out id 1\ndelete_atoms group out\nrun 0\n", 0.1),
        "before a restart": ("run 20000\nwrite_restart left.bin\n", 0.0053),
    }[way]
    text = impact("thornton", "primitive", steps=0, every=20000).replace("run 0\n", body)
    text = text.replace("delay 0", "every 1 delay 0 check no").replace("c_strain[2]\n", "c_strain[2] atoms\n")
    text = text.replace("processors 1", f"processors {ranks}")
    places, speeds = np.array([[-0.01, 0, 5.1e-3], [0.03, 0, 5.1e-3]]), np.array([[0, 0, -10.0], [0, 0, 0]])
    spheres = Bodies(np.array([1, 1]), np.full(2, 5e-3), places, speeds)
    files = {"box.data": spheres.data(((-0.05, 0.05), (-0.05, 0.05), (-0.01, box)))}
    out = good(tmp_path, text, files=files, ranks=ranks).text
    if way == "before a restart":
        again = text.replace("read_data box.data", "read_restart left.bin").replace(body, "run 1\n")
        out = good(tmp_path / "again", again.replace("left.bin", "../left.bin"), ranks=ranks).text
    last = [line.split() for line in out.splitlines() if re.fullmatch(r" *\d+ +[\d.e-]+ +[\d.e-]+ +\d+ *", line)][-1]
    assert last[3] == "1"
    np.testing.assert_allclose(np.array(last[1:3], float), expected("thornton"), rtol=3e-4)
