# SPDX-License-Identifier: GPL-2.0-or-later
"""Figures 8.16, 8.17 and 8.19 of Seville and Wu 2016 and figure 10 of Thornton and Ning 1998, redrawn from theory, the
last also from LIGGGHTS; sourced data points are not at hand."""

import tempfile
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from ..case.fields import Material
from ..engines import DEFAULT_ENGINE, engine
from ..impacts.experiment import Experiment, plane, sphere
from ..impacts.plan import plan
from ..impacts.prediction import predict
from ..impacts.run import run_plan
from ..laws.strengths import ADHESION, LawSpec
from ..report.chart import GREY, INK, Axis, Chart, Panel, Series, save
from ..theory import pair
from ..theory.backbones import LAWS
from ..theory.cavity import Cavity
from ..theory.restitution import e_n, wu
from ..theory.yielding import FIRST_YIELD_ROUNDED, yield_speed
from . import printed

STEEL = {"E": 208e9, "nu": 0.3, "density": 7850.0, "Y": 1e9, "R": 0.01}  # the reference case


def mean_pressure() -> Chart:
    """Figure 8.16: p_m/Y against E* a/(Y R*), elastic, expanding cavity (8.81), fully plastic (8.80), and law cavity.

    Full plasticity begins at 33.8 in the law, at about 40 in the chapter's text, at 73.6 where 8.81 reaches 2.8.
    """
    x = np.geomspace(0.5, 300, 400)
    law = Cavity(E_star=1.0, R_star=1.0, Y=1e-3)
    alpha = np.geomspace(0.03, 3e4, 600) * law.yield_overlap
    a = law.radius(alpha)
    series = [
        Series("three regimes", x, printed.mean(x), INK, width=2.0),
        Series("Hertz, $4x/(3\\pi)$", x[x < 4], printed.elastic_mean(x[x < 4]), 0, "dash"),
        Series("expanding cavity, 8.81", x[x > 1.5], printed.cavity_mean(x[x > 1.5]), 1, "dot", width=1.5),
        Series("law cavity", 1e3 * a, law.force(alpha) / (np.pi * a * a * law.Y), 2, "dashdot", width=1.5),
    ]
    for k, p in enumerate(printed.FULLY_PLASTIC):
        series.append(Series("" if k else "fully plastic, 8.80", [0.5, 300], [p, p], GREY))
    for end in (law.radius(law.plastic_overlap) * 1e3, 40.0, printed.cavity_end(printed.FULLY_PLASTIC[0])):
        series.append(Series("", [float(end)] * 2, [0.0, 3.6], GREY, "dot", width=0.8))
    axes = Axis("$E^* a/(Y R^*)$", log=True, low=0.5, high=300), Axis("$p_m/Y$", low=0.0, high=3.6)
    title = "Mean contact pressure, eqs. 8.79 to 8.81"
    return Chart("figure_8_16", title, "Mean contact pressure against the size of the contact.", [Panel(*axes, series)])


def unloading_pressure() -> Chart:
    """Figure 8.17b: pressure while a fully plastic contact unloads, eq. 8.82; p = 2.8 Y, a* = 2.68 um."""
    a_max, series = 2.68e-6, []
    for k, share in enumerate((1.0, 0.95, 0.8, 0.6, 0.4, 0.2)):
        r = np.linspace(-1, 1, 801) * share * a_max
        p = printed.unloading(r, a=share * a_max, a_max=a_max, p=printed.FULLY_PLASTIC[0])
        series.append(Series(f"$a$ = {share:g} $a^*$", r * 1e6, p, k))
    axes = Axis("$r$", "µm"), Axis("$p/Y$")
    title = "Unloading from p = 2.8 Y, a* = 2.68 µm: eq. 8.82"
    return Chart("figure_8_17", title, "Pressure across the contact while it unloads.", [Panel(*axes, series)])


def restitution() -> Chart:
    """Figure 8.19: e_n against v/v_y0 for every law, with the printed equations 8.83, 8.86 and 8.88."""
    s = STEEL
    E = pair.E_star(s["E"], s["nu"], s["E"], s["nu"])
    m = pair.sphere_mass(radius=s["R"], density=s["density"])
    both = {"E_star": E, "R_star": s["R"], "m_star": m}
    v_y0 = yield_speed(p_y=FIRST_YIELD_ROUNDED * s["Y"], **both)
    ratio, series = np.geomspace(0.3, 1e4, 500), []
    for k, (name, law) in enumerate(LAWS.items()):
        declared = law.declaration()
        Y = declared.default_ratio * s["Y"]
        strength = {declared.parameter(declared.strength).symbol: Y} if declared.strength else {}
        found = e_n(law(E_star=E, R_star=s["R"], **strength), m_star=m, speed=ratio * v_y0)
        series.append(Series(name, ratio, found, k))
    v_y = yield_speed(p_y=LAWS["thornton"].declaration().default_ratio * s["Y"], **both) / v_y0
    series.append(Series("8.83", ratio, printed.thornton(ratio, v_y=v_y), INK, "dot", width=1.5))
    p_m = LAWS["johnson"].declaration().default_ratio * s["Y"]
    series.append(Series("8.86", ratio, printed.johnson(ratio * v_y0, p_m=p_m, **both), INK, "dash", width=1.0))
    series.append(Series("8.88 (finite elements)", ratio, wu(ratio, v_y0=1.0), INK, "dashdot", width=1.0))
    axes = Axis("$v/v_{y0}$", log=True), Axis("$e_n$", log=True)
    alt = "Coefficient of restitution of every law against the speed over that of first yield."
    return Chart("figure_8_19", "Restitution, steel sphere on a plane", alt, [Panel(*axes, series)])


def adhesion_by_strength() -> Chart:
    """Figure 10 of Thornton and Ning 1998: e_n against speed with adhesion for three strengths, and an elastic sphere;
    lines are theory, points are impacts in LIGGGHTS, where it is installed."""
    steel = Material.model_validate({"young_modulus": "215 GPa", "poisson_ratio": 0.3, "density": "7850 kg/m^3"})
    body, target = sphere(steel, radius=1e-5, name="steel"), plane(steel, name="steel")
    tool, series = engine(DEFAULT_ENGINE), []
    for k, p_y in enumerate((None, 3.04e9, 1e9, 0.5e9)):
        law = LawSpec("jkr", {ADHESION: 0.2}, (np.inf, np.inf))
        if p_y is not None:
            law = LawSpec("thornton_ning", {ADHESION: 0.2, "yield_pressure": p_y}, (p_y, p_y))
        x = Experiment(law, body, target, np.geomspace(0.005, 50, 400))
        name = "elastic (JKR)" if p_y is None else f"$p_y$ = {p_y / 1e9:g} GPa"
        series.append(Series(name, x.speed, predict(x).e_n, k))
        if tool.missing() is None:
            points = replace(x, speed=np.geomspace(0.008, 30, 16))
            with tempfile.TemporaryDirectory(prefix="epdem-figure-") as scratch:
                found = run_plan(plan(points, predict(points)), tool, Path(scratch)).tables["impacts"]
            series.append(Series("", points.speed, found["e_n"].to_numpy().reshape(16, -1)[:, 0], k, None, 0))
    axes = Axis("impact speed $v$", "m/s", log=True), Axis("$e_n$")
    alt = "Coefficient of restitution of adhesive spheres against impact speed: theory as lines, LIGGGHTS as points."
    title = "Adhesive spheres, R* = 10 µm, Γ = 0.2 J/m²"
    return Chart("thornton_ning_1998", title, alt, [Panel(*axes, series)])


def draw_all(folder: Path, formats: Sequence[str] = ("png",)) -> list[Path]:
    """All figures into `folder`, with their data; their paths."""
    charts = (mean_pressure(), unloading_pressure(), restitution(), adhesion_by_strength())
    return [path for chart in charts for path in save(chart, folder, formats)]
