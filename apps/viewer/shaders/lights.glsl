// Light straight from lamps and suns, with shadow maps. Units and formulas are those of
// KHR_lights_punctual, as src/scene/lights/lighting_punctual.c has them. A sun is a point here: its
// shadows are sharp.
#include "pixel.glsl"

struct light {
    vec4 position;  // metres; w: 1 / range, 0 without a range
    vec4 direction; // unit, along which the light travels; w: cosine of the outer cone
    vec4 color;     // candela or lux; w: 1 / max(.001, cos inner - cos outer)
    uint kind;      // LIGHT_...
    uint first;     // of its shadow views
    uint views;     // 1; 6 = around it, towards +x, -x, +y, -y, +z and -z
    uint unused;
};

struct shadow_view {
    vec4 origin;  // metres; w: layer of the map
    vec4 forward; // unit; w: near plane, of a sun 1 / far plane
    vec4 right;   // x = dot(point, right), of lamps over the distance; w: width of a texel in
    vec4 up;      // metres, of lamps at distance 1
};

layout(std430, binding = BUFFER_LIGHTS) readonly buffer light_list { light lights[]; };
layout(std430, binding = BUFFER_SHADOW_VIEWS) readonly buffer shadow_view_list {
    shadow_view shadow_views[];
};
layout(binding = TEXTURE_SUN_SHADOWS) uniform sampler2DArrayShadow sun_shadows;
layout(binding = TEXTURE_LAMP_SHADOWS) uniform sampler2DArrayShadow lamp_shadows;

layout(location = UNIFORM_LIGHTS) uniform uint light_count;

/// E on a surface that faces the light. @param toward out: unit, from the point to the light
vec3 light_at(light l, vec3 position, out vec3 toward)
{
    toward = -l.direction.xyz;
    if (l.kind == LIGHT_SUN) {
        return l.color.rgb;
    }
    vec3 way = l.position.xyz - position;
    float distance = length(way), share = distance * l.position.w;
    toward = way / distance;
    float window = clamp(1.0 - share * share * share * share, 0.0, 1.0);
    float ramp = clamp((-dot(toward, l.direction.xyz) - l.direction.w) * l.color.w, 0.0, 1.0);
    float strength = l.kind == LIGHT_SPOT ? window * ramp * ramp : window;
    return distance > 0.0 ? l.color.rgb * (strength / (distance * distance)) : vec3(0.0);
}

/// The view of a light that sees a point. @param from the light to the point
uint shadow_view_of(light l, vec3 from)
{
    vec3 size = abs(from);
    uint axis = size.x >= max(size.y, size.z) ? 0u : size.y >= size.z ? 1u : 2u;
    return l.first + (l.views == 1u ? 0u : 2u * axis + (from[axis] < 0.0 ? 1u : 0u));
}

/// Share of four texels around a point that the light reaches, weighted bilinearly.
///
/// The point is moved along the normal n, so that a plane does not shade itself. The centres of the
/// four texels lie within sqrt(2) texels of width w. Over them the depth of the plane changes by
/// sqrt(2) w tan a at most, with the angle a between n and the axis of the view. Moved by d, the
/// point lies d / cos a before the plane: d = sqrt(2) w sin a is enough. Shares of w and of the
/// distance are added for rounding.
float find_visibility(light l, place p)
{
    bool sun = l.kind == LIGHT_SUN;
    shadow_view v = shadow_views[shadow_view_of(l, p.position - l.position.xyz)];
    vec3 from = p.position - v.origin.xyz;
    float distance = dot(from, v.forward.xyz), width = v.right.w * (sun ? 1.0 : distance);
    float sine = length(cross(p.geometric, v.forward.xyz));
    from += (width * (1.41421356 * sine + 0.05) + 1e-6 * distance) * p.geometric;
    distance = dot(from, v.forward.xyz);
    vec2 at = vec2(dot(from, v.right.xyz), -dot(from, v.up.xyz)) / (sun ? 1.0 : distance);
    vec3 texel = vec3(0.5 + 0.5 * at, v.origin.w);
    return sun ? texture(sun_shadows, vec4(texel, 1.0 - distance * v.forward.w))
               : texture(lamp_shadows, vec4(texel, v.forward.w / distance));
}

/// E of all lights.
vec3 direct_irradiance(place p)
{
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < light_count; i++) {
        light l = lights[i];
        vec3 toward, arriving = light_at(l, p.position, toward);
        float cosine = dot(p.normal, toward);
        bool faces = cosine > 0.0 && dot(p.geometric, toward) > 0.0;
        if (faces && arriving.r + arriving.g + arriving.b > 0.0) {
            sum += cosine * find_visibility(l, p) * arriving;
        }
    }
    return sum;
}
