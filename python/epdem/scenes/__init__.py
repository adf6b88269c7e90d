# SPDX-License-Identifier: GPL-2.0-or-later
"""Bulk scenes: a case file with [scene] becomes a lean LIGGGHTS deck, a run that can be resumed, and tables."""
