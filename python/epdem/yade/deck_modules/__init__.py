# SPDX-License-Identifier: GPL-2.0-or-later
"""The laws inside YADE: `law` (numbers, standard library only) and `contacts` (what a YADE script imports)."""
