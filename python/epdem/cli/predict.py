# SPDX-License-Identifier: GPL-2.0-or-later
"""The command `epdem predict`: prediction of a case, its time step, or one impact for every law."""

from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..base.terminal import status
from .options import AsJson, Laws, answer, refuse_options

if TYPE_CHECKING:  # slow to import
    from ..impacts.experiment import Experiment


def predict(
    case: Annotated[
        Path | None, typer.Argument(metavar="[CASE]", help="case file (TOML); without it one impact for every law")
    ] = None,
    law: Laws = None,
    error: Annotated[
        float | None,
        typer.Option(min=1e-9, max=0.1, help="find the time step of the case for this largest relative error of e_n"),
    ] = None,
    material: Annotated[
        str | None,
        typer.Option(help="one impact: material of sphere and wall, from the materials file (default: steel)"),
    ] = None,
    radius: Annotated[str | None, typer.Option(help='one impact: radius of the sphere (default: "10 mm")')] = None,
    speed: Annotated[str | None, typer.Option(help='one impact: its speed (default: "5 m/s")')] = None,
    adhesion: Annotated[
        str | None, typer.Option("--work-of-adhesion", help='one impact: as "0.1 J/m^2", the laws with adhesion, too')
    ] = None,
    full: Annotated[bool, typer.Option("--full", help="print the estimated share of elastic waves, too")] = False,
    as_json: AsJson = False,
) -> None:
    """Print the prediction of theory for a case; no engine runs.

    With --error print the time step for a target error. Without a case print one impact on a wall for every law.
    """
    from ..case.impact import load
    from ..case.plausibility import case_warnings
    from ..case.toml import error_context
    from ..impacts.experiment import experiment, one_impact
    from ..impacts.prediction import predict as predict_experiment
    from ..impacts.prediction_report import predictions

    warnings: list[str] = []
    if case is None:
        refuse_options("epdem predict", "it belongs to a case", law=law, error=error)
        experiments = one_impact(material or "steel", radius or "10 mm", speed or "5 m/s", adhesion)
    else:
        own = "the case has its own numbers"
        refuse_options(case, own, material=material, radius=radius, speed=speed, work_of_adhesion=adhesion)
        with error_context(case):
            read, laws = load(case), dict.fromkeys(law or [])
            experiments = [experiment(read, name) for name in laws] or [experiment(read)]
        warnings = case_warnings(read)
    if error is not None:
        with error_context(case):
            raise _time_steps(experiments, error, as_json)
    pairs = [(x, predict_experiment(x)) for x in experiments]
    raise answer(*predictions(pairs, warnings, full=full), as_json)


def _time_steps(experiments: "list[Experiment]", error: float, as_json: bool) -> typer.Exit:
    """Print the time steps for a target error, found with the embedded engine."""
    from ..impacts.plan import matched_step
    from ..impacts.prediction import predict as predict_experiment
    from ..impacts.prediction_report import costs, sentence

    documents, lines = [], []
    with status() as progress:
        for x in experiments:
            progress(f"{x.name}, {x.law.name}")
            f = matched_step(x, predict_experiment(x), error)
            share, found = f.shares(), costs(x, f.time_step, error)
            documents.append({"case": x.name, "law": x.law.name, **asdict(f), "share": share, "cost": found})
            lines.append(
                f"{x.name}, law {x.law.name}: timestep {f.time_step:.4g} s for e_n within {f.target:g} "
                f"(largest {f.error:.2g}, rms {f.rms:.2g}; {f.steps_in_contact:.0f} steps in the shortest contact)\n"
                f"  {share['stability']:.2%} of the stability limit, {share['rayleigh']:.2%} of the Rayleigh time, "
                f"{share['hertz']:.2%} of the elastic contact time\n"
                f"  {sentence(found)}"
            )
    return answer(documents[0] if len(documents) == 1 else documents, lines, as_json)
