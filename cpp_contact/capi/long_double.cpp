// SPDX-License-Identifier: GPL-2.0-or-later
// The laws once more, in long double: the same statements and constants, so a difference to double is round-off.
#define EPDEM_REAL long double
#define epdem epdem_long_double  // a namespace of its own, or the linker would merge the functions of both precisions

#include "epdem/impact.hpp"
#include "epdem/laws.hpp"

#undef epdem
#include "epdem.h"

bool epdem_long_double_batch(int law, double E_star, const double* parameters, size_t n, const epdem_impact_input* in,
                             epdem_impact_output* out);

namespace {

using namespace epdem_long_double;

template <class Law>
bool batch(double E_star, const double* parameters, size_t n, const epdem_impact_input* in, epdem_impact_output* out) {
  static_assert(Law::n_parameters <= EPDEM_MAX_PARAMETERS, "raise EPDEM_MAX_PARAMETERS in epdem.h");
  real exact[EPDEM_MAX_PARAMETERS] = {};
  for (int k = 0; k < Law::n_parameters; ++k) exact[k] = parameters[k];
  const Law law(E_star, exact);
  for (size_t i = 0; i < n; ++i) {
    const epdem_impact_input& c = in[i];
    const ImpactOutput o = impact(law, {c.R_star, c.m_star, c.speed, c.time_step, c.gap, c.steps, c.viscous}, {});
    out[i] = {double(o.rebound_speed), double(o.force_max), double(o.overlap_max), double(o.last_overlap),
              o.first, o.last, o.steps};
  }
  return true;
}

}  // namespace

bool epdem_long_double_batch(int law, double E_star, const double* parameters, size_t n, const epdem_impact_input* in,
                             epdem_impact_output* out) {
  int i = 0;
#define EPDEM_CASE(Class) \
  if (law == i++) return batch<Class>(E_star, parameters, n, in, out);
  EPDEM_LAWS(EPDEM_CASE)
#undef EPDEM_CASE
  return false;
}
