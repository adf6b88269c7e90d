# SPDX-License-Identifier: GPL-2.0-or-later
"""The theory of each law that is declared in C++, by name: the class with this name in the module of this name."""

from collections.abc import Iterator, Mapping
from importlib import import_module
from typing import TypeVar

from ..base.declarations import declarations
from .backbone import Backbone
from .cavity import Cavity
from .hertz import Hertz
from .jkr import JKR
from .johnson import Johnson
from .meyer import Meyer
from .thornton import Thornton
from .thornton_ning import ThorntonNing

Kind = TypeVar("Kind", Backbone, JKR)


class _Laws(Mapping[str, type[Kind]]):
    """Classes by the name of the law; the C library is read when they are looked at."""

    def __init__(self, base: type[Kind], adheres: bool):
        self.base: type[Kind] = base
        self.adheres = adheres

    def __iter__(self) -> Iterator[str]:
        return (name for name, law in declarations().items() if law.adheres is self.adheres)

    def __len__(self) -> int:
        return sum(1 for _ in self)

    def __getitem__(self, name: str) -> type[Kind]:
        if name not in list(self):
            raise KeyError(name)
        classes = [c for c in vars(import_module(f".{name}", __package__)).values() if isinstance(c, type)]
        return next(c for c in classes if issubclass(c, self.base) and vars(c).get("name") == name)


LAWS = _Laws(Backbone, adheres=False)
# The contact radius is the natural variable, and the theory of impacts is in `adhesion`.
ADHESIVE = _Laws(JKR, adheres=True)

__all__ = ["ADHESIVE", "JKR", "LAWS", "Backbone", "Cavity", "Hertz", "Johnson", "Meyer", "Thornton", "ThorntonNing"]
