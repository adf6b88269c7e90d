# SPDX-License-Identifier: GPL-2.0-or-later
"""Scenes of the adhesive models in LIGGGHTS with the theory of their contacts: millimetre spheres that attract hard."""

import numpy as np
from plugin_decks import NU, P_Y, RHO, Bodies, E, Y, deck_of, gamma, good, materials

from epdem.theory import adhesion
from epdem.theory.cavity_adhesive import CavityAdhesive
from epdem.theory.jkr import JKR
from epdem.theory.thornton_ning import ThorntonNing

R = 1e-3
BOX = ((-0.05, 0.05), (-0.05, 0.05), (-0.02, 0.05))


def theory(law, i=1, j=2, radius=R, other=np.inf):
    """The contact of two types and radii; a wall is of type 2."""
    E_star = 1 / ((1 - NU[i - 1] ** 2) / E[i - 1] + (1 - NU[j - 1] ** 2) / E[j - 1])
    numbers = {"E_star": E_star, "R_star": 1 / (1 / radius + 1 / other), "Gamma": gamma(law)[i - 1, j - 1]}
    if law == "cavity_adhesive":
        return CavityAdhesive(**numbers, Y=min(Y[i - 1], Y[j - 1]))
    return JKR(**numbers) if law == "jkr" else ThorntonNing(**numbers, p_y=min(P_Y[i - 1], P_Y[j - 1]))


def mass(i=1, radius=R):
    return RHO[i - 1] * 4 / 3 * np.pi * radius**3


def spheres(x, v, types=1, radius=R):
    """Bodies at the places x moving at v, both (n, 3)."""
    n = len(x)
    return Bodies(np.full(n, types), np.full(n, radius), np.asarray(x, float), np.asarray(v, float))


def deck(law, *, wall=None, dt, body, every=1, tangential="off", before="", settings="", friction=0.0, top=None):
    """Text of a scene; `body` moves and runs it."""
    dump = f"dump d all custom {every} out.bin id x y z vx vy vz fx fy fz\ndump_modify d sort id\n"
    properties = materials(f"ep/{law}", friction=friction) + before
    words = {"wall": wall, "tangential": tangential, "settings": settings}
    return deck_of(f"ep/{law}", dump + body, dt=dt, skin=2e-4, properties=properties, move="", top=top, **words)


def walls(folder, law, speeds, *, wall="primitive", files=None, steps_in_contact=400, types=1, places=None, before=""):
    """Spheres that meet the wall at z = 0 (or the mesh of `files`) at these speeds: (steps, n) of z and v_z, and dt."""
    m, n = mass(types), len(speeds)
    c = theory(law, types)
    slow, fast = np.maximum([min(speeds), max(speeds)], 1.001 * float(adhesion.sticking_speed(c, m_star=m)))
    dt = float(adhesion.contact_time(c, m_star=m, speed=fast)) / steps_in_contact
    steps = int(1.3 * float(adhesion.contact_time(c, m_star=m, speed=slow)) / dt) + 20
    x = np.array([[3e-3 * (k - n // 2), 0.0, 0.0] for k in range(n)]) if places is None else np.array(places, float)
    x[:, 2] += R + (0.5 + np.arange(n) % 2 / 3) * dt * np.asarray(speeds)
    v = np.array([[0.0, 0.0, -s] for s in speeds])
    body = f"fix move all nve/sphere\nrun {steps}\n"
    text = deck(law, wall=wall, dt=dt, body=body, before=before)
    done = good(folder, text, files={"box.data": spheres(x, v, types).data(BOX), **(files or {})})
    frames = done.frames()[1]
    return frames[:, :, 3], frames[:, :, 6], dt


def slope(x):
    """Corners of the two triangles between a ridge along y, at x = z = 0, and a line at x that lies lower [m]."""
    near, far, start, end = (x, -0.015, -0.01), (x, 0.02, -0.01), (0.0, -0.015, 0.0), (0.0, 0.02, 0.0)
    return [(start, near, end), (near, far, end)]


EDGE = [*slope(0.02), *slope(-0.02)]
BASE = [(x, y, -0.01) for x, y in ((0.02, 0.02), (-0.02, 0.02), (-0.02, -0.02), (0.02, -0.02))]
TIP = [((0.0, 0.0, 0.0), BASE[k - 1], BASE[k]) for k in range(4)]
