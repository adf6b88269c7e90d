# SPDX-License-Identifier: GPL-2.0-or-later
"""Prescribed motions of two spheres in LAMMPS: every step sets both, then runs once."""

from dataclasses import replace
from pathlib import Path

from ...base import rendering as decks
from ...engines.lammps import launcher
from ...engines.lammps.deck import ImpactDeck
from ...engines.lammps.engine import Lammps
from ...engines.lammps.tables import impact_frames
from ...laws.library import Array
from .liggghts import LiggghtsMotions
from .prescribed import Motion, Touch, summary

SET = "x {} y {} z {} vx {} vy {} vz {} omega {} {} {}"


class LammpsMotions(LiggghtsMotions):
    """LAMMPS with a law and a friction of ours."""

    name = Lammps.name
    features = Lammps.features
    template, path, words, launcher = "verification/lammps/motion.in.j2", "path.txt", SET, launcher

    def deck(self, touch: Touch, motion: Motion) -> ImpactDeck:
        plain = Lammps().deck(touch.plan(motion))
        friction = f" tangential {touch.tangential} {decks.number(touch.friction)}"
        pairs = tuple(words.partition(" tangential ")[0] + friction for words in plain.pairs)
        return replace(plain, head=replace(plain.head, summary=summary(touch, motion)), pairs=pairs)

    def read(self, path: Path, steps: int) -> Array:
        return impact_frames(path, steps + 1, 2)
