# SPDX-License-Identifier: GPL-2.0-or-later
"""What a contact costs in YADE per step: our laws against YADE's own Hertz-Mindlin law. Takes a few minutes.

    .venv/bin/python bench/yade_speed.py [rounds] [folder of epdem_yade.so]

The classes of epdem_yade (`make yade`), every law.

A cubic lattice of spheres, every sphere in contact with its neighbours: at rest before any yield; in uniform
compression, where every contact yields in every step; and at rest after it. One YADE process per law and round, laws
interleaved, the best time of all rounds counts; times are processor time of whole steps over contacts, in microseconds.
"""

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

from epdem.base.declarations import declarations
from epdem.engines.yade import launcher

NATIVE = "YADE's Hertz-Mindlin"
CLASSES = tuple(f"C++ {law.title().replace('_', '')}" for law in declarations())
# of each law that yields, by the names of its LIGGGHTS properties [Pa]
STRENGTHS = {
    law.parameter(law.strength).property: 1e9 if law.strength == "yield_stress" else 2.8e9
    for law in declarations().values()
    if law.strength
}
SIDE = 14  # spheres along an edge
STATES = ("at rest", "all yield in every step", "at rest after yield")
LIMIT = 0.9  # of the classes

SCRIPT = """
import json, sys, time
from yade import O
from yade.utils import sphere
from yade.wrapper import *

law, side, R, overlap = {law!r}, {side}, 0.01, 1e-7
if law.startswith("YADE"):
    steel = FrictMat(young=208e9, poisson=0.3, density=7850, frictionAngle=0.3)
    O.materials.append(steel)
    loop = [InteractionLoop([Ig2_Sphere_Sphere_ScGeom()], [Ip2_FrictMat_FrictMat_MindlinPhys()],
                            [Law2_ScGeom_MindlinPhys_Mindlin()])]
else:
    sys.path.insert(0, {module!r})
    import epdem_yade
    steel = epdem_yade.EpMat(young=208e9, poisson=0.3, density=7850, frictionAngle=0.3, surfaceEnergy=0.1,
                             **{strengths})
    O.materials.append(steel)
    loop = [InteractionLoop([Ig2_Sphere_Sphere_ScGeom()], [epdem_yade.Ip2_EpMat_EpMat_EpPhys()],
                            [getattr(epdem_yade, "Law2_ScGeom_EpPhys_" + law.split()[1])()])]
spacing, middle = 2 * R - overlap, 0.5 * (side - 1)
for i in range(side ** 3):
    place = [i % side - middle, i // side % side - middle, i // side ** 2 - middle]
    O.bodies.append(sphere([spacing * x for x in place], R, material=steel))
    O.bodies[-1].state.blockedDOFs = "xyzXYZ"  # the law is timed, not the motion
O.engines = [ForceResetter(), InsertionSortCollider([Bo1_Sphere_Aabb()], verletDist=0.05 * R), *loop,
             NewtonIntegrator(damping=0)]
O.dt = 1e-7
O.step()
n = O.interactions.countReal()


def steps(number, chunks=5):
    best = 1e9
    for _ in range(chunks):
        start = time.thread_time()
        for _ in range(number):
            O.step()
        best = min(best, (time.thread_time() - start) / number / n)
    return best * 1e6


def pull(rate):
    for body in O.bodies:
        body.state.vel = [-rate * x for x in body.state.pos]


rest = steps(20)
pull(2e4)  # the overlaps grow by 4e-5 m per step: beyond all yield overlaps in a few steps
O.run(4, True)
pull(50.0)
loading = steps(4)
pull(0.0)
O.run(3, True)
print("RESULT " + json.dumps([rest, loading, steps(20)]), n)
"""


def once(law: str, folder: Path, module: str) -> tuple[list[float], int]:
    """Microseconds per contact and step of one law in each of STATES, and the number of contacts."""
    path = folder / f"{law.replace(' ', '_')}.py"
    path.write_text(SCRIPT.format(module=module, law=law, side=SIDE, strengths=STRENGTHS))
    done = subprocess.run(
        ["yade", "-n", "-x", path.name],
        cwd=folder,
        capture_output=True,
        text=True,
        timeout=300,
        stdin=subprocess.DEVNULL,
        env=os.environ | {"OMP_NUM_THREADS": "1"},
    )
    lines = [t for t in done.stdout.splitlines() if t.startswith("RESULT ")]
    if done.returncode or not lines:
        raise SystemExit(done.stdout[-2000:] + done.stderr[-2000:])
    values, n = lines[0].removeprefix("RESULT ").rsplit(" ", 1)
    return json.loads(values), int(n)


def measure(rounds: int, module: Path) -> tuple[dict[str, list[float]], int]:
    """Best times of every law, laws interleaved."""
    best: dict[str, list[float]] = {}
    with tempfile.TemporaryDirectory() as folder:
        for _ in range(rounds):
            for law in (NATIVE, *CLASSES):
                times, n = once(law, Path(folder), str(module))
                best[law] = [min(a, b) for a, b in zip(times, best.get(law, times), strict=True)]
    return best, n


def main() -> int:
    """Print the table in Markdown; 1 if a contact of a class costs more than LIMIT times that of YADE's own law."""
    built = launcher.module()
    if len(sys.argv) < 3 and built is None:
        raise SystemExit(f"the module epdem_yade is not built; {launcher.BUILD}")
    module = Path(sys.argv[2]).resolve() if len(sys.argv) > 2 else built.parent
    best, n = measure(int(sys.argv[1]) if len(sys.argv) > 1 else 3, module)
    print(f"{n} contacts, microseconds per contact and step (and over YADE's own Hertz-Mindlin)")
    print("| law |" + "".join(f" {state} |" for state in STATES) + "\n|---|" + "---|" * len(STATES))
    for law, times in best.items():
        cells = (f" {t:.2f} ({t / own:.2f}) |" for t, own in zip(times, best[NATIVE], strict=True))
        print(f"| {law} |" + "".join(cells))
    ratios = {law: max(t / own for t, own in zip(best[law], best[NATIVE], strict=True)) for law in CLASSES}
    worst = max(ratios.values(), default=0.0)
    print(f"classes at most {worst:.2f} (limit {LIMIT}: {'kept' if worst <= LIMIT else 'EXCEEDED'})")
    return int(worst > LIMIT)


if __name__ == "__main__":
    sys.exit(main())
