// SPDX-License-Identifier: GPL-2.0-or-later
// Makes the laws known to LIGGGHTS when the library (or the launcher) is loaded.
#include <string>
#include <utility>

#include "epdem/laws.hpp"
#include "loop/pair.hpp"
#include "loop/wall.hpp"
#include "model.hpp"
#include "partial_slip.hpp"

namespace epdem::liggghts {

namespace {

using LAMMPS_NS::FixWallGran;
using LAMMPS_NS::LAMMPS;
using LAMMPS_NS::PairGran;
namespace PairStyles = LIGGGHTS::PairStyles;
namespace Walls = LIGGGHTS::Walls;

// every model that this LIGGGHTS has, from its own lists
#define TANGENTIAL_MODEL(name, text, id) name,
#define COHESION_MODEL(name, text, id) name,
#define ROLLING_MODEL(name, text, id) name,
#define SURFACE_MODEL(name, text, id) name,
constexpr int tangentials[] = {
    TANGENTIAL_OFF,
#include "style_tangential_model.h"
    TANGENTIAL_PARTIAL_SLIP,
    TANGENTIAL_PARTIAL_SLIP_2,
};
constexpr int cohesions[] = {
    COHESION_OFF,
#include "style_cohesion_model.h"
};
constexpr int rollings[] = {
    ROLLING_OFF,
#include "style_rolling_model.h"
};
constexpr int surfaces[] = {
#include "style_surface_model.h"
};
#undef TANGENTIAL_MODEL
#undef COHESION_MODEL
#undef ROLLING_MODEL
#undef SURFACE_MODEL
constexpr const char* partial_slip_names[] = {"ep/partial_slip", "ep/partial_slip_2"};
constexpr int unknown_law = 63;  // normal id of what is refused: by its name, or for its tangential model

/// Why, as the tangential id of a refusal.
enum Refusal { unknown_normal, unknown_tangential, foreign_normal };

/// Luding's models need slots of Luding's normal model; capillary forces and superquadrics bring their own contact law.
bool available(const Ids& ids) {
  return (ids.tangential <= TANGENTIAL_HISTORY || slip_nodes(ids.tangential) > 0) && ids.rolling <= ROLLING_EPSD3 &&
         ids.cohesion <= COHESION_SJKR2 && (ids.surface == SURFACE_DEFAULT || ids.surface == SURFACE_MULTICONTACT);
}

template <class Part>
std::shared_ptr<Part> make(const Site& s) {
  return std::make_shared<Part>(s.lmp, s.history, s.contact);
}

template <int nodes>
std::shared_ptr<TangentialModelBase> partial_slip_model(const Site& s) {
  if (s.normal->flattens) return std::make_shared<PartialSlip<nodes, true>>(s);
  return std::make_shared<PartialSlip<nodes, false>>(s);
}

}  // namespace

std::shared_ptr<SurfaceModelBase> surface_model(const Site& s) {
  if (s.ids.surface == SURFACE_MULTICONTACT) return make<SurfaceModel<SURFACE_MULTICONTACT>>(s);
  return make<SurfaceModel<SURFACE_DEFAULT>>(s);
}

std::shared_ptr<CohesionModelBase> cohesion_model(const Site& s) {
  if (s.ids.cohesion == COHESION_SJKR) return make<CohesionModel<COHESION_SJKR>>(s);
  if (s.ids.cohesion == COHESION_SJKR2) return make<CohesionModel<COHESION_SJKR2>>(s);
  return make<CohesionModel<COHESION_OFF>>(s);
}

std::shared_ptr<TangentialModelBase> tangential_model(const Site& s) {
  switch (s.ids.tangential) {
    case TANGENTIAL_HISTORY: return make<TangentialModel<TANGENTIAL_HISTORY>>(s);
    case TANGENTIAL_NO_HISTORY: return make<TangentialModel<TANGENTIAL_NO_HISTORY>>(s);
    case TANGENTIAL_PARTIAL_SLIP: return partial_slip_model<3>(s);
    case TANGENTIAL_PARTIAL_SLIP_2: return partial_slip_model<2>(s);
    default: return make<TangentialModel<TANGENTIAL_OFF>>(s);
  }
}

std::shared_ptr<RollingModelBase> rolling_model(const Site& s) {
  switch (s.ids.rolling) {
    case ROLLING_CDT: return make<RollingModel<ROLLING_CDT>>(s);
    case ROLLING_EPSD: return make<RollingModel<ROLLING_EPSD>>(s);
    case ROLLING_EPSD2: return make<RollingModel<ROLLING_EPSD2>>(s);
    case ROLLING_EPSD3: return make<RollingModel<ROLLING_EPSD3>>(s);
    default: return make<RollingModel<ROLLING_OFF>>(s);
  }
}

namespace {

PairStyles::IGranularPairStyle* new_pair(LAMMPS* lmp, PairGran* parent, int64_t hash) {
  return new loop::Pair(lmp, parent, hash);
}

Walls::IGranularWall* new_wall(LAMMPS* lmp, FixWallGran* parent, int64_t hash) {
#ifdef EPDEM_BUILT_FOR
  return new loop::Wall(lmp, parent, hash);
#else
  return new Walls::Granular<Model>(lmp, parent, hash);
#endif
}

bool with_adhesion(const Ids& ids) {
#define EPDEM_ADHERES(Class) \
  if (ids.normal == Class<double>::id) return adheres<Class<double>>;
  EPDEM_LAWS(EPDEM_ADHERES)
#undef EPDEM_ADHERES
  return false;
}

constexpr const char* combinations =
    "epdem's models combine with tangential off, no_history, history, ep/partial_slip, ep/partial_slip_2; cohesion "
    "off, sjkr, sjkr2; rolling_friction off, cdt, epsd, epsd2, epsd3; surface default, multicontact; nothing else";

std::string tangential_names() {
  std::string names;
  for (const char* name : partial_slip_names) names += std::string(" ") + name;
  return names;
}

template <class Interface, class Parent>
Interface* refuse(LAMMPS* lmp, Parent*, int64_t hash) {
  const Ids ids = Ids::of(hash);
  const std::string text =
      with_adhesion(ids) && ids.cohesion != COHESION_OFF
          ? "a law with adhesion has its attraction already: leave out the cohesion model beside it"
      : with_adhesion(ids) ? "laws with adhesion combine with tangential off, no_history, history; rolling_friction "
                             "off, cdt, epsd, epsd2, epsd3; surface default; nothing else"
      : ids.normal != unknown_law            ? combinations
      : ids.tangential == unknown_tangential ? "unknown tangential model: those of epdem are" + tangential_names()
      : ids.tangential == foreign_normal
          ? "tangential ep/partial_slip goes with the normal models of epdem only: "
            "LIGGGHTS's own do not pass the contact radius on (its hertz is ep/hertz, with viscous on for its dashpot)"
          : "unknown normal model: the models of epdem are" + model_names();
  lmp->error->all(FLERR, text.c_str());
  return nullptr;
}

void add(const Ids& ids, PairStyles::IGranularPairStyle* (*pair)(LAMMPS*, PairGran*, int64_t),
         Walls::IGranularWall* (*wall)(LAMMPS*, FixWallGran*, int64_t)) {
  PairStyles::Factory::instance().addStyle("gran", static_cast<int>(ids.hash()), pair);
  Walls::Factory::instance().addStyle("gran", static_cast<int>(ids.hash()), wall);
}

void add_refusal(const Ids& ids) {
  add(ids, &refuse<PairStyles::IGranularPairStyle, PairGran>, &refuse<Walls::IGranularWall, FixWallGran>);
}

/// Partial slip and cohesion are not measured with adhesion, which brings an attraction of its own.
bool offered(const Ids& ids) {
  return available(ids) && !(with_adhesion(ids) && (ids.cohesion != COHESION_OFF || ids.surface != SURFACE_DEFAULT ||
                                                    ids.tangential > TANGENTIAL_HISTORY));
}

template <class Law>
void add_law() {
  static_assert(sizeof(int) >= 4, "LIGGGHTS's tables are indexed by int");
  LIGGGHTS::ContactModels::Factory::instance().addNormalModel(model_name<Law>(), Law::id);
  for (int t : tangentials)
    for (int c : cohesions)
      for (int r : rollings)
        for (int s : surfaces) {
          const Ids ids{Law::id, t, c, r, s};
          offered(ids) ? add(ids, &new_pair, &new_wall) : add_refusal(ids);
        }
}

Ids refused(int why) { return {unknown_law, why, COHESION_OFF, ROLLING_OFF, SURFACE_DEFAULT}; }

#ifdef EPDEM_BUILT_FOR
bool starts_with_ep(const std::string& name) { return name.compare(0, 2, "ep") == 0; }

bool unknown_name(const std::string& name) {
  if (!starts_with_ep(name)) return false;
#define EPDEM_KNOWN(Class) \
  if (name == model_name<Class<double>>()) return false;
  EPDEM_LAWS(EPDEM_KNOWN)
#undef EPDEM_KNOWN
  return true;
}
#endif

const struct Registration {
  Registration() {
#define EPDEM_ADD(Class) add_law<Class<double>>();
    EPDEM_LAWS(EPDEM_ADD)
#undef EPDEM_ADD
    for (int why : {unknown_normal, unknown_tangential, foreign_normal}) add_refusal(refused(why));
    for (int k = 0; k < 2; ++k)
      LIGGGHTS::ContactModels::Factory::instance().addTangentialModel(partial_slip_names[k],
                                                                      TANGENTIAL_PARTIAL_SLIP + k);
  }
} registration;  // NOLINT(bugprone-throwing-static-initialization): LIGGGHTS cannot run without its models

}  // namespace

}  // namespace epdem::liggghts

#ifdef EPDEM_BUILT_FOR
/// In place of LIGGGHTS's own, which calls every wrong name "Invalid model specified": for a name that starts with
/// ep the message lists what exists. LIGGGHTS takes this function's address through the dynamic linker, which finds
/// the launcher or a preloaded library first; beside those of loop/mesh.cpp it is the one symbol that the plugin
/// exports.
[[gnu::visibility("default")]] int64_t LIGGGHTS::ContactModels::Factory::select(
    int& narg, char**& arg, LAMMPS_NS::Custom_contact_models custom) {
  using namespace epdem::liggghts;
  bool ours = false;
  for (int k = 0; k + 1 < narg; ++k) {
    const std::string word = arg[k], name = arg[k + 1];
    if (word == "model") {
      if (unknown_name(name)) return refused(unknown_normal).hash();
      ours = starts_with_ep(name);
    }
    if (word == "tangential" && starts_with_ep(name)) {
      if (name != partial_slip_names[0] && name != partial_slip_names[1]) return refused(unknown_tangential).hash();
      if (!ours) return refused(foreign_normal).hash();
    }
  }
  return instance().select_model(narg, arg, std::move(custom));
}
#endif
