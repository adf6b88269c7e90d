# SPDX-License-Identifier: GPL-2.0-or-later
"""The command `epdem calibrate`."""

from pathlib import Path
from typing import Annotated, Any

import typer

from ..base.terminal import bar, warned
from .options import AsJson, CasePath, Force, Out, answer, refuse_options


def calibrate(
    case: CasePath,
    e_n: Annotated[
        list[float] | None,
        typer.Option("--e-n", help="measured coefficient of restitution; repeat with --speed for a law that hardens"),
    ] = None,
    speed: Annotated[list[str] | None, typer.Option(help='speed of that impact, as "2 m/s"')] = None,
    measured: Annotated[
        bool, typer.Option("--measured", help="take speeds and e_n from the table 'measured' of the case")
    ] = False,
    uncertainty: Annotated[float | None, typer.Option(help="standard error of each of several e_n")] = None,
    hv: Annotated[float | None, typer.Option(help="Vickers hardness in kgf/mm^2 instead of an impact")] = None,
    hb: Annotated[float | None, typer.Option(help="Brinell hardness in kgf/mm^2 instead of an impact")] = None,
    dent_ratio: Annotated[
        float | None,
        typer.Option(help="Brinell test: diameter of the indentation over diameter of the ball (default: 0.375)"),
    ] = None,
    indentation: Annotated[
        Path | None,
        typer.Option(
            metavar="CURVE.csv",
            help="columns of depth and force with their units, measured on the contact, instead of an impact",
        ),
    ] = None,
    target: Annotated[
        list[str] | None,
        typer.Option(metavar="NAME=VALUE", help='number of a scene\'s results, as plate_force_max="12 N"; repeat'),
    ] = None,
    free: Annotated[
        list[str] | None,
        typer.Option(metavar="KEY=LOW..HIGH", help="key of the scene to be found, and its range; up to three"),
    ] = None,
    tolerance: Annotated[float | None, typer.Option(help="largest relative error of a target (default: 0.01)")] = None,
    engine: Annotated[str | None, typer.Option("--engine", "-e", help="of the scene (default: liggghts)")] = None,
    ranks: Annotated[int | None, typer.Option(min=1, max=1024, help="MPI ranks of each scene (default: 1)")] = None,
    jobs: Annotated[int | None, typer.Option("--jobs", "-j", min=1, help="scenes at once (default: cores)")] = None,
    out: Out = None,
    force: Force = False,
    as_json: AsJson = False,
) -> None:
    """Compute the strength of a law from e_n, a hardness or an indentation, or keys of a scene from its results.

    A fit of a scene leaves report.html in its folder.
    """
    impacts: dict[str, Any] = {"e_n": e_n, "speed": speed, "measured": measured, "uncertainty": uncertainty}
    hardness: dict[str, Any] = {"hv": hv, "hb": hb, "dent_ratio": dent_ratio}
    curve: dict[str, Any] = {"indentation": indentation}
    of_scene = {"tolerance": tolerance, "engine": engine, "ranks": ranks, "jobs": jobs, "out": out}
    if target or free:
        refuse_options(case, "it does not go with --target and --free", **impacts, **hardness, **curve)
        given = {k: v for k, v in (of_scene | {"force": force}).items() if v is not None}
        raise _of_scene(case, target or [], free or [], given, as_json)
    refuse_options(case, "it goes with --target and --free", **of_scene, force=force)
    from ..studies.calibrate import from_measurement, summary

    impacts |= {"e_n": e_n or [], "speed": speed or []}
    found = from_measurement(case, **impacts, **hardness, **curve)
    raise answer(vars(found), [*summary(found), *warned(found.warnings)], as_json)


def _of_scene(case: Path, target: list[str], free: list[str], options: dict[str, Any], as_json: bool) -> typer.Exit:
    from ..studies.fit import fit
    from ..studies.sweep.points import settings

    targets = settings(target, "--target", "plate_force_max='12 N'")
    with bar(case.stem, "points") as report:
        found = fit(case, targets, settings(free, "--free", "contact.friction=0.1..0.9"), report=report, **options)
    said = [f"{key} = {value}" for key, value in found.values.items()]
    for name, value in found.numbers.items():
        said.append(
            f"  gives {name} = {value:.6g} {found.units[name]}".rstrip() + f" (target {found.targets[name]:.6g})"
        )
    counts = f"{found.points} scenes, {found.ran} of them just now; the case with these values: {found.case}"
    page = found.sweep.report([*said, counts])
    known = {name: value for name, value in vars(found).items() if name != "sweep"}
    return answer(known, [*said, f"{counts}; see {page}"], as_json)
