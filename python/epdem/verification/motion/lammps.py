# SPDX-License-Identifier: GPL-2.0-or-later
"""Prescribed motions of two spheres in LAMMPS: every step sets both, then runs once."""

from pathlib import Path

from ...engines.lammps import launcher
from ...engines.lammps.engine import Lammps
from ...engines.lammps.tables import impact_frames
from ...laws.library import Array
from .liggghts import LiggghtsMotions

SET = "x {} y {} z {} vx {} vy {} vz {} omega {} {} {}"


class LammpsMotions(LiggghtsMotions):
    """LAMMPS with a law and a friction of ours."""

    name, host, features = Lammps.name, Lammps, Lammps.features
    template, path, words, launcher = "verification/lammps/motion.in.j2", "path.txt", SET, launcher

    def read(self, path: Path, steps: int) -> Array:
        return impact_frames(path, steps + 1, 2)
