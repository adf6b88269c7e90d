// SPDX-License-Identifier: GPL-2.0-or-later
// YADE's headers, and what the classes here read of YADE.
#pragma once

#include <array>
#include <atomic>
#include <boost/serialization/array.hpp>
#include <cstring>
#include <limits>
#include <sstream>

#include <core/Body.hpp>
#include <core/Cell.hpp>
#include <core/Clump.hpp>
#include <core/Dispatching.hpp>
#include <core/EnergyTracker.hpp>
#include <core/Interaction.hpp>
#include <core/Omega.hpp>
#include <core/Scene.hpp>
#include <core/State.hpp>
#include <lib/factory/ClassFactory.hpp>
#include <pkg/common/ElastMat.hpp>
#include <pkg/common/MatchMaker.hpp>
#include <pkg/common/NormShearPhys.hpp>
#include <pkg/dem/FrictPhys.hpp>
#include <pkg/dem/ScGeom.hpp>
