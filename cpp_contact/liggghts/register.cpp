// SPDX-License-Identifier: GPL-2.0-or-later
// Makes the laws known to LIGGGHTS when the library (or the launcher) is loaded.
#include <string>
#include <utility>
#include <vector>

#include "epdem/laws.hpp"
#include "loop/pair.hpp"
#include "loop/wall.hpp"
#include "model.hpp"
#include "sub_models.hpp"

namespace epdem::liggghts {

namespace {

using LAMMPS_NS::FixWallGran;
using LAMMPS_NS::LAMMPS;
using LAMMPS_NS::PairGran;
namespace PairStyles = LIGGGHTS::PairStyles;
namespace Walls = LIGGGHTS::Walls;

// every model that this LIGGGHTS has, from its own lists
#define EPDEM_ID(name, text, id) name,
#define TANGENTIAL_MODEL EPDEM_ID
#define COHESION_MODEL EPDEM_ID
#define ROLLING_MODEL EPDEM_ID
#define SURFACE_MODEL EPDEM_ID
constexpr int tangentials[] = {
    TANGENTIAL_OFF,
#include "style_tangential_model.h"
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
#undef EPDEM_ID
constexpr int unknown_law = 63;  // normal id of what is refused: by its name, or for its tangential model

/// Why, as the tangential id of a refusal.
enum Refusal { unknown_normal, unknown_tangential, foreign_normal };

/// Ids of LIGGGHTS's models and of epdem's models that LIGGGHTS lacks.
template <class Ours, int n>
std::vector<int> with_ours(const int (&theirs)[n], Ours) {
  std::vector<int> ids(theirs, theirs + n);
  Ours::each([&](auto m, int) {
    if (!m.of_liggghts) ids.push_back(m.id);
  });
  return ids;
}

/// The names of epdem's models with a separator between them; only_new: of the models that LIGGGHTS lacks.
template <class Ours>
std::string names_of(Ours, const char* separator, bool only_new = false) {
  std::string names;
  Ours::each([&](auto m, int) {
    if (!only_new || !m.of_liggghts) names += (names.empty() ? "" : separator) + std::string(m.name);
  });
  return names;
}

/// Luding's models need slots of Luding's normal model; capillary forces and superquadrics bring their own contact law.
bool available(const Ids& ids) {
  return Frictions::place(ids.tangential) >= 0 && Cohesions::place(ids.cohesion) >= 0 &&
         (Rollings::place(ids.rolling) >= 0 || ids.rolling == ROLLING_EPSD || ids.rolling == ROLLING_EPSD3) &&
         (ids.surface == SURFACE_DEFAULT || ids.surface == SURFACE_MULTICONTACT);
}

template <class Part>
std::shared_ptr<Part> make(const Site& s) {
  return std::make_shared<Part>(s.lmp, s.history, s.contact);
}

}  // namespace

std::shared_ptr<SurfaceModelBase> surface_model(const Site& s) {
  if (s.ids.surface == SURFACE_MULTICONTACT) return make<SurfaceModel<SURFACE_MULTICONTACT>>(s);
  return make<SurfaceModel<SURFACE_DEFAULT>>(s);
}

std::shared_ptr<CohesionModelBase> cohesion_model(const Site& s) {
  if (s.ids.cohesion == COHESION_SJKR) return make<CohesionModel<COHESION_SJKR>>(s);
  if (s.ids.cohesion == COHESION_SJKR2) return make<CohesionModel<COHESION_SJKR2>>(s);
  std::shared_ptr<CohesionModelBase> found = make<CohesionModel<COHESION_OFF>>(s);
  Cohesions::each([&](auto m, int) {
    if constexpr (!decltype(m)::of_liggghts)
      if (m.id == s.ids.cohesion) found = std::make_shared<AttractionModel<decltype(m)>>(s);
  });
  return found;
}

std::shared_ptr<TangentialModelBase> tangential_model(const Site& s) {
  if (s.ids.tangential == TANGENTIAL_HISTORY) return std::make_shared<LiggghtsSpring>(s);
  if (s.ids.tangential == TANGENTIAL_NO_HISTORY) return make<TangentialModel<TANGENTIAL_NO_HISTORY>>(s);
  if (s.ids.tangential == TANGENTIAL_OFF) return make<TangentialModel<TANGENTIAL_OFF>>(s);
  std::shared_ptr<TangentialModelBase> found;
  Frictions::each([&](auto m, int) {
    if constexpr (!decltype(m)::of_liggghts) {
      if (m.id != s.ids.tangential) return;
      if (s.normal->flattens)
        found = std::make_shared<FrictionModel<decltype(m), true>>(s);
      else
        found = std::make_shared<FrictionModel<decltype(m), false>>(s);
    }
  });
  return found;
}

std::shared_ptr<RollingModelBase> rolling_model(const Site& s) {
  switch (s.ids.rolling) {
    case ROLLING_CDT: return make<RollingModel<ROLLING_CDT>>(s);
    case ROLLING_EPSD: return make<RollingModel<ROLLING_EPSD>>(s);
    case ROLLING_EPSD2: return make<RollingModel<ROLLING_EPSD2>>(s);
    case ROLLING_EPSD3: return make<RollingModel<ROLLING_EPSD3>>(s);
    default: break;
  }
  std::shared_ptr<RollingModelBase> found = make<RollingModel<ROLLING_OFF>>(s);
  Rollings::each([&](auto m, int) {
    if constexpr (!decltype(m)::of_liggghts)
      if (m.id == s.ids.rolling) found = std::make_shared<RollingFrictionModel<decltype(m)>>(s);
  });
  return found;
}

/// An explicit instantiation may name a private member.
template <class Style, Model Style::* model>
struct Exposed {
  friend Model& model_of(Style& style) { return style.*model; }
};
template struct Exposed<PairStyles::Granular<Model>, &PairStyles::Granular<Model>::cmodel>;
template struct Exposed<Walls::Granular<Model>, &Walls::Granular<Model>::cmodel>;

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

std::string combinations() {
  return "epdem's models combine with tangential " + names_of(Frictions{}, ", ") + "; cohesion " +
         names_of(Cohesions{}, ", ") + "; rolling_friction " + names_of(Rollings{}, ", ") +
         ", epsd, epsd3; surface default, multicontact; nothing else";
}

template <class Interface, class Parent>
Interface* refuse(LAMMPS* lmp, Parent*, int64_t hash) {
  const Ids ids = Ids::of(hash);
  const std::string text =
      with_adhesion(ids) && ids.cohesion != COHESION_OFF
          ? "a law with adhesion has its attraction already: leave out the cohesion model beside it"
      : with_adhesion(ids) ? "laws with adhesion combine with tangential off, no_history, history; rolling_friction "
                             "off, cdt, epsd, epsd2, epsd3; surface default; nothing else"
      : ids.normal != unknown_law ? combinations()
      : ids.tangential == unknown_tangential
          ? "unknown tangential model: the models of epdem are " + names_of(Frictions{}, " ", true)
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

/// Partial slip and cohesion are not measured with adhesion, which has its own attraction.
bool offered(const Ids& ids) {
  return available(ids) && !(with_adhesion(ids) && (ids.cohesion != COHESION_OFF || ids.surface != SURFACE_DEFAULT ||
                                                    ids.tangential > TANGENTIAL_HISTORY));
}

template <class Law>
void add_law() {
  static_assert(sizeof(int) >= 4, "LIGGGHTS's tables are indexed by int");
  LIGGGHTS::ContactModels::Factory::instance().addNormalModel(model_name<Law>(), Law::id);
  for (int t : with_ours(tangentials, Frictions{}))
    for (int c : with_ours(cohesions, Cohesions{}))
      for (int r : with_ours(rollings, Rollings{}))
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
    auto& factory = LIGGGHTS::ContactModels::Factory::instance();
    Frictions::each([&](auto m, int) {
      if (!m.of_liggghts) factory.addTangentialModel(m.name, m.id);
    });
    Rollings::each([&](auto m, int) {
      if (!m.of_liggghts) factory.addRollingModel(m.name, m.id);
    });
    Cohesions::each([&](auto m, int) {
      if (!m.of_liggghts) factory.addCohesionModel(m.name, m.id);
    });
  }
} registration;  // NOLINT(bugprone-throwing-static-initialization): LIGGGHTS cannot run without its models

}  // namespace

}  // namespace epdem::liggghts

#ifdef EPDEM_BUILT_FOR
/// In place of LIGGGHTS's own, which calls every wrong name "Invalid model specified": for a name that starts with
/// ep the message lists what exists. LIGGGHTS takes this function's address through the dynamic linker, which finds
/// the launcher or a preloaded library first. All other exported symbols of the plugin stand in loop/.
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
      if (epdem::Frictions::find(name.c_str()) < 0) return refused(unknown_tangential).hash();
      if (!ours) return refused(foreign_normal).hash();
    }
  }
  return instance().select_model(narg, arg, std::move(custom));
}
#endif
