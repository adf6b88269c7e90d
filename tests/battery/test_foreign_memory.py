# SPDX-License-Identifier: GPL-2.0-or-later
"""A contact whose stored numbers are those of another law, as after a restart with another model."""

import shutil
import subprocess
from pathlib import Path

import pytest

INCLUDE = Path(__file__).parents[2] / "cpp_contact/include"
PROGRAM = """
#include <cmath>
#include <cstdio>
#include <cstring>
#include <random>
#include "epdem/laws.hpp"

// Random bit patterns that are finite numbers, and numbers of everyday size, in every slot of the memory.
static double number(std::mt19937_64& r) {
  std::uniform_real_distribution<double> everyday(-2.0, 2.0);
  if (r() & 1) return everyday(r);
  double x;
  do {
    const unsigned long long bits = r();
    std::memcpy(&x, &bits, sizeof x);
  } while (!std::isfinite(x));
  return x;
}

template <class Law>
static int bad() {
  std::mt19937_64 r(7);
  const double parameter[] = {1e9, 1.6, 2.8, epdem::no_finite_strain, epdem::no_finite_strain};
  const Law law = epdem::law_of<Law>(1.1e11, parameter, 1.0);
  int found = 0;
  for (int n = 0; n < 2000000; ++n) {
    epdem::State<Law> before{};
    double slots[sizeof before / sizeof(double)];
    for (double& slot : slots) slot = number(r);
    std::memcpy(static_cast<void*>(&before), slots, sizeof before);
    const double R_star = n % 3 == 0 ? 1e-9 : n % 3 == 1 ? 0.01 : 10.0;
    const auto now = epdem::step(law, R_star, before, std::exp(-20.0 * std::abs(std::sin(n * 1.0))), 0.0);
    const bool pulls = epdem::adheres<Law> && std::isfinite(now.force);
    found += !(now.force >= 0.0 || pulls) || !(now.radius >= 0.0);
  }
  return found;
}

int main() {
#define COUNT(Class) std::printf("%s %d\\n", epdem::Class<double>::name, bad<epdem::Class<double>>());
  EPDEM_LAWS(COUNT)
}
"""


def test_any_finite_memory_gives_a_force_that_is_a_number_and_no_attraction(tmp_path):
    compiler = shutil.which("g++") or shutil.which("c++")
    if compiler is None:
        pytest.skip("no C++ compiler (apt-get install g++)")
    (tmp_path / "memory.cpp").write_text(PROGRAM)
    subprocess.run(
        [compiler, "-std=c++17", "-O2", f"-I{INCLUDE}", "memory.cpp", "-o", "memory"], cwd=tmp_path, check=True
    )
    found = subprocess.run(["./memory"], cwd=tmp_path, capture_output=True, text=True, check=True).stdout.split()
    assert {"hertz", "thornton", "johnson", "cavity"} <= set(found[::2]) and set(found[1::2]) == {"0"}
