# SPDX-License-Identifier: GPL-2.0-or-later
"""What a study shows: figures described once, drawn with matplotlib or in a page; the page report.html."""
