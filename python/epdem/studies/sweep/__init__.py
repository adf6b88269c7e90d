# SPDX-License-Identifier: GPL-2.0-or-later
"""Sweeps: one case or scene at many points, here or on a cluster; what is finished is never run again."""
