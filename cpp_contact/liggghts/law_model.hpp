// SPDX-License-Identifier: GPL-2.0-or-later
// A law as LIGGGHTS sees it: reads the contact, calls step(), writes force and stiffness. No physics in here.
#pragma once

#include <cstring>
#include <memory>

#include "epdem/contact.hpp"
#include "epdem/laws.hpp"
#include "kernels/block.hpp"
#include "normal.hpp"

namespace epdem::liggghts {

template <class Law>
class LawModel : public NormalModel {
  static constexpr int size = epdem::history_size<Law>;

 public:
  LawModel(LAMMPS_NS::LAMMPS* lmp, LIGGGHTS::IContactHistorySetup* setup, bool wall, bool others_have_history)
      : NormalModel(lmp, setup, wall, others_have_history, declaration(), State<Law>::slots, size) {
    static_assert(std::is_trivially_copyable_v<State<Law>>);
    state_.flattens = Law::flattens;
  }

  int place() const override { return detail::place<Law>(); }
  int root_slot() const override {
    if constexpr (adheres<Law>) return offsetof(State<Law>, root) / sizeof(double);
    return -1;
  }
  void put_constants(int i, int j, double* c) const override {
    static_assert(sizeof(ContactConstants<Law>) <= kernels::most_constants * sizeof(double));
    std::memcpy(c, &table_[i * width_ + j], sizeof(ContactConstants<Law>));
  }

  void surfacesIntersect(SurfacesIntersectData& s, ForceData& fi, ForceData& fj) override {
    if (s.contact_flags) *s.contact_flags |= CONTACT_NORMAL_MODEL;
    const ContactConstants<Law>& pair = table_[s.itype * width_ + s.jtype];
    const double R_star = wall_ ? s.radi : reduced_finite(s.radi, s.radj);
    const double delta = wall_ ? s.deltan : s.radsum - s.r;
    const bool keep = s.computeflag && s.shearupdate;

    State<Law> before{};
    double* const history = s.contact_history;
    if constexpr (size > 0) std::memcpy(static_cast<void*>(&before), history + offset_, sizeof before);
    if (has_step()) {
      state_.is_new = is_new(history, keep);
      if (state_.is_new) before = {};
    }
    if constexpr (adheres<Law>)
      if (others_have_history_ && keep && !(before.root > 0.0)) forget_others(history);

    // a step that is not kept repeats the last one that was
    const NormalContact<Law> contact = normal_contact(
        pair, R_star, before, delta, keep ? -s.vn * update->dt : 0.0, -s.vn, pair.damping > 0.0, pair.dashpot > 0.0,
        [&] { return s.meff; }, !keep);
    const Step<Law>& now = contact.step;

    if (keep) {
      if (plastic_work_) ledger_.book(wall_, pair.law, R_star, before, now, delta, {s.i, s.j, atom->nlocal});
      if (contact_strain_) strain_.note(s.i, now.radius / R_star, delta / R_star);
      if constexpr (size > 0) std::memcpy(history + offset_, &now.after, sizeof now.after);
      if (has_step()) history[step_slot_] = now_;
    }

    state_.stiffness = 8.0 * pair.shear_modulus;
    state_.pressed = pressed_by(now, now.force);
    s.Fn = contact.load;  // friction's limit is mu times it, after what cohesion made of it
    s.kn = contact.k_n;
    s.kt = contact.k_t;
    s.gamman = 0.0;
    s.gammat = contact.damping;

    const double share = wall_ ? contact.force * s.area_ratio : contact.force;
    for (int k = 0; k < 3; ++k) {
      fi.delta_F[k] += share * s.en[k];
      if (!wall_) fj.delta_F[k] -= share * s.en[k];
    }
  }

  bool attracts(const SurfacesCloseData& s) const override {
    if constexpr (!adheres<Law>) {
      return false;
    } else {
      if (!s.contact_history) return false;
      const bool keep = s.computeflag && s.shearupdate;
      if (has_step() && now_ - s.contact_history[step_slot_] > keep) return false;
      State<Law> before;
      std::memcpy(static_cast<void*>(&before), s.contact_history + offset_, sizeof before);
      return before.root > 0.0 || (before.jump != 0.0 && !keep);
    }
  }

 protected:
  void set_materials(const Materials& m) override {
    table_.assign(m.pairs.size(), ContactConstants<Law>{});
    for (int i = 1; i < width_; ++i)
      for (int j = 1; j < width_; ++j) {
        const PairOfTypes& p = m.pairs[i * width_ + j];
        ContactConstants<Law>& pair = table_[i * width_ + j];
        pair.law = Law(effective_modulus(p.i, p.j), p.parameters.data());
        pair.shear_modulus = effective_shear_modulus(p.i, p.j);
        pair.damping = p.damping_number;
        pair.dashpot = p.viscous_number;
      }
  }

  std::vector<double> resistances(double cohesive) const override {
    std::vector<double> all;
    for (const auto& pair : table_) all.push_back(resistance(pair.law) / cohesive);
    return all;
  }

  double largest_gap(double smallest_radius) const override {
    double gap = 0.0;
    if constexpr (adheres<Law>)
      for (int i = 1; i < width_; ++i)
        for (int j = 1; j < width_; ++j)
          gap = std::max(gap, adhesive::largest_gap(table_[i * width_ + j].law.c, smallest_radius));
    return gap;
  }

 private:
  static Declaration declaration() {
    return {model_name<Law>(), Law::parameters,    Law::n_parameters,      &Law::valid,
            Law::strength,     Law::default_ratio, Law::strength_by_ratio, adheres<Law>};
  }

  std::vector<ContactConstants<Law>> table_;  // by types
};

}  // namespace epdem::liggghts
