# SPDX-License-Identifier: GPL-2.0-or-later
"""Two spheres whose motion is prescribed: the motion from a file, forces and torques of every step to files.

The names in the files are those of the tests of interactions of ON-DEM's working group 4: x, v, q, omega, F, T of the
bodies i and j.
"""

import json
import re
from abc import ABC, abstractmethod
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import numpy.typing as npt

from ...case.fields import NODES, Tangential
from ...case.sizes import LARGEST_FILE
from ...case.toml import text_of
from ...engines.input_script import impact_model
from ...errors import CaseError
from ...impacts.engine import ImpactEngine
from ...impacts.experiment import Experiment
from ...impacts.plan import Plan
from ...laws.library import Array
from ...scenes.plan.model import Model

WIDTHS = {"t": 1, "dt": 1} | {f"{name}_{side}": n for name, n in (("x", 3), ("v", 3), ("q", 4)) for side in "ij"}
WIDTHS |= {f"{name}_{side}": 3 for name in ("omega", "F", "T") for side in "ij"}
NEEDED = ("t", "x_i", "x_j", "v_i", "v_j", "omega_i", "omega_j")
MOST_STEPS = 200_000


@dataclass(frozen=True)
class Touch:
    """The spheres `body` (i) and `target` (j) of an experiment, their friction and its model."""

    experiment: Experiment
    friction: float
    tangential: Tangential

    @property
    def nodes(self) -> int:
        """Of partial slip; 0: one spring."""
        return NODES[self.tangential]

    @property
    def radii(self) -> tuple[float, float]:
        """[m]."""
        return self.experiment.body.radius, self.experiment.target.radius

    def plan(self, motion: "Motion") -> Plan:
        """Plan from which the decks of impacts are made."""
        x = self.experiment
        return Plan(x, motion.time_step, motion.steps, 1, x.speed[:1], np.zeros(1))

    def model(self, plan: Plan) -> Model:
        """The contact model of the experiment with this friction."""
        m = impact_model(plan)
        n = len(m.types)
        return replace(m, friction=((self.friction,) * n,) * n, tangential=self.tangential)


@dataclass(frozen=True)
class Motion:
    """Places [m], velocities [m/s] and spins [rad/s] of both spheres in every step, shape (n, 2, 3).

    The slip of a step is its velocity times the time step [s].
    """

    name: str
    time_step: float
    place: Array
    velocity: Array
    spin: Array

    @property
    def steps(self) -> int:
        return len(self.place)

    @property
    def states(self) -> Array:
        """Place, velocity and spin of both spheres in every step, shape (n, 2, 9)."""
        return np.concatenate([self.place, self.velocity, self.spin], axis=2)

    def columns(self) -> dict[str, Array]:
        """By the names of the files."""
        found = {"t": self.time_step * np.arange(self.steps)}
        for name, values in {"x": self.place, "v": self.velocity, "omega": self.spin}.items():
            found |= {f"{name}_{side}": values[:, k] for k, side in enumerate("ij")}
        return found


@dataclass(frozen=True)
class Loads:
    """Forces [N] and torques [N m] on both spheres in every step, shape (n, 2, 3).

    normal: the law's force alone [N], shape (n,), positive as it pushes, where the engine tells it apart.
    """

    force: Array
    torque: Array
    normal: Array | None = None

    @property
    def peak(self) -> float:
        """The largest force on a sphere [N]."""
        return float(np.linalg.norm(self.force, axis=2).max())

    def along(self, normals: Array) -> Array:
        """The law's force, or what of the whole force lies along the unit normals (n, 3)."""
        return np.einsum("nk,nk->n", self.force[:, 0], normals) if self.normal is None else self.normal

    def columns(self) -> dict[str, Array]:
        """By the names of the files."""
        both = (("F", self.force), ("T", self.torque))
        return {f"{name}_{side}": values[:, k] for name, values in both for k, side in enumerate("ij")}


class MotionEngine(ABC):
    """An engine of impacts that computes the forces of a prescribed motion."""

    host: type[ImpactEngine]
    laws: tuple[str, ...] | None = None

    def __init__(self) -> None:
        self.tool = self.host()
        self.name, self.features = self.tool.name, self.tool.features

    def missing(self) -> str | None:
        return self.tool.missing()

    @abstractmethod
    def loads(self, touch: Touch, motion: Motion, folder: Path) -> Loads:
        """Run the motion in `folder`. Raises CaseError for what the engine cannot do, EngineError."""


def unit_normals(motion: Motion) -> Array:
    """From j to i, shape (n, 3)."""
    apart = motion.place[:, 0] - motion.place[:, 1]
    return np.asarray(apart / np.linalg.norm(apart, axis=1)[:, None])


def read(path: Path) -> Motion:
    """The motion of a JSON or CSV file: t [s], x_i, x_j [m], v_i, v_j [m/s], omega_i, omega_j [rad/s].

    JSON holds lists by these names; a CSV file a line of names, each for its 3 (t: 1) columns, with commas or spaces.
    Orientations q_i, q_j (4 columns) are passed over, as spheres look the same from all sides, and other names, in a
    CSV file from the first one on. Raises CaseError.
    """
    columns = columns_of(path)
    for name in NEEDED:
        if name not in columns:
            raise CaseError(f"{path}: {name} is missing; a motion has {', '.join(NEEDED)} in every step")
    n = len(columns["t"])
    if not 2 <= n <= MOST_STEPS:
        raise CaseError(f"{path}: {n} steps, must be from 2 to {MOST_STEPS}")
    for name, values in columns.items():
        if values.shape != (n, WIDTHS[name]) or not np.isfinite(values).all():
            raise CaseError(
                f"{path}: {name} has {' x '.join(map(str, values.shape))} values, must be {n} x {WIDTHS[name]} "
                "finite numbers"
            )
    times = np.diff(columns["t"][:, 0])
    if not times[0] > 0 or np.abs(times - times[0]).max() > 1e-6 * times[0]:
        low, high = times.min(), times.max()
        raise CaseError(f"{path}: t must grow by the same step everywhere; it grows by {low:g} to {high:g} s")

    def both(name: str) -> Array:
        return np.stack([columns[f"{name}_i"], columns[f"{name}_j"]], axis=1)

    return Motion(path.stem, float(times.mean()), both("x"), both("v"), both("omega"))


def columns_of(path: Path) -> dict[str, Array]:
    """The columns of a JSON or CSV file by name, see `read`; also forces and torques. Raises CaseError."""
    text = text_of(path, LARGEST_FILE)
    return _json(path, text) if path.suffix == ".json" else _csv(path, text)


def _json(path: Path, text: str) -> dict[str, Array]:
    try:
        data = json.loads(text)
        columns = {name: np.asarray(data[name], float) for name in WIDTHS if name in data}
    except (ValueError, TypeError, RecursionError) as error:
        raise CaseError(f"{path}: not JSON of lists of numbers by name ({error})") from None
    return {name: values.reshape(len(values), -1) for name, values in columns.items() if values.size and values.ndim}


def _csv(path: Path, text: str) -> dict[str, Array]:
    lines = [(n, line.strip()) for n, line in enumerate(text.splitlines(), 1) if line.strip()]
    heads = next((line.lstrip("# ") for _, line in lines if re.match(r"[#\s]*t\b", line)), "")
    if not heads:
        raise CaseError(f"{path}: no line of names that begins with t; it is as 't,x_i,x_j,v_i,v_j,omega_i,omega_j'")
    names = re.split(r"[,\s]+", heads)
    known = names[: next((k for k, name in enumerate(names) if name not in WIDTHS), len(names))]
    width, rows = sum(WIDTHS[name] for name in known), []
    for n, line in lines:
        fields = re.split(r"[,\s]+", line)
        if line.startswith("#") or fields[0] == "t":
            continue
        try:
            rows.append([float(field) for field in fields[:width]])
        except ValueError as error:
            raise CaseError(f"{path} line {n}: {error}") from None
        if len(rows[-1]) < width:
            raise CaseError(f"{path} line {n}: {len(fields)} values, must be {width} or more")
    table, at, columns = np.array(rows).reshape(-1, width), 0, {}
    for name in known:
        columns[name] = table[:, at : at + WIDTHS[name]]
        at += WIDTHS[name]
    return columns


def text(columns: dict[str, npt.NDArray[np.float64]]) -> str:
    """The columns as JSON, every digit."""
    return json.dumps({name: values.tolist() for name, values in columns.items()})


def check_motion(touch: Touch, motion: Motion) -> None:
    """Raise CaseError for a motion in which the centres meet, or the spheres never touch."""
    distance = np.linalg.norm(motion.place[:, 0] - motion.place[:, 1], axis=1)
    small = min(touch.radii)
    if distance.min() < small:
        raise CaseError(
            f"motion {motion.name}: the centres come as near as {distance.min():g} m; the least is the smaller radius, "
            f"{small:g} m"
        )
    if distance.min() >= sum(touch.radii):
        raise CaseError(
            f"motion {motion.name}: nothing touches, the least distance is {distance.min():g} m and the radii are "
            f"{touch.radii[0]:g} and {touch.radii[1]:g} m; give the radii that the motion was made for"
        )
