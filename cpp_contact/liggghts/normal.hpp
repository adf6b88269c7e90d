// SPDX-License-Identifier: GPL-2.0-or-later
// The normal model as LIGGGHTS sees it: settings, properties, history and the clock of all laws.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "energy_tally.hpp"
#include "epdem/exists.hpp"
#include "growth.hpp"
#include "host.hpp"
#include "materials.hpp"
#include "normal_state.hpp"
#include "simulation.hpp"
#include "strain.hpp"

namespace epdem::liggghts {

using namespace LIGGGHTS::ContactModels;

/// Normal model of one law for pairs or walls; LawModel adds the law.
///
/// History: the values that a law keeps (doubles), and for pairs the step of the last evaluation that was kept.
/// LIGGGHTS does not report that a pair parted, so a contact whose last evaluation is older than one step is a new one,
/// for the law and for all models with a history beside it. Walls need no step: their end is reported. With compaction
/// the last values are those of GrowthState.
///
/// A contact with adhesion stands across a gap as well: LIGGGHTS then calls surfacesClose, and the model takes it as a
/// contact like any other (Model::surfacesClose).
class NormalModel : protected LAMMPS_NS::Pointers {
 public:
  virtual ~NormalModel() = default;

  void registerSettings(::Settings& settings) {
    settings.registerOnOff("computePlasticWork", plastic_work_, false);
    settings.registerOnOff("computeElasticEnergy", elastic_energy_, true);
    settings.registerOnOff("computeContactStrain", contact_strain_, false);
    settings.registerOnOff("compaction", compaction_, false);
    settings.registerOnOff("tangential_damping", tangential_damping_, true);
    settings.registerOnOff("viscous", viscous_, false);
    settings.registerOnOff("limitForce", limit_force_, false);
    settings.registerOnOff("heating_normal_hertz", heating_, false);
    settings.registerOnOff("heating_tracking", heating_tracking_, false);
    settings.registerOnOff("computeElasticPotential", elastic_potential_, false);
    settings.registerOnOff("computeDissipatedEnergy", dissipated_energy_, false);
    settings.registerOnOff("disableNormalWhenBonded", disable_when_bonded_, false);
  }

  /// adds_friction: the tangential model beside it computes its work. cohesion: id of the model.
  void postSettings(LIGGGHTS::IContactHistorySetup* setup, bool adds_friction, int cohesion) {
    adds_friction_ = adds_friction;
    bonds_ = cohesion == Bond::id;
    if (bonds_ && !compaction_) fail("cohesion ep/bond holds contacts with compaction: add compaction on");
    // limitForce and heating_tracking change nothing: the force is never negative, the law makes no viscous heat
    if (law_.adheres && limit_force_) refuse("limitForce", "it would take the attraction away");
    if (heating_) refuse("heating_normal_hertz", "it is the heat of a viscous normal force, and this law has none");
    if (elastic_potential_)
      refuse("computeElasticPotential", "LIGGGHTS integrates nothing for it (use computePlasticWork)");
    if (dissipated_energy_)
      refuse("computeDissipatedEnergy", "it would miss the plastic work (use computePlasticWork)");
    if (disable_when_bonded_) refuse("disableNormalWhenBonded", "bonds are not part of the public LIGGGHTS");
    if (plastic_work_ && !wall_) tally_.create(lmp, adds_friction_, law_.adheres, elastic_energy_);
    if (contact_strain_ && !wall_) LargestStrain::create(lmp);
    if (!compaction_) return;
    if (!law_.compacts) refuse("compaction", "only ep/cavity and ep/cavity_adhesive have it");
    if (!setup) refuse("compaction", "the loops of LIGGGHTS-PFM do not have it");
    if (cohesion && !bonds_) refuse("compaction", "it is for contacts without cohesion, or with ep/bond");
    if (!wall_) Growth::create(lmp);
    using State = GrowthState<double>;
    for (int k = 0; k < growth_values; ++k) {
      const int at = setup->add_history_value(State::slots[k], State::turns(k) ? "1" : "0");
      if (gap_.growth < 0) gap_.growth = at;
    }
  }

  /// cohesive: area on which cohesion pulls, over the area of the overlap's lens; 0 without cohesion.
  void connectToProperties(PropertyRegistry& registry, Dashpot dashpot, double cohesive) {
    if (!only_spheres(lmp))
      fail("it is for spheres; give other particles a model of LIGGGHTS with surface superquadric");
    // Rebuilt at every init: LIGGGHTS frees all properties there, and the user may have changed them.
    if (!tangential_damping_ && dashpot == Dashpot::optional) dashpot = Dashpot::off;
    const Materials m = read_materials(lmp, registry, law_, dashpot, viscous_);
    width_ = m.width;
    set_materials(m);
    if (cohesive > 0.0) compare_cohesion(lmp, law_.model, width_, resistances(cohesive));
    if (plastic_work_) tally_.connect(lmp, law_.model, adds_friction_, law_.adheres, compaction_);
    if (contact_strain_) strain_.connect(lmp, law_.model);
    state_.tally = tally();
    if (law_.adheres) reach();
    if (wall_ && law_.compacts && !compaction_ && Growth::exists(lmp))
      fail("the pair style has compaction on, and this wall needs it, too");
    if (!compaction_) return;
    growth_.connect(lmp, law_.model);
    if (bonds_) {
      registry.registerProperty("cohEnergyDens", &MODEL_PARAMS::createCohesionEnergyDensity);
      registry.connect("cohEnergyDens", bond_, law_.model.c_str());
    }
    register_contact_distance(lmp, 1.0 + growth_reach);
  }

  double stressStrainExponent() const { return 1.5; }

  int width() const { return width_; }
  double now() const { return now_; }
  int history_size() const { return history_size_; }
  EnergyTally* tally() { return plastic_work_ ? &tally_ : nullptr; }
  LargestStrain* strain() { return contact_strain_ ? &strain_ : nullptr; }
  Growth* growth() { return compaction_ ? &growth_ : nullptr; }
  const NormalContactState& state() const { return state_; }

  /// LIGGGHTS calls it before the loop over all pairs, never for walls.
  void beginPass(const SurfacesIntersectData& s) {
    const bool keep = s.computeflag && s.shearupdate;
    if (contact_strain_) strain_.keep(*lmp, neighbor->lastcall == update->ntimestep);
    if (plastic_work_ && keep) tally_.open(atom->nlocal);
    if (compaction_ && keep) growth_.close(*atom);
    if (!has_step()) return;
    const bigint expected = clock_ + (keep ? 1 : 0);
    if (update->ntimestep != expected) move_clock(update->ntimestep - expected);
    clock_ = update->ntimestep;
    now_ = static_cast<double>(clock_);
  }

  /// Values that LIGGGHTS prepares only for pairs that overlap, by its own operations.
  void prepare(SurfacesIntersectData& s) const {
    if (wall_) return;
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

  void surfacesClose(SurfacesCloseData& s) {
    if (s.contact_flags) *s.contact_flags &= ~CONTACT_NORMAL_MODEL;
    if (!s.contact_history) return;
    std::fill_n(s.contact_history + offset_, history_size_, 0.0);
    if (compaction_) std::fill_n(s.contact_history + gap_.growth, growth_values, 0.0);
  }

  virtual void surfacesIntersect(SurfacesIntersectData& s, ForceData& fi, ForceData& fj) = 0;

  /// Whether bodies that do not overlap are in contact, or parted in the very step that is evaluated once more. A
  /// template, because LIGGGHTS-PFM, which does not call it, lacks members of the data.
  template <class Data>
  bool attracts(const Data& s) const {
    if (!s.contact_history || !gap_.any()) return false;
    const bool keep = s.computeflag && s.shearupdate;
    const bool known = !has_step() || now_ - s.contact_history[step_slot_] <= keep;
    Gap gap{s.rsq, s.radi, wall_ ? 0.0 : s.radj, {}, {}};
    if (compaction_) gap.i = growth_.of(s.i);
    if (compaction_ && !wall_) gap.j = growth_.of(s.j);
    return exists(gap_, known ? s.contact_history : nullptr, gap, !keep);
  }
  const GapPlaces& gap() const { return gap_; }

  /// Whether spheres of this run can be refused because of their adhesion, and the least R* of the types i * width + j.
  bool judges() const { return !least_.empty(); }
  const std::vector<double>& least() const { return least_; }
  /// Ends the run at the contact of sphere i with sphere j or, j = -1, with a wall of type_j: its R* is below the
  /// least.
  void refuse_contact(int i, int j, int type_j) const {
    const double R_i = atom->radius[i], R_star = j < 0 ? R_i : reduced_finite(R_i, atom->radius[j]);
    const std::string other = j < 0 ? " and a wall" : " and " + std::to_string(atom->tag[j]);
    const std::string text = "model " + law_.model + ": step " + std::to_string(update->ntimestep) + ", sphere " +
                             std::to_string(atom->tag[i]) + other + ", " + both(atom->type[i], type_j) + ": " +
                             refused_adhesion(atom->type[i], type_j, R_star);
    error->one(FLERR, text.c_str());
  }

  /// The law's place in the register, and its constants of two types, for our loops.
  virtual int place() const = 0;
  virtual void put_constants(int i, int j, double* constants) const = 0;

 protected:
  NormalModel(LAMMPS_NS::LAMMPS* lmp, LIGGGHTS::IContactHistorySetup* setup, bool wall, bool others_have_history,
              const Declaration& law, const char* const* slots, int history_size, GapPlaces gap)
      : Pointers(lmp), wall_(wall), others_have_history_(others_have_history), history_size_(history_size), law_(law) {
    // Flag "0": an even quantity; "1" would change its sign when the pair is stored from the other side.
    for (int k = 0; k < history_size; ++k) {
      const int at = setup->add_history_value(slots[k], "0");
      if (k == 0) offset_ = at;
    }
    if (gap.root >= 0) gap_ = {offset_ + gap.root, offset_ + gap.jump};
    if (has_step()) {
      step_slot_ = setup->add_history_value("last_step", "0");
      if (history_size > 0 && step_slot_ != offset_ + history_size) fail("its history values are not side by side");
      pair_ = dynamic_cast<LAMMPS_NS::PairGran*>(setup);
      if (!pair_) fail("its history belongs to no pair style of LIGGGHTS");
      clock_ = update->ntimestep;
    }
    if (wall && law.adheres) {
      wall_gran_ = dynamic_cast<LAMMPS_NS::FixWallGran*>(setup);
      if (!wall_gran_) fail("its history belongs to no wall of LIGGGHTS");
    }
  }

  virtual void set_materials(const Materials& m) = 0;
  virtual std::vector<double> resistances(double cohesive) const = 0;
  virtual double largest_gap(double smallest_radius) const = 0;
  /// The least R* of bodies of two types that the law's adhesion allows, and the sentence on a smaller one.
  virtual double least_R_star(int i, int j) const = 0;
  virtual std::string refused_adhesion(int i, int j, double R_star) const = 0;

  /// Whether the history holds the step of the last evaluation that was kept.
  bool has_step() const { return !wall_ && (history_size_ > 0 || others_have_history_); }

  /// Whether the pair parted since its last evaluation: it is a new contact, for the other models as well.
  bool is_new(double* history, bool keep) const {
    if (!(now_ - history[step_slot_] > 1.0)) return false;
    const int first = step_slot_ - history_size_;
    if (keep) std::fill_n(history + first, pair_->dnum_pair() - first, 0.0);
    return true;
  }

  /// Bodies that touch without being in contact (inside a dent) begin anew in all other models.
  void forget_others(double* history) const {
    const int first = offset_ + history_size_ + has_step();
    const int last = compaction_ ? gap_.growth : wall_ ? wall_gran_->dnum() : pair_->dnum_pair();
    std::fill_n(history + first, std::max(0, last - first), 0.0);
  }

  const bool wall_, others_have_history_;
  const int history_size_;
  int width_ = 0, offset_ = 0, step_slot_ = -1;
  GapPlaces gap_;
  double now_ = 0.0;
  bool plastic_work_ = false, contact_strain_ = false, compaction_ = false, bonds_ = false;
  double** bond_ = nullptr;    // strengths of bonds [Pa] by types
  std::vector<double> least_;  // empty: no contact can be refused
  EnergyTally tally_;
  LargestStrain strain_;
  Growth growth_;
  NormalContactState state_;

 private:
  /// LIGGGHTS looks at bodies that do not overlap up to a share of the sum of their radii (of a wall: of the radius).
  /// The largest gap, 1.6088 (Gamma^2 R*/E*^2)^(1/3), takes the largest share of the smallest sphere at a wall; half a
  /// hundredth more is for the step after the last one in contact.
  void reach() {
    least_.clear();
    const std::vector<double> radii = smallest_radii(lmp);
    const double smallest = *std::min_element(radii.begin(), radii.end());
    if (!std::isfinite(smallest)) return;  // no spheres, and nothing that will add any
    find_least(radii);
    const double gap = largest_gap(smallest), factor = 1.005 + gap / smallest;
    if (!(factor > neighbor->contactDistanceFactor)) return;
    register_contact_distance(lmp, factor);
    char line[160];
    std::snprintf(line, sizeof line,
                  "epdem: %s pulls across gaps up to %.4g (radius %.4g), contact distance factor %.9g",
                  law_.model.c_str(), gap, smallest, factor);
    say(lmp, line);
  }

  /// Contacts are judged one by one where the adhesion of the smallest spheres of two types would be refused: they may
  /// never meet. A line says so before the run.
  void find_least(const std::vector<double>& radii) {
    std::vector<double> least(width_ * width_);
    bool refuses = false;
    for (int i = 1; i < width_; ++i)
      for (int j = 1; j < width_; ++j) {
        least[i * width_ + j] = least_R_star(i, j);
        if (!wall_ && std::isinf(radii[i] + radii[j])) continue;  // no two spheres meet
        const double R_star = wall_ ? radii[i] : reduced_finite(radii[i], radii[j]);
        if (!(R_star < least[i * width_ + j])) continue;
        refuses = true;
        if (!wall_ && i <= j)
          say_once(lmp, "epdem: " + law_.model + ": the run ends where the smallest spheres of " + both(i, j) +
                            " meet: " + refused_adhesion(i, j, R_star));
      }
    if (refuses) least_ = least;
  }

  /// reset_timestep came between two runs: the stored steps move with it.
  void move_clock(bigint shift) const {
    const LAMMPS_NS::NeighList* lists[] = {pair_->list, pair_->listgranhistory};
    if (!lists[0] || !lists[1]) return;
    const int width = pair_->dnum();
    for (int n = 0; n < lists[0]->inum; ++n) {
      const int i = lists[0]->ilist[n];
      for (int k = 0; k < lists[0]->numneigh[i]; ++k)
        lists[1]->firstdouble[i][k * width + step_slot_] += static_cast<double>(shift);
    }
  }

  void fail(const std::string& what) const { error->all(FLERR, ("model " + law_.model + ": " + what).c_str()); }

  void refuse(const char* setting, const char* reason) const {
    fail(std::string("setting ") + setting + " on is not available: " + reason);
  }

  const Declaration law_;
  LAMMPS_NS::PairGran* pair_ = nullptr;
  LAMMPS_NS::FixWallGran* wall_gran_ = nullptr;
  bigint clock_ = 0;  // step of the last pass
  bool adds_friction_ = false, elastic_energy_ = true;
  bool viscous_ = false, tangential_damping_ = true, limit_force_ = false, heating_ = false, heating_tracking_ = false;
  bool elastic_potential_ = false, dissipated_energy_ = false, disable_when_bonded_ = false;
};

}  // namespace epdem::liggghts
