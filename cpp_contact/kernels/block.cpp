// SPDX-License-Identifier: GPL-2.0-or-later
#include "kernels/block.hpp"

#include <cstring>

#include "epdem/contact.hpp"
#include "epdem/laws.hpp"

namespace epdem::kernels {

const Kernels* kernels_of(const char* name) {
  const auto wanted = [name](const char* set) { return !*name || std::strcmp(name, set) == 0; };
#if defined __x86_64__
  __builtin_cpu_init();
  const bool avx512 =
      __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
  if (avx512 && wanted("avx512")) return &kernels_avx512;
  if (__builtin_cpu_supports("avx2") && wanted("avx2")) return &kernels_avx2;
#endif
  return wanted("sse2") ? &kernels_sse2 : nullptr;
}

namespace {

template <class Law, bool wall>
bool closes(const Gap& gap) {
  ContactConstants<Law> pair;
  std::memcpy(static_cast<void*>(&pair), gap.constants, sizeof pair);
  Growing<wall, double> c{gap.radius_i, gap.radius_j, {gap.sums_i[0], gap.sums_i[1]}, {}, {}, {}};
  if constexpr (!wall) c.j = {gap.sums_j[0], gap.sums_j[1]};
  State<Law> before{};
  if (gap.history) {
    std::memcpy(static_cast<void*>(&before), gap.history, sizeof before);
    std::memcpy(static_cast<void*>(&c.state), gap.growth, sizeof c.state);
  }
  const double R_star = wall ? gap.radius_i : reduced_finite(gap.radius_i, gap.radius_j);
  return epdem::closes_gap(pair.law, pair.bodies, R_star, before, c, gap.overlap, gap.repeats);
}

template <class Law>
bool closes_of(int law, const Gap& gap) {
  if constexpr (compacts<Law>)
    if (law == detail::place<Law>()) return gap.sums_j ? closes<Law, false>(gap) : closes<Law, true>(gap);
  return false;
}

}  // namespace

bool closes_gap(int law, const Gap& gap) {
#define EPDEM_CLOSES(Class) \
  if (closes_of<Class<double>>(law, gap)) return true;
  EPDEM_LAWS(EPDEM_CLOSES)
#undef EPDEM_CLOSES
  return false;
}

void pad(Block& b, int n) {
  for (int k = n; k < n + most_lanes; ++k) {
    b.i[k] = b.i[0];
    b.j[k] = b.j[0];
    b.history[k] = b.unused_history;
    b.material[k] = b.material[0];
    b.radius_i.a[k] = b.radius_j.a[k] = b.mass_i.a[k] = b.mass_j.a[k] = 1.0;
  }
}

}  // namespace epdem::kernels
