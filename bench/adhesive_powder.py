# SPDX-License-Identifier: GPL-2.0-or-later
"""The powder of cases/adhesive_powder.toml with its adhesion and without: looseness, strength, shape.

Run: .venv/bin/python bench/adhesive_powder.py

Both beds fall, are pressed and released (the case itself). Then the sides, which were periodic, and the plate are taken
away: the block stands free on the lower plate under gravity. Prints the table of docs/adhesion.md.
"""

import math
import re
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np

from epdem.engines import scene_engine
from epdem.engines.liggghts import dump, launcher
from epdem.scenes.run import run

CASE = Path(__file__).resolve().parent.parent / "cases" / "adhesive_powder.toml"
STANDING = 0.005  # time without sides [s]


def standing(folder: Path, dt: float) -> tuple[np.ndarray, np.ndarray]:
    """Places [m] of the spheres when the sides are taken away and STANDING later, (n, 3) each."""
    restart = max(folder.glob("restart.*.bin"), key=lambda path: int(path.name.split(".")[1]))
    setup = (folder / "setup.in").read_text(encoding="utf-8").splitlines()
    kept = [line for line in setup if not re.match(r"dump|compute|fix (wall_plate|load)|thermo|dump_modify", line)]
    (folder / "standing.in").write_text("\n".join(kept) + "\n", encoding="utf-8")
    steps = math.ceil(STANDING / dt)
    head = [line for line in (folder / "in.scene").read_text(encoding="utf-8").splitlines() if "communicate" in line]
    deck = [
        "units si",
        "atom_style granular",
        "newton off",
        *head,
        f"read_restart {restart.name}",
        "include standing.in",
        "run 0",
        "change_box all boundary f f f",
        "change_box all x final -1e-2 1e-2 y final -1e-2 1e-2",
        "dump s all custom 1000 standing.bin id x y z",
        "dump_modify s first yes",
        f"run {steps}",
    ]
    (folder / "in.standing").write_text("\n".join(deck) + "\n", encoding="utf-8")
    launcher.run("in.standing", folder, out="out.standing", seconds=36000)
    first, *_, last = dump.series(folder / "standing.bin")
    return first, last


def numbers(folder: Path, text: str) -> dict[str, float]:
    """What the table says of one powder."""
    case = folder / "powder.toml"
    case.write_text(text, encoding="utf-8")
    outcome = run(case, scene_engine("liggghts"), out=folder / "run")
    p, tables = outcome.plan, outcome.results.tables
    area = (p.box[1] - p.box[0]) * (p.box[3] - p.box[2])
    rows, spheres, contacts = tables["rows"], tables["particles"], tables["contacts"]
    fall, load = p.phases[0].end, p.phases[1].end

    def bed(step: int) -> tuple[float, float]:
        """(share of solid below nine tenths of its height, contacts of a sphere) at the frame next to a step."""
        at = min(spheres["step"].unique(), key=lambda s: abs(s - step))
        now = spheres[spheres["step"] == at]
        top = 0.9 * float(np.quantile(now["z"], 0.98))
        inside = now[now["z"] < top]
        solid = float((4 / 3 * np.pi * inside["radius"] ** 3).sum()) / (area * top)
        touching = contacts[(contacts["step"] == at) & (contacts["force"] != 0.0)]
        return solid, (2 * (touching["j"] > 0).sum() + (touching["j"] == 0).sum()) / len(now)

    after = rows[rows["step"] > load]
    stress = after["stress"]
    first, last = standing(folder / "run", p.time_step)
    wide = [float(np.sqrt((x[:, :2] ** 2).sum(axis=1).mean())) for x in (first, last)]
    return {
        "solid share where it fell": bed(fall)[0],
        "contacts of a sphere there": bed(fall)[1],
        "solid share pressed": bed(load)[0],
        "largest stress [kPa]": float(rows["stress"].max()) / 1e3,
        "solid share released": bed(p.steps)[0],
        "contacts of a sphere released": bed(p.steps)[1],
        "least stress on the way back [kPa]": float(stress.min()) / 1e3,
        "spread without sides, end over start": wide[1] / wide[0],
        "height without sides, end over start": float(np.quantile(last[:, 2], 0.98) / np.quantile(first[:, 2], 0.98)),
    }


def main() -> None:
    text = CASE.read_text(encoding="utf-8")

    def one(gamma: str) -> dict[str, float]:
        with tempfile.TemporaryDirectory(prefix="epdem-powder-") as scratch:
            return numbers(Path(scratch), text.replace("0.025 J/m^2", gamma))

    with ThreadPoolExecutor(2) as both:
        found = list(both.map(one, ("0 J/m^2", "0.025 J/m^2")))
    print("| | Γ = 0 | Γ = 0.05 J/m² |\n|---|---|---|")
    for name in found[0]:
        print(f"| {name} | {found[0][name]:.3g} | {found[1][name]:.3g} |")


if __name__ == "__main__":
    main()
