# SPDX-License-Identifier: GPL-2.0-or-later
"""`python -m epdem.cli` is the command `epdem`."""

from .main import main

main()
