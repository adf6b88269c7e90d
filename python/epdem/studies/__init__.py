# SPDX-License-Identifier: GPL-2.0-or-later
"""Studies that run many cases."""

from .sweep.table import read_sweep

__all__ = ["read_sweep"]
