# SPDX-License-Identifier: GPL-2.0-or-later
"""The command `epdem timestep`."""

import json
from typing import Annotated

import typer

from ..base.terminal import status
from .options import AsJson, CasePath, Laws, laws_or_own


def timestep(
    case: CasePath,
    error: Annotated[float, typer.Option(min=1e-9, max=0.1, help="largest relative error of e_n")] = 1e-3,
    law: Laws = None,
    as_json: AsJson = False,
) -> None:
    """Find the time step of a case for a target error, with the embedded engine."""
    from ..case.impact import load
    from ..case.toml import named
    from ..impacts.experiment import experiment
    from ..impacts.prediction import predict
    from ..impacts.timestep import search

    searches = []
    with status() as progress, named(case):
        for name in laws_or_own(law):
            x = experiment(load(case), name)
            progress(f"{x.name}, {x.law.name}")
            searches.append((x, search(x, predict(x), error)))
    if as_json:
        documents = [
            {
                "case": x.name,
                "law": x.law.name,
                "target": f.target,
                "time_step": f.time_step,
                "error": f.error,
                "rms": f.rms,
                "steps_in_contact": f.steps_in_contact,
                "reference": vars(f.reference),
                "share": f.shares(),
            }
            for x, f in searches
        ]
        print(json.dumps(documents[0] if len(documents) == 1 else documents, indent=1))
        return
    for x, f in searches:
        share = f.shares()
        print(
            f"{x.name}, law {x.law.name}: timestep {f.time_step:.4g} s for e_n within {f.target:g} "
            f"(largest {f.error:.2g}, rms {f.rms:.2g}; {f.steps_in_contact:.0f} steps in the shortest contact)\n"
            f"  {share['stability']:.2%} of the stability limit, {share['rayleigh']:.2%} of the Rayleigh time, "
            f"{share['hertz']:.2%} of the elastic contact time"
        )
