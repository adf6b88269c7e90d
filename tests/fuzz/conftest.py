# SPDX-License-Identifier: GPL-2.0-or-later
"""How much is tried: a few fixed examples in the test suite, EPDEM_FUZZ random ones per test in `make fuzz`."""

import os
from pathlib import Path

from hypothesis import HealthCheck, settings
from hypothesis.database import DirectoryBasedExampleDatabase

FEW = 10
few = settings(derandomize=True, deadline=None, suppress_health_check=list(HealthCheck), max_examples=FEW)
settings.register_profile("few", few)
settings.register_profile(
    "many",
    few,
    derandomize=False,
    database=DirectoryBasedExampleDatabase(Path(__file__).with_name("seeds")),
    max_examples=int(os.environ.get("EPDEM_FUZZ", FEW)),
)


def pytest_runtest_setup():
    settings.load_profile("many" if "EPDEM_FUZZ" in os.environ else "few")
