# SPDX-License-Identifier: GPL-2.0-or-later
"""Prescribed motions of two spheres in the C library."""

from pathlib import Path

import numpy as np

from ...engines.embedded import Embedded
from .. import native
from .prescribed import Loads, Motion, Touch, unit_normals


class EmbeddedMotions:
    """One contact, without any other program."""

    name = Embedded.name
    laws: tuple[str, ...] | None = None
    features = Embedded.features

    def missing(self) -> str | None:
        return Embedded().missing()

    def loads(self, touch: Touch, motion: Motion, folder: Path) -> Loads:
        x, dt = touch.experiment, motion.time_step
        normal, apart = unit_normals(motion), motion.place[:, 0] - motion.place[:, 1]
        distance = np.linalg.norm(apart, axis=1)[:, None]
        overlap = sum(touch.radii) - distance
        arm = np.array(touch.radii) - 0.5 * overlap  # to the middle of the overlap, of each body
        v = motion.velocity[:, 0] - motion.velocity[:, 1]
        opening = (v * normal).sum(axis=1)[:, None]
        slip = dt * (v - opening * normal + np.cross(normal, (arm[:, :, None] * motion.spin).sum(axis=1)))
        turn = 0.5 * dt * (motion.spin.sum(axis=1) * normal).sum(axis=1)[:, None]
        out = native.motion(
            x.native_law(),
            np.hstack([overlap, -dt * opening, normal, slip, turn]),
            R_star=x.R_star,
            G_star=x.G_star,
            mu=touch.friction,
            nodes=touch.nodes,
        )
        friction = out[:, 1:]
        force = out[:, :1] * normal + friction
        torque = -arm[:, :, None] * np.cross(normal, friction)[:, None, :]
        return Loads(np.stack([force, -force], axis=1), torque, out[:, 0])
