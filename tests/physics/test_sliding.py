# SPDX-License-Identifier: GPL-2.0-or-later
"""Stresses and first yield under a sliding Hertz contact: tables of point-load integration, and mathematics that the
field must obey."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from epdem.theory import printed, sliding

MU = [0, 0.1, 0.2, 0.25, 0.3, 0.4, 0.5]
BELOW = {
    "von_mises": [1.61280, 1.60142, 1.56822, 1.54418, 1.51571, 1.44731, 1.36600],
    "tresca": [1.61280, 1.60050, 1.56460, 1.53858, 1.50774, 1.43339],
}
ABOVE = {
    "von_mises": [4.33013, 2.76781, 1.97902, 1.72627, 1.52906, 1.24257, 1.04528],
    "tresca": [3.75000, 2.49885, 1.87370, 1.66539, 1.46586, 1.15061, 0.94416],
}


@pytest.mark.parametrize("criterion", ["von_mises", "tresca"])
def test_pressure_at_first_yield_of_a_sliding_contact(criterion):
    """5 digits from point-load integration, nu = 0.3."""
    below, _ = sliding.first_yield_below(MU[: len(BELOW[criterion])], 0.3, criterion)
    above, place = sliding.first_yield_surface(np.reshape(MU, (-1, 1)), [0.3], criterion)
    assert above.shape == place[0].shape == (7, 1)
    above = above[:, 0]
    assert below == pytest.approx(BELOW[criterion], abs=6e-6)
    assert above == pytest.approx(ABOVE[criterion], abs=6e-6)


@pytest.mark.parametrize(
    ("nu", "criterion", "mu"),
    [(0.3, "von_mises", 0.3047), (0.3, "tresca", 0.2879), (0.25, "von_mises", 0.2776), (0.25, "tresca", 0.2454)],
)
def test_first_yield_comes_to_the_surface_as_friction_grows(nu, criterion, mu):
    """The printed friction, to its 4 digits."""
    assert sliding.first_sliding_yield(mu - 1e-4, nu, criterion)[1][2] > 0.3
    place = sliding.first_sliding_yield(mu + 1e-4, nu, criterion)[1]
    assert place[2] == 0
    # the trailing edge, or for Tresca and nu = 0.3 the printed x = -0.59 a
    assert place[0] == (pytest.approx(-0.59, abs=0.03) if (nu, criterion) == (0.3, "tresca") else -1.0)


def test_without_a_local_summit_below_the_surface_nothing_is_made_up():
    assert sliding.first_yield_below(0.5, 0.3, "tresca")[0] == np.inf


@settings(max_examples=30)
@given(st.floats(-1.5, 1.5), st.floats(-1.5, 1.5), st.floats(0.3, 2), st.floats(0, 1), st.floats(0, 0.5))
def test_the_sliding_field_is_in_equilibrium(x, y, z, mu, nu):
    """div sigma = 0 by central differences; their error is h^2 = 1e-8 times third derivatives of order 100."""
    h = 1e-4
    force = np.zeros(3)
    for axis in range(3):
        step = h * np.eye(3)[axis]
        up = sliding.subsurface(x + step[0], y + step[1], z + step[2], mu=mu, nu=nu)
        down = sliding.subsurface(x - step[0], y - step[1], z - step[2], mu=mu, nu=nu)
        force += (up - down)[axis] / (2 * h)
    assert np.abs(force).max() < 2e-6


def test_the_field_carries_the_traction_it_came_from():
    """On the surface: -p and -mu p inside, nothing outside; 1e-11 for points up to 1e-3 from the edge."""
    r = np.array([0.0, 0.3, 0.9, 0.999, 1.001, 1.2, 3.0])
    phi = np.linspace(0, 2 * np.pi, 7)[:, None]
    s = sliding.subsurface(r * np.cos(phi), r * np.sin(phi), 0.0, mu=0.4, nu=0.3)
    p = np.sqrt(np.maximum(1 - r * r, 0)) + 0 * phi
    assert np.abs(s[..., 2, :] - np.stack([-0.4 * p, 0 * p, -p], axis=-1)).max() < 1e-11


def cerruti(x, y, z, nu):
    """Stresses of a unit force along +x at the origin of the surface (Johnson 1985, eq. 3.76), with z into the body."""
    r, k = np.sqrt(x * x + y * y + z * z), 1 - 2 * nu
    b, c = r + z, x / r**3
    s = np.empty((*x.shape, 3, 3))
    s[..., 0, 0] = -3 * x**3 / r**5 + k * (c - 3 * x / (r * b**2) + x**3 / (r**3 * b**2) + 2 * x**3 / (r**2 * b**3))
    s[..., 1, 1] = -3 * x * y * y / r**5 + k * (
        c - x / (r * b**2) + x * y * y / (r**3 * b**2) + 2 * x * y * y / (r**2 * b**3)
    )
    s[..., 0, 1] = -3 * x * x * y / r**5 + k * (
        -y / (r * b**2) + x * x * y / (r**3 * b**2) + 2 * x * x * y / (r**2 * b**3)
    )
    s[..., 0, 2], s[..., 1, 2], s[..., 2, 2] = -3 * x * x * z / r**5, -3 * x * y * z / r**5, -3 * x * z * z / r**5
    for i, j in ((1, 0), (2, 0), (2, 1)):
        s[..., i, j] = s[..., j, i]
    return s / (2 * np.pi)


@pytest.mark.parametrize("nu", [0.0, 0.3, 0.5])
def test_tangential_field_is_cerrutis_point_solution_spread_over_the_contact(nu):
    """Product rule on the disc with r = sin psi; its 120 x 240 nodes leave 1e-13 at these depths."""
    psi, w = np.polynomial.legendre.leggauss(120)
    psi, w = np.pi / 4 * (psi + 1), np.pi / 4 * w
    phi = (np.arange(240) + 0.5) / 240 * 2 * np.pi
    r, load = np.sin(psi)[:, None], (np.cos(psi) ** 2 * np.sin(psi) * w)[:, None] * np.full(240, 2 * np.pi / 240)
    mu = 0.4
    for x, y, z in ((0.2, 0.1, 0.5), (-0.9, 0.3, 0.4), (1.5, -1.0, 0.7)):
        spread = np.tensordot(load, cerruti(x - r * np.cos(phi), y - r * np.sin(phi), z, nu), 2)
        friction = sliding.subsurface(x, y, z, mu=mu, nu=nu) - sliding.subsurface(x, y, z, mu=0.0, nu=nu)
        assert friction == pytest.approx(mu * spread, rel=1e-11, abs=1e-12)


def test_normal_field_is_hubers():
    """Huber 1904 in closed form, with u the positive root of r^2/(1+u) + z^2/u = 1."""
    r, z, nu = np.array([0.3, 0.9, 1.0, 2.0, 0.05]), np.array([0.5, 0.1, 0.2, 3.0, 0.4]), 0.3
    b = r * r + z * z - 1
    u = 0.5 * (b + np.sqrt(b * b + 4 * z * z))
    q, bend = z / np.sqrt(u), np.arctan(1 / np.sqrt(u))
    edge = (1 - 2 * nu) / (3 * r * r) * (1 - q**3)
    s = sliding.subsurface(r, 0.0, z, mu=0.0, nu=nu)
    radial = edge + q**3 * u / (u * u + z * z) + q * (u * (1 - nu) / (1 + u) + (1 + nu) * np.sqrt(u) * bend - 2)
    hoop = -edge - q * (2 * nu + u * (1 - nu) / (1 + u) - (1 + nu) * np.sqrt(u) * bend)
    for found, exact in (
        (s[:, 0, 0], radial),
        (s[:, 1, 1], hoop),
        (s[:, 2, 2], -(q**3) * u / (u * u + z * z)),
        (s[:, 0, 2], -r * z * z * np.sqrt(u) / ((u * u + z * z) * (1 + u))),
    ):
        assert found == pytest.approx(exact, rel=1e-11, abs=1e-13)


@pytest.mark.parametrize("mu", [0.0, 0.5])
def test_field_of_the_surface_is_its_closed_form(mu):
    x = np.array([-0.99, -0.7, -0.2, 0.0, 0.5])
    assert sliding.subsurface(x, 0.0, 0.0, mu=mu, nu=0.3) == pytest.approx(sliding.surface(x, mu=mu, nu=0.3), abs=1e-11)


def test_on_the_axis_the_field_is_hertz():
    """s_z = -p_0/(1+z^2), and the difference that both criteria see there."""
    z = np.array([0.1, 0.48, 1.0, 3.0])
    s = sliding.subsurface(0.0, 0.0, z, mu=0.0, nu=0.3)
    assert s[:, 2, 2] == pytest.approx(-1 / (1 + z * z), rel=1e-12, abs=0)
    assert s[:, 0, 0] - s[:, 2, 2] == pytest.approx(printed.axis_difference(z, 0.3), rel=1e-12, abs=0)
