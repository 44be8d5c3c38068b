// The smoke of one pixel of the frame, premultiplied. How much it hides is known for this very pixel (whole.glsl); the colour of the light that it
// sends, for each unit of opacity, changes slowly and is taken up from the smoke's image. Include it after upsample.glsl where `smoke` and `whole` are
// declared.
#ifndef SF_THICK_FULL_GLSL
#define SF_THICK_FULL_GLSL

vec4 full_smoke()
{
    vec4 coarse = upsample(smoke, gl_FragCoord.xy);
    if (SCALE == 1u)
        return coarse;
    float opaque = 1.0 - exp(-texelFetch(whole, ivec2(gl_FragCoord.xy), 0).r);
    return vec4(coarse.a > 0.0 ? coarse.rgb * (opaque / coarse.a) : vec3(0.0), opaque);
}

#endif
