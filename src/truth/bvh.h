/* A bounding volume hierarchy over boxes: binary, split at the median, the same for the same boxes. Walks give the
 * leaves that a ray crosses in an order that follows from the ray alone, so that sums over them have the same bits
 * on every thread. */
#ifndef SF_TRUTH_BVH_H
#define SF_TRUTH_BVH_H

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include "sfumato/status.h"

/* Rounded outward from what it holds, so that a ray that grazes the thing never misses the box. */
struct sf_bvh_box {
    float min[3], max[3];
};
struct sf_bvh_node { /* 32 bytes */
    struct sf_bvh_box box;
    uint32_t first; /* leaf: of its things in `order`; else its second child (the first one follows it) */
    uint8_t count;  /* of a leaf's things; 0: not a leaf */
    uint8_t axis;   /* that its children were split along */
};
struct sf_bvh {
    struct sf_bvh_node *nodes;
    uint32_t *order; /* the things' numbers as the leaves hold them */
    uint32_t node_count;
};

enum { SF_BVH_LEAF = 4, SF_BVH_DEPTH = 64 };

/* `boxes` may go afterwards. With no boxes there are no nodes. SF_ERROR_MEMORY: and then there is nothing to finish. */
enum sf_status sf_bvh_build(const struct sf_bvh_box *boxes, uint32_t count, struct sf_bvh *bvh);
void sf_bvh_finish(struct sf_bvh *bvh);
/* The box of a sphere, or of what lies between two corners, rounded outward. */
struct sf_bvh_box sf_bvh_box_of(const double min[3], const double max[3]);

/* The leaves that origin + t direction crosses for t in from..to. `to` may be lowered on the way. */
struct sf_bvh_walk {
    double origin[3], inverse[3], from, to;
    uint32_t stack[SF_BVH_DEPTH];
    uint32_t waiting;
};

static inline void sf_bvh_begin(struct sf_bvh_walk *walk, const struct sf_bvh *bvh, const double origin[3],
                                const double direction[3], double from, double to)
{
    for (int i = 0; i < 3; i++) {
        walk->origin[i] = origin[i];
        /* Never infinite: infinity times 0 has no value. */
        walk->inverse[i] = fabs(direction[i]) > 1e-300 ? 1 / direction[i] : 1e300;
    }
    walk->from = from;
    walk->to = to;
    walk->stack[0] = 0;
    walk->waiting = bvh->node_count > 0;
}

static inline bool sf_bvh_crosses(const struct sf_bvh_walk *walk, const struct sf_bvh_box *box)
{
    double from = walk->from, to = walk->to;

    for (int i = 0; i < 3; i++) {
        double a = (box->min[i] - walk->origin[i]) * walk->inverse[i];
        double b = (box->max[i] - walk->origin[i]) * walk->inverse[i];

        if (a > b) {
            double c = a;
            a = b;
            b = c;
        }
        from = a > from ? a : from;
        to = b < to ? b : to;
    }
    return from <= to;
}

/* The next leaf, or NULL when there is none left. */
static inline const struct sf_bvh_node *sf_bvh_next(struct sf_bvh_walk *walk, const struct sf_bvh *bvh)
{
    while (walk->waiting > 0) {
        uint32_t number = walk->stack[--walk->waiting];
        const struct sf_bvh_node *node = &bvh->nodes[number];

        if (!sf_bvh_crosses(walk, &node->box))
            continue;
        if (node->count > 0)
            return node;
        bool backward = walk->inverse[node->axis] < 0;
        walk->stack[walk->waiting++] = backward ? number + 1 : node->first;
        walk->stack[walk->waiting++] = backward ? node->first : number + 1;
    }
    return NULL;
}

#endif
