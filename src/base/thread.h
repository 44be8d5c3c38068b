/* pthreads with the two shapes we use: a bounded queue of jobs with workers, and a clock. */
#ifndef SF_BASE_THREAD_H
#define SF_BASE_THREAD_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include "sfumato/status.h"

/* Monotonic nanoseconds. */
uint64_t sf_clock_ns(void);
unsigned sf_cpu_count(void);

typedef enum sf_status (*sf_job_fn)(void *user);

/* A pool that runs jobs in any order on `threads` threads; at most `depth` wait (push blocks, which is the back
 * pressure). The first failing job's status is kept and given by push and by finish; later jobs still run, so that
 * their memory is freed. */
struct sf_pool;
enum sf_status sf_pool_create(unsigned threads, unsigned depth, struct sf_pool **pool);
enum sf_status sf_pool_push(struct sf_pool *pool, sf_job_fn fn, void *user);
/* Waits for every job pushed so far; the first failure, or SF_OK. */
enum sf_status sf_pool_wait(struct sf_pool *pool);
/* Waits, joins, frees, nulls. NULL and *pool == NULL are legal. */
enum sf_status sf_pool_destroy(struct sf_pool **pool);

#endif
