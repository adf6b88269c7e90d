// SPDX-License-Identifier: BSD-3-Clause
// Heat of spheres: conduction through the area of their contacts, and a share of the plastic and frictional work.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "epdem/conduction.hpp"
#include "kernels/block.hpp"

namespace epdem::kernels {

/// The heat of one simulation. A contact of radius a conducts 2 k a (T_j - T_i), 2/k = 1/k_i + 1/k_j. A step of a
/// simulation opens the sums, adds its contacts and closes with new temperatures.
class Heat {
 public:
  /// A wall with a temperature; others are adiabatic. flow: into the wall in the last step.
  struct Wall {
    std::string name;
    double temperature, conductivity, flow;
  };

  /// The words ID all heat/ep SHARE, k c of each type, and wall NAME T k of each wall with a temperature.
  /// number_at(k): the number at a word; fail(text) ends the run.
  template <class NumberAt, class Fail>
  void read(int count, const char* const* word, int types, NumberAt number_at, Fail fail) {
    const auto above_zero = [&](int k, const char* what) {
      const double value = number_at(k);
      if (!(value > 0.0)) fail(std::string("fix heat/ep: ") + what + " " + word[k] + " must be above 0");
      return value;
    };
    const int first = 4, walls = first + 2 * types;
    if (types == 0) fail("fix heat/ep: there is no simulation box; create it before");
    if (count < walls || (count - walls) % 4)
      fail("fix heat/ep: the words are ID all heat/ep SHARE, k c of each of the " + std::to_string(types) +
           " types, and wall NAME T k of each wall with a temperature");
    share_ = number_at(3);
    if (!(share_ >= 0.0 && share_ <= 1.0)) fail(std::string("fix heat/ep: share ") + word[3] + " must lie in [0, 1]");
    conductivity_.assign(types + 1, 0.0);
    capacity_.assign(types + 1, 0.0);
    for (int type = 1; type <= types; ++type) {
      conductivity_[type] = above_zero(first + 2 * type - 2, "conductivity");
      capacity_[type] = above_zero(first + 2 * type - 1, "specific heat");
    }
    for (int k = walls; k < count; k += 4) {
      if (std::string(word[k]) != "wall") fail(std::string("fix heat/ep: ") + word[k] + " is not known; there is wall");
      walls_.push_back({word[k + 1], number_at(k + 2), above_zero(k + 3, "conductivity"), 0.0});
    }
  }

  std::vector<Wall>& walls() { return walls_; }

  /// Begins a step of `spheres` owned spheres. temperature: also of ghosts; work(i): plastic and frictional work of the
  /// contacts of a sphere since the start.
  template <class Work>
  void open(int spheres, const double* temperature, const int* type, Work work) {
    temperature_ = temperature;
    type_ = type;
    flow_.assign(spheres, 0.0);
    conductance_.assign(spheres, 0.0);
    work_.resize(spheres);
    for (int i = 0; i < spheres; ++i) work_[i] = work(i);
    for (Wall& wall : walls_) wall.flow = 0.0;
  }

  /// A contact of an owned sphere i with another sphere, owned or a ghost.
  void add_pair(int i, int j, double radius) {
    const double G = conductance(conductivity_[type_[i]], conductivity_[type_[j]], radius);
    const double flow = G * (temperature_[j] - temperature_[i]);
    flow_[i] += flow;
    conductance_[i] += G;
    if (static_cast<std::size_t>(j) >= flow_.size()) return;
    flow_[j] -= flow;
    conductance_[j] += G;
  }

  /// The n contacts of spheres of a block.
  void add_pairs(const Block& b, int n) {
    for (int k = 0; k < n; ++k) add_pair(b.i[k], b.j[k], b.contact_radius.a[k]);
  }

  /// The wall of this name; null: it is adiabatic.
  Wall* wall(const char* name) {
    for (Wall& w : walls_)
      if (w.name == name) return &w;
    return nullptr;
  }

  void add_wall(int i, Wall& wall, double radius) {
    const double G = conductance(conductivity_[type_[i]], wall.conductivity, radius);
    const double flow = G * (temperature_[i] - wall.temperature);
    flow_[i] -= flow;
    conductance_[i] += G;
    wall.flow += flow;
  }

  /// Closes a step of length dt by explicit Euler: no temperature passes the temperatures of its neighbours while the
  /// step is at most C/sum of the conductances. too_long(i, limit) and unknown(i), a sphere or its neighbour without a
  /// temperature, end the run.
  template <class Work, class TooLong, class Unknown>
  void close(double* temperature, const double* mass, double dt, Work work, TooLong too_long, Unknown unknown) {
    for (int i = 0; i < static_cast<int>(flow_.size()); ++i) {
      const double C = mass[i] * capacity_[type_[i]], limit = C / conductance_[i];
      temperature[i] += (dt * flow_[i] + share_ * (work(i) - work_[i])) / C;
      if (dt > limit) too_long(i, limit);
      if (!std::isfinite(temperature[i])) unknown(i);
    }
  }

 private:
  double share_ = 0.0;
  std::vector<double> conductivity_, capacity_;  // by type
  std::vector<Wall> walls_;
  const double* temperature_ = nullptr;
  const int* type_ = nullptr;
  std::vector<double> flow_, conductance_, work_;  // of each owned sphere in the step
};

}  // namespace epdem::kernels
