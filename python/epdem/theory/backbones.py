# SPDX-License-Identifier: GPL-2.0-or-later
"""The register of laws by name: a new law is its file beside this one and a line here."""

from .backbone import Backbone, Parameter
from .cavity import Cavity
from .hertz import Hertz
from .jkr import JKR
from .johnson import Johnson
from .thornton import Thornton
from .thornton_ning import ThorntonNing

LAWS: dict[str, type[Backbone]] = {law.name: law for law in (Hertz, Thornton, Johnson, Cavity)}
# With adhesion: the contact radius is the natural variable, and the theory of impacts is in `adhesion`.
ADHESIVE: dict[str, type[JKR]] = {law.name: law for law in (JKR, ThorntonNing)}

__all__ = ["ADHESIVE", "JKR", "LAWS", "Backbone", "Cavity", "Hertz", "Johnson", "Parameter", "Thornton", "ThorntonNing"]
