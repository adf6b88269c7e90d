// SPDX-License-Identifier: GPL-2.0-or-later
// A law as LIGGGHTS sees it: reads the contact, calls step(), writes force and stiffness. No physics in here.
#pragma once

#include <cstring>
#include <memory>

#include "epdem/compaction.hpp"
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
    double delta = wall_ ? s.deltan : s.radsum - s.r;
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

    const double overlap = delta;
    Grown<double> grown{};
    double now_added = 0.0, last_added = 0.0;
    if constexpr (compacts<Law>)
      if (compaction_) {
        last_added = has_step() && state_.is_new ? 0.0 : history[growth_slot_ + !keep];
        now_added = keep ? added_overlap_of(s, before.delta_max) : last_added;
        grown = grow<Law>(before, overlap, now_added, last_added);
        delta += grown.added;
        s.deltan = delta;  // for the models beside the law
      }

    // a step that is not kept repeats the last one that was
    const NormalContact<Law> contact = normal_contact(
        pair, R_star, before, delta, keep ? -s.vn * update->dt : 0.0, -s.vn, pair.damping > 0.0, pair.dashpot > 0.0,
        [&] { return s.meff; }, !keep);
    const Step<Law>& now = contact.step;

    if (keep) {
      double loss = 0.0;
      State<Law> after = now.after;
      if constexpr (compacts<Law>)
        if (compaction_) {
          const double reached = largest_overlap(grown, overlap);
          if (plastic_work_) loss = growth_loss(pair.law, R_star, reached, overlap, now_added, last_added);
          after.delta_max = reached;
          history[growth_slot_] = now_added;
          history[growth_slot_ + 1] = grown.added;
          const auto depths = wall_ ? depths_of<true>(s.radi, 0.0, reached) : depths_of<false>(s.radi, s.radj, reached);
          growth_.add(s.i, depths.i);
          if (!wall_ && s.j < atom->nlocal) growth_.add(s.j, depths.j);
        }
      if (plastic_work_) ledger_.book(wall_, pair.law, R_star, before, now, delta, loss, {s.i, s.j, atom->nlocal});
      if (contact_strain_) strain_.note(s.i, now.radius / R_star, delta / R_star);
      if constexpr (size > 0) std::memcpy(history + offset_, &after, sizeof after);
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
    if constexpr (compacts<Law>) {
      return compaction_ && stands(s);
    } else if constexpr (!adheres<Law>) {
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
  double added_overlap_of(const SurfacesCloseData& s, double delta_max) const {
    return wall_ ? added_overlap<true>(s.radi, 0.0, delta_max, growth_.of(s.i), 0.0)
                 : added_overlap<false>(s.radi, s.radj, delta_max, growth_.of(s.i), growth_.of(s.j));
  }

  /// Whether grown bodies that do not overlap are in contact.
  bool stands(const SurfacesCloseData& s) const {
    const bool keep = s.computeflag && s.shearupdate;
    const bool known = !has_step() || now_ - s.contact_history[step_slot_] <= keep;
    if (!keep) return known && closes_gap(s.radsum, s.rsq, s.contact_history[growth_slot_]);
    return closes_gap(s.radsum, s.rsq, added_overlap_of(s, known ? s.contact_history[offset_] : 0.0));
  }

  static Declaration declaration() {
    return {model_name<Law>(),  Law::parameters,        Law::n_parameters, &Law::valid,  Law::strength,
            Law::default_ratio, Law::strength_by_ratio, adheres<Law>,      compacts<Law>};
  }

  std::vector<ContactConstants<Law>> table_;  // by types
};

}  // namespace epdem::liggghts
