# SPDX-License-Identifier: GPL-2.0-or-later
"""Elastic-plastic particle contact for LIGGGHTS and YADE, checked against theory."""

__version__ = "0.1.0"
