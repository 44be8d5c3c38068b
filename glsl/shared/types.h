/* Lets one header be read by C and by GLSL. Structs hold only vec4, mat4, uvec4 and 16-byte groups of scalars, so that
 * std140, std430 and C agree. */
#ifndef SF_SHARED_TYPES_H
#define SF_SHARED_TYPES_H
#ifdef __STDC_VERSION__
#include <stdint.h>
#define SF_VEC4(name)   float name[4]
#define SF_UVEC4(name)  uint32_t name[4]
#define SF_MAT4(name)   float name[16] /* column-major */
#define SF_FLOAT(name)  float name
#define SF_UINT(name)   uint32_t name
#define SF_STRUCT(name) struct name
#else
#define SF_VEC4(name)   vec4 name
#define SF_UVEC4(name)  uvec4 name
#define SF_MAT4(name)   mat4 name
#define SF_FLOAT(name)  float name
#define SF_UINT(name)   uint name
#define SF_STRUCT(name) name
#endif
#endif
