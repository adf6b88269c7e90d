# SPDX-License-Identifier: GPL-2.0-or-later
"""Nothing stands in an impact deck that its case does not need: each line is removed in turn.

The removal must break the run or change a result, but for comments, the output that was asked for, and guards, which
carry their reason in the deck.
"""

import itertools
import re
import sys
from pathlib import Path

import pytest

sys.path.append(str(Path(__file__).parents[1] / "scenes"))
from removals import removals

from epdem.case.impact import Numerics, parse
from epdem.case.toml import read_toml
from epdem.engines import engine
from epdem.impacts.experiment import experiment
from epdem.impacts.plan import plan
from epdem.impacts.prediction import predict
from marks import thorough

pytestmark = pytest.mark.liggghts
CASES = Path(__file__).parents[2] / "cases"
IMPACTS = [p for p in sorted(CASES.glob("*.toml")) if "impact" in read_toml(p)]


def small(path: Path, law: str | None):
    """Two speeds in one phase at 40 steps: enough to see any line work."""
    data = read_toml(path)
    speeds = parse(data, path).impact.speed_values()
    data["impact"]["speeds"] = [f"{speeds[0]} m/s", f"{speeds[-1]} m/s"]
    case = parse(data, path).model_copy(update={"numerics": Numerics(steps_in_contact=40, phases=1)})
    x = experiment(case, law)
    return plan(x, predict(x))


def forms() -> dict[str, tuple[Path, str | None]]:
    """A case and its law for each form of a deck, which is its lines without their numbers."""
    found: dict[str, tuple[Path, str | None]] = {}
    for path, law in itertools.product(IMPACTS, (None, "hertz")):
        lines = engine("liggghts").files(small(path, law))["in.impact"].splitlines()
        form = "\n".join(re.sub(r"-?\d[\d.e+-]*", "0", line) for line in lines if not line.startswith("#"))
        found.setdefault(form, (path, law))
    return found


@pytest.mark.parametrize(
    ("path", "law"),
    [thorough(*form, unless=n % 5 == 0) for n, form in enumerate(forms().values())],
    ids=lambda x: getattr(x, "stem", x),
)
def test_every_line_of_the_deck_is_needed(path, law, tmp_path):
    """Of the output only the dumps count, not the rows."""
    engine("liggghts").write(small(path, law), tmp_path / "whole")
    found = removals(tmp_path / "whole", tmp_path / "without", "in.impact", ["in.impact"], rows=False)
    assert [x.line for x in found if x.effect == "nothing"] == []
