# SPDX-License-Identifier: GPL-2.0-or-later
"""What every room uses, free of the domain: files, folders, processes, templates, tables, consoles."""

__version__ = "0.2.0"
