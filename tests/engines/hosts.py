# SPDX-License-Identifier: GPL-2.0-or-later
"""Impacts in every host: cases with another law, target, speeds or steps, run by the engine of the host."""

from dataclasses import replace
from itertools import product
from pathlib import Path

import numpy as np
import pytest

from epdem.base.declarations import declarations
from epdem.case.impact import Numerics, parse
from epdem.case.toml import read_toml
from epdem.engines import engine
from epdem.impacts.experiment import experiment
from epdem.impacts.plan import plan
from epdem.impacts.prediction import predict

CASES = Path(__file__).resolve().parents[2] / "cases"
LAWS = [name for name, law in declarations().items() if not law.adheres]
ADHESIVE = [name for name, law in declarations().items() if law.adheres]

EMBEDDED = pytest.param("embedded", id="embedded")
LIGGGHTS = pytest.param("liggghts", marks=pytest.mark.liggghts, id="liggghts")
LAMMPS = pytest.param("lammps", marks=pytest.mark.lammps, id="lammps")
YADE = pytest.param("yade", marks=pytest.mark.yade, id="yade")  # with the C library in the deck
CLASSES = pytest.param("yade", marks=pytest.mark.yade("module"), id="yade-classes")

BRASS = {"young_modulus": "100 GPa", "poisson_ratio": 0.35, "density": "8500 kg/m^3", "yield_stress": "0.3 GPa"}
TARGETS = {
    "wall": {},
    "sphere": {"kind": "sphere-sphere", "target": {"material": "brass", "radius": "4 mm"}},
    "rigid": {"target": {"material": "rigid"}},
}


def on(hosts, *values, rare=lambda *choice: False):
    """Parameters (host, value of each of `values`); those that are `rare` are for `make thorough` alone."""
    found = []
    for host, *choice in product(hosts, *values):
        marks = [*host.marks, pytest.mark.thorough] if rare(host.id, *choice) else host.marks
        found.append(pytest.param(*host.values, *choice, marks=marks, id="-".join([host.id, *choice])))
    return found


def prepared(case="steel_wall", law=None, *, steps=100, speed=None, yield_stress=None, restitution=None, **tables):
    """(plan, prediction) of a case with other values of its tables; speed: array [m/s] in place of the case's."""
    data = read_toml(CASES / f"{case}.toml")
    data["materials"]["brass"] = BRASS
    if yield_stress:
        data["materials"]["steel"]["yield_stress"] = yield_stress
    for name, table in tables.items():
        data[name] = data.get(name, {}) | table
    if law == "meyer":
        law = {"name": law, "hardening_exponent": 0.3}
    if isinstance(law, dict):
        data["law"], law = law, law["name"]
    numerics = Numerics(steps_in_contact=steps, phases=8)
    x = experiment(parse(data, "test").model_copy(update={"numerics": numerics}), law)
    if speed is not None:
        x = replace(x, speed=np.asarray(speed))
    if restitution is not None:
        x = replace(x, viscous_restitution=restitution)
    prediction = predict(x)
    return plan(x, prediction), prediction


def run(name, p, folder, **how):
    """The samples of the impacts of a plan."""
    tool = engine(name)
    tool.write(p, folder)
    return tool.run(p, folder, **how)


def largest_share(p, a, b):
    """Largest difference of overlap, force and velocity of any impact, over the largest value of that impact."""
    shares = []
    for quantity in ("overlap", "force", "velocity"):
        ours, theirs = getattr(a, quantity), getattr(b, quantity)
        assert ours.shape == theirs.shape == (p.n, p.steps + 1)
        known = np.isfinite(theirs)
        difference = np.abs(np.where(known, ours - theirs, 0.0)).max(axis=1)
        shares.append((difference / np.where(known, np.abs(theirs), 0.0).max(axis=1)).max())
    return max(shares)
