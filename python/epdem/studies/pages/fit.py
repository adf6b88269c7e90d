# SPDX-License-Identifier: GPL-2.0-or-later
"""The page of a fit of a scene."""

from pathlib import Path

from ...report.chart import INK, Axis, Chart, Panel, Series
from ...report.page import Page, Rows
from ..fit import Fit
from ..sweep.table import read_sweep
from . import common


def of_fit(found: Fit) -> Path:
    """Write the page of a fit of a scene into the folder of its points."""
    folder = found.case.parents[2]
    table = read_sweep(folder).dropna(subset=list(found.targets))
    units = table.attrs.get("units", {}) | found.units
    panels = []
    for name, target in found.targets.items():
        for k, key in enumerate(found.values):
            x, y = table[key].to_numpy(float), table[name].to_numpy(float)
            shown = [
                Series("points", x, y, k, None, 0),
                Series("target", [x.min(), x.max()], [target] * 2, INK, "dash"),
            ]
            panels.append(Panel(Axis(key, units.get(key, "")), Axis(name, units.get(name, "")), shown))
    names = ", ".join(found.targets)
    said = [
        f"{', '.join(f'{key} = {value}' for key, value in found.values.items())} gives "
        + ", ".join(f"{n} = {v:.6g} {found.units[n]} (target {found.targets[n]:.6g})" for n, v in found.numbers.items())
        + ".",
        f"{found.points} scenes, {found.ran} of them just now; the case with these values is {found.case}.",
    ]
    alt = f"{names} of every scene of the fit against the keys that it frees; the target as a dashed line."
    charts = [Chart(f"fit{n}", "Target against key", alt, [panel]) for n, panel in enumerate(panels)]
    rows = Rows("All scenes", table[["point", *found.values, *found.targets]], units)
    case = common.case_lines(found.case.read_text(encoding="utf-8"))
    page = Page(f"Fit of {names}", said, [*charts, rows, case, common.origin({}, {})], command=common.command())
    return common.written(page, folder)
