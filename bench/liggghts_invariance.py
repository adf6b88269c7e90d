# SPDX-License-Identifier: GPL-2.0-or-later
"""Writes docs/invariance.md: which contact models give the same answer however a scene is told to LIGGGHTS.

Run: .venv/bin/python bench/liggghts_invariance.py
"""

import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tests" / "engines"))

from plugin_decks import LAWS  # noqa: E402
from plugin_invariance import Suite  # noqa: E402

MODELS = (*(f"ep/{law}" for law in LAWS), "hertz", "thornton_ning", "edinburgh")

HEAD = """# One scene, told in other ways

Written by `.venv/bin/python bench/liggghts_invariance.py`; do not edit.

24 oblique impacts (12 pairs of unequal spheres of three materials, 12 spheres on a wall) with `tangential history`
drift across a face while they touch. Each row tells LIGGGHTS the same scene in another way, and shows the largest
deviation of any final velocity or spin from the plain run, relative to the largest velocity or spin of the scene:
0 is bitwise equal. Rows about momentum give the change of a pair's momentum relative to what its bodies exchanged.
The scene is in `tests/engines/plugin_invariance.py`; `tests/engines/test_plugin_invariance.py` asserts the columns of
epdem and the main failures of the others.

"""

TAIL = """
Why the others fail: `thornton_ning` and `edinburgh` register even quantities (largest overlap, force, flags) with the
newton flag 1, so LIGGGHTS negates them when a pair is stored from its other side, and they register no contact
distance factor, so nothing tells them that a pair parted before the next neighbour list. The shear spring of `hertz`
with `tangential history` survives for the same reason. Their viscous force reads velocities in the middle of a step, so
a split run differs slightly; `hertz` also leaves its setting `tangential_damping` unset when a restart file creates it.
"""


def cell(values):
    worst = max(v for v in values if v is not None)
    return "0" if worst == 0 else f"{worst:.0e}"


def main():
    with tempfile.TemporaryDirectory() as folder:
        columns = {model: Suite(model, Path(folder) / model.replace("/", "-")).deviations() for model in MODELS}
    lines = ["| way | " + " | ".join(MODELS) + " |", "|---" * (len(MODELS) + 1) + "|"]
    for name in columns[MODELS[0]]:
        lines.append(f"| {name} | " + " | ".join(cell(columns[m][name]) for m in MODELS) + " |")
    text = HEAD + "\n".join(lines) + "\n" + TAIL
    (ROOT / "docs").mkdir(exist_ok=True)
    (ROOT / "docs" / "invariance.md").write_text(text)
    print(text)


if __name__ == "__main__":
    main()
