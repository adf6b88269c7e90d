# SPDX-License-Identifier: GPL-2.0-or-later
"""Spheres that LIGGGHTS inserts while it runs: no history at the start, theory's restitution, no energy lost unseen."""

import numpy as np
import pytest
from plugin_decks import NU, P_Y, RHO, E, Y, contact, good, head, materials
from triangles import plate

from epdem.theory import backbones, pair, restitution
from marks import thorough

pytestmark = pytest.mark.liggghts

SPEED, RADII, DT, STEPS = 10.0, (1.0e-3, 1.5e-3, 1.2e-3), 4e-8, 70000
SEEDS = (15485863, 86028121, 67867979)
REGION = "region in block -0.02 0.02 -0.02 0.02 0.004 0.012 units box\n"
# A stream's spheres keep their speed until they have passed its face, whatever hits them: with 8 mm below the face the
# first rebounds come back to it when the last sphere has passed.
WHERE = {
    "insert/pack": REGION + "{fix} insert_every once particles_in_region 60 region in\n",
    "insert/rate/region": REGION + "{fix} nparticles 60 particlerate 60000 insert_every 2500 region in\n",
    "insert/stream": "fix face all mesh/surface/planar file plate.stl type 1 move 0 0 0.008\n"
    "{fix} nparticles 60 particlerate 37500 insertion_face face extrude_length 0.008\n",
}


def deck(law, how, ranks):
    templates = "".join(
        f"fix t{k} all particletemplate/sphere {SEEDS[k - 1]} atom_type {k} density constant {float(RHO[k - 1])!r} "
        f"radius constant {RADII[k - 1]!r}\n"
        for k in (1, 2, 3)
    )
    fix = f"fix in all {how} seed 49979687 distributiontemplate d vel constant 0. 0. {-SPEED!r}"
    fix += " overlapcheck yes all_in yes"
    return (
        head(ranks=(ranks, 1, 1))
        + "region box block -0.06 0.06 -0.06 0.06 -0.01 0.08 units box\ncreate_box 3 box\nneighbor 1e-3 bin\n"
        + materials("ep/any")
        + contact(f"ep/{law}", wall="primitive", tangential="off", settings="computePlasticWork on")
        + f"timestep {DT!r}\n{templates}"
        + "fix d all particledistribution/discrete 32452843 3 t1 0.4 t2 0.3 t3 0.3\nfix move all nve/sphere\n"
        + WHERE[how].format(fix=fix)
        + "compute k all ke\ncompute w all reduce sum f_plasticWork\ncompute s all reduce sum f_elasticEnergy\n"
        "compute m all property/atom mass\ncompute sm all reduce sum c_m\n"
        "thermo_style custom step atoms c_k c_w c_s c_sm\nthermo 61\n"
        "thermo_modify lost error norm no format float %.17g\n"
        "dump out all custom 200 out.bin id type z vx vy vz\n"
        f"run {STEPS}\n"
    )


def theory(law, kind):
    """Restitution of a sphere of type `kind` that comes down on the wall, which is of type 2."""
    k, R = kind - 1, RADII[kind - 1]
    strength = {"p_y": min(P_Y[k], P_Y[1])} if law == "thornton" else {"Y": min(Y[k], Y[1])}
    backbone = backbones.LAWS[law](E_star=float(pair.E_star(E[k], NU[k], E[1], NU[1])), R_star=R, **strength)
    return float(restitution.e_n(backbone, m_star=RHO[k] * 4 / 3 * np.pi * R**3, speed=SPEED))


def first_bounces(frames):
    """(type, restitution) of spheres that hit the wall before anything else, and how many hit a sphere first."""
    bounces, hit_spheres = [], 0
    rows = np.concatenate(list(frames))
    for n in np.unique(rows[:, 0]):
        _, kind, z, vx, vy, vz = rows[rows[:, 0] == n].T
        touching = z < RADII[int(kind[0]) - 1]
        changed = ((vz != -SPEED) | (vx != 0) | (vy != 0)) & ~touching
        if not changed.any():
            continue
        first = np.argmax(changed)
        if vx[first] == vy[first] == 0:
            bounces.append((int(kind[0]), vz[first] / SPEED))
        else:
            hit_spheres += 1
    return bounces, hit_spheres


# every two values of the three meet
ALL_PAIRS = [(how, law, (k + n) % 2 + 1) for n, how in enumerate(WHERE) for k, law in enumerate(("thornton", "cavity"))]


@pytest.mark.parametrize(("how", "law", "ranks"), [thorough(*c, unless=c[1] == "cavity") for c in ALL_PAIRS])
def test_inserted_spheres_yield_as_theory_says_and_their_energy_adds_up(tmp_path, law, how, ranks):
    files = {"plate.stl": plate(x=(-0.02, 0.02), y=(-0.02, 0.02))}
    run = good(tmp_path, deck(law, how, ranks), ranks=ranks, files=files)

    lines = [line.split() for line in run.text.splitlines()]
    rows = np.array([line for line in lines if len(line) == 6 and line[0].isdigit() and line[1].isdigit()], float)
    rows = rows[rows[:, 1] > 0]
    atoms, kinetic, plastic, elastic, mass = rows[:, 1:].T
    assert atoms[-1] == 60 and (how == "insert/pack" or atoms[0] < 60)
    brought = 0.5 * mass * SPEED**2  # every sphere comes with the same speed
    # 100 steps in a contact: the velocity, half a step off, leaves 6e-6 while spheres touch
    assert np.abs((kinetic + plastic + elastic) / brought - 1).max() < 2e-5
    assert plastic[-1] > 0.5 * brought[-1] and elastic.max() > 1e-2 * brought[-1]

    bounces, hit_spheres = first_bounces(run.frames()[1])
    assert len(bounces) >= 30 and hit_spheres >= 5 and {kind for kind, _ in bounces} == {1, 2, 3}
    for kind, e_n in bounces:  # 3e-4: the error of 100 steps in a contact, docs/laws.md
        assert e_n == pytest.approx(theory(law, kind), rel=3e-4)
