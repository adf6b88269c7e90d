# SPDX-License-Identifier: GPL-2.0-or-later
"""Clusters of spheres on random walks with compaction in every host: work of forces and energies of the contacts."""

import numpy as np
from dense_spheres import LIKE
from free_spheres import ELASTIC, FORCE, PLACE, PLASTIC, RUBBED, SPRINGS, Scene, frames

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
    shape = (3, count * len(cluster[0]))
    return rng.uniform(0.0, 0.6 * depth, shape).T, rng.uniform(0.0, 2 * np.pi, shape).T


def paths(cluster, steps, *, count=4, seed=7, depth=0.05):
    """Places on `count` random walks, shape (steps + 1, count n, 3), and radii."""
    x, radius, ways = cluster
    swing, phase = swings(cluster, count, depth, seed)
    t = np.arange(steps + 1)[:, None, None] / steps
    along = -depth * t[..., 0] + (swing * (np.sin(RATE * t + phase) - np.sin(phase))).sum(-1)
    start = (x + SPACING * np.arange(count)[:, None, None] * [1.0, 0, 0]).reshape(-1, 3)
    return start + np.tile(ways * radius[:, None], (count, 1)) * along[..., None], np.tile(radius, count)


def lines(host, values, depth, steps):
    """Runs of LIGGGHTS or LAMMPS in which each sphere moves by its nine values: way, amplitudes, phases."""
    if host == "lammps":
        at = [f"d_value{k}" for k in range(9)]
        text, words = f"fix own all property/atom {' '.join(at)}\n", [f" {name} {{!r}}" for name in at]
    else:
        at = [f"f_value[{k}]" for k in range(1, 10)]
        text = f"fix value all property/atom value vector no no no{' 0.0' * 9}\nrun 0\n"
        words = [" property/atom value", *[" {!r}"] * 9]
    text += "".join(f"set atom {k}{''.join(words).format(*row)}\n" for k, row in enumerate(values.tolist(), 1))
    sines = "+".join(f"{at[3 + k]}*(sin({w!r}*v_t+{at[6 + k]})-sin({at[6 + k]}))" for k, w in enumerate(RATE))
    slopes = "+".join(f"{at[3 + k]}*{w!r}*cos({w!r}*v_t+{at[6 + k]})" for k, w in enumerate(RATE))
    text += f"variable t equal step*{1.0 / steps!r}\n"
    text += f"variable s atom -{depth!r}*v_t+{sines}\nvariable u atom -{depth!r}+{slopes}\n"
    text += "".join(f"variable x{k} atom {at[k]}*v_s\nvariable v{k} atom {at[k]}*v_u\n" for k in range(3))
    return text + f"unfix move\nfix move all move variable v_x0 v_x1 v_x2 v_v0 v_v1 v_v2\nrun {steps}\n"


def walk(host, folder, cluster, materials, steps, *, count=4, seed=7, depth=0.05, mu=0.0, Gamma=None):
    """Frames of `count` random walks of a cluster, shape (steps + 1, count, n, columns of `frames`). materials: E, nu,
    Y of the types, which alternate over the spheres; mu: of partial slip; Gamma: of cavity_adhesive. A walk approaches
    by `depth` R and oscillates by three sines of up to 0.6 of it."""
    x, radius, ways = cluster
    n, (way, radii) = len(x), paths(cluster, steps, count=count, seed=seed, depth=depth)
    kinds = [LIKE | {"E": E, "nu": nu, "yieldStress": Y, "density": 1e15} for E, nu, Y in materials]
    values = np.hstack([np.tile(ways * radius[:, None], (count, 1)), *swings(cluster, count, depth, seed)])
    law = "cavity" if Gamma is None else "cavity_adhesive"
    kinds = [kind | ({} if Gamma is None else {"workOfAdhesion": Gamma}) for kind in kinds]
    slip = {"tangential": "partial_slip", "friction": mu} if mu else {}
    if host == "yade":
        slip["moves"] = tuple((v, 1) for v in np.diff(way, axis=0) * steps)
    else:
        slip["lines"] = lines(host, values, depth, steps)
    still = {"radius": radii, "kinds": np.arange(count * n) % n % len(kinds), "compaction": True, "skin": 0.1}
    found = frames(host, folder, Scene(law, kinds, way[0], 0 * way[0], 1.0 / steps, steps, **still, **slip))
    return found.reshape(steps + 1, count, n, -1)


def energies(found):
    """Work, elastic energy and energy lost of walks, shape (steps + 1, count)."""
    F, x = found[..., FORCE], found[..., PLACE]
    power = -0.5 * ((F[1:] + F[:-1]) * np.diff(x, axis=0)).sum((-1, -2))
    work = np.concatenate([np.zeros((1, found.shape[1])), np.cumsum(power, axis=0)])
    return work, found[..., [ELASTIC, SPRINGS]].sum((-1, -2)), found[..., [PLASTIC, RUBBED]].sum((-1, -2))


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
