# SPDX-License-Identifier: GPL-2.0-or-later
"""Where a prediction leaves the range in which the law, or small-deformation theory, has been compared with anything.

Each law states its own limits (`Law.caveats`); the limits of all laws together are here.
"""

import numpy as np

from .numerics import Array

SMALL_DEFORMATION = 0.3  # strain l a_max/R* above which results are flagged everywhere
# l a/R* from which finite-element impacts leave the -1/4 law, and by how many percent e_n of cavity exceeds theirs
# there: 0.62 [(v/v_y0)/(E*/Y)]^(-1/2), the finite-strain branch of Wu et al. 2003, a sphere and a rigid plane (l = 1);
# the ratio does not depend on Y
FINITE_STRAIN = {0.2: 0, SMALL_DEFORMATION: 23}
OVERESTIMATED = (
    f"small-strain theory overestimates e_n, by {FINITE_STRAIN[SMALL_DEFORMATION]} % at {SMALL_DEFORMATION} (cavity "
    "against Wu et al. 2003), more beyond"
)

SOFTENED = (  # of cavity with finite_strain against the same branch, E*/Y = 120 to 300
    f"e_n with finite_strain is overestimated by 6 to 8 % at {SMALL_DEFORMATION} and by 20 % at 0.5 (Wu et al. 2003)"
)


OF_SHARE = "w a/R* (w: share of the weaker body, 1/2 of like bodies, 1 beside a rigid one)"
OF_CURVATURE = "l a/R* (l: 1/2 for like bodies, 1 for a sphere on a rigid plane, 0 for a rigid sphere on a plane)"


def finite_strain(largest: float, where: str = "", effect: str = OVERESTIMATED, strain: str = OF_SHARE) -> list[str]:
    """A sentence for the highest limit that the largest `strain` of contacts exceeds; none below all limits.

    The strain is l a/R* (`pair.curvature_share`), or of scenes w a/R* (`pair.strain_share`), which is the same between
    like bodies. `where`: which part of the results is above the limit; `effect`: what follows from it, in words.
    """
    limit = max((limit for limit in FINITE_STRAIN if largest > limit), default=None)
    if limit is None:
        return []
    return [f"the strain {strain} reaches {largest:.2f}, above {limit}{where}: {effect}"]


def finite_strain_of_impacts(strain: Array, speed: Array, effect: str = OVERESTIMATED) -> list[str]:
    """`finite_strain` for impacts with the largest strains l a_max/R* at `speed` [m/s], arrays of one shape."""
    limit = max((limit for limit in FINITE_STRAIN if strain.max() > limit), default=np.inf)
    where = f" from {speed[strain > limit].min():.3g} m/s on" if limit < np.inf else ""
    return finite_strain(strain.max(), where, effect, OF_CURVATURE)
