#include "truth/bvh.h"

#include <stdlib.h>
#include <string.h>

struct builder {
    const struct sf_bvh_box *boxes;
    struct sf_bvh *bvh;
};

struct sf_bvh_box sf_bvh_box_of(const double min[3], const double max[3])
{
    struct sf_bvh_box box;

    for (int i = 0; i < 3; i++) {
        /* One step for the rounding to float, one for the walk's own rounding. */
        box.min[i] = nextafterf(nextafterf((float)min[i], -INFINITY), -INFINITY);
        box.max[i] = nextafterf(nextafterf((float)max[i], INFINITY), INFINITY);
    }
    return box;
}

static double middle(const struct builder *builder, uint32_t thing, int axis)
{
    return (double)builder->boxes[thing].min[axis] + builder->boxes[thing].max[axis];
}

static bool before(const struct builder *builder, uint32_t a, uint32_t b, int axis)
{
    double x = middle(builder, a, axis), y = middle(builder, b, axis);

    return x < y || (x == y && a < b);
}

static void swap(uint32_t *a, uint32_t *b)
{
    uint32_t c = *a;

    *a = *b;
    *b = c;
}

/* Puts the things of from..to in such an order that those before `at` are not behind those after it (Hoare's
 * selection; the pivot is the median of three). */
static void part(const struct builder *builder, uint32_t *order, uint32_t from, uint32_t to, uint32_t at, int axis)
{
    while (to - from > 2) {
        uint32_t half = from + (to - from) / 2, last = to - 1, low = from, high = last;

        if (before(builder, order[half], order[from], axis))
            swap(&order[half], &order[from]);
        if (before(builder, order[last], order[half], axis))
            swap(&order[last], &order[half]);
        if (before(builder, order[half], order[from], axis))
            swap(&order[half], &order[from]);
        uint32_t pivot = order[half];
        while (low <= high) {
            while (before(builder, order[low], pivot, axis))
                low++;
            while (before(builder, pivot, order[high], axis))
                high--;
            if (low <= high) {
                swap(&order[low++], &order[high]);
                if (high == 0)
                    break;
                high--;
            }
        }
        if (at <= high)
            to = high + 1;
        else if (at >= low)
            from = low;
        else
            return;
    }
    if (to - from == 2 && before(builder, order[from + 1], order[from], axis))
        swap(&order[from], &order[from + 1]);
}

/* Medians halve the number: recursion is at most 31 deep. */
static void split(struct builder *builder, uint32_t from, uint32_t to)
{
    struct sf_bvh *bvh = builder->bvh;
    uint32_t number = bvh->node_count++;
    struct sf_bvh_node node = {.first = from};
    double least[3], most[3];

    node.box = builder->boxes[bvh->order[from]];
    for (int i = 0; i < 3; i++)
        least[i] = most[i] = middle(builder, bvh->order[from], i);
    for (uint32_t k = from + 1; k < to; k++) {
        const struct sf_bvh_box *box = &builder->boxes[bvh->order[k]];

        for (int i = 0; i < 3; i++) {
            double at = middle(builder, bvh->order[k], i);

            node.box.min[i] = fminf(node.box.min[i], box->min[i]);
            node.box.max[i] = fmaxf(node.box.max[i], box->max[i]);
            least[i] = fmin(least[i], at);
            most[i] = fmax(most[i], at);
        }
    }
    for (int i = 1; i < 3; i++) {
        if (most[i] - least[i] > most[node.axis] - least[node.axis])
            node.axis = (uint8_t)i;
    }
    if (to - from <= SF_BVH_LEAF) {
        node.count = (uint8_t)(to - from);
        bvh->nodes[number] = node;
        return;
    }
    uint32_t half = from + (to - from) / 2;
    part(builder, bvh->order, from, to, half, node.axis);
    split(builder, from, half);
    node.first = bvh->node_count;
    bvh->nodes[number] = node;
    split(builder, half, to);
}

enum sf_status sf_bvh_build(const struct sf_bvh_box *boxes, uint32_t count, struct sf_bvh *bvh)
{
    struct builder builder = {.boxes = boxes, .bvh = bvh};

    memset(bvh, 0, sizeof *bvh);
    if (count == 0)
        return SF_OK;
    /* Leaves hold at least 2 of more than 4: at most count / 2 leaves, and one inner node less. */
    bvh->nodes = malloc(((size_t)count + 1) * sizeof *bvh->nodes);
    bvh->order = malloc(count * sizeof *bvh->order);
    if (!bvh->nodes || !bvh->order) {
        sf_bvh_finish(bvh);
        return SF_ERROR_MEMORY;
    }
    for (uint32_t i = 0; i < count; i++)
        bvh->order[i] = i;
    split(&builder, 0, count);
    return SF_OK;
}

void sf_bvh_finish(struct sf_bvh *bvh)
{
    free(bvh->nodes);
    free(bvh->order);
    memset(bvh, 0, sizeof *bvh);
}
