# SPDX-License-Identifier: GPL-2.0-or-later
"""Equations that only the proof uses: yield criteria, contact pressures, printed restitutions."""
