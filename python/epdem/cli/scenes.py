# SPDX-License-Identifier: GPL-2.0-or-later
"""Commands for bulk scenes: functions of a few lines that call the library."""

from dataclasses import asdict
from pathlib import Path
from typing import Annotated, Any

import typer

from ..base.terminal import bar, status, warned
from ..errors import CaseError
from .options import AsJson, CasePath, Replace, answer


def is_scene(path: Path) -> bool:
    """Whether a case file describes a bulk scene. Raises CaseError if it cannot be read."""
    from ..case.scene import is_scene as holds_scene
    from ..case.toml import read_toml

    return holds_scene(read_toml(path))


def run_scene(
    case: Path, *, engine: str, formats: tuple[str, ...], csv: bool, as_json: bool, **options: Any
) -> typer.Exit:
    """Run a scene with a progress bar; print its checks."""
    from ..base.tables import write_csv
    from ..case.scene import load
    from ..engines import scene_engine
    from ..report.pages import write_page
    from ..scenes.judge import summary
    from ..scenes.plan.plan import plan
    from ..scenes.run import run

    tool = scene_engine(engine)
    if csv and not plan(load(case)).contacts:
        raise CaseError(f"{case}: --format csv: the scene has no table of contacts; give output.contacts")
    with bar(case.stem, "steps") as progress:
        phases: list[Any] = []

        def report_step(step: int, steps: int) -> None:
            progress(step, steps, next((f"phase {x.name}" for x in phases if step <= x.end), ""))

        outcome = run(case, tool, report=report_step, planned=lambda p: phases.extend(p.phases), **options)
    if csv:
        write_csv(outcome.folder / "contacts.csv", outcome.results.contacts)
    write_page(outcome, formats)
    return answer(summary.document(outcome), summary.shown(outcome), as_json, outcome.passed)


def view(
    case: CasePath,
    out: Annotated[Path | None, typer.Option("--out", "-o", help="PNG file (default: NAME.png here)")] = None,
    force: Replace = False,
    as_json: AsJson = False,
) -> None:
    """Draw a scene before it runs: walls, regions, first spheres."""
    from ..base.files import refuse_existing
    from ..case.scene import load
    from ..case.toml import error_context
    from ..report import pictures
    from ..scenes.plan.plan import plan

    with error_context(case):
        p = plan(load(case))
        path = out or Path(f"{p.case.name}.png")
        refuse_existing(path, force=force)
        with status() as line:
            line(f"{p.case.name}: walls, regions, first spheres")
            drawn = pictures.before(p, path)
    said = {"file": str(path), "spheres": p.count, "drawn": drawn}
    raise answer(said, [f"{path}: walls, regions and {drawn} of {p.count} spheres"], as_json)


def soften(
    case: CasePath,
    factor: Annotated[
        float, typer.Option("--factor", "-k", help="divisor of E; the time step grows by its 0.4th power")
    ],
    out: Annotated[
        Path | None, typer.Option("--out", "-o", help="file to write (default: CASE_softK.toml beside it)")
    ] = None,
    force: Replace = False,
    as_json: AsJson = False,
) -> None:
    """Write a softened copy of a case with the same e_n at every speed and larger time steps."""
    from ..base.files import refuse_existing, write_text
    from ..studies.soften import soften as twin_of

    target = out or case.parent / f"{case.stem}_soft{factor:g}.toml"
    twin = twin_of(case, factor, folder=target.parent)
    refuse_existing(target, force=force)
    write_text(target, twin.text)
    about = {name: value for name, value in asdict(twin).items() if name != "text"}
    kept = f"changes by up to {100 * twin.e_n_change:.2g} %" if twin.e_n_change else "of every speed stays"
    said = (
        f"time step {twin.time_step_factor:.3g} times larger; w a_max/R* {twin.strain[0]:.3f} -> "
        f"{twin.strain[1]:.3f}; e_n {kept}; written to {target}"
    )
    changes = [f"{c.place}: {c.before} -> {c.after}" for c in twin.changes]
    raise answer({"file": str(target)} | about, [*changes, said, *warned(twin.warnings)], as_json)
