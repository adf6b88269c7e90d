# SPDX-License-Identifier: GPL-2.0-or-later
"""The same impacts in LIGGGHTS in another order or place: which contact model gives the same answer?

The main scene: 12 oblique impacts of unequal spheres and 12 of spheres on a wall, all drifting across x = CENTRE while
they touch. Each way of telling it (swapped ids, sorted atoms, two ranks, a periodic face, ...) must not change the
outcome.
`bench/liggghts_invariance.py` writes the table of all models; the tests assert it for the models of epdem.
"""

import re
from dataclasses import replace
from functools import cache, cached_property, partial

import numpy as np
from plugin_decks import DUMP, Bodies, contact, deck_of, good, head, materials, per_pair
from triangles import plate

CENTRE = 0.09375  # 1.5/16 m: on both sides of a face the coordinates have the same spacing of doubles
BOX = ((-CENTRE, 3 * CENTRE), (-0.02, 0.12), (-0.01, 0.14))
PERIODIC = ((-CENTRE, CENTRE), *BOX[1:])
DRIFT, DT, STEPS, MIDDLE, N = 20.0, 2e-8, 2000, 450, 12
EVERY_STEP = "neigh_modify every 1 delay 0 check no\n"
HEAP_STEPS = 300
SELDOM = "neigh_modify every 1 delay 0 check yes\n"


def scene():
    """2 N spheres in pairs and N above the wall; contacts begin within 100 steps and last 300 to 1500."""
    rng = np.random.default_rng(7)
    kinds = rng.integers(1, 4, 2 * N)
    radius = rng.uniform(1e-3, 2e-3, 2 * N)
    x, v = np.empty((3 * N, 3)), np.empty((3 * N, 3))
    crossing = CENTRE - DRIFT * DT * MIDDLE
    for k in range(N):
        n = np.array([rng.uniform(-0.03, 0.03), 1.0, rng.uniform(-0.2, 0.2)])
        n /= np.linalg.norm(n)
        a, b = 2 * k, 2 * k + 1
        speed = rng.uniform(5, 15)
        distance = radius[a] + radius[b] + rng.uniform(0, 100) * speed * DT
        contact_point = np.array([crossing, 0.0, 0.02 + 0.009 * k])
        x[a], x[b] = contact_point - radius[a] * n, contact_point + (distance - radius[a]) * n
        v[a], v[b] = 0.5 * speed * n, -0.5 * speed * n
    wall_radius = rng.uniform(1e-3, 2e-3, N)
    for k in range(N):
        speed = rng.uniform(5, 15)
        offset = rng.uniform(-1e-4, 1e-4)
        x[2 * N + k] = (crossing + offset, 0.025 + 0.005 * k, wall_radius[k] + rng.uniform(0, 100) * speed * DT)
        v[2 * N + k] = (0.0, 0.0, -speed)
    v += rng.uniform(-2, 2, v.shape) * np.array([1, 0.3, 0.3])
    v[:, 0] += DRIFT
    types = np.concatenate([kinds, rng.integers(1, 4, N)])
    return Bodies(types, np.concatenate([radius, wall_radius]), x, v, rng.uniform(-2e3, 2e3, v.shape))


def deck(
    model,
    *,
    tangential="history",
    box="box.data",
    before="",
    neigh=SELDOM,
    wall="primitive",
    body=None,
    restart=None,
    style=True,
    **top,
):
    """The scene's deck; `restart` continues from a file, without `style` with the models of that file."""
    atoms = f"read_restart {restart}\n" if restart else f"read_data {box}\n"
    words = contact(model, wall=wall, tangential=tangential)
    if not style:
        words = "\n".join(line for line in words.splitlines() if not line.startswith("pair_")) + "\n"
    return (
        head(**top)
        + atoms
        + "neighbor 5e-4 bin\nneigh_modify binsize 0.02\n"
        + neigh
        + materials(model)
        + words
        + f"timestep {DT!r}\nfix move all nve/sphere\nthermo_modify lost error norm no\n"
        + before
        + (body or f"run {STEPS}\n")
        + DUMP.format(every=1)
        + "run 0\n"
    )


class Suite:
    """All ways to tell the scene with one model, each a run; `rows` compare them with the plain one."""

    def __init__(self, model, folder, tangential="history"):
        self.model, self.folder, self.bodies, self.tangential = model, folder, scene(), tangential

    @cached_property
    def plain(self):
        return self.outcome("plain", self.deck())

    def deck(self, **options):
        return deck(self.model, tangential=self.tangential, **options)

    def outcome(self, name, text, *, bodies=None, box=BOX, ranks=1, files=None):
        """Velocity and spin of every body after the run, in the order of the scene."""
        bodies = bodies or self.bodies
        files = {"box.data": bodies.data(box), "plate.stl": plate(x=(0.05, 0.14), y=(-0.01, 0.11)), **(files or {})}
        frames = good(self.folder / name, text, ranks=ranks, files=files).last
        assert len(frames) == len(bodies.radius), f"{name}: LIGGGHTS lost particles"
        return frames[bodies.ids - 1, 4:]

    def momentum(self, outcome):
        """Change of each pair's momentum over the impact, relative to the momentum that the bodies exchanged."""
        change = (self.bodies.mass[:, None] * (outcome[:, :3] - self.bodies.v))[: 2 * N].reshape(N, 2, 3)
        return (np.abs(change.sum(axis=1)).max(axis=1) / np.abs(change).max(axis=(1, 2))).max()

    def second_impact(self, *, fast):
        """Deviation of three impacts in one neighbour list from those with a new list every step. Spheres fall on fixed
        ones and gravity brings them back before the list is due. `fast`: soft bodies that part by more than a
        thousandth of their size in one step, so that no contact distance factor sees them part."""
        rng = np.random.default_rng(11)
        radius = rng.uniform(1e-3, 1.5e-3, 2 * N)
        x = np.array([[0.01 * (k // 2), 0.0, 0.05] for k in range(2 * N)])
        x[1::2, 2] += radius[0::2] + radius[1::2] + 1e-5
        v = np.zeros_like(x)
        v[1::2] = rng.uniform(-0.02, 0.02, (N, 3)) + np.array([0, 0, -1.0])
        w = rng.uniform(-50, 50, (2 * N, 3))
        gravity, dt, skin, steps = (1e3, 1e-5, 4e-3, 500) if fast else (2e3, 5e-8, 1e-3, 50000)
        types = np.full(2 * N, 3)
        types[0::2] = np.arange(N) % 2 + 1
        bodies, box = Bodies(types, radius, x, v, w), ((-0.02, 0.14), (-0.02, 0.02), (0.0, 0.1))
        properties = materials(self.model)
        if fast:
            soft = {"m1": "7e7 2e8 5e6", "p1": "3e6 3e6 3e5", "p2": "1e6 1e6 1e5"}
            for fix, values in soft.items():
                properties = re.sub(rf"(fix {fix} .* peratomtype) .*", rf"\1 {values}", properties)
            work = " 0.05" if self.model == "ep/cavity_adhesive" else " 0.5"  # it refuses more between such bodies
            properties = re.sub(r"(workOfAdhesion peratomtypepair 3) .*", r"\1" + 9 * work, properties)
        text = (
            head()
            + f"read_data box.data\nneighbor {skin!r} bin\nneigh_modify binsize 0.02\n{{neigh}}"
            + properties
            + contact(self.model, tangential=self.tangential)
            + f"timestep {dt!r}\nthermo_modify lost error norm no\n"
            + "group up id "
            + " ".join(map(str, bodies.ids[1::2]))
            + "\nfix move up nve/sphere\n"
            + f"fix g up gravity {gravity!r} vector 0 0 -1\nrun {steps}\n"
            + DUMP.format(every=1)
            + "run 0\n"
        )
        never = "neigh_modify delay 1000000 check no\n"
        kind = "fast" if fast else "slow"
        one, other = (
            self.outcome(f"second-{kind}-{k}", text.format(neigh=n), bodies=bodies, box=box)
            for k, n in enumerate((never, EVERY_STEP))
        )
        return np.abs(one - other)[:, :3].max()

    def revolution(self):
        """Change of the force on a sphere, over the force, after its loaded, sheared pair has turned once as a whole.
        The axis is none of the pair's: it turns about its normal, too. 1000 steps."""
        radius, delta, dt, turn = 2e-3, 2e-5, 1e-7, 1000
        x = np.array([[0, 0, radius - delta / 2], [0, 0, delta / 2 - radius], [0.04, 0, 0], [0.04, 0.03, 0]])
        bodies, box = Bodies(np.array([2, 2, 1, 3]), np.full(4, radius), x, 0 * x), [(-0.02, 0.06)] * 3
        body = f"group one id 1\ngroup two id <= 2\ndump out one custom {turn} out.bin id fx fy fz\n"
        body += "fix go one move linear 7e-3 3e-3 0\nrun 900\nunfix go\nvelocity all set 0 0 0\nrun 100\n"
        body += f"fix go two move rotate 0 0 0 1 2 2 {turn * dt!r}\nrun {turn}\n"
        text = deck_of(self.model, body, dt=dt, move="", tangential=self.tangential)
        frames = good(self.folder / "revolution", text, files={"box.data": bodies.data(box)}).frames()[1][1:, 0, 1:]
        return np.linalg.norm(frames[-1] - frames[0]) / np.linalg.norm(frames[0])

    def heap(self, runs, *, reverse=False, ranks=1, friction=0.3):
        """Velocities and spins of 64 spheres in contact that slide and stick on each other, with dashpots."""
        rng, dt = np.random.default_rng(5), 1e-7
        places = 3.996e-3 * (np.array(list(np.ndindex(4, 4, 4))) - 1.5) + rng.uniform(-1e-6, 1e-6, (64, 3))
        radius, speeds = rng.uniform(1.999e-3, 2e-3, 64), rng.uniform(-3, 3, (64, 3))
        ids = np.arange(64, 0, -1) if reverse else None
        bodies = Bodies(rng.integers(1, 4, 64), radius, places, speeds, ids=ids)
        given = materials(self.model, friction=friction)
        given += "" if "coefficientRestitution" in given else per_pair("coefficientRestitution", 0.6)
        more = {"properties": given, "tangential": self.tangential, "top": {"ranks": (ranks, 1, 1), "sort": "0 0"}}
        text = deck_of(self.model, f"{runs}{DUMP.format(every=1)}run 0\n", dt=dt, skin=5e-4, **more)
        name = f"heap-{reverse}-{ranks}-{friction}-{len(runs)}"
        return self.outcome(name, text, bodies=bodies, box=[(-0.02, 0.02)] * 3, ranks=ranks)

    def heaps(self):
        """name -> largest deviation of a heap from the same heap, computed in another order or in several runs."""
        one, two = f"run {HEAP_STEPS}\n", f"run {HEAP_STEPS // 2}\n" * 2
        often = f"run {HEAP_STEPS} every 10 NULL\n"
        heap = cache(self.heap)

        def row(*ways):
            a, b = (heap(runs, **options) for runs, options in ways)
            return (self.over_scale(a - b, b).max(), None)

        return {
            "heap, rows reversed": lambda: row((one, {"reverse": True}), (one, {})),
            "heap, rows reversed, two runs": lambda: row((two, {"reverse": True}), (two, {})),
            "heap, rows reversed, runs of 10 steps": lambda: row((often, {"reverse": True}), (often, {})),
            "heap, 2 ranks, two runs": lambda: row((two, {"ranks": 2}), (two, {})),
            "heap, two runs in place of one": lambda: row((two, {}), (one, {})),
            "heap, runs of 10 steps in place of one": lambda: row((often, {}), (one, {})),
        }

    def variants(self):
        """name -> outcome; the names are the rows of the table in the documentation."""
        b = self.bodies
        swapped = replace(b, ids=b.ids[::-1].copy())
        local = (
            "compute c all pair/gran/local id force_normal history delta\ndump l all local 10 local.txt c_c[1] c_c[4]\n"
        )
        return {
            "swap of i and j": lambda: self.outcome("swap", self.deck(), bodies=swapped),
            "neighbour list built every step": lambda: self.outcome("every", self.deck(neigh=EVERY_STEP)),
            "atoms sorted while touching": lambda: self.outcome("sort", self.deck(neigh=EVERY_STEP, sort="1 0.0125")),
            "migration between 2 ranks": lambda: self.outcome(
                "ranks", self.deck(neigh=EVERY_STEP, ranks=(2, 1, 1)), ranks=2
            ),
            "periodic face": lambda: self.outcome(
                "periodic", self.deck(neigh=EVERY_STEP, boundary="p f f"), box=PERIODIC
            ),
            "run split in two": lambda: self.outcome("split", self.deck(body=f"run {MIDDLE}\nrun {STEPS - MIDDLE}\n")),
            "reset_timestep while touching": lambda: self.outcome(
                "reset", self.deck(body=f"run {MIDDLE}\nreset_timestep 7\nrun {STEPS - MIDDLE}\n")
            ),
            "local computes every 10 steps": lambda: self.outcome("local", self.deck(before=local)),
            "restart while touching": lambda: self.restart(),
            "restart, models from the file": lambda: self.restart(style=False),
            "restart from 1 rank to 2": lambda: self.restart(ranks=2),
            "wall as a mesh": lambda: self.outcome("mesh", self.deck(wall="mesh")),
            "mesh wall, restart while touching": lambda: self.restart(wall="mesh"),
            "mesh wall, 2 ranks": lambda: self.outcome(
                "mesh2", self.deck(wall="mesh", neigh=EVERY_STEP, ranks=(2, 1, 1)), ranks=2
            ),
        }

    def restart(self, *, ranks=1, style=True, wall="primitive"):
        name = f"restart-{ranks}-{style}-{wall}"
        stop = self.deck(wall=wall, body=f"run {MIDDLE}\nwrite_restart ../{name}.restart\n")
        self.outcome(f"{name}-first", stop)
        go_on = self.deck(
            wall=wall, restart=f"../{name}.restart", style=style, body=f"run {STEPS - MIDDLE}\n", ranks=(ranks, 1, 1)
        )
        return self.outcome(name, go_on, ranks=ranks)

    @cached_property
    def rows(self):
        """name -> function that computes once the largest deviation of (pairs, wall impacts). The deviation is relative
        to the largest velocity or spin; for other rows the first number is described there."""
        runs = {name: cache(run) for name, run in self.variants().items()}
        rows = {"momentum of a pair": lambda: (self.momentum(self.plain), None)}
        for name, run in runs.items():
            rows[name] = partial(self.deviation, run)
            if name == "migration between 2 ranks":
                rows["momentum of a pair on 2 ranks"] = lambda run=run: (self.momentum(run()), None)
        rows["rigid rotation, one revolution"] = lambda: (self.revolution(), None)
        rows["second impact in one list"] = lambda: (self.second_impact(fast=False), None)
        rows["second impact, fast parting"] = lambda: (self.second_impact(fast=True), None)
        rows |= self.heaps()
        return {name: cache(row) for name, row in rows.items()}

    @staticmethod
    def over_scale(off, outcome):
        """Absolute deviations of velocities and spins over the largest velocity and spin."""
        return np.abs(off) / np.repeat([np.abs(outcome[:, :3]).max(), np.abs(outcome[:, 3:]).max()], 3)

    def deviation(self, run):
        """Largest deviation of (pairs, wall impacts) of a run from the plain one."""
        off = self.over_scale(run() - self.plain, self.plain)
        return off[: 2 * N].max(), off[2 * N :].max()

    def deviations(self):
        """name -> numbers of all rows."""
        return {name: row() for name, row in self.rows.items()}
