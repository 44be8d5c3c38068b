/* The noise of volumetric particles, for src/methods/volumetric.c and glsl/volumetric. */
#ifndef SF_SHARED_VOLUMETRIC_H
#define SF_SHARED_VOLUMETRIC_H

/* A cube that repeats, its layers one behind the other in an array of images. Two fields of mean 0, variance 1 and
 * mean product 0, each by SF_VOLUMETRIC_RANGE and from -1..1 to 0..1: R and B at the layer, G and A at the
 * next one, so that one filtered look-up gives both. */
#define SF_VOLUMETRIC_SIDE      64
#define SF_VOLUMETRIC_CELLS     4    /* of the first octave along a side */
#define SF_VOLUMETRIC_ROUGHNESS 0.6f /* amplitude of an octave to that of the one before; each is twice as fine */
#define SF_VOLUMETRIC_RANGE     3.0f

#endif
