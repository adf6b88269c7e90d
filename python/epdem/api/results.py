# SPDX-License-Identifier: GPL-2.0-or-later
"""What has run, for a program: tables with units, and what a notebook shows."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import pandas as pd

from ..impacts.comparison import UNITS
from ..impacts.run import Outcome
from ..scenes.columns import UNITS as SCENE_UNITS
from ..scenes.run import SceneOutcome


def with_units(table: pd.DataFrame, units: Mapping[str, str]) -> pd.DataFrame:
    """A table with the units of its columns, as far as they have one, in `attrs["units"]`."""
    found = table.copy()
    names = {name: units.get(name.removesuffix("_theory")) for name in map(str, found.columns)}
    found.attrs["units"] = {name: unit for name, unit in names.items() if unit}
    return found


@dataclass(frozen=True)
class Run:
    """Impacts that have run: `outcome` has everything; in a notebook it shows its table."""

    outcome: Outcome

    @property
    def table(self) -> pd.DataFrame:
        """Measured and predicted numbers, one row for each speed, engine and law."""
        return with_units(self.outcome.results.comparison, UNITS)

    @property
    def passed(self) -> bool:
        """Whether all numbers are within the tolerances of the case."""
        return self.outcome.passed

    @property
    def folder(self) -> Path:
        """Where results.h5, results.csv and the decks are."""
        return self.outcome.folder

    def plot(self) -> Path:
        """Draw e_n.png, restitution against speed with theory; its path."""
        from ..impacts.report import figure

        return figure(self.outcome)

    def _repr_html_(self) -> str:
        return str(self.table.to_html(max_rows=20))


@dataclass(frozen=True)
class SceneRun:
    """A scene that has run: `outcome` has everything; in a notebook it shows its checks."""

    outcome: SceneOutcome

    @property
    def tables(self) -> dict[str, pd.DataFrame]:
        """rows, particles, contacts, ledger and checks, as far as the scene requests them."""
        return {name: with_units(table, SCENE_UNITS) for name, table in self.outcome.results.tables.items()}

    @property
    def passed(self) -> bool:
        """Whether all checks of the scene hold."""
        return self.outcome.passed

    @property
    def folder(self) -> Path:
        """Where results.h5, results.csv and the deck are."""
        return self.outcome.folder

    def _repr_html_(self) -> str:
        return str(self.tables["checks"].to_html())
