# SPDX-License-Identifier: GPL-2.0-or-later
"""Print what a module for this YADE is built with: version, precision, features, folder of Python's headers."""

import sysconfig

from yade import config

print("epdem version", config.version)
print("epdem bits", config.highPrecisionBits)
print("epdem digits", config.highPrecisionDecimalPlaces)
print("epdem features", " ".join(sorted(set(config.features))))
print("epdem python", sysconfig.get_path("include"))
