# SPDX-License-Identifier: GPL-2.0-or-later
"""Stored renderings of decks, and the plan of an impact of which most are."""

import re
from pathlib import Path

import pytest

from epdem.case.impact import parse
from epdem.case.toml import read_toml
from epdem.engines import scene_engine, texts_with_reasons
from epdem.impacts.experiment import experiment
from epdem.impacts.plan import Plan, plan
from epdem.impacts.prediction import predict
from epdem.scenes.plan.plan import ScenePlan

CASES = Path(__file__).parents[1] / "cases"
BRASS = {"young_modulus": "100 GPa", "poisson_ratio": 0.35, "density": "8500 kg/m^3", "yield_stress": "0.3 GPa"}
SPHERE = {"kind": "sphere-sphere", "target": {"material": "brass", "radius": "4 mm"}}


def planned(changes, law=None):
    data = read_toml(CASES / "steel_wall.toml")
    data["materials"]["brass"] = BRASS
    data["impact"] |= changes
    x = experiment(parse(data, "test"), law)
    return plan(x, predict(x))


def compare(folder: Path, name: str, text: str) -> None:
    """A change of a deck is seen in review: to store it anew, delete the file in `stored` and run twice."""
    stored = folder / "stored" / f"{name}.in"
    if not stored.exists():
        stored.parent.mkdir(exist_ok=True)
        stored.write_text(text)
        pytest.fail(f"{stored} did not exist and was written; look at it and run again")
    assert rounded(text) == rounded(stored.read_text())


def checked_deck(p: ScenePlan) -> dict[str, str]:
    """The texts of a scene's LIGGGHTS files by their path. Raises CaseError."""
    engine = scene_engine("liggghts")
    engine.check(p)
    return engine.files(p)


def reasons(job: Plan | ScenePlan) -> list[tuple[str, str, str]]:
    """(file, line, reason) of every line of a LIGGGHTS deck that does something."""
    scripts = {name: text for name, text in texts_with_reasons("liggghts", job).items() if "in" in name.split(".")}
    split = [(name, *line.partition("  # ")[::2]) for name, text in scripts.items() for line in text.split("\n")]
    return [(name, line.rstrip(), reason) for name, line, reason in split if line.strip() and line[0] != "#"]


def rounded(text: str) -> str:
    """The deck of any version, long numbers to 10 digits: the last ones follow the rounding of theory's quadrature."""
    text = re.sub(r"(?m)^# epdem [^;]+;", "# epdem;", text)
    return re.sub(r"\d+\.\d{10,}(e[-+]?\d+)?", lambda number: f"{float(number[0]):.9e}", text)
