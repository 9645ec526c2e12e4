// Whether blockers keep a light from a position: what hdrp_cull_blocker_light_visible computes, from
// the arrays of an hdrp_gpu_vk_blockers. For shaders of any stage; also the hook of light_loop.glsl
// for hdrp_gpu_vk_lighting.blockers. Before the line that includes it, a shader has
//
//     #extension GL_GOOGLE_include_directive : require
//     #include "hdrp_cull_blocker.h"
//
// and may define HDRP_BLOCKER_SET and HDRP_BLOCKER_BINDING. Without them they are those of the light
// loop: the set is HDRP_LIGHTING_SET, the bindings HDRP_LIGHTING_BINDING + 12 to + 15.
//
//     HDRP_BLOCKER_BINDING      storage buffer  masks, a word for each entry of the lists
//     HDRP_BLOCKER_BINDING + 1  storage buffer  lights, an hdrp_cull_blocker_links for each
//     HDRP_BLOCKER_BINDING + 2  storage buffer  links
//     HDRP_BLOCKER_BINDING + 3  storage buffer  blockers and portals
//
// With HDRP_LIGHT_BLOCKERS defined after it, light_loop.glsl asks is_light_blocked for lights that
// have blockers; those that are in no list ask all of them.

#ifndef HDRP_BLOCKER_SET
#ifdef HDRP_LIGHTING_SET
#define HDRP_BLOCKER_SET HDRP_LIGHTING_SET
#else
#define HDRP_BLOCKER_SET 0
#endif
#endif
#ifndef HDRP_BLOCKER_BINDING
#ifdef HDRP_LIGHTING_BINDING
#define HDRP_BLOCKER_BINDING (HDRP_LIGHTING_BINDING + 12)
#else
#define HDRP_BLOCKER_BINDING 12
#endif
#endif
#define HDRP_I_BLOCKER(n) set = HDRP_BLOCKER_SET, binding = HDRP_BLOCKER_BINDING + n

layout(std430, HDRP_I_BLOCKER(0)) readonly buffer HdrpBlockerMasks { uint blocker_masks[]; };
layout(std430, HDRP_I_BLOCKER(1)) readonly buffer HdrpBlockerLights { uvec2 blocker_lights[]; };
layout(std430, HDRP_I_BLOCKER(2)) readonly buffer HdrpBlockerLinks { uint blocker_links[]; };
layout(std430, HDRP_I_BLOCKER(3)) readonly buffer HdrpBlockers { hdrp_cull_blocker blockers[]; };

// Whether a blocker keeps a light at a place from a position, and none of its portals lets it
// through: one text for both, for it is long.
bool hdrp_i_blocks(uint blocker, vec4 place, vec3 position)
{
    uint first = blockers[blocker].bits.y;
    uint portals = blockers[blocker].bits.z;
    for (uint i = 0u; i <= portals; ++i) {
        uint index = i == 0u ? blocker : first + i - 1u;
        bool crosses = hdrp_cull_blocker_blocks(blockers[index], place, position) > 0.0;
        if (crosses != (i == 0u)) {
            return false;
        }
    }
    return true;
}

// Whether one of the blockers of a light keeps it from a position in the world. mask has a bit for
// each that is asked; place is hdrp_cull_light_place.
bool is_light_blocked(uint light, uint mask, vec4 place, vec3 position)
{
    uvec2 own = blocker_lights[light];
    bool blocked = false;
    for (uint k = 0u; k < own.y && !blocked; ++k) {
        blocked = ((mask >> k) & 1u) != 0u &&
                  hdrp_i_blocks(blocker_links[own.x + k], place, position);
    }
    return blocked;
}
