# SPDX-License-Identifier: GPL-2.0-or-later
"""Normal impacts in YADE under a law of the C library, whose copy lies beside this module.

YADE finds the contacts and moves the bodies; its own springs have stiffness 0. `apply`, between the interaction loop
and the integrator, adds the force of the law.
"""

import ctypes
import json
from functools import partial
from pathlib import Path
from typing import Any

from yade import O
from yade.wrapper import (
    Ig2_Sphere_Sphere_ScGeom,
    Ig2_Wall_Sphere_ScGeom,
    InteractionLoop,
    Ip2_FrictMat_FrictMat_FrictPhys,
    Law2_ScGeom_FrictPhys_CundallStrack,
    MatchMaker,
)

LIBRARY = Path(__file__).with_name("libepdem.so")


class Contacts:
    """Contacts of one pair of materials and one R_star [m]; E_star [Pa], parameters of the law by name, SI.

    share: curvature share of the pair, on which finite strain depends, 0 to 1.
    """

    def __init__(self, law: str, *, E_star: float, R_star: float, share: float, **parameters: float):
        library = ctypes.CDLL(str(LIBRARY))
        library.epdem_declarations.restype = library.epdem_message.restype = ctypes.c_char_p
        laws = json.loads(library.epdem_declarations())
        index = [declared["name"] for declared in laws].index(law)
        values = [parameters[p["name"]] for p in laws[index]["parameters"]]
        numbers = (ctypes.c_double * (len(values) + 1))(*values, share)
        self._R, self._before, self._now = ctypes.c_double(R_star), ctypes.c_double(), ctypes.c_double()
        self._result = (ctypes.c_double * 3)()  # force [N], contact radius, largest overlap [m]
        pointers = map(ctypes.byref, (self._R, self._before, self._now, self._result))
        constants = ctypes.c_int(index), ctypes.c_double(E_star), numbers, ctypes.c_size_t(1)
        self._step, self._message = partial(library.epdem_step, *constants, *pointers), library.epdem_message
        self._largest: dict[tuple[int, int, int], float] = {}  # overlap [m] of each contact that was ever there

    def loop(self) -> Any:
        """YADE's interaction loop, to stand before `apply`."""
        none = MatchMaker(algo="val", val=0.0)
        return InteractionLoop(
            [Ig2_Sphere_Sphere_ScGeom(), Ig2_Wall_Sphere_ScGeom()],
            [Ip2_FrictMat_FrictMat_FrictPhys(kn=none, ks=none)],
            [Law2_ScGeom_FrictPhys_CundallStrack()],
        )

    def apply(self) -> None:
        """Add the forces of this step. Raises ValueError with the reason of the law."""
        for i in O.interactions:
            contact = i.id1, i.id2, i.iterMadeReal
            self._before.value, self._now.value = self._largest.get(contact, 0.0), i.geom.penetrationDepth
            if status := self._step():
                raise ValueError(self._message(status).decode())
            force, _, self._largest[contact] = self._result
            O.forces.addF(i.id1, -force * i.geom.normal)
            O.forces.addF(i.id2, force * i.geom.normal)
