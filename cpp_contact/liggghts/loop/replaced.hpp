// SPDX-License-Identifier: GPL-2.0-or-later
// Functions of LIGGGHTS that are replaced: LIGGGHTS takes their addresses through the dynamic linker, which finds ours
// first; ours find LIGGGHTS's as the next of the same name. In a source tree, where all is one program, LIGGGHTS's
// remain.
#pragma once

#ifdef EPDEM_BUILT_FOR

#include <dlfcn.h>

namespace epdem::liggghts::loop {

template <class... Words>
using Function = void (*)(Words...);

template <class... Words>
Function<Words...> next(const char* name) {
  return reinterpret_cast<Function<Words...>>(dlsym(RTLD_NEXT, name));
}

}  // namespace epdem::liggghts::loop
#endif
