# SPDX-License-Identifier: GPL-2.0-or-later
"""LIGGGHTS carries 256 spheres along prescribed overlaps with a wall: force and memory are the law's own."""

import subprocess

import numpy as np
import pytest
from laws import NAMES, YIELDING, numbers, yield_overlap

from epdem.base import paths
from epdem.base.declarations import declarations
from epdem.engines.liggghts import dump
from epdem.laws.library import Law
from epdem.theory import pair, viscous

pytestmark = pytest.mark.liggghts
N, STEPS, R, E, NU, Y = 256, 600, 0.01, 208e9, 0.3, 1e9
STRENGTH = {name: {"johnson": 3.0, "cavity": 1.0}.get(name, 2.8) * Y for name in YIELDING}

# Sphere k starts 1e-6 m apart and moves by beats of its own: deep and shallow, several reloads, some partings.
DECK = """atom_style granular
boundary f f f
newton off
communicate single vel yes
hard_particles yes
read_data path.data
neighbor 2e-3 bin
neigh_modify delay 0
fix m1 all property/global youngsModulus peratomtype {E!r}
fix m2 all property/global poissonsRatio peratomtype {NU!r}
{strength}
pair_style gran model ep/{law} tangential off{settings}
pair_coeff * *
fix target all wall/gran model ep/{law} tangential off primitive type 1 zplane 0.0{settings}
variable t equal step*0.01
variable depth atom 1e-6+(2e-6+8e-4*(id/{N})^3)*(1+0.4*sin((1+0.01*id)*v_t))
variable dz atom -v_depth*sin((0.9+0.003*id)*v_t)
variable vz atom {speed}
fix move all move variable NULL NULL v_dz NULL NULL v_vz
timestep 1e-8
dump path all custom 1 path.bin id z vz fz
run {STEPS}
"""


def carried(law: str, folder, restitution: float | None = None, speed: str = "0"):
    """Overlap [m], force [N] and approach speed [m/s] at every step, shape (STEPS + 1, N); `restitution`: a dashpot."""
    side, place = 16, 0.03
    atoms = [
        f"{k + 1} 1 {2 * R!r} 7850.0 {place * (k % side)!r} {place * (k // side)!r} {R + 1e-6!r}" for k in range(N)
    ]
    box = f"-0.03 {place * side!r} xlo xhi\n-0.03 {place * side!r} ylo yhi\n-0.02 0.05 zlo zhi"
    data = f"paths\n\n{N} atoms\n1 atom types\n{box}\n\nAtoms\n\n" + "\n".join(atoms) + "\n"
    (folder / "path.data").write_text(data)
    given = numbers(law, STRENGTH.get(law, 0.0))
    properties = {p.property: given[p.name] for p in declarations()[law].parameters if p.name in given}
    strength = "\n".join(f"fix p_{k} all property/global {k} peratomtype {v!r}" for k, v in properties.items())
    settings = ""
    if restitution is not None:
        settings = " viscous on"
        strength += f"\nfix m4 all property/global coefficientRestitution peratomtypepair 1 {restitution!r}"
    deck = DECK.format(law=law, strength=strength, settings=settings, speed=speed, E=E, NU=NU, N=N, STEPS=STEPS)
    (folder / "in.path").write_text(deck)
    done = subprocess.run([str(paths.launcher()), "-in", "in.path"], cwd=folder, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout[-500:]
    z, velocity, force = np.moveaxis(dump.series(folder / "path.bin"), 2, 0)
    return R - z, force, -velocity


@pytest.mark.parametrize("name", NAMES)
def test_liggghts_has_the_laws_force_on_256_paths(name, tmp_path):
    """To 1e-15 of the largest force where nothing cancels, times four roundings; alpha_max - alpha adds its own."""
    overlap, force, _ = carried(name, tmp_path)
    parameters = numbers(name, STRENGTH.get(name, 0.0))
    law = Law(name, E_star=float(pair.E_star(E, NU, E, NU)), **parameters)
    state = np.zeros(N)
    reloads = 0
    for step in range(STEPS + 1):
        state = np.where(overlap[step] > 0, state, 0.0)  # parted: LIGGGHTS forgets, so does the reference
        expected, _, after = law.step(R_star=R, delta_max=state, delta=overlap[step])
        reloads += int(((after == state) & (expected > 0)).sum())
        if step < STEPS:  # setup's evaluation of step 0 and every kept one store their memory
            state = after if step else state
        largest = law.step(R_star=R, delta_max=0.0, delta=np.maximum(after, 1e-300))[0]
        assert np.all(np.abs(force[step] - expected) <= 1e-15 * largest * np.where(after > overlap[step], 8, 4)), step
    assert reloads > 20_000 or name == "hertz"  # of 153,600 samples
    assert (overlap > 0).any(axis=0).all()


@pytest.mark.parametrize("name", NAMES)
def test_liggghts_has_the_dashpots_force_on_256_paths(name, tmp_path):
    """Below the backbone max(0, F + 2 sqrt(5/6) zeta sqrt(2 E* a m*) v), on it F alone, at speeds of either sign."""
    overlap, force, v = carried(name, tmp_path, 0.7, "2*cos(0.013*id+0.7*v_t)")
    parameters = numbers(name, STRENGTH.get(name, 0.0))
    E_star, mass = float(pair.E_star(E, NU, E, NU)), float(pair.sphere_mass(radius=R, density=7850.0))
    law, number = Law(name, E_star=E_star, **parameters), 2 * np.sqrt(5 / 6) * float(viscous.damping_ratio(0.7))
    delta_y = yield_overlap(name, E_star, R, STRENGTH[name]) if name in STRENGTH else np.inf
    state, cut = np.zeros(N), 0
    for step in range(STEPS + 1):
        state = np.where(overlap[step] > 0, state, 0.0)
        elastic, radius, after = law.step(R_star=R, delta_max=state, delta=overlap[step])
        flows = (after > state) & (after > delta_y)
        whole = elastic + number * np.sqrt(2 * E_star * radius * mass) * v[step]
        expected = np.where(flows | (overlap[step] <= 0), elastic, np.maximum(whole, 0.0))
        cut += int((~flows & (whole < 0)).sum())
        if step:
            state = after
            scale = np.abs(expected).max()
            assert np.abs(force[step] - expected).max() <= 2e-14 * scale, step
    assert cut > 100
