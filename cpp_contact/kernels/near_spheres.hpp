// SPDX-License-Identifier: BSD-3-Clause
// The candidates of a wall that is a mesh of triangles. For hosts alone: sources that are compiled for newer processors
// hold no inline function that others share.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "kernels/block.hpp"

namespace epdem::kernels {

/// The spheres in the neighbour lists of a mesh, and shorter lists: those that can touch a triangle before a sphere or
/// the mesh has moved by a part of the skin.
class NearSpheres {
 public:
  /// Read new neighbour lists of the first `triangles`; only spheres below `owned` count. Spheres touch from `reach`
  /// radii on.
  template <class SpheresOf, class PlanesOf>
  void take(int triangles, int owned, double reach, SpheresOf spheres_of, PlanesOf planes_of) {
    reach_ = reach * (1.0 + 1e-6);      // far above round-off
    std::vector<int> place(owned, -1);  // of a sphere in spheres_
    spheres_.clear();
    listed_.clear();
    all_.clear();
    triangles_.clear();
    for (int t = 0; t < triangles; ++t) {
      const std::size_t before = all_.size();
      for (const int i : spheres_of(t)) {
        if (i >= owned) continue;
        if (place[i] < 0) {
          place[i] = static_cast<int>(spheres_.size());
          spheres_.push_back(i);
        }
        all_.push_back(place[i]);
      }
      if (all_.size() > before) listed_.push_back({t, static_cast<int>(all_.size() - before), planes_of(t)});
    }
    near_.resize(all_.size() + most_lanes);
    found_.resize(all_.size() + most_lanes);
    now_.resize(4 * spheres_.size());
    before_.assign(now_.size(), 0.0);
    corners_.clear();
    is_new_ = true;
  }

  /// For a step; x: rows of three; corners: nine numbers of each of the `triangles` of a mesh that moves, else null.
  void update(const SphereKernels& kernels, const double* x, const double* radius, const double* corners, int triangles,
              double slack) {
    if (spheres_.empty()) return;
    double moved = std::sqrt(moved_spheres(x, radius));
    if (corners) moved += std::sqrt(moved_corners(corners));
    if (!is_new_ && moved <= slack) return;
    is_new_ = false;
    before_ = now_;
    if (corners) corners_.assign(corners, corners + 9 * static_cast<std::size_t>(triangles));
    shorten(kernels, slack);
  }

  /// contact(triangle, sphere) for all that can touch now, in the order of the neighbour lists.
  template <class F>
  void each(const SphereKernels& kernels, F contact) {
    const NearTest test{now_.data(), reach_, 0.0};
    const int* candidates = near_.data();
    for (const Near& near : triangles_) {
      const int n = kernels.near_triangle(test, near.planes, candidates, near.count, found_.data());
      for (int k = 0; k < n; ++k) contact(near.triangle, spheres_[found_[k]]);
      candidates += near.count;
    }
  }

 private:
  struct Near {
    int triangle, count;
    TrianglePlanes planes;
  };

  void shorten(const SphereKernels& kernels, double slack) {
    triangles_.clear();
    const NearTest test{now_.data(), reach_, slack};
    int *candidates = all_.data(), *near = near_.data();
    for (const Near& listed : listed_) {
      const int n = kernels.near_triangle(test, listed.planes, candidates, listed.count, near);
      if (n > 0) triangles_.push_back({listed.triangle, n, listed.planes});
      candidates += listed.count;
      near += n;
    }
  }

  /// The largest square of a way since the short lists were made; infinite if a radius has changed.
  double moved_spheres(const double* x, const double* radius) {
    double most = 0.0;
    double* now = now_.data();
    const double* before = before_.data();
    for (const int i : spheres_) {
      std::copy_n(x + 3L * i, 3, now);
      now[3] = radius[i];
      most = std::max(most, square_of_way(now, before));
      if (now[3] != before[3]) most = std::numeric_limits<double>::infinity();
      now += 4;
      before += 4;
    }
    return most;
  }

  double moved_corners(const double* now) const {
    double most = 0.0;
    for (std::size_t k = 0; k < corners_.size(); k += 3)
      most = std::max(most, square_of_way(now + k, corners_.data() + k));
    return most;
  }

  static double square_of_way(const double* a, const double* b) {
    const double dx = a[0] - b[0], dy = a[1] - b[1], dz = a[2] - b[2];
    return dx * dx + dy * dy + dz * dz;
  }

  double reach_ = 1.0;
  bool is_new_ = false;               // there are no short lists yet
  std::vector<int> spheres_;          // each once
  std::vector<double> now_, before_;  // rows of position and radius: in this step, and when the short lists were made
  std::vector<double> corners_;       // then, of a mesh that moves
  std::vector<Near> listed_, triangles_;
  std::vector<int> all_, near_;  // places in spheres_: all lists one after the other, and the short ones
  std::vector<int> found_;
};

}  // namespace epdem::kernels
