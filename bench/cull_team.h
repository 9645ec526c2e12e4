/* cull_team.h - two jobs on two cores that share the stages of a frame.
 * SPDX-License-Identifier: MIT
 *
 * The second job waits for the next stage without giving its core away, as the jobs of an engine do
 * within a frame. Parts of a stage go to whichever job asks first. */
#ifndef CULL_TEAM_H
#define CULL_TEAM_H

#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

typedef struct cull_team {
    int stage_count;
    void (*begin)(void* argument, int stage);        /* before each stage, on the first core */
    void (*run)(void* argument, int stage, int job); /* on both */
    void* argument;
    cpu_set_t allowed; /* of the process, before it was pinned */
    pthread_t thread;
    int stage;
    atomic_uint next;     /* part of the stage */
    atomic_uint released; /* stages that have begun */
    atomic_uint done;     /* stages that the second job has finished */
    atomic_bool is_over;
} cull_team;

/* Makes the caller stay on a core: the first of those allowed, or for job 1 the second. */
static inline void cull_team_pin(const cpu_set_t* allowed, int job)
{
    cpu_set_t one;
    int skip = job;
    CPU_ZERO(&one);
    for (size_t i = 0; i < CPU_SETSIZE; ++i) {
        if (CPU_ISSET(i, allowed) && skip-- == 0) {
            CPU_SET(i, &one);
            sched_setaffinity(0, sizeof one, &one);
            return;
        }
    }
}

static inline void cull_team_wait(const atomic_uint* counter, unsigned value)
{
    for (unsigned turns = 1u; atomic_load_explicit(counter, memory_order_acquire) != value;
         ++turns) {
        if (turns % 100000u == 0u) {
            sched_yield();
        }
    }
}

/* The next `step` parts of the stage: index of the first. */
static inline uint32_t cull_team_take(cull_team* team, uint32_t step)
{
    return atomic_fetch_add_explicit(&team->next, step, memory_order_relaxed);
}

static inline void* cull_team_second(void* argument)
{
    cull_team* team = argument;
    cull_team_pin(&team->allowed, 1);
    for (unsigned i = 1u;; ++i) {
        cull_team_wait(&team->released, i);
        if (atomic_load(&team->is_over)) {
            return NULL;
        }
        team->run(team->argument, team->stage, 1);
        atomic_store_explicit(&team->done, i, memory_order_release);
    }
}

/* All stages, on both cores. */
static inline void cull_team_frame(cull_team* team)
{
    for (int stage = 0; stage < team->stage_count; ++stage) {
        unsigned i = atomic_load(&team->released) + 1u;
        team->begin(team->argument, stage);
        team->stage = stage;
        atomic_store(&team->next, 0u);
        atomic_store_explicit(&team->released, i, memory_order_release);
        team->run(team->argument, stage, 0);
        cull_team_wait(&team->done, i);
    }
}

/* The members up to `allowed` are set; false where there is no second thread. */
static inline bool cull_team_start(cull_team* team)
{
    atomic_init(&team->next, 0u);
    atomic_init(&team->released, 0u);
    atomic_init(&team->done, 0u);
    atomic_init(&team->is_over, false);
    return pthread_create(&team->thread, NULL, cull_team_second, team) == 0;
}

static inline void cull_team_stop(cull_team* team)
{
    atomic_store(&team->is_over, true);
    atomic_fetch_add(&team->released, 1u);
    pthread_join(team->thread, NULL);
}

#endif
