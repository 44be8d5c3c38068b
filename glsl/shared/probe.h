/* The buffer in which a method's samples along the probed pixel's ray come back (glsl/lib/probe.glsl): their number in a
 * word, then the points as struct sf_probe_point of sfumato.h. */
#ifndef SF_SHARED_PROBE_H
#define SF_SHARED_PROBE_H
#define SF_PROBE_POINT_WORDS   5
#define SF_PROBE_BYTES(points) (4 + 4 * SF_PROBE_POINT_WORDS * (points))
#endif
