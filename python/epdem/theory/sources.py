# SPDX-License-Identifier: GPL-2.0-or-later
"""The sources of the theory in full, by their short names. Equation numbers 8.xx are those of CHAPTER."""

import tomllib
from pathlib import Path

CHAPTER = (
    "J. P. K. Seville, C.-Y. Wu, Particle Technology and Engineering, Butterworth-Heinemann (2016), "
    "ISBN 978-0-08-098337-0, chapter 8, section 8.2"
)
SOURCES: dict[str, str] = tomllib.loads(Path(__file__).with_name("sources.toml").read_text(encoding="utf-8"))
