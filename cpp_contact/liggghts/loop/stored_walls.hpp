// SPDX-License-Identifier: GPL-2.0-or-later
// Contacts of walls in a restart file. LIGGGHTS keeps them in fixes beside the walls, finds these by their ids, and
// loses without a word what no fix has the id of.
#pragma once

#include <string>
#include <vector>

#include "../simulation.hpp"

#ifdef EPDEM_BUILT_FOR

namespace epdem::liggghts::loop {

/// Access to protected members of Modify.
class StoredFixes : LAMMPS_NS::Modify {
 public:
  /// Notes the fixes of a restart file that hold contacts of walls. Returns false: there is no restart file, or a run
  /// has begun, with which LIGGGHTS forgets the file.
  static bool note(LAMMPS_NS::LAMMPS* lmp) {
    Modify& m = *lmp->modify;
    if (m.nfix_restart_peratom == 0) return false;
    char** const ids = m.*&StoredFixes::id_restart_peratom;
    for (int k = 0; k < m.nfix_restart_peratom; ++k)
      for (const char* const kind : {"history_", "tracker_"})
        if (std::string(ids[k]).rfind(kind, 0) == 0) Simulation::of(lmp).stored_walls.insert(ids[k]);
    return true;
  }
};

/// The contacts of one wall in the restart file. Made with the wall.
class StoredContacts {
 public:
  explicit StoredContacts(LAMMPS_NS::LAMMPS* lmp) : lmp_(lmp), in_time_(StoredFixes::note(lmp)) {}

  /// Before the first run of the wall: ends the program if contacts of the file are lost.
  void claim(const LAMMPS_NS::FixWallGran& wall) {
    if (claimed_) return;
    claimed_ = true;
    std::set<std::string>& stored = Simulation::of(lmp_).stored_walls;
    bool is_new = false;
    for (const std::string& id : histories_of(wall)) is_new |= stored.erase(id) == 0;
    if (!is_new && !in_time_)
      refuse(wall, "its contacts of the restart file ended with the first run; give the fix before this run");
    if (!is_new || !in_time_) return;
    std::string others;
    for (const std::string& id : stored)
      if (lmp_->modify->find_fix(id.c_str()) < 0) others += " " + id.substr(id.find('_') + 1);
    if (!others.empty())
      refuse(wall, "the restart file holds contacts of walls or meshes with the ids" + others +
                       ", and none with this id; give it its id of before, a new wall after a run 0");
  }

 private:
  /// The fixes that hold the contacts of a wall or of its meshes.
  static std::vector<std::string> histories_of(const LAMMPS_NS::FixWallGran& wall) {
    if (!wall.is_mesh_wall()) return {std::string("history_") + wall.id};
    std::vector<std::string> found;
    for (int k = 0; k < wall.n_meshes(); ++k) found.push_back(std::string("tracker_") + wall.mesh_list()[k]->id);
    return found;
  }

  void refuse(const LAMMPS_NS::FixWallGran& wall, const std::string& why) const {
    lmp_->error->all(FLERR, (std::string("fix wall/gran, id ") + wall.id + ": " + why).c_str());
  }

  LAMMPS_NS::LAMMPS* const lmp_;
  const bool in_time_;  // made between read_restart and the first run
  bool claimed_ = false;
};

}  // namespace epdem::liggghts::loop
#endif
