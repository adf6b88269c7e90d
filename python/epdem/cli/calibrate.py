# SPDX-License-Identifier: GPL-2.0-or-later
"""The command `epdem calibrate`."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..base.terminal import bar, warned
from ..errors import CaseError
from .options import AsJson, CasePath, Force, Out, answer, refuse_options

if TYPE_CHECKING:
    from ..studies.calibrate import Calibration


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
    impacts = {"e_n": e_n, "speed": speed, "measured": measured, "uncertainty": uncertainty}
    hardness = {"hv": hv, "hb": hb, "dent_ratio": dent_ratio}
    curve = {"indentation": indentation}
    of_scene = {"tolerance": tolerance, "engine": engine, "ranks": ranks, "jobs": jobs, "out": out}
    if target or free:
        refuse_options(case, "it does not go with --target and --free", **impacts, **hardness, **curve)
        given = {k: v for k, v in (of_scene | {"force": force}).items() if v is not None}
        raise _of_scene(case, target or [], free or [], given, as_json)
    refuse_options(case, "it goes with --target and --free", **of_scene, force=force)
    from ..studies.calibrate import summary

    found = _from_measurement(case, e_n or [], speed or [], measured, uncertainty, hardness, indentation)
    raise answer(vars(found), [*summary(found), *warned(found.warnings)], as_json)


def _of_scene(case: Path, target: list[str], free: list[str], options: dict[str, Any], as_json: bool) -> typer.Exit:
    from ..studies.fit import fit
    from ..studies.pages import write_sweep_page
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
    page = write_sweep_page(found.sweep, [*said, counts])
    known = {name: value for name, value in vars(found).items() if name != "sweep"}
    return answer(known, [*said, f"{counts}; see {page}"], as_json)


def _from_measurement(
    case: Path,
    e_n: list[float],
    speed: list[str],
    measured: bool,
    uncertainty: float | None,
    hardness: dict[str, float | None],
    indentation: Path | None,
) -> "Calibration":
    from ..case.units import read_number
    from ..studies import calibrate as c

    hv, hb, dent_ratio = hardness.values()
    if (bool(e_n) + measured + (hv is not None or hb is not None) + (indentation is not None)) != 1:
        raise CaseError("give one measurement: --e-n with --speed, --measured, --hv, --hb, or --indentation")
    if hb is None:
        refuse_options(case, "it belongs to --hb", dent_ratio=dent_ratio)
    if not e_n:
        refuse_options(case, "it belongs to --e-n", speed=speed)
    if not (measured or e_n):
        refuse_options(case, "it belongs to --e-n and --measured", uncertainty=uncertainty)
        if indentation is not None:
            return c.from_indentation(case, indentation)
        test = c.hardness_test(vickers=hv, brinell=hb, dent_ratio=dent_ratio)
        return c.from_hardness(case, test, f"HV {hv:g}" if hv is not None else f"HB {hb:g}")
    if len(e_n) != len(speed):
        raise CaseError("--e-n belongs to one impact; add its speed, as --speed '2 m/s'")
    points = [(read_number("--speed", v, "m/s"), e) for v, e in zip(speed, e_n, strict=True)]
    if measured:
        points = c.measured_restitutions(case)
    if len(points) == 1:
        refuse_options(case, "it belongs to several e_n", uncertainty=uncertainty)
        return c.from_restitution(case, points[0][1], points[0][0])
    return c.from_restitutions(case, points, uncertainty)
