/* implementation.c - the algorithms that the tests of culling call, where they have none yet.
 * SPDX-License-Identifier: MIT */
#define HDRP_CULL_IMPLEMENTATION
#include "hdrp_cull.h"
