# SPDX-License-Identifier: GPL-2.0-or-later
"""Tables of a scene from the output of any host, and their file results.h5."""
