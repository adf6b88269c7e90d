// SPDX-License-Identifier: GPL-2.0-or-later
// The C interface: selects the law, checks the arguments, loops over contacts. It has no arithmetic.
#include "epdem.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "epdem/impact.hpp"
#include "epdem/laws.hpp"
#include "epdem/motion.hpp"
#include "epdem/oblique.hpp"
#include "epdem/range.hpp"

#define EPDEM_EXPORT extern "C" __attribute__((visibility("default")))

/// In long_double.cpp: arguments are already checked; false if the law does not exist.
bool epdem_long_double_batch(int law, double E_star, const double* parameters, size_t n, const epdem_impact_input* in,
                             epdem_impact_output* out);

namespace {

using namespace epdem;

bool positive(double x) { return std::isfinite(x) && x > 0.0; }

/// Whether the numbers are in the range of a law, each alone and together.
template <class Law>
bool in_range(double E_star, const double* parameters) {
  for (int k = 0; k < Law::n_parameters; ++k)
    if (!range_of(Law::parameters[k]).holds(parameters[k])) return false;
  const double share = parameters[Law::n_parameters];
  return positive(E_star) && share >= 0.0 && share <= 1.0 && Law::valid(parameters);
}

/// Calls `body(law object)` for the law of that index; only here an index becomes a type.
template <class Body>
int with_law(int index, double E_star, const double* parameters, const Body& body) {
  int i = 0;
#define EPDEM_CASE(Class)                                                                            \
  if (index == i++) {                                                                                \
    if (!in_range<Class<double>>(E_star, parameters)) return EPDEM_BAD_PARAMETER;                    \
    return body(law_of<Class<double>>(E_star, parameters, parameters[Class<double>::n_parameters])); \
  }
  EPDEM_LAWS(EPDEM_CASE)
#undef EPDEM_CASE
  return EPDEM_UNKNOWN_LAW;
}

bool sane(const epdem_impact_input& c) {
  return positive(c.R_star) && positive(c.m_star) && positive(c.speed) && positive(c.time_step) &&
         std::isfinite(c.gap) && c.steps >= 0 && std::isfinite(c.viscous) && c.viscous >= 0.0;
}

ImpactInput<double> input(const epdem_impact_input& c) {
  return {c.R_star, c.m_star, c.speed, c.time_step, c.gap, c.steps, c.viscous};
}

epdem_impact_output output(const ImpactOutput<double>& o) {
  return {o.rebound_speed, o.force_max, o.overlap_max, o.last_overlap, o.first, o.last, o.steps};
}

bool sane_friction(double G_star, double mu, int nodes) {
  return positive(G_star) && std::isfinite(mu) && mu >= 0.0 && (nodes == 0 || nodes == 2 || nodes == 3);
}

/// Calls `body` with the model of friction: partial slip with `nodes` nodes, or one spring.
template <class Body>
void with_friction(int nodes, const Body& body) {
  if (nodes == 2)
    body(PartialSlip<2>{});
  else if (nodes == 3)
    body(PartialSlip<3>{});
  else
    body(SlidingSpring{});
}

template <class Friction, class Law>
void move(const ContactConstants<Law>& pair, double R_star, size_t n, const double* m, double* out) {
  MovedContact<Friction, Law> contact(pair, R_star);
  for (size_t i = 0; i < n; ++i, m += 9, out += 4) {
    const auto [force, friction] = contact({m[0], m[1], {m[2], m[3], m[4]}, {m[5], m[6], m[7]}, m[8]});
    out[0] = force;
    out[1] = friction.x;
    out[2] = friction.y;
    out[3] = friction.z;
  }
}

static_assert(sizeof(epdem_impact_input) == sizeof(ImpactInput<double>), "the C struct mirrors the C++ one");
static_assert(sizeof(epdem_impact_output) == sizeof(ImpactOutput<double>), "the C struct mirrors the C++ one");

}  // namespace

EPDEM_EXPORT int epdem_abi(void) { return EPDEM_ABI; }
EPDEM_EXPORT const char* epdem_version(void) { return EPDEM_VERSION; }

EPDEM_EXPORT const char* epdem_message(int status) {
  switch (status) {
    case EPDEM_OK: return "ok";
    case EPDEM_UNKNOWN_LAW: return "no law of that index";
    case EPDEM_BAD_PARAMETER:
      return "E_star and every law parameter must be finite, > 0 and in the law's range, the share of curvature in [0, "
             "1]";
    case EPDEM_BAD_INPUT: return "R_star, m_star, speed and time_step must be finite and > 0, gap finite, steps >= 0";
    default: return "unknown status";
  }
}

EPDEM_EXPORT size_t epdem_size_of(const char* name) {
  if (!std::strcmp(name, "epdem_step_result")) return sizeof(epdem_step_result);
  if (!std::strcmp(name, "epdem_impact_input")) return sizeof(epdem_impact_input);
  if (!std::strcmp(name, "epdem_impact_output")) return sizeof(epdem_impact_output);
  return 0;
}

EPDEM_EXPORT double epdem_viscous_number(double restitution) {
  return restitution >= viscous_restitution_min && restitution <= 1.0 ? viscous_number(restitution) : std::nan("");
}

EPDEM_EXPORT int epdem_step(int law, double E_star, const double* parameters, size_t n, const double* R_star,
                            const double* delta_max, const double* delta, epdem_step_result* out) {
  if (!std::all_of(R_star, R_star + n, positive)) return EPDEM_BAD_INPUT;
  return with_law(law, E_star, parameters, [&](const auto& l) {
    for (size_t i = 0; i < n; ++i) {
      const auto now = step(l, R_star[i], remember(l, R_star[i], delta_max[i]), delta[i], 0.0);
      if constexpr (adheres<std::decay_t<decltype(l)>>)  // its memory is another
        out[i] = {now.force, now.radius, std::fmax(delta_max[i], delta[i])};
      else
        out[i] = {now.force, now.radius, now.after.delta_max};
    }
    return int(EPDEM_OK);
  });
}

EPDEM_EXPORT int epdem_backbone(int law, double E_star, const double* parameters, size_t n, const double* R_star,
                                const double* delta, double* force, double* radius, double* work,
                                double* plastic_work_out) {
  if (!std::all_of(R_star, R_star + n, positive)) return EPDEM_BAD_INPUT;
  return with_law(law, E_star, parameters, [&](const auto& l) {
    for (size_t i = 0; i < n; ++i) {
      const auto now = step(l, R_star[i], {}, delta[i], 0.0);
      force[i] = now.force;
      radius[i] = now.radius;
      work[i] = l.work(R_star[i], delta[i]);
      if constexpr (adheres<std::decay_t<decltype(l)>>)
        plastic_work_out[i] = losses(l, R_star[i], {}, now.after).plastic;
      else
        plastic_work_out[i] = plastic_work(l, R_star[i], delta[i]);
    }
    return int(EPDEM_OK);
  });
}

EPDEM_EXPORT int epdem_yield(int law, double E_star, const double* parameters, size_t n, const double* R_star,
                             const double* delta_max, double* yield_overlap, double* dent) {
  if (!std::all_of(R_star, R_star + n, positive)) return EPDEM_BAD_INPUT;
  return with_law(law, E_star, parameters, [&](const auto& l) {
    if constexpr (adheres<std::decay_t<decltype(l)>>) {
      return int(EPDEM_UNKNOWN_LAW);
    } else {
      for (size_t i = 0; i < n; ++i) {
        yield_overlap[i] = l.elastic_overlap(R_star[i]);
        dent[i] = residual_overlap(l, R_star[i], delta_max[i]);
      }
      return int(EPDEM_OK);
    }
  });
}

EPDEM_EXPORT int epdem_impacts(int law, double E_star, const double* parameters, size_t n, const epdem_impact_input* in,
                               epdem_impact_output* out, size_t stride, double* overlap, double* force,
                               double* velocity) {
  for (size_t i = 0; i < n; ++i) {
    const epdem_impact_input& c = in[i];
    const bool samples = overlap || force || velocity;
    if (!sane(c) || (samples && size_t(c.steps) + 1 > stride)) return EPDEM_BAD_INPUT;
  }
  return with_law(law, E_star, parameters, [&](const auto& l) {
    for (size_t i = 0; i < n; ++i) {
      const Path<double> path{overlap ? overlap + i * stride : nullptr, force ? force + i * stride : nullptr,
                              velocity ? velocity + i * stride : nullptr};
      out[i] = output(impact(l, input(in[i]), path));
    }
    return int(EPDEM_OK);
  });
}

EPDEM_EXPORT int epdem_oblique(int law, double E_star, const double* parameters, double G_star, double mu, int nodes,
                               size_t n, const epdem_impact_input* in, const double* slip, double* slip_after_out) {
  if (!sane_friction(G_star, mu, nodes)) return EPDEM_BAD_INPUT;
  for (size_t i = 0; i < n; ++i)
    if (!sane(in[i]) || !std::isfinite(slip[i])) return EPDEM_BAD_INPUT;
  return with_law(law, E_star, parameters, [&](const auto& l) {
    with_friction(nodes, [&](auto friction) {
      for (size_t i = 0; i < n; ++i)
        slip_after_out[i] = slip_after<decltype(friction)>(l, input(in[i]), {slip[i], G_star, mu});
    });
    return int(EPDEM_OK);
  });
}

EPDEM_EXPORT int epdem_motion(int law, double E_star, const double* parameters, double R_star, double G_star, double mu,
                              int nodes, size_t n, const double* motion, double* out) {
  if (!positive(R_star) || !sane_friction(G_star, mu, nodes)) return EPDEM_BAD_INPUT;
  for (size_t k = 0; k < 9 * n; ++k)
    if (!std::isfinite(motion[k])) return EPDEM_BAD_INPUT;
  return with_law(law, E_star, parameters, [&](const auto& l) {
    ContactConstants<std::decay_t<decltype(l)>> pair = of_law(l);
    pair.shear_modulus = G_star;
    pair.friction = mu;
    with_friction(nodes, [&](auto friction) { move<decltype(friction)>(pair, R_star, n, motion, out); });
    return int(EPDEM_OK);
  });
}

EPDEM_EXPORT int epdem_impacts_long_double(int law, double E_star, const double* parameters, size_t n,
                                           const epdem_impact_input* in, epdem_impact_output* out) {
  for (size_t i = 0; i < n; ++i)
    if (!sane(in[i])) return EPDEM_BAD_INPUT;
  return with_law(law, E_star, parameters, [&](const auto&) {  // with the checks of double
    return epdem_long_double_batch(law, E_star, parameters, n, in, out) ? int(EPDEM_OK) : int(EPDEM_UNKNOWN_LAW);
  });
}

EPDEM_EXPORT int epdem_bounces(int law, double E_star, const double* parameters, const epdem_impact_input* first,
                               int64_t count, epdem_impact_output* out, double* speeds) {
  if (!sane(*first) || count < 0) return EPDEM_BAD_INPUT;
  return with_law(law, E_star, parameters, [&](const auto& l) {
    *out = output(bounces(l, input(*first), count, speeds));
    return int(EPDEM_OK);
  });
}
