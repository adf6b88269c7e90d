# SPDX-License-Identifier: GPL-2.0-or-later
"""Figures 8.16, 8.17 and 8.19 of Seville and Wu 2016 and figure 10 of Thornton and Ning 1998, redrawn from theory, the
last also from LIGGGHTS; sourced data points are not at hand."""

import tempfile
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from ..base.files import atomic
from ..case.impact import Material
from ..engines import DEFAULT_ENGINE, engine
from ..impacts.experiment import Experiment, plane, sphere
from ..impacts.plan import plan
from ..impacts.prediction import predict
from ..impacts.run import run_plan
from ..laws.strengths import ADHESION, LawSpec
from ..theory import pair, pressure, printed
from ..theory.backbones import LAWS
from ..theory.cavity import Cavity
from ..theory.restitution import e_n
from ..theory.yielding import FIRST_YIELD_ROUNDED, FULLY_PLASTIC

STEEL = {"E": 208e9, "nu": 0.3, "density": 7850.0, "Y": 1e9, "R": 0.01}  # the reference case


def _axes(title: str, xlabel: str, ylabel: str) -> tuple[Any, Any]:
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(figsize=(6.5, 4.5), layout="constrained")
    axes.set(title=title, xlabel=xlabel, ylabel=ylabel)
    axes.grid(alpha=0.3)
    return figure, axes


def _save(figure: Any, path: Path) -> Path:
    import matplotlib.pyplot as plt

    with atomic(path) as temporary:
        figure.savefig(temporary, dpi=130)
    plt.close(figure)
    return path


def mean_pressure(folder: Path) -> Path:
    """Figure 8.16: p_m/Y against E* a/(Y R*), elastic, expanding cavity (8.81), fully plastic (8.80), and law cavity.

    Full plasticity begins at 33.8 in the law, at about 40 in the chapter's text, at 73.6 where 8.81 reaches 2.8.
    """
    figure, axes = _axes("Mean contact pressure, eqs. 8.79 to 8.81", "E* a/(Y R*)", "p_m/Y")
    x = np.geomspace(0.5, 300, 400)
    axes.semilogx(x, pressure.mean(x), lw=2, label="three regimes")
    axes.semilogx(x[x < 4], pressure.elastic_mean(x[x < 4]), "--", lw=1, label="Hertz, 4x/(3 pi)")
    axes.semilogx(x[x > 1.5], pressure.cavity_mean(x[x > 1.5]), ":", lw=1.5, label="expanding cavity, 8.81")
    law = Cavity(E_star=1.0, R_star=1.0, Y=1e-3)
    alpha = np.geomspace(0.03, 3e4, 600) * law.yield_overlap
    a = law.radius(alpha)
    axes.semilogx(1e3 * a, law.force(alpha) / (np.pi * a * a * law.Y), "-.", lw=1.5, label="law cavity")
    for end in (law.radius(law.plastic_overlap) * 1e3, 40.0, pressure.cavity_end(FULLY_PLASTIC[0])):
        axes.axvline(float(end), color="0.7", lw=0.8, ls=":")
    axes.axhspan(*FULLY_PLASTIC, alpha=0.15, label="fully plastic, 8.80")
    axes.set_ylim(0, 3.6)
    axes.legend()
    return _save(figure, folder / "figure_8_16.png")


def unloading_pressure(folder: Path) -> Path:
    """Figure 8.17b: pressure while a fully plastic contact unloads, eq. 8.82; p = 2.8 Y, a* = 2.68 um."""
    figure, axes = _axes("Unloading from p = 2.8 Y, a* = 2.68 um: eq. 8.82", "r [um]", "p/Y")
    a_max = 2.68e-6
    for share in (1.0, 0.95, 0.8, 0.6, 0.4, 0.2):
        r = np.linspace(-1, 1, 801) * share * a_max
        axes.plot(
            r * 1e6, pressure.unloading(r, a=share * a_max, a_max=a_max, p=FULLY_PLASTIC[0]), label=f"a = {share:g} a*"
        )
    axes.legend()
    return _save(figure, folder / "figure_8_17.png")


def restitution(folder: Path) -> Path:
    """Figure 8.19: e_n against v/v_y0 for every law, with the printed equations 8.83, 8.86 and 8.88."""
    figure, axes = _axes("Restitution, steel sphere on a plane", "v/v_y0", "e_n")
    s = STEEL
    E = pair.E_star(s["E"], s["nu"], s["E"], s["nu"])
    m = pair.sphere_mass(radius=s["R"], density=s["density"])
    both = {"E_star": E, "R_star": s["R"], "m_star": m}
    v_y0 = printed.yield_speed(p_y=FIRST_YIELD_ROUNDED * s["Y"], **both)
    ratio = np.geomspace(0.3, 1e4, 500)
    for name, law in LAWS.items():
        strength = {k: law.default_ratio * s["Y"] for k in list(law.keywords.values())[:1]}
        axes.loglog(ratio, e_n(law(E_star=E, R_star=s["R"], **strength), m_star=m, speed=ratio * v_y0), label=name)
    thornton = printed.thornton(
        ratio, v_y=printed.yield_speed(p_y=LAWS["thornton"].default_ratio * s["Y"], **both) / v_y0
    )
    axes.loglog(ratio, thornton, "k:", lw=1.5, label="8.83")
    axes.loglog(
        ratio,
        printed.johnson(ratio * v_y0, p_m=LAWS["johnson"].default_ratio * s["Y"], **both),
        "k--",
        lw=1,
        label="8.86",
    )
    axes.loglog(ratio, printed.wu(ratio, v_y0=1.0), "k-.", lw=1, label="8.88 (finite elements)")
    axes.legend()
    return _save(figure, folder / "figure_8_19.png")


def adhesion_by_strength(folder: Path) -> Path:
    """Figure 10 of Thornton and Ning 1998: e_n against speed with adhesion for three strengths, and an elastic sphere;
    lines are theory, points are impacts in LIGGGHTS, where it is installed."""
    figure, axes = _axes("Adhesive spheres, R* = 10 um, Gamma = 0.2 J/m^2", "V [m/s]", "e_n")
    steel = Material.model_validate({"young_modulus": "215 GPa", "poisson_ratio": 0.3, "density": "7850 kg/m^3"})
    body, target = sphere(steel, radius=1e-5, name="steel"), plane(steel, name="steel")
    tool = engine(DEFAULT_ENGINE)
    for k, p_y in enumerate((None, 3.04e9, 1e9, 0.5e9)):
        law = LawSpec("jkr", {ADHESION: 0.2}, (np.inf, np.inf))
        if p_y is not None:
            law = LawSpec("thornton_ning", {ADHESION: 0.2, "yield_pressure": p_y}, (p_y, p_y))
        x = Experiment(law, body, target, np.geomspace(0.005, 50, 400))
        name = "elastic (JKR)" if p_y is None else f"p_y = {p_y / 1e9:g} GPa"
        axes.semilogx(x.speed, predict(x).e_n, color=f"C{k}", lw=1.2, label=name)
        if tool.missing() is None:
            points = replace(x, speed=np.geomspace(0.008, 30, 16))
            with tempfile.TemporaryDirectory(prefix="epdem-figure-") as scratch:
                found = run_plan(plan(points, predict(points)), tool, Path(scratch)).impacts
            e_n = found["e_n"].to_numpy().reshape(16, -1)[:, 0]
            axes.plot(points.speed, e_n, "o", color=f"C{k}", ms=4, mfc="none")
    axes.legend()
    return _save(figure, folder / "thornton_ning_1998.png")


def draw_all(folder: Path) -> list[Path]:
    """All figures into `folder`; their paths."""
    return [draw(folder) for draw in (mean_pressure, unloading_pressure, restitution, adhesion_by_strength)]
