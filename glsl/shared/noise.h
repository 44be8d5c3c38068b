/* Gradient noise in 2, 3 and 4 dimensions (Perlin, "Improving noise", SIGGRAPH 2002: quintic weights) and cellular
 * noise in 3 (Worley, "A cellular texture basis function", SIGGRAPH 1996), for C and GLSL: the same bits in both.
 *
 * Only integers, and sums, differences and products of floats, each rounded by itself: these are exact in Vulkan as they
 * are in C (`precise` and -ffp-contract=off keep products and sums apart). Directions are not chosen from a table but
 * cut from the bits of an integer hash of the lattice point, uniform in a cube, so that any number of points differ and
 * eight or sixteen can be done at once: there is not one branch.
 *
 * Coordinates lie within +-2^30. A period of n > 0 wraps the lattice along that axis; there the coordinate must lie in
 * 0..n, and 0 and n give the same value. 0: no period. */
#ifndef SF_SHARED_NOISE_H
#define SF_SHARED_NOISE_H
#include "types.h"

#ifdef __STDC_VERSION__
#include "base/hash.h"
#if defined(__GNUC__)
#define SF_NOISE_FN static inline __attribute__((always_inline)) /* else loops over many points are not vectorised */
#else
#define SF_NOISE_FN static inline
#endif
#define SF_NOISE_WORD     uint32_t
#define SF_NOISE_INT(x)   ((int)(x))
#define SF_NOISE_UINT(x)  ((uint32_t)(x))
#define SF_NOISE_FLOAT(x) ((float)(x))
#define SF_NOISE_PRECISE
#else
#include "lib/hash.glsl"
#define SF_NOISE_FN
#define SF_NOISE_WORD     uint
#define SF_NOISE_INT(x)   int(x)
#define SF_NOISE_UINT(x)  uint(x)
#define SF_NOISE_FLOAT(x) float(x)
#define SF_NOISE_PRECISE  precise
#endif

/* Root mean squares over the whole of space, in closed form: with the integrals over an axis of the cell
 * of both weights squared, A = 0.783550, and of both weights times distances squared, B = 0.0593851, and the variance 1/3
 * of a direction's component, they are sqrt(n B A^(n-1) / 3) in n dimensions. */
#define SF_NOISE2_RMS 0.176127f
#define SF_NOISE3_RMS 0.190944f
#define SF_NOISE4_RMS 0.195166f

/* Odd multipliers that spread lattice points over the words. */
#define SF_NOISE_X 0x9E3779B1u
#define SF_NOISE_Y 0x85EBCA77u
#define SF_NOISE_Z 0xC2B2AE3Du
#define SF_NOISE_W 0x27D4EB2Fu

SF_NOISE_FN int sf_noise_floor(float x)
{
    int whole = SF_NOISE_INT(x);

    return whole - SF_NOISE_INT(x < SF_NOISE_FLOAT(whole));
}

/* The lattice point `i` of a period: i is in 0..period + 1. */
SF_NOISE_FN int sf_noise_wrap(int i, int period)
{
    return i - period * SF_NOISE_INT(i >= period);
}

/* 0 to 1 with first and second derivative 0 at both ends. */
SF_NOISE_FN float sf_noise_fade(float t)
{
    SF_NOISE_PRECISE float weight = t * t * t * (t * (t * 6.0f - 15.0f) + 10.0f);

    return weight;
}

SF_NOISE_FN float sf_noise_mix(float a, float b, float share)
{
    SF_NOISE_PRECISE float mixed = a + share * (b - a);

    return mixed;
}

/* -1..1 of the lowest 16, 10 or 8 bits, exact; the mean over all is 0. */
SF_NOISE_FN float sf_noise_16(SF_NOISE_WORD bits)
{
    return SF_NOISE_FLOAT(SF_NOISE_INT(bits & 65535u) * 2 - 65535) * (1.0f / 65536.0f);
}

SF_NOISE_FN float sf_noise_10(SF_NOISE_WORD bits)
{
    return SF_NOISE_FLOAT(SF_NOISE_INT(bits & 1023u) * 2 - 1023) * (1.0f / 1024.0f);
}

SF_NOISE_FN float sf_noise_8(SF_NOISE_WORD bits)
{
    return SF_NOISE_FLOAT(SF_NOISE_INT(bits & 255u) * 2 - 255) * (1.0f / 256.0f);
}

/* What one lattice point, of that key, adds at a distance from it. */
SF_NOISE_FN float sf_noise_corner2(SF_NOISE_WORD key, float x, float y)
{
    SF_NOISE_WORD bits = sf_hash_u32(key);
    SF_NOISE_PRECISE float slope = sf_noise_16(bits) * x + sf_noise_16(bits >> 16u) * y;

    return slope;
}

SF_NOISE_FN float sf_noise_corner3(SF_NOISE_WORD key, float x, float y, float z)
{
    SF_NOISE_WORD bits = sf_hash_u32(key);
    SF_NOISE_PRECISE float slope = sf_noise_10(bits) * x + sf_noise_10(bits >> 10u) * y + sf_noise_10(bits >> 20u) * z;

    return slope;
}

SF_NOISE_FN float sf_noise_corner4(SF_NOISE_WORD key, float x, float y, float z, float w)
{
    SF_NOISE_WORD bits = sf_hash_u32(key);
    SF_NOISE_PRECISE float slope =
        sf_noise_8(bits) * x + sf_noise_8(bits >> 8u) * y + sf_noise_8(bits >> 16u) * z + sf_noise_8(bits >> 24u) * w;

    return slope;
}

SF_NOISE_FN float sf_noise2(float x, float y, int period_x, int period_y, SF_NOISE_WORD seed)
{
    int ix = sf_noise_floor(x), iy = sf_noise_floor(y);
    SF_NOISE_PRECISE float fx = x - SF_NOISE_FLOAT(ix);
    SF_NOISE_PRECISE float fy = y - SF_NOISE_FLOAT(iy);
    float u = sf_noise_fade(fx), v = sf_noise_fade(fy);
    SF_NOISE_WORD x0 = SF_NOISE_UINT(sf_noise_wrap(ix, period_x)) * SF_NOISE_X + seed;
    SF_NOISE_WORD x1 = SF_NOISE_UINT(sf_noise_wrap(ix + 1, period_x)) * SF_NOISE_X + seed;
    SF_NOISE_WORD y0 = SF_NOISE_UINT(sf_noise_wrap(iy, period_y)) * SF_NOISE_Y;
    SF_NOISE_WORD y1 = SF_NOISE_UINT(sf_noise_wrap(iy + 1, period_y)) * SF_NOISE_Y;

    return sf_noise_mix(
        sf_noise_mix(sf_noise_corner2(x0 + y0, fx, fy), sf_noise_corner2(x1 + y0, fx - 1.0f, fy), u),
        sf_noise_mix(sf_noise_corner2(x0 + y1, fx, fy - 1.0f), sf_noise_corner2(x1 + y1, fx - 1.0f, fy - 1.0f), u), v);
}

SF_NOISE_FN float sf_noise3(float x, float y, float z, int period_x, int period_y, int period_z, SF_NOISE_WORD seed)
{
    int ix = sf_noise_floor(x), iy = sf_noise_floor(y), iz = sf_noise_floor(z);
    SF_NOISE_PRECISE float fx = x - SF_NOISE_FLOAT(ix);
    SF_NOISE_PRECISE float fy = y - SF_NOISE_FLOAT(iy);
    SF_NOISE_PRECISE float fz = z - SF_NOISE_FLOAT(iz);
    SF_NOISE_PRECISE float gx = fx - 1.0f;
    SF_NOISE_PRECISE float gy = fy - 1.0f;
    SF_NOISE_PRECISE float gz = fz - 1.0f;
    float u = sf_noise_fade(fx), v = sf_noise_fade(fy), w = sf_noise_fade(fz);
    SF_NOISE_WORD x0 = SF_NOISE_UINT(sf_noise_wrap(ix, period_x)) * SF_NOISE_X + seed;
    SF_NOISE_WORD x1 = SF_NOISE_UINT(sf_noise_wrap(ix + 1, period_x)) * SF_NOISE_X + seed;
    SF_NOISE_WORD y0 = SF_NOISE_UINT(sf_noise_wrap(iy, period_y)) * SF_NOISE_Y;
    SF_NOISE_WORD y1 = SF_NOISE_UINT(sf_noise_wrap(iy + 1, period_y)) * SF_NOISE_Y;
    SF_NOISE_WORD z0 = SF_NOISE_UINT(sf_noise_wrap(iz, period_z)) * SF_NOISE_Z;
    SF_NOISE_WORD z1 = SF_NOISE_UINT(sf_noise_wrap(iz + 1, period_z)) * SF_NOISE_Z;
    float a = sf_noise_mix(sf_noise_corner3(x0 + y0 + z0, fx, fy, fz), sf_noise_corner3(x1 + y0 + z0, gx, fy, fz), u);
    float b = sf_noise_mix(sf_noise_corner3(x0 + y1 + z0, fx, gy, fz), sf_noise_corner3(x1 + y1 + z0, gx, gy, fz), u);
    float c = sf_noise_mix(sf_noise_corner3(x0 + y0 + z1, fx, fy, gz), sf_noise_corner3(x1 + y0 + z1, gx, fy, gz), u);
    float d = sf_noise_mix(sf_noise_corner3(x0 + y1 + z1, fx, gy, gz), sf_noise_corner3(x1 + y1 + z1, gx, gy, gz), u);

    return sf_noise_mix(sf_noise_mix(a, b, v), sf_noise_mix(c, d, v), w);
}

/* Of the eight points of a cell on one side of the fourth axis: x0 to z1 are their parts of the keys. */
SF_NOISE_FN float sf_noise_side4(SF_NOISE_WORD x0, SF_NOISE_WORD x1, SF_NOISE_WORD y0, SF_NOISE_WORD y1,
                                 SF_NOISE_WORD z0, SF_NOISE_WORD z1, float fx, float fy, float fz, float fw)
{
    SF_NOISE_PRECISE float gx = fx - 1.0f;
    SF_NOISE_PRECISE float gy = fy - 1.0f;
    SF_NOISE_PRECISE float gz = fz - 1.0f;
    float u = sf_noise_fade(fx), v = sf_noise_fade(fy);
    float a =
        sf_noise_mix(sf_noise_corner4(x0 + y0 + z0, fx, fy, fz, fw), sf_noise_corner4(x1 + y0 + z0, gx, fy, fz, fw), u);
    float b =
        sf_noise_mix(sf_noise_corner4(x0 + y1 + z0, fx, gy, fz, fw), sf_noise_corner4(x1 + y1 + z0, gx, gy, fz, fw), u);
    float c =
        sf_noise_mix(sf_noise_corner4(x0 + y0 + z1, fx, fy, gz, fw), sf_noise_corner4(x1 + y0 + z1, gx, fy, gz, fw), u);
    float d =
        sf_noise_mix(sf_noise_corner4(x0 + y1 + z1, fx, gy, gz, fw), sf_noise_corner4(x1 + y1 + z1, gx, gy, gz, fw), u);

    return sf_noise_mix(sf_noise_mix(a, b, v), sf_noise_mix(c, d, v), sf_noise_fade(fz));
}

SF_NOISE_FN float sf_noise4(float x, float y, float z, float w, int period_x, int period_y, int period_z, int period_w,
                            SF_NOISE_WORD seed)
{
    int ix = sf_noise_floor(x), iy = sf_noise_floor(y), iz = sf_noise_floor(z), iw = sf_noise_floor(w);
    SF_NOISE_PRECISE float fx = x - SF_NOISE_FLOAT(ix);
    SF_NOISE_PRECISE float fy = y - SF_NOISE_FLOAT(iy);
    SF_NOISE_PRECISE float fz = z - SF_NOISE_FLOAT(iz);
    SF_NOISE_PRECISE float fw = w - SF_NOISE_FLOAT(iw);
    SF_NOISE_WORD x0 = SF_NOISE_UINT(sf_noise_wrap(ix, period_x)) * SF_NOISE_X;
    SF_NOISE_WORD x1 = SF_NOISE_UINT(sf_noise_wrap(ix + 1, period_x)) * SF_NOISE_X;
    SF_NOISE_WORD y0 = SF_NOISE_UINT(sf_noise_wrap(iy, period_y)) * SF_NOISE_Y;
    SF_NOISE_WORD y1 = SF_NOISE_UINT(sf_noise_wrap(iy + 1, period_y)) * SF_NOISE_Y;
    SF_NOISE_WORD z0 = SF_NOISE_UINT(sf_noise_wrap(iz, period_z)) * SF_NOISE_Z;
    SF_NOISE_WORD z1 = SF_NOISE_UINT(sf_noise_wrap(iz + 1, period_z)) * SF_NOISE_Z;
    SF_NOISE_WORD w0 = SF_NOISE_UINT(sf_noise_wrap(iw, period_w)) * SF_NOISE_W + seed;
    SF_NOISE_WORD w1 = SF_NOISE_UINT(sf_noise_wrap(iw + 1, period_w)) * SF_NOISE_W + seed;

    return sf_noise_mix(sf_noise_side4(x0 + w0, x1 + w0, y0, y1, z0, z1, fx, fy, fz, fw),
                        sf_noise_side4(x0 + w1, x1 + w1, y0, y1, z0, z1, fx, fy, fz, fw - 1.0f), sf_noise_fade(fw));
}

/* A point wanders in each cell on an ellipse about its middle, up to half the cell's width away: `cosine` and `sine` are
 * those of its angle; 1 and 0 are the beginning, where it is at most 0.354 away along each axis. The squared distances
 * to the nearest and the second nearest point. Only the 27 cells around are looked at: the nearest point is farther
 * than those at less than one place in 10^8. */
struct sf_noise_cells {
    SF_FLOAT(first);
    SF_FLOAT(second);
};

/* With the point of one cell: x, y and z lead to the corner of the box in which the point wanders. */
SF_NOISE_FN SF_STRUCT(sf_noise_cells)
    sf_noise_cell3(SF_STRUCT(sf_noise_cells) cells, SF_NOISE_WORD key, float x, float y, float z, float c, float s)
{
    SF_NOISE_WORD bits = sf_hash_u32(key);
    float i = SF_NOISE_FLOAT(SF_NOISE_INT(bits & 1023u));
    float j = SF_NOISE_FLOAT(SF_NOISE_INT(bits >> 10u & 1023u));
    float k = SF_NOISE_FLOAT(SF_NOISE_INT(bits >> 22u));
    SF_NOISE_PRECISE float px = x + (i * c + j * s);
    SF_NOISE_PRECISE float py = y + (j * c + k * s);
    SF_NOISE_PRECISE float pz = z + (k * c + i * s);
    SF_NOISE_PRECISE float square = px * px + py * py + pz * pz;
    float later = square < cells.first ? cells.first : square;

    cells.first = square < cells.first ? square : cells.first;
    cells.second = later < cells.second ? later : cells.second;
    return cells;
}

/* The part of a row of cells' key: -1, 0 or 1 cell away from `i`. */
SF_NOISE_FN SF_NOISE_WORD sf_noise_near(int i, int away, int period, SF_NOISE_WORD spread)
{
    int cell = i + away;

    return SF_NOISE_UINT(sf_noise_wrap(cell + period * SF_NOISE_INT(cell < 0), period)) * spread;
}

SF_NOISE_FN SF_STRUCT(sf_noise_cells) sf_noise_cells3(float x, float y, float z, int period_x, int period_y,
                                                      int period_z, float cosine, float sine, SF_NOISE_WORD seed)
{
    int cx = sf_noise_floor(x), cy = sf_noise_floor(y), cz = sf_noise_floor(z);
    int ix = sf_noise_wrap(cx, period_x), iy = sf_noise_wrap(cy, period_y), iz = sf_noise_wrap(cz, period_z);
    SF_NOISE_PRECISE float c = cosine * (0.35355338f / 512.0f);
    SF_NOISE_PRECISE float s = sine * (0.35355338f / 512.0f);
    SF_NOISE_PRECISE float corner = 0.5f - 511.5f * (c + s);
    SF_NOISE_PRECISE float fx = corner - (x - SF_NOISE_FLOAT(cx));
    SF_NOISE_PRECISE float fy = corner - (y - SF_NOISE_FLOAT(cy));
    SF_NOISE_PRECISE float fz = corner - (z - SF_NOISE_FLOAT(cz));
    SF_NOISE_PRECISE float before = fx - 1.0f;
    SF_NOISE_PRECISE float after = fx + 1.0f;
    SF_NOISE_WORD x0 = sf_noise_near(ix, -1, period_x, SF_NOISE_X) + seed;
    SF_NOISE_WORD x1 = sf_noise_near(ix, 0, period_x, SF_NOISE_X) + seed;
    SF_NOISE_WORD x2 = sf_noise_near(ix, 1, period_x, SF_NOISE_X) + seed;
    SF_STRUCT(sf_noise_cells) cells;

    cells.first = 16.0f;
    cells.second = 16.0f;
    for (int number = 0; number < 9; number++) {
        int dy = number % 3 - 1, dz = number / 3 - 1;
        SF_NOISE_WORD key = sf_noise_near(iy, dy, period_y, SF_NOISE_Y) + sf_noise_near(iz, dz, period_z, SF_NOISE_Z);
        SF_NOISE_PRECISE float py = fy + SF_NOISE_FLOAT(dy);
        SF_NOISE_PRECISE float pz = fz + SF_NOISE_FLOAT(dz);

        cells = sf_noise_cell3(cells, x0 + key, before, py, pz, c, s);
        cells = sf_noise_cell3(cells, x1 + key, fx, py, pz, c, s);
        cells = sf_noise_cell3(cells, x2 + key, after, py, pz, c, s);
    }
    return cells;
}

#endif
