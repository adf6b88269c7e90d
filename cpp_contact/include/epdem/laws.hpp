// SPDX-License-Identifier: GPL-2.0-or-later
// The register of laws: a new law is its header above this list and one line in it.
#pragma once

#include "cavity.hpp"
#include "hertz.hpp"
#include "johnson.hpp"
#include "law.hpp"
#include "thornton.hpp"

// X(class, LIGGGHTS name, id): ids are stored in LIGGGHTS restart files and never change.
#define EPDEM_LAWS(X)      \
  X(Hertz, hertz, 40)      \
  X(Thornton, thornton, 41) \
  X(Johnson, johnson, 42)  \
  X(Cavity, cavity, 43)
