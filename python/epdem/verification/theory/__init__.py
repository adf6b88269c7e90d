# SPDX-License-Identifier: GPL-2.0-or-later
"""Equations that only the proof uses: stress fields, yield criteria, waves, oblique impacts, printed restitutions."""
