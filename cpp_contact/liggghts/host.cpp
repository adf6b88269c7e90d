// SPDX-License-Identifier: GPL-2.0-or-later
#include "host.hpp"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <limits>
#include <string>

#include "atom.h"
#include "domain.h"
#include "epdem/laws.hpp"
#include "library.h"
#include "universe.h"

#ifdef EPDEM_BUILT_FOR
#include <dlfcn.h>
#endif

namespace epdem::liggghts {

namespace {

#ifdef EPDEM_BUILT_FOR  // as the library said when this was built; in a source tree all is built at once

constexpr const char* built_for = EPDEM_BUILT_FOR;
#ifdef SUPERQUADRIC_ACTIVE_FLAG
constexpr bool superquadrics = true;
#else
constexpr bool superquadrics = false;
#endif

/// The library carries no symbol versions: compare its version, where it says that two members lie, and whether it has
/// superquadrics, with which a contact has 392 bytes and without 368.
bool has_superquadrics() { return dlsym(RTLD_DEFAULT, "_ZTVN9LAMMPS_NS19AtomVecSuperquadricE") != nullptr; }

bool compare_library(LAMMPS_NS::LAMMPS* lmp) {
  const auto found_at = [lmp](const char* name, const void* here) {
    return lammps_extract_global(lmp, const_cast<char*>(name)) == here;
  };
  return strcasestr(lmp->universe->version, built_for) && found_at("dt", &lmp->update->dt) &&
         found_at("boxxlo", &lmp->domain->boxlo[0]) && has_superquadrics() == superquadrics;
}

void refuse_library(LAMMPS_NS::LAMMPS* lmp) {
  const std::string text = std::string("epdem was built for ") + built_for +
                           (superquadrics ? " with superquadrics" : "") + ", but the library in use says \"" +
                           lmp->universe->version + "\"" + (has_superquadrics() ? " and has superquadrics" : "") +
                           " or has another memory layout; build epdem on this machine";
  lmp->error->all(FLERR, text.c_str());
}

#else

bool compare_library(LAMMPS_NS::LAMMPS*) { return true; }
void refuse_library(LAMMPS_NS::LAMMPS*) {}

#endif

}  // namespace

bool library_matches(LAMMPS_NS::LAMMPS* lmp) {
  static const bool matches = compare_library(lmp);  // a program has one library
  return matches;
}

void check_host(LAMMPS_NS::LAMMPS* lmp) {
  // error->one ends in MPI_Abort without flushing: on a pipe or in a file the message would be lost
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  if (!library_matches(lmp)) refuse_library(lmp);
}

bool only_spheres(LAMMPS_NS::LAMMPS* lmp) {
  return lmp->atom->sphere_flag && !lmp->atom->superquadric_flag && !lmp->atom->shapetype_flag;
}

std::vector<double> smallest_radii(LAMMPS_NS::LAMMPS* lmp) {
  std::vector<double> least(lmp->atom->ntypes + 1, std::numeric_limits<double>::infinity());
  for (int i = 0; i < lmp->atom->nlocal; ++i) {
    double& smallest = least[lmp->atom->type[i]];
    smallest = std::min(smallest, lmp->atom->radius[i]);
  }
  for (int k = 0; k < lmp->modify->nfix; ++k)
    for (int type = 1; type <= lmp->atom->ntypes; ++type) {
      const double added = lmp->modify->fix[k]->min_rad(type);
      if (added > 0.0) least[type] = std::min(least[type], added);
    }
  std::vector<double> everywhere = least;
  MPI_Allreduce(least.data(), everywhere.data(), static_cast<int>(least.size()), MPI_DOUBLE, MPI_MIN, lmp->world);
  return everywhere;
}

void register_contact_distance(LAMMPS_NS::LAMMPS* lmp, double factor) {
  lmp->neighbor->register_contact_dist_factor(factor);
}

std::string model_names() {
  std::string names;
#define EPDEM_NAME(Class) names += " " + model_name<Class<double>>();
  EPDEM_LAWS(EPDEM_NAME)
#undef EPDEM_NAME
  return names;
}

}  // namespace epdem::liggghts
