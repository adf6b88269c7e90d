# SPDX-License-Identifier: GPL-2.0-or-later
"""Commands for bulk scenes: functions of a few lines that call the library."""

import json
from pathlib import Path
from typing import Annotated

import typer

from ..errors import CaseError
from ..terminal import bar, console
from .options import AsJson, CasePath, Replace, quantity, refuse, warn


def is_scene(path: Path) -> bool:
    """Whether a case file describes a bulk scene. Raises CaseError if it cannot be read."""
    from ..case.impact import read_toml
    from ..case.scene import is_scene as holds_scene

    return holds_scene(read_toml(path))


def run_scene(
    case: Path,
    *,
    engine: str = "liggghts",
    out: Path | None = None,
    ranks: int = 1,
    fresh: bool = False,
    resume: bool = False,
    force: bool = False,
    as_json: bool = False,
) -> int:
    """Run a scene with a progress bar; print its checks. Exit code: 0, or 1 if a check failed."""
    from rich.progress import TextColumn, TimeRemainingColumn

    from ..engines import scene_engine
    from ..scenes import report
    from ..scenes.run import run

    tool = scene_engine(engine)
    with bar(TextColumn("{task.completed}/{task.total} steps"), TimeRemainingColumn()) as progress:
        task = progress.add_task(Path(case).stem, total=None)
        outcome = run(
            case,
            tool,
            out=out,
            ranks=ranks,
            fresh=fresh,
            resume=resume,
            force=force,
            report=lambda step, steps: progress.update(task, completed=step, total=steps),
        )
    report.figures(outcome)
    if as_json:
        print(report.as_json(outcome))
    else:
        report.show(outcome, console())
    return 0 if outcome.passed else 1


def deck_scene(case: Path, out: Path, *, engine: str = "liggghts", force: bool = False, as_json: bool = False) -> None:
    """Write the deck of a scene."""
    from ..case.doubts import doubts
    from ..case.impact import named
    from ..case.scene import load
    from ..engines import scene_engine
    from ..folders import write_own
    from ..scenes.plan import plan

    with named(case):
        read = load(case)
        warn(doubts(read))
        files = scene_engine(engine).files(plan(read))
    names = [str(f) for f in write_own(out, files, force=force)]
    print(json.dumps({"files": names}) if as_json else "\n".join(names))


def explain(case: CasePath, as_json: AsJson = False) -> None:
    """Print each line of the LIGGGHTS deck of a case with its reason."""
    lines = _explained(case)
    if as_json:
        print(json.dumps([{"file": f, "line": text, "reason": reason} for f, text, reason in lines], indent=1))
        return
    file = None
    for name, text, reason in lines:
        if name != file:
            print(f"{name}:")
            file = name
        print(f"  {text.split('  # ')[0].rstrip()}\n      {reason}")


def _explained(case: Path) -> list[tuple[str, str, str]]:
    from ..case.impact import load, named
    from ..liggghts import explain

    with named(case):
        if is_scene(case):
            from ..case.scene import load as load_scene
            from ..liggghts.scene_deck import deck
            from ..scenes.plan import plan as scene_plan

            return explain.explain(explain.SCENE, deck(scene_plan(load_scene(case))))
        from ..impacts.experiment import experiment
        from ..impacts.plan import plan
        from ..impacts.prediction import predict
        from ..liggghts.impacts import Liggghts

        x = experiment(load(case))
        return explain.explain(explain.IMPACT, Liggghts().deck(plan(x, predict(x))))


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
    from ..files import atomic
    from ..folders import refuse_existing
    from ..studies.soften import soften as twin_of

    twin = twin_of(case, factor)
    target = out or case.with_name(f"{case.stem}_soft{factor:g}.toml")
    refuse_existing(target, force=force)
    with atomic(target) as temporary:
        temporary.write_text(twin.text, encoding="utf-8")
    if as_json:
        print(
            json.dumps(
                {
                    "file": str(target),
                    "changes": [vars(c) for c in twin.changes],
                    "warnings": twin.warnings,
                    "strain_ratio": twin.strain_ratio,
                    "time_step_factor": twin.time_step_factor,
                },
                indent=1,
            )
        )
        return
    for c in twin.changes:
        print(f"{c.place}: {c.before} -> {c.after}")
    print(
        f"time step {twin.time_step_factor:.3g} times larger; a_max/R* {twin.strain_ratio[0]:.3f} -> "
        f"{twin.strain_ratio[1]:.3f}; e_n of every speed stays; written to {target}"
    )
    for warning in twin.warnings:
        print(f"warning: {warning}")


def calibrate(
    case: CasePath,
    e_n: Annotated[float | None, typer.Option("--e-n", help="measured coefficient of restitution")] = None,
    speed: Annotated[str | None, typer.Option(help='speed of that impact, as "2 m/s"')] = None,
    hv: Annotated[float | None, typer.Option(help="Vickers hardness [kgf/mm^2] instead of an impact")] = None,
    hb: Annotated[float | None, typer.Option(help="Brinell hardness [kgf/mm^2] instead of an impact")] = None,
    dent_ratio: Annotated[
        float | None,
        typer.Option(help="Brinell test: diameter of the indentation over that of the ball (default: 0.375)"),
    ] = None,
    as_json: AsJson = False,
) -> None:
    """Compute the strength of the case's law from one measured e_n, or from a hardness."""
    from ..studies import calibrate as c

    if (e_n is None) == (hv is None and hb is None):
        raise CaseError("give one measurement: --e-n with --speed, or --hv, or --hb")
    if hb is None:
        refuse(case, "it belongs to --hb", dent_ratio=dent_ratio)
    if e_n is not None:
        if speed is None:
            raise CaseError("--e-n belongs to one impact; add its speed, as --speed '2 m/s'")
        result = c.from_restitution(case, e_n, quantity("--speed", speed, "m/s"))
    else:
        refuse(case, "it belongs to --e-n", speed=speed)
        pressure = c.pressure_of_hardness(vickers=hv, brinell=hb, dent_ratio=dent_ratio)
        result = c.from_hardness(case, pressure, f"HV {hv:g}" if hv is not None else f"HB {hb:g}")
    if as_json:
        print(json.dumps(vars(result), indent=1))
        return
    print(
        f"law {result.law}, {result.source}: {result.parameter} = {result.value / 1e6:.6g} MPa, "
        f"that is yield_stress = {result.yield_stress / 1e6:.6g} MPa, yield speed {result.yield_speed:.4g} m/s\n"
        f'in the case file, under [law]: {result.parameter} = "{result.value / 1e6:.6g} MPa"'
    )


def deck_template(
    template: Path, case: Path, sets: list[str], out: Path, *, force: bool = False, as_json: bool = False
) -> None:
    """Write a deck from a template of the user's own and the values of a case."""
    from ..liggghts.own_template import settings, write

    names = [str(f) for f in write(template, case, settings(sets), out, force=force)]
    print(json.dumps({"files": names}) if as_json else "\n".join(names))
