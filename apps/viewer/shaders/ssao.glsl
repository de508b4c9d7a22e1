// The share of ambient light at this fragment that pass_ssao found open. Panes have no occlusion.
layout(binding = TEXTURE_SSAO) uniform sampler2D ssao_picture;
layout(location = UNIFORM_SSAO) uniform bool ssao;

float open_share()
{
    bool opaque = (peeled & PEEL_BEFORE) == 0;
    return ssao && opaque ? texelFetch(ssao_picture, ivec2(gl_FragCoord.xy), 0).r : 1.0;
}
