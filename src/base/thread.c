#include "base/thread.h"

#include <pthread.h>
#include <stdlib.h>
#include <time.h>
#include <unistd.h>

uint64_t sf_clock_ns(void)
{
    struct timespec now;

    clock_gettime(CLOCK_MONOTONIC, &now);
    return (uint64_t)now.tv_sec * 1000000000u + (uint64_t)now.tv_nsec;
}

unsigned sf_cpu_count(void)
{
    long count = sysconf(_SC_NPROCESSORS_ONLN);

    return count > 0 ? (unsigned)count : 1;
}

struct job {
    sf_job_fn fn;
    void *user;
};

struct sf_pool {
    pthread_mutex_t lock;
    pthread_cond_t work;  /* a job is waiting, or the end has come */
    pthread_cond_t space; /* the queue has room */
    pthread_cond_t idle;  /* nothing waits and nothing runs */
    pthread_t *threads;
    struct job *queue; /* a ring of `depth` jobs, the oldest at `first` */
    unsigned thread_count, depth, first, waiting, running;
    unsigned made; /* of lock, work, space, idle, in this order: what a half-built pool must give back */
    enum sf_status status;
    bool ending;
};

static void *worker(void *user)
{
    struct sf_pool *pool = user;

    pthread_mutex_lock(&pool->lock);
    for (;;) {
        struct job job;
        enum sf_status status;

        while (pool->waiting == 0 && !pool->ending)
            pthread_cond_wait(&pool->work, &pool->lock);
        if (pool->waiting == 0)
            break;
        job = pool->queue[pool->first];
        pool->first = (pool->first + 1) % pool->depth;
        pool->waiting--;
        pool->running++;
        pthread_cond_signal(&pool->space);
        pthread_mutex_unlock(&pool->lock);
        status = job.fn(job.user);
        pthread_mutex_lock(&pool->lock);
        pool->running--;
        if (pool->status == SF_OK)
            pool->status = status;
        if (pool->waiting == 0 && pool->running == 0)
            pthread_cond_broadcast(&pool->idle);
    }
    pthread_mutex_unlock(&pool->lock);
    return NULL;
}

enum sf_status sf_pool_create(unsigned threads, unsigned depth, struct sf_pool **out)
{
    struct sf_pool *pool;

    *out = NULL;
    if (threads == 0 || depth == 0)
        return SF_ERROR_USAGE;
    pool = calloc(1, sizeof *pool);
    if (!pool)
        return SF_ERROR_MEMORY;
    pool->depth = depth;
    pool->threads = calloc(threads, sizeof *pool->threads);
    pool->queue = calloc(depth, sizeof *pool->queue);
    if (!pool->threads || !pool->queue)
        goto fail;
    if (pthread_mutex_init(&pool->lock, NULL) != 0)
        goto fail;
    pool->made++;
    pthread_cond_t *conditions[] = {&pool->work, &pool->space, &pool->idle};
    for (unsigned i = 0; i < 3; i++, pool->made++)
        if (pthread_cond_init(conditions[i], NULL) != 0)
            goto fail;
    for (; pool->thread_count < threads; pool->thread_count++)
        if (pthread_create(&pool->threads[pool->thread_count], NULL, worker, pool) != 0)
            goto fail;
    *out = pool;
    return SF_OK;

fail:
    sf_pool_destroy(&pool);
    return SF_ERROR_MEMORY;
}

enum sf_status sf_pool_push(struct sf_pool *pool, sf_job_fn fn, void *user)
{
    enum sf_status status;

    pthread_mutex_lock(&pool->lock);
    while (pool->waiting == pool->depth)
        pthread_cond_wait(&pool->space, &pool->lock);
    pool->queue[(pool->first + pool->waiting) % pool->depth] = (struct job){.fn = fn, .user = user};
    pool->waiting++;
    status = pool->status;
    pthread_cond_signal(&pool->work);
    pthread_mutex_unlock(&pool->lock);
    return status;
}

enum sf_status sf_pool_wait(struct sf_pool *pool)
{
    enum sf_status status;

    pthread_mutex_lock(&pool->lock);
    while (pool->waiting > 0 || pool->running > 0)
        pthread_cond_wait(&pool->idle, &pool->lock);
    status = pool->status;
    pthread_mutex_unlock(&pool->lock);
    return status;
}

enum sf_status sf_pool_destroy(struct sf_pool **pool_place)
{
    struct sf_pool *pool = pool_place ? *pool_place : NULL;
    enum sf_status status;

    if (!pool)
        return SF_OK;
    if (pool->thread_count > 0) {
        pthread_mutex_lock(&pool->lock);
        pool->ending = true; /* the workers first empty the queue */
        pthread_cond_broadcast(&pool->work);
        pthread_mutex_unlock(&pool->lock);
        for (unsigned i = 0; i < pool->thread_count; i++)
            pthread_join(pool->threads[i], NULL);
    }
    status = pool->status;
    if (pool->made > 3)
        pthread_cond_destroy(&pool->idle);
    if (pool->made > 2)
        pthread_cond_destroy(&pool->space);
    if (pool->made > 1)
        pthread_cond_destroy(&pool->work);
    if (pool->made > 0)
        pthread_mutex_destroy(&pool->lock);
    free(pool->queue);
    free(pool->threads);
    free(pool);
    *pool_place = NULL;
    return status;
}
