# SPDX-License-Identifier: GPL-2.0-or-later
"""The commands `epdem theory` and `epdem figures`."""

import json
from pathlib import Path
from typing import Annotated

import typer

from ..terminal import console
from ..terminal import table as empty_table
from .options import AsJson, quantity


def theory(
    material: Annotated[str, typer.Option(help="of sphere and wall, from the materials file")] = "steel",
    radius: Annotated[str, typer.Option(help='of the sphere, as "10 mm"')] = "10 mm",
    speed: Annotated[str, typer.Option(help='of the impact, as "5 m/s"')] = "5 m/s",
    as_json: AsJson = False,
) -> None:
    """What every law says of one impact on a wall of the same material."""
    from ..case.materials import material as find
    from ..theory import pair, printed, yielding
    from ..theory.backbones import LAWS
    from ..theory.restitution import impact

    found, R, v = find(material), quantity("--radius", radius, "m"), quantity("--speed", speed, "m/s")
    m = found.material
    E = pair.E_star(m.young_modulus, m.poisson_ratio, m.young_modulus, m.poisson_ratio)
    mass = pair.sphere_mass(radius=R, density=m.density)
    rows = {}
    for name, law in LAWS.items():
        strength = {k: law.default_ratio * m.yield_stress for k in list(law.keywords.values())[:1]}
        x = impact(law(E_star=E, R_star=R, **strength), m_star=mass, speed=v)
        rows[name] = {
            k: float(getattr(x, k))
            for k in ("e_n", "contact_time", "force_max", "overlap_max", "residual_overlap", "strain_ratio")
        }
    p_0, depth = yielding.first_yield(m.poisson_ratio)
    common = {
        "E_star": E,
        "m_star": mass,
        "first_yield_p0_over_Y": float(p_0),
        "first_yield_depth_over_a": float(depth),
        "v_y0": float(printed.yield_speed(p_y=1.6 * m.yield_stress, E_star=E, R_star=R, m_star=mass)),
        "v_y": float(printed.yield_speed(p_y=2.8 * m.yield_stress, E_star=E, R_star=R, m_star=mass)),
    }
    if as_json:
        print(
            json.dumps({"material": material, "source": found.source, "radius": R, "speed": v, **common, "laws": rows})
        )
        return
    title = f"{material} sphere, R = {R:g} m, on {material} at {v:g} m/s (SI units)"
    table = empty_table(title, ("law", *rows["hertz"]), left=("law",))
    for name, row in rows.items():
        table.add_row(name, *(f"{value:.6g}" for value in row.values()))
    console().print(table)
    console().print(
        f"E* = {E:.5g} Pa, m* = {mass:.5g} kg; first yield at p_0 = {float(p_0):.4f} Y, depth "
        f"{float(depth):.3f} a; v_y0 = {common['v_y0']:.4g} m/s (1.60 Y), "
        f"v_y = {common['v_y']:.4g} m/s (2.8 Y)",
        soft_wrap=True,
    )
    console().print(f"source: {found.source}", soft_wrap=True)


def figures(
    out: Annotated[Path, typer.Option("--out", "-o", help="folder")] = Path("docs/figures"), as_json: AsJson = False
) -> None:
    """Figures 8.16, 8.17 and 8.19 of the chapter, redrawn from theory."""
    from ..studies.figures import draw_all

    names = [str(path) for path in draw_all(out)]
    print(json.dumps({"files": names}) if as_json else "\n".join(names))
