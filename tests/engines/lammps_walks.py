# SPDX-License-Identifier: GPL-2.0-or-later
"""Clusters of spheres on random walks in LAMMPS with compaction: work of the forces and energies of the contacts."""

import numpy as np
from lammps_decks import run

from epdem.theory.cavity import FINITE_STRAIN

AXES = np.concatenate([np.eye(3), -np.eye(3)])
SPACING = 10.0  # of clusters


def one_body(radius=1.0):
    """A sphere and six neighbors that walk: places, radii, directions of the walks."""
    x = np.concatenate([np.zeros((1, 3)), 2.001 * AXES])
    return x, np.full(7, radius), np.concatenate([np.zeros((1, 3)), AXES])


def two_bodies(ratio):
    """Two spheres that touch, of radii 1 and `ratio`, each with five neighbors of its own size."""
    outer = AXES[[1, 2, 4, 5]]
    away = 1.0 + ratio
    places = [np.zeros(3), [away + 0.001, 0, 0], [-2.001, 0, 0], [away + 2.001 * ratio, 0, 0]]
    ways = [np.zeros(3), AXES[0], -AXES[0], AXES[0]]
    x = np.concatenate([places, 2.001 * outer, [away, 0, 0] + 2.001 * ratio * outer])
    radii = np.array([1.0, ratio, 1.0, ratio, *[1.0] * 4, *[ratio] * 4])
    return x, radii, np.concatenate([ways, outer, outer])


RATE = [2 * np.pi, 4.6 * np.pi, 8.2 * np.pi]  # of the sines of a walk, which takes the time 1


def swings(cluster, count, depth, seed):
    """Amplitudes and phases of the sines of the spheres of `count` clusters, shape (count n, 3) each."""
    rng = np.random.default_rng(seed)
    shape = (count * len(cluster[0]), 3)
    return rng.uniform(0.0, 0.6 * depth, shape), rng.uniform(0.0, 2 * np.pi, shape)


def paths(cluster, steps, *, count=4, seed=7, depth=0.05):
    """Places on `count` random walks, shape (steps + 1, count n, 3), and radii."""
    x, radius, ways = cluster
    swing, phase = swings(cluster, count, depth, seed)
    t = np.arange(steps + 1)[:, None, None] / steps
    along = -depth * t[..., 0] + (swing * (np.sin(RATE * t + phase) - np.sin(phase))).sum(-1)
    start = (x + SPACING * np.arange(count)[:, None, None] * [1.0, 0, 0]).reshape(-1, 3)
    return start + np.tile(ways * radius[:, None], (count, 1)) * along[..., None], np.tile(radius, count)


def laws(materials, friction=""):
    """Lines of pair_coeff for one type of each material."""
    words = [f"{k} {k} cavity {E!r} {nu!r} {Y!r} 1.6 2.8 {FINITE_STRAIN}" for k, (E, nu, Y) in enumerate(materials, 1)]
    words += [f"{k} {m} mixed" for m in range(1, len(materials) + 1) for k in range(1, m)]
    return "".join(f"pair_coeff {w}{friction} compaction on\n" for w in words)


def walks(folder, cluster, materials, steps, *, count=4, seed=7, depth=0.05, friction=""):
    """Work, elastic energy and energy lost of `count` random walks of a cluster, shape (steps + 1, count).

    materials: E, nu, Y of the types, which alternate over the spheres; friction: words of pair_coeff. A walk approaches
    by `depth` R and oscillates by three sines of up to 0.6 of it.
    """
    x, radius, ways = cluster
    n = len(x)
    places = (x + SPACING * np.arange(count)[:, None, None] * [1.0, 0, 0]).reshape(-1, 3).tolist()
    swing, phase = swings(cluster, count, depth, seed)
    values = np.hstack([np.tile(ways * radius[:, None], (count, 1)), swing, phase])
    names = [f"d_{name}{k}" for name in ("way", "swing", "phase") for k in range(3)]
    half = SPACING * count
    atoms = "".join(
        f"{k + 1} {1 + k % n % len(materials)} {float(2 * radius[k % n])!r} 1e15 {p[0]!r} {p[1]!r} {p[2]!r}\n"
        for k, p in enumerate(places)
    )
    rows = "".join(f"{k + 1} {' '.join(map(repr, v))}\n" for k, v in enumerate(values.tolist()))
    data = f"x\n\n{len(places)} atoms\n{len(materials)} atom types\n\n"
    data += (
        "".join(f"{-half!r} {half!r} {a}lo {a}hi\n" for a in "xyz") + f"\nAtoms # sphere\n\n{atoms}\nWalks\n\n{rows}"
    )
    sines = "+".join(f"d_swing{k}*(sin({w!r}*v_t+d_phase{k})-sin(d_phase{k}))" for k, w in enumerate(RATE))
    slopes = "+".join(f"d_swing{k}*{w!r}*cos({w!r}*v_t+d_phase{k})" for k, w in enumerate(RATE))
    moves = "".join(f"variable x{k} atom d_way{k}*v_s\nvariable v{k} atom d_way{k}*v_u\n" for k in range(3))
    text = f"""units si
atom_style sphere
atom_modify map array sort 0 0
boundary f f f
comm_modify vel yes
fix own all property/atom {" ".join(names)}
read_data spheres.data fix own NULL Walks
pair_style ep energies
{laws(materials, friction)}neighbor 0.1 bin
variable t equal step*{1.0 / steps!r}
variable s atom -{depth!r}*v_t+{sines}
variable u atom -{depth!r}+{slopes}
{moves}fix move all move variable v_x0 v_x1 v_x2 v_v0 v_v1 v_v2
timestep {1.0 / steps!r}
dump d all custom 1 frames.txt x y z fx fy fz {" ".join(f"f_EP_HISTORY0[{k}]" for k in (1, 2, 4, 5))}
dump_modify d sort id header no format float %.15g
run {steps}
"""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "spheres.data").write_text(data)
    run(text, folder)
    frames = np.fromstring((folder / "frames.txt").read_text(), sep=" ").reshape(-1, count, n, 10)
    power = -0.5 * ((frames[1:, ..., 3:6] + frames[:-1, ..., 3:6]) * np.diff(frames[..., :3], axis=0)).sum((-1, -2))
    work = np.concatenate([np.zeros((1, count)), np.cumsum(power, axis=0)])
    return work, frames[..., [7, 9]].sum((-1, -2)), frames[..., [6, 8]].sum((-1, -2))


def falls(work, elastic, later=0):
    """Largest fall of the dissipation of each walk over its largest work, with what comes `later` steps after."""
    lost = work - elastic
    windows = np.lib.stride_tricks.sliding_window_view(lost, later + 1, axis=0)
    least, most = windows.min(axis=-1), windows.max(axis=-1)
    return (np.maximum.accumulate(least, axis=0) - most).max(axis=0) / work.max(axis=0)


def nine_spheres(seed=2, speed=0.05):
    """Places, radii 1 to 4 and velocities of a large sphere and eight small ones that fly towards it."""
    rng = np.random.default_rng(seed)
    radius = np.array([4.0, *rng.uniform(1.0, 2.0, 8)])
    ways = np.array([[i, j, k] for i in (-1, 1) for j in (-1, 1) for k in (-1, 1)]) / 3**0.5
    x = np.concatenate([np.zeros((1, 3)), ways * (4.0 + radius[1:, None] + 0.02)])
    v = np.concatenate([np.zeros((1, 3)), -speed * ways * rng.uniform(0.5, 1.5, (8, 1))])
    v[1:] += 0.2 * speed * rng.normal(size=(8, 3))
    return x, radius, v


FLIGHT = 12.0  # duration


def fly(folder, materials, steps, *, density=1.0):
    """Nine free spheres fly together: places, kinetic, elastic and plastic energies of all steps."""
    x, radius, v = nine_spheres()
    mass = 4 / 3 * np.pi * radius**3 * density
    atoms = "".join(
        f"{k + 1} {1 + k % len(materials)} {2 * r!r} {density!r} {' '.join(map(repr, p))}\n"
        for k, (r, p) in enumerate(zip(radius.tolist(), x.tolist(), strict=True))
    )
    speeds = "".join(f"{k + 1} {' '.join(map(repr, w))} 0 0 0\n" for k, w in enumerate(v.tolist()))
    data = f"x\n\n9 atoms\n{len(materials)} atom types\n\n" + "".join(f"-15 15 {a}lo {a}hi\n" for a in "xyz")
    data += f"\nAtoms # sphere\n\n{atoms}\nVelocities\n\n{speeds}"
    text = f"""units si
atom_style sphere
atom_modify map array sort 0 0
boundary f f f
comm_modify vel yes
read_data spheres.data
pair_style ep energies
{laws(materials)}neighbor 0.1 bin
fix move all nve/sphere
timestep {FLIGHT / steps!r}
dump d all custom 1 frames.txt x y z vx vy vz f_EP_HISTORY0[1] f_EP_HISTORY0[2]
dump_modify d sort id header no format float %.15g
run {steps}
"""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "spheres.data").write_text(data)
    run(text, folder)
    frames = np.fromstring((folder / "frames.txt").read_text(), sep=" ").reshape(-1, 9, 8)
    kinetic = (0.5 * mass * (frames[..., 3:6] ** 2).sum(-1)).sum(-1)
    return frames[..., :3], kinetic, frames[..., 7].sum(-1), frames[..., 6].sum(-1)
