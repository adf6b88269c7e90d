# SPDX-License-Identifier: GPL-2.0-or-later
"""Decks of LAMMPS with our plugin, and their results."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from epdem.engines.lammps import launcher

needs_lammps = pytest.mark.lammps

THORNTON = "thornton 1e8 0.3 4e5"
BOX = (0.04, 0.02, 0.02)  # [m]


def bed(
    pairs=(f"1 1 {THORNTON} tangential history 0.3",),
    *,
    style="ep",
    newton="off",
    units="si",
    scale=1.0,
    boundary="p p p",
    more="",
    types=1,
):
    """A dense bed of 2,000 spheres of 2 mm that is sheared, in a periodic box; every length times `scale`."""
    length = [scale * side for side in BOX]
    box = " ".join(f"0 {side!r}" for side in length)
    many = "set group all type/fraction 2 0.5 4711\n" if types == 2 else ""
    coefficients = "\n".join(f"pair_coeff {words}" for words in pairs)
    return f"""units {units}
atom_style sphere
atom_modify map array
newton {newton}
comm_modify vel yes
boundary {boundary}
region box block {box} units box
create_box {types} box
lattice sc {0.00192 * scale!r} origin 0.5 0.5 0.5
create_atoms 1 box
set group all diameter {0.002 * scale!r} density {2500 * (1e-3 if units == "cgs" else 1)!r}
displace_atoms all random {5e-5 * scale!r} {5e-5 * scale!r} {5e-5 * scale!r} 1234 units box
{many}velocity all ramp vx {-0.4 * scale!r} {0.4 * scale!r} y 0 {length[1]!r} units box
velocity all ramp vy {-0.2 * scale!r} {0.2 * scale!r} x 0 {length[0]!r} sum yes units box
pair_style {style}
{coefficients}
neighbor {0.0004 * scale!r} bin
neigh_modify delay 0
{more}
fix motion all nve/sphere
timestep 2e-6
thermo_style custom step atoms ke press
thermo_modify lost error format float %.17g
thermo 500
"""


def spheres(*places, pair, diameter=0.02, density=7850):
    """Equal spheres at rest at places [m] in a room of 0.2 m; `pair`: words of pair_coeff * *."""
    atoms = "".join(f"create_atoms 1 single {x!r} {y!r} {z!r}\n" for x, y, z in places)
    return f"""units si
atom_style sphere
atom_modify map array
comm_modify vel yes
boundary f f f
region box block -0.1 0.1 -0.1 0.1 -0.1 0.1
create_box 1 box
{atoms}set group all diameter {diameter} density {density}
pair_style ep
pair_coeff * * {pair}
neighbor 0.002 bin
"""


DUMP = "write_dump all custom end.txt id type x y z vx vy vz omegax omegay omegaz modify sort id format float %.17g\n"


def lammps(text, folder, *, ranks=1):
    """Run a deck; code and output."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "in.deck").write_text(text)
    command = [str(launcher.program()), "-in", "in.deck", "-log", "none"]
    if ranks > 1:
        command = [str(Path(sys.prefix) / "bin" / "mpiexec"), "-n", str(ranks), *command]
    done = subprocess.run(
        command,
        cwd=folder,
        env=launcher.environment(),
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        timeout=300,
        check=False,
    )
    return done.returncode, done.stdout


def run(text, folder, *, ranks=1):
    """Output of a deck that must run, and its last rows by atom: end.txt without the id."""
    code, out = lammps(text, folder, ranks=ranks)
    assert code == 0 and "ERROR" not in out and "WARNING" not in out, out[-3000:]
    end = folder / "end.txt"
    rows = np.loadtxt(end, skiprows=9, ndmin=2)[:, 1:] if end.exists() else np.empty(0)
    return out, rows


def column(out, name):
    """A column of all thermo tables of an output."""
    found, at = [], None
    for line in out.splitlines():
        words = line.split()
        if words[:1] == ["Step"]:
            at = words.index(name) if name in words else None
        elif line.startswith("Loop time"):
            at = None
        elif at is not None and words:
            found.append(float(words[at]))
    return np.array(found)
