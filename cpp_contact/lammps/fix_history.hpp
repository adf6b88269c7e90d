// SPDX-License-Identifier: GPL-2.0-or-later
// The history of the contacts of a pair style, through new lists, exchange of atoms and restart files; and the energies
// that contacts give to their atoms.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "epdem/compaction.hpp"
#include "fix.h"
#include "kernels/pair_list.hpp"
#include "words.hpp"

namespace epdem::lammps {

/// Between two lists, the histories lie beside the list (`at`); while a list is made, with their atoms, by the tag of
/// the partner. A pair that spans two ranks is on both lists and has two equal histories. Commands between two runs may
/// give atoms new tags; each atom keeps the tag that it had when partners were named.
class FixHistory : public LAMMPS_NS::Fix {
 public:
  static constexpr const char* style_name = "EP_HISTORY";

  /// fix ID all EP_HISTORY [energies]; the pair style creates it.
  FixHistory(LAMMPS_NS::LAMMPS* lmp, int count, char** word);
  ~FixHistory() override;

  /// Before each run. Collective.
  void prepare(LAMMPS_NS::NeighList* const* list, const Layout& layout, const Models& models);

  /// The pairs of the list without those that bonds exclude.
  kernels::PairList& pairs() { return pairs_; }

  /// The history of the pair at this place of the list.
  double* at(int place) { return page_.data() + long(layout_.values) * place; }

  /// Whether the list, not the atoms, holds the histories.
  bool at_list() const { return page_holds_; }

  /// The neighbor list of the run before is in use again.
  void resume() { page_holds_ = layout_.values > 0; }

  /// The number of the evaluation that follows; `advance` says that it counts.
  double now() const { return evaluations_ + 1.0; }
  void advance() { evaluations_ += 1.0; }

  /// Histories of before an evaluation that does not count.
  std::vector<double>& page() { return page_; }

  /// Energies are requested: columns plastic work, elastic energy, loaded contacts, work lost by friction, elastic
  /// energy of friction, work lost by adhesion in its jumps. With compaction: BodyMemory.
  enum Column {
    plastic_work,
    elastic_energy,
    loaded_contacts,
    friction_work,
    friction_energy,
    adhesive_work,
    body_memory,
    columns = body_memory + memory_values
  };
  template <int halves>
  class HalfEnergies;
  /// What scatter_pairs adds beside the forces: half of plastic work and elastic energy, and a loaded contact, to each
  /// atom of this rank; halves: the first of these columns.
  template <int halves>
  HalfEnergies<halves> half_energies(const kernels::Block& b, const Models& models);
  /// Adds plastic work and elastic energy, if it is known, of n contacts with a wall to their atoms.
  void add_wall_energies(const kernels::Block& b, int n, const Models& models, bool holds);
  /// Plastic and frictional work of the contacts of an atom since the start.
  double work_of(int i) const { return array_atom[i][plastic_work] + array_atom[i][friction_work]; }
  /// Adds the energies of friction and the work of adhesion of n contacts: half of a pair to each atom of this rank.
  void add_works(const kernels::Block& b, int n, const Models& models, bool wall);
  /// Notes the largest w a/R* and w overlap/R* of a block.
  void note_strain(const kernels::Block& b);
  /// Largest w a/R* (0) or w overlap/R* (1) of all contacts since the start.
  double compute_vector(int which) override;
  /// At the start of an evaluation that counts.
  void open_energies(int atoms);

  /// Compaction: growth of each atom over its radius and area of its contacts, by the dents of the evaluation before.
  /// Walls come after the pairs, so that the sums close at the start of the next evaluation. An evaluation that does
  /// not count sums up the same dents once more, so that a restart file needs no sums. Collective.
  void close_growth(bool counts, double (*close)(const kernels::BodyRows&));
  const double* bodies() const { return bodies_.data(); }
  /// No grown spheres touch whose squared distance is above this factor times the squared sum of their radii.
  double factor() const { return touch_factor(largest_); }
  /// Before the pairs: all of the list again where spheres grew more than its pairs allow.
  void widen();
  /// Adds the dents of a block to the sums of the atoms of this rank.
  void note_dents(const kernels::Block& b, int n, bool wall);

  /// Walls whose contacts are in the restart file and that no fix has taken yet, by the ID of their fix.
  /// found: whether the fix with this ID got them. Gives what is wrong with a wall that is used for the first time.
  std::string claim_wall(const std::string& fix, bool found);

  int pack_forward_comm(int n, int* atoms, double* buffer, int, int*) override;
  void unpack_forward_comm(int n, int first, double* buffer) override;
  int setmask() override;
  void setup_post_neighbor() override;
  void post_neighbor() override;
  void setup_pre_exchange() override;
  void pre_exchange() override;
  void post_run() override;

  void grow_arrays(int atoms) override;
  void copy_arrays(int from, int to, int) override;
  void set_arrays(int i) override;
  int pack_exchange(int i, double* buffer) override;
  int unpack_exchange(int i, double* buffer) override;
  void write_restart(FILE* file) override;
  void restart(char* stored) override;
  int pack_restart(int i, double* buffer) override;
  void unpack_restart(int i, int nth) override;
  int size_restart(int i) override;
  int maxsize_restart() override;
  double memory_usage() override;

 private:
  void collect();
  void distribute();
  bool narrows() const;
  void read_list();
  void rename_partners();
  int stride() const { return layout_.values + 1; }
  void remember(int i, LAMMPS_NS::tagint partner, const double* values, bool mirrored);
  size_t longest() const;
  int longest_of_ranks() const;

  LAMMPS_NS::NeighList* const* list_ = nullptr;
  Layout layout_;
  std::vector<std::string> walls_;  // of claim_wall
  bool has_run_ = false;            // since the restart file was read
  std::vector<double> identity_;    // of the models whose histories these are: their ids, numbers of a contact
  double evaluations_ = 0.0;
  double strain_[2] = {};
  std::vector<double> dents_;        // with compaction, by atom: sums of the dents
  std::vector<double> bodies_;       // BodySums, also of ghosts
  double largest_ = 0.0;             // growth
  double listed_factor_ = HUGE_VAL;  // up to which pairs_ holds all pairs that meet
  bool page_holds_ = false;          // else the atoms hold the histories
  int rows_ = 0;                     // of array_atom
  int stored_most_ = 0;              // numbers of the contacts of an atom in a restart file, of all ranks
  kernels::PairList pairs_;
  std::vector<double> page_;               // by place of the pair
  std::vector<std::vector<double>> held_;  // by atom: tag of the partner, values
  std::vector<LAMMPS_NS::tagint> own_;     // by atom: its tag when partners were named, 0: a new atom
};

/// The sums of atom i stay in registers while its pairs follow each other.
template <int halves>
class FixHistory::HalfEnergies {
 public:
  HalfEnergies(const kernels::Block& b, const Models& models, double* rows)
      : work_(b.plastic_work_step.a),
        energy_(b.stored_energy.a),
        loaded_(b.contact_radius.a),
        gives_back_(models.compaction),
        rows_(rows) {}

  void begin(long i) { std::copy_n(rows_ + columns * i, halves, sum_); }
  void add(int k, long j, bool owned) {
    double* const row = owned ? rows_ + columns * j : ghost_;
    const double work = work_[k] > 0.0 || gives_back_ ? 0.5 * work_[k] : 0.0;  // growth can give work back
    const double of_contact[] = {work, 0.5 * energy_[k], double(loaded_[k] > 0.0)};
    for (int c = 0; c < halves; ++c) {
      sum_[c] += of_contact[c];
      row[c] += of_contact[c];
    }
  }
  void end(long i) { std::copy_n(sum_, halves, rows_ + columns * i); }

 private:
  const double *const work_, *const energy_, *const loaded_;
  const bool gives_back_;
  double* const rows_;
  double sum_[halves] = {}, ghost_[halves] = {};
};

template <int halves>
inline FixHistory::HalfEnergies<halves> FixHistory::half_energies(const kernels::Block& b, const Models& models) {
  return {b, models, array_atom[0]};
}

}  // namespace epdem::lammps
