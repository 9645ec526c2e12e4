#include "scene.h"
bool rd_scene_build_builtin(rd_scene* scene, rd_report* report)
{
    (void)report;
    rd_scene_update_bounds(scene);
    return true;
}
