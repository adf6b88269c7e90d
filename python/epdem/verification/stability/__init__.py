# SPDX-License-Identifier: GPL-2.0-or-later
"""Stability on stiff and extreme cases: a fixed set by rule, every engine and law, and where each breaks."""

from .cases import Extreme, extremes
from .suite import Outcome, run

__all__ = ["Extreme", "Outcome", "extremes", "run"]
