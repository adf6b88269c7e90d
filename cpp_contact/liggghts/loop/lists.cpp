// SPDX-License-Identifier: GPL-2.0-or-later
// In place of LIGGGHTS's search for neighbours: bins side by side in memory, and candidates tested as lanes. The same
// pairs in the same order, with the same histories.
#include <algorithm>
#include <cstring>
#include <vector>

#include "fix_contact_history.h"
#include "fix_neighlist_mesh.h"
#include "neigh_list.h"
#include "replaced.hpp"
#include "state.hpp"
#include "triangles.hpp"

#ifdef EPDEM_BUILT_FOR

namespace epdem::liggghts::loop {
namespace {

/// Whether n bins that begin with these spheres are empty: no loop that ends early, so that it becomes vectors.
template <int n>
bool empty(const int* head) {
  int all = -1;
  for (int b = 0; b < n; ++b) all &= head[b];
  return all == -1;
}

}  // namespace

void Bins::fill(const int* head, const int* next, int count, int spheres) {
  start.resize(count + 1);
  members.resize(spheres + 8);
  bin_of.resize(spheres);
  int n = 0;
  for (int b = 0; b < count;) {
    const int first = b;
    while (b + 32 <= count && empty<32>(head + b)) b += 32;  // most bins are empty
    while (b + 8 <= count && empty<8>(head + b)) b += 8;
    std::fill(start.data() + first, start.data() + b, n);
    for (const int end = std::min(b + 8, count); b < end; ++b) {
      start[b] = n;
      for (int i = head[b]; i >= 0; i = next[i]) {
        bin_of[i] = b;
        members[n++] = i;
      }
    }
  }
  start[count] = n;
}

namespace {

/// Bins that follow one another in memory, as distances from the bin of a sphere.
struct Row {
  int first, last;
};

std::vector<Row> rows_of(const LAMMPS_NS::NeighList& list) {
  std::vector<Row> rows;
  for (int k = 0; k < list.nstencil; ++k) {
    const int bin = list.stencil[k];
    if (!rows.empty() && rows.back().last + 1 == bin)
      rows.back().last = bin;
    else
      rows.push_back({bin, bin});
  }
  return rows;
}

/// The state of a simulation whose neighbours the plugin searches; nullptr: LIGGGHTS's own functions search.
LoopState* searching_loops(LAMMPS_NS::LAMMPS* lmp) {
  return lmp->atom->nlocal > 0 && lmp->atom->radius ? active_loops(lmp) : nullptr;
}

/// The spheres of some bins, one bin after the other.
struct Candidates {
  const int *const start, *const members;
  int* const spheres;  // eight more can be read
  int n = 0;

  explicit Candidates(LoopState& loops)
      : start(loops.bins.start.data()), members(loops.bins.members.data()), spheres(room(loops)) {}

  void add(int first, int last) {
    const int begin = start[first], count = start[last + 1] - begin;
    if (count == 0) return;
    for (int k = 0; k < count; k += 8)  // nearly always one turn
      std::memcpy(spheres + n + k, members + begin + k, 8 * sizeof(int));
    n += count;
  }

 private:
  static int* room(LoopState& loops) {
    if (loops.candidates.size() < loops.bins.members.size()) loops.candidates.resize(loops.bins.members.size());
    return loops.candidates.data();
  }
};

/// Notes where the spheres are.
void note_spheres(std::vector<double>& spheres, const LAMMPS_NS::Atom& atom) {
  const int n = atom.nlocal + atom.nghost;
  spheres.resize(4 * static_cast<std::size_t>(n));
  const double *const x = atom.x[0], *const radius = atom.radius;
  double* row = spheres.data();
  for (int i = 0; i < n; ++i, row += 4) {
    for (int k = 0; k < 3; ++k) row[k] = x[3 * i + k];
    row[3] = radius[i];
  }
}

/// A search for the neighbours of a mesh begins.
void note_search(LAMMPS_NS::LAMMPS* lmp) {
  if (!library_matches(lmp)) return;
  LoopState& loops = state_of(lmp);
  ++loops.mesh_searches;
  if (searching_loops(lmp)) note_spheres(loops.spheres, *lmp->atom);
}

}  // namespace
}  // namespace epdem::liggghts::loop

namespace LAMMPS_NS {

namespace loop = epdem::liggghts::loop;

[[gnu::visibility("default")]] void Neighbor::bin_atoms() {
  static const auto original = loop::next<Neighbor*>("_ZN9LAMMPS_NS8Neighbor9bin_atomsEv");
  original(this);
  if (!epdem::liggghts::library_matches(lmp)) return;
  loop::LoopState& loops = loop::state_of(lmp);  // the first call of a run
  if (!loops.generic) loops.bins.fill(binhead, bins, mbins, atom->nlocal + atom->nghost);
}

[[gnu::visibility("default")]] int Neighbor::check_distance() {
  static const auto original =
      reinterpret_cast<int (*)(Neighbor*)>(dlsym(RTLD_NEXT, "_ZN9LAMMPS_NS8Neighbor14check_distanceEv"));
  const loop::LoopState* const loops = loop::searching_loops(lmp);
  if (!loops || boxcheck || atom->radvary_flag) return original(this);
  const int n = includegroup ? atom->nfirst : atom->nlocal;
  const int here = loops->kernels.spheres.any_moved(atom->x[0], xhold[0], n, triggersq);
  int anywhere = here;
  MPI_Allreduce(&here, &anywhere, 1, MPI_INT, MPI_MAX, world);  // as the other ranks do, by whichever function
  if (anywhere && ago == std::max(every, delay)) ++ndanger;
  return anywhere;
}

[[gnu::visibility("default")]] void Neighbor::granular_bin_no_newton(NeighList* list) {
  static const auto original =
      loop::next<Neighbor*, NeighList*>("_ZN9LAMMPS_NS8Neighbor22granular_bin_no_newtonEPNS_9NeighListE");
  loop::LoopState* const loops = loop::searching_loops(lmp);
  if (!loops || exclude) return original(this, list);
  bin_atoms();
  const std::vector<loop::Row> rows = loop::rows_of(*list);
  loop::note_spheres(loops->spheres, *atom);
  const loop::NearTest test{loops->spheres.data(), contactDistanceFactor, skin};
  const auto near = loops->kernels.spheres.near_sphere;
  loop::Candidates found(*loops);

  FixContactHistory* const history = list->fix_history;
  NeighList* const contacts = history ? list->listgranhistory : nullptr;
  list->ipage->reset();
  if (contacts) {
    contacts->ipage->reset();
    contacts->dpage->reset();
  }
  double** const x = atom->x;
  const double* const radius = atom->radius;
  const int count = includegroup ? atom->nfirst : atom->nlocal, values = contacts ? contacts->dnum : 0;
  for (int i = 0; i < count; ++i) {
    const int bin = loops->bins.bin_of[i];
    found.n = 0;
    for (const loop::Row& row : rows) found.add(bin + row.first, bin + row.last);
    const int n = near(test, i, found.spheres, found.n, found.spheres);
    int* const neighbours = list->ipage->vget();
    if (!neighbours || n > oneatom) error->one(FLERR, "Neighbor list overflow, boost neigh_modify one");
    std::copy_n(found.spheres, n, neighbours);
    list->ilist[i] = i;
    list->firstneigh[i] = neighbours;
    list->numneigh[i] = n;
    list->ipage->vgot(n);
    if (!contacts) continue;
    int* const touched = contacts->ipage->vget();
    double* const kept = contacts->dpage->vget();
    if (!touched || !kept) error->one(FLERR, "Neighbor list overflow, boost neigh_modify one");
    std::fill_n(touched, n, 0);
    std::fill_n(kept, n * values, 0.0);
    for (int k = 0; k < n && history->npartner_[i] > 0; ++k) {
      const int j = neighbours[k];
      const double dx = x[i][0] - x[j][0], dy = x[i][1] - x[j][1], dz = x[i][2] - x[j][2];
      const double sum = (radius[i] + radius[j]) * contactDistanceFactor;
      if (!(dx * dx + dy * dy + dz * dz < sum * sum)) continue;
      const int *const partners = history->partner_[i], *const end = partners + history->npartner_[i];
      const int* const partner = std::find(partners, end, atom->tag[j]);
      if (partner == end) continue;
      touched[k] = 1;
      std::copy_n(history->contacthistory_[i] + (partner - partners) * values, values, kept + k * values);
    }
    contacts->firstneigh[i] = touched;
    contacts->firstdouble[i] = kept;
    contacts->ipage->vgot(n);
    contacts->dpage->vgot(n * values);
  }
  list->inum = count;
}

[[gnu::visibility("default")]] void FixNeighlistMesh::pre_force(int vflag) {
  static const auto original = loop::next<FixNeighlistMesh*, int>("_ZN9LAMMPS_NS16FixNeighlistMesh9pre_forceEi");
  if (buildNeighList) loop::note_search(lmp);
  original(this, vflag);
}

/// LIGGGHTS's does not call pre_force through the dynamic linker. Walls have their velocities before the first forces
/// of a run (FixMoveMesh::setup), because a restart file does not hold them.
[[gnu::visibility("default")]] void FixNeighlistMesh::setup_pre_force(int vflag) {
  static const auto original = loop::next<FixNeighlistMesh*, int>("_ZN9LAMMPS_NS16FixNeighlistMesh15setup_pre_forceEi");
  loop::note_search(lmp);
  original(this, vflag);
  if (!epdem::liggghts::library_matches(lmp)) return;
  for (int k = 0; k < modify->n_fixes_style("move/mesh"); ++k) modify->find_fix_style("move/mesh", k)->setup(vflag);
}

[[gnu::visibility("default")]] void FixNeighlistMesh::handleTriangle(int triangle) {
  static const auto original = loop::next<FixNeighlistMesh*, int>("_ZN9LAMMPS_NS16FixNeighlistMesh14handleTriangleEi");
  loop::LoopState* const loops = loop::searching_loops(lmp);
  if (!loops || atom->ellipsoid) return original(this, triangle);
  loop::Candidates found(*loops);
  // LIGGGHTS does not clip a triangle's box in a 2-D simulation, and keeps boxes while the grid gets coarser
  const auto bins = static_cast<unsigned>(loops->bins.start.size() - 1);
  const auto add = [&](int bin) {
    if (static_cast<unsigned>(bin) < bins) found.add(bin, bin);
  };
  if (changingMesh || changingDomain) {
    int low[3], high[3];
    getBinBoundariesForTriangle(triangle, low[0], high[0], low[1], high[1], low[2], high[2]);
    for (int ix = low[0]; ix <= high[0]; ++ix)
      for (int iy = low[1]; iy <= high[1]; ++iy)
        for (int iz = low[2]; iz <= high[2]; ++iz) {
          const int bin = iz * mbiny * mbinx + iy * mbinx + ix;
          add(bin);
        }
  } else {
    for (const int bin : triangles[triangle].bins) add(bin);
  }
  const loop::NearTest test{loops->spheres.data(), neighbor->contactDistanceFactor, skin};
  const loop::TrianglePlanes planes = loop::Triangles::planes(*mesh_, triangle);
  const int n = loops->kernels.spheres.listed_at_triangle(test, planes, found.spheres, found.n, found.spheres);
  std::vector<int>& contacts = triangles[triangle].contacts;
  contacts.clear();
  for (int k = 0; k < n; ++k) {
    const int i = found.spheres[k];
    if ((i > atom->nlocal && !domain->is_periodic_ghost(i)) || !(atom->mask[i] & groupbit_wall_mesh)) continue;
    contacts.push_back(i);
    fix_nneighs_->set_vector_atom_int(i, fix_nneighs_->get_vector_atom_int(i) + 1);
  }
}

}  // namespace LAMMPS_NS
#endif
