# SPDX-License-Identifier: GPL-2.0-or-later
"""Figures 8.16 to 8.19 of Seville and Wu 2016 and figure 10 of Thornton and Ning 1998: theory, engines, data."""

import tempfile
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from ..case.fields import Material
from ..engines import DEFAULT_ENGINE, engine
from ..impacts.experiment import Experiment, experiment, plane, sphere
from ..impacts.plan import plan
from ..impacts.prediction import predict
from ..impacts.run import run_plan
from ..laws.strengths import ADHESION, LawSpec
from ..report.chart import GREY, INK, Axis, Chart, Panel, Series, save
from ..theory import pair, printed
from ..theory.backbones import LAWS
from ..theory.cavity import Cavity
from ..theory.restitution import e_n
from ..theory.waves import history
from ..theory.yielding import FIRST_YIELD_ROUNDED, yield_speed
from .measured_data import case_of, names, read

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
        Series("three regimes", x, printed.mean_pressure(x), INK, width=2.0),
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


def pressure_profiles() -> Chart:
    """Figure 8.17: pressure while a contact loads, cut off at p_y = 2.8 Y (a), and unloads by 8.82 (b)."""
    a_max, p, panels = 2.68e-6, printed.FULLY_PLASTIC[0], []
    s = STEEL
    contact = {"E_star": pair.E_star(s["E"], s["nu"], s["E"], s["nu"]) / s["Y"], "R_star": 1e-5}
    loading = {"loading, $p_y$ = 2.8 $Y$": (0.05, 0.1, 0.2, 0.4, 0.7, 1.0)}
    for name, shares in (loading | {"unloading, 8.82": (1.0, 0.95, 0.8, 0.6, 0.4, 0.2)}).items():
        series = []
        for k, share in enumerate(shares):
            a = share * a_max
            r = np.linspace(-a, a, 801)
            if name in loading:
                values = printed.loading_pressure(r, **contact, a=a, p_y=p)
            else:
                values = printed.unloading_pressure(r, a=a, a_max=a_max, p=p)
            series.append(Series(f"$a$ = {share:g} $a^*$, {name.split(',')[0]}", r * 1e6, values, k))
        panels.append(Panel(Axis("$r$", "µm"), Axis("$p/Y$"), series))
    title = "Contact pressure up to a* = 2.68 µm (R* = 10 µm) and back"
    return Chart("figure_8_17", title, "Pressure across the contact while it loads and unloads.", panels)


def force_history() -> Chart:
    """Figure 8.18: force against time (a) and overlap (b) at four speeds, law thornton; lines are theory, points an
    engine: LIGGGHTS where it is installed, else the embedded one."""
    steel = Material.model_validate({"young_modulus": "208 GPa", "poisson_ratio": 0.3, "density": "7850 kg/m^3"})
    p_y = LAWS["thornton"].declaration().default_ratio * STEEL["Y"]
    law = LawSpec("thornton", {"yield_pressure": p_y}, (p_y, p_y))
    body, target = sphere(steel, radius=STEEL["R"], name="steel"), plane(steel, name="steel")
    x = Experiment(law, body, target, np.array([0.5, 2.0, 5.0, 10.0]))
    p, tool = plan(x, predict(x)), engine(DEFAULT_ENGINE)
    tool = engine("embedded") if tool.missing() else tool
    with tempfile.TemporaryDirectory(prefix="epdem-figure-") as scratch:
        tool.write(p, Path(scratch))
        path = tool.run(p, Path(scratch))
    times, overlaps, forces = history(x.backbone(), m_star=x.m_star, speed=x.speed)
    by_time: list[Series] = []
    by_overlap: list[Series] = []
    for k, v in enumerate(x.speed):
        n = int(np.argmax(p.speed == v))
        points = np.flatnonzero(path.force[n] > 0)
        points = points[:: max(1, len(points) // 25)]
        t = points * p.time_step - p.gap[n] / v
        for series, there, found in ((by_time, times, t), (by_overlap, overlaps, path.overlap[n, points])):
            series.append(Series(f"{v:g} m/s", 1e6 * there[k], 1e-3 * forces[k], k))
            series.append(Series("", 1e6 * found, 1e-3 * path.force[n, points], k, None, 0))
    force = Axis("$F$", "kN")
    panels = [Panel(Axis("$t$", "µs"), force, by_time), Panel(Axis("$\\alpha$", "µm"), force, by_overlap)]
    alt = f"Force of impacts at four speeds against time and overlap: theory as lines, {tool.name} as points."
    title = f"Steel sphere of 10 mm on a steel plane, law thornton: theory and {tool.name}"
    return Chart("figure_8_18", title, alt, panels, beside=True)


def measured_restitution() -> Series:
    """Measured e_n of data/restitution over v/v_y0 of the softer material (1.60 Y; yield stress from the hardness by
    law cavity)."""
    ratios, values = [], []
    for name in names():
        measured = read(name)
        for _, point in measured.points[measured.points["quantity"] == "e_n"].iterrows():
            material = str(point["strength of"])
            case = case_of(measured, material, float(point[measured.given]), [point["speed"]], "cavity")
            ratios.append(point["speed"] / predict(experiment(case, "cavity")).yield_speeds[material])
            values.append(point["value"])
    return Series("measured (data/restitution)", np.array(ratios), np.array(values), INK, None, 0)


def restitution() -> Chart:
    """Figure 8.19: e_n against v/v_y0 for every law, the printed equations 8.83, 8.86, 8.88, and measured impacts."""
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
    series.append(Series("8.83", ratio, printed.thornton_restitution(ratio, v_y=v_y), INK, "dot", width=1.5))
    p_m = LAWS["johnson"].declaration().default_ratio * s["Y"]
    series.append(
        Series("8.86", ratio, printed.johnson_restitution(ratio * v_y0, p_m=p_m, **both), INK, "dash", width=1.0)
    )
    series.append(
        Series("8.88 (finite elements)", ratio, printed.wu_restitution(ratio, v_y0=1.0), INK, "dashdot", width=1.0)
    )
    series.append(measured_restitution())
    axes = Axis("$v/v_{y0}$", log=True), Axis("$e_n$", log=True)
    alt = "Coefficient of restitution of every law and of measured impacts against the speed over that of first yield."
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
    charts = (mean_pressure(), pressure_profiles(), force_history(), restitution(), adhesion_by_strength())
    return [path for chart in charts for path in save(chart, folder, formats)]
