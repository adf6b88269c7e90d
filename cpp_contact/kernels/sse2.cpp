// SPDX-License-Identifier: GPL-2.0-or-later
#define EPDEM_KERNELS kernels_sse2
#include "kernels/kernel.hpp"
