// Threads of a group, and how they wait for each other. A group that is no larger than a subgroup
// runs in step: it needs no barriers, which a device without hardware for them takes long for.
//
// Mesa's lavapipe, to Mesa 22 at least, leaves the loops of a thread after 65535 turns of all of them
// together, so that loops here are kept short where they can be. It jumps only at the end of a loop:
// what is behind a condition that is not met costs its time, and a loop that asks at its beginning
// one more turn. So loops that do much ask at their end. Other devices do not mind.
#extension GL_KHR_shader_subgroup_basic : require

#define GROUP_MAX 64

layout(local_size_x = GROUP_MAX, local_size_x_id = 0) in;
layout(constant_id = 1) const bool ONE_SUBGROUP = false;

#define GROUP gl_WorkGroupSize.x

// What the threads of the group have written to shared memory is seen by all of them.
void wait_for_group()
{
    if (ONE_SUBGROUP) {
        subgroupBarrier();
    } else {
        barrier();
    }
}
