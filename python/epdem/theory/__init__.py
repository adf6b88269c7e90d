# SPDX-License-Identifier: GPL-2.0-or-later
"""The theory of elastic-plastic particle contact, on numpy alone: floats or arrays that broadcast, SI, no state.

Equation numbers 8.xx are those of Seville and Wu 2016, chapter 8, section 8.2 (`sources.CHAPTER`); `docs/equations.md`
lists them with their functions and tests.
"""

# isort: off
# fmt: off
from .backbones import ADHESIVE, LAWS
from .pair import contact_conductance
from .johnson import Johnson
from .pair import E_star, G_star, R_star, m_star, sphere_mass
from .printed import (
    bridges_restitution, cavity_mean, elastic_mean, first_yield, first_yield_mean, fully_plastic_mean,
    hertz_pressure, johnson_plane_restitution, johnson_restitution, loading_pressure, mean_pressure,
    thornton_restitution, tresca, unloading_force, unloading_pressure, von_mises, wu_restitution,
)
from .restitution import e_n, impact
from .sliding import first_sliding_yield, subsurface, surface
from .waves import (
    elastic_wave_share, energy_split, history, plastic_wave_share, radiated, rayleigh_share, wave_constant,
)
from .yielding import first_yield_speed, yield_speed

__all__ = [  # noqa: RUF022
    "ADHESIVE", "E_star", "G_star", "Johnson", "LAWS", "R_star", "bridges_restitution", "cavity_mean",
    "contact_conductance", "e_n", "elastic_mean", "elastic_wave_share", "energy_split", "first_sliding_yield",
    "first_yield", "first_yield_mean", "first_yield_speed", "fully_plastic_mean", "hertz_pressure", "history", "impact",
    "johnson_plane_restitution", "johnson_restitution", "loading_pressure", "m_star", "mean_pressure",
    "plastic_wave_share", "radiated", "rayleigh_share", "sphere_mass", "subsurface", "surface", "thornton_restitution",
    "tresca", "unloading_force", "unloading_pressure", "von_mises", "wave_constant", "wu_restitution", "yield_speed",
]
# fmt: on
