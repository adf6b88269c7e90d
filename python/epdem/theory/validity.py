# SPDX-License-Identifier: GPL-2.0-or-later
"""Where a prediction leaves the range in which the law, or small-deformation theory, has been compared with anything.

Each law states its own limits (`Backbone.caveats`); the limits of all laws together are here.
"""

import numpy as np

from . import adhesion
from .backbone import Backbone
from .checks import Array, Real, number
from .jkr import JKR
from .restitution import impact

SMALL_DEFORMATION = 0.3  # a_max/R* above which results are flagged everywhere
# a_max/R* from which finite-element impacts leave the -1/4 law, whatever Y is, and by how much e_n is then too high
# (finite-strain branch of Wu et al. 2003)
FINITE_STRAIN = {0.2: "0 to 6 % too high, growing", SMALL_DEFORMATION: "13 to 23 % too high, growing"}


def caveats(law: Backbone, *, m_star: float, speed: Real) -> list[str]:
    """Sentences, none where all is well, on impacts at `speed` [m/s] > 0 of any shape with m_star [kg] > 0."""
    speed = np.ravel(number("speed", speed))
    strain = impact(law, m_star=m_star, speed=speed).strain_ratio
    return [*law.caveats(m_star=m_star, speed=speed), *_finite_strain(strain, speed)]


def adhesive_caveats(law: JKR, *, m_star: float, speed: Real) -> list[str]:
    """The same for a law with adhesion; Tabor's number below 3 is one of them."""
    speed = np.ravel(number("speed", speed))
    tabor = adhesion.warning(law)
    return [
        *([tabor] if tabor else []),
        *_finite_strain(adhesion.impact(law, m_star=m_star, speed=speed).strain_ratio, speed),
    ]


def _finite_strain(strain: Array, speed: Array) -> list[str]:
    sentences = []
    for limit, deviation in FINITE_STRAIN.items():
        beyond = speed[strain > limit]
        if beyond.size:
            sentences.append(
                f"a_max/R* reaches {strain.max():.2f}, above {limit} from {beyond.min():.3g} m/s on: finite strain, "
                f"e_n is {deviation}"
            )
    return sentences
