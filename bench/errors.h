/* errors.h - see errors.c.
 * SPDX-License-Identifier: MIT */
#ifndef HDRP_BENCH_ERRORS_H
#define HDRP_BENCH_ERRORS_H

void bench_print_errors(void);

#endif
