# SPDX-License-Identifier: GPL-2.0-or-later
"""Lines by which the deck of an impact becomes that of another set-up."""

from .edits import Edit, Edits


def second_wall(line: str, z: float) -> str:
    """The line of a second wall at height z [m] from that of the wall at height 0."""
    return line.replace("wall(0,", f"wall({z!r},")


def carry(place: float, rise: float, steps: int) -> list[Edit]:
    """Carry the sphere from `place` [m] down by `rise` [m] and back, in cycles of `steps` with the same bits."""
    height = f"{place!r} - {rise!r} * (1 - abs((O.iter + 1) % {steps} / {steps // 2} - 1))"
    return [
        Edit("states =", ("for s in states:", '    s.blockedDOFs = "xyzXYZ"')),
        Edit("    now[2]", ("    for s in states:", f"        s.pos = (s.pos[0], s.pos[1], {height})")),
    ]


EDITS = Edits("impact.py", "O.bodies.append(wall(0,", second_wall, carry)
