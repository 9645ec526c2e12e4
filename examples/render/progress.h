/* A progress bar on stderr, drawn at most every 50 ms. */
#ifndef RD_PROGRESS_H
#define RD_PROGRESS_H

#include <stdbool.h>

typedef struct rd_progress {
    bool on;
    bool drawn;
    double last_ms;
} rd_progress;

/* On where stderr is a terminal, or forced. */
void rd_progress_begin(rd_progress* p, bool forced);
/* May be called from any thread. */
void rd_progress_show(rd_progress* p, const char* what, double done, double total);
/* Removes the bar, so that other output starts on a clean line. */
void rd_progress_end(rd_progress* p);

#endif
