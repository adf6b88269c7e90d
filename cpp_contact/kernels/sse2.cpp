// SPDX-License-Identifier: BSD-3-Clause
#define EPDEM_KERNELS kernels_sse2
#include "kernels/kernel.hpp"
