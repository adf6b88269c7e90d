// SPDX-License-Identifier: GPL-2.0-or-later
// One normal impact of two bodies by velocity Verlet, as a DEM engine integrates it: the embedded engine.
#pragma once

#include <cstdint>

#include "law.hpp"

namespace epdem {

/// One impact: the relative approach obeys m* alpha'' = -F.
struct ImpactInput {
  double R_star;         // [m]
  double m_star;         // [kg]
  double speed;          // approach speed [m/s]
  double time_step;      // [s]
  double gap;            // distance before first touch [m]; the phase of the impact is gap/(speed time_step)
  std::int64_t steps;  // at most so many steps are taken
};

struct ImpactOutput {
  double rebound_speed;            // [m/s]
  double force_max, overlap_max;   // largest sampled values [N], [m]
  double last_overlap;             // overlap at the last loaded sample [m]
  std::int64_t first, last;      // first and last step with a force
  std::int64_t steps;            // steps taken
};

/// Samples of the path, written if the pointers are set; room for steps + 1 values each.
struct Path {
  double* overlap = nullptr;   // [m], negative while apart
  double* force = nullptr;     // [N]
  double* velocity = nullptr;  // of approach [m/s]
};

/// Integrates until the bodies have parted (no force for two steps after contact) or `steps` is reached.
template <class Law>
inline ImpactOutput impact(const Law& law, const ImpactInput& in, const Path& path) noexcept {
  const double half = 0.5 * in.time_step / in.m_star;
  State<Law> state{};
  double alpha = -in.gap, v = in.speed, force = 0.0;
  ImpactOutput out{in.speed, 0.0, 0.0, 0.0, -1, -1, 0};
  std::int64_t n = 0;
  for (;; ++n) {
    const Step<Law> now = step(law, in.R_star, state, alpha);
    if (n > 0) v -= half * now.force;
    force = now.force;
    state = now.after;
    if (path.overlap) path.overlap[n] = alpha;
    if (path.force) path.force[n] = force;
    if (path.velocity) path.velocity[n] = v;
    if (force > 0.0) {
      if (out.first < 0) out.first = n;
      out.last = n;
      out.last_overlap = alpha;
      if (force > out.force_max) out.force_max = force;
      if (alpha > out.overlap_max) out.overlap_max = alpha;
    } else if (out.last >= 0 && n > out.last + 1) {
      break;
    }
    if (n == in.steps) break;
    v -= half * force;
    alpha += in.time_step * v;
  }
  out.rebound_speed = -v;
  out.steps = n;
  return out;
}

}  // namespace epdem
