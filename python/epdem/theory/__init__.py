# SPDX-License-Identifier: GPL-2.0-or-later
"""The theory of elastic-plastic particle contact, on numpy alone: floats or arrays that broadcast, SI, no state.

Equation numbers 8.xx are those of Seville and Wu 2016, chapter 8, section 8.2 (`sources.CHAPTER`); `docs/equations.md`
lists them with their functions and tests.
"""
