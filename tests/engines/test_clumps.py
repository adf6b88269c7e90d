# SPDX-License-Identifier: GPL-2.0-or-later
"""Clumps of two spheres that land on one of them: `fix rigid/small` of LAMMPS, `fix multisphere` of LIGGGHTS."""

import numpy as np
import pytest
from lammps_decks import DUMP, needs_lammps
from lammps_decks import run as run_lammps
from plugin_decks import NU, P_Y, E, contact, good, head, materials
from triangles import plate

from epdem.scenes.plan.meshes import stl_text
from epdem.theory import pair, restitution
from epdem.theory.thornton import Thornton

R, DENSITY, SPEED = 1.5e-3, 2500.0, 0.2
MASS = DENSITY * 4 / 3 * np.pi * R**3  # of one sphere
TILTS = {"upright": 0.0, "tilted": np.radians(30)}  # of the line of centres
SQUARE = np.array([[(-1, -1, 0), (1, -1, 0), (1, 1, 0)], [(-1, -1, 0), (1, 1, 0), (-1, 1, 0)]]) * 0.02
# the wall has type 2, the spheres have type 1
LAW = Thornton(E_star=pair.E_star(E[0], NU[0], E[1], NU[1]), R_star=R, p_y=min(P_Y[:2]))


def centres(tilt):
    """Of both spheres about the centre of mass; the first one is lower."""
    way = R * np.array([np.sin(tilt), 0.0, np.cos(tilt)])
    return np.array([-way, way])


def expected(tilt):
    """e_n of the point of contact: a plane feels the mass 1/(1/M + b^2/I), b the offset of the centre of mass."""
    offset, inertia = R * np.sin(tilt), 2 * MASS * (0.4 + 1) * R**2
    return float(restitution.e_n(LAW, m_star=1 / (1 / (2 * MASS) + offset**2 / inertia), speed=SPEED))


def found(low):
    """e_n from the velocity of the lower sphere, which is that of the point of contact without friction."""
    return low[2] / SPEED


# the tilted clump turns a little while the sphere touches: 1.7e-3
LIMITS = {"upright": 1e-4, "tilted": 2e-3}


@needs_lammps
@pytest.mark.parametrize("wall", ["zplane 0 NULL", "mesh plate.stl"])
@pytest.mark.parametrize("tilt", TILTS)
def test_a_rigid_body_of_lammps_has_the_e_n_of_its_mass(tilt, wall, tmp_path):
    (tmp_path / "plate.stl").write_text(stl_text("plate", SQUARE))
    place = centres(TILTS[tilt])
    place[:, 2] += 1.000001 * R - place[0, 2]
    atoms = "".join(f"create_atoms 1 single {' '.join(map(repr, x))}\n" for x in place.tolist())
    first, second = (
        f"thornton {e!r} {nu!r} {p!r}"
        for e, nu, p in zip(E[:2].tolist(), NU[:2].tolist(), P_Y[:2].tolist(), strict=True)
    )
    text = f"""units si
atom_style sphere
atom_modify map array
boundary f f f
region box block -0.1 0.1 -0.1 0.1 -0.1 0.1
create_box 2 box
fix body all property/atom mol ghost yes
{atoms}set group all diameter {2 * R!r} density {DENSITY!r}
set group all mol 1
comm_modify vel yes
pair_style ep
pair_coeff 1 1 {first}
pair_coeff 2 2 {second}
neighbor 0.001 bin
neigh_modify exclude molecule/intra all
fix w all wall/ep {wall} {second}
velocity all set 0 0 {-SPEED!r}
fix move all rigid/small molecule
timestep 5e-9
thermo_style custom step
run 10000
{DUMP}"""
    _, rows = run_lammps(text, tmp_path)
    assert rows[0, 3] > place[0, 2] or rows[0, 6] > 0
    assert found(rows[0, 4:7]) == pytest.approx(expected(TILTS[tilt]), rel=LIMITS[tilt])


@pytest.mark.liggghts
@pytest.mark.parametrize("wall", ["primitive", "mesh"])
@pytest.mark.parametrize("tilt", TILTS)
def test_a_clump_of_liggghts_has_the_e_n_of_its_mass(tilt, wall, tmp_path):
    """LIGGGHTS draws 1e6 points for mass and inertia: 6e-4."""
    text = (
        head()
        + "region box block -0.05 0.05 -0.05 0.05 -0.02 0.1 units box\ncreate_box 3 box\nneighbor 1e-3 bin\n"
        + materials("ep/any", friction=0.0)
        + contact("ep/thornton", wall=wall)
        + "".join(f"create_atoms {k} single 0.04 0.04 {0.01 * k} units box\n" for k in (2, 3))  # all types are in use
        + "set group all diameter 0.002\nset group all density 1000\ntimestep 1e-7\n"
        + "fix t all particletemplate/multisphere 15485863 atom_type 1 density constant 2500 nspheres 2 ntry 1000000 "
        + "spheres file clump.txt scale 1.0 type 1\nfix d all particledistribution/discrete 15485867 1 t 1.0\n"
        + "fix move all multisphere\nregion in block -0.02 0.02 -0.02 0.02 0.002 0.012 units box\n"
        + "fix in all insert/pack seed 32452843 distributiontemplate d vel constant 0. 0. -0.2 orientation constant "
        + "1.0 0.0 0.0 0.0 insert_every once overlapcheck yes all_in yes particles_in_region 1 region in\n"
        + "run 1\ngroup clump type 1\ndump out clump custom 1000 out.bin id x y z vx vy vz\nrun 500000\n"
    )
    rows = "".join(f"{' '.join(map(repr, x))} {R!r}\n" for x in centres(TILTS[tilt]).tolist())
    _, frames = good(tmp_path, text, files={"clump.txt": rows, "plate.stl": plate()}).frames()
    line = (frames[0, 1, 1:4] - frames[0, 0, 1:4]) / (2 * R)
    assert line == pytest.approx(centres(TILTS[tilt])[1] / R, abs=1e-3)
    low = frames[frames[:, 0, 6] > 0][0, 0]
    assert found(low[4:7]) == pytest.approx(expected(TILTS[tilt]), rel=LIMITS[tilt] + 1e-3)
