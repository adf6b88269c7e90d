// SPDX-License-Identifier: GPL-2.0-or-later
// LIGGGHTS's wall of one contact model, known as ours: its loop over triangles is shortened (mesh.cpp).
#pragma once

#include "host.hpp"

namespace epdem::liggghts::loop {

/// By this LIGGGHTS's walls of our models differ from others.
struct OurWall {
  virtual ~OurWall() = default;
};

template <class Model>
class Wall : public LIGGGHTS::Walls::Granular<Model>, public OurWall {
 public:
  using LIGGGHTS::Walls::Granular<Model>::Granular;
};

}  // namespace epdem::liggghts::loop
