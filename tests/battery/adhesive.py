# SPDX-License-Identifier: GPL-2.0-or-later
"""The adhesive laws of C++ behind a pipe, and the theory of the same contacts."""

import functools
import subprocess
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from epdem.theory import adhesion
from epdem.theory.cavity_adhesive import CavityAdhesive
from epdem.theory.jkr import JKR
from epdem.theory.thornton_ning import ThorntonNing

HERE = Path(__file__).parent
E_STEEL, R_FINE, GAMMA = 215e9 / (2 * (1 - 0.3**2)), 1e-5, 0.2
DENSITY = 7850.0


@functools.cache
def _folder() -> tempfile.TemporaryDirectory:
    return tempfile.TemporaryDirectory()  # goes with the process


@functools.cache
def program() -> Path:
    """adhesive_impacts.cpp, built once per process."""
    path = Path(_folder().name) / "adhesive_impacts"
    include = HERE.parents[1] / "cpp_contact" / "include"
    command = ["g++", "-std=c++17", "-O2", "-Wall", "-Wextra", "-Werror", f"-I{include}"]
    subprocess.run([*command, HERE / "adhesive_impacts.cpp", "-o", path], check=True)
    return path


def ask(lines: list[str]) -> list[np.ndarray]:
    """The numbers that the program answers to each line."""
    done = subprocess.run([program()], input="\n".join(lines), capture_output=True, text=True, check=True)
    return [np.array(line.split(), float) for line in done.stdout.splitlines()]


@dataclass(frozen=True)
class Contact:
    """A pair with adhesion [SI]; p_y None: it does not yield. m_star is that of a solid sphere of R_star.

    cavity: law cavity_adhesive, and p_y is its yield stress; c_strain: its finite strain."""

    p_y: float | None = None
    Gamma: float = GAMMA
    R_star: float = R_FINE
    E_star: float = E_STEEL
    cavity: bool = False
    c_strain: float = 1e6

    @property
    def m_star(self) -> float:
        return 4 / 3 * np.pi * self.R_star**3 * DENSITY

    @functools.cached_property
    def theory(self) -> JKR:
        numbers = {"E_star": self.E_star, "R_star": self.R_star, "Gamma": self.Gamma}
        if self.cavity:
            return CavityAdhesive(**numbers, Y=self.p_y, c_strain=self.c_strain, share=0.5)
        return JKR(**numbers) if self.p_y is None else ThorntonNing(**numbers, p_y=self.p_y)

    @functools.cached_property
    def V_s(self) -> float:
        return float(adhesion.sticking_speed(self.theory, m_star=self.m_star))

    @property
    def words(self) -> str:
        name = "cavity_adhesive" if self.cavity else "jkr" if self.p_y is None else "thornton_ning"
        return f"{name} {self.E_star!r} {self.R_star!r} {self.Gamma!r} {self.p_y or 0.0!r} {self.c_strain!r}"

    def path(self, overlaps) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Force [N], contact radius [m] and stored energy [J] at prescribed overlaps [m], one after the other."""
        (row,) = ask([f"path {self.words} {len(overlaps)} {' '.join(repr(float(x)) for x in overlaps)}"])
        return row[::3], row[1::3], row[2::3]

    def line(self, V: float, dt: float, phase: float, steps: int) -> str:
        """An impact at V [m/s] that touches at `phase` in [0, 1) of a step of dt [s]."""
        return f"impact {self.words} {self.m_star!r} {V!r} {dt!r} {phase * V * dt!r} {steps}"


COLUMNS = ("rebound", "force_max", "overlap_max", "force_min", "last_overlap", "last_step")


def impacts(cases: list[tuple[Contact, float]], steps: int, phases: int = 8):
    """Impacts of (contact, speed) at dt = contact time/steps: theory of each case, and dict of arrays (case, phase)."""
    theory = [adhesion.impact(c.theory, m_star=c.m_star, speed=V) for c, V in cases]
    lines = []
    for (c, V), x in zip(cases, theory, strict=True):
        dt = float(x.contact_time) / steps
        lines += [c.line(V, dt, (k + 0.5) / phases, 20 * steps) for k in range(phases)]
    rows = np.array(ask(lines)).reshape(len(cases), phases, len(COLUMNS))
    return theory, dict(zip(COLUMNS, np.moveaxis(rows, 2, 0), strict=True))


def e_n_errors(cases: list[tuple[Contact, float]], steps: int, phases: int = 8) -> np.ndarray:
    """Largest |e_n - theory| over the phases, one per case."""
    theory, found = impacts(cases, steps, phases)
    e_n = found["rebound"] / np.array([[V] for _, V in cases])
    return np.abs(e_n - np.array([[float(x.e_n)] for x in theory])).max(axis=1)
