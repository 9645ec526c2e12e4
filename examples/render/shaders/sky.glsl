// What a ray sees that leaves the scene: rd_environment_seen.
layout(set = 2, binding = 12) uniform sampler2D sky_latlong;
layout(set = 2, binding = 13) uniform samplerCube sky_cube;

vec3 sky_seen(vec3 direction)
{
    vec3 nits = vec3(0.0);
    if (frame.sky.x == 1.0) {
        nits = textureLod(sky_latlong, hdrp_env_latlong_from_direction(direction), 0.0).xyz;
    } else if (frame.sky.x == 2.0) {
        nits = textureLod(sky_cube, direction, 0.0).xyz;
    }
    vec3 off = cross(direction, frame.to_sun.xyz);
    bool sun = dot(direction, frame.to_sun.xyz) > 0.0 && dot(off, off) < frame.sky.y;
    return sun ? nits + frame.sun_nits.xyz : nits;
}
