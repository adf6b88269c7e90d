// SPDX-License-Identifier: GPL-2.0-or-later
// The laws without adhesion in LIGGGHTS-PFM. Its contact models have another interface (collision, noCollision), and
// its hash code has four bits for each of them.
#include "interface.hpp"

#include <cstdio>
#include <cstring>
#include <limits>

#include "../law_model.hpp"
#include "../simulation.hpp"

namespace epdem::liggghts {

bool only_spheres(LAMMPS_NS::LAMMPS* lmp) { return lmp->atom->sphere_flag && !lmp->atom->superquadric_flag; }

// No law there holds bodies across a gap.
std::vector<double> smallest_radii(LAMMPS_NS::LAMMPS*) { return {std::numeric_limits<double>::infinity()}; }
void register_contact_distance(LAMMPS_NS::LAMMPS*, double) {}
const kernels::SphereKernels* sphere_kernels(LAMMPS_NS::LAMMPS*) { return nullptr; }

namespace pfm {

using LAMMPS_NS::FixWallGran;
using LAMMPS_NS::LAMMPS;
using LAMMPS_NS::PairGran;
namespace PairStyles = LIGGGHTS::PairStyles;
namespace Walls = LIGGGHTS::Walls;

/// Ids that are free there, 10 to 15, for the first six laws without adhesion in the order of the register. Restart
/// files keep them: they never change, because new laws are added at the end.
constexpr int first_id = 10, last_id = 15;
template <class Law>
constexpr int id_of() {
  int id = first_id;
  bool before = true;
#define EPDEM_BEFORE(Class)                        \
  before = before && Class<double>::id != Law::id; \
  if (before && !adheres<Class<double>>) ++id;
  EPDEM_LAWS(EPDEM_BEFORE)
#undef EPDEM_BEFORE
  return id;
}
template <class Law>
constexpr int id = id_of<Law>();
template <class Law>
constexpr bool offered = !adheres<Law> && id<Law> <= last_id;
constexpr int tangential_off = 15;

/// LIGGGHTS-PFM has no `tangential off`.
class NoFriction {
 public:
  NoFriction(LAMMPS*, LIGGGHTS::IContactHistorySetup*) {}
  void registerSettings(Settings&) {}
  void connectToProperties(PropertyRegistry&) {}
  void collision(CollisionData&, ForceData&, ForceData&) {}
  void noCollision(ContactData&, ForceData&, ForceData&) {}
};

template <int tangential>
struct OfId {
  using type = TangentialModel<tangential>;
};
template <>
struct OfId<tangential_off> {
  using type = NoFriction;
};

std::string names() {
  std::string all;
#define EPDEM_NAME(Class) \
  if (offered<Class<double>>) all += " " + model_name<Class<double>>();
  EPDEM_LAWS(EPDEM_NAME)
#undef EPDEM_NAME
  return all;
}

/// Contact model of the loops of LIGGGHTS-PFM: a law with its surface, tangential and rolling models.
template <class Law, bool wall, int tangential, int rolling>
class Model {
 public:
  static const int64_t STYLE_HASHCODE =
      GranStyle<id<Law>, tangential, COHESION_OFF, rolling, SURFACE_DEFAULT>::HASHCODE;

  Model(LAMMPS* lmp, LIGGGHTS::IContactHistorySetup* setup)
      : surface_(lmp, setup),
        normal_(lmp, setup, wall, others_have_history),
        tangential_(lmp, setup),
        rolling_(lmp, setup) {
    if (wall && history_size<Law> == 1)
      setup->add_history_value("spare", "0");  // a wall's history of one value is refused
    std::setvbuf(stdout, nullptr, _IOLBF, 0);  // error->one ends in MPI_Abort: on a pipe its message would be lost
    if (!wall) say_once(lmp, "epdem " EPDEM_VERSION ":" + names());
  }

  int64_t hashcode() { return STYLE_HASHCODE; }
  double stressStrainExponent() { return normal_.stressStrainExponent(); }

  void registerSettings(::Settings& settings) {
    surface_.registerSettings(settings);
    normal_.registerSettings(settings);
    tangential_.registerSettings(settings);
    rolling_.registerSettings(settings);
  }

  void connectToProperties(PropertyRegistry& registry) {
    normal_.postSettings(nullptr, false, false);
    surface_.connectToProperties(registry);
    normal_.connectToProperties(registry, dashpot, 0.0);
    tangential_.connectToProperties(registry);
    rolling_.connectToProperties(registry);
  }

  void beginPass(CollisionData& s, ForceData&, ForceData&) { normal_.beginPass(s); }
  void endPass(CollisionData&, ForceData&, ForceData&) {}

  bool checkSurfaceIntersect(CollisionData& s) { return surface_.checkSurfaceIntersect(s); }

  void collision(CollisionData& s, ForceData& i, ForceData& j) {
    const double overlap = s.deltan;  // the surface model computes it again, of a wall less accurately
    surface_.collision(s, i, j);
    if (wall) s.deltan = overlap;
    normal_.surfacesIntersect(s, i, j);
    tangential_.collision(s, i, j);
    rolling_.collision(s, i, j);
  }

  void noCollision(ContactData& s, ForceData& i, ForceData& j) {
    normal_.surfacesClose(s);
    tangential_.noCollision(s, i, j);
    rolling_.noCollision(s, i, j);
  }

 private:
  static constexpr Dashpot dashpot = tangential == tangential_off          ? Dashpot::off
                                     : tangential == TANGENTIAL_NO_HISTORY ? Dashpot::required
                                                                           : Dashpot::optional;
  static constexpr bool others_have_history = tangential == TANGENTIAL_HISTORY || rolling > ROLLING_CDT;

  SurfaceModel<SURFACE_DEFAULT> surface_;
  LawModel<Law> normal_;
  typename OfId<tangential>::type tangential_;
  RollingModel<rolling> rolling_;
};

/// A pair style; the properties of computePlasticWork and computeContactStrain are there as soon as its settings are,
/// for dumps that name them.
template <class Contact>
class Pairs : public PairStyles::Granular<Contact> {
 public:
  Pairs(LAMMPS* lmp, PairGran* parent) : PairStyles::Granular<Contact>(lmp, parent), lmp_(lmp) {}

  void settings(int n, char** words) override {
    PairStyles::Granular<Contact>::settings(n, words);
    for (int k = 0; k + 1 < n; ++k) {
      if (std::strcmp(words[k + 1], "on")) continue;
      if (!std::strcmp(words[k], "computePlasticWork")) EnergyTally().create(lmp_, false, false, true);
      if (!std::strcmp(words[k], "computeContactStrain")) LargestStrain::create(lmp_);
    }
  }

 private:
  LAMMPS* const lmp_;
};

template <class Interface, class Part, class Parent>
Interface* create(LAMMPS* lmp, Parent* parent) {
  return new Part(lmp, parent);
}

template <class Law, int tangential, int... rollings>
void add() {
  const auto one = [](auto rolling) {
    using OfPair = Pairs<Model<Law, false, tangential, rolling>>;
    using OfWall = Walls::Granular<Model<Law, true, tangential, rolling>>;
    const int hash = static_cast<int>(Model<Law, false, tangential, rolling>::STYLE_HASHCODE);
    PairStyles::Factory::instance().addStyle("gran", hash, &create<PairStyles::IGranularPairStyle, OfPair, PairGran>);
    Walls::Factory::instance().addStyle("wall/gran", hash, &create<Walls::IGranularWall, OfWall, FixWallGran>);
  };
  (one(std::integral_constant<int, rollings>{}), ...);
}

template <class Law>
void add_law() {
  Factory::instance().addNormalModel(model_name<Law>(), id<Law>);
  add<Law, tangential_off, ROLLING_OFF, ROLLING_CDT, ROLLING_EPSD, ROLLING_EPSD2>();
  add<Law, TANGENTIAL_NO_HISTORY, ROLLING_OFF, ROLLING_CDT, ROLLING_EPSD, ROLLING_EPSD2>();
  add<Law, TANGENTIAL_HISTORY, ROLLING_OFF, ROLLING_CDT, ROLLING_EPSD, ROLLING_EPSD2>();
}

const struct Registration {
  Registration() {
#define EPDEM_ADD(Class) \
  if constexpr (offered<Class<double>>) add_law<Class<double>>();
    EPDEM_LAWS(EPDEM_ADD)
#undef EPDEM_ADD
    Factory::instance().addTangentialModel("off", tangential_off);
  }
} registration;

}  // namespace pfm

}  // namespace epdem::liggghts
