# SPDX-License-Identifier: GPL-2.0-or-later
"""The impact of Dosta et al. 2024 with YADE's own model of Hertz and Mindlin, on the spheres of spheres.csv.

    yade -n -x bench/community_yade.py spheres.csv curve.txt BEGIN END

Times in seconds. Until BEGIN the sphere falls freely and the bed rests; the run begins there. curve.txt has a line for
every 100 steps: time, height, velocity. A run that was stopped goes on from curve.state.
"""

import csv
import sys
from math import atan
from pathlib import Path

from yade import (
    Bo1_Sphere_Aabb,
    Bo1_Wall_Aabb,
    ForceResetter,
    FrictMat,
    Ig2_Sphere_Sphere_ScGeom,
    Ig2_Wall_Sphere_ScGeom,
    InsertionSortCollider,
    InteractionLoop,
    Ip2_FrictMat_FrictMat_MindlinPhys,
    Law2_ScGeom_MindlinPhys_Mindlin,
    MatchMaker,
    NewtonIntegrator,
    O,
)
from yade.utils import sphere, wall

G, DT, EVERY = 9.81, 5e-7, 100
SAVED = 25  # lines between two states
FRICTION = {(0, 0): 0.5, (0, 1): 0.2, (1, 1): 0.3}  # steel, M1
RESTITUTION = {(0, 0): 0.6, (0, 1): 0.4, (1, 1): 0.5}
WALLS = ((0, -0.05), (0, 0.05), (1, -0.03), (1, 0.03), (2, -0.090243))


def build(table: Path, begin: float) -> None:
    """The walls, the bed and, last, the sphere where it is at `begin`."""
    steel = O.materials.append(FrictMat(young=210e9, poisson=0.2, density=7200, frictionAngle=atan(0.5)))
    m1 = O.materials.append(FrictMat(young=1e9, poisson=0.2, density=2500, frictionAngle=atan(0.3)))
    for axis, at in WALLS:
        O.bodies.append(wall(at, axis, material=steel))
    with table.open(encoding="utf-8") as stream:
        for row in csv.DictReader(stream):
            O.bodies.append(sphere([float(row[k]) for k in "xyz"], float(row["radius"]), material=m1))
    place = (0.0, 0.0, 0.06 - 5.0 * begin - 0.5 * G * begin**2)
    impactor = O.bodies[O.bodies.append(sphere(place, 0.01, material=steel))]
    impactor.state.vel = (0.0, 0.0, -5.0 - G * begin)

    def pairs(values: dict[tuple[int, int], float]) -> MatchMaker:
        return MatchMaker(matches=tuple((a, b, value) for (a, b), value in values.items()))

    angles = {pair: atan(mu) for pair, mu in FRICTION.items()}
    O.engines = [
        ForceResetter(),
        InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Wall_Aabb()], verletDist=-0.1),
        InteractionLoop(
            [Ig2_Sphere_Sphere_ScGeom(), Ig2_Wall_Sphere_ScGeom(hertzian=True)],
            [Ip2_FrictMat_FrictMat_MindlinPhys(frictAngle=pairs(angles), en=pairs(RESTITUTION))],
            [Law2_ScGeom_MindlinPhys_Mindlin()],
        ),
        NewtonIntegrator(damping=0, gravity=(0, 0, -G)),
    ]
    O.dt = DT


def main(table: Path, out: Path, begin: float, end: float) -> None:
    """Run from `begin` to `end`, or from where an earlier run was stopped."""
    state = out.with_suffix(".state")
    if state.exists():
        O.load(str(state))
    else:
        build(table, begin)
    impactor = O.bodies[len(O.bodies) - 1].state
    with out.open("a", encoding="utf-8", buffering=1) as stream:
        for turn in range(round((end - begin) / DT / EVERY) - O.iter // EVERY):
            O.run(EVERY, True)
            stream.write(f"{begin + O.time:.9g} {impactor.pos[2]:.12g} {impactor.vel[2]:.12g}\n")
            if turn % SAVED == SAVED - 1:
                O.save(str(state) + ".new")
                Path(str(state) + ".new").replace(state)


if __name__ == "__main__":
    main(Path(sys.argv[-4]), Path(sys.argv[-3]), float(sys.argv[-2]), float(sys.argv[-1]))
