// SPDX-License-Identifier: GPL-2.0-or-later
#define EPDEM_KERNELS kernels_avx512
#include "kernels/kernel.hpp"
