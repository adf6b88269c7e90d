# SPDX-License-Identifier: GPL-2.0-or-later
"""Values of parametrized tests that `make thorough` runs."""

import pytest


def thorough(*values, unless=False, marks=(), **named):
    """pytest.param of the values, for `make thorough` alone; `unless`: for `make test`."""
    return pytest.param(*values, marks=[*marks] if unless else [*marks, pytest.mark.thorough], **named)
