// SPDX-License-Identifier: BSD-3-Clause
// The models beside a law: a new one is its header and one line in its list. The first of each list is no model.
#pragma once

#include "cohesion/bond.hpp"
#include "cohesion/sjkr.hpp"
#include "cohesion/sjkr2.hpp"
#include "friction/partial_slip.hpp"
#include "friction/sliding_dashpot.hpp"
#include "friction/sliding_spring.hpp"
#include "rolling/constant_torque.hpp"
#include "rolling/rolling_spring.hpp"

namespace epdem {

namespace detail {

constexpr bool same_text(const char* a, const char* b) noexcept {
  while (*a && *a == *b) ++a, ++b;
  return *a == *b;
}

}  // namespace detail

/// The name of a model without the prefix ep/, which LIGGGHTS needs for models that it lacks.
constexpr const char* plain_name(const char* name) noexcept {
  return name[0] == 'e' && name[1] == 'p' && name[2] == '/' ? name + 3 : name;
}

template <class... Models>
struct List {
  static constexpr int size = sizeof...(Models);

  /// Calls f(model, place) for all of them.
  template <class F>
  EPDEM_INLINE static constexpr void each(F f) {
    int place = 0;
    (f(Models{}, place++), ...);
  }

  /// The place of the model with this id, -1: none.
  static constexpr int place(int id) noexcept {
    int at = 0, found = -1;
    ((Models::id == id ? void(found = at++) : void(++at)), ...);
    return found;
  }

  /// The place of the model with this name, with or without its prefix; -1: none.
  static constexpr int find(const char* name) noexcept {
    int at = 0, found = -1;
    const auto is = [name](const char* own) {
      return detail::same_text(name, own) || detail::same_text(name, plain_name(own));
    };
    ((is(Models::name) ? void(found = at++) : void(++at)), ...);
    return found;
  }
};

// clang-format off
using Frictions = List<
    NoFriction,
    SlidingDashpot,
    SlidingSpring,
    PartialSlip<3>,
    PartialSlip<2>>;

using Rollings = List<
    NoRolling,
    ConstantTorque,
    RollingSpring>;

using Cohesions = List<
    NoCohesion,
    Sjkr,
    Sjkr2,
    Bond>;
// clang-format on

/// The place of the bond in its list, the one cohesion that goes with compaction.
inline constexpr int bond_place = Cohesions::place(Bond::id);

/// Whether the model at this place of its list has a history.
template <class... Models>
EPDEM_INLINE constexpr bool has_history(List<Models...> list, int place) noexcept {
  bool found = false;
  list.each([&](auto model, int at) __attribute__((always_inline)) { found |= at == place && model.has_history; });
  return found;
}

}  // namespace epdem
