# SPDX-License-Identifier: GPL-2.0-or-later
"""The commands of the headline claims give the values that the pages state."""

import pytest

from scripts import DOCS, script

validation = script("validation")
READ = validation.read()
CLAIMS = validation.claims_of(READ)


def test_pages_state_the_values_of_the_claims():
    assert validation.PAGE.read_text() == validation.page(READ), "run .venv/bin/python docs/validation.py"
    assert (DOCS / "data/commands.csv").read_text() == validation.commands(READ).to_csv(index=False)
    assert all((DOCS.parent / ("" if name == "README.md" else "docs") / name).exists() for name in READ["commands"])
    for name, claim in CLAIMS.items():
        for page in claim.get("quoted", []):
            assert validation.shown(claim["value"]) in (DOCS.parent / page).read_text(), name


@pytest.mark.liggghts
def test_every_command_still_gives_the_value_of_its_claim():
    found = validation.measure(CLAIMS)
    assert len(found) >= 14
    for name, value in found.items():
        assert value == pytest.approx(CLAIMS[name]["value"], rel=0.02), name
        assert value <= CLAIMS[name].get("tolerance", 1.0), name
