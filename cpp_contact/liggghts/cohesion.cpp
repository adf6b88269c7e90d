// SPDX-License-Identifier: GPL-2.0-or-later
#include "reader.hpp"
#include "simulation.hpp"

namespace epdem::liggghts {

void compare_cohesion(LAMMPS_NS::LAMMPS* lmp, const std::string& model, int width, const std::vector<double>& resists) {
  auto* const density = static_cast<FixPropertyGlobal*>(lmp->modify->find_fix_property(
      "cohesionEnergyDensity", "property/global", "peratomtypepair", width - 1, width - 1, model.c_str(), false));
  if (!density) return;  // LIGGGHTS says so
  for (int i = 1; i < width; ++i)
    for (int j = i; j < width; ++j) {
      const double pull = density->compute_array(i - 1, j - 1), most = resists[i * width + j];
      if (!(pull > most)) continue;
      const std::string text = "model " + model + ": cohesionEnergyDensity = " + number(pull) + " of " + both(i, j) +
                               " pulls contacts in harder than they resist: above " + number(most) +
                               " the spheres collapse";
      if (Simulation::of(lmp).is_new(text) && lmp->comm->me == 0) lmp->error->warning(FLERR, text.c_str());
      return;
    }
}

}  // namespace epdem::liggghts
