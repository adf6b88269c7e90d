# SPDX-License-Identifier: GPL-2.0-or-later
"""Adding a model of friction, rolling friction or cohesion takes one header and one line in its list."""

import re
import sys

import numpy as np
import pytest
from workshop import LAWS, ROOT, build_plugin

sys.path.insert(0, str(ROOT / "tests" / "engines"))

from plugin_loop import SAID, SAID_OF_WALLS, Scene, outcome

pytestmark = pytest.mark.liggghts

# A spring of half of the stiffness; a torque against the rotation; an attraction by R*.
HEADERS = {
    "friction": """#pragma once
#include "sliding.hpp"
namespace epdem {
struct ToyFriction {
  static constexpr const char* name = "ep/toy";
  static constexpr int id = 60, even_values = 0;
  static constexpr bool of_liggghts = false, books_work = false;
  template <class T>
  struct History {
    Vec<T> stretch;
  };
  template <bool flattens, class T, class Observer>
  EPDEM_INLINE static Vec<T> force(const Sliding<T>& s, History<T>& history, Observer&&) noexcept {
    const Vec<T> stretch = history.stretch + s.slip, spring = (-0.5 * s.k_t) * stretch;
    const T most = s.mu * fabs(s.pressed.load), pull = length(spring);
    history.stretch = select(pull > most, (most / pull) * stretch, stretch);
    return select(pull > most, (most / pull) * spring, spring);
  }
};
}  // namespace epdem
""",
    "rolling": """#pragma once
#include "rolling.hpp"
namespace epdem {
struct ToyRolling {
  static constexpr const char* name = "ep/toy";
  static constexpr int id = 60;
  static constexpr bool of_liggghts = false, has_history = false;
  template <bool wall, class T>
  EPDEM_INLINE static Vec<T> torque(const Rolling<T>& r, Vec<T>&) noexcept {
    return (1e-3 * r.friction * r.load * r.R_star) * r.rotation;
  }
};
}  // namespace epdem
""",
    "cohesion": """#pragma once
#include "cohesion.hpp"
namespace epdem {
struct ToyCohesion {
  static constexpr const char* name = "ep/toy";
  static constexpr int id = 60;
  static constexpr bool of_liggghts = false;
  static constexpr double area_ratio = 1.0;
  template <bool wall, class T>
  EPDEM_INLINE static T force(const Kinematics<T>& c, T density) noexcept {
    return -density * c.R_star * c.overlap;
  }
};
}  // namespace epdem
""",
}
LISTS = {
    "friction": ("    SlidingSpring,\n", "    SlidingSpring,\n    ToyFriction,\n"),
    "rolling": ("    ConstantTorque,\n", "    ConstantTorque,\n    ToyRolling,\n"),
    "cohesion": ("    Sjkr,\n", "    Sjkr,\n    ToyCohesion,\n"),
}


@pytest.fixture(scope="module")
def launcher(copy):
    """LIGGGHTS with a new model of each kind."""
    models = copy / LAWS / "sub_models.hpp"
    text = models.read_text()
    for kind, header in HEADERS.items():
        (copy / LAWS / kind / "toy.hpp").write_text(header)
        assert text.count(LISTS[kind][0]) == 1
        text = text.replace(*LISTS[kind]).replace("#pragma once\n", f'#pragma once\n\n#include "{kind}/toy.hpp"', 1)
    models.write_text(text)
    return str(build_plugin(copy, "-O0"))


@pytest.mark.parametrize("kind", [{"tangential": "ep/toy"}, {"rolling": "ep/toy"}, {"cohesion": "ep/toy"}], ids=str)
def test_a_new_model_runs_in_both_loops_with_the_same_bits(launcher, tmp_path, kind):
    scene = Scene(**{"rolling": "epsd2", "types": 3, "loose": True, "walls": True} | kind)
    ours, said = outcome(tmp_path / "ours", scene, command=launcher)
    theirs, _ = outcome(tmp_path / "generic", scene, loop="generic", command=launcher)
    assert SAID not in said and SAID_OF_WALLS not in said
    assert np.array_equal(ours, theirs)
    without = Scene(**vars(scene) | {"settings": ()} | {name: "off" for name in kind})
    assert not np.array_equal(ours, outcome(tmp_path / "without", without, command=launcher)[0])


def test_the_manual_says_what_this_test_does():
    section = ROOT.joinpath("ARCHITECTURE.md").read_text().split("## Add a sub-model")[1].split("## ")[0]
    assert all(re.search(rf"`{kind}/`", section) for kind in HEADERS) and "`sub_models.hpp`" in section
