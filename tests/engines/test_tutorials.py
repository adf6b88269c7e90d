# SPDX-License-Identifier: GPL-2.0-or-later
"""Decks that others wrote: tutorials of LIGGGHTS with `ep/hertz` in place of `hertz`, row by row, then with yield.

Two of them run in the test suite, all six by `make tutorials` (EPDEM_TUTORIALS=all).
"""

import os

import numpy as np
import pytest
from plugin_decks import good
from tutorials import STEPS, decks, need_source, rewritten, unpacked

from epdem.tools.deck_checks import check
from marks import thorough

pytestmark = pytest.mark.liggghts
SHORT = ["packing/in.packing", "heatTransfer_1/in.heatGran"]
CHOSEN = list(STEPS) if os.environ.get("EPDEM_TUTORIALS") == "all" else SHORT
YIELD = "fix yp all property/global yieldPressure peratomtype 1e5\n"


def rows(name, folder, model, **changes) -> np.ndarray:
    """The thermo rows: step, atoms, kinetic energy, spin energy and what the tutorial adds."""
    folder.mkdir()
    text = rewritten(unpacked(name, folder), model, *STEPS[name], **changes)
    found, width = [], 0
    for line in good(folder, text, timeout=900).text.splitlines():
        words = line.split()
        width = len(words) if words[:1] == ["Step"] else width
        if width and len(words) == width and words[0].isdigit():
            found.append([float(word) for word in words])
    return np.array(found)


@pytest.mark.parametrize("name", [thorough(name, unless=CHOSEN is not SHORT or name == SHORT[0]) for name in CHOSEN])
def test_a_tutorial_has_the_rows_of_hertz_and_loses_energy_where_it_yields(name, tmp_path):
    need_source()
    hertz = rows(name, tmp_path / "hertz", "hertz")
    ours = rows(name, tmp_path / "ours", "ep/hertz")
    soft = rows(name, tmp_path / "soft", "ep/thornton", extra=YIELD)
    assert hertz.shape == ours.shape and len(hertz) > 7 and hertz[-1, 1] > 0
    assert ours == pytest.approx(hertz, rel=1e-9, abs=1e-15)
    assert (soft[:, 0] == hertz[:, 0]).all()
    energy = [table[-1, 2] / table[-1, 1] for table in (soft, hertz)]  # of a sphere: where a bed is low, more fit in
    assert energy[0] < 0.999 * energy[1]


def test_no_tutorial_has_an_input_that_the_check_names():
    need_source()
    found = decks()
    assert len(found) > 20
    assert [sentence for name, text in found.items() for sentence in check(text, name)] == []
