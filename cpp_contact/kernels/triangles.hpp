// SPDX-License-Identifier: BSD-3-Clause
// Contacts of a sphere with a surface of triangles: the points of the surface that are nearest to the centre in their
// neighbourhood. For hosts alone: sources that are compiled for newer processors hold no inline function that others
// share.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "epdem/kinematics.hpp"

namespace epdem::kernels {

/// A point of a triangle is in contact unless a nearer triangle holds it: over a face, an edge or a corner a sphere has
/// one contact, in a concave corner one with each face. Triangles in one plane act as one, orientation has no effect,
/// and a triangle that occurs twice acts once.
class TriangleSurface {
 public:
  using Point = Vec<double>;

  struct Contact {
    int triangle;
    double distance;
    Point from_wall;  // to the centre of the sphere
  };

  /// corners: nine numbers of each triangle, whose area is above zero.
  explicit TriangleSurface(const std::vector<double>& corners) {
    for (std::size_t k = 0; k + 9 <= corners.size(); k += 9) {
      const double* const c = corners.data() + k;
      const Point a{c[0], c[1], c[2]}, ab = Point{c[3], c[4], c[5]} - a, ac = Point{c[6], c[7], c[8]} - a;
      const Point across = cross(ab, ac);
      triangles_.push_back({a, ab, ac, across / length(across)});
    }
    make_cells();
  }

  /// The triangles up to a distance from a point, in ascending order.
  void near(const Point& x, double distance, std::vector<int>& found) const {
    found.clear();
    std::array<int, 3> first, last;
    const double at[] = {x.x, x.y, x.z};
    for (int axis = 0; axis < 3; ++axis) {
      if (!(at[axis] + distance >= low_[axis] && at[axis] - distance <= high_[axis])) return;
      first[axis] = cell_of(axis, at[axis] - distance);
      last[axis] = cell_of(axis, at[axis] + distance);
    }
    each_cell(first, last, [&](std::size_t cell) {
      for (int k = first_in_[cell]; k < first_in_[cell + 1]; ++k) {
        const Point away = from_triangle(in_cells_[k], x);
        if (dot(away, away) <= distance * distance) found.push_back(in_cells_[k]);
      }
    });
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
  }

  /// The contacts below a distance of `reach`, from the nearest on; candidates: among others all triangles in reach.
  void contacts(const Point& x, double reach, const std::vector<int>& candidates, std::vector<Contact>& found) const {
    found.clear();
    reached_.clear();
    for (const int t : candidates) {
      const Triangle& triangle = triangles_[t];
      if (!(std::fabs(dot(triangle.normal, x - triangle.a)) < reach)) continue;
      const Point away = from_triangle(t, x);
      const double distance = length(away);
      if (distance < reach && distance > 0.0) reached_.push_back({t, distance, away});
    }
    std::sort(reached_.begin(), reached_.end(), [](const Contact& one, const Contact& two) {
      return one.distance < two.distance || (one.distance == two.distance && one.triangle < two.triangle);
    });
    for (std::size_t k = 0; k < reached_.size(); ++k) {
      const Contact& c = reached_[k];
      const auto has_direction_of = [&](const Contact& nearer) {
        return dot(c.from_wall, nearer.from_wall) > (1.0 - one_direction) * c.distance * nearer.distance;
      };
      const Point at = x - c.from_wall;
      const auto holds_point = [&](const Contact& nearer) { return is_at(nearer.triangle, at, rounding * c.distance); };
      if (std::any_of(found.begin(), found.end(), has_direction_of)) continue;
      if (std::any_of(reached_.begin(), reached_.begin() + static_cast<std::ptrdiff_t>(k), holds_point)) continue;
      found.push_back(c);
    }
  }

  /// Whether a contact of a sphere can pass from one triangle to the other: they meet. size: radius of the sphere.
  bool meet(int one, int two, double size) const {
    const auto has_corner_at = [&](int of, int at) {
      const Triangle& t = triangles_[of];
      for (const Point& corner : {t.a, t.a + t.ab, t.a + t.ac})
        if (is_at(at, corner, rounding * size)) return true;
      return false;
    };
    return one == two || has_corner_at(one, two) || has_corner_at(two, one);
  }

  bool in_one_plane(int one, int two) const {
    return std::fabs(dot(triangles_[one].normal, triangles_[two].normal)) > 1.0 - one_direction;
  }

  int size() const { return static_cast<int>(triangles_.size()); }

 private:
  struct Triangle {
    Point a, ab, ac, normal;
  };

  static constexpr double rounding = 1e-6;       // of the distance: within it, triangles meet
  static constexpr double one_direction = 1e-6;  // 1 - cosine between contacts that are one: 0.08 degrees

  bool is_at(int triangle, const Point& x, double tolerance) const {
    const Triangle& t = triangles_[triangle];
    if (std::fabs(dot(t.normal, x - t.a)) > tolerance) return false;
    const Point away = from_triangle(triangle, x);
    return dot(away, away) <= tolerance * tolerance;
  }

  /// From the nearest point of a triangle to x.
  Point from_triangle(int triangle, const Point& x) const {
    const Triangle& t = triangles_[triangle];
    const Point from_a = x - t.a, from_b = from_a - t.ab, from_c = from_a - t.ac;
    const double b_a = dot(t.ab, from_a), c_a = dot(t.ac, from_a);
    if (b_a <= 0.0 && c_a <= 0.0) return from_a;
    const double b_b = dot(t.ab, from_b), c_b = dot(t.ac, from_b);
    if (b_b >= 0.0 && c_b <= b_b) return from_b;
    const double beyond_ab = b_a * c_b - b_b * c_a;
    if (beyond_ab <= 0.0 && b_a >= 0.0 && b_b <= 0.0) return from_a - (b_a / (b_a - b_b)) * t.ab;
    const double b_c = dot(t.ab, from_c), c_c = dot(t.ac, from_c);
    if (c_c >= 0.0 && b_c <= c_c) return from_c;
    const double beyond_ac = b_c * c_a - b_a * c_c;
    if (beyond_ac <= 0.0 && c_a >= 0.0 && c_c <= 0.0) return from_a - (c_a / (c_a - c_c)) * t.ac;
    const double beyond_bc = b_b * c_c - b_c * c_b, along = c_b - b_b, back = b_c - c_c;
    if (beyond_bc <= 0.0 && along >= 0.0 && back >= 0.0) return from_b - (along / (along + back)) * (t.ac - t.ab);
    return dot(t.normal, from_a) * t.normal;
  }

  /// Cells of equal size, each with the triangles whose bounding boxes meet it.
  void make_cells() {
    for (int axis = 0; axis < 3; ++axis) low_[axis] = std::numeric_limits<double>::max(), high_[axis] = -low_[axis];
    std::vector<std::array<double, 6>> limits;
    for (const Triangle& t : triangles_) {
      const Point b = t.a + t.ab, c = t.a + t.ac;
      const double all[3][3] = {{t.a.x, b.x, c.x}, {t.a.y, b.y, c.y}, {t.a.z, b.z, c.z}};
      limits.emplace_back();
      for (int axis = 0; axis < 3; ++axis) {
        const auto [least, most] = std::minmax_element(all[axis], all[axis] + 3);
        limits.back()[2 * axis] = *least;
        limits.back()[2 * axis + 1] = *most;
        low_[axis] = std::min(low_[axis], *least);
        high_[axis] = std::max(high_[axis], *most);
      }
    }
    double widest = 0.0;
    for (int axis = 0; axis < 3; ++axis) widest = std::max(widest, high_[axis] - low_[axis]);
    const double per_side = std::clamp(std::cbrt(8.0 * size()), 1.0, 100.0);
    side_ = widest > 0.0 ? widest / per_side : 1.0;
    for (int axis = 0; axis < 3; ++axis) cells_[axis] = 1 + static_cast<int>((high_[axis] - low_[axis]) / side_);
    const std::size_t count = static_cast<std::size_t>(cells_[0]) * cells_[1] * cells_[2];
    first_in_.assign(count + 1, 0);
    const auto each_of = [&](auto visit) {
      for (std::size_t t = 0; t < limits.size(); ++t) {
        std::array<int, 3> first, last;
        for (int axis = 0; axis < 3; ++axis) {
          first[axis] = cell_of(axis, limits[t][2 * axis]);
          last[axis] = cell_of(axis, limits[t][2 * axis + 1]);
        }
        each_cell(first, last, [&](std::size_t cell) { visit(cell, static_cast<int>(t)); });
      }
    };
    each_of([&](std::size_t cell, int) { ++first_in_[cell + 1]; });
    for (std::size_t cell = 0; cell < count; ++cell) first_in_[cell + 1] += first_in_[cell];
    in_cells_.resize(first_in_[count]);
    std::vector<int> next(first_in_.begin(), first_in_.end() - 1);
    each_of([&](std::size_t cell, int t) { in_cells_[next[cell]++] = t; });
  }

  int cell_of(int axis, double x) const {
    const double cell = (x - low_[axis]) / side_;
    return static_cast<int>(std::clamp(cell, 0.0, cells_[axis] - 1.0));
  }

  template <class Visit>
  void each_cell(const std::array<int, 3>& first, const std::array<int, 3>& last, Visit visit) const {
    for (int i = first[0]; i <= last[0]; ++i)
      for (int j = first[1]; j <= last[1]; ++j)
        for (int k = first[2]; k <= last[2]; ++k) visit((static_cast<std::size_t>(i) * cells_[1] + j) * cells_[2] + k);
  }

  std::vector<Triangle> triangles_;
  double low_[3], high_[3], side_ = 1.0;
  int cells_[3];
  std::vector<int> first_in_, in_cells_;  // of each cell: the place of its first triangle in in_cells_
  mutable std::vector<Contact> reached_;  // scratch
};

}  // namespace epdem::kernels
