// SPDX-License-Identifier: GPL-2.0-or-later
// Histories of pairs where LIGGGHTS gives them to other contacts or forgets them: delete_atoms gives numbers anew, by
// which histories name their partners (`compress yes`, the default), and neighbour lists that hold them end between
// runs.
#include "delete_atoms.h"
#include "fix_contact_history.h"
#include "modify.h"
#include "replaced.hpp"
#include "state.hpp"

#ifdef EPDEM_BUILT_FOR

#include <algorithm>
#include <utility>
#include <vector>

namespace epdem::liggghts::loop {
namespace {

struct Histories : LAMMPS_NS::FixContactHistory {
  static int* partners(FixContactHistory& of, int i) { return (of.*(&Histories::partner_))[i]; }
};

/// Whether delete_atoms runs.
bool deletes_atoms(LAMMPS_NS::LAMMPS* lmp) {
  if (!library_matches(lmp)) return false;
  const Simulation* const known = Simulation::find(lmp);
  return known && known->loops && known->loops->deletes_atoms;
}

/// The numbers of all atoms before delete_atoms: a property that goes with its atom.
class Numbers : protected LAMMPS_NS::Pointers {
 public:
  explicit Numbers(LAMMPS_NS::LAMMPS* lmp) : Pointers(lmp) {
    const char* words[] = {name, "all", "property/atom", name, "scalar", "no", "no", "no", "0"};
    before_ = modify->add_fix_property_atom(9, const_cast<char**>(words), "epdem");
    for (int i = 0; i < atom->nlocal; ++i) before_->vector_atom[i] = atom->tag[i];
  }
  Numbers(const Numbers&) = delete;
  Numbers& operator=(const Numbers&) = delete;
  ~Numbers() { modify->delete_fix(name); }

  /// Gives partners their new numbers, 0 to those that are deleted. Collective.
  void follow(LAMMPS_NS::FixContactHistory& histories) const {
    const std::vector<std::pair<int, int>> all = of_all_ranks();
    for (int i = 0; i < atom->nlocal; ++i) {
      int* const partners = Histories::partners(histories, i);
      for (int k = 0; k < histories.n_partner(i); ++k) {
        const auto at = std::lower_bound(all.begin(), all.end(), std::pair{partners[k], 0});
        partners[k] = at != all.end() && at->first == partners[k] ? at->second : 0;
      }
    }
  }

 private:
  static constexpr const char* name = "epdemNumbers";

  /// Pairs of a number before and now, sorted.
  std::vector<std::pair<int, int>> of_all_ranks() const {
    std::vector<int> mine, counts(comm->nprocs), starts(comm->nprocs);
    for (int i = 0; i < atom->nlocal; ++i) {
      mine.push_back(static_cast<int>(before_->vector_atom[i]));
      mine.push_back(atom->tag[i]);
    }
    const int count = static_cast<int>(mine.size());
    MPI_Allgather(&count, 1, MPI_INT, counts.data(), 1, MPI_INT, world);
    for (int rank = 1; rank < comm->nprocs; ++rank) starts[rank] = starts[rank - 1] + counts[rank - 1];
    std::vector<int> numbers(starts.back() + counts.back());
    MPI_Allgatherv(mine.data(), count, MPI_INT, numbers.data(), counts.data(), starts.data(), MPI_INT, world);
    std::vector<std::pair<int, int>> all;
    for (std::size_t k = 0; k < numbers.size(); k += 2) all.emplace_back(numbers[k], numbers[k + 1]);
    std::sort(all.begin(), all.end());
    return all;
  }

  LAMMPS_NS::FixPropertyAtom* before_;
};

}  // namespace
}  // namespace epdem::liggghts::loop

namespace LAMMPS_NS {

namespace loop = epdem::liggghts::loop;

[[gnu::visibility("default")]] void DeleteAtoms::command(int count, char** words) {
  static const auto original = loop::next<DeleteAtoms*, int, char**>("_ZN9LAMMPS_NS11DeleteAtoms7commandEiPPc");
  const bool stored = modify->n_fixes_style_strict("contacthistory") > 0;
  if (!stored || !epdem::liggghts::library_matches(lmp)) return original(this, count, words);
  const loop::Numbers numbers(lmp);
  loop::LoopState& loops = loop::state_of(lmp);
  loops.deletes_atoms = true;
  original(this, count, words);
  loops.deletes_atoms = false;
  numbers.follow(*static_cast<FixContactHistory*>(modify->find_fix_style_strict("contacthistory", 0)));
}

/// A second delete_atoms would read the lists of the last run, whose atoms have other places now.
[[gnu::visibility("default")]] void FixContactHistory::pre_exchange() {
  static const auto original = loop::next<FixContactHistory*>("_ZN9LAMMPS_NS17FixContactHistory12pre_exchangeEv");
  if (*computeflag_ || !loop::deletes_atoms(lmp)) original(this);
}

/// Stores histories before LIGGGHTS deletes the lists that hold them. LIGGGHTS deletes lists whose style, pages or
/// requests have changed since the run before.
[[gnu::visibility("default")]] void Neighbor::init() {
  static const auto original = loop::next<Neighbor*>("_ZN9LAMMPS_NS8Neighbor4initEv");
  if (epdem::liggghts::library_matches(lmp))
    for (int k = 0; k < modify->n_fixes_style_strict("contacthistory"); ++k)
      modify->find_fix_style_strict("contacthistory", k)->setup_pre_exchange();
  original(this);
}

}  // namespace LAMMPS_NS
#endif
