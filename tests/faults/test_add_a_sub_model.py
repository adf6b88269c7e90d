# SPDX-License-Identifier: GPL-2.0-or-later
"""Adding a model of friction, rolling friction or cohesion takes one header and one line in its list."""

import re
import subprocess
import sys

import numpy as np
import pytest
from workshop import ROOT, program

sys.path.insert(0, str(ROOT / "tests" / "engines"))

import lammps_decks
from plugin_loop import SAID, SAID_OF_WALLS, Scene, outcome

pytestmark = [pytest.mark.liggghts, pytest.mark.faults]  # in the build of the faults of the plugin


@pytest.fixture
def launcher(plugin):
    """LIGGGHTS with a new model of each kind."""
    return str(program(plugin))


@pytest.mark.parametrize("kind", [{"tangential": "ep/toy"}, {"rolling": "ep/toy"}, {"cohesion": "ep/toy"}], ids=str)
def test_a_new_model_runs_in_both_loops_with_the_same_bits(launcher, tmp_path, kind):
    scene = Scene(**{"rolling": "epsd2", "types": 3, "loose": True, "walls": True} | kind)
    ours, said = outcome(tmp_path / "ours", scene, command=launcher)
    theirs, _ = outcome(tmp_path / "generic", scene, loop="generic", command=launcher)
    assert SAID not in said and SAID_OF_WALLS not in said
    assert np.array_equal(ours, theirs)
    without = Scene(**vars(scene) | {"settings": ()} | {name: "off" for name in kind})
    assert not np.array_equal(ours, outcome(tmp_path / "without", without, command=launcher)[0])


SETTINGS = ("LAMMPS_INCLUDE", "LAMMPS_VERSION", "LAMMPS_SIZES", "MPI_INCLUDE")


@pytest.fixture(scope="session")
def lammps_plugin(plugin, shared):
    """The plugin of LAMMPS from the sources and kernels of this LIGGGHTS."""
    caches = [dict(re.findall(r"^(\w+):\w+=(.+)$", c.read_text(), re.M)) for c in ROOT.glob("build/*/CMakeCache.txt")]
    found = next(cache for cache in caches if set(SETTINGS) <= cache.keys())
    tree = plugin / "build" / "epdem-liggghts"

    def build(_):
        configure = ["-S", plugin, "-B", tree, *(f"-D{key}={found[key]}" for key in SETTINGS)]
        for words in (configure, ["--build", tree, "-j2", "--target", "epdem_lammps"]):
            subprocess.run(["cmake", *words], check=True, stdout=subprocess.DEVNULL)

    shared("lammps plugin", build)
    return next(tree.rglob("epdemplugin.so"))


RADIUS, OVERLAP, MU, SPIN, DENSITY = 0.01, 1e-5, 0.3, 3.0, 1e5


def forces_of(folder, models):
    """Force and torque [N], [N m] on the second of two spheres along x that overlap and slide along y."""
    deck = lammps_decks.spheres((0.0, 0.0, 0.0), (2 * RADIUS - OVERLAP, 0.0, 0.0), pair=f"hertz 1e8 0.3 {models}")
    deck += f"set atom 2 vy 1.0\nset atom 1 omega {SPIN} 0 0\nfix motion all nve/sphere\ntimestep 1e-9\nrun 1\n"
    deck += "write_dump all custom end.txt id fx fy fz tqx tqy tqz modify sort id format float %.17g\n"
    return lammps_decks.run(deck, folder)[1][1]


@lammps_decks.needs_lammps
def test_a_new_model_acts_in_lammps(lammps_plugin, tmp_path, monkeypatch):
    native = lammps_decks.launcher.paths.native
    monkeypatch.setattr(
        lammps_decks.launcher.paths, "native", lambda name: lammps_plugin if "epdemplugin" in name else native(name)
    )
    none = forces_of(tmp_path / "none", "")
    spring, toy = (forces_of(tmp_path / name, f"tangential {name} {MU}") - none for name in ("history", "toy"))
    assert spring[1] != 0.0
    assert toy[1] == pytest.approx(0.5 * spring[1], rel=1e-6)  # half of the stiffness
    cohesive = forces_of(tmp_path / "cohesion", f"cohesion toy {DENSITY}")
    assert cohesive[0] - none[0] == pytest.approx(-DENSITY * RADIUS / 2 * OVERLAP, rel=1e-6)
    rolling = forces_of(tmp_path / "rolling", f"rolling toy {MU}")
    assert rolling[3] == pytest.approx(1e-3 * MU * none[0] * RADIUS / 2 * SPIN, rel=1e-6)
