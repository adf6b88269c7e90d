// SPDX-License-Identifier: GPL-2.0-or-later
// The normal models of all laws.
#include "law_model.hpp"
#include "model.hpp"

namespace epdem::liggghts {

std::unique_ptr<NormalModel> normal_model(LAMMPS_NS::LAMMPS* lmp, LIGGGHTS::IContactHistorySetup* setup, bool wall,
                                          int law, bool others_have_history) {
#define EPDEM_MAKE(Class) \
  if (law == Class<double>::id) return std::make_unique<LawModel<Class<double>>>(lmp, setup, wall, others_have_history);
  EPDEM_LAWS(EPDEM_MAKE)
#undef EPDEM_MAKE
  return nullptr;
}

}  // namespace epdem::liggghts
