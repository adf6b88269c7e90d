# SPDX-License-Identifier: GPL-2.0-or-later
"""Modules whose copies are part of a YADE deck: `deck_modules`, which YADE's own Python imports."""
