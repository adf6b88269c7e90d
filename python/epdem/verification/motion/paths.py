# SPDX-License-Identifier: GPL-2.0-or-later
"""Motions of two spheres that show each part of a contact law. SI."""

from collections.abc import Callable, Sequence

import numpy as np

from ...laws.library import Array
from .prescribed import Loads, Motion, Touch

TIME_STEP = 1e-6
DEPTH = 0.01  # of the load under which the others shear and turn, in R*
# from j to i, along the shear, across both: no axis of any engine
NORMAL, ALONG = np.array([1.0, 2.0, 2.0]) / 3.0, np.array([2.0, 1.0, -2.0]) / 3.0
ACROSS = np.cross(NORMAL, ALONG)
AXIS = np.array([2.0, -1.0, 2.0]) / 3.0  # of the rigid rotation
TURN = 1000  # steps of a revolution


def _path(*corners: tuple[int, Sequence[float]]) -> Array:
    """Straight lines through (steps from the corner before, place), shape (n, k); the first corner is the start."""
    steps, places = np.cumsum([n for n, _ in corners]), np.array([p for _, p in corners])
    at = np.arange(steps[-1] + 1)
    return np.stack([np.interp(at, steps, column) for column in places.T], axis=1)


def _rates(path: Array) -> Array:
    """Change of a path in each step, over the time step."""
    return np.diff(path, axis=0, prepend=path[:1]) / TIME_STEP


def _motion(name: str, touch: Touch, between: Array, spin: Array | None = None) -> Motion:
    """Of both spheres, half each, from overlap and shears along and across, (n, 3) [m]; spin (n, 2, 3) [rad/s]."""
    reach = sum(touch.radii)
    apart = (reach - between[:, :1]) * NORMAL + between[:, 1:2] * ALONG + between[:, 2:] * ACROSS
    place = np.stack([0.5 * apart, -0.5 * apart], axis=1)
    spin = np.zeros_like(place) if spin is None else spin
    return Motion(name, TIME_STEP, place, _rates(place), spin)


def _depth(touch: Touch) -> float:
    return DEPTH * touch.experiment.R_star


def _slip(touch: Touch) -> float:
    """Shear [m] at which an elastic contact under the load slides: mu F/(8 G* a)."""
    x = touch.experiment
    return max(touch.friction, 0.1) * x.E_star * _depth(touch) / (6.0 * x.G_star)


def normal_loading(touch: Touch) -> Motion:
    """Load, unload in part, load further, part: with and without a dent."""
    d = _depth(touch)
    corners = [(0, -0.05), (150, 1.0), (60, 0.6), (90, 1.5), (150, -0.05)]
    return _motion("normal_loading", touch, _path(*((n, (share * d, 0, 0)) for n, share in corners)))


def _shear(touch: Touch, name: str, share: float) -> Motion:
    d, s = _depth(touch), share * _slip(touch)
    return _motion(
        name,
        touch,
        _path(
            (0, (-0.05 * d, 0, 0)),
            (100, (d, 0, 0)),
            (60, (d, s, 0)),
            (120, (d, -s, 0)),
            (60, (d, 0, 0)),
            (60, (d, 0, s)),
            (40, (0.8 * d, 0, s)),
        ),
    )


def shear_elastic(touch: Touch) -> Motion:
    """Under load: shear forth, back and across, each by a fifth of what slides."""
    return _shear(touch, "shear_elastic", 0.2)


def shear_slip(touch: Touch) -> Motion:
    """The same by three times of what slides."""
    return _shear(touch, "shear_slip", 3.0)


def _turned(touch: Touch, name: str, spins: Sequence[tuple[int, Array, Array]]) -> Motion:
    """Loaded and sheared by a third of what slides, then (steps, spin of i, spin of j)."""
    d, s = _depth(touch), 0.3 * _slip(touch)
    path = _path((0, (-0.05 * d, 0, 0)), (100, (d, 0, 0)), (40, (d, s, 0)), (sum(n for n, *_ in spins), (d, s, 0)))
    rest = np.zeros((len(path) - sum(n for n, *_ in spins), 2, 3))
    return _motion(name, touch, path, np.concatenate([rest, *(np.tile([i, j], (n, 1, 1)) for n, i, j in spins)]))


def rotation_in_plane(touch: Touch) -> Motion:
    """Spins about an axis in the plane of the contact: one body, both alike (sliding), both against each other
    (rolling)."""
    w = _slip(touch) / (50 * TIME_STEP * min(touch.radii)) * ACROSS
    (r_i, r_j), still = touch.radii, np.zeros(3)
    return _turned(
        touch,
        "rotation_in_plane",
        [(25, w, still), (50, -w, still), (50, -w, -w), (50, w * r_j / max(touch.radii), -w * r_i / max(touch.radii))],
    )


def rotation_out_of_plane(touch: Touch) -> Motion:
    """Spins about the normal: both alike by half a radian, then one body, then against each other."""
    w, still = 0.5 / (100 * TIME_STEP) * NORMAL, np.zeros(3)
    return _turned(touch, "rotation_out_of_plane", [(100, w, w), (100, w, still), (100, w, -w)])


def _angles() -> Array:
    return np.asarray(2 * np.pi * np.arange(TURN + 1)[:, None, None] / TURN)


def _about_axis(vectors: Array, angle: Array) -> Array:
    """Vectors (2, 3) turned about AXIS by each angle, (n, 1, 1)."""
    along = (vectors @ AXIS)[:, None] * AXIS
    return np.asarray(along + np.cos(angle) * (vectors - along) + np.sin(angle) * np.cross(AXIS, vectors))


def objectivity(loads: Loads) -> float:
    """How far the forces of `rigid_rotation` lie from those that turn with the pair, over the largest force."""
    turned = _about_axis(loads.force[-TURN - 1], _angles())
    return float(np.linalg.norm(loads.force[-TURN - 1 :] - turned, axis=2).max() / loads.peak)


def rigid_rotation(touch: Touch) -> Motion:
    """The loaded and sheared pair turns through one revolution as one body: its forces turn with it."""
    loaded = _turned(touch, "rigid_rotation", [])
    w, angle = 2 * np.pi / (TURN * TIME_STEP), _angles()[1:]
    start = loaded.place[-1]
    place = _about_axis(start, angle)
    return Motion(
        loaded.name,
        TIME_STEP,
        np.concatenate([loaded.place, place]),
        np.concatenate([loaded.velocity, np.cross(w * AXIS, place)]),
        np.concatenate([loaded.spin, np.broadcast_to(w * AXIS, place.shape)]),
    )


MOTIONS: tuple[Callable[[Touch], Motion], ...] = (
    normal_loading,
    shear_elastic,
    shear_slip,
    rotation_in_plane,
    rotation_out_of_plane,
    rigid_rotation,
)
