# SPDX-License-Identifier: GPL-2.0-or-later
"""The theory of elastic-plastic particle contact, on numpy alone: floats or arrays that broadcast, SI, no state.

Equation numbers 8.xx are those of the chapter "Interaction of Elastic-Plastic Particles"; `docs/equations.md` maps
them.
"""
