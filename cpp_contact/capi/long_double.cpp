// SPDX-License-Identifier: GPL-2.0-or-later
// The laws on long double: the same statements and constants, so that a difference to double is round-off.
#include "epdem.h"
#include "epdem/impact.hpp"
#include "epdem/laws.hpp"

bool epdem_long_double_batch(int law, double E_star, const double* parameters, size_t n, const epdem_impact_input* in,
                             epdem_impact_output* out);

namespace {

template <class Law>
bool batch(double E_star, const double* parameters, size_t n, const epdem_impact_input* in, epdem_impact_output* out) {
  static_assert(Law::n_parameters <= EPDEM_MAX_PARAMETERS, "raise EPDEM_MAX_PARAMETERS in epdem.h");
  long double exact[EPDEM_MAX_PARAMETERS] = {};
  for (int k = 0; k < Law::n_parameters; ++k) exact[k] = parameters[k];
  const Law law = epdem::law_of<Law>(E_star, exact, parameters[Law::n_parameters]);
  for (size_t i = 0; i < n; ++i) {
    const epdem_impact_input& c = in[i];
    const auto o = epdem::impact(law, {c.R_star, c.m_star, c.speed, c.time_step, c.gap, c.steps, c.viscous}, {});
    out[i] = {double(o.rebound_speed),
              double(o.force_max),
              double(o.overlap_max),
              double(o.last_overlap),
              o.first,
              o.last,
              o.steps};
  }
  return true;
}

}  // namespace

bool epdem_long_double_batch(int law, double E_star, const double* parameters, size_t n, const epdem_impact_input* in,
                             epdem_impact_output* out) {
  int i = 0;
#define EPDEM_CASE(Class) \
  if (law == i++) return batch<epdem::Class<long double>>(E_star, parameters, n, in, out);
  EPDEM_LAWS(EPDEM_CASE)
#undef EPDEM_CASE
  return false;
}
