// SPDX-License-Identifier: GPL-2.0-or-later
// To preload into a launcher: times every evaluation of the pair style and every step, and appends the shortest of both
// [ms] to the file that EPDEM_TIMES names: processor time of this process, and the shortest of many steps, because on a
// shared machine a sum does not repeat.
#include <mpi.h>

#include <cstdio>
#include <cstdlib>
#include <ctime>

#include "comm.h"
#include "granular_pair_style.h"
#include "pair_gran_proxy.h"
#include "update.h"

namespace {

constexpr int warm_up = 10;  // steps that do not count

double now() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return t.tv_sec + 1e-9 * t.tv_nsec;
}

struct Shortest {
  double pair = 1e300, step = 1e300, last = 0.0;
  int count = 0, rank = 0;
  ~Shortest() {
    const char* const name = std::getenv("EPDEM_TIMES");
    if (!name || rank != 0 || count <= warm_up) return;
    if (FILE* const file = std::fopen(name, "a")) {
      std::fprintf(file, "%.6f %.6f\n", 1e3 * pair, 1e3 * step);
      std::fclose(file);
    }
  }
} shortest;

}  // namespace

__attribute__((visibility("default"))) void LAMMPS_NS::PairGranProxy::compute_force(int eflag, int vflag, int addflag) {
  const double start = now();
  impl->compute_force(this, eflag, vflag, addflag);
  const double end = now();
  Shortest& s = shortest;
  s.rank = comm->me;
  const bool follows = !update->setupflag && s.count++ > warm_up;
  if (follows && end - start < s.pair) s.pair = end - start;
  if (follows && start - s.last < s.step) s.step = start - s.last;
  s.last = start;
}
