// SPDX-License-Identifier: GPL-2.0-or-later
#include "stl.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <sstream>

#include "epdem/vec.hpp"

namespace epdem::lammps {
namespace {

constexpr std::size_t head = 84, row = 50;  // [byte] of a binary file: text and number of triangles, a triangle

std::size_t count_in_head(const std::string& bytes) {
  std::uint32_t count = 0;
  if (bytes.size() >= head) std::memcpy(&count, bytes.data() + head - sizeof count, sizeof count);
  return count;
}

void read_binary(const std::string& bytes, std::vector<double>& corners) {
  for (std::size_t k = head; k < bytes.size(); k += row) {
    float numbers[12];  // normal and corners
    std::memcpy(numbers, bytes.data() + k, sizeof numbers);
    corners.insert(corners.end(), numbers + 3, numbers + 12);
  }
}

std::string read_text(const std::string& bytes, std::vector<double>& corners) {
  std::istringstream lines(bytes);
  std::string line, word;
  std::size_t before = 0;
  bool is_open = false;
  for (int number = 1; std::getline(lines, line); ++number) {
    const std::string at = "line " + std::to_string(number) + ": ";
    std::transform(line.begin(), line.end(), line.begin(), [](unsigned char c) { return std::tolower(c); });
    std::istringstream words(line);
    words >> word;
    if (!words) continue;
    if (word == "facet") {
      if (is_open) return at + "the triangle before has no endfacet";
      is_open = true;
      before = corners.size();
    } else if (word == "vertex") {
      for (int k = 0; k < 3; ++k) {
        char* end = nullptr;
        words >> word;
        corners.push_back(words ? std::strtod(word.c_str(), &end) : NAN);
        if (!words || *end) return at + "a vertex needs three numbers";
      }
    } else if (word == "endfacet") {
      if (!is_open || corners.size() != before + 9) return at + "the triangle has not three corners";
      is_open = false;
    }
  }
  return is_open || corners.size() % 9 ? "the text ends within a triangle" : "";
}

std::string fault_of(const std::vector<double>& corners) {
  for (std::size_t k = 0; k < corners.size(); k += 9) {
    const double* const c = corners.data() + k;
    const std::string triangle = "triangle " + std::to_string(k / 9 + 1);
    if (!std::all_of(c, c + 9, [](double x) { return std::isfinite(x); }))
      return triangle + " has corners that are not numbers";
    const Vec<double> a{c[0], c[1], c[2]}, ab = Vec<double>{c[3], c[4], c[5]} - a,
                                           ac = Vec<double>{c[6], c[7], c[8]} - a, bc = ac - ab;
    const double longest = std::max({dot(ab, ab), dot(ac, ac), dot(bc, bc)});
    if (length(cross(ab, ac)) > 1e-6 * longest) continue;
    std::ostringstream place;
    place << triangle << " at (" << a.x << ", " << a.y << ", " << a.z << ") has no area";
    return place.str();
  }
  return "";
}

}  // namespace

std::string read_stl(const std::string& path, std::vector<double>& corners) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return "the file cannot be read";
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  const std::size_t count = count_in_head(bytes);
  std::string wrong;
  if (bytes.size() == head + row * count && bytes.size() >= head)
    read_binary(bytes, corners);
  else if (bytes.find("facet") == std::string::npos && bytes.find("FACET") == std::string::npos)
    return "not an STL file: " + std::to_string(bytes.size()) + " bytes, where the " + std::to_string(count) +
           " triangles of its header have " + std::to_string(head + row * count) + ", and without the word facet";
  else
    wrong = read_text(bytes, corners);
  if (wrong.empty()) wrong = corners.empty() ? "there are no triangles" : fault_of(corners);
  return wrong;
}

}  // namespace epdem::lammps
