/* half_module.cpp - one module of the accuracy registry, HALF_MODULE, in half precision, or in
 * float without HALF_PRECISION.
 * SPDX-License-Identifier: MIT */
#include "half.hpp"

#ifdef HALF_PRECISION
#include "half_as_float.hpp"
#endif
#include "accuracy.h"

#define HALF_PASTE(a, b) a##b
#define HALF_NAME(name)  HALF_PASTE(acc_, name)
extern const acc_entry HALF_NAME(HALF_MODULE)[]; /* C++ would keep a constant to this file */
#include HALF_SOURCE
