# SPDX-License-Identifier: GPL-2.0-or-later
"""Adding a law takes three places, as ARCHITECTURE.md says: a header, its line in the register, a theory class."""

import re

import pytest
from workshop import LAWS, PYTHON, build_library

from epdem.base.declarations import declarations

# A toy: thornton with a plastic line of 4/5 of its slope.
HEADER = """// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "backbone.hpp"

namespace epdem {

template <class T>
struct Toy {
  using number = T;
  static constexpr const char* name = "toy";
  static constexpr int id = 62;
  static constexpr const char* title = "elastic, then 4/5 of the plastic slope";
  static constexpr const char* sources = "Thornton 1997";
  static constexpr const char* condition = nullptr;
  using State = Maximum<T>;
  static constexpr bool yields = true;
  static constexpr bool flattens = false;
  static constexpr Parameter parameters[] = {
      {"yield_pressure", "yieldPressure", "p_y", "Pa", not_given}};
  static constexpr int n_parameters = 1;
  static constexpr int strength = 0;
  static constexpr double default_ratio = 2.8;
  static constexpr bool strength_by_ratio = true;

  T E_star{}, p_y{};

  static bool valid(const T*) noexcept { return true; }

  Toy() noexcept = default;
  Toy(T E_star_, const T* parameter) noexcept : E_star(E_star_), p_y(parameter[0]) {}

  T elastic_overlap(T R_star) const noexcept {
    const T q = pi * p_y / (2.0 * E_star);
    return q * q * R_star;
  }
  Point<T> load(T R_star, T delta) const noexcept {
    const T y = elastic_overlap(R_star), a = sqrt(R_star * delta);
    return {hertz_point(E_star, R_star, y).force + 0.8 * pi * p_y * R_star * (delta - y), a, T{}};
  }
  T work(T R_star, T delta) const noexcept {
    const T y = elastic_overlap(R_star), x = max(T{}, delta - y);
    const T mean = hertz_point(E_star, R_star, y).force + 0.4 * pi * p_y * R_star * x;
    return hertz_work(E_star, R_star, min(delta, y)) + mean * x;
  }
};

}  // namespace epdem
"""
THEORY = """# SPDX-License-Identifier: GPL-2.0-or-later
\"\"\"The toy law.\"\"\"

import numpy as np

from .backbone import Backbone


class Toy(Backbone):
    \"\"\"A toy law: thornton with 4/5 of its plastic slope.\"\"\"

    name = "toy"

    def __init__(self, *, E_star, R_star, p_y):
        super().__init__(E_star, R_star)
        (self.p_y,) = self.read_parameters(p_y=p_y)
        self.yield_overlap = self.R_star * (np.pi * self.p_y / (2 * self.E_star)) ** 2

    def radius(self, alpha):
        return np.sqrt(self.R_star * alpha)

    def force(self, alpha):
        y = self.yield_overlap
        line = self._hertz_force(y) + 0.8 * np.pi * self.p_y * self.R_star * (alpha - y)
        return np.where(alpha <= y, self._hertz_force(np.minimum(alpha, y)), line)

    def work(self, alpha):
        y, x = self.yield_overlap, np.maximum(alpha - self.yield_overlap, 0)
        plastic = self._hertz_force(y) * x + 0.4 * np.pi * self.p_y * self.R_star * x * x
        return self._hertz_work(np.minimum(alpha, y)) + plastic
"""
# What a person meets: decks of both engines, their explanation, tables and pages.
COMMANDS = """# SPDX-License-Identifier: GPL-2.0-or-later
import importlib.util
import json
import subprocess
import sys

import pytest
from typer.testing import CliRunner

from epdem.case.toml import read_toml
from epdem.cli.main import app
from epdem.theory.backbones import LAWS

CASES = ["steel_wall", "settle_glass"]


def of_toy(name, folder):
    text = open(f"cases/{name}.toml").read()
    path = folder / "case.toml"
    path.write_text(text.replace('name = "thornton"', 'name = "toy"'))
    assert read_toml(path)["law"]["name"] == "toy"
    return path


@pytest.fixture(params=CASES)
def case(request, tmp_path):
    return of_toy(request.param, tmp_path)


def command(*words):
    return CliRunner().invoke(app, list(map(str, words)), catch_exceptions=False)


def test_a_deck_has_the_model_and_one_number_of_memory(case, tmp_path):
    assert command("deck", case, "--out", tmp_path / "deck").exit_code == 0
    text = "".join(p.read_text() for pattern in ("*.in*", "in.*") for p in (tmp_path / "deck").glob(pattern))
    assert "pair_style gran model ep/toy " in text and "yieldPressure peratomtype" in text
    assert "newton off" in text


def test_every_line_has_its_reason(case, tmp_path):
    assert command("deck", case, "--reasons", "--out", tmp_path / "deck").exit_code == 0
    text = "".join(p.read_text() for pattern in ("*.in", "in.*") for p in (tmp_path / "deck").glob(pattern))
    lines = [line for line in text.splitlines() if line[:1] not in ("", "#")]
    assert any("ep/toy" in line for line in lines) and all("  # " in line for line in lines)


def test_a_deck_of_yade_has_the_law_in_its_copy_of_the_library(tmp_path):
    case = of_toy("steel_wall", tmp_path)
    assert command("deck", case, "--engine", "yade", "--out", tmp_path / "deck").exit_code == 0
    (script,) = (tmp_path / "deck").glob("*.py")
    assert '"toy",' in script.read_text()
    library = tmp_path / "deck/epdem/yade/deck_modules/libepdem.so"
    text = f"import ctypes; f = ctypes.CDLL('{library}').epdem_declarations; "
    text += "f.restype = ctypes.c_char_p; print(f().decode())"
    done = subprocess.run([sys.executable, "-S", "-c", text], capture_output=True)
    assert "toy" in [law["name"] for law in json.loads(done.stdout)], done.stderr


def test_the_tables_and_the_reference_have_the_law(case):
    found = json.loads(command("predict", "--material", "steel", "--json").output)
    assert "toy" in [prediction["law"] for prediction in found]
    assert "law toy, Thornton 1997" in command("cite", case).output
    place = importlib.util.spec_from_file_location("guide", "docs/guide.py")
    guide = importlib.util.module_from_spec(place)
    place.loader.exec_module(guide)
    assert "| toy | `law.yield_pressure` | p_y | (0, inf) Pa | 2.8 times the yield stress |" in guide.laws()
"""


@pytest.mark.faults
def test_a_new_law_passes_the_battery_and_lands_on_its_theory(copy, tests_of_copy):
    (copy / LAWS / "toy.hpp").write_text(HEADER)
    register = copy / LAWS / "laws.hpp"
    text = register.read_text().replace('#include "thornton.hpp"', '#include "thornton.hpp"\n#include "toy.hpp"')
    text, n = re.subn(r"(  X\(ThorntonNing\))", r"\1 \\\n  X(Toy)", text)
    assert n == 1
    register.write_text(text)
    (copy / PYTHON / "theory" / "toy.py").write_text(THEORY)
    build_library(copy)
    others = " or ".join(sorted(declarations()))  # the tests of the others are those of every run
    done = tests_of_copy.run(
        "tests/battery", only=f"not (liggghts or adhesive or finite_strain) and (toy or not ({others}))"
    )
    assert done.returncode == 0, done.stdout[-3000:]
    done = tests_of_copy.run("tests/engines/test_laws.py", only="toy and embedded")
    assert done.returncode == 0, done.stdout[-3000:]
    assert "2 passed" in done.stdout  # restitution, dashpot
    (copy / "tests/decks/test_toy.py").write_text(COMMANDS)
    done = tests_of_copy.run("tests/decks/test_toy.py")
    assert done.returncode == 0, done.stdout[-3000:]
    assert "7 passed" in done.stdout
