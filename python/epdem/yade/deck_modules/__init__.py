# SPDX-License-Identifier: GPL-2.0-or-later
"""The laws inside YADE: `law` (the C library for one contact) and `contacts` (what a YADE script imports)."""
