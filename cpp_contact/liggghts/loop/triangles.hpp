// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "host.hpp"
#include "kernels/spheres.hpp"

namespace epdem::liggghts::loop {

/// Access to protected members of TriMesh.
struct Triangles : LAMMPS_NS::TriMesh {
  static kernels::TrianglePlanes planes(LAMMPS_NS::TriMesh& mesh, int triangle) {
    double** const nodes = (mesh.*(&Triangles::node_))(triangle);
    double** const sides = (mesh.*(&Triangles::edgeNorm))(triangle);
    double* (LAMMPS_NS::SurfaceMesh<3, 5>::* const face)(int) = &Triangles::surfaceNorm;
    return {{(mesh.*(&Triangles::center_))(triangle), nodes[0], nodes[1], nodes[2]},
            {(mesh.*face)(triangle), sides[0], sides[1], sides[2]}};
  }

  /// The corners of all triangles, nine numbers each, owned and ghosts.
  static const double* corners(LAMMPS_NS::TriMesh& mesh) { return (mesh.*(&Triangles::node_))(0)[0]; }
};

}  // namespace epdem::liggghts::loop
