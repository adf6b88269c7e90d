// SPDX-License-Identifier: BSD-3-Clause
// Plastic spheres in a box. Reads the side of the box, the time step, the number of steps and x y z vx vy vz of each
// sphere [SI]; prints the same six numbers of each sphere at the end.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <unordered_map>
#include <vector>

#include <epdem/contact.hpp>
#include <epdem/laws.hpp>

using Vec = epdem::Vec<double>;
using Law = epdem::Thornton<double>;     // any law of laws.hpp
using Friction = epdem::PartialSlip<3>;  // any model of sub_models.hpp
using History = epdem::ContactHistory<Law, Friction>;

constexpr double radius = 1e-3, density = 7850.0, mass = density * 4.0 / 3.0 * epdem::pi * radius * radius * radius;
constexpr double inertia = 0.4 * mass * radius * radius;
constexpr epdem::Elastic steel{208e9, 0.3};
constexpr double yield_pressure[] = {2.8e9}, friction = 0.3;

struct Sphere {
  Vec x, v, spin{}, force{}, torque{};
};

struct Box {
  double side, dt;
  std::vector<Sphere> spheres;
  epdem::ContactConstants<Law> pair{};
  epdem::ContactSettings settings{};
  std::unordered_map<std::uint64_t, History> histories, last;

  /// One contact of sphere i with a sphere j < n or a wall n + 0 to 5; a contact without history is new.
  template <bool wall>
  epdem::ContactLoads<double> contact(std::size_t i, std::size_t j, const epdem::Kinematics<double>& c) {
    const std::uint64_t key = i * (spheres.size() + 6) + j;
    const auto found = last.find(key);
    History& history = histories[key] = found == last.end() ? History{} : found->second;
    const auto m_star = [] { return wall ? mass : 0.5 * mass; };
    return epdem::contact<Friction, wall>(pair, settings, c, history, m_star, epdem::NoObserver{});
  }

  void spheres_touch(std::size_t i, std::size_t j) {
    Sphere &a = spheres[i], &b = spheres[j];
    const Vec d = a.x - b.x;
    if (dot(d, d) >= 4.0 * radius * radius) return;
    const auto loads = contact<false>(i, j, epdem::between_spheres(radius, radius, d, a.v - b.v, a.spin, b.spin));
    a.force = a.force + loads.force;
    b.force = b.force - loads.force;
    a.torque = a.torque + loads.torque_i;
    b.torque = b.torque + loads.torque_j;
  }

  void wall_touches(std::size_t i, int wall) {
    Sphere& a = spheres[i];
    const int axis = wall / 2;
    const double at = axis == 0 ? a.x.x : axis == 1 ? a.x.y : a.x.z;
    const double gap = wall % 2 ? side - at : at, sign = wall % 2 ? -1.0 : 1.0;  // normal: from the wall to the sphere
    if (gap >= radius) return;
    const Vec d{axis == 0 ? sign * gap : 0.0, axis == 1 ? sign * gap : 0.0, axis == 2 ? sign * gap : 0.0};
    const auto c = epdem::at_wall(radius, radius - gap, d, a.v, a.spin);
    const auto loads = contact<true>(i, spheres.size() + wall, c);
    a.force = a.force + loads.force;
    a.torque = a.torque + loads.torque_i;
  }

  void forces() {
    last.swap(histories);
    histories.clear();
    const int cells = std::max(1, int(side / (2.0 * radius)));
    const auto cell = [&](double x) { return std::min(cells - 1, std::max(0, int(x / side * cells))); };
    std::unordered_map<int, std::vector<std::size_t>> members;  // spheres so far by their cell
    for (std::size_t i = 0; i < spheres.size(); ++i) {
      spheres[i].force = spheres[i].torque = Vec{};
      for (int wall = 0; wall < 6; ++wall) wall_touches(i, wall);
      const int X = cell(spheres[i].x.x), Y = cell(spheres[i].x.y), Z = cell(spheres[i].x.z);
      for (int x = X - 1; x <= X + 1; ++x)
        for (int y = Y - 1; y <= Y + 1; ++y)
          for (int z = Z - 1; z <= Z + 1; ++z)
            if (const auto near = members.find((x * (cells + 2) + y) * (cells + 2) + z); near != members.end())
              for (const std::size_t j : near->second) spheres_touch(i, j);
      members[(X * (cells + 2) + Y) * (cells + 2) + Z].push_back(i);
    }
  }

  void step() {  // velocity Verlet
    const auto kick = [&](Sphere& s) {
      s.v = s.v + (0.5 * dt / mass) * s.force;
      s.spin = s.spin + (0.5 * dt / inertia) * s.torque;
    };
    for (Sphere& s : spheres) kick(s), s.x = s.x + dt * s.v;
    forces();
    for (Sphere& s : spheres) kick(s);
  }
};

int main() {
  Box box{};
  long steps = 0;
  Vec x, v;
  if (std::scanf("%lf %lf %ld", &box.side, &box.dt, &steps) != 3) return 1;
  while (std::scanf("%lf %lf %lf %lf %lf %lf", &x.x, &x.y, &x.z, &v.x, &v.y, &v.z) == 6) box.spheres.push_back({x, v});
  box.pair.law = Law(epdem::effective_modulus(steel, steel), yield_pressure);
  box.pair.shear_modulus = epdem::effective_shear_modulus(steel, steel);
  box.pair.friction = friction;
  box.settings.dt = box.dt;
  for (long n = 0; n < steps; ++n) box.step();
  for (const Sphere& s : box.spheres)
    std::printf("%.17g %.17g %.17g %.17g %.17g %.17g\n", s.x.x, s.x.y, s.x.z, s.v.x, s.v.y, s.v.z);
}
