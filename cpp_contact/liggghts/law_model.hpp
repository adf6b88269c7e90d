// SPDX-License-Identifier: GPL-2.0-or-later
// A law as LIGGGHTS sees it: reads the contact, calls step(), writes force and stiffness. No physics in here.
#pragma once

#include <cmath>
#include <cstring>
#include <memory>

#include "epdem/contact.hpp"
#include "epdem/laws.hpp"
#include "epdem/range.hpp"
#include "kernels/block.hpp"
#include "normal.hpp"

namespace epdem::liggghts {

template <class Law>
class LawModel : public NormalModel {
  static constexpr int size = epdem::history_size<Law>;

 public:
  LawModel(LAMMPS_NS::LAMMPS* lmp, LIGGGHTS::IContactHistorySetup* setup, bool wall, bool others_have_history)
      : NormalModel(lmp, setup, wall, others_have_history, declaration(), State<Law>::slots, size, gap_places<Law>()) {
    static_assert(std::is_trivially_copyable_v<State<Law>>);
    state_.flattens = Law::flattens;
  }

  int place() const override { return detail::place<Law>(); }
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
    if constexpr (adheres<Law>)
      if (judges() && R_star < least()[s.itype * width_ + s.jtype]) refuse_contact(s.i, wall_ ? -1 : s.j, s.jtype);

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
    NormalEnergies<double> energies{};
    const Observer observer{keep && plastic_work_ ? &energies : nullptr};
    const auto normal = [&](auto&& growth) {
      return normal_contact(
          pair, R_star, s.radi, before, delta, keep ? -s.vn * update->dt : 0.0, -s.vn, pair.damping > 0.0,
          pair.dashpot > 0.0, [&] { return s.meff; }, !keep, observer, growth);
    };
    NormalContact<Law> contact;
    if constexpr (compacts<Law>) {
      if (compaction_)
        contact = wall_ ? grown<true>(s, keep, normal) : grown<false>(s, keep, normal);
      else
        contact = normal(NoGrowth{});
      s.deltan = contact.overlap;  // for the models beside the law
    } else {
      contact = normal(NoGrowth{});
    }
    const Step<Law>& now = contact.step;

    if (keep) {
      if (plastic_work_) tally_.add(wall_, energies, now.radius > 0.0, {s.i, s.j, atom->nlocal});
      if (contact_strain_) {
        const double share = larger_share(pair.bodies) / R_star;
        strain_.note(s.i, share * now.radius, share * contact.overlap);
      }
      if constexpr (size > 0) std::memcpy(history + offset_, &now.after, sizeof now.after);
      if (has_step()) history[step_slot_] = now_;
    }

    state_.stiffness = 8.0 * pair.shear_modulus;
    state_.pressed = pressed_by(now, now.force);
    state_.radius = now.radius;
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

 protected:
  void set_materials(const Materials& m) override {
    table_.assign(m.pairs.size(), ContactConstants<Law>{});
    for (int i = 1; i < width_; ++i)
      for (int j = 1; j < width_; ++j) {
        const PairOfTypes& p = m.pairs[i * width_ + j];
        ContactConstants<Law>& pair = table_[i * width_ + j];
        pair.bodies = body_shares(p.i, p.j, p.strain_share);
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

  double least_R_star(int i, int j) const override { return epdem::least_R_star(table_[i * width_ + j].law); }
  std::string refused_adhesion(int i, int j, double R_star) const override {
    return epdem::refused_adhesion(table_[i * width_ + j].law, R_star);
  }

 private:
  /// Gets the energies of a step, if they are requested.
  struct Observer : NoObserver {
    NormalEnergies<double>* energies;

    explicit Observer(NormalEnergies<double>* energies) : energies(energies) {}
    template <class Energies>
    void normal(const ContactConstants<Law>&, double, const Step<Law>&, double, const Energies& of_step) const {
      if (energies) *energies = of_step();
    }
  };

  /// The normal contact with growth; a step that is kept stores the state and adds the dents to the bodies.
  template <bool wall, class Normal>
  NormalContact<Law> grown(SurfacesIntersectData& s, bool keep, const Normal& normal) {
    double* const state = s.contact_history + gap_.growth;
    const double* const known = has_step() && state_.is_new ? nullptr : state;
    Growing<wall, double> growth;
    if constexpr (wall)
      growth = growing_at_wall(s.radi, growth_.of(s.i), known);
    else
      growth = growing_pair(s.radi, s.radj, growth_.of(s.i), growth_.of(s.j), known);
    if (bonds_) growth.bond = bond_[s.itype][s.jtype];
    const NormalContact<Law> contact = normal(growth);
    if (!keep) return contact;
    std::memcpy(state, &growth.state, sizeof growth.state);
    add_dent(growth_.sums() + dent_sums * long(s.i), growth.dents.i);
    if (!wall && s.j < atom->nlocal) add_dent(growth_.sums() + dent_sums * long(s.j), growth.dents.j);
    return contact;
  }

  static Declaration declaration() {
    return {model_name<Law>(), Law::parameters,    Law::n_parameters,      &Law::valid,  &hardening<Law>,
            Law::strength,     Law::default_ratio, Law::strength_by_ratio, adheres<Law>, compacts<Law>};
  }

  std::vector<ContactConstants<Law>> table_;  // by types
};

}  // namespace epdem::liggghts
