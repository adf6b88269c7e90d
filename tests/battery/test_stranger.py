# SPDX-License-Identifier: GPL-2.0-or-later
"""A CMake project that knows only the installed package: the laws as headers, and the C interface."""

import re
import shutil
import subprocess
import sysconfig
from pathlib import Path

import numpy as np
import pytest

from epdem.base.declarations import library_path
from epdem.laws.library import Law
from epdem.theory import pair, restitution
from epdem.theory.thornton import Thornton

ROOT = Path(__file__).parents[2]
PAGE, PROGRAM = (ROOT / "docs/embed.md").read_text(), ROOT / "data/embed"

PROJECT = """cmake_minimum_required(VERSION 3.20)
project(stranger LANGUAGES C CXX)
find_package(epdem CONFIG REQUIRED)
add_executable(headers headers.cpp)
target_link_libraries(headers PRIVATE epdem::laws)
add_executable(interface interface.c)
target_link_libraries(interface PRIVATE epdem::capi)
"""
HEADERS = """#include <cstdio>
#include <epdem/laws.hpp>
int main() {
  const double p_y[] = {2.8e9};
  const epdem::Thornton<double> law(1.1e11, p_y);
  std::printf("%.17g", epdem::step(law, 0.01, {}, 5e-5).force);
}
"""
INTERFACE = """#include <epdem.h>
#include <stdio.h>
int main(void) {
  const double p_y[] = {2.8e9, 1.0 /* share of the curvature */}, R_star = 0.01, before = 0, delta = 5e-5;
  epdem_step_result out;
  if (epdem_abi() != EPDEM_ABI || epdem_step(1, 1.1e11, p_y, 1, &R_star, &before, &delta, &out)) return 1;
  printf("%.17g", out.force);
  return 0;
}
"""


def build(folder, files):
    if shutil.which("cmake") is None or shutil.which("g++") is None:
        pytest.skip("no cmake or no C++ compiler (apt-get install cmake g++)")
    if not (library_path().parent.parent / "cmake").exists():
        pytest.skip("the compiled parts stand alone here, without the installed package around them")
    for name, text in files.items():
        (folder / name).write_text(text)
    prefix = f"-DCMAKE_PREFIX_PATH={sysconfig.get_path('platlib')}"
    for line in (["-S", folder, "-B", folder / "tree", prefix], ["--build", folder / "tree"]):
        done = subprocess.run(["cmake", *line], capture_output=True, text=True)
        assert done.returncode == 0, done.stdout + done.stderr
    return folder / "tree"


def test_a_stranger_builds_with_the_installed_package(tmp_path):
    tree = build(tmp_path, {"CMakeLists.txt": PROJECT, "headers.cpp": HEADERS, "interface.c": INTERFACE})
    force = Law("thornton", E_star=1.1e11, yield_pressure=2.8e9).step(R_star=0.01, delta_max=0.0, delta=5e-5)[0][0]
    for program in ("headers", "interface"):
        done = subprocess.run([tree / program], check=True, capture_output=True, text=True)
        assert float(done.stdout) == force


@pytest.fixture(scope="module")
def spheres(tmp_path_factory):
    """Runs the program of the page: side, time step, number of steps, rows of x and v; rows at the end."""
    files = {path.name: path.read_text() for path in PROGRAM.iterdir() if path.is_file()}
    program = build(tmp_path_factory.mktemp("spheres"), files) / "spheres"

    def run(side, dt, steps, rows):
        words = " ".join(repr(float(x)) for row in rows for x in row)
        done = subprocess.run(
            [program], input=f"{side} {dt} {steps} {words}", check=True, capture_output=True, text=True
        )
        return np.array([line.split() for line in done.stdout.splitlines()], float)

    return run


R, SPEED = 1e-3, 3.0
MASS, E_STAR = 7850 * 4 / 3 * np.pi * R**3, pair.E_star(208e9, 0.3, 208e9, 0.3)
PHASES = (np.arange(8) + 0.5) / 8


def test_the_core_that_the_page_shows_is_that_of_the_program():
    """Line by line, but for the depth of the class around it."""
    (core,) = re.findall(r"^```cpp\n(.*?)^```$", PAGE, re.M | re.S)
    program = [line.strip() for line in (PROGRAM / "spheres.cpp").read_text().splitlines()]
    assert all(line.strip() in program for line in core.splitlines())


def test_the_program_of_the_page_gives_the_restitution_of_theory(spheres):
    """Pairs and impacts on a wall at 8 starting phases, and the two spheres of the page's command."""
    head_on, at_wall = (Thornton(E_star=E_STAR, R_star=r, p_y=2.8e9) for r in (R / 2, R))
    expected = [restitution.e_n(head_on, m_star=MASS / 2, speed=2 * SPEED)]
    expected.append(restitution.e_n(at_wall, m_star=MASS, speed=SPEED))
    dt = restitution.impact(head_on, m_star=MASS / 2, speed=2 * SPEED).contact_time / 400
    rows = []
    for k, phase in enumerate(PHASES):  # across the faces of cells
        half, y = R + phase * SPEED * dt, 0.011 * (k + 1)
        rows += [(0.05 - half, y, 0.03, SPEED, 0, 0), (0.05 + half, y, 0.03, -SPEED, 0, 0)]
    rows += [(0.011 * (k + 1), 0.05, R + phase * SPEED * dt, 0, 0, -SPEED) for k, phase in enumerate(PHASES)]
    end = spheres(0.1, dt, 2000, rows)
    e_n = (end[1:16:2, 3] - end[:16:2, 3]) / (2 * SPEED), end[16:, 5] / SPEED
    assert np.max(abs(e_n[0] - expected[0])) < 1e-5 and np.max(abs(e_n[1] - expected[1])) < 1e-5
    command = [float(x) for x in re.search(r'echo "(.+)" \|', PAGE)[1].split()]
    leave = spheres(*command[:2], int(command[2]), np.reshape(command[3:], (-1, 6)))[1, 3]
    assert float(re.search(r"both leave with (\S+) m/s", PAGE)[1]) == round(leave, 3)
    assert (
        float(re.search(r"e_n = (\S+)\. Without", PAGE)[1]) == round(leave / SPEED, 4) == round(float(expected[0]), 4)
    )


def test_the_spheres_of_the_page_lose_energy_and_stay_apart_in_a_crowd(spheres):
    """A pair that the list of cells misses would go through each other."""
    rng, side, n = np.random.default_rng(3), 20 * R, 6
    x = (np.stack(np.meshgrid(*[np.arange(n)] * 3), -1).reshape(-1, 3) + 0.5) * side / n
    start = np.hstack([x, rng.normal(size=x.shape)])
    end = spheres(side, 4e-8, 12000, start)
    apart = np.linalg.norm(end[:, None, :3] - end[None, :, :3], axis=-1) + 10 * R * np.eye(len(end))
    assert apart.min() > 1.98 * R and end[:, :3].min() > 0.98 * R and end[:, :3].max() < side - 0.98 * R
    assert 0.1 < np.sum(end[:, 3:] ** 2) / np.sum(start[:, 3:] ** 2) < 0.95
