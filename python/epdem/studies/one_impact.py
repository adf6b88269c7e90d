# SPDX-License-Identifier: GPL-2.0-or-later
"""One impact on a wall of the same material by every law, from theory."""

from dataclasses import replace
from typing import Any

import numpy as np

from ..case.library import sourced
from ..errors import CaseError
from ..impacts.experiment import Experiment, pair_of, plane, sphere
from ..impacts.prediction import predict
from ..laws.strengths import default_numbers
from ..theory import yielding
from ..theory.backbones import ADHESIVE, LAWS

NAMES = ("e_n", "contact_time", "force_max", "overlap_max", "residual_overlap", "strain_ratio")


def one_impact(material: str, *, radius: float, speed: float, adhesion: float | None = None) -> dict[str, Any]:
    """A sphere of `radius` [m], of a material in the materials file, at `speed` [m/s]; both > 0. Raises CaseError.

    SI: the impact; E* and m*; pressure and depth of first yield; the yield speeds v_y0 and v_y, at which p_0 is
    `first` Y and p_m is `plastic` Y; in `laws` the numbers NAMES of each law. With a work of `adhesion` > 0 [J/m^2] the
    laws with adhesion come, too.
    """
    properties, source = sourced(material)
    if (Y := properties.yield_stress) is None:
        raise CaseError(f"--material {material!r} has no yield stress in the materials file; choose another")
    body, target = sphere(properties, radius=radius, name=material), plane(properties, name=material)
    laws = {}
    for name in [*LAWS, *(ADHESIVE if adhesion else [])]:
        law = default_numbers(name)
        law = replace(law, adhesion=adhesion) if name in ADHESIVE else law
        x = Experiment(pair_of(law, body, target), body, target, np.array([speed]))
        prediction = predict(x)
        laws[name] = {k: float(getattr(prediction, k)[0]) for k in NAMES}
    plastic, first = LAWS["thornton"].declaration().default_ratio, yielding.FIRST_YIELD_ROUNDED
    p_0, depth = yielding.first_yield(properties.poisson_ratio)
    pair = {"E_star": x.E_star, "R_star": x.R_star, "m_star": x.m_star}
    found: dict[str, Any] = {"material": material, "source": source, "radius": radius, "speed": speed}
    found |= {"E_star": x.E_star, "m_star": x.m_star}
    found |= {"first_yield_p0_over_Y": float(p_0), "first_yield_depth_over_a": float(depth)}
    speeds = {name: float(yielding.yield_speed(p_y=k * Y, **pair)) for name, k in (("v_y0", first), ("v_y", plastic))}
    return found | speeds | {"laws": laws, "first": float(first), "plastic": float(plastic)}
