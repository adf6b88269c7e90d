# SPDX-License-Identifier: GPL-2.0-or-later
"""The plan of a scene, made once from the case: what hosts translate into decks. Refuses scenes beyond limits."""
