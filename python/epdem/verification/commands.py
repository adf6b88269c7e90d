# SPDX-License-Identifier: GPL-2.0-or-later
"""The commands of `epdem verify`: each calls its study and prints the answer; `app` has those of the product, too."""

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.text import Text

from ..base.terminal import Shown, frame_table, status
from ..cli.main import app as app
from ..cli.options import (
    AsJson,
    CasePath,
    Engines,
    Force,
    Formats,
    Laws,
    Out,
    answer,
    formats,
)
from ..errors import CaseError

if TYPE_CHECKING:  # slow to import
    from .runner import Outcome

verify = typer.Typer(
    no_args_is_help=True, help="Verify laws and engines against theory, measurements, each other and other codes."
)
app.add_typer(verify, name="verify")


def _rows(outcome: "Outcome", note: str, as_json: bool) -> typer.Exit:
    document = {"passed": outcome.passed, "folder": outcome.folder, "rows": outcome.rows}
    return answer(document, [frame_table(outcome.study.title, outcome.rows, digits=3), note], as_json, outcome.passed)


def _absent(reasons: Mapping[str, str]) -> list[str]:
    return [f"left out: {name}: {reason}" for name, reason in reasons.items()]


@verify.command()
def crosscheck(
    cases: Annotated[list[Path], typer.Argument(metavar="CASE...", help="case files (TOML)")],
    engine: Engines = None,
    law: Annotated[str | None, typer.Option("--law", "-l", help="a law instead of the case's")] = None,
    out: Out = None,
    fresh: Annotated[bool, typer.Option("--fresh", help="run again although results are stored")] = False,
    force: Force = False,
    as_json: AsJson = False,
) -> None:
    """Run a case on every installed engine and model, and print errors, order of convergence and invariance.

    Exit code 1: an engine of epdem is outside of the tolerances of the case. Models of other codes are not judged.
    """
    from ..case.impact import load
    from .engine_comparison import crosscheck as check
    from .engine_comparison import crosscheck_tables
    from .pages import of_crosscheck

    folders = [out / path.stem for path in cases] if out and len(cases) > 1 else [out for _ in cases]
    if out and len(set(folders)) < len(cases):
        raise CaseError(f"--out {out}: two of the cases have one file name and would share a folder; rename one")
    for path in cases:
        load(path)  # a mistake in the last one is not said after minutes with the first
    documents, shown, passed = [], [], True
    with status() as progress:
        for path, folder in zip(cases, folders, strict=True):
            c = check(path, engines=engine or [], law=law, out=folder, fresh=fresh, force=force, progress=progress)
            about = {"case": c.outcome.case.name, "passed": c.passed, "absent": c.absent, "notes": c.notes}
            documents.append(about | {"rows": c.table})
            shown += crosscheck_tables(c.outcome.case.case.title, c.table)
            shown += [f"{name} has a law and a theory of its own: {note}" for name, note in c.notes.items()]
            shown += [*_absent(c.absent), f"page, figure and data: {of_crosscheck(c)}"]
            passed &= c.passed
    raise answer(documents[0] if len(documents) == 1 else documents, shown, as_json, passed)


@verify.command()
def cost(
    case: CasePath,
    engine: Engines = None,
    law: Laws = None,
    repetitions: Annotated[int, typer.Option(min=1, max=100, help="repetitions of every timed run, interleaved")] = 5,
    pictures: Formats = None,
    out: Out = None,
    force: Force = False,
    as_json: AsJson = False,
) -> None:
    """Measure error against run time at 10 to 3000 steps in contact (default engines: embedded and liggghts)."""
    from ..base.files import claim, results_folder
    from ..case.impact import load
    from . import cost as study
    from .pages import of_cost

    kinds = formats(pictures)
    folder = results_folder(out, load(case).name, "cost")
    with claim(folder, force=force, files=["cost.csv"]), status() as progress:
        found = study.run(case, engines=engine or [], laws=law or [], repetitions=repetitions, progress=progress)
        files = [*study.write(found, folder, kinds), of_cost(found, folder)]
    document = {"case": found.case.name, "seconds": found.seconds, "files": files, "rows": found.rows}
    document |= {"models": found.models}
    tables = [frame_table(title, frame, digits=3) for title, frame in study.tables(found).items()]
    raise answer(document, [*tables, f"see {folder}/report.html"], as_json)


@verify.command()
def stability(
    engine: Engines = None,
    law: Laws = None,
    group: Annotated[
        list[str] | None, typer.Option("--group", "-g", help="run only these groups of cases; repeat for more")
    ] = None,
    every: Annotated[int, typer.Option(min=1, help="run only every n-th case")] = 1,
    steps: Annotated[
        int | None, typer.Option(min=1000, help="steps of the drift by repeated bounces (default: 1e9)")
    ] = None,
    out: Out = None,
    force: Force = False,
    as_json: AsJson = False,
) -> None:
    """Test stiff and extreme cases, and find the time step at which each fails (default engine: embedded)."""
    from ..base.files import claim, results_folder
    from ..base.tables import write_csv
    from . import stability as suite
    from .pages import of_stability
    from .stability.suite import tables

    folder = results_folder(out, "stability")
    with claim(folder, force=force, files=["stability.csv"]), status() as progress:
        found = suite.run(engine or [], law or [], groups=group, every=every, steps=steps, progress=progress)
        write_csv(folder / "stability.csv", found.verdicts)
        of_stability(found, folder)
    document = {"passed": found.passed, "rows": found.verdicts, "roundoff": found.roundoff, "bulk": found.bulk}
    failed = found.verdicts[found.verdicts["status"] == "failed"].itertuples()
    shown: list[Shown] = [frame_table(title, frame, digits=3) for title, frame in tables(found).items()]
    shown += [Text(f"failed: {v.engine}, {v.law}, {v.case}: {v.reason}", style="red") for v in failed]
    raise answer(document, shown, as_json, found.passed)


@verify.command()
def motion(
    case: CasePath,
    file: Annotated[
        list[Path] | None,
        typer.Option("--motion", "-m", help="JSON or CSV file of a motion instead of our own six; repeat for more"),
    ] = None,
    engine: Engines = None,
    law: Laws = None,
    out: Out = None,
    force: Force = False,
    as_json: AsJson = False,
) -> None:
    """Prescribe the motion of two spheres and compare forces and torques between engines, step by step.

    Default engines: embedded and liggghts; the first one is what the others are compared with, at 1e-9 of its force.
    """
    from .motion.compare import compare

    with status() as progress:
        found = compare(
            case, files=file or [], engines=engine or [], laws=law or [], out=out, force=force, progress=progress
        )
    raise _rows(found, f"motions, forces and torques: {found.folder}/LAW/ENGINE/MOTION/motion.json", as_json)


@verify.command()
def contacts(
    files: Annotated[list[Path] | None, typer.Argument(help="YAML files, a CSV file beside each; else ours")] = None,
    engine: Engines = None,
    out: Out = None,
    force: Force = False,
    as_json: AsJson = False,
) -> None:
    """Run the tests of plastic contacts, which other codes can run, too: forces of prescribed motions, and impacts.

    Default engines: embedded and liggghts. References and tolerances are in the files (docs/evidence.md).
    """
    from .contacts import compare

    with status() as progress:
        found = compare(files or [], engines=engine or [], out=out, force=force, progress=progress)
    raise _rows(found, f"table: {found.folder}/contacts.csv", as_json)


@verify.command()
def data(
    sets: Annotated[
        list[str] | None, typer.Option("--set", "-s", help="run only this measured set; repeat for more")
    ] = None,
    engine: Engines = None,
    law: Laws = None,
    out: Out = None,
    force: Force = False,
    as_json: AsJson = False,
) -> None:
    """Run all laws against measured impacts with nothing fitted (default engines: embedded and liggghts)."""
    from .measured_data import validate
    from .pages import of_validation
    from .runner import STUDIES

    with status() as progress:
        found = validate(
            sets=sets or [], engines=engine or [], chosen=law or [], out=out, force=force, progress=progress
        )
        page = of_validation(found)
    document = {"rows": found.points, "summary": found.summary, "absent": found.absent, "page": page}
    table = frame_table(STUDIES["data"].title, found.summary, digits=3)
    raise answer(document, [table, *_absent(found.absent), f"see {page}"], as_json)


@verify.command()
def figures(
    out: Annotated[Path, typer.Option("--out", "-o", help="folder for the figures")] = Path("runs/figures"),
    pictures: Formats = None,
    force: Force = False,
    as_json: AsJson = False,
) -> None:
    """Draw figures 8.16 to 8.19 of Seville and Wu (2016) and figure 10 of Thornton and Ning (1998)."""
    from ..base.files import claim
    from .figures import draw_all

    kinds = formats(pictures)
    with claim(out, force=force), status() as progress:
        progress("five figures")
        paths = draw_all(out, kinds)
    raise answer({"files": paths}, map(str, paths), as_json)


@verify.command()
def rerun(
    file: Annotated[Path, typer.Argument(metavar="results.h5", help="results file of impacts or of a scene")],
    as_json: AsJson = False,
) -> None:
    """Repeat a stored run from its results file alone and compare: the same decks and numbers (exit code 0), or not."""
    from .rerun import rerun as repeat

    with status() as progress:
        found = repeat(file, progress)
    document = {"file": file, "same": found.same, "versions": found.versions, "differences": found.differences}
    shown: list[Shown] = [
        Text(f"{name}: {before} then, {now} now", style="yellow") for name, (before, now) in found.versions.items()
    ]
    shown += [
        Text(f"{name}: {difference or 'the same'}", style="red" if difference else "")
        for name, difference in found.differences.items()
    ]
    shown.append(f"{file}: {'everything is the same' if found.same else 'not everything is the same'}")
    raise answer(document, shown, as_json, found.same)
