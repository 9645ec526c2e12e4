/* peers_cpp.cpp - loops over what C++ libraries offer.
 * SPDX-License-Identifier: MIT */
#include "bench.h"

#include <glm/glm.hpp>
#include <glm/gtc/packing.hpp>
#include <meshoptimizer.h>

#include "rows_begin.h"

namespace
{

inline hdrp_v3 bench_v3_from_glm(glm::vec3 v)
{
    return hdrp_v3_make(v.x, v.y, v.z);
}

#include "peers_cpp.inc"

#define BENCH_TABLE
#include "rows_begin.h"

const bench_kernel kernels[] = {
#include "peers_cpp.inc"
};

} // namespace

extern "C" const bench_list BENCH_LIST = {kernels, sizeof kernels / sizeof kernels[0]};
