// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <string>
#include <vector>

namespace epdem::lammps {

/// Reads the corners of a binary or ASCII STL file, nine numbers of each triangle; what is wrong with the file, or "".
std::string read_stl(const std::string& path, std::vector<double>& corners);

}  // namespace epdem::lammps
