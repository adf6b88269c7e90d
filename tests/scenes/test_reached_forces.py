# SPDX-License-Identifier: GPL-2.0-or-later
"""The force on a wall that ends a phase is judged as a stage of a press is: by half a percent and by two percent."""

from dataclasses import replace

import pandas as pd
import pytest
from parts_cases import parts
from test_ends_of_phases import pressed

from epdem.case.scene import parse
from epdem.scenes.judge import checks
from epdem.scenes.judge.warnings import measured_warnings
from epdem.scenes.plan.phases import NOT_REACHED, REACHED
from epdem.scenes.plan.plan import plan
from epdem.scenes.plan.quantities import STRAINS


@pytest.mark.parametrize(
    ("value", "told", "passed"),
    [(0.3, False, True), (0.3014, False, True), (0.3017, True, True), (0.2945, True, True), (0.3063, True, False)],
)
def test_a_force_that_ends_a_phase_is_told_above_half_a_percent_and_fails_above_two(value, told, passed):
    p = plan(parse(pressed()))
    ended = replace(p.phases[1], reached=REACHED, value=value)
    p = replace(p, phases=(p.phases[0], ended, p.phases[2]))
    rows = pd.DataFrame({"particles": [p.count], STRAINS[0]: [0.0], "step": [0]})
    found = checks.checks(p, {"rows": rows}).set_index("key").loc["reached_force"]
    assert (found["value"], found["expected"], bool(found["passed"])) == (value, 0.3, passed)
    said = [w for w in measured_warnings(p, {"rows": rows}) if "asked for" in w]
    assert len(said) == told and all(f"{value} N, {value / 0.3 - 1:+.2%} beside the 0.3 N" in w for w in said)


def test_what_did_not_end_by_a_force_has_no_such_check():
    """A phase that ended by its duration has a warning; a stage of a press has its own check."""
    p = plan(parse(pressed()))
    p = replace(p, phases=(p.phases[0], replace(p.phases[1], reached=NOT_REACHED, value=0.1), p.phases[2]))
    assert checks.reached_forces(p) == {} == checks.reached_forces(plan(parse(parts())))
