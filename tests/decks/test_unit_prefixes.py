# SPDX-License-Identifier: GPL-2.0-or-later
"""Prefixes of units against pint."""

import pytest

from epdem.case import units


@pytest.mark.parametrize("si", ["m", "s", "Pa", "J/m^3", "m/s", "m/s^2", "rad", "rad/s", "Hz", "N", "J", "kg/m^3"])
def test_a_prefix_read_without_pint_is_that_of_pint(si):
    for prefix in ("", *units.PREFIXES):
        try:
            expected = units._by_pint(prefix + si, si)
        except ValueError:
            expected = None
        try:
            value = units._factor(prefix + si, si)
        except ValueError:
            value = None
        assert value == (expected and pytest.approx(expected, rel=1e-15)), prefix  # Pint 0.24 rounds 1 nPa
