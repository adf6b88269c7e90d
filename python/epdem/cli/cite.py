# SPDX-License-Identifier: GPL-2.0-or-later
"""The command `epdem cite`."""

import json
from typing import Annotated

import typer

from ..base.settings import DEFAULT_ENGINE
from .options import AsJson, CasePath, Engines, Laws, refuse
from .scenes import is_scene


def cite(
    case: CasePath,
    engine: Engines = None,
    law: Laws = None,
    bibtex: Annotated[bool, typer.Option("--bibtex", help="print entries of BibTeX")] = False,
    as_json: AsJson = False,
) -> None:
    """Print what to cite for the law of a case and for the engines that run the case."""
    from ..api import cite as cited

    refuse(case, "--bibtex prints BibTeX", json=as_json and bibtex)
    if is_scene(case):
        refuse(case, "a scene has its own law", law=law)
    found = cited(case, engines=engine or [DEFAULT_ENGINE], laws=law or [])
    if bibtex:
        print(found.bibtex(), end="")
    else:
        print(json.dumps(found) if as_json else "\n".join(f"{what}: {text}" for what, text in found.items()))
