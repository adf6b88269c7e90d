// SPDX-License-Identifier: GPL-2.0-or-later
// The register of laws: a new law is its header above this list and one line in it.
#pragma once

#include "cavity.hpp"
#include "hertz.hpp"
#include "johnson.hpp"
#include "law.hpp"
#include "thornton.hpp"

#define EPDEM_LAWS(X) \
  X(Hertz)            \
  X(Thornton)         \
  X(Johnson)          \
  X(Cavity)

namespace epdem::detail {

#define EPDEM_ID(Class) Class::id,
inline constexpr int law_ids[] = {EPDEM_LAWS(EPDEM_ID)};
#undef EPDEM_ID

constexpr bool ids_fit() noexcept {
  for (const int& id : law_ids) {
    if (id < 1 || id > 62) return false;  // six bits of LIGGGHTS's hash code; 63 marks a name that is none of ours
    for (const int* other = law_ids; other != &id; ++other)
      if (*other == id) return false;
  }
  return true;
}
static_assert(ids_fit(), "every law needs an id of its own from 1 to 62");

#define EPDEM_CHECK(Class)                                                                               \
  static_assert(sizeof(State<Class>) == std::size(State<Class>::slots) * sizeof(real), "name every slot"); \
  static_assert(Class::strength < Class::n_parameters, "the strength is one of the parameters");           \
  static_assert(Class::strength >= 0 || !Class::strength_by_ratio, "no strength, no ratio");
EPDEM_LAWS(EPDEM_CHECK)
#undef EPDEM_CHECK

}  // namespace epdem::detail
