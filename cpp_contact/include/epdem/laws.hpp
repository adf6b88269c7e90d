// SPDX-License-Identifier: BSD-3-Clause
// The register of laws: a new law is its header and a line at the end of this list, whose order numbers the laws of the
// C interface and of LIGGGHTS-PFM. X(class template)
#pragma once

#include "cavity.hpp"
#include "cavity_adhesive.hpp"
#include "hertz.hpp"
#include "jkr.hpp"
#include "johnson.hpp"
#include "law.hpp"
#include "meyer.hpp"
#include "thornton.hpp"
#include "thornton_ning.hpp"

#define EPDEM_LAWS(X) \
  X(Hertz)            \
  X(Thornton)         \
  X(Johnson)          \
  X(Cavity)           \
  X(Jkr)              \
  X(ThorntonNing)     \
  X(Meyer)            \
  X(CavityAdhesive)

namespace epdem::detail {

#define EPDEM_ID(Class) Class<double>::id,
inline constexpr int law_ids[] = {EPDEM_LAWS(EPDEM_ID)};
#undef EPDEM_ID

constexpr bool ids_fit() noexcept {
  for (const int& id : law_ids) {
    if (id < 1 || id > 62) return false;  // six bits of LIGGGHTS's hash code; 63 marks a name that is not epdem's
    for (const int* other = law_ids; other != &id; ++other)
      if (*other == id) return false;
  }
  return true;
}
static_assert(ids_fit(), "every law needs its own id from 1 to 62");

/// A law's place in the register.
template <class Law>
constexpr int place() noexcept {
  int at = 0;
  while (law_ids[at] != Law::id) ++at;
  return at;
}

template <class Law>
constexpr bool sound() noexcept {
  static_assert(sizeof(State<Law>) == sizeof(double[std::size(State<Law>::slots)]), "name every slot of the memory");
  static_assert(Law::strength < Law::n_parameters, "the strength is one of the parameters");
  static_assert(Law::strength >= 0 || !Law::strength_by_ratio, "no strength, no ratio");
  return sizeof(Law) % sizeof(double) == 0;
}
#define EPDEM_CHECK(Class) static_assert(sound<Class<double>>(), "a law's data are numbers of type T only");
EPDEM_LAWS(EPDEM_CHECK)
#undef EPDEM_CHECK

}  // namespace epdem::detail

namespace epdem {

/// The name of the law that a law with adhesion is for a work of adhesion of 0; nullptr of a law without adhesion.
template <class Law>
constexpr const char* without_adhesion() noexcept {
  if constexpr (adheres<Law>)
    return Law::without_adhesion;
  else
    return nullptr;
}

}  // namespace epdem
