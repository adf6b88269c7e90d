// SPDX-License-Identifier: BSD-3-Clause
// Conduction of heat or current through the area of a contact.
#pragma once

namespace epdem {

/// Conductance of a circle of this radius between two half-spaces of these conductivities: twice the radius times their
/// harmonic mean (Holm 1967; Batchelor and O'Brien 1977).
inline double conductance(double k_i, double k_j, double radius) noexcept {
  return 4.0 * k_i * k_j / (k_i + k_j) * radius;
}

}  // namespace epdem
