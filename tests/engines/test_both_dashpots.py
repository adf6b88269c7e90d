# SPDX-License-Identifier: GPL-2.0-or-later
"""Friction of contacts with both dashpots: tables of contacts, and runs in pieces."""

import numpy as np
import pytest
from lammps_decks import DUMP, THORNTON, bed, run
from plugin_decks import DUMP as FRAMES
from plugin_decks import Bodies, E, contact, good, head, materials, per_pair

MU, E_N = 0.3, 0.6
ENGINES = [pytest.param("liggghts", marks=pytest.mark.liggghts), pytest.param("lammps", marks=pytest.mark.lammps)]
TIME = 6e-5  # [s] of a run


def lammps_bed(runs, dt, folder, friction):
    """Velocities and spins of a sheared bed; rows (distance vector, force on i) of its contacts at the end."""
    law = f"1 1 {THORNTON} tangential {friction} {MU} restitution {E_N}"
    deck = bed([law]).replace("timestep 2e-6", f"timestep {dt!r}").replace("0.04", "0.01")
    table = "compute rows all pair/local dx dy dz p7 p8 p9\n"
    table += "dump rows all local 100000 rows.txt c_rows[*]\ndump_modify rows format float %.17g first yes\nrun 0\n"
    _, end = run(deck + runs + DUMP + table, folder)
    return end[:, 4:], np.loadtxt(folder / "rows.txt", skiprows=9)


def liggghts_bed(runs, dt, folder, friction):
    """The same of 64 spheres that fly into each other."""
    rng = np.random.default_rng(5)
    places = 3.996e-3 * (np.array(list(np.ndindex(4, 4, 4))) - 1.5) + rng.uniform(-1e-6, 1e-6, (64, 3))
    stirred = Bodies(rng.integers(1, 4, 64), np.full(64, 2e-3), places, rng.uniform(-0.5, 0.5, (64, 3)) - 50 * places)
    text = head(sort="0 0") + "read_data box.data\nneighbor 5e-4 bin\nneigh_modify delay 0\n"
    text += materials("ep/thornton", friction=MU).replace(" ".join(map(repr, E.tolist())), "1e8 2e8 5e7")
    text += per_pair("coefficientRestitution", E_N)
    text += contact("ep/thornton", tangential=friction.replace("partial", "ep/partial"), settings="viscous on")
    every = round(TIME / dt)
    text += f"timestep {dt!r}\nfix move all nve/sphere\nthermo_modify lost error norm no\n{FRAMES.format(every=every)}"
    text += f"compute rows all pair/gran/local pos force\ndump rows all local {every} rows.txt "
    text += " ".join(f"c_rows[{k}]" for k in range(1, 10)) + "\n"
    text += f'dump_modify rows format "{" ".join(["%.17g"] * 9)}"\n{runs}'
    done = good(folder, text, files={"box.data": stirred.data([(-0.02, 0.02)] * 3)})
    frame = (folder / "rows.txt").read_text().split("ITEM: ENTRIES")[-1].split("\n", 1)[1]
    rows = np.array([line.split() for line in frame.splitlines()], float)
    return done.last[:, 4:], np.column_stack([rows[:, :3] - rows[:, 3:6], rows[:, 6:]])


BEDS = {"liggghts": liggghts_bed, "lammps": lammps_bed}


@pytest.mark.parametrize("friction", ["history", "partial_slip"])
@pytest.mark.parametrize("engine", ENGINES)
def test_no_row_of_a_table_has_friction_above_its_limit_and_pieces_of_a_run_are_the_run(engine, friction, tmp_path):
    """Of first order in the time step, because a run begins with the velocities of the full step."""
    off = []
    for dt in (1e-6, 2.5e-7):
        steps = round(TIME / dt)
        whole, rows = BEDS[engine](f"run {steps}\n", dt, tmp_path / f"whole{dt}", friction)
        parts, _ = BEDS[engine](f"run {steps // 20}\n" * 20, dt, tmp_path / f"parts{dt}", friction)
        off.append(np.abs(whole - parts)[:, :3].max() / np.abs(whole[:, :3]).max())
        n = rows[:, :3] / np.linalg.norm(rows[:, :3], axis=1)[:, None]
        F_n = (rows[:, 3:] * n).sum(axis=1)
        F_t = np.linalg.norm(rows[:, 3:] - F_n[:, None] * n, axis=1)
        assert (F_t <= MU * F_n * (1 + 1e-9) + 1e-12 * F_n.max()).all()
        assert (F_t > 0.999 * MU * F_n).sum() > 3
    assert off[0] < 3e-3 and off[1] < 0.5 * off[0]
