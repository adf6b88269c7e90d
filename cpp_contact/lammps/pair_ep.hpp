// SPDX-License-Identifier: GPL-2.0-or-later
// pair_style ep: gathers the contacts of LAMMPS's neighbor list, has them computed as lanes, scatters forces.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "fix_heat.hpp"
#include "fix_history.hpp"
#include "pair.h"
#include "words.hpp"

namespace epdem::lammps {

class PairEp : public LAMMPS_NS::Pair {
 public:
  static constexpr const char* style_name = "ep";

  explicit PairEp(LAMMPS_NS::LAMMPS* lmp);
  ~PairEp() override;

  void settings(int count, char** word) override;
  void coeff(int count, char** word) override;
  void init_style() override;
  double init_one(int i, int j) override;
  void compute(int eflag, int vflag) override;
  /// Elastic energy of a contact, normal force over distance; svector: overlap, largest overlap, contact radius,
  /// whether the bodies touch or are attached, overlap that growth adds, screening, force on i; of that overlap the
  /// growth of the bodies, their pressure.
  double single(int i, int j, int itype, int jtype, double rsq, double, double, double& fforce) override;
  void write_restart(FILE* file) override;
  void read_restart(FILE* file) override;

  /// For walls: models of all contacts, the material of a type, energies.
  const Models& models() const { return models_; }
  bool has_material(int type) const { return !types_.at(type * width_ + type).text.empty(); }
  const Words& words_of(int type, const std::string& place) const;
  FixHistory* history() const { return history_; }
  bool energies() const { return energies_; }
  bool holds() const { return holds_; }
  bool strain() const { return strain_; }
  double largest_radius(int type) const { return largest_[type]; }
  double smallest_radius(int type) const { return smallest_[type]; }

 private:
  struct PairOfTypes {
    std::string text;  // words of pair_coeff; empty: not given
    Words words;
  };

  void allocate();
  PairOfTypes& types(int i, int j) { return types_[i * width_ + j]; }
  void set_words(int i, int j, const std::string& text);
  void create_history();
  void measure_radii();
  void set_pass(bool counts);
  void gather();
  bool stands(int i, int j, const double* history) const;
  template <class HistoryAt>
  void fetch(int n, HistoryAt history_at);
  void finish(int n);
  void tally(int n);
  double* history_of(int i, int j) const;

  int width_ = 0;  // number of types + 1
  std::vector<PairOfTypes> types_;
  std::vector<double> constants_;           // of i * width + j
  std::vector<double> largest_, smallest_;  // radius by type [length]
  AdhesionJudge judge_;
  Models models_;
  bool energies_ = false, holds_ = false, strain_ = false;  // holds_: with the elastic energy
  Layout layout_;
  std::string fix_id_;
  FixHistory* history_ = nullptr;
  FixHeat* heat_ = nullptr;

  kernels::Kernel kernel_[2] = {};  // the second one is complete
  kernels::Pass pass_{};
  std::unique_ptr<kernels::Block> block_;
  const kernels::SphereKernels* spheres_ = nullptr;
  int place_[kernels::block_size + kernels::most_lanes];  // in the list
  std::vector<double> copies_[3];  // of x, v, omega, if no number can be read behind the last atom
  int frozen_ = 0;                 // group bit
  double single_[12];              // svector
};

}  // namespace epdem::lammps
