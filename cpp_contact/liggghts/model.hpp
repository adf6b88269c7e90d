// SPDX-License-Identifier: GPL-2.0-or-later
// A law together with LIGGGHTS's surface, cohesion, tangential and rolling models: one contact model.
#pragma once

#include <memory>

#include "epdem/sub_models.hpp"
#include "heat.hpp"
#include "normal.hpp"
#include "simulation.hpp"

namespace epdem::liggghts {

/// Which models a contact combines; LIGGGHTS packs them into its hash code, which is stored in restart files.
struct Ids {
  int normal, tangential, cohesion, rolling, surface;

  static Ids of(int64_t hash) {
    const auto six_bits = [hash](int at) { return static_cast<int>((hash >> at) & 63); };
    return {six_bits(0), six_bits(6), six_bits(12), six_bits(18), six_bits(24)};
  }
  int64_t hash() const {
    return LIGGGHTS::Utils::generate_gran_hashcode(normal, tangential, cohesion, rolling, surface);
  }
};

/// Arguments of the constructors of LIGGGHTS's models.
struct Site {
  LAMMPS_NS::LAMMPS* lmp;
  LIGGGHTS::IContactHistorySetup* history;
  ContactModelBase* contact;
  Ids ids;
  const NormalContactState* normal = nullptr;  // for tangential models
};

/// A model that is chosen by its id when the simulation starts; choose returns a shared_ptr because LIGGGHTS's base
/// classes have no virtual destructor, and a shared_ptr remembers the class that it was made of.
template <class Base, std::shared_ptr<Base> (*choose)(const Site&)>
class Chosen {
 public:
  explicit Chosen(const Site& site) : part_(choose(site)) {}

  void registerSettings(::Settings& s) { part_->registerSettings(s); }
  void postSettings(LIGGGHTS::IContactHistorySetup* setup, ContactModelBase* c) { part_->postSettings(setup, c); }
  void connectToProperties(PropertyRegistry& r) { part_->connectToProperties(r); }
  bool checkSurfaceIntersect(SurfacesIntersectData& s) { return part_->checkSurfaceIntersect(s); }
  void surfacesIntersect(SurfacesIntersectData& s, ForceData& i, ForceData& j) { part_->surfacesIntersect(s, i, j); }
  void surfacesClose(SurfacesCloseData& s, ForceData& i, ForceData& j) { part_->surfacesClose(s, i, j); }
  void endSurfacesIntersect(SurfacesIntersectData& s, LAMMPS_NS::TriMesh* mesh, double* F) {
    part_->endSurfacesIntersect(s, mesh, F);
  }
  void endSurfacesIntersect(SurfacesIntersectData& s, ForceData& i, ForceData& j) {
    part_->endSurfacesIntersect(s, i, j);
  }
  void beginPass(SurfacesIntersectData& s, ForceData& i, ForceData& j) { part_->beginPass(s, i, j); }
  void endPass(SurfacesIntersectData& s, ForceData& i, ForceData& j) { part_->endPass(s, i, j); }
  void tally_pp(double x, int i, int j, int k) { part_->tally_pp(x, i, j, k); }
  void tally_pw(double x, int i, int j, int k) { part_->tally_pw(x, i, j, k); }

 private:
  std::shared_ptr<Base> part_;
};

std::shared_ptr<SurfaceModelBase> surface_model(const Site& site);
std::shared_ptr<CohesionModelBase> cohesion_model(const Site& site);
std::shared_ptr<TangentialModelBase> tangential_model(const Site& site);
std::shared_ptr<RollingModelBase> rolling_model(const Site& site);

/// The normal model of a law; others_have_history: a model beside the normal model has a history.
std::unique_ptr<NormalModel> normal_model(LAMMPS_NS::LAMMPS* lmp, LIGGGHTS::IContactHistorySetup* setup, bool wall,
                                          int law, bool others_have_history);

/// Whether the tangential or the rolling model of a contact has a history.
inline bool others_have_history(const Ids& ids) {
  bool found = ids.rolling == ROLLING_EPSD || ids.rolling == ROLLING_EPSD3;
  Frictions::each([&](auto m, int) { found |= m.id == ids.tangential && values_of<decltype(m), double> > 0; });
  Rollings::each([&](auto m, int) { found |= m.id == ids.rolling && m.has_history; });
  return found;
}

/// Whether the tangential model of a contact computes its work.
inline bool adds_friction(const Ids& ids) {
  bool found = false;
  Frictions::each([&](auto m, int) { found |= m.id == ids.tangential && m.adds_work; });
  return found;
}

/// Contact model of LIGGGHTS's pair and wall loops, with all models behind virtual calls: the loops for throughput are
/// in loop/. The parts have the order of LIGGGHTS's own models.
class Model : public ContactModelBase {
 public:
  Model(LAMMPS_NS::LAMMPS* lmp, LIGGGHTS::IContactHistorySetup* setup, bool is_wall, const int64_t hash)
      : ContactModelBase(lmp, is_wall),
        lmp_(lmp),
        wall_(is_wall),
        ids_(checked(lmp, hash)),
        surface_({lmp, setup, this, ids_}),
        normal_(normal_model(lmp, setup, is_wall, ids_.normal, others_have_history(ids_))),
        cohesion_({lmp, setup, this, ids_}),
        tangential_(Site{lmp, setup, this, ids_, &normal_->state()}),
        rolling_({lmp, setup, this, ids_}) {
    if (is_wall) {
      wall_gran_ = dynamic_cast<LAMMPS_NS::FixWallGran*>(setup);
      return;
    }
    say_once(lmp, "epdem " EPDEM_VERSION ":" + model_names());
    add_fix_styles(lmp);
  }

  /// Settings of LIGGGHTS's models that our loops must know.
  struct LoopSettings {
    bool torsion = false, cohesion_slides = false, heating = false, twist = false;

    /// Setting that our loops do not include; nullptr: none.
    const char* missing() const {
      if (heating) return "heating_tangential_history on";
      return twist ? "torsion on" : nullptr;
    }
  };
  const LoopSettings& loop_settings() const { return loop_settings_; }
  NormalModel& normal() { return *normal_; }
  FixHeat* heat() { return heat_; }

  int64_t hashcode() { return ids_.hash(); }

  void registerSettings(::Settings& settings) {
    surface_.registerSettings(settings);
    normal_->registerSettings(settings);
    cohesion_.registerSettings(settings);
    tangential_.registerSettings(settings);
    rolling_.registerSettings(settings);
    if (Rollings::place(ids_.rolling) > 0) settings.registerOnOff("torsionTorque", loop_settings_.torsion, false);
    if (ids_.cohesion != COHESION_OFF)
      settings.registerOnOff("tangential_reduce", loop_settings_.cohesion_slides, false);
    if (ids_.tangential == TANGENTIAL_HISTORY) {
      settings.registerOnOff("heating_tangential_history", loop_settings_.heating, false);
#if __has_include("iloopcallbackcallable.h")  // LIGGGHTS-INL
      settings.registerOnOff("torsion", loop_settings_.twist, false);
#endif
    }
  }

  void postSettings(LIGGGHTS::IContactHistorySetup* setup) {
    surface_.postSettings(setup, this);
    normal_->postSettings(setup, adds_friction(ids_), ids_.cohesion);
    cohesion_.postSettings(setup, this);
    tangential_.postSettings(setup, this);
    rolling_.postSettings(setup, this);
  }

  void connectToProperties(PropertyRegistry& registry) {
    surface_.connectToProperties(registry);
    normal_->connectToProperties(registry, dashpot(), cohesive());
    cohesion_.connectToProperties(registry);
    tangential_.connectToProperties(registry);
    rolling_.connectToProperties(registry);
    heat_ = FixHeat::of(lmp_, normal_->tally() != nullptr);
  }

  void beginPass(SurfacesIntersectData& s, ForceData& i, ForceData& j) {
    surface_.beginPass(s, i, j);
    normal_->beginPass(s);
    if (heat_ && s.computeflag && s.shearupdate) heat_->open();
    cohesion_.beginPass(s, i, j);
    tangential_.beginPass(s, i, j);
    rolling_.beginPass(s, i, j);
  }

  void endPass(SurfacesIntersectData& s, ForceData& i, ForceData& j) {
    rolling_.endPass(s, i, j);
    tangential_.endPass(s, i, j);
    cohesion_.endPass(s, i, j);
    surface_.endPass(s, i, j);
  }

  double stressStrainExponent() { return normal_->stressStrainExponent(); }
  void tally_pp(double x, int i, int j, int k) override { surface_.tally_pp(x, i, j, k); }
  void tally_pw(double x, int i, int j, int k) override { surface_.tally_pw(x, i, j, k); }

  /// LIGGGHTS calls this function first for a pair: the prefetch of this history and of the next one overlaps with the
  /// computation of the distance.
  bool checkSurfaceIntersect(SurfacesIntersectData& s) {
    __builtin_prefetch(s.contact_history, 1);
    __builtin_prefetch(s.contact_history + 24, 1);
    return surface_.checkSurfaceIntersect(s);
  }

  void surfacesIntersect(SurfacesIntersectData& s, ForceData& i, ForceData& j) {
    surface_.surfacesIntersect(s, i, j);
    normal_->surfacesIntersect(s, i, j);
    cohesion_.surfacesIntersect(s, i, j);
    tangential_.surfacesIntersect(s, i, j);
    rolling_.surfacesIntersect(s, i, j);
    if (!heat_ || !s.computeflag || !s.shearupdate) return;
    const double radius = normal_->state().radius;
    wall_ ? heat_->add_wall(s.i, s.fix_mesh, *wall_gran_, radius) : heat_->sums().add_pair(s.i, s.j, radius);
  }

  void endSurfacesIntersect(SurfacesIntersectData& s, LAMMPS_NS::TriMesh* mesh, ForceData& i, ForceData& j) {
    surface_.endSurfacesIntersect(s, mesh, i.delta_F);
    cohesion_.endSurfacesIntersect(s, i, j);
  }

  void surfacesClose(SurfacesCloseData& s, ForceData& i, ForceData& j) {
    if (normal_->attracts(s)) {
      auto& all = static_cast<SurfacesIntersectData&>(s);  // both loops of LIGGGHTS pass the whole
      normal_->prepare(all);
      surfacesIntersect(all, i, j);
      s.has_force_update = true;
      return;
    }
    surface_.surfacesClose(s, i, j);
    normal_->surfacesClose(s);
    cohesion_.surfacesClose(s, i, j);
    tangential_.surfacesClose(s, i, j);
    rolling_.surfacesClose(s, i, j);
  }

  // by value: LIGGGHTS-INL declares it so, as a virtual function
  // NOLINTNEXTLINE(performance-unnecessary-value-param)
  bool contact_match(std::string kind, std::string model) {
    auto& names = LIGGGHTS::ContactModels::Factory::instance();
    if (kind == "surface") return ids_.surface == names.getSurfaceModelId(model);
    if (kind == "normal") return ids_.normal == names.getNormalModelId(model);
    if (kind == "cohesion") return ids_.cohesion == names.getCohesionModelId(model);
    if (kind == "tangential") return ids_.tangential == names.getTangentialModelId(model);
    if (kind == "rolling_friction") return ids_.rolling == names.getRollingModelId(model);
    return false;
  }

 private:
  /// Before the first part is built: a foreign library must not be touched.
  static Ids checked(LAMMPS_NS::LAMMPS* lmp, int64_t hash) {
    check_host(lmp);
    return Ids::of(hash);
  }

  Dashpot dashpot() const {
    if (ids_.tangential == TANGENTIAL_OFF) return Dashpot::off;
    return ids_.tangential == TANGENTIAL_NO_HISTORY ? Dashpot::required : Dashpot::optional;
  }

  /// Area on which cohesion pulls, over the area of the overlap's lens.
  double cohesive() const {
    double ratio = 0.0;
    Cohesions::each([&](auto m, int) {
      if (m.id == ids_.cohesion && m.id != 0) ratio = wall_ ? 1.0 : m.area_ratio;
    });
    return ratio;
  }

  LAMMPS_NS::LAMMPS* const lmp_;
  const bool wall_;
  const Ids ids_;
  FixHeat* heat_ = nullptr;
  LAMMPS_NS::FixWallGran* wall_gran_ = nullptr;  // of a wall
  LoopSettings loop_settings_;
  Chosen<SurfaceModelBase, surface_model> surface_;
  const std::unique_ptr<NormalModel> normal_;
  Chosen<CohesionModelBase, cohesion_model> cohesion_;
  Chosen<TangentialModelBase, tangential_model> tangential_;
  Chosen<RollingModelBase, rolling_model> rolling_;
};

/// The model of a pair style or of a wall, a private member of LIGGGHTS's class.
Model& model_of(LIGGGHTS::PairStyles::Granular<Model>& style);
Model& model_of(LIGGGHTS::Walls::Granular<Model>& style);

}  // namespace epdem::liggghts
