# SPDX-License-Identifier: GPL-2.0-or-later
"""Adding a law takes what ARCHITECTURE.md says: one header, one line of registration, one theory class."""

import re

from workshop import LAWS, PYTHON, ROOT, build, pytest_in

# A toy: linear plastic flow at 3/2 of Hertz's force at yield, alpha_y = 1e-4 of R*, no parameter but a strength.
HEADER = """// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include "johnson.hpp"
namespace epdem {
struct Toy : Johnson {
  static constexpr const char* name = "toy";
  using Johnson::Johnson;
};
}  // namespace epdem
"""
THEORY = """

class Toy(Johnson):
    \"\"\"A toy law: johnson under another name.\"\"\"

    name = "toy"


LAWS["toy"] = Toy
"""


def test_the_manual_says_what_this_test_does():
    section = ROOT.joinpath("ARCHITECTURE.md").read_text().split("## Add a law")[1].split("## ")[0]
    for place in ("laws.hpp", "theory/backbones.py", "X(Toy, toy, 44)"):
        assert place in section
    assert len(section.strip().splitlines()) <= 16


def test_a_new_law_passes_the_battery_and_lands_on_its_theory(copy):
    (copy / LAWS / "toy.hpp").write_text(HEADER)
    register = copy / LAWS / "laws.hpp"
    text = register.read_text().replace('#include "thornton.hpp"', '#include "thornton.hpp"\n#include "toy.hpp"')
    text, n = re.subn(r"(  X\(Cavity, cavity, 43\))", r"\1 \\\n  X(Toy, toy, 44)", text)
    assert n == 1
    register.write_text(text)
    backbones = copy / PYTHON / "theory" / "backbones.py"
    backbones.write_text(backbones.read_text() + THEORY)
    laws = copy / "tests/battery/laws.py"  # the battery's own knowledge of where a law yields
    laws.write_text(laws.read_text().replace('"johnson": 3 * strength', '"johnson": 3 * strength, "toy": 3 * strength'))
    build(copy, plugin=False)
    done = pytest_in(copy, "tests/battery", "not liggghts")
    assert done.returncode == 0, done.stdout[-3000:]
    done = pytest_in(copy, "tests/engines/test_laws.py", "toy and embedded")
    assert "4 passed" in done.stdout or "2 passed" in done.stdout, done.stdout[-3000:]
