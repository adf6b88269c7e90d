# SPDX-License-Identifier: GPL-2.0-or-later
"""What any law must do in the embedded engine, where an impact chooses its path of overlaps; with a dashpot or not."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from laws import YIELDING, contacts

from epdem.base import declarations
from epdem.errors import EngineError
from epdem.laws import library as claw
from epdem.verification import native

decades = st.floats(-1.0, 4.0)  # of v/v_y
dashpots = st.sampled_from([1.0, 0.999, 0.9, 0.5, 0.14])


def impacts(c, decade, steps, restitution=1.0, phases=8):
    """Impacts of a 1 kg body at 10^decade times the yield speed, `steps` in the elastic contact time of that speed.
    Contact with dashpot or plastic flow lasts up to 3 times longer; (out, overlap, force, velocity, speed)."""
    work = 8 / 15 * c.E_star * math.sqrt(c.R_star) * c.delta_y**2.5  # of Hertz
    speed = 10**decade * math.sqrt(2 * work)
    time = 2.87 * (1 / (c.R_star * c.E_star**2 * speed)) ** 0.2
    gap = (np.arange(phases) + 0.5) / phases * speed * time / steps
    numbers = {"R_star": c.R_star, "m_star": 1.0, "speed": speed, "time_step": time / steps, "gap": gap}
    number = claw.viscous_number(restitution)
    return *c.law.impact_paths(**numbers, steps=20 * steps, viscous=number), speed


@given(contacts(), decades, st.integers(8, 300))
def test_every_sample_is_the_laws_own_force_to_the_last_bit(c, decade, steps):
    _, overlap, force, _, _ = impacts(c, decade, steps)
    for path, forces in zip(overlap, force, strict=True):
        path, forces = path[np.isfinite(path)], forces[np.isfinite(forces)]
        before = np.maximum.accumulate(np.concatenate([[0.0], np.maximum(path, 0.0)]))[:-1]
        assert np.array_equal(forces, c.step(before, path)[0])


@given(contacts(), decades, st.integers(8, 300), dashpots)
def test_force_never_attracts_and_the_contact_ends(c, decade, steps, restitution):
    out, overlap, force, velocity, _ = impacts(c, decade, steps, restitution)
    assert np.nanmin(force) >= 0
    assert np.all(out["last"] >= 0)
    assert np.all(out["steps"] < 20 * steps)
    assert np.all(np.isfinite(overlap) == np.isfinite(force))
    assert np.all(out["rebound_speed"] > 0)
    assert np.all(np.nanmin(velocity, axis=1) == -out["rebound_speed"])  # nothing pulls the body back


@given(contacts(), decades, dashpots)
@settings(max_examples=60)
def test_an_impact_never_returns_more_than_it_brought(c, decade, restitution):
    """200 steps in contact; velocity Verlet's own error of e_n there is below 1e-3 of an elastic impact."""
    out, *_, speed = impacts(c, decade, 200, restitution)
    assert np.all(out["rebound_speed"] <= speed * (1 + 1e-3 if restitution == 1 else restitution**0.5 * (1 + 5e-3)))


@given(contacts(), st.floats(-1.0, -0.05), st.sampled_from([0.999, 0.9, 0.5]))
@settings(max_examples=60)
def test_below_yield_the_restitution_is_that_of_the_dashpot(c, decade, restitution):
    """Within 1e-3 at 1600 steps: the dashpot sees the speed half a step late, an error of first order in the step."""
    out, *_, speed = impacts(c, decade, 1600, restitution, phases=2)
    assert out["rebound_speed"] / speed == pytest.approx(restitution, abs=1e-3)


@given(contacts(YIELDING), st.floats(0.2, 3.0))
@settings(max_examples=40)
def test_a_dent_that_is_hit_again_as_hard_answers_elastically(c, decade):
    """The second impact at the rebound speed stays below alpha_max: e_n = 1 up to the integration error, 500 steps."""
    work = 8 / 15 * c.E_star * math.sqrt(c.R_star) * c.delta_y**2.5
    speed = 10**decade * math.sqrt(2 * work)
    time = 2.87 * (1 / (c.R_star * c.E_star**2 * speed)) ** 0.2
    _, speeds = native.bounces(c.law, 4, R_star=c.R_star, m_star=1.0, speed=speed, time_step=time / 2000, steps=20_000)
    assert speeds[1:] == pytest.approx(speeds[0], rel=2e-3)


def test_a_library_of_another_version_is_told_before_what_it_lacks(monkeypatch):
    older = SimpleNamespace(epdem_abi=lambda: declarations.ABI - 1)
    monkeypatch.setattr(declarations.ctypes, "CDLL", lambda path: older)
    sentence = f"ABI {declarations.ABI - 1}, this package needs {declarations.ABI}; run 'make setup'"
    with pytest.raises(EngineError, match=sentence):
        declarations.load_library.__wrapped__()
