# SPDX-License-Identifier: GPL-2.0-or-later
"""The commands `epdem theory` and `epdem figures`."""

import json
from pathlib import Path
from typing import Annotated

import typer

from ..base.terminal import console
from ..base.terminal import table as empty_table
from ..errors import CaseError
from .options import AsJson, CasePath, Engines, Force, Laws, laws_or_own, refuse


def theory(
    material: Annotated[str, typer.Option(help="material of sphere and wall, from the materials file")] = "steel",
    radius: Annotated[str, typer.Option(help='radius of the sphere, as "10 mm"')] = "10 mm",
    speed: Annotated[str, typer.Option(help='speed of the impact, as "5 m/s"')] = "5 m/s",
    as_json: AsJson = False,
) -> None:
    """Print one impact on a wall of the same material for every law."""
    import numpy as np

    from ..case.materials import material as sourced
    from ..case.units import read_number
    from ..impacts.experiment import Experiment, pair_of, plane, sphere
    from ..impacts.prediction import predict
    from ..laws.strengths import default_numbers
    from ..theory import printed, yielding
    from ..theory.backbones import LAWS

    entry, R, v = sourced(material), read_number("--radius", radius, "m"), read_number("--speed", speed, "m/s")
    if (Y := entry.material.yield_stress) is None:
        raise CaseError(f"--material {material!r} has no yield stress in the materials file; choose another")
    body, target = sphere(entry.material, radius=R, name=material), plane(entry.material, name=material)
    names = ("e_n", "contact_time", "force_max", "overlap_max", "residual_overlap", "strain_ratio")
    rows = {}
    for name in LAWS:
        x = Experiment(pair_of(default_numbers(name), body, target), body, target, np.array([v]))
        prediction = predict(x)
        rows[name] = {k: float(getattr(prediction, k)[0]) for k in names}
    plastic, first = LAWS["thornton"].default_ratio, yielding.FIRST_YIELD_ROUNDED
    p_0, depth = yielding.first_yield(entry.material.poisson_ratio)
    pair = {"E_star": x.E_star, "R_star": x.R_star, "m_star": x.m_star}
    common = {
        "E_star": x.E_star,
        "m_star": x.m_star,
        "first_yield_p0_over_Y": float(p_0),
        "first_yield_depth_over_a": float(depth),
        "v_y0": float(printed.yield_speed(p_y=first * Y, **pair)),
        "v_y": float(printed.yield_speed(p_y=plastic * Y, **pair)),
    }
    if as_json:
        print(
            json.dumps({"material": material, "source": entry.source, "radius": R, "speed": v, **common, "laws": rows})
        )
        return
    title = f"{material} sphere, R = {R:g} m, on {material} at {v:g} m/s (SI units)"
    table = empty_table(title, ("law", *rows["hertz"]), left=("law",))
    for name, row in rows.items():
        table.add_row(name, *(f"{value:.6g}" for value in row.values()))
    console().print(table)
    console().print(
        f"E* = {x.E_star:.5g} Pa, m* = {x.m_star:.5g} kg; first yield at p_0 = {float(p_0):.4f} Y, depth "
        f"{float(depth):.3f} a; v_y0 = {common['v_y0']:.4g} m/s ({first:.2f} Y), "
        f"v_y = {common['v_y']:.4g} m/s ({plastic:g} Y)",
        soft_wrap=True,
    )
    console().print(f"source: {entry.source}", soft_wrap=True)


def figures(
    out: Annotated[Path, typer.Option("--out", "-o", help="folder for the figures")] = Path("runs/figures"),
    force: Force = False,
    as_json: AsJson = False,
) -> None:
    """Draw figures 8.16, 8.17 and 8.19 of Seville and Wu (2016) from theory."""
    from ..base.folders import claim
    from ..studies.figures import draw_all

    with claim(out, force=force):
        names = [str(path) for path in draw_all(out)]
    print(json.dumps({"files": names}) if as_json else "\n".join(names))


def cite(case: CasePath, engine: Engines = None, law: Laws = None, as_json: AsJson = False) -> None:
    """Print what to cite for the law of a case and for the engines that ran it."""
    from ..case import scene
    from ..case.impact import load
    from ..case.toml import named, read_toml
    from ..engines import engine as find
    from ..engines.citations import citations
    from ..impacts.experiment import experiment

    tools = [find(name).name for name in engine or ["liggghts"]]
    with named(case):
        if scene.is_scene(read_toml(case)):
            refuse(case, "a scene has its own law", law=law)
            bulk = scene.load(case)
            laws, dashpot = [bulk.law.name], bulk.viscous is not None
        else:
            experiments = [experiment(load(case), name) for name in laws_or_own(law)]
            laws = [x.law.name for x in experiments]
            dashpot = experiments[0].viscous_restitution is not None
    found = citations(laws, tools, dashpot=dashpot)
    print(json.dumps(found) if as_json else "\n".join(f"{what}: {text}" for what, text in found.items()))
