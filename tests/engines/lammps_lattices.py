# SPDX-License-Identifier: GPL-2.0-or-later
"""Regular lattices of real spheres in a periodic box of LAMMPS, pressed and released, beside the lattices in numpy."""

import numpy as np
from lammps_decks import column, run

from bed import Material
from bed_lattices import distance_at
from dense_lattices import LATTICES
from epdem.theory.cavity import FINITE_STRAIN

# LAMMPS's lattice at first touch of spheres of radius 1, cells along an edge: no two neighbors are the same sphere
CELLS = {
    "sc": ("sc 2", 3),
    "fcc": (f"fcc {8**0.5!r}", 2),
    "bcc": (f"bcc {4 / 3**0.5!r}", 3),
    "hex": (f"custom 2 a1 1 0 0 a2 0 {3**0.5!r} 0 a3 0 0 1 basis 0 0 0 basis 0.5 0.5 0", 3),
}
DECK = """units si
atom_style sphere
atom_modify map array sort 0 0
comm_modify vel yes
boundary p p p
lattice {lattice}
region box block 0 {cells} 0 {cells} 0 {cells}
create_box 1 box
create_atoms 1 box
set group all diameter 2 density 1e15
pair_style ep
pair_coeff * * {law}
neighbor 0.1 bin
fix move all nve/sphere
timestep 1e-3
thermo_style custom step lz press
thermo_modify format float %.17g
thermo 1
"""


def dense_law(material):
    """Words of cavity with finite_strain and compaction."""
    return f"cavity {material.E!r} {material.nu!r} {material.Y!r} 1.6 2.8 {FINITE_STRAIN} compaction on"


def press(folder, name, material, density, *, steps=400, back=0.0, law=dense_law):
    """(distance, pressure/Y) of all steps: to a relative density and, by `back` [R], from there back. LAMMPS moves the
    box after the forces of a step: the spheres of a step stand as the box of the step before."""
    lattice, cells = CELLS[name]
    text = DECK.format(lattice=lattice, cells=cells, law=law(material))
    end = float(distance_at(LATTICES[name], density))
    scales = [end] + [(end + back) / end] * (back > 0)
    for scale in scales:
        text += f"fix squeeze all deform 1 {' '.join(f'{a} scale {scale!r}' for a in 'xyz')} remap x\nrun {steps}\n"
    folder.mkdir(parents=True, exist_ok=True)
    out, _ = run(text, folder)
    step, box, pressure = (column(out, c) for c in ("Step", "Lz", "Press"))
    second = np.flatnonzero(np.diff(step) == 0)[-1:]  # the run back begins with the last step
    found = []
    for d, P in zip(np.split(box / box[0], second + 1), np.split(pressure, second + 1), strict=True):
        of_spheres = np.append(d[0], d[:-1])
        found.append([of_spheres, P * (d / of_spheres) ** 3])
    return np.concatenate(found, axis=1)


def press_in_die(folder, material, density, *, steps=400, back=0.0):
    """(distance, axial, lateral stress over Y) of one sphere between six rigid walls, of which two move."""
    end = np.pi / 6 / density
    rigid = dense_law(Material(1e9 * material.E, 0.0, 1e9 * material.Y))
    text = f"""units si
atom_style sphere
atom_modify map array
comm_modify vel yes
boundary f f f
region box block -2 2 -2 2 -2 2
create_box 1 box
create_atoms 1 single 0 0 0
set group all diameter 2 density 1e15
pair_style ep
pair_coeff * * {dense_law(material)}
neighbor 0.1 bin
fix left all wall/ep xplane -1 NULL {rigid}
fix right all wall/ep xplane NULL 1 {rigid}
fix front all wall/ep yplane -1 NULL {rigid}
fix back all wall/ep yplane NULL 1 {rigid}
variable pressed equal ramp(0,1)
variable released equal 0
variable up equal {1 - end!r}*v_pressed-{back!r}*v_released
variable down equal -v_up
region lower plane 0 0 -1 0 0 1 move NULL NULL v_up
region upper plane 0 0 1 0 0 -1 move NULL NULL v_down
fix lower all wall/ep/region lower {rigid}
fix upper all wall/ep/region upper {rigid}
fix move all nve/sphere
timestep 1e-3
thermo_style custom step v_up f_lower[3] f_left[1]
thermo_modify format float %.17g
thermo 1
run {steps}
"""
    if back > 0.0:
        text += f"variable pressed equal 1\nvariable released equal ramp(0,1)\nrun {steps}\n"
    folder.mkdir(parents=True, exist_ok=True)
    out, _ = run(text, folder)
    d, top, side = 1 - column(out, "v_up"), column(out, "f_lower[3]"), column(out, "f_left[1]")
    return np.array([d, top / 4, side / (4 * d)])
