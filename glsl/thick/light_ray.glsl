// The rays of a light's map, in the light's view space. `at`: texels of the cell.
#ifndef SF_THICK_LIGHT_RAY_GLSL
#define SF_THICK_LIGHT_RAY_GLSL

// Not of unit length.
vec3 light_ray_way(sf_gpu_light_view view, vec2 at)
{
    vec2 uv = at / float(push.cell_size);
    vec3 around = octahedral_way(uv * 2.0 - 1.0);
    vec3 ahead = vec3(view.info.x > 0.5 && view.window.x != 0.0 ? (uv - view.window.zw) / view.window.xy : vec2(0.0), 1.0);
    return view.info.x > 1.5 ? around : ahead;
}

vec3 light_ray_start(sf_gpu_light_view view, vec2 at)
{
    vec2 uv = at / float(push.cell_size);
    return vec3(view.info.x < 0.5 ? (uv - view.window.zw) / view.window.xy : vec2(0.0), 0.0);
}

#endif
