# SPDX-License-Identifier: GPL-2.0-or-later
"""Writes docs/invariance.md: which contact models give the same results in every set-up of one scene in LIGGGHTS.

Run: .venv/bin/python bench/liggghts_invariance.py
"""

import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tests" / "engines"))

from plugin_decks import ADHESIVE, LAWS  # noqa: E402
from plugin_invariance import Suite  # noqa: E402

SLIPS = ("ep/thornton ep/partial_slip_2", "ep/cavity ep/partial_slip")  # with another tangential model than history
MODELS = (*(f"ep/{law}" for law in (*LAWS, *ADHESIVE)), *SLIPS, "hertz", "thornton_ning", "edinburgh")

HEAD = """# Invariance under changes of the set-up

`.venv/bin/python bench/liggghts_invariance.py` writes this page.

The scene has 24 oblique impacts (12 pairs of unequal spheres of three materials, 12 spheres on a wall). The tangential
model is `history` or the model in the head of the column. The bodies drift across a face of the box during contact.
Each row runs the scene in another set-up. A number is the largest deviation of a final velocity or spin from the plain
run, relative to the largest velocity or spin of the scene; 0 means bitwise equality. Rows of momentum show the change
of the momentum of a pair, relative to the exchanged momentum. The row of the rigid rotation is a separate scene: a
loaded and sheared pair rotates once as one body about a skew axis ([motions](motions.md)), and the number is the
relative change of the force on a sphere. The heap is a separate scene as well: 64 spheres of three materials that slide
and stick on each other for 300 steps, with dashpots (`coefficientRestitution`); each row compares two ways of computing
it, in runs of 300, of 150 or of 10 steps (`every 10`). The scenes are in `tests/engines/plugin_invariance.py`;
`tests/engines/test_plugin_invariance.py` asserts the columns of epdem and the main failures of the other models.

"""

TAIL = """
The other models fail for the following reasons. `thornton_ning` and `edinburgh` register even quantities (largest
overlap, force, flags) with newton flag 1, and LIGGGHTS negates such values when a pair is stored from its other side.
They register no contact distance factor. Their history therefore survives a contact that ends between two neighbour
lists, like the shear spring of `hertz` with `tangential history`. Their viscous force depends on velocities of the half
step, which differ slightly in a split run. `hertz` also leaves its setting `tangential_damping` undefined when a
restart file creates it.

LIGGGHTS's `tangential history` projects its spring on the plane of the contact in every step, but does not rotate the
spring about the normal. After the revolution the friction has another direction. Partial slip (`ep/partial_slip`)
rotates the spring; the remaining error of a revolution is of first order in the angle of a step (1000 steps).

LIGGGHTS computes all forces once more before the first step of a run. The spring of a contact that slides is stored
exactly at mu F, and LIGGGHTS's `tangential history` judges by the last digit whether the contact sticks now, with its
dashpot, or slides, without. In this evaluation a contact of epdem that stands at its limit slides, in LIGGGHTS and
LAMMPS. The dashpots of contacts that stick have the velocities of the step in place of those of the half step, in every
model; the last two rows show this effect.
"""


def cell(values):
    worst = max(v for v in values if v is not None)
    return "0" if worst == 0 else f"{worst:.0e}"


def main():
    with tempfile.TemporaryDirectory() as folder:
        columns = {}
        for model in MODELS:
            name, _, tangential = model.partition(" ")
            place = Path(folder) / model.replace("/", "-").replace(" ", "-")
            columns[model] = Suite(name, place, tangential or "history").deviations()
    lines = ["| set-up | " + " | ".join(MODELS) + " |", "|---" * (len(MODELS) + 1) + "|"]
    for name in columns[MODELS[0]]:
        lines.append(f"| {name} | " + " | ".join(cell(columns[m][name]) for m in MODELS) + " |")
    text = HEAD + "\n".join(lines) + "\n" + TAIL
    (ROOT / "docs").mkdir(exist_ok=True)
    (ROOT / "docs" / "invariance.md").write_text(text)
    print(text)


if __name__ == "__main__":
    main()
