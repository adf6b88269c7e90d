# SPDX-License-Identifier: GPL-2.0-or-later
"""Any numbers in the C interface: a status, or finite results; never a crash, and nothing outside the arrays."""

import ctypes

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from epdem.base.declarations import declarations
from epdem.laws.library import IMPACT_INPUT, IMPACT_OUTPUT, library

doubles = st.one_of(
    st.floats(allow_nan=True, allow_infinity=True),
    st.floats(1e-12, 1e12),
    st.floats(-20, 20).map(lambda p: 10.0**p),
    st.sampled_from([0.0, -1.0, 5e-324, 1.7e308, float("nan"), float("inf")]),
)
GUARD = 8
SIZES = {"epdem_step_result": 3 * 8, "epdem_impact_input": IMPACT_INPUT.itemsize}
SIZES["epdem_impact_output"] = IMPACT_OUTPUT.itemsize


def pointer(array: np.ndarray):
    return array.ctypes.data_as(ctypes.POINTER(ctypes.c_double))


@pytest.mark.parametrize("struct", SIZES)
def test_the_structs_of_c_have_the_size_that_python_gives_them(struct):
    """Else the ABI number was forgotten."""
    size_of = library().epdem_size_of
    size_of.restype, size_of.argtypes = ctypes.c_size_t, [ctypes.c_char_p]
    assert size_of(struct.encode()) == SIZES[struct]


@given(st.sampled_from(list(range(-2, 8))), doubles, st.lists(doubles, min_size=8, max_size=8), doubles, st.data())
def test_steps_and_backbones_have_a_status_or_are_finite(law, E_star, parameters, R_star, data):
    n = data.draw(st.integers(0, 4))
    largest, delta = (np.array(data.draw(st.lists(doubles, min_size=n, max_size=n)), float) for _ in range(2))
    numbers = np.array(parameters, float)
    radii = np.full(n, R_star)
    out = np.full((n + 1, 3), 7.0)  # force, radius, delta_max
    status = library().epdem_step(law, E_star, pointer(numbers), n, *map(pointer, (radii, largest, delta, out)))
    assert status in (0, 1, 2, 3) and (out[n] == 7.0).all()
    assert status != (1 if law in range(len(declarations())) else 0)
    usual = 1e-9 <= E_star <= 1e30 and 1e-12 <= R_star <= 1e6 and ((numbers >= 1e-9) & (numbers <= 1e30)).all()
    usual = usual and ((largest >= 0) & (largest <= R_star)).all() and (np.abs(delta) <= R_star).all()
    if status == 0 and usual:
        assert (out[:n] >= 0.0).all()
    columns = [np.full(n + GUARD, 7.0) for _ in range(4)]
    code = library().epdem_backbone(law, E_star, pointer(numbers), n, *map(pointer, (radii, delta, *columns)))
    assert code in (0, 1, 2, 3) and all((c[n:] == 7.0).all() for c in columns)


@given(st.sampled_from(list(range(-2, 8))), doubles, st.lists(doubles, min_size=8, max_size=8), st.data())
def test_impacts_have_a_status_or_end(law, E_star, parameters, data):
    n, steps = data.draw(st.integers(0, 3)), data.draw(st.integers(-1, 300))
    into = np.zeros(n, IMPACT_INPUT)
    for name in IMPACT_INPUT.names:
        into[name] = steps if name == "steps" else data.draw(st.lists(doubles, min_size=n, max_size=n))
    got, stride = np.zeros(n + 1, IMPACT_OUTPUT), max(steps + 1, 0)
    samples = [np.full(n * stride + GUARD, 7.0) for _ in range(3)]
    numbers = np.array(parameters, float)
    status = library().epdem_impacts(
        law, E_star, pointer(numbers), n, into.ctypes.data, got.ctypes.data, stride, *map(pointer, samples)
    )
    assert status in (0, 1, 2, 3) and all((s[n * stride :] == 7.0).all() for s in samples)
    assert got[n].tobytes() == bytes(IMPACT_OUTPUT.itemsize)
    if status == 0:
        assert all(0 <= r["steps"] <= max(steps, 0) for r in got[:n])
