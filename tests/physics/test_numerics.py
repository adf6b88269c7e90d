# SPDX-License-Identifier: GPL-2.0-or-later
"""The rule of quadrature and the bisection that all of the theory shares, on problems solved by hand."""

import mpmath as mp
import numpy as np
import pytest

from epdem.theory.numerics import bisect, gauss, segment


def test_gauss_integrates_polynomials_of_twice_its_nodes_exactly():
    """x^k from 0 to 1 is 1/(k+1) for k below 2 n; x^(2n) is missed."""
    x, w = gauss(5)
    for k in range(10):
        assert float(w @ x**k) == pytest.approx(1 / (k + 1), rel=1e-14, abs=0)
    assert abs(float(w @ x**10) - 1 / 11) > 1e-7


def test_bisection_halves_an_array_of_brackets():
    """Roots of 2, 3 and 9 in (0, 9); after 10 halvings the bracket is 9/1024 wide."""
    squares = np.array([2.0, 3.0, 9.0])
    low, high = bisect(lambda x: x * x < squares, 0.0, np.array([9.0, 9.0, 9.0]))
    assert high == pytest.approx([2**0.5, 3**0.5, 3.0], rel=1e-15, abs=0)
    low, high = bisect(lambda x: x * x < squares, np.zeros(3), 9.0, steps=10)
    assert high - low == pytest.approx(np.full(3, 9 / 1024), rel=1e-13) and np.all(
        (low**2 < squares) & (high**2 >= squares)
    )


@pytest.mark.parametrize("opening", [1e-12, 1e-4, 0.3, 1.0, np.pi / 2])
def test_segment_keeps_its_digits(opening):
    with mp.workdps(50):
        exact = mp.mpf(opening) - mp.sin(opening) * mp.cos(opening)
    assert float(segment(opening)) == pytest.approx(float(exact), rel=1e-14, abs=0)
