// SPDX-License-Identifier: GPL-2.0-or-later
// The tangential models `ep/partial_slip` (3 nodes) and `ep/partial_slip_2` (2 nodes) as LIGGGHTS sees them: read what
// the law beside them found, call partial_slip(), write force and torque. No physics in here.
#pragma once

#include <cstring>
#include <string>

#include "host.hpp"
#include "normal_state.hpp"

namespace epdem::liggghts {

using namespace LIGGGHTS::ContactModels;

/// Friction with partial slip beside one of our laws, for pairs (wall = false) or walls; `normal` is the law's own.
template <int nodes, bool flattens>
class PartialSlip : public TangentialModelBase {
  static constexpr int history_size = 3 * nodes + 1;
  using State = SlipState<nodes, double>;
  static_assert(sizeof(State) == history_size * sizeof(double));

 public:
  template <class Site>
  explicit PartialSlip(const Site& site)
      : TangentialModelBase(site.lmp, site.history, site.contact), normal_(*site.normal) {
    // Flag "1": these change their sign when the pair is stored from the other side; the radius does not.
    for (int k = 0; k < 3 * nodes; ++k) {
      const int at = site.history->add_history_value("stretch" + std::to_string(k), "1");
      if (k == 0) offset_ = at;
    }
    site.history->add_history_value("stretch_radius", "0");
  }

  void registerSettings(::Settings&) override {}
  void postSettings(LIGGGHTS::IContactHistorySetup*, ContactModelBase*) override {}
  void connectToProperties(PropertyRegistry& registry) override {
    registry.registerProperty("coeffFrict", &MODEL_PARAMS::createCoeffFrict);
    registry.connect("coeffFrict", mu_, "tangential_model ep/partial_slip");
  }
  void beginPass(SurfacesIntersectData&, ForceData&, ForceData&) override {}
  void endPass(SurfacesIntersectData&, ForceData&, ForceData&) override {}

  void surfacesIntersect(const SurfacesIntersectData& s, ForceData& fi, ForceData& fj) override {
    if (s.contact_flags) *s.contact_flags |= CONTACT_TANGENTIAL_MODEL;
    double* const history = s.contact_history + offset_;
    State before{};
    if (!normal_.is_new) std::memcpy(static_cast<void*>(&before), history, sizeof before);
    Pressed<double> now = normal_.pressed;
    now.load = s.Fn;
    const double dt = update->dt, mu = mu_[s.itype][s.jtype];
    // a wall does not turn about the normal
    const Vec<double> n{s.en[0], s.en[1], s.en[2]};
    Vec<double> w{s.omega_i[0], s.omega_i[1], s.omega_i[2]};
    if (!s.is_wall) w = w + Vec<double>{s.omega_j[0], s.omega_j[1], s.omega_j[2]};
    const Shear<double> motion{n, {dt * s.vtr1, dt * s.vtr2, dt * s.vtr3}, 0.5 * dt * dot(n, w), 1.0 / dt * s.gammat};
    if (s.gammat > 0.0)
      apply<true>(s, before, now, motion, mu, history, fi, fj);
    else
      apply<false>(s, before, now, motion, mu, history, fi, fj);
  }

  void surfacesClose(SurfacesCloseData& s, ForceData&, ForceData&) override {
    if (s.contact_flags) *s.contact_flags &= ~CONTACT_TANGENTIAL_MODEL;
    if (s.contact_history) std::fill_n(s.contact_history + offset_, history_size, 0.0);
  }

 private:
  template <bool damped>
  void apply(const SurfacesIntersectData& s, const State& before, const Pressed<double>& now,
             const Shear<double>& motion, double mu, double* history, ForceData& fi, ForceData& fj) {
    Vec<double> T;
    if (s.computeflag && s.shearupdate) {
      const auto step = partial_slip<nodes, flattens, damped>(before, now, motion, normal_.stiffness, mu);
      T = step.force;
      if (normal_.ledger) {
        const double lost = slip_loss(before, step, motion.slip, normal_.stiffness);
        const double held = slip_energy(step.after, normal_.stiffness);
        const Ledger::Bodies bodies{s.i, s.j, atom->nlocal};
        normal_.ledger->book_friction(s.is_wall, lost, held, bodies);
      }
      std::memcpy(history, &step.after, sizeof step.after);
    } else {
      T = present_friction<nodes, damped>(before, now.load, motion, normal_.stiffness, mu);
    }
    const double share = s.is_wall ? s.area_ratio : 1.0;
    const double force[3] = {T.x, T.y, T.z};
    const Vec<double> lever = cross(motion.normal, T);
    const double torque[3] = {lever.x, lever.y, lever.z};
    for (int k = 0; k < 3; ++k) {
      fi.delta_F[k] += share * force[k];
      fi.delta_torque[k] += share * (-s.cri * torque[k]);
      if (s.is_wall) continue;
      fj.delta_F[k] -= force[k];
      fj.delta_torque[k] += -s.crj * torque[k];
    }
  }

  const NormalContactState& normal_;
  double** mu_ = nullptr;
  int offset_ = -1;
};

}  // namespace epdem::liggghts
