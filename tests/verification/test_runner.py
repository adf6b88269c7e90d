# SPDX-License-Identifier: GPL-2.0-or-later
"""The runner of studies: rows against tolerances, by hand."""

import math

import pandas as pd
import pytest

from epdem.errors import EngineError
from epdem.verification.runner import STUDIES, Study, run


def test_a_row_passes_up_to_its_tolerance_and_says_what_is_above():
    study = Study("t", tolerances={"a": 0.5, "b": "limit"})
    assert study.judged({"a": 0.5, "b": 2.0, "limit": 2.0})["passed"] is True
    wrong = study.judged({"a": 0.75, "b": 3.0, "limit": 2.0})
    assert (wrong["passed"], wrong["reason"]) == (False, "a = 0.75, at most 0.5; b = 3, at most 2")


@pytest.mark.parametrize("value", [math.nan, math.inf])
def test_what_is_no_number_does_not_pass(value):
    assert not Study("t", tolerances={"a": 0.5}).judged({"a": value})["passed"]


def test_one_row_that_fails_fails_the_study_and_the_table_is_in_the_folder(tmp_path):
    rows = [{"case": "x", "error": 1.0, "tolerance": 2.0}, {"case": "y", "error": 3.0, "tolerance": 2.0}]
    assert run("contacts", rows[:1], tmp_path / "one").passed
    outcome = run("contacts", rows, tmp_path / "two")
    assert not outcome.passed
    stored = pd.read_csv(tmp_path / "two/contacts.csv", comment="#")
    assert stored["passed"].tolist() == [True, False] and stored["case"].tolist() == ["x", "y"]


def test_an_engine_that_fails_leaves_no_table(tmp_path):
    def rows():
        yield {"error": 1.0, "tolerance": 2.0}
        raise EngineError("it died")

    with pytest.raises(EngineError, match="it died"):
        run("contacts", rows(), tmp_path / "out")
    assert not (tmp_path / "out/contacts.csv").exists()


def test_engines_are_taken_once_and_else_those_of_the_study():
    motion = STUDIES["motion"]
    assert motion.tools(["yade", "yade"], str) == ["yade"] and motion.tools([], str) == ["embedded", "liggghts"]
