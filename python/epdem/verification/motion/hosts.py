# SPDX-License-Identifier: GPL-2.0-or-later
"""Prescribed motions of two spheres in the C library, and in decks of LIGGGHTS, LAMMPS and YADE that set both spheres
in every step."""

from abc import abstractmethod
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from ...base import rendering as decks
from ...engines.embedded import Embedded
from ...engines.host import Host
from ...engines.input_script import data_text, equal_spheres
from ...engines.lammps.engine import Lammps
from ...engines.lammps.tables import impact_frames
from ...engines.liggghts import dump
from ...engines.liggghts.engine import Liggghts
from ...engines.yade import launcher as yade
from ...engines.yade.engine import Yade
from ...errors import EngineError
from ...impacts.plan import Group
from ...laws.library import Array
from .. import native
from .prescribed import Loads, Motion, MotionEngine, Touch, unit_normals


class EmbeddedMotions(MotionEngine):
    """One contact, without any other program."""

    host = Embedded

    def loads(self, touch: Touch, motion: Motion, folder: Path) -> Loads:
        x, dt = touch.experiment, motion.time_step
        normal, apart = unit_normals(motion), motion.place[:, 0] - motion.place[:, 1]
        distance = np.linalg.norm(apart, axis=1)[:, None]
        overlap = sum(touch.radii) - distance
        arm = np.array(touch.radii) - 0.5 * overlap  # to the middle of the overlap, of each body
        v = motion.velocity[:, 0] - motion.velocity[:, 1]
        opening = (v * normal).sum(axis=1)[:, None]
        slip = dt * (v - opening * normal + np.cross(normal, (arm[:, :, None] * motion.spin).sum(axis=1)))
        turn = 0.5 * dt * (motion.spin.sum(axis=1) * normal).sum(axis=1)[:, None]
        out = native.motion(
            x.native_law(),
            np.hstack([overlap, -dt * opening, normal, slip, turn]),
            R_star=x.R_star,
            G_star=x.G_star,
            mu=touch.friction,
            nodes=touch.nodes,
        )
        friction = out[:, 1:]
        force = out[:, :1] * normal + friction
        torque = -arm[:, :, None] * np.cross(normal, friction)[:, None, :]
        return Loads(np.stack([force, -force], axis=1), torque, out[:, 0])


class HostMotions(MotionEngine):
    """A host with a law and a friction of ours. path: file with the forces that the deck `script` writes."""

    tool: Host
    template: str
    script, path = "in.motion", "path.bin"

    def loads(self, touch: Touch, motion: Motion, folder: Path) -> Loads:
        self.tool.put(self.files(touch, motion), folder)
        path = folder / self.path
        path.unlink(missing_ok=True)
        self.tool.start(self.script, folder, seconds=300 + 0.01 * motion.steps)
        try:
            return self.read(path, motion.steps)
        except (OSError, ValueError) as error:
            out = self.tool.launcher.OUT
            raise EngineError(f"{path}: the run left no result ({error}); see {out} beside it") from None

    def read(self, path: Path, steps: int) -> Loads:
        """Forces and torques of every step. Raises EngineError, OSError, ValueError."""
        found = self.samples(path, steps + 1)[1:].reshape(steps, 2, 2, 3)  # the first frame is the start
        return Loads(found[:, :, 0], found[:, :, 1])

    def samples(self, path: Path, frames: int) -> Array:
        """Forces and torques of both spheres in each frame."""
        return dump.series(path).reshape(frames, 2, -1)

    def files(self, touch: Touch, motion: Motion) -> dict[str, str]:
        """Deck and steps of a motion by name; they run by hand in one folder. Raises CaseError."""
        plan = touch.plan(motion)
        deck = self.tool.deck(plan, touch.model(plan))
        said = f"{motion.name}: {motion.steps} steps of a prescribed motion, law {touch.experiment.law.name}"
        (steps, _), *_ = data = list(self.data(touch, motion, deck))
        return {self.script: decks.render(self.template, deck=deck, summary=said, steps=steps), **dict(data)}

    @abstractmethod
    def data(self, touch: Touch, motion: Motion, deck: Any) -> Iterator[tuple[str, str]]:
        """Name and text of the file of the steps, then of other files."""


class LiggghtsMotions(HostMotions):
    """LIGGGHTS. words: of `set` for place, velocity and spin of a sphere."""

    host: type[Host] = Liggghts
    template = "verification/liggghts/motion.in.j2"
    words = " ".join(f"{name}{axis} {{}}" for name in ("", "v", "omega") for axis in "xyz")

    def data(self, touch: Touch, motion: Motion, deck: Any) -> Iterator[tuple[str, str]]:
        yield "motion.steps", "".join(self._steps(motion))
        x, types, reach = touch.experiment, len(deck.types), 4 * max(touch.radii)
        box = [float(x) for a in motion.place.reshape(-1, 3).T for x in (a.min() - reach, a.max() + reach)]
        sides = [Group(b, motion.place[:1, k], motion.velocity[:1, k]) for k, b in enumerate((x.body, x.target))]
        rows = [row for kind, g in zip((1, types), sides, strict=True) for row in equal_spheres(kind, g)]
        yield "motion.data", data_text(motion.name, types, box, rows)  # the target is of the last type

    def _steps(self, motion: Motion) -> Iterator[str]:
        for bodies in motion.states.tolist():
            for id, values in enumerate(bodies, 1):
                yield f"set atom {id} {self.words.format(*map(decks.number, values))}\n"
            yield "run 1 pre no post no\n"


class LammpsMotions(LiggghtsMotions):
    """LAMMPS."""

    host = Lammps
    template, path = "verification/lammps/motion.in.j2", "path.txt"
    words = "x {} y {} z {} vx {} vy {} vz {} omega {} {} {}"

    def samples(self, path: Path, frames: int) -> Array:
        return impact_frames(path, frames, 2)


class YadeMotions(HostMotions):
    """YADE with the classes of epdem_yade, without an integrator."""

    host = Yade
    tool: Yade
    template, script, path = "verification/yade/motion.py.j2", "motion.py", "path.npy"

    def missing(self) -> str | None:
        if (reason := super().missing()) or self.tool.classes:
            return reason
        return f"motions need the module epdem_yade, which is not built; {yade.BUILD}"

    def read(self, path: Path, steps: int) -> Loads:
        table = np.load(path).reshape(steps, 13)
        found = table[:, 1:].reshape(steps, 2, 2, 3)
        return Loads(found[:, :, 0], found[:, :, 1], table[:, 0])

    def data(self, touch: Touch, motion: Motion, deck: Any) -> Iterator[tuple[str, str]]:
        rows = (" ".join(map(decks.number, row)) for row in motion.states.reshape(motion.steps, 18).tolist())
        yield "motion.txt", "\n".join(["# of i, then of j: x y z [m], v [m/s], omega [rad/s]", *rows, ""])
