# SPDX-License-Identifier: GPL-2.0-or-later
"""Sweeps: one case or scene at many points, on this machine or on a cluster; a finished point never runs again."""
