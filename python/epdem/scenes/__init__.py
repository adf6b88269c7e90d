# SPDX-License-Identifier: GPL-2.0-or-later
"""Bulk scenes: a case file with [scene] becomes a plan for an engine, a run that can be resumed, and tables."""
