# SPDX-License-Identifier: GPL-2.0-or-later
"""Output of a study: figures described once, drawn with matplotlib or in a page; the page report.html."""
