// SPDX-License-Identifier: GPL-2.0-or-later
// Finite elements of a sphere (R = 1, Y = 1) that rigid planes without friction press, the symmetry planes of a
// lattice:
//   g++ -std=c++17 -O3 -march=native -ffast-math bench/finite_elements.cpp -o finite_elements
//   ./finite_elements LATTICE E/Y nu n D [speed [back [ball]]] > lattice.csv
// LATTICE: sc, fcc, bcc, hex (simple hexagonal), tet (simple tetragonal, two planes at 1.1 of the distance of the
// others), die (simple cubic, four planes stay) or pair (two planes, or two rigid balls of the radius `ball`); n:
// elements along an edge of the inner cube, D: last relative density, of a pair the last distance of the planes; speed
// of the planes over sqrt(Y/density), 0.02 by default. With `back`, the speed of the release, the planes stop at D, are
// held there and go back until they are free; a first column is the phase: 0, 1 and 2. One octant, hexahedra with 2 x 2
// x 2 points and one pressure p = K ln(V/V0) each (Q1P0), ideally plastic J2 with the Jaumann rate of the deviator,
// central differences. Masses of the elements are scaled to one critical time step.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

namespace {

constexpr int lanes = 8;  // elements computed at once
using Real = double __attribute__((vector_size(8 * lanes)));
using Point = std::array<double, 3>;

constexpr double bulk_viscosity = 0.1, drag = 0.2;  // damping: of the volume rate, and of the velocity [1/time]
constexpr double courant = 0.6;
constexpr int rows = 225;  // of the table of the loading

// The planes slow down, stand and start back in these times; then rows of the table are these times and ways apart.
constexpr double slowing = 0.6, standing = 2.5, starting = 0.5;
constexpr double held_row = 0.2, back_row = 1e-4;

struct Plane {
  Point normal;
  double ratio;  // distance over the first distance
  bool moves;
  int group;
};

struct Lattice {
  std::vector<Plane> planes;  // those that touch the octant
  std::vector<int> counts;    // planes of each group around the whole sphere
  double cell;                // volume of the cell over distance^3; over distance for a die
  const char* header;
};

Lattice lattice_of(const std::string& name) {
  const double h = std::sqrt(0.5), t = std::sqrt(1.0 / 3.0), w = std::sqrt(0.75);
  const Point x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
  if (name == "sc") return {{{x, 1, true, 0}, {y, 1, true, 0}, {z, 1, true, 0}}, {6}, 8.0, "force"};
  if (name == "fcc")
    return {{{{h, h, 0}, 1, true, 0}, {{h, 0, h}, 1, true, 0}, {{0, h, h}, 1, true, 0}}, {12}, 8.0 * h, "force"};
  if (name == "bcc")
    return {{{{t, t, t}, 1, true, 0}, {x, 2 * t, true, 1}, {y, 2 * t, true, 1}, {z, 2 * t, true, 1}},
            {8, 6},
            32.0 * t * t * t,
            "force_first,force_second"};
  if (name == "hex") return {{{x, 1, true, 0}, {{0.5, w, 0}, 1, true, 0}, {z, 1, true, 0}}, {8}, 8.0 * w, "force"};
  if (name == "tet")
    return {{{x, 1, true, 0}, {y, 1, true, 0}, {z, 1.1, true, 1}}, {4, 2}, 8.8, "force_first,force_second"};
  if (name == "pair") return {{{z, 1, true, 0}}, {2}, 1.0, "force"};
  if (name == "die")
    return {{{x, 1, false, 0}, {y, 1, false, 0}, {z, 1, true, 1}}, {4, 2}, 8.0, "force_side,force_top"};
  std::fprintf(stderr, "lattice %s: must be sc, fcc, bcc, hex, tet, die or pair\n", name.c_str());
  std::exit(2);
}

Point scaled(const Point& a, double s) { return {a[0] * s, a[1] * s, a[2] * s}; }
double dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Point minus(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Point cross(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

struct Mesh {
  std::vector<Point> x;
  std::vector<std::array<int, 8>> elements;  // corner i + 2 j + 4 k
};

// An inner cube of n^3 elements with bulged faces, and three blocks of n x n x m between its faces and the sphere.
Mesh octant(int n) {
  Mesh mesh;
  std::map<std::array<long, 3>, int> found;
  const auto node = [&](const Point& p) {
    const auto [at, fresh] = found.try_emplace(
        {std::lround(1e7 * p[0]), std::lround(1e7 * p[1]), std::lround(1e7 * p[2])}, static_cast<int>(mesh.x.size()));
    if (fresh) mesh.x.push_back(p);
    return at->second;
  };
  const auto inner = [](const Point& u) {
    const double r = std::sqrt(dot(u, u)), most = std::max({u[0], u[1], u[2]});
    return scaled(u, r > 0.0 ? 0.55 * (0.5 + 0.5 * most / r) : 0.0);
  };
  const auto outer = [&](int axis, double t, double v, double w) {
    Point u, s;
    u[axis] = 1.0, u[(axis + 1) % 3] = v, u[(axis + 2) % 3] = w;
    for (int k = 0; k < 3; ++k) s[k] = std::tan(std::atan(1.0) * u[k]);
    const Point a = inner(u), b = scaled(s, 1.0 / std::sqrt(dot(s, s)));
    return Point{a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), a[2] + t * (b[2] - a[2])};
  };
  const int m = static_cast<int>(std::lround(0.58 * n));
  for (int block = -1; block < 3; ++block)
    for (int i = 0; i < (block < 0 ? n : m); ++i)
      for (int j = 0; j < n; ++j)
        for (int k = 0; k < n; ++k) {
          std::array<int, 8> corners;
          for (int c = 0; c < 8; ++c) {
            const double a = i + (c & 1), b = double(j + (c >> 1 & 1)) / n, d = double(k + (c >> 2)) / n;
            corners[c] = node(block < 0 ? inner({a / n, b, d}) : outer(block, a / m, b, d));
          }
          mesh.elements.push_back(corners);
        }
  return mesh;
}

// Volume over the largest face, from the corners.
double height(const Mesh& mesh, const std::array<int, 8>& e, double volume) {
  static constexpr int faces[6][4] = {{0, 2, 6, 4}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                      {2, 3, 7, 6}, {0, 1, 3, 2}, {4, 5, 7, 6}};
  double most = 0.0;
  for (const auto& f : faces) {
    const Point a = cross(minus(mesh.x[e[f[2]]], mesh.x[e[f[0]]]), minus(mesh.x[e[f[3]]], mesh.x[e[f[1]]]));
    most = std::max(most, 0.5 * std::sqrt(dot(a, a)));
  }
  return volume / most;
}

struct Batch {                // of elements
  Real stress[8][6] = {};     // deviator at each point: xx, yy, zz, xy, yz, zx
  Real volume, first_volume;  // now and at the start
};

class Shapes {  // derivatives of the shape functions at the points
 public:
  double d[8][8][3];
  Shapes() {
    const double g = std::sqrt(1.0 / 3.0);
    for (int p = 0; p < 8; ++p)
      for (int c = 0; c < 8; ++c) {
        double sign[3], value[3];
        for (int k = 0; k < 3; ++k) {
          sign[k] = (c >> k & 1) ? 1.0 : -1.0;
          value[k] = 0.5 * (1.0 + sign[k] * ((p >> k & 1) ? g : -g));
        }
        for (int k = 0; k < 3; ++k) d[p][c][k] = 0.5 * sign[k] * value[(k + 1) % 3] * value[(k + 2) % 3];
      }
  }
};

struct Material {
  double G, K, M;  // moduli of shear, of volume and of waves
};

// Stresses after the step `u` of the corners at `x`, and the forces on the corners.
void evaluate(Batch& batch, const Real (&x)[8][3], const Real (&u)[8][3], const Material& material, double viscosity,
              Real (&force)[8][3]) {
  static const Shapes shapes;
  static constexpr int at[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};
  Real mean[8][3] = {}, volume = {};
  for (auto& f : force) f[0] = f[1] = f[2] = Real{};
  for (int p = 0; p < 8; ++p) {
    Real J[3][3] = {}, inverse[3][3], gradient[8][3], L[3][3] = {};
    for (int c = 0; c < 8; ++c)
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b) J[a][b] += shapes.d[p][c][b] * x[c][a];
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b) {
        const int a1 = (a + 1) % 3, a2 = (a + 2) % 3, b1 = (b + 1) % 3, b2 = (b + 2) % 3;
        inverse[b][a] = J[a1][b1] * J[a2][b2] - J[a1][b2] * J[a2][b1];
      }
    const Real det = J[0][0] * inverse[0][0] + J[0][1] * inverse[1][0] + J[0][2] * inverse[2][0];
    for (int c = 0; c < 8; ++c)
      for (int a = 0; a < 3; ++a) {  // times det
        gradient[c][a] =
            shapes.d[p][c][0] * inverse[0][a] + shapes.d[p][c][1] * inverse[1][a] + shapes.d[p][c][2] * inverse[2][a];
        mean[c][a] += gradient[c][a];
      }
    volume += det;
    for (int c = 0; c < 8; ++c)
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b) L[a][b] += u[c][a] * gradient[c][b];
    const Real one = 1.0 / det;
    for (auto& row : L)
      for (auto& value : row) value *= one;
    Real(&s)[6] = batch.stress[p];
    Real t[6], square = {}, scale;
    const Real third = (L[0][0] + L[1][1] + L[2][2]) / 3.0;
    for (int a = 0; a < 3; ++a)
      for (int b = a; b < 3; ++b) {  // s + W s - s W + 2 G dev(D)
        Real value = s[at[a][b]] + material.G * (L[a][b] + L[b][a] - (a == b ? 2.0 * third : Real{}));
        for (int k = 0; k < 3; ++k)
          value += 0.5 * ((L[a][k] - L[k][a]) * s[at[k][b]] + (L[b][k] - L[k][b]) * s[at[a][k]]);
        t[at[a][b]] = value;
        square += (a == b ? 1.5 : 3.0) * value * value;
      }
    for (int l = 0; l < lanes; ++l) scale[l] = square[l] > 1.0 ? 1.0 / std::sqrt(square[l]) : 1.0;
    for (int k = 0; k < 6; ++k) s[k] = scale * t[k];
    for (int c = 0; c < 8; ++c)
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b) force[c][a] -= s[at[a][b]] * gradient[c][b];
  }
  Real growth = {}, pressure;
  for (int c = 0; c < 8; ++c)
    for (int a = 0; a < 3; ++a) growth += mean[c][a] * u[c][a];
  for (int l = 0; l < lanes; ++l) pressure[l] = material.K * std::log(volume[l] / batch.first_volume[l]);
  pressure += viscosity * growth / volume;
  for (int c = 0; c < 8; ++c)
    for (int a = 0; a < 3; ++a) force[c][a] -= pressure * mean[c][a];
  batch.volume = volume;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 6) {
    std::fprintf(stderr, "finite_elements LATTICE E/Y nu n D [speed [back [ball]]]\n");
    return 2;
  }
  const std::string name = argv[1];
  const Lattice lattice = lattice_of(name);
  const double E = std::atof(argv[2]), nu = std::atof(argv[3]), density = std::atof(argv[5]);
  const double speed = argc > 6 ? std::atof(argv[6]) : 0.02, back = argc > 7 ? std::atof(argv[7]) : 0.0;
  const double ball = argc > 8 ? std::atof(argv[8]) : 0.0;
  const Material material{E / (2 * (1 + nu)), E / (3 * (1 - 2 * nu)), E * (1 - nu) / ((1 + nu) * (1 - 2 * nu))};
  const double ratio = 4.0 / 3.0 * std::acos(-1.0) / (lattice.cell * density);
  const double end = name == "pair" ? density : name == "die" ? ratio : std::cbrt(ratio);  // last distance
  if (!(E > 0.0 && nu > -1.0 && nu < 0.5 && end < 1.0 && speed > 0.0 && back >= 0.0)) {
    std::fprintf(stderr, "E/Y and the speeds must be above 0, nu in (-1, 0.5), D above that of touching spheres\n");
    return 2;
  }
  Mesh mesh = octant(std::atoi(argv[4]));
  const int elements = static_cast<int>(mesh.elements.size()), nodes = static_cast<int>(mesh.x.size());
  if (elements == 0 || elements % lanes != 0) {
    std::fprintf(stderr, "n = %s gives %d elements, must be a multiple of %d; take n = 8, 12, 16\n", argv[4], elements,
                 lanes);
    return 2;
  }
  std::vector<Batch> batches(elements / lanes);
  std::vector<double> mass(nodes), heights(elements);
  std::vector<std::array<bool, 3>> held(nodes);  // on the planes of symmetry of the octant
  std::vector<Point> u(nodes, Point{}), f(nodes, Point{});
  for (int i = 0; i < nodes; ++i)
    for (int k = 0; k < 3; ++k) held[i][k] = mesh.x[i][k] < 1e-9;

  double viscosity = 0.0;
  const auto internal_forces = [&] {
    for (auto& force : f) force = {};
    for (int b = 0; b < elements / lanes; ++b) {
      Real x[8][3], step[8][3], force[8][3];
      for (int l = 0; l < lanes; ++l)
        for (int c = 0; c < 8; ++c)
          for (int a = 0; a < 3; ++a) {
            const int i = mesh.elements[b * lanes + l][c];
            x[c][a][l] = mesh.x[i][a];
            step[c][a][l] = u[i][a];
          }
      evaluate(batches[b], x, step, material, viscosity, force);
      for (int l = 0; l < lanes; ++l)
        for (int c = 0; c < 8; ++c)
          for (int a = 0; a < 3; ++a) f[mesh.elements[b * lanes + l][c]][a] += force[c][a][l];
    }
  };

  for (auto& batch : batches) batch.first_volume = 1.0 + Real{};
  internal_forces();
  double mean_height = 0.0;
  for (auto& batch : batches) batch.first_volume = batch.volume;
  for (int e = 0; e < elements; ++e) {
    heights[e] = height(mesh, mesh.elements[e], batches[e / lanes].volume[e % lanes]);
    mean_height += heights[e] / elements;
  }
  for (int e = 0; e < elements; ++e)  // density (mean_height/height)^2
    for (const int i : mesh.elements[e])
      mass[i] += 0.125 * batches[e / lanes].volume[e % lanes] * std::pow(mean_height / heights[e], 2);

  const double interval = (1.0 - end) / rows, turn = end + 0.5 * slowing * speed;
  const std::size_t groups = lattice.counts.size();
  std::vector<Point> v(nodes, Point{});
  std::vector<double> impulse(groups, 0.0);
  double distance = 1.0, row_start = 1.0, dt = 0.0, row_time = 0.0, phase_time = 0.0;
  int phase = 0, free_rows = 0;
  std::printf("%sdistance,%s\n", back > 0.0 ? "phase," : "", lattice.header);
  f.assign(nodes, Point{});
  for (long step = 0, row = 1; row <= rows && free_rows < 3; ++step) {
    if (step % 50 == 0) {
      dt = 1e9;
      for (int e = 0; e < elements; ++e)
        dt = std::min(dt, height(mesh, mesh.elements[e], batches[e / lanes].volume[e % lanes]) / heights[e]);
      dt *= courant * mean_height / std::sqrt(material.M);
      viscosity = bulk_viscosity * std::sqrt(material.M) * mean_height / dt;
    }
    if ((phase == 0 && back > 0.0 && distance <= turn) || (phase == 1 && phase_time >= slowing + standing))
      ++phase, phase_time = 0.0, row_time = 0.0, row_start = distance, impulse.assign(groups, 0.0);
    const double closing = phase == 0   ? speed
                           : phase == 1 ? speed * std::max(0.0, 1.0 - phase_time / slowing)
                                        : -back * std::min(1.0, phase_time / starting);
    distance -= closing * dt;
    row_time += dt, phase_time += dt;
    for (int i = 0; i < nodes; ++i) {
      for (int k = 0; k < 3; ++k) {
        u[i][k] = held[i][k] ? 0.0 : dt * (v[i][k] + dt * (f[i][k] / mass[i] - drag * v[i][k]));
        mesh.x[i][k] += u[i][k];
      }
      for (int sweep = 0; sweep < 3; ++sweep)
        for (const Plane& plane : lattice.planes) {
          double depth = dot(plane.normal, mesh.x[i]) - (plane.moves ? plane.ratio * distance : plane.ratio);
          Point way = plane.normal;
          if (ball > 0.0) {  // on the normal of the plane, which touches it
            const Point to_ball = minus(scaled(plane.normal, distance + ball), mesh.x[i]);
            const double far = std::sqrt(dot(to_ball, to_ball));
            depth = ball - far;
            way = scaled(to_ball, 1.0 / far);
          }
          if (depth <= 0.0) continue;
          const double along = dot(way, plane.normal);
          for (int k = 0; k < 3; ++k)
            if (held[i][k]) way[k] = 0.0;
          const double push = depth / dot(way, way);
          for (int k = 0; k < 3; ++k) {
            u[i][k] -= push * way[k];
            mesh.x[i][k] -= push * way[k];
          }
          impulse[plane.group] += mass[i] * push * along / dt;
        }
      v[i] = scaled(u[i], 1.0 / dt);
    }
    internal_forces();
    const bool ends = phase == 0   ? distance <= 1.0 - row * interval
                      : phase == 1 ? row_time >= held_row
                                   : std::abs(distance - row_start) >= back_row;
    if (!ends) continue;
    bool free = phase == 2;
    if (back > 0.0) std::printf("%d,", phase);
    std::printf("%.6f", 0.5 * (row_start + distance));
    for (std::size_t g = 0; g < groups; ++g) std::printf(",%.6g", 8.0 * impulse[g] / row_time / lattice.counts[g]);
    std::printf("\n");
    std::fflush(stdout);
    for (const Plane& plane : lattice.planes) free = free && (!plane.moves || impulse[plane.group] == 0.0);
    free_rows += free;
    row += phase == 0;
    impulse.assign(groups, 0.0);
    row_time = 0.0, row_start = distance;
  }
  return 0;
}
