#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#include "studio.h"

#include <stdlib.h>
#include <string.h>

studio* open_studio(void)
{
    studio* s = (studio*)calloc(1, sizeof *s);
    assert_non_null(s);
    s->options.width = WIDTH;
    s->options.height = HEIGHT;
    s->options.spp = 1;
    s->options.quality = RD_QUALITY_BALANCED;
    s->options.features = RD_FEATURE_ALL;
    return s;
}

void close_studio(studio* s)
{
    rd_lighting_free(&s->lighting);
    rd_environment_free(&s->environment);
    rd_trace_free(s->trace);
    rd_scene_free(&s->scene);
    free(s);
}

void add(studio* s, rd_shape shape, rd_material m, hdrp_v3 where)
{
    rd_affine a = rd_affine_identity();
    a.t = where;
    assert_true(shape.ok);
    rd_material_update_features(&m);
    rd_mesh_transform(&shape.mesh, a);
    shape.mesh.material = rd_scene_add_material(&s->scene, &m);
    assert_true(rd_scene_add_mesh(&s->scene, &shape.mesh));
}

void add_light(studio* s, rd_light_type type, hdrp_v3 position, float intensity)
{
    rd_light l;
    memset(&l, 0, sizeof l);
    l.type = type;
    l.position = position;
    l.forward = hdrp_v3_normalize(hdrp_v3_neg(position));
    l.color = hdrp_v3_splat(1.0f);
    l.intensity = intensity;
    l.inner_angle_rad = 0.3f;
    l.outer_angle_rad = 0.5f;
    l.radius_m = type == RD_LIGHT_DIRECTIONAL ? 0.0f : 0.02f;
    assert_true(rd_scene_add_light(&s->scene, &l));
}

/* `sky` is taken over; NULL: the procedural one. */
void set_sky(studio* s, rd_image_f32* sky, float lux)
{
    rd_environment_desc d = {sky, "sky", lux, 0.6f, -0.6f, {0.2f, 0.2f, 0.2f}, s->options.quality};
    assert_true(rd_environment_make(&s->environment, &d, &s->stats, &s->report));
}

rd_image_f32 uniform_sky(float nits)
{
    rd_image_f32 sky = {64, 32, RD_LAYOUT_PLAIN, NULL};
    sky.rgba = (float*)malloc(64 * 32 * 4 * sizeof(float));
    assert_non_null(sky.rgba);
    for (int i = 0; i < 64 * 32 * 4; ++i) {
        sky.rgba[i] = nits;
    }
    return sky;
}

void set_up(studio* s)
{
    rd_lighting_desc d = {&s->scene, NULL, &s->environment, &s->options};
    rd_scene_update_bounds(&s->scene);
    s->trace = rd_trace_build(&s->scene, &s->report);
    assert_non_null(s->trace);
    d.trace = s->trace;
    assert_true(rd_lighting_make(&s->lighting, &d, &s->stats, &s->report));
    s->camera = rd_camera_look_at(hdrp_v3_make(0.0f, 0.0f, 5.0f), hdrp_v3_splat(0.0f), 0.46f,
                                  s->options.width, s->options.height);
}

/* The film, to be freed. */
float* shoot(studio* s, float exposure)
{
    rd_progress silent;
    rd_renderer r;
    rd_renderer_desc d = {&s->options, &s->lighting, exposure, NULL, &silent};
    float* film;
    memset(&silent, 0, sizeof silent);
    assert_true(rd_renderer_begin(&r, &d, &s->report));
    rd_render(&r, &s->camera);
    s->counts = r.counts;
    film = r.film;
    r.film = NULL;
    rd_renderer_end(&r);
    return film;
}

hdrp_v3 pixel(const float* film, int x, int y)
{
    const float* p = film + (y * WIDTH + x) * 4;
    return hdrp_v3_make(p[0], p[1], p[2]);
}

rd_material plain(float r, float g, float b, float metallic)
{
    rd_material m = rd_material_default();
    m.base_color = hdrp_v3_make(r, g, b);
    m.metallic = metallic;
    return m;
}
