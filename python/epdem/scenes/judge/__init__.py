# SPDX-License-Identifier: GPL-2.0-or-later
"""Judgement of a scene by its plan and tables: energy balance, checks, measures, warnings, summary."""
