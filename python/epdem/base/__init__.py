# SPDX-License-Identifier: GPL-2.0-or-later
"""Modules for every room, without physics: files, folders, processes, templates, tables, consoles."""

__version__ = "0.2.0"
