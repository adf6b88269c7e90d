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

struct Triangle {
  using Point = Vec<double>;

  Point a, ab, ac, normal;

  /// corners: nine numbers; the area is above zero.
  explicit Triangle(const double* c)
      : a{c[0], c[1], c[2]}, ab(Point{c[3], c[4], c[5]} - a), ac(Point{c[6], c[7], c[8]} - a) {
    const Point across = cross(ab, ac);
    normal = across / length(across);
  }

  /// From the nearest point of the triangle to x.
  Point to(const Point& x) const {
    const Point from_a = x - a, from_b = from_a - ab, from_c = from_a - ac;
    const double b_a = dot(ab, from_a), c_a = dot(ac, from_a);
    if (b_a <= 0.0 && c_a <= 0.0) return from_a;
    const double b_b = dot(ab, from_b), c_b = dot(ac, from_b);
    if (b_b >= 0.0 && c_b <= b_b) return from_b;
    const double beyond_ab = b_a * c_b - b_b * c_a;
    if (beyond_ab <= 0.0 && b_a >= 0.0 && b_b <= 0.0) return from_a - (b_a / (b_a - b_b)) * ab;
    const double b_c = dot(ab, from_c), c_c = dot(ac, from_c);
    if (c_c >= 0.0 && b_c <= c_c) return from_c;
    const double beyond_ac = b_c * c_a - b_a * c_c;
    if (beyond_ac <= 0.0 && c_a >= 0.0 && c_c <= 0.0) return from_a - (c_a / (c_a - c_c)) * ac;
    const double beyond_bc = b_b * c_c - b_c * c_b, along = c_b - b_b, back = b_c - c_c;
    if (beyond_bc <= 0.0 && along >= 0.0 && back >= 0.0) return from_b - (along / (along + back)) * (ac - ab);
    return dot(normal, from_a) * normal;
  }

  bool is_at(const Point& x, double tolerance) const {
    if (std::fabs(dot(normal, x - a)) > tolerance) return false;
    const Point away = to(x);
    return dot(away, away) <= tolerance * tolerance;
  }

  /// Whether a contact of a sphere can pass from one triangle to the other: they meet. size: radius of the sphere.
  bool meets(const Triangle& other, double size) const {
    const auto has_corner_at = [&](const Triangle& of, const Triangle& at) {
      for (const Point& corner : {of.a, of.a + of.ab, of.a + of.ac})
        if (at.is_at(corner, rounding * size)) return true;
      return false;
    };
    return has_corner_at(*this, other) || has_corner_at(other, *this);
  }

  bool in_plane_of(const Triangle& other) const { return std::fabs(dot(normal, other.normal)) > 1.0 - one_direction; }

  static constexpr double rounding = 1e-6;       // of the distance: within it, triangles meet
  static constexpr double one_direction = 1e-6;  // 1 - cosine between contacts that are one: 0.08 degrees
  static constexpr double shallow = 0.06;        // the same at a concave fold, where faces meet: 20 degrees
};

struct TriangleContact {
  int triangle;
  double distance;
  Vec<double> from_wall;  // to the centre of the sphere
};

/// The contacts of a sphere at x, from the nearest on, among the nearest points of all triangles in reach, which are
/// sorted. A point of a triangle is in contact unless a nearer triangle holds it: over a face, an edge or a corner a
/// sphere has one contact, in a concave corner one with each face, in a shallow fold, as of round walls, one with the
/// nearest: the second would begin with a force. Triangles in one plane act as one, orientation has no effect, and a
/// triangle that occurs twice acts once.
template <class TriangleOf>
void find_contacts(const Vec<double>& x, std::vector<TriangleContact>& reached, TriangleOf triangle_of,
                   std::vector<TriangleContact>& found) {
  found.clear();
  std::sort(reached.begin(), reached.end(), [](const TriangleContact& one, const TriangleContact& two) {
    return one.distance < two.distance || (one.distance == two.distance && one.triangle < two.triangle);
  });
  for (std::size_t k = 0; k < reached.size(); ++k) {
    const TriangleContact& c = reached[k];
    const auto has_direction_of = [&](const TriangleContact& nearer) {
      const double along = dot(c.from_wall, nearer.from_wall), lengths = c.distance * nearer.distance;
      return along > (1.0 - Triangle::one_direction) * lengths ||
             (along > (1.0 - Triangle::shallow) * lengths &&
              triangle_of(c.triangle).meets(triangle_of(nearer.triangle), c.distance));
    };
    const Vec<double> at = x - c.from_wall;
    const auto holds_point = [&](const TriangleContact& nearer) {
      return triangle_of(nearer.triangle).is_at(at, Triangle::rounding * c.distance);
    };
    if (std::any_of(found.begin(), found.end(), has_direction_of)) continue;
    if (std::any_of(reached.begin(), reached.begin() + static_cast<std::ptrdiff_t>(k), holds_point)) continue;
    found.push_back(c);
  }
}

/// A contact that passes from one triangle to another takes its record along, at best within a plane.
/// before: the triangle of each record, or -1; now: of each contact; pass(record, contact) is called.
template <class TriangleOf, class Pass>
void pass_records(const std::vector<int>& before, const std::vector<int>& now, double size, TriangleOf triangle_of,
                  Pass pass) {
  std::vector<bool> is_kept(before.size()), has_record(now.size());
  for (std::size_t c = 0; c < now.size(); ++c)
    for (std::size_t k = 0; k < before.size(); ++k)
      if (before[k] == now[c]) is_kept[k] = has_record[c] = true;
  for (const bool bends : {false, true})
    for (std::size_t c = 0; c < now.size(); ++c)
      for (std::size_t k = 0; k < before.size() && !has_record[c]; ++k) {
        if (is_kept[k] || before[k] < 0) continue;
        const auto &from = triangle_of(before[k]), &to = triangle_of(now[c]);
        if (!(bends || from.in_plane_of(to)) || !from.meets(to, size)) continue;
        pass(k, c);
        is_kept[k] = has_record[c] = true;
      }
}

/// Triangles that keep their places.
class TriangleSurface {
 public:
  using Point = Vec<double>;

  /// corners: nine numbers of each triangle, whose area is above zero.
  explicit TriangleSurface(const std::vector<double>& corners) {
    for (std::size_t k = 0; k + 9 <= corners.size(); k += 9) triangles_.emplace_back(corners.data() + k);
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
        const Point away = triangles_[in_cells_[k]].to(x);
        if (dot(away, away) <= distance * distance) found.push_back(in_cells_[k]);
      }
    });
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
  }

  /// The contacts below a distance of `reach`; candidates: among others all triangles in reach.
  void contacts(const Point& x, double reach, const std::vector<int>& candidates,
                std::vector<TriangleContact>& found) const {
    reached_.clear();
    for (const int t : candidates) {
      const Triangle& triangle = triangles_[t];
      if (!(std::fabs(dot(triangle.normal, x - triangle.a)) < reach)) continue;
      const Point away = triangle.to(x);
      const double distance = length(away);
      if (distance < reach && distance > 0.0) reached_.push_back({t, distance, away});
    }
    find_contacts(x, reached_, [this](int t) -> const Triangle& { return triangles_[t]; }, found);
  }

  const Triangle& operator[](int triangle) const { return triangles_[triangle]; }
  int size() const { return static_cast<int>(triangles_.size()); }

 private:
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
  std::vector<int> first_in_, in_cells_;          // of each cell: the place of its first triangle in in_cells_
  mutable std::vector<TriangleContact> reached_;  // scratch
};

}  // namespace epdem::kernels
