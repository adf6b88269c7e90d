# SPDX-License-Identifier: GPL-2.0-or-later
"""The page of a bulk scene."""

from pathlib import Path

from ...base.files import claim
from ...report.page import NAME, Facts, Page, Part, Picture, Rows, write
from ...scenes.columns import STRAINS, units
from ...scenes.report import bed, charts
from ...scenes.run import SceneOutcome
from ...theory.validity import SMALL_DEFORMATION
from . import common

DRAWN = {"bed", "key", "scene", "energy"}  # pictures of a folder that are charts of the page
TABLES = [
    ("checks", "Checks", "Each number against its expected value."),
    ("energy_balance", "Energy balance", "One row for each frame."),
    ("measures", "Measures", "One row for each frame."),
    ("histograms", "Histograms", ""),
    ("rows", "Rows", ""),
]


def of_scene(outcome: SceneOutcome) -> Path:
    """Write report.html into the folder of a scene; its path."""
    with claim(outcome.folder, force=True):
        return write(outcome.folder / NAME, lambda: page(outcome, common.command()))


def page(outcome: SceneOutcome, command: str = "") -> Page:
    """The page of a scene."""
    tables, about = outcome.results.tables, outcome.results.attributes
    shown = charts(outcome)
    pictures = [
        Picture(path.stem.replace("_", " "), f"{path.name}, as the run left it", file=path)
        for path in sorted(outcome.folder.glob("*.png"))
        if path.stem not in DRAWN and not path.stem.startswith("scene_")
    ]
    engine = str(about["engine"])
    parts: list[Part] = [*shown[:1], *bed(outcome), *shown[1:], *pictures]
    for name, title, note in TABLES:
        table = tables.get(name)
        if table is not None and not table.drop(columns=["step", "time"], errors="ignore").empty:
            parts.append(Rows(title, table, units(table), note))
    decks = common.decks(engine, outcome.plan, outcome.results.decks)
    parts += [_facts(outcome), common.case_lines(outcome.results.case_text), *decks]
    return common.page_of(
        outcome,
        sentences(outcome),
        parts,
        hashes={engine: about["inputs"]},
        laws=[outcome.plan.model.law],
        engines=[engine],
        command=command,
    )


def sentences(outcome: SceneOutcome) -> list[str]:
    """What ran and came out, in words."""
    p, tables = outcome.plan, outcome.results.tables
    last, checks = tables["rows"].iloc[-1], tables["checks"]
    failed = ", ".join(checks["check"][~checks["passed"].astype(bool)])
    about = outcome.results.attributes
    said = [
        f"A scene of kind {outcome.case.scene.kind} with law {p.model.law} in {about['engine']} (MPI ranks: "
        f"{about['ranks']}): {p.steps} steps of {p.time_step:.4g} s took {float(str(about['seconds'])):.3g} s.",
        f"At the end, at {last['time']:.4g} s, {int(last['particles'])} spheres are in the room and their kinetic "
        f"energy is {last['kinetic_energy']:.4g} J.",
    ]
    radius, overlap = (last[name] for name in STRAINS)
    said.append(
        f"The contacts reach a contact radius of {radius:.3g} R* and an overlap of {overlap:.3g} R*; small strain "
        f"ends at a contact radius of {SMALL_DEFORMATION} R*."
    )
    return [*said, f"These checks fail: {failed}." if failed else f"All {len(checks)} checks hold."]


def _facts(outcome: SceneOutcome) -> Facts:
    p = outcome.plan
    facts = {"kind": outcome.case.scene.kind, "law": p.model.law, "time step": f"{p.time_step:.6g} s"}
    facts |= {"steps": str(p.steps), "smallest radius": f"{p.smallest:.4g} m", "materials": ", ".join(p.types)}
    phases = [f"{x.name} up to step {x.end}" + f" (until {x.reached})" * bool(x.reached) for x in p.phases]
    return Facts("The scene", facts | {"phases": ", ".join(phases)})
