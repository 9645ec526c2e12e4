#define _POSIX_C_SOURCE 200809L
#include "progress.h"

#include "stats.h"

#include <stdio.h>
#include <unistd.h>

#define BAR_WIDTH   40
#define INTERVAL_MS 50.0

void rd_progress_begin(rd_progress* p, bool forced)
{
    p->on = forced || isatty(STDERR_FILENO);
    p->drawn = false;
    p->last_ms = -INTERVAL_MS;
}

static void draw(const char* what, double share)
{
    static const char full[] = "########################################";
    int n = (int)(share * BAR_WIDTH);
    fprintf(stderr, "\r[%-*.*s] %3d%% %-24.24s", BAR_WIDTH, n, full, (int)(share * 100.0), what);
    fflush(stderr);
}

void rd_progress_show(rd_progress* p, const char* what, double done, double total)
{
    double now;
    if (!p->on) {
        return;
    }
#pragma omp critical(rd_progress)
    {
        now = rd_now_ms();
        if (now - p->last_ms >= INTERVAL_MS || done >= total) {
            p->last_ms = now;
            p->drawn = true;
            draw(what, total > 0 ? done / total : 1.0);
        }
    }
}

void rd_progress_end(rd_progress* p)
{
    if (p->on && p->drawn) {
        fprintf(stderr, "\r%*s\r", BAR_WIDTH + 34, "");
        fflush(stderr);
        p->drawn = false;
    }
}
