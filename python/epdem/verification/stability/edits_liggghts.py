# SPDX-License-Identifier: GPL-2.0-or-later
"""Lines by which the deck of an impact becomes that of another set-up."""

from .edits import Edit, Edits


def second_wall(line: str, z: float) -> str:
    """The line of a second wall at height z [m] from that of the wall at height 0."""
    return line.replace("fix target", "fix ceiling").replace("zplane 0.0", f"zplane {z!r}")


def carry(place: float, rise: float, steps: int) -> list[Edit]:
    """Carry the sphere down by `rise` [m] and up to where it was, in cycles of `steps` with the same bits."""
    lines = (
        f"variable at equal step-{steps}*floor(step/{steps})",
        f"variable dz atom {-rise!r}*(1-abs(v_at/{steps // 2}-1))",
        "variable vz atom 0",
        "fix motion all move variable NULL NULL v_dz NULL NULL v_vz",
    )
    return [Edit("fix motion", lines, instead=True)]


# LIGGGHTS evaluates the contacts at t = 0 without keeping their history
EDITS = Edits("in.impact", "fix target all wall/gran", second_wall, carry, unknown=1)
