# SPDX-License-Identifier: GPL-2.0-or-later
"""The command `epdem`: functions of a few lines that call the library."""

import errno
import io
import os
import re
import shutil
import signal
import sys
from contextlib import nullcontext
from inspect import unwrap
from pathlib import Path
from typing import Annotated, Any

import typer

from ..base import __version__, processes
from ..base.paths import DEFAULT_ENGINE
from ..base.terminal import status
from ..errors import CaseError, EpdemError, Stopped
from . import calibrate as cli_calibrate
from . import predict as cli_predict
from . import scenes as cli_scene
from . import sweep as cli_sweep
from .export import app as export
from .options import AsJson, CasePath, Engines, Force, Formats, Laws, Out, answer, formats, refuse_options, warn

ABOUT = """Elastic-plastic particle contact for LIGGGHTS, YADE and LAMMPS, checked against theory.

Begin with: epdem run cases/steel_wall.toml -e embedded -e liggghts

Exit codes: 0 all within tolerance, 1 a check failed, 2 bad input, 3 an engine failed, 130 stopped.
"""
DECKS: dict[str, tuple[tuple[str, ...], str]] = {  # the options that a kind of deck takes, and why not others
    "check": ((), "--check takes nothing but a LIGGGHTS deck"),
    "convert": (("out", "law", "set", "force"), "--convert takes nothing but a LIGGGHTS deck"),
    "own": (("out", "case", "set", "force"), "an own template makes a LIGGGHTS deck with the law of its case"),
    "case": (("out", "engine", "law", "reasons", "force"), "it goes with an own template (.j2)"),
}
NUMBERS = {"number": "a number", "integer": "a whole number"}  # by the words of pydantic
UsageError: Any = typer.BadParameter.__base__  # typer gives its own name to its children only
app = typer.Typer(
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    help=ABOUT,
    context_settings={"help_option_names": ["-h", "--help"]},
)


def _print_version(wanted: bool) -> None:
    if wanted:
        print(f"epdem {__version__}")
        raise typer.Exit


@app.callback()
def _options(
    version: Annotated[
        bool, typer.Option("--version", callback=_print_version, is_eager=True, help="print the version and end")
    ] = False,
) -> None:
    pass


@app.command()
def run(
    case: CasePath,
    engine: Engines = None,
    law: Laws = None,
    ranks: Annotated[int, typer.Option(min=1, max=1024, help="MPI ranks of LIGGGHTS or LAMMPS")] = 1,
    steps: Annotated[
        int | None, typer.Option(min=5, max=100_000, help="steps in contact instead of the case's")
    ] = None,
    error: Annotated[
        float | None,
        typer.Option(min=1e-9, max=0.1, help="find the steps in contact for this largest relative error of e_n"),
    ] = None,
    out: Out = None,
    fresh: Annotated[bool, typer.Option("--fresh", help="run again although results are stored")] = False,
    resume: Annotated[
        bool, typer.Option("--resume", help="continue an interrupted scene from its last restart file")
    ] = False,
    full: Annotated[bool, typer.Option("--full", help="print all rows, not ten impacts of each engine")] = False,
    pictures: Formats = None,
    force: Force = False,
    as_json: AsJson = False,
) -> None:
    """Run a case and check it against theory, or run a bulk scene (default engine: liggghts).

    Its page report.html is beside the results.
    """
    table, engines = "csv" in (pictures or []), engine or [DEFAULT_ENGINE]
    kinds = formats([name for name in pictures or [] if name != "csv"])
    options: dict[str, Any] = {"out": out, "ranks": ranks, "fresh": fresh, "force": force}
    if full and as_json:
        raise CaseError("--full: --json holds all rows; leave it out")
    if cli_scene.is_scene(case):
        refuse_options(case, "a scene has its own law and time step", law=law, steps=steps, error=error)
        refuse_options(case, "it is for impacts; a scene prints all its checks", full=full)
        if len(set(engines)) > 1:
            raise CaseError(f"{case}: --engine: a scene runs on one engine; give it once")
        if fresh and resume:
            raise CaseError(f"{case}: --resume continues a run and --fresh begins it again; leave one out")
        raise cli_scene.run_scene(
            case, engine=engines[0], formats=kinds, csv=table, as_json=as_json, resume=resume, **options
        )
    if table:
        raise CaseError("--format csv: it is for the contacts of scenes; impacts have results.csv; leave it out")
    refuse_options(
        case, "it continues bulk scenes; a run of impacts takes finished stages from its store", resume=resume
    )
    if steps is not None:
        refuse_options(case, "--steps gives the time step", error=error)
    options |= {"steps": steps, "error": error, "laws": law or []}
    raise _run_impacts(case, engines=engines, formats=kinds, full=full, as_json=as_json, **options)


def _run_impacts(
    case: Path, *, engines: list[str], formats: tuple[str, ...], full: bool, as_json: bool, **options: Any
) -> typer.Exit:
    from ..engines import engine as find
    from ..impacts import summary
    from ..impacts.run import run
    from ..report.pages import write_page

    with status() as progress:
        outcome = run(case, engines=[find(name) for name in engines], progress=progress, **options)
        progress("figures")
        write_page(outcome, formats)
    return answer(summary.document(outcome), summary.shown(outcome, full=full), as_json, outcome.passed)


@app.command()
def deck(
    file: Annotated[
        Path,
        typer.Argument(
            metavar="CASE|TEMPLATE|DECK", help="case file (TOML), a template of your own (.j2), a deck to convert"
        ),
    ],
    out: Annotated[Path | None, typer.Option("--out", "-o", help="folder for the deck")] = None,
    engine: Annotated[str, typer.Option("--engine", "-e", help="liggghts, yade or lammps")] = DEFAULT_ENGINE,
    law: Laws = None,
    case: Annotated[Path | None, typer.Option("--case", help="the case that fills the template")] = None,
    given: Annotated[
        list[str] | None,
        typer.Option("--set", metavar="KEY=VALUE", help="a value for the template or the deck; repeat for more"),
    ] = None,
    convert: Annotated[
        bool, typer.Option("--convert", help="change the model of a LIGGGHTS deck to --law (default: thornton)")
    ] = False,
    check: Annotated[
        bool, typer.Option("--check", help="name inputs of a LIGGGHTS deck that are probably wrong; writes nothing")
    ] = False,
    reasons: Annotated[bool, typer.Option("--reasons", help="the reason of each line as its comment")] = False,
    force: Force = False,
    as_json: AsJson = False,
) -> None:
    """Write the deck of a case, fill a template of your own with the values of a case, or convert a LIGGGHTS deck.

    Example: epdem deck --convert my.in --set yieldPressure=1e8 -o converted
    """
    kind = "check" if check else "convert" if convert else "own" if file.suffix == ".j2" else "case"
    takes, reason = DECKS[kind]
    options: dict[str, object] = {
        "out": out,
        "law": law,
        "case": case,
        "set": given,
        "reasons": reasons,
        "force": force,
    }
    options |= {"engine": None if engine == DEFAULT_ENGINE else engine, "convert": check and convert}
    refuse_options(file, reason, **{name: value for name, value in options.items() if name not in takes})
    if len(law or []) > 1:
        raise CaseError(f"{file}: --law: a deck has one law; write one deck for each")
    if check:
        from ..tools.deck_checks import check_file

        found = check_file(file)
        raise answer({"warnings": found}, found or [f"{file}: nothing found"], as_json, not found)
    if out is None:
        raise CaseError(f"{file}: --out is missing; name a folder for the deck")
    from ..studies.sweep.points import settings as values_of

    values = values_of(given or [], example="yieldPressure=1e8")
    if convert:
        from ..tools.convert import convert_file
        from ..tools.deck_checks import check_file

        files, notes = convert_file(file, (law or ["thornton"])[0], values, out, force=force)
        print("\n".join([*notes, *check_file(files[0])]), file=sys.stderr)
        raise answer({"files": files}, map(str, files), as_json)
    if kind == "own":
        from ..tools.own_decks import settings
        from ..tools.own_decks import write as fill

        if case is None:
            raise CaseError(f"{file}: an own template needs the values of a case; add --case CASE")
        files = fill(file, case, settings(values), out, force=force)
        raise answer({"files": files}, map(str, files), as_json)
    if cli_scene.is_scene(file):
        refuse_options(file, "a scene has its own law", law=law)
    from ..api import deck as write  # unwrapped, its errors name options
    from ..base.rendering import with_reasons

    with with_reasons() if reasons else nullcontext():
        files = unwrap(write)(file, out, engine=engine, law=law[0] if law else None, force=force, warn=warn)
    raise answer({"files": files}, map(str, files), as_json)


@app.command()
def cite(
    case: CasePath,
    engine: Engines = None,
    law: Laws = None,
    bibtex: Annotated[bool, typer.Option("--bibtex", help="print entries of BibTeX")] = False,
    as_json: AsJson = False,
) -> None:
    """Print what to cite for the law of a case and for the engines that run the case."""
    from ..api import cite as cited  # as above

    refuse_options(case, "--bibtex prints BibTeX", json=as_json and bibtex)
    if cli_scene.is_scene(case):
        refuse_options(case, "a scene has its own law", law=law)
    found = unwrap(cited)(case, engines=engine or [DEFAULT_ENGINE], laws=law or [])
    if bibtex:
        print(found.bibtex(), end="")
        return
    raise answer(found, [f"{what}: {text}" for what, text in found.items()], as_json)


@app.command()
def doctor(as_json: AsJson = False) -> None:
    """List the engines and their versions, test which models LIGGGHTS has, and name what to install."""
    from ..engines.doctor import examine, shown

    with status() as line:
        line("engines")
        findings = examine()
    answer([vars(f) for f in findings], shown(findings), as_json)
    raise typer.Exit(0 if all(f.ok for f in findings if f.needed) else 3)


for command in (
    cli_predict.predict,
    cli_scene.view,
    cli_scene.soften,
    cli_calibrate.calibrate,
    cli_sweep.sweep,
    cli_sweep.status,
):
    app.command()(command)
app.add_typer(export, name="export")


def _usage(error: Any) -> int:
    if not (text := error.format_message()):
        error.show()
        return 2
    name = error.ctx.command_path if error.ctx else "epdem"
    dash = next((word for word in sys.argv[1:] if word.startswith("-") and Path(word).exists()), None)
    advice = f"write the file as ./{dash}" if dash else f"see {name} --help"
    text = re.sub(
        r"Input should be an? valid (\w+), unable to parse.*", lambda kind: f"must be {NUMBERS[kind[1]]}", text
    )
    print(f"epdem: {text.rstrip('.').replace('Input should be', 'must be')}; {advice}", file=sys.stderr)
    return 2


def main(commands: typer.Typer = app) -> None:
    """Run a command: errors that a user can correct become one sentence and an exit code."""
    os.environ.pop("MPLBACKEND", None)  # figures are only saved, and an unknown backend ends matplotlib's import
    processes.install_signal_handlers()  # whatever stops us, no engine stays behind
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors="backslashreplace")  # a title may hold what the terminal's encoding does not
    try:
        sys.exit(commands(prog_name="epdem", standalone_mode=False))
    except UsageError as error:
        sys.exit(_usage(error))
    except EpdemError as error:
        from ..case.messages import cut_quotes

        print(f"epdem: {cut_quotes(str(error))}", file=sys.stderr)
        sys.exit(error.exit_code)
    except Stopped:
        print("epdem: stopped; what was finished is stored", file=sys.stderr)
        sys.exit(130)
    except OSError as error:
        place, reason = error.filename or "a file", error.strerror or error
        if error.errno == errno.ENOSPC:
            there = next(parent for parent in Path(place).absolute().parents if parent.exists())
            reason = f"{reason} ({shutil.disk_usage(there).free} bytes are free)"
        print(f"epdem: {place}: {reason}; choose another folder by --out, or make it writable", file=sys.stderr)
        sys.exit(2)
    finally:
        for name in processes.SIGNALS:  # all is stored: what comes now must not meet Python's own end
            signal.signal(name, signal.SIG_DFL)
