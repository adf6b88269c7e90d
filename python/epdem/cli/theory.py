# SPDX-License-Identifier: GPL-2.0-or-later
"""The commands `epdem theory` and `epdem cite`."""

import json
from typing import Annotated

import typer

from ..base.settings import DEFAULT_ENGINE
from ..base.terminal import console, show_table
from ..base.terminal import table as empty_table
from .options import AsJson, CasePath, Engines, Laws, refuse


def theory(
    material: Annotated[str, typer.Option(help="material of sphere and wall, from the materials file")] = "steel",
    radius: Annotated[str, typer.Option(help='radius of the sphere, as "10 mm"')] = "10 mm",
    speed: Annotated[str, typer.Option(help='speed of the impact, as "5 m/s"')] = "5 m/s",
    adhesion: Annotated[
        str | None, typer.Option("--work-of-adhesion", help='as "0.1 J/m^2": the laws with adhesion, too')
    ] = None,
    as_json: AsJson = False,
) -> None:
    """Print one impact on a wall of the same material for every law."""
    from dataclasses import asdict

    from ..case.units import read_number
    from ..impacts.report import plain
    from ..studies.one_impact import one_impact

    x = one_impact(
        material,
        radius=read_number("--radius", radius, "m"),
        speed=read_number("--speed", speed, "m/s"),
        adhesion=None if adhesion is None else read_number("--work-of-adhesion", adhesion, "J/m^2"),
    )
    if as_json:
        rows = {name: {k: plain(v) for k, v in row.items()} for name, row in x.laws.items()}
        print(json.dumps({k: v for k, v in asdict(x).items() if k not in ("first", "plastic")} | {"laws": rows}))
        return
    title = f"{material} sphere, R = {x.radius:g} m, on {material} at {x.speed:g} m/s (SI units)"
    table = empty_table(title, ("law", *x.laws["hertz"]), left=("law",))
    for name, row in x.laws.items():
        table.add_row(name, *(f"{value:.6g}" for value in row.values()))
    show_table(console(), table)
    console().print(
        f"E* = {x.E_star:.5g} Pa, m* = {x.m_star:.5g} kg; first yield at p_0 = {x.first_yield_p0_over_Y:.4f} Y, depth "
        f"{x.first_yield_depth_over_a:.3f} a; v_y0 = {x.v_y0:.4g} m/s ({x.first:.2f} Y), "
        f"v_y = {x.v_y:.4g} m/s ({x.plastic:g} Y)",
        soft_wrap=True,
    )
    console().print(f"source: {x.source}", soft_wrap=True)


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
