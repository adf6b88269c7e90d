# SPDX-License-Identifier: GPL-2.0-or-later
"""What a YADE deck contains a copy of: `deck_modules`, which YADE's own Python imports."""
