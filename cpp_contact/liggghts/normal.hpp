// SPDX-License-Identifier: GPL-2.0-or-later
// A law as LIGGGHTS sees it: reads the contact, calls step(), writes force and stiffness. No physics in here.
#pragma once

#include <cmath>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include "epdem/adhesive.hpp"
#include "epdem/friction.hpp"
#include "epdem/tangential.hpp"
#include "epdem/viscous.hpp"
#include "grip.hpp"
#include "host.hpp"
#include "materials.hpp"
#include "strain.hpp"

namespace epdem::liggghts {

using namespace LIGGGHTS::ContactModels;

/// Normal model of one law for pairs (wall = false) or walls.
///
/// History: what a law that yields remembers (doubles), and for pairs the step of the last evaluation that was kept.
/// LIGGGHTS does not report that a pair parted, so a contact whose last evaluation is older than one step is a new one,
/// for the law and for all models that remember something beside it. Walls need no step: their end is reported.
///
/// A contact with adhesion stands across a gap as well: LIGGGHTS then calls surfacesClose, and the model takes it as a
/// contact like any other (Model::surfacesClose).
template <class Law, bool wall, bool others_remember>
class Normal : protected LAMMPS_NS::Pointers {
  static constexpr int memory = epdem::memory<Law>;
  static constexpr bool remembers = memory > 0;
  static constexpr bool stamped = !wall && (remembers || others_remember);

 public:
  Normal(LAMMPS_NS::LAMMPS* lmp, LIGGGHTS::IContactHistorySetup* setup) : Pointers(lmp), model_(model_name<Law>()) {
    static_assert(std::is_trivially_copyable_v<State<Law>>);
    if constexpr (remembers) {
      // Flag "0": an even quantity; "1" would change its sign when the pair is stored from the other side.
      for (const char* slot : State<Law>::slots) {
        const int at = setup->add_history_value(slot, "0");
        if (offset_ < 0) offset_ = at;
      }
    }
    if constexpr (stamped) {
      stamp_ = setup->add_history_value("last_step", "0");
      if (remembers && stamp_ != offset_ + memory) fail("its history values are not side by side");
      pair_ = dynamic_cast<LAMMPS_NS::PairGran*>(setup);
      if (!pair_) fail("its history belongs to no pair style of LIGGGHTS");
      clock_ = update->ntimestep;
    }
    if constexpr (wall && adheres<Law>) {
      wall_ = dynamic_cast<LAMMPS_NS::FixWallGran*>(setup);
      if (!wall_) fail("its history belongs to no wall of LIGGGHTS");
    }
  }

  void registerSettings(::Settings& settings) {
    settings.registerOnOff("computePlasticWork", plastic_work_, false);
    settings.registerOnOff("computeContactStrain", contact_strain_, false);
    settings.registerOnOff("tangential_damping", tangential_damping_, true);
    settings.registerOnOff("viscous", viscous_, false);
    settings.registerOnOff("limitForce", limit_force_, false);
    settings.registerOnOff("heating_normal_hertz", heating_, false);
    settings.registerOnOff("heating_tracking", heating_tracking_, false);
    settings.registerOnOff("computeElasticPotential", elastic_potential_, false);
    settings.registerOnOff("computeDissipatedEnergy", dissipated_energy_, false);
    settings.registerOnOff("disableNormalWhenBonded", disable_when_bonded_, false);
  }

  /// rubs: the tangential model beside it computes its work.
  void postSettings(bool rubs) {
    rubs_ = rubs;
    // limitForce and heating_tracking change nothing: the force is never negative, the law makes no viscous heat
    if (adheres<Law> && limit_force_) refuse("limitForce", "it would take the attraction away");
    if (heating_) refuse("heating_normal_hertz", "it is the heat of a viscous normal force, and this law has none");
    if (elastic_potential_)
      refuse("computeElasticPotential", "LIGGGHTS integrates nothing for it (use computePlasticWork)");
    if (dissipated_energy_)
      refuse("computeDissipatedEnergy", "it would miss the plastic work (use computePlasticWork)");
    if (disable_when_bonded_) refuse("disableNormalWhenBonded", "bonds are not part of the public LIGGGHTS");
    if (plastic_work_ && !wall) ledger_.create(lmp, rubs_, adheres<Law>);
    if (contact_strain_ && !wall) LargestStrain::create(lmp);
  }

  /// cohesive: area on which cohesion pulls over that of the overlap's lens, 0 without cohesion.
  void connectToProperties(PropertyRegistry& registry, Dashpot dashpot, double cohesive) {
    if (!only_spheres(lmp))
      fail("it is for spheres; give other particles a model of LIGGGHTS with surface superquadric");
    // Rebuilt at every init: LIGGGHTS frees all properties there, and the user may have changed them.
    if (!tangential_damping_ && dashpot == Dashpot::optional) dashpot = Dashpot::off;
    const Declaration law{model_.c_str(), Law::parameters,    Law::n_parameters,      &Law::valid,
                          Law::strength,  Law::default_ratio, Law::strength_by_ratio, adheres<Law>};
    const Materials m = read_materials(lmp, registry, law, dashpot, viscous_);
    width_ = m.width;
    table_.assign(m.pairs.size(), Entry{});
    for (int i = 1; i < width_; ++i)
      for (int j = 1; j < width_; ++j) {
        const PairOfTypes& p = m.pairs[i * width_ + j];
        table_[i * width_ + j] = {Law(effective_modulus(p.i, p.j), p.parameters.data()),
                                  effective_shear_modulus(p.i, p.j), p.damping_number, p.viscous_number};
      }
    if (cohesive > 0.0) {
      std::vector<double> resists;
      for (const Entry& t : table_) resists.push_back(resistance(t.law) / cohesive);
      compare_cohesion(lmp, model_.c_str(), width_, resists);
    }
    if (plastic_work_) ledger_.connect(lmp, model_, rubs_, adheres<Law>);
    if (contact_strain_) strain_.connect(lmp, model_);
    grip_.ledger = ledger();
    if constexpr (adheres<Law>) reach();
  }

  double stressStrainExponent() const { return 1.5; }

  /// What a pair of types has in common.
  struct Entry {
    Law law;
    double G_star = 0.0, damping_number = 0.0, viscous_number = 0.0;
  };
  int width() const { return width_; }
  const Entry& entry(int i, int j) const { return table_[i * width_ + j]; }
  double now() const { return now_; }
  Ledger* ledger() { return plastic_work_ ? &ledger_ : nullptr; }
  LargestStrain* strain() { return contact_strain_ ? &strain_ : nullptr; }
  const Grip* grip() const { return &grip_; }

  /// LIGGGHTS calls it before the loop over all pairs, never for walls.
  void beginPass(const SurfacesIntersectData& s) {
    const bool keep = s.computeflag && s.shearupdate;
    if (plastic_work_ && keep) ledger_.open(atom->nlocal);
    if constexpr (stamped) {
      const bigint expected = clock_ + (keep ? 1 : 0);
      if (update->ntimestep != expected) move_clock(update->ntimestep - expected);
      clock_ = update->ntimestep;
      now_ = static_cast<double>(clock_);
    }
  }

  void surfacesIntersect(SurfacesIntersectData& s, ForceData& fi, ForceData& fj) {
    if (s.contact_flags) *s.contact_flags |= CONTACT_NORMAL_MODEL;
    const Entry& t = table_[s.itype * width_ + s.jtype];
    const double R_star = wall ? s.radi : reduced_finite(s.radi, s.radj);
    const double delta = wall ? s.deltan : s.radsum - s.r;
    const bool keep = s.computeflag && s.shearupdate;

    State<Law> before{};
    double* const history = s.contact_history;
    if constexpr (remembers) std::memcpy(static_cast<void*>(&before), history + offset_, sizeof before);
    if constexpr (stamped) {
      grip_.fresh = now_ - history[stamp_] > 1.0;
      if (grip_.fresh) before = parted(history, keep);
    }
    if constexpr (adheres<Law> && others_remember)
      if (keep && !(before.root > 0.0)) forget_others(history);

    // with adhesion: a step that is not kept repeats the last one that was
    const Step<Law> now = step(t.law, R_star, before, delta, keep ? -s.vn * update->dt : 0.0);

    if (keep) {
      if (plastic_work_) ledger_.template book<wall>(t.law, R_star, before, now, delta, {s.i, s.j, atom->nlocal});
      if (contact_strain_) strain_.note(s.i, now.radius / R_star, delta / R_star);
      if constexpr (remembers) std::memcpy(history + offset_, &now.after, sizeof now.after);
      if constexpr (stamped) history[stamp_] = now_;
    }

    double force = now.force;
    if constexpr (adheres<Law>)
      if (!keep) force += before.jump;
    if (t.viscous_number > 0.0) force = damped_force(t.law, R_star, before, now, t.viscous_number, s.meff, -s.vn);

    grip_.stiffness = 8.0 * t.G_star;
    grip_.pressed = pressed_by(now, now.force);

    s.Fn = sliding_load(t.law, R_star, now, force);  // friction's limit is mu times it, after what cohesion made of it
    s.kn = 4.0 / 3.0 * t.law.E_star * now.radius;    // LIGGGHTS's convention for rolling friction: F/alpha of Hertz
    if (adheres<Law> && !(delta > 0.0)) s.kn = 0.0;  // rolling friction by the overlap has none across a gap
    s.kt = tangential_stiffness(t.G_star, now.radius);
    s.gamman = 0.0;
    s.gammat = t.damping_number > 0.0 ? tangential_damping(t.damping_number, s.kt, s.meff) : 0.0;

    const double share = wall ? force * s.area_ratio : force;
    for (int k = 0; k < 3; ++k) {
      fi.delta_F[k] += share * s.en[k];
      if constexpr (!wall) fj.delta_F[k] -= share * s.en[k];
    }
  }

  /// Whether bodies that do not overlap are in contact, or parted in the very step that is evaluated once more.
  template <class Close>
  bool pulls(const Close& s) const {
    if constexpr (!adheres<Law>) return false;
    if (!s.contact_history) return false;
    const bool keep = s.computeflag && s.shearupdate;
    if constexpr (stamped)
      if (now_ - s.contact_history[stamp_] > keep) return false;
    State<Law> before;
    std::memcpy(static_cast<void*>(&before), s.contact_history + offset_, sizeof before);
    return before.root > 0.0 || (before.jump != 0.0 && !keep);
  }

  /// What LIGGGHTS prepares only for pairs that overlap, by its own operations.
  void prepare(SurfacesIntersectData& s) const {
    if constexpr (!wall) {
      s.r = LAMMPS_NS::vectorMag3D(s.delta);
      s.rinv = 1.0 / s.r;
      for (int k = 0; k < 3; ++k) s.en[k] = s.delta[k] * s.rinv;
      s.omega_i = atom->omega[s.i];
      s.omega_j = atom->omega[s.j];
      s.mi = atom->rmass ? atom->rmass[s.i] : atom->mass[s.itype];
      s.mj = atom->rmass ? atom->rmass[s.j] : atom->mass[s.jtype];
      if (pair_->fr_pair()) {
        if (pair_->mr_pair()[s.i] > 0.0) s.mi = pair_->mr_pair()[s.i];
        if (pair_->mr_pair()[s.j] > 0.0) s.mj = pair_->mr_pair()[s.j];
      }
      s.meff = s.mi * s.mj / (s.mi + s.mj);
      if (atom->mask[s.i] & pair_->freeze_group_bit()) s.meff = s.mj;
      if (atom->mask[s.j] & pair_->freeze_group_bit()) s.meff = s.mi;
    }
  }

  void surfacesClose(SurfacesCloseData& s) {
    if (s.contact_flags) *s.contact_flags &= ~CONTACT_NORMAL_MODEL;
    if (remembers && s.contact_history) std::fill_n(s.contact_history + offset_, memory, 0.0);
  }

 private:
  /// LIGGGHTS looks at bodies that do not overlap up to a share of the sum of their radii (of a wall: of the radius).
  /// The largest gap, 1.6088 (Gamma^2 R*/E*^2)^(1/3), takes the largest share of the smallest sphere at a wall; half a
  /// hundredth more is for the step after the last one in contact.
  void reach() {
    const double smallest = smallest_radius(lmp);
    if (!std::isfinite(smallest)) return;  // no spheres, and nothing that will add any
    double gap = 0.0;
    for (int i = 1; i < width_; ++i)
      for (int j = 1; j < width_; ++j) gap = std::max(gap, adhesive::largest_gap(entry(i, j).law.c, smallest));
    const double factor = 1.005 + gap / smallest;
    if (!(factor > neighbor->contactDistanceFactor)) return;
    neighbor->register_contact_dist_factor(factor);
    char line[160];
    std::snprintf(line, sizeof line,
                  "epdem: %s pulls across gaps up to %.4g (radius %.4g), contact distance factor %.9g", model_.c_str(),
                  gap, smallest, factor);
    say(lmp, line);
  }

  /// Bodies that touch without being in contact (inside a dent) begin anew in all other models.
  void forget_others(double* history) const {
    const int first = offset_ + memory + stamped, last = wall ? wall_->dnum() : pair_->dnum_pair();
    std::fill_n(history + first, std::max(0, last - first), 0.0);
  }

  /// The pair parted since its last evaluation: it is a new contact, for the other models as well.
  State<Law> parted(double* history, bool keep) const {
    const int first = stamp_ - memory;
    if (keep) std::fill_n(history + first, pair_->dnum_pair() - first, 0.0);
    return {};
  }

  /// reset_timestep came between two runs: the stored steps move with it.
  void move_clock(bigint shift) const {
    const LAMMPS_NS::NeighList* lists[] = {pair_->list, pair_->listgranhistory};
    if (!lists[0] || !lists[1]) return;
    const int width = pair_->dnum();
    for (int n = 0; n < lists[0]->inum; ++n) {
      const int i = lists[0]->ilist[n];
      for (int k = 0; k < lists[0]->numneigh[i]; ++k)
        lists[1]->firstdouble[i][k * width + stamp_] += static_cast<double>(shift);
    }
  }

  void fail(const std::string& what) const { error->all(FLERR, ("model " + model_ + ": " + what).c_str()); }

  void refuse(const char* setting, const char* reason) const {
    fail(std::string("setting ") + setting + " on is not available: " + reason);
  }

  const std::string model_;
  std::vector<Entry> table_;
  int width_ = 0, offset_ = -1, stamp_ = -1;
  LAMMPS_NS::PairGran* pair_ = nullptr;
  LAMMPS_NS::FixWallGran* wall_ = nullptr;
  bigint clock_ = 0;  // step of the last pass
  double now_ = 0.0;
  Ledger ledger_;
  LargestStrain strain_;
  Grip grip_{{}, 0.0, false, Law::flattens, nullptr};
  bool rubs_ = false;
  bool plastic_work_ = false, contact_strain_ = false;
  bool viscous_ = false, tangential_damping_ = true, limit_force_ = false, heating_ = false, heating_tracking_ = false;
  bool elastic_potential_ = false, dissipated_energy_ = false, disable_when_bonded_ = false;
};

}  // namespace epdem::liggghts
