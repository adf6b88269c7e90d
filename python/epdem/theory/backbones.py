# SPDX-License-Identifier: GPL-2.0-or-later
"""The register of laws by name: a new law is its file beside this one and a line here."""

from .backbone import Backbone, Parameter
from .cavity import Cavity
from .hertz import Hertz
from .johnson import Johnson
from .thornton import Thornton

LAWS: dict[str, type[Backbone]] = {law.name: law for law in (Hertz, Thornton, Johnson, Cavity)}

__all__ = ["LAWS", "Backbone", "Cavity", "Hertz", "Johnson", "Parameter", "Thornton"]
