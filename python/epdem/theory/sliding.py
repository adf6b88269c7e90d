# SPDX-License-Identifier: GPL-2.0-or-later
"""Stresses under a sliding Hertz contact, traction q = mu p along +x, and where it yields first (section 8.2.5).

Lengths in units of the contact radius a, stresses in units of p_0; z points into the body. The potentials of the
half-ellipse are those of point sources spread over the imaginary line z = -it, abs(t) < 1, with weight (pi/2)(1 - t^2):
one integral for every stress, taken along a half-circle in the complex t on which it is smooth at any depth. (Love's
potentials as in Johnson 1985, section 3.2; the field is that of Hamilton and Goodman 1966, Hamilton 1983, Bryant and
Keer 1982; yield as in Johnson and Jefferis 1963.)
"""

import functools
from collections.abc import Callable
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from .numerics import Array, Real, gauss, number, poisson_ratio
from .printed import first_yield, tresca, von_mises


# All singularities lie at t = i z +- r: from t = -i to 1 below them. The nodes crowd towards t = 1, where the edge of
# the contact comes near; the other half of the way, from -1 to -i, gives the complex conjugate.
@functools.cache
def _half_way() -> tuple[Any, Any]:
    """Complex t of the nodes, and their weights."""
    s, weight = gauss(96)
    t = np.exp(-0.5j * np.pi * s**4)
    return t, weight * 0.5j * np.pi * 4 * s**3 * t * (np.pi / 2) * (1 - t**2)


Place: TypeAlias = tuple[float, float]
Point: TypeAlias = tuple[float, tuple[float, float, float]]


CRITERIA = {"von_mises": von_mises, "tresca": tresca}


def equivalent(stress: ArrayLike, criterion: str) -> Array:
    """Equivalent stress of tensors (..., 3, 3) by "von_mises" or "tresca". ValueError for another name."""
    if criterion not in CRITERIA:
        raise ValueError(f"criterion = {criterion!r}, must be one of {', '.join(CRITERIA)}")
    p = np.linalg.eigvalsh(np.asarray(stress, float))
    return CRITERIA[criterion](p[..., 0], p[..., 1], p[..., 2])


def subsurface(x: ArrayLike, y: ArrayLike, z: ArrayLike, *, mu: Real, nu: Real) -> Array:
    """Stress tensor, shape (..., 3, 3), in units of p_0 at points (x, y, z >= 0) in units of a.

    mu >= 0 (0: Hertz's field alone), nu in (-1, 0.5]; ValueError outside. Accurate to 1e-11 of p_0 everywhere, on the
    surface inside and beside the contact too, but for points within 1e-4 of its edge (1e-7 at 1e-8 from it).
    """
    mu, nu = number("mu", mu, low_ok=True), poisson_ratio("nu", nu)
    x, y, z = np.broadcast_arrays(np.asarray(x, float), np.asarray(y, float), number("z", z, low_ok=True))
    t, weight = _half_way()
    X, Y, Z = x[..., None], y[..., None], z[..., None] + 1j * t
    R = np.sqrt(X * X + Y * Y + Z * Z)
    D = R + Z
    c = 1 / (R**3 * D) + 1 / (R**2 * D**2)  # -L_xy/(xy)
    d = 3 / (R**5 * D) + 3 / (R**4 * D**2) + 2 / (R**3 * D**3)
    e, f = 1 / (R * D**2), 1 / (R**3 * D**2) + 2 / (R**2 * D**3)

    def total(values: Any) -> Any:  # both halves of the way are twice the real part; 1/(2 pi) of Love's formulas
        return np.real(values @ weight) / np.pi

    zz, zzz = total(-Z / R**3), total(-1 / R**3 + 3 * Z * Z / R**5)
    zx, zy = total(-X / R**3), total(-Y / R**3)
    zxx, zyy = total(-1 / R**3 + 3 * X * X / R**5), total(-1 / R**3 + 3 * Y * Y / R**5)
    zxy, zzx, zzy = total(3 * X * Y / R**5), total(3 * X * Z / R**5), total(3 * Y * Z / R**5)
    xx, yy, xy = total(1 / (R * D) - X * X * c), total(1 / (R * D) - Y * Y * c), total(-X * Y * c)
    xxx, xyy, xxy = (total(X * (X * X * d - 3 * c)), total(X * (Y * Y * d - c)), total(Y * (X * X * d - c)))
    Fxxx, Fxyy, Fxxy = (total(X * (3 * e - X * X * f)), total(X * (e - Y * Y * f)), total(Y * (e - X * X * f)))

    k = 1 - 2 * nu
    s = np.empty((*x.shape, 3, 3))
    s[..., 0, 0] = -k * xx - z * zxx + 2 * nu * zz + mu * (2 * zx + 2 * nu * Fxxx - z * xxx + 2 * nu * zx)
    s[..., 1, 1] = -k * yy - z * zyy + 2 * nu * zz + mu * (2 * nu * Fxyy - z * xyy + 2 * nu * zx)
    s[..., 2, 2] = zz - z * zzz + mu * (-z * zzx)
    s[..., 0, 1] = s[..., 1, 0] = -k * xy - z * zxy + mu * (zy + 2 * nu * Fxxy - z * xxy)
    s[..., 0, 2] = s[..., 2, 0] = -z * zzx + mu * (zz - z * zxx)
    s[..., 1, 2] = s[..., 2, 1] = -z * zzy + mu * (-z * zxy)
    return s


def surface(x: ArrayLike, *, mu: Real, nu: Real) -> Array:
    """Stress tensor, shape (..., 3, 3), in units of p_0 on the surface inside the contact, at (x, 0, 0), abs(x) <= 1.

    From the traction: s_x = -(pi (4+nu)/8) mu x, s_y = -(3 pi nu/8) mu x, tau_xz = -mu p. ValueError outside.
    """
    mu, nu = number("mu", mu, low_ok=True), poisson_ratio("nu", nu)
    x = number("x", x, low=-1.0, high=1.0, low_ok=True) + np.zeros(np.shape(x))
    p = np.sqrt(1 - x * x)
    # [1 - (1-x^2)^1.5]/x^2 without cancellation: (1 - p)(1 + p + p^2)/((1 - p)(1 + p))
    bend = (1 - 2 * nu) / 3 * (1 + p + p * p) / (1 + p)
    s = np.zeros((*np.shape(x), 3, 3))
    s[..., 0, 0] = bend - p - np.pi * (4 + nu) / 8 * mu * x
    s[..., 1, 1] = -bend - 2 * nu * p - 3 * np.pi * nu / 8 * mu * x
    s[..., 2, 2] = -p
    s[..., 0, 2] = s[..., 2, 0] = -mu * p
    return s


def _climb(value: Callable[[Any, Any], Any], place: Place, step: float) -> tuple[float, Place]:
    """Highest point near `place` by pattern search in two coordinates."""
    best = value(*place)
    while step > 1e-9:
        around = [(place[0] + dx * step, place[1] + dz * step) for dx in (-1, 0, 1) for dz in (-1, 0, 1)]
        heights = value(np.array([p[0] for p in around]), np.array([p[1] for p in around]))
        k = int(np.argmax(heights))
        if heights[k] > best * (1 + 1e-15):
            best, place = heights[k], around[k]
        else:
            step /= 2
    return float(best), place


def _for_arrays(find: Callable[[float, float, str], Point]) -> Callable[..., tuple[Real, tuple[Real, ...]]]:
    """The same search for every pair of mu and nu, which broadcast; pressure and coordinates have their shape. A scene
    asks for the same few pairs many times: each is searched once."""
    once = functools.lru_cache(maxsize=1024)(find)

    @functools.wraps(find)
    def everywhere(mu: Real, nu: Real, criterion: str = "von_mises") -> tuple[Real, tuple[Real, ...]]:
        mu, nu = np.broadcast_arrays(number("mu", mu, low_ok=True), poisson_ratio("nu", nu))
        points = [once(float(m), float(n), criterion) for m, n in zip(mu.flat, nu.flat, strict=True)]
        columns = np.array([(pressure, *place) for pressure, place in points]).reshape(*mu.shape, 4)
        return columns[..., 0][()], tuple(columns[..., k][()] for k in (1, 2, 3))

    return everywhere


@_for_arrays
def first_yield_below(mu: float, nu: float, criterion: str = "von_mises") -> Point:
    """(p_0/Y, (x, y, z)/a) of first yield below the surface; mu >= 0 and nu broadcast, each result has their shape.

    At high friction the summit below vanishes and stress only rises towards the surface: (inf, ...) then.
    """
    _, depth = first_yield(nu)

    def height(x: Any, z: Any) -> Array:
        return equivalent(subsurface(x, 0.0, np.maximum(z, 0.0), mu=mu, nu=nu), criterion)

    # the summit moves along x with friction; from there, not from the axis, the climb does not stray to the surface
    best, (x, z) = _climb(height, (1.1 * mu, float(depth) - 0.5 * mu**2), 0.02)
    if z <= 1e-6:  # the climb went to the surface
        return np.inf, (float(x), 0.0, 0.0)
    return 1 / best, (float(x), 0.0, float(z))


@_for_arrays
def first_yield_surface(mu: float, nu: float, criterion: str = "von_mises") -> Point:
    """(p_0/Y, (x, y, z)/a) of first yield on the surface, inside the contact; mu >= 0 and nu broadcast."""
    low, high = -1.0, 1.0
    for _ in range(12):  # a finer grid around the highest point each time
        x = np.linspace(low, high, 201)
        height = equivalent(surface(x, mu=mu, nu=nu), criterion)
        k = int(np.argmax(height))
        low, high = max(-1.0, x[max(k - 2, 0)]), min(1.0, x[min(k + 2, 200)])
    return float(1 / height[k]) if height[k] > 0 else np.inf, (float(x[k]), 0.0, 0.0)


@_for_arrays
def first_sliding_yield(mu: float, nu: float, criterion: str = "von_mises") -> Point:
    """(p_0/Y, (x, y, z)/a) of first yield of a sliding contact: the smaller pressure of surface and below counts.

    mu >= 0, nu in (-1, 0.5], both broadcast; criterion "von_mises" or "tresca"; ValueError otherwise.
    """
    candidates: list[Any] = [first_yield_below(mu, nu, criterion), first_yield_surface(mu, nu, criterion)]
    lower: Point = min(candidates, key=lambda point: point[0])
    return lower
