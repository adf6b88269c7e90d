// SPDX-License-Identifier: GPL-2.0-or-later
// Our models beside a law, as LIGGGHTS's loop sees them: read the contact, call the model, write force and torque.
#pragma once

#include <cmath>
#include <cstring>
#include <string>
#include <utility>

#include "epdem/sub_models.hpp"
#include "host.hpp"
#include "normal_state.hpp"

namespace epdem::liggghts {

using namespace LIGGGHTS::ContactModels;

inline void add(double* to, double share, const Vec<double>& v) {
  to[0] += share * v.x;
  to[1] += share * v.y;
  to[2] += share * v.z;
}

/// Whether the step counts and histories are stored.
inline bool keeps(const SurfacesIntersectData& s) { return s.computeflag && s.shearupdate; }

/// Adds friction F on i [N] and its torques.
inline void add_friction(const SurfacesIntersectData& s, const Vec<double>& F, ForceData& fi, ForceData& fj) {
  const double share = s.is_wall ? s.area_ratio : 1.0;
  const Vec<double> lever = cross(vector_of(s.en), F);
  add(fi.delta_F, share, F);
  add(fi.delta_torque, share, (-s.cri) * lever);
  if (s.is_wall) return;
  add(fj.delta_F, -1.0, F);
  add(fj.delta_torque, 1.0, (-s.crj) * lever);
}

/// Friction beside one of our laws; `normal` is the law's own.
template <class Friction, bool flattens>
class FrictionModel : public TangentialModelBase {
  using History = typename Friction::template History<double>;
  static constexpr int values = values_of<Friction, double>;

 public:
  template <class Site>
  explicit FrictionModel(const Site& site)
      : TangentialModelBase(site.lmp, site.history, site.contact), normal_(*site.normal) {
    // Flag "1": these change their sign when the pair is stored from the other side.
    constexpr int odd_values = values - Friction::even_values;
    for (int k = 0; k < odd_values; ++k) {
      const int at = site.history->add_history_value("friction" + std::to_string(k), "1");
      if (k == 0) offset_ = at;
    }
    for (int k = odd_values; k < values; ++k) site.history->add_history_value("friction" + std::to_string(k), "0");
  }

  void registerSettings(::Settings&) override {}
  void postSettings(LIGGGHTS::IContactHistorySetup*, ContactModelBase*) override {}
  void connectToProperties(PropertyRegistry& registry) override {
    registry.registerProperty("coeffFrict", &MODEL_PARAMS::createCoeffFrict);
    registry.connect("coeffFrict", mu_, Friction::name);
  }
  void beginPass(SurfacesIntersectData&, ForceData&, ForceData&) override {}
  void endPass(SurfacesIntersectData&, ForceData&, ForceData&) override {}

  void surfacesIntersect(const SurfacesIntersectData& s, ForceData& fi, ForceData& fj) override {
    if (s.contact_flags) *s.contact_flags |= CONTACT_TANGENTIAL_MODEL;
    History history{};
    if (values > 0 && !normal_.is_new)
      std::memcpy(static_cast<void*>(&history), s.contact_history + offset_, values * sizeof(double));
    const double dt = update->dt;
    // a wall does not turn about the normal
    const Vec<double> n = vector_of(s.en), v{s.vtr1, s.vtr2, s.vtr3};
    const Vec<double> spin = s.is_wall ? vector_of(s.omega_i) : vector_of(s.omega_i) + vector_of(s.omega_j);
    Sliding<double> sliding{normal_.pressed,
                            n,
                            v,
                            dt * v,
                            0.5 * dt * dot(n, spin),
                            mu_[s.itype][s.jtype],
                            normal_.stiffness,
                            s.kt,
                            s.gammat,
                            1.0 / dt * s.gammat,
                            s.gammat > 0.0,
                            keeps(s)};
    sliding.pressed.load = s.Fn;
    const Vec<double> F = Friction::template force<flattens>(sliding, history, Booking{normal_.tally, s, *this});
    if (values > 0 && sliding.keeps) std::memcpy(s.contact_history + offset_, &history, values * sizeof(double));
    add_friction(s, F, fi, fj);
  }

  void surfacesClose(SurfacesCloseData& s, ForceData&, ForceData&) override {
    if (s.contact_flags) *s.contact_flags &= ~CONTACT_TANGENTIAL_MODEL;
    if (values > 0 && s.contact_history) std::fill_n(s.contact_history + offset_, values, 0.0);
  }

 private:
  /// Books the work of friction, if it is requested.
  struct Booking {
    EnergyTally* tally;
    const SurfacesIntersectData& s;
    const FrictionModel& model;

    template <class Work>
    void friction(const Work& work) const {
      if (!tally) return;
      const FrictionWork<double> w = work();
      tally->add_friction(s.is_wall, w.lost, w.stored, {s.i, s.j, model.atom->nlocal});
    }
  };

  const NormalContactState& normal_;
  double** mu_ = nullptr;
  int offset_ = 0;
};

/// LIGGGHTS's tangential history with the dashpot inside the limit of friction, where its class has it outside.
class LiggghtsSpring : public TangentialModel<TANGENTIAL_HISTORY> {
  using Spring = TangentialModel<TANGENTIAL_HISTORY>;

 public:
  template <class Site>
  explicit LiggghtsSpring(const Site& site) : Spring(site.lmp, site.history, site.contact) {}

  void connectToProperties(PropertyRegistry& registry) override {
    Spring::connectToProperties(registry);
    registry.connect("coeffFrict", mu_, SlidingSpring::name);
  }

  void surfacesIntersect(const SurfacesIntersectData& s, ForceData& fi, ForceData& fj) override {
    if (!(s.gammat > 0.0)) return Spring::surfacesIntersect(s, fi, fj);
    SurfacesIntersectData undamped = s;
    undamped.gammat = 0.0;
    undamped.area_ratio = 1.0;
    ForceData of_spring, none;
    Spring::surfacesIntersect(undamped, of_spring, none);
    const Vec<double> spring = vector_of(of_spring.delta_F), v{s.vtr1, s.vtr2, s.vtr3};
    const Vec<double> F = with_dashpot(spring, s.gammat, v, mu_[s.itype][s.jtype] * std::fabs(s.Fn));
    s.P_diss = undamped.P_diss;
    if (heating) s.P_diss += dot(spring - F, v);
    add_friction(s, F, fi, fj);
  }

 private:
  double** mu_ = nullptr;
};

/// Rolling friction.
template <class Friction>
class RollingFrictionModel : public RollingModelBase {
 public:
  template <class Site>
  explicit RollingFrictionModel(const Site& site) : RollingModelBase(site.lmp, site.history, site.contact) {
    for (int k = 0; Friction::has_history && k < 3; ++k) {
      const int at = site.history->add_history_value("rolling" + std::to_string(k), "1");
      if (k == 0) offset_ = at;
    }
  }

  void registerSettings(::Settings& settings) override { settings.registerOnOff("torsionTorque", torsion_, false); }
  void postSettings(LIGGGHTS::IContactHistorySetup*, ContactModelBase*) override {}
  void connectToProperties(PropertyRegistry& registry) override {
    registry.registerProperty("coeffRollFrict", &MODEL_PARAMS::createCoeffRollFrict);
    registry.connect("coeffRollFrict", mu_, Friction::name);
  }
  void beginPass(SurfacesIntersectData&, ForceData&, ForceData&) override {}
  void endPass(SurfacesIntersectData&, ForceData&, ForceData&) override {}

  void surfacesIntersect(SurfacesIntersectData& s, ForceData& fi, ForceData& fj) override {
    if (Friction::has_history && s.contact_flags) *s.contact_flags |= CONTACT_ROLLING_MODEL;
    const Vec<double> spin = vector_of(s.omega_i);
    const epdem::Rolling<double> rolling{vector_of(s.en),
                                         s.is_wall ? s.rinv * (s.cri * spin) : spin - vector_of(s.omega_j),
                                         s.is_wall ? s.radi : reduced_finite(s.radi, s.radj),
                                         s.deltan,
                                         s.Fn,
                                         s.kn,
                                         s.kt,
                                         mu_[s.itype][s.jtype],
                                         update->dt,
                                         torsion_};
    Vec<double> history{};
    if (Friction::has_history) history = vector_of(s.contact_history + offset_);
    const Vec<double> torque = s.is_wall ? Friction::template torque<true>(rolling, history)
                                         : Friction::template torque<false>(rolling, history);
    if (Friction::has_history && keeps(s)) std::memcpy(s.contact_history + offset_, &history, sizeof history);
    add(fi.delta_torque, -1.0, torque);
    add(fj.delta_torque, 1.0, torque);
  }

  void surfacesClose(SurfacesCloseData& s, ForceData&, ForceData&) override {
    if (!Friction::has_history) return;
    if (s.contact_flags) *s.contact_flags &= ~CONTACT_ROLLING_MODEL;
    if (s.contact_history) std::fill_n(s.contact_history + offset_, 3, 0.0);
  }

 private:
  double** mu_ = nullptr;
  bool torsion_ = false;
  int offset_ = 0;
};

/// Cohesion along the normal.
template <class Cohesion>
class AttractionModel : public CohesionModelBase {
 public:
  template <class Site>
  explicit AttractionModel(const Site& site) : CohesionModelBase(site.lmp, site.history, site.contact) {}

  void registerSettings(::Settings& settings) override { settings.registerOnOff("tangential_reduce", slides_, false); }
  void postSettings(LIGGGHTS::IContactHistorySetup*, ContactModelBase*) override {}
  void connectToProperties(PropertyRegistry& registry) override {
    registry.registerProperty("cohEnergyDens", &MODEL_PARAMS::createCohesionEnergyDensity);
    registry.connect("cohEnergyDens", density_, Cohesion::name);
  }
  void beginPass(SurfacesIntersectData&, ForceData&, ForceData&) override {}
  void endPass(SurfacesIntersectData&, ForceData&, ForceData&) override {}
  void endSurfacesIntersect(SurfacesIntersectData&, ForceData&, ForceData&) override {}

  void surfacesIntersect(SurfacesIntersectData& s, ForceData& fi, ForceData& fj) override {
    if (s.contact_flags) *s.contact_flags |= CONTACT_COHESION_MODEL;
    Kinematics<double> c{};
    c.radius_i = s.radi;
    c.radius_j = s.is_wall ? 0.0 : s.radj;
    c.R_star = s.is_wall ? s.radi : reduced_finite(s.radi, s.radj);
    c.distance = s.r;
    c.overlap = s.is_wall ? s.radi - s.r : s.radsum - s.r;
    c.normal = vector_of(s.en);
    const double density = density_[s.itype][s.jtype];
    const double pull =
        s.is_wall ? Cohesion::template force<true>(c, density) : Cohesion::template force<false>(c, density);
    if (slides_) s.Fn += pull;
    add(fi.delta_F, s.is_wall ? s.area_ratio * pull : pull, c.normal);
    if (!s.is_wall) add(fj.delta_F, -pull, c.normal);
  }

  void surfacesClose(SurfacesCloseData& s, ForceData&, ForceData&) override {
    if (s.contact_flags) *s.contact_flags &= ~CONTACT_COHESION_MODEL;
  }

 private:
  double** density_ = nullptr;
  bool slides_ = false;
};

}  // namespace epdem::liggghts
