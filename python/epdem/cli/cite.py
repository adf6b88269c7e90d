# SPDX-License-Identifier: GPL-2.0-or-later
"""The command `epdem cite`."""

import json
from typing import Annotated

import typer

from ..base.settings import DEFAULT_ENGINE
from .options import AsJson, CasePath, Engines, Laws, refuse


def cite(
    case: CasePath,
    engine: Engines = None,
    law: Laws = None,
    bibtex: Annotated[bool, typer.Option("--bibtex", help="print entries of BibTeX")] = False,
    as_json: AsJson = False,
) -> None:
    """Print what to cite for the law of a case and for the engines that run the case."""
    from ..case import scene
    from ..case.impact import load
    from ..case.toml import named, read_toml
    from ..engines import engine as find
    from ..engines.citations import citations

    refuse(case, "--bibtex prints BibTeX", json=as_json and bibtex)
    tools = [find(name).name for name in engine or [DEFAULT_ENGINE]]
    with named(case):
        if scene.is_scene(read_toml(case)):
            refuse(case, "a scene has its own law", law=law)
            bulk = scene.load(case)
            found = citations(bulk, [bulk.law.name], tools)
        else:
            impacts = load(case)
            found = citations(impacts, law or [impacts.law.name], tools)
    if bibtex:
        print(found.bibtex(), end="")
    else:
        print(json.dumps(found) if as_json else "\n".join(f"{what}: {text}" for what, text in found.items()))
