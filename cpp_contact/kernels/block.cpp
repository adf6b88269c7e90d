// SPDX-License-Identifier: BSD-3-Clause
#include "kernels/block.hpp"

#include <cstdlib>
#include <cstring>

#include "kernels/gather.hpp"

namespace epdem::kernels {

namespace {

/// An empty name: the widest set.
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

}  // namespace

const Kernels* chosen_kernels(std::string& refusal) {
  const char* const set = std::getenv("EPDEM_SIMD");
  const Kernels* const found = kernels_of(set ? set : "");
  if (!found)
    refusal = std::string("EPDEM_SIMD = ") + set +
              ": this processor has no such instructions; leave it unset, or take sse2, avx2 or avx512";
  return found;
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
