# SPDX-License-Identifier: GPL-2.0-or-later
"""The pipeline of every job: inputs, files, engine run, tables, reuse of stored tables."""
