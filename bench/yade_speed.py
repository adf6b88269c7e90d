# SPDX-License-Identifier: GPL-2.0-or-later
"""What a contact costs in YADE per step: our laws against YADE's own Hertz-Mindlin law. Takes half a minute.

    .venv/bin/python bench/yade_speed.py [rounds] [folder of epdem_yade.so]

With a folder the classes of epdem_yade are measured beside the decks' laws.

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

ROOT = Path(__file__).resolve().parents[1]
CLASSES = tuple(f"C++ {law}" for law in ("Hertz", "Thornton", "Johnson", "Cavity"))
LAWS = ("native", "hertz", "thornton", "thornton 1e-6", "johnson", "cavity")  # 1e-6: tolerance, else 0
SIDE = 14  # spheres along an edge
STATES = ("rest", "yielding", "rest after yield")
AT_REST, LIMIT = (0, 2), 2.5

SCRIPT = """
import json, sys, time
sys.path.insert(0, {python!r})
from yade import O
from yade.utils import sphere
from yade.wrapper import *

law, side, R, overlap = {law!r}, {side}, 0.01, 1e-7
if law == "native":
    steel = FrictMat(young=208e9, poisson=0.3, density=7850, frictionAngle=0.3)
    O.materials.append(steel)
    loop = [InteractionLoop([Ig2_Sphere_Sphere_ScGeom()], [Ip2_FrictMat_FrictMat_MindlinPhys()],
                            [Law2_ScGeom_MindlinPhys_Mindlin()])]
elif law.startswith("C++"):
    sys.path.insert(0, {module!r})
    import epdem_yade
    steel = epdem_yade.EpMat(young=208e9, poisson=0.3, density=7850, frictionAngle=0.3, yieldPressure=2.8e9,
                             yieldStress=1e9)
    O.materials.append(steel)
    loop = [InteractionLoop([Ig2_Sphere_Sphere_ScGeom()], [epdem_yade.Ip2_EpMat_EpMat_EpPhys()],
                            [getattr(epdem_yade, "Law2_ScGeom_EpPhys_" + law.split()[1])()])]
else:
    from epdem.yade.deck_modules.contacts import Contacts
    law, *tolerance = law.split()
    contacts = Contacts(law, tolerance=float(*tolerance))
    strength = dict(hertz={{}}, cavity=dict(yield_stress=1e9)).get(law, dict(yield_pressure=2.8e9))
    steel = contacts.material("steel", young_modulus=208e9, poisson_ratio=0.3, density=7850, friction=0.3, **strength)
    loop = contacts.engines()
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
    path.write_text(SCRIPT.format(python=str(ROOT / "python"), module=module, law=law, side=SIDE))
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


def measure(rounds: int = 3, module: str | None = None) -> tuple[dict[str, list[float]], int]:
    """Best times of every law, laws interleaved."""
    best: dict[str, list[float]] = {}
    with tempfile.TemporaryDirectory() as folder:
        for _ in range(rounds):
            for law in (*LAWS, *CLASSES) if module else LAWS:
                times, n = once(law, Path(folder), module or "")
                best[law] = [min(a, b) for a, b in zip(times, best.get(law, times), strict=True)]
    return best, n


def main() -> int:
    """Print the table; 1 if a contact at rest costs more than LIMIT times that of YADE's own law."""
    best, n = measure(int(sys.argv[1]) if len(sys.argv) > 1 else 3, sys.argv[2] if len(sys.argv) > 2 else None)
    print(f"{n} contacts, microseconds per contact and step (and over YADE's own Hertz-Mindlin)")
    print(f"{'law':14}" + "".join(f"{s:>24}" for s in STATES))
    for law, times in best.items():
        cells = (f"{t:.3f} ({t / own:.2f})" for t, own in zip(times, best["native"], strict=True))
        print(f"{law:14}" + "".join(f"{c:>24}" for c in cells))
    worst = max(times[k] / best["native"][k] for times in best.values() for k in AT_REST)
    print(f"at rest at most {worst:.2f} (limit {LIMIT}: {'kept' if worst <= LIMIT else 'EXCEEDED'})")
    return int(worst > LIMIT)


if __name__ == "__main__":
    sys.exit(main())
