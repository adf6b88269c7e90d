# SPDX-License-Identifier: GPL-2.0-or-later
"""The C++ law of partial slip for tests: arrays of contacts, oblique impacts and cycles of shear."""

import ctypes
import subprocess
import tempfile
from functools import cache
from pathlib import Path

import numpy as np

from epdem.theory import partial_slip, restitution
from epdem.theory.backbones import Cavity, Hertz, Johnson, Thornton

ROOT = Path(__file__).parents[2]
FLAGS = ["-std=c++17", "-O2", "-Wall", "-Wextra", "-Werror", "-shared", "-fPIC"]
E_STAR, G_STAR, R, M, MU = 1.1428571428571429e11, 2.3529411764705883e10, 0.01, 0.032882003107573169, 0.3  # nu = 0.3
KAPPA = 4 * G_STAR / E_STAR
V_Y0, V_Y = 0.138086424357753, 0.559430455498519  # first yield of cavity at Y = 1 GPa, of thornton at 2.8 GPa
PAIR = {"E_star": E_STAR, "R_star": R}
LAWS = {
    "hertz": Hertz(**PAIR),
    "thornton": Thornton(**PAIR, p_y=2.8e9),
    "johnson": Johnson(**PAIR, p_m=3e9),
    "cavity": Cavity(**PAIR, Y=1e9),
}
IMPACTS = [
    ("hertz", 1.0),
    ("thornton", 5 * V_Y),
    ("thornton", 20 * V_Y),  # where the error of 3 nodes is largest
    ("thornton", 50 * V_Y),
    ("cavity", 5 * V_Y0),
    ("cavity", 50 * V_Y0),
    ("cavity", 150 * V_Y0),  # as above
    ("cavity", 500 * V_Y0),
]


@cache
def library() -> ctypes.CDLL:
    """slip.cpp, compiled once per process."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "slip.so"
        source = Path(__file__).with_suffix(".cpp")
        subprocess.run(["g++", *FLAGS, f"-I{ROOT}/cpp_contact/include", "-o", path, source], check=True)
        return ctypes.CDLL(str(path))


def _pointer(x):
    return x.ctypes.data_as(ctypes.POINTER(ctypes.c_double))


class Contacts:
    """Contacts that share 8 G* and mu; what they remember, their friction and their energy after each step."""

    def __init__(self, count, *, nodes=3, flattens=False, damped=False, lanes=False, G_star=G_STAR, mu=MU):
        self.options = [nodes, int(flattens), int(damped), int(lanes)]
        self.stiffness, self.mu = 8 * G_star, mu
        self.state, self.out = np.zeros((count, 3 * nodes + 1)), np.zeros((count, 5))

    def move(self, slip, *, load, a, a_peak=None, flatness=0.0, normal=(0.0, 0.0, 1.0), turn=0.0, damping=0.0):
        """Friction [N], shape (count, 3), on the body that slips by `slip` (count, 3) [m]; others broadcast."""
        count = len(self.state)
        now, shear = np.empty((count, 4)), np.empty((count, 8))
        for k, column in enumerate((load, a, a if a_peak is None else a_peak, flatness)):
            now[:, k] = column
        shear[:, :3], shear[:, 3:6], shear[:, 6], shear[:, 7] = normal, slip, turn, damping
        library().slip_steps(
            *self.options,
            ctypes.c_long(count),
            ctypes.c_double(self.stiffness),
            ctypes.c_double(self.mu),
            *map(_pointer, (self.state, now, shear, self.out)),
        )
        self.dissipated, self.energy = self.out[:, 3], self.out[:, 4]
        return self.out[:, :3].copy()


class Spring:
    """The one spring of LIGGGHTS's `tangential history`, T = 8 G* a s, cut off at mu F: to compare with, not tested."""

    dissipated = 0.0

    def __init__(self, count):
        self.stretch = np.zeros(count)

    def move(self, slip, *, load, a, **_):
        stiffness = 8 * G_STAR * np.maximum(a, 1e-30)
        limit = MU * load / stiffness
        self.stretch = np.clip(self.stretch + slip[:, 0], -limit, limit)
        return -(stiffness * self.stretch)[:, None]


def rebound(law, psi_1, speed, *, steps, nodes=3, phases=8, damping=0.0, loading_flatness=None):
    """psi_2, shape (len(psi_1), phases), of spheres on a plane by velocity Verlet; work lost [J]; largest T/(mu F). As
    an engine integrates: the slip of a step is that of the speed half a step before its end. damping: gamma_t over
    sqrt(k_t m), k_t = 8 G* a. nodes = 0: one spring. loading_flatness: that of a contact that grows to an overlap, in
    place of the law's; 0 below."""
    psi_1, phase = np.broadcast_arrays(np.array(psi_1, float)[:, None], (np.arange(phases) + 0.5) / phases)
    dt = float(restitution.impact(law, m_star=M, speed=speed).contact_time) / steps
    alpha, v, slip = -phase.ravel() * speed * dt, np.full(phase.size, speed), MU / KAPPA * speed * psi_1.ravel()
    contacts = (
        Contacts(phase.size, nodes=nodes, flattens=law.name == "cavity" or bool(loading_flatness), damped=damping > 0)
        if nodes
        else (Spring(phase.size))
    )
    top, F, T = np.zeros(phase.size), np.zeros(phase.size), np.zeros(phase.size)
    lost, most = np.zeros(phase.size), 0.0
    for _ in range(int(1.3 * steps) + 3):
        v, slip = v - dt / 2 * F / M, slip + dt / 2 * 3.5 / M * T
        alpha = alpha + dt * v
        top = np.maximum(top, alpha)
        touches, safe = alpha > 0, np.maximum(top, 1e-12)
        down, up = law.unloading(np.clip(alpha, 0, safe), safe), (law.force(safe), law.radius(safe))
        F, a = (np.where(touches, np.where(alpha >= top, x, y), 0.0) for x, y in zip(up, down, strict=True))
        move = np.zeros((phase.size, 3))
        move[:, 0] = dt * slip
        gamma = damping * np.sqrt(8 * G_STAR * a * M)
        a_peak, tau = law.radius(safe), law.flatness(safe)
        if loading_flatness:
            a_peak, tau = a, np.where(alpha >= top, loading_flatness(safe), 0.0)
        T = contacts.move(move, load=F, a=a, a_peak=a_peak, flatness=tau, damping=gamma / dt)[:, 0]
        lost += contacts.dissipated
        most = max(most, np.abs(T / (MU * np.where(F > 0, F, 1))).max())
        v, slip = v - dt / 2 * F / M, slip + dt / 2 * 3.5 / M * T
    return KAPPA / MU * slip.reshape(phase.shape) / speed, lost.reshape(phase.shape), most


def reference(law, psi_1, speed):
    """psi_2 by 400 springs and 2000 steps."""
    moved = MU / KAPPA * speed * np.asarray(psi_1)
    slip = partial_slip.rebound(law, m_star=M, m_tangential=2 / 7 * M, mu=MU, G_star=G_STAR, v_n=speed, slip=moved)
    return KAPPA / MU * slip / speed


def error(name, speed, *, nodes, steps, psi_1=None):
    """Largest deviation of psi_2 over psi_1 below sliding and 8 phases."""
    psi_1 = np.linspace(0, 5, 41)[1:] if psi_1 is None else psi_1
    found, _, _ = rebound(LAWS[name], psi_1, speed, steps=steps, nodes=nodes)
    return np.abs(found - reference(LAWS[name], psi_1, speed)[:, None]).max()


def unit_slip(alpha):
    """Slip [m] at which all of a Hertz contact slides (Cattaneo): 3 mu F/(16 G* a)."""
    law = LAWS["hertz"]
    return 3 * MU * float(law.force(alpha)) / (16 * G_STAR * float(law.radius(alpha)))


def cycle_losses(shear, legs, *, nodes, cycles, steps=100):
    """Work lost in each of `cycles`, shape (cycles,), over the energy 4 G* a shear^2 of a spring at the first overlap.
    A cycle is a list of legs (overlap at start, at end, slip) of a Hertz contact, all in m; nodes = 0: 400 springs."""
    law = LAWS["hertz"]
    alpha = np.concatenate([np.linspace(low, high, steps + 1)[1:] for low, high, _ in legs] * cycles)
    slips = np.repeat([slip / steps for *_, slip in legs] * cycles, steps)
    one = Contacts(1, nodes=nodes or 2)
    line = partial_slip.Springs(G_star=G_STAR, mu=MU, a_max=float(law.radius(alpha.max())), shape=(1,))
    force = [0.0]
    for F, a, slip in zip(law.force(alpha).tolist(), law.radius(alpha).tolist(), slips, strict=True):
        if nodes:
            force.append(-one.move([[slip, 0, 0]], load=F, a=a)[0, 0])
        else:
            force.append(float(line.move([slip], force=F, a=a, a_peak=a, flatness=0.0)[0]))
    work = 0.5 * (np.array(force[1:]) + force[:-1]) * slips
    return work.reshape(cycles, -1).sum(axis=1) / (4 * G_STAR * float(law.radius(legs[0][0])) * shear**2)


def shaken(share, *, nodes):
    """Loss of a cycle of shear between +-share of the sliding shear at constant load."""
    d, shear = 1e-6, share * unit_slip(1e-6)
    legs = [(d, d, shear), (d, d, -2 * shear), (d, d, shear)]
    return cycle_losses(shear, legs, nodes=nodes, cycles=2)[1]


def sheared_back_under_load(share, *, nodes, cycles):
    """Losses of cycles: shear at 1 um, load to 1.6 um, shear back, unload."""
    d, top, shear = 1e-6, 1.6e-6, share * unit_slip(1e-6)
    legs = [(d, d, shear), (d, top, 0.0), (top, top, -shear), (top, d, 0.0)]
    return cycle_losses(shear, legs, nodes=nodes, cycles=cycles)
