// SPDX-License-Identifier: GPL-2.0-or-later
// fix ID group-ID slowing/ep FORCE rises|falls LIMIT NEAR LAG SHARE: the share of its speed that a wall has near a
// force, as the scalar of the fix (`kernels/wall_slowing.hpp`). FORCE: f_ID or c_ID, whose first three numbers are a
// force, or f_ID[n] or c_ID[n], a component. For LAMMPS and LIGGGHTS, whose classes have the same names.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <string>

#include "compute.h"
#include "error.h"
#include "fix.h"
#include "kernels/wall_slowing.hpp"
#include "modify.h"
#include "update.h"

namespace epdem {

class FixSlowing final : public LAMMPS_NS::Fix {
 public:
  static constexpr const char* style_name = "slowing/ep";

  FixSlowing(LAMMPS_NS::LAMMPS* lmp, int count, char** word) : Fix(lmp, count, word) {
    if (count != 9 || (std::strcmp(word[4], "rises") != 0 && std::strcmp(word[4], "falls") != 0)) refuse();
    source_ = word[3];
    if (const auto at = source_.find('['); at != std::string::npos) {
      component_ = static_cast<int>(value_of(source_.substr(at + 1, source_.size() - at - 2)));
      if (source_.back() != ']' || component_ < 1) refuse();
      source_.resize(at);
    }
    if (source_.rfind("f_", 0) != 0 && source_.rfind("c_", 0) != 0) refuse();
    slowing_ = {value_of(word[5]), *word[4] == 'r', value_of(word[6]), value_of(word[7]), value_of(word[8])};
    if (!(slowing_.limit > 0.0 && slowing_.near > 0.0 && slowing_.lag >= 1.0)) refuse();
    scalar_flag = global_freq = nevery = 1;
    extscalar = 0;
  }

  int setmask() override { return LAMMPS_NS::FixConst::END_OF_STEP; }
  void init() override {
    const std::string id = source_.substr(2);
    const int fix = modify->find_fix(id.c_str()), compute = modify->find_compute(id.c_str());
    fix_ = *source_.c_str() == 'f' && fix >= 0 ? modify->fix[fix] : nullptr;
    compute_ = *source_.c_str() == 'c' && compute >= 0 ? modify->compute[compute] : nullptr;
    const int numbers =
        fix_ ? fix_->size_vector * fix_->vector_flag : (compute_ ? compute_->size_vector * compute_->vector_flag : 0);
    if (numbers < std::max(3, component_)) refuse();
  }
  void end_of_step() override { slowing_.follow(force()); }
  double compute_scalar() override { return slowing_.share; }

 private:
  double force() {
    if (compute_ && compute_->invoked_vector != update->ntimestep) compute_->compute_vector();
    const auto number = [this](int k) { return fix_ ? fix_->compute_vector(k) : compute_->vector[k]; };
    if (component_ > 0) return std::fabs(number(component_ - 1));
    const double x = number(0), y = number(1), z = number(2);
    return std::sqrt(x * x + y * y + z * z);
  }

  double value_of(const std::string& word) {
    char* end = nullptr;
    const double value = std::strtod(word.c_str(), &end);
    if (word.empty() || *end) refuse();
    return value;
  }

  void refuse() {
    error->all(FLERR,
               "fix slowing/ep: the words are ID group slowing/ep FORCE rises|falls LIMIT NEAR LAG SHARE; FORCE is the "
               "f_ID or c_ID of a force, or its component; LIMIT and NEAR are above 0, LAG is at least 1");
  }

  std::string source_;
  int component_ = 0;  // from 1; 0: of all three
  Fix* fix_ = nullptr;
  LAMMPS_NS::Compute* compute_ = nullptr;
  kernels::WallSlowing slowing_{};
};

}  // namespace epdem
