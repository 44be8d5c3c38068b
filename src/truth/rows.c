/* Rows of a picture on many threads. */
#include <stdlib.h>
#include "base/thread.h"
#include "truth/inner.h"

struct rows {
    sf_truth_row_fn fn;
    void *user;
    atomic_uint done;
    atomic_bool stopped;
};

struct row {
    struct rows *rows;
    uint32_t y;
};

static enum sf_status do_row(void *user)
{
    const struct row *row = user;
    enum sf_status status = row->rows->fn(row->rows->user, row->y, &row->rows->stopped);

    atomic_fetch_add(&row->rows->done, 1);
    return status;
}

/* The pool's queue is short, so that progress is told as it is made. */
enum sf_status sf_truth_rows(uint32_t height, const struct sf_truth_work *work, sf_truth_row_fn fn, void *user)
{
    struct rows rows = {.fn = fn, .user = user};
    struct row *list = calloc(height, sizeof *list);
    unsigned threads = work->threads > 0 ? work->threads : sf_cpu_count();
    struct sf_pool *pool = NULL;
    enum sf_status status = list ? sf_pool_create(threads, threads, &pool) : SF_ERROR_MEMORY, ended;
    bool going = true;

    for (uint32_t y = 0; y < height && status == SF_OK && going; y++) {
        list[y] = (struct row){&rows, y};
        status = sf_pool_push(pool, do_row, &list[y]);
        going = !work->progress || work->progress(work->user, atomic_load(&rows.done), height);
    }
    if (!going || status != SF_OK)
        atomic_store(&rows.stopped, true);
    ended = sf_pool_destroy(&pool);
    free(list);
    if (status == SF_OK)
        status = ended;
    if (status == SF_OK && going && work->progress)
        going = work->progress(work->user, height, height);
    return status != SF_OK ? status : going ? SF_OK : SF_ERROR_INTERRUPTED;
}
