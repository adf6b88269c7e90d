# SPDX-License-Identifier: GPL-2.0-or-later
"""Tools for decks of the user's own and for other trees of LIGGGHTS."""
