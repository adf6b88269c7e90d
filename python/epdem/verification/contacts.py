# SPDX-License-Identifier: GPL-2.0-or-later
"""Tests of plastic contacts as data: a file in the form of LAMMPS's unittest/granular, and a prescribed motion.

Every engine computes the forces of the motion; LAMMPS also runs the first file as LAMMPS's own test program does. The
references are in the files.
"""

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import product
from pathlib import Path
from string import Template
from typing import Any

import numpy as np

from ..api.files import Case
from ..base import paths
from ..base.files import results_folder, write_texts
from ..case.sizes import LARGEST_FILE
from ..case.toml import text_of
from ..engines.lammps import launcher
from ..errors import CaseError, EngineError
from ..impacts.experiment import experiment
from ..jobs.engine import require
from ..laws.library import Array
from ..laws.strengths import find_law
from .motion.compare import engine
from .motion.prescribed import Loads, Motion, MotionEngine, Touch, columns_of, read
from .runner import STUDIES, Outcome, Progress, Row, run, silent

DECK = "in.contacts"
NEEDED = ("variables", "pair_style", "pair_coeff", "pre_commands", "post_commands", "run_segments", "epsilon")


@dataclass(frozen=True)
class ContactTest:
    """keys: of the YAML file; reference: forces and torques of the motion."""

    name: str
    keys: dict[str, Any]
    motion: Motion
    reference: Loads

    @property
    def variables(self) -> dict[str, str]:
        """By name, as text."""
        pairs = (line.split(maxsplit=1) for line in self.lines("variables"))
        return {pair[0]: pair[1] for pair in pairs if len(pair) == 2}

    def value(self, name: str) -> float:
        """A variable. Raises CaseError."""
        try:
            return float(self.variables[name])
        except (KeyError, ValueError):
            raise CaseError(f"{self.name}.yaml: variables: {name} is missing or not a number") from None

    def lines(self, key: str) -> list[str]:
        """The commands of a block."""
        return [line.strip() for line in str(self.keys[key] or "").splitlines() if line.strip()]

    def table(self, key: str) -> Array:
        """Rows of segment, id, three numbers."""
        return np.array([line.split() for line in self.lines(key)], float)

    def touch(self) -> Touch:
        """The spheres, law and friction that pair_coeff and the variables name. Raises CaseError.

        One line for all types, or a line of each of two types and one of their pair, which has the friction.
        """
        lines = [Template(line).safe_substitute(self.variables).split() for line in self.lines("pair_coeff")]
        types = [words for words in lines if words[0] == words[1]]
        law, options = types[0][2], lines[-1][2:]
        declared, strength = find_law(law).parameters, find_law(law).strength
        materials: dict[str, dict[str, float]] = {}
        numbers: dict[str, float] = {}
        for name, words in zip(("steel", "other"), types, strict=False):
            numbers = dict(zip((p.name for p in declared), map(float, words[5 : 5 + len(declared)]), strict=False))
            E, nu = map(float, words[3:5])
            materials[name] = {"young_modulus": E, "poisson_ratio": nu, "density": self.value("dens")}
            if len(types) > 1 and strength:  # each has its own
                materials[name]["yield_stress"] = numbers.pop(strength)
                numbers[f"{strength}_ratio"] = 1.0
        names = list(materials)
        spheres = [{"radius": self.value("diam") / 2, "material": name} for name in (names[0], names[-1])]
        case = Case(
            case={"name": self.name},
            materials=materials,
            impact={"kind": "sphere-sphere", "body": spheres[0], "target": spheres[1], "speeds": [1.0]},
            law={"name": law} | numbers,
        )
        x = experiment(case.model)
        if "tangential" not in options:
            return Touch(x, 0.0, "history")
        friction = options.index("tangential")
        return Touch(x, float(options[friction + 2]), options[friction + 1])  # type: ignore[arg-type]


def stored_tests() -> list[Path]:
    """The YAML files of data/plastic_contacts."""
    return sorted(paths.beside("data").glob("plastic_contacts/*.yaml"))


def read_test(path: Path) -> ContactTest:
    """The test of a YAML file and of the CSV file beside it. Raises CaseError."""
    import yaml

    try:
        keys = yaml.safe_load(text_of(path, LARGEST_FILE))
    except yaml.YAMLError as error:
        raise CaseError(f"{path}: not YAML ({' '.join(str(error).split())})") from None
    if not isinstance(keys, dict):
        raise CaseError(f"{path}: not a mapping with the keys {', '.join(NEEDED)}")
    if lacking := [key for key in NEEDED if key not in keys]:
        raise CaseError(f"{path}: {', '.join(lacking)} missing")
    table = path.with_suffix(".csv")
    columns = columns_of(table)
    if lacking := [name for name in ("F_i", "F_j", "T_i", "T_j") if name not in columns]:
        raise CaseError(f"{table}: {', '.join(lacking)} missing: the references of forces and torques")
    force, torque = (np.stack([columns[f"{name}_{side}"] for side in "ij"], axis=1) for name in "FT")
    return ContactTest(path.stem, keys, read(table), Loads(force, torque))


def compare(
    files: Sequence[Path] = (),
    *,
    engines: Sequence[str] = (),
    out: Path | None = None,
    force: bool = False,
    progress: Progress = silent,
) -> Outcome:
    """Run the tests of `files`, else the stored ones, on each engine. Raises CaseError, EngineError.

    Rows: case, engine, quantity, error, tolerance.
    """
    tools = STUDIES["contacts"].tools(engines, engine)
    tests = [read_test(path) for path in files or stored_tests()]
    require(*tools)
    folder = results_folder(out, "plastic_contacts")
    return run("contacts", _rows(tests, tools, folder, progress), folder, force=force)


def _rows(tests: list[ContactTest], tools: list[MotionEngine], folder: Path, progress: Progress) -> Iterator[Row]:
    for test, tool in product(tests, tools):
        progress(f"{test.name}, {tool.name}")
        found = motion_errors(test, tool, folder / tool.name / test.name)
        if tool.name == "lammps":
            found |= dynamic_errors(test, folder / tool.name / test.name / "impact")
        for name, (error, limit) in found.items():
            yield {"case": test.name, "engine": tool.name, "quantity": name, "error": error, "tolerance": limit}


def motion_errors(test: ContactTest, tool: MotionEngine, folder: Path) -> dict[str, tuple[float, float]]:
    """(error, tolerance) of forces and torques: over the largest force, torques also over the smaller radius."""
    touch, limit = test.touch(), test.value("force_tol")
    found, scale = tool.loads(touch, test.motion, folder), test.reference.peak
    off = np.linalg.norm(found.force - test.reference.force, axis=2).max()
    turning = np.linalg.norm(found.torque - test.reference.torque, axis=2).max() / min(touch.radii)
    return {"force": (float(off / scale), limit), "torque": (float(turning / scale), limit)}


def deck(test: ContactTest) -> str:
    """Script that repeats LAMMPS's test program on the file and writes the state after each segment."""
    lines = ["newton on", *(f"variable {name} index {value}" for name, value in test.variables.items())]
    lines += [*test.lines("pre_commands"), f"pair_style {test.keys['pair_style']}"]
    lines += [f"pair_coeff {line}" for line in test.lines("pair_coeff")]
    lines += [*test.lines("post_commands"), "run 0 post no"]
    columns = "id x y z vx vy vz omegax omegay omegaz"
    for k, steps in enumerate(str(test.keys["run_segments"]).split()):
        state = f"write_dump all custom state.{k}.txt {columns} modify sort id header no format float %.17g"
        lines += [f"run {steps} post no", state]
    return "\n".join(lines) + "\n"


def dynamic_errors(test: ContactTest, folder: Path) -> dict[str, tuple[float, float]]:
    """(error, tolerance) of positions, velocities and spins after each segment, and of the restitution, in LAMMPS."""
    write_texts(folder, {DECK: deck(test)})
    launcher.run(DECK, folder, seconds=120)
    segments, states = len(str(test.keys["run_segments"]).split()), []
    for k in range(segments):
        try:
            states.append(np.loadtxt(folder / f"state.{k}.txt", ndmin=2))
        except (OSError, ValueError) as error:
            raise EngineError(f"{folder}/state.{k}.txt: no state ({error}); see {launcher.OUT} beside it") from None
    found, epsilon = {}, float(test.keys["epsilon"])
    for name, key, at in (("position", "run_pos", 1), ("velocity", "run_vel", 4), ("spin", "run_omega", 7)):
        if key in test.keys:
            table = test.table(key)
            values = np.array([states[int(row[0])][int(row[1]) - 1, at : at + 3] for row in table])
            found[name] = deviation(values, table[:, 2:]), epsilon
    if re.fullmatch("yes|true", str(test.keys.get("analytic_enable")), re.IGNORECASE):
        if test.keys["analytic_model"] != "collision_restitution":
            raise CaseError(
                f"{test.name}.yaml: analytic_model = {test.keys['analytic_model']}, must be collision_restitution"
            )
        v = states[int(test.keys["analytic_segment"])][:, 4]
        e_n, expected = -(v[0] - v[1]) / (2 * test.value("vin")), test.value("en")
        found["e_n"] = float(abs(e_n - expected) / abs(expected)), float(test.keys["analytic_tol"])
    return found


def deviation(found: Array, expected: Array) -> float:
    """The largest difference over the smaller one of both numbers; the difference itself where one is 0."""
    least = np.minimum(np.abs(found), np.abs(expected))
    return float((np.abs(found - expected) / np.where(least == 0, 1.0, least)).max())
