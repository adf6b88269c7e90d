# SPDX-License-Identifier: GPL-2.0-or-later
"""A CMake project that knows only the installed package: the laws as headers, and the C interface."""

import shutil
import subprocess

import pytest

from epdem.base.declarations import library_path
from epdem.laws.library import Law

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
  const double p_y[] = {2.8e9, 1.0 /* share of the strain */}, R_star = 0.01, before = 0, delta = 5e-5;
  epdem_step_result out;
  if (epdem_abi() != EPDEM_ABI || epdem_step(1, 1.1e11, p_y, 1, &R_star, &before, &delta, &out)) return 1;
  printf("%.17g", out.force);
  return 0;
}
"""


def test_a_stranger_builds_with_the_installed_package(tmp_path):
    if shutil.which("cmake") is None or shutil.which("g++") is None:
        pytest.skip("no cmake or no C++ compiler (apt-get install cmake g++)")
    config = library_path().parent.parent / "cmake"
    if not config.exists():
        pytest.skip("the compiled parts stand alone here, without the installed package around them")
    for name, text in {"CMakeLists.txt": PROJECT, "headers.cpp": HEADERS, "interface.c": INTERFACE}.items():
        (tmp_path / name).write_text(text)
    for line in (["-S", tmp_path, "-B", tmp_path / "tree", f"-Depdem_DIR={config}"], ["--build", tmp_path / "tree"]):
        subprocess.run(["cmake", *line], check=True, capture_output=True)
    force = Law("thornton", E_star=1.1e11, yield_pressure=2.8e9).step(R_star=0.01, delta_max=0.0, delta=5e-5)[0][0]
    for program in ("headers", "interface"):
        done = subprocess.run([tmp_path / "tree" / program], check=True, capture_output=True, text=True)
        assert float(done.stdout) == force
