# SPDX-License-Identifier: GPL-2.0-or-later
"""The pages report.html of runs, scenes and studies: each puts its parts together, `report.page` lays them out."""
