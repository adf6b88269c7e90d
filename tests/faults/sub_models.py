# SPDX-License-Identifier: GPL-2.0-or-later
"""A new model of friction, rolling friction and cohesion: one header and one line in its list."""

from pathlib import Path

from workshop import LAWS

# A spring of half of the stiffness; a torque against the rotation; an attraction by R*.
HEADERS = {
    "friction": """#pragma once
#include "sliding.hpp"
namespace epdem {
struct ToyFriction {
  static constexpr const char* name = "ep/toy";
  static constexpr int id = 60, even_values = 0;
  static constexpr bool of_liggghts = false, adds_work = false;
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


def add_models(folder: Path) -> None:
    """Add the three models to a copy of the project."""
    models = folder / LAWS / "sub_models.hpp"
    text = models.read_text()
    for kind, header in HEADERS.items():
        (folder / LAWS / kind / "toy.hpp").write_text(header)
        assert text.count(LISTS[kind][0]) == 1
        text = text.replace(*LISTS[kind]).replace("#pragma once\n", f'#pragma once\n\n#include "{kind}/toy.hpp"', 1)
    models.write_text(text)
