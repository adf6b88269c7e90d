// SPDX-License-Identifier: GPL-2.0-or-later
// Entry of the library, which LAMMPS calls when it loads it: `plugin load epdemplugin.so`, or by itself from
// LAMMPS_PLUGIN_PATH.
#include <cstring>
#include <new>
#include <string>

#include "error.h"
#include "fix_heat.hpp"
#include "fix_motion.hpp"
#include "fix_slowing.hpp"
#include "fix_wall.hpp"
#include "fix_wall_mesh.hpp"
#include "pair_ep.hpp"

// GCC calls it where a container would be too large; the library of Linux systems before 2021 lacks it
namespace std {
void __throw_bad_array_new_length() { throw std::bad_array_new_length(); }
}  // namespace std

// library.h of LAMMPS; weak, because a LAMMPS that is linked statically may lack it
extern "C" [[gnu::weak]] int lammps_extract_setting(void* lmp, const char* keyword);

namespace {

/// LAMMPS's declaration of a style, which its installed headers lack.
struct Style {
  const char *version, *style, *name, *info, *author;
  void* create;
  void* handle;
};
using Register = void (*)(Style*, void*);

template <class Pair>
void* create_pair(void* lmp) {
  return new Pair(static_cast<LAMMPS_NS::LAMMPS*>(lmp));
}

template <class Fix>
void* create_fix(void* lmp, int count, char** word) {
  return new Fix(static_cast<LAMMPS_NS::LAMMPS*>(lmp), count, word);
}

void* create_compute(void* lmp, int count, char** word) {
  return new epdem::lammps::ComputeTriangles(static_cast<LAMMPS_NS::LAMMPS*>(lmp), count, word);
}

void* create_wall(void* lmp, int count, char** word) {
  const bool is_mesh = count > 3 && std::strcmp(word[3], "mesh") == 0;
  return (is_mesh ? create_fix<epdem::lammps::FixWallMesh> : create_fix<epdem::lammps::FixWallPlanes>)(lmp, count,
                                                                                                       word);
}

}  // namespace

extern "C" [[gnu::visibility("default")]] void lammpsplugin_init(void* pointer, void* handle, void* add) {
  auto* const lmp = static_cast<LAMMPS_NS::LAMMPS*>(pointer);
  const std::string build =
      "; build it for this one: make lammps LAMMPS_DIR=/its/build/folder in a checkout of epdem, else epdem export "
      "lammps --out DIR";
  if (lmp->num_ver != EPDEM_LAMMPS_VERSION)
    lmp->error->all(FLERR, "epdemplugin.so is built for LAMMPS " + std::to_string(EPDEM_LAMMPS_VERSION) +
                               " and this is LAMMPS " + std::to_string(lmp->num_ver) + build);
  if (lammps_extract_setting && (lammps_extract_setting(pointer, "tagint") != int(sizeof(LAMMPS_NS::tagint)) ||
                                 lammps_extract_setting(pointer, "bigint") != int(sizeof(LAMMPS_NS::bigint))))
    lmp->error->all(FLERR,
                    "epdemplugin.so is built for other sizes of integers than this LAMMPS has (LAMMPS_SIZES)" + build);
  const auto style = [&](const char* kind, const char* name, const char* info, void* create) {
    Style s{lmp->version, kind, name, info, "the epdem developers", create, handle};
    reinterpret_cast<Register>(add)(&s, pointer);
  };
  using namespace epdem::lammps;
  style("pair", PairEp::style_name, "elastic-plastic contacts (epdem " EPDEM_VERSION ")",
        reinterpret_cast<void*>(&create_pair<PairEp>));
  style("fix", FixHistory::style_name, "history of elastic-plastic contacts",
        reinterpret_cast<void*>(&create_fix<FixHistory>));
  style("fix", FixHeat::style_name, "heat of spheres", reinterpret_cast<void*>(&create_fix<FixHeat>));
  style("fix", FixMotion::style_name, "motion of spheres", reinterpret_cast<void*>(&create_fix<FixMotion>));
  style("fix", FixGravity::style_name, "gravity", reinterpret_cast<void*>(&create_fix<FixGravity>));
  style("fix", epdem::FixSlowing::style_name, "speed of walls near a force",
        reinterpret_cast<void*>(&create_fix<epdem::FixSlowing>));
  style("fix", FixTravel::style_name, "travel of walls", reinterpret_cast<void*>(&create_fix<FixTravel>));
  style("fix", FixWallPlanes::style_name, "elastic-plastic contacts with planes or triangles",
        reinterpret_cast<void*>(&create_wall));
  style("fix", FixWallRegion::style_name, "elastic-plastic contacts with a region",
        reinterpret_cast<void*>(&create_fix<FixWallRegion>));
  style("compute", ComputeTriangles::style_name, "stress and wear of triangles",
        reinterpret_cast<void*>(&create_compute));
}
