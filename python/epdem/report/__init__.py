# SPDX-License-Identifier: GPL-2.0-or-later
"""Pages and pictures of impacts, scenes and studies: figures as data, drawn with matplotlib; the page report.html.

A page and each of its figures are written anew at each call, from the tables of a study.
"""
