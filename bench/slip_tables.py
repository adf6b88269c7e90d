# SPDX-License-Identifier: GPL-2.0-or-later
"""The tables of docs/partial_slip.md.

.venv/bin/python bench/slip_tables.py
"""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tests" / "physics"))

from slip import IMPACTS, LAWS, error, rebound, reference, shaken, sheared_back_under_load


def main():
    """The tables of docs/partial_slip.md."""
    print("| e_t at psi_1 | " + " | ".join(f"`{n}` {v:.3g} m/s" for n, v in IMPACTS[:2]) + " |")
    for psi_1 in (0.01, 0.05, 0.1, 0.125):
        cells = []
        for name, speed in IMPACTS[:2]:
            psi_2 = [rebound(LAWS[name], [psi_1], speed, steps=300, nodes=k)[0].mean() for k in (2, 3)]
            psi_2.append(float(reference(LAWS[name], [psi_1], speed)[0]))
            cells.append(", ".join(f"{1 - (1 - x / psi_1) / 3.5:.3f}" for x in psi_2))
        print(f"| {psi_1:g} | {' | '.join(cells)} |")
    for share in (0.1, 0.2, 0.3, 0.4, 0.5, 0.7):
        print(f"| {share} | " + " | ".join(f"{shaken(share, nodes=k):.3f}" for k in (2, 3, 0)) + " |")
    for share in (0.05, 0.1, 0.3, 0.6):
        losses = [sheared_back_under_load(share, nodes=k, cycles=20)[[0, 1, 4, 19]] for k in (2, 3, 0)]
        print(f"| {share} | " + " | ".join(", ".join(f"{x:.2f}" for x in row) for row in losses) + " |")
    print("| friction | steps in contact | " + " | ".join(f"`{n}` {v:.3g} m/s" for n, v in IMPACTS) + " |")
    print("|" + "---|" * (2 + len(IMPACTS)))
    for label, nodes in (("one spring, `history`", 0), ("2 nodes", 2), ("3 nodes", 3)):
        for steps in (30, 100, 300):
            row = [f"{error(name, speed, nodes=nodes, steps=steps):.3f}" for name, speed in IMPACTS]
            print(f"| {label} | {steps} | {' | '.join(row)} |")


if __name__ == "__main__":
    main()
