/* The display behind transparent things of every kind: smoke in many soft layers, tinted panes,
 * sparks and glows that only add light, holograms that cover and shine. Smoke and glows are soft
 * enough for half the resolution. */
#include "builtin_builder.h"
#include "builtin_texture.h"

#define PUFFS  14 /* in a column */
#define SPARKS 72

/* In [low,high], a different one for each index and key. */
static float spread(uint32_t index, uint32_t key, float low, float high)
{
    return hdrp_lerp(low, high, hdrp_unit_from_u32(hdrp_hash2(index, key)));
}

static rd_material blended(hdrp_v3 color, float perceptual_roughness, float alpha)
{
    rd_material m = rd_dielectric(color, perceptual_roughness);
    m.alpha_mode = RD_ALPHA_BLEND;
    m.double_sided = true;
    m.alpha = alpha;
    return m;
}

static rd_material glow(hdrp_v3 nits, rd_builtin_texture texture)
{
    rd_material m = blended(hdrp_v3_splat(0.0f), 1.0f, 1.0f);
    m.additive = true;
    m.emission_nits = nits;
    m.slot[RD_SLOT_BASE_COLOR] = rd_texture_slot_make((int)texture);
    return m;
}

/* An upright square around a point, turned about the axis of view and a little about its own. */
static void add_square(rd_builder* b, int material, hdrp_v3 center, float size, float roll,
                       float turn, const char* name)
{
    rd_affine lifted = rd_translation(0.0f, -0.5f * size, 0.0f);
    rd_affine where = rd_affine_mul(
        rd_translation(center.x, center.y, center.z),
        rd_affine_mul(rd_rotation_y(turn), rd_affine_mul(rd_rotation_z(roll), lifted)));
    rd_build_mesh(b, rd_shape_card(size, size, 0.0f, rd_uv_scale(1.0f, -1.0f)), material, where,
                  name);
}

/* >>smoke: columns that widen and thin out as they rise */

static void add_column(rd_builder* b, const int* smoke, uint32_t column, hdrp_v3 foot)
{
    for (uint32_t i = 0; i < PUFFS; ++i) {
        uint32_t id = column * PUFFS + i;
        float rise = ((float)i + spread(id, 1u, 0.0f, 0.8f)) / (float)PUFFS;
        float size = 0.35f + 0.85f * rise;
        hdrp_v3 center =
            hdrp_v3_make(foot.x + 0.45f * rise + spread(id, 2u, -0.12f, 0.12f),
                         foot.y + 0.2f + 1.7f * rise, foot.z + spread(id, 3u, -0.35f, 0.35f));
        add_square(b, smoke[rise > 0.5f], center, size, spread(id, 4u, 0.0f, HDRP_TWO_PI),
                   spread(id, 5u, -0.3f, 0.3f), "smoke");
    }
}

static void add_smoke(rd_builder* b)
{
    rd_material dense = blended(hdrp_v3_make(0.42f, 0.41f, 0.40f), 1.0f, 0.55f);
    rd_material thin = blended(hdrp_v3_make(0.62f, 0.61f, 0.60f), 1.0f, 0.3f);
    int smoke[2];
    dense.slot[RD_SLOT_BASE_COLOR] = thin.slot[RD_SLOT_BASE_COLOR] =
        rd_texture_slot_make(RD_TEX_SMOKE);
    dense.half_resolution = thin.half_resolution = true;
    smoke[0] = rd_build_material(b, &dense, "dense smoke");
    smoke[1] = rd_build_material(b, &thin, "thin smoke");
    add_column(b, smoke, 0u, hdrp_v3_make(0.0f, 0.55f, 0.32f));
    add_column(b, smoke, 1u, hdrp_v3_make(-1.75f, 0.0f, 1.45f));
    add_column(b, smoke, 2u, hdrp_v3_make(1.25f, 0.0f, 2.0f));
}

/* >>panes, some of them behind each other */

static void add_panes(rd_builder* b)
{
    static const hdrp_v3 tints[4] = {
        {0.75f, 0.25f, 0.12f}, {0.15f, 0.55f, 0.35f}, {0.20f, 0.30f, 0.75f}, {0.80f, 0.65f, 0.20f}};
    static const float alphas[4] = {0.3f, 0.5f, 0.4f, 0.85f};
    for (int i = 0; i < 4; ++i) {
        rd_material m = blended(tints[i], 0.05f, alphas[i]);
        rd_affine where =
            rd_affine_mul(rd_translation(-0.75f + 0.34f * (float)i, 0.0f, 1.55f + 0.3f * (float)i),
                          rd_rotation_y(0.5f - 0.25f * (float)i));
        rd_build_mesh(
            b, rd_shape_card(0.62f, 0.95f - 0.08f * (float)i, 0.0f, rd_uv_scale(1.0f, -1.0f)),
            rd_build_material(b, &m, "tinted pane"), where, "pane");
    }
}

/* >>what only adds light */

static void add_sparks(rd_builder* b)
{
    rd_material hot = glow(hdrp_v3_make(600e3f, 260e3f, 60e3f), RD_TEX_GLOW);
    rd_material halo = glow(hdrp_v3_make(9e3f, 4e3f, 1e3f), RD_TEX_GLOW);
    int spark = rd_build_material(b, &hot, "spark");
    halo.half_resolution = true;
    for (uint32_t i = 0; i < SPARKS; ++i) {
        float up = spread(i, 12u, 0.0f, 1.0f);
        float out = spread(i, 13u, -1.0f, 1.0f) * (0.1f + 0.6f * up);
        hdrp_v3 center = hdrp_v3_make(-1.75f + out, 0.1f + 1.5f * up * (1.0f - 0.4f * out * out),
                                      1.6f + spread(i, 14u, -0.5f, 0.9f));
        add_square(b, spark, center, spread(i, 15u, 0.02f, 0.05f), 0.0f, 0.0f, "spark");
    }
    add_square(b, rd_build_material(b, &halo, "halo"), hdrp_v3_make(-1.75f, 0.35f, 1.7f), 1.5f,
               0.0f, 0.0f, "halo");
}

/* >>holograms: a sheet with lines, a ring and a ball whose far sides are seen through the near ones */

static void add_holograms(rd_builder* b)
{
    rd_material sheet = blended(hdrp_v3_splat(0.02f), 0.6f, 0.6f);
    rd_material ring = blended(hdrp_v3_splat(0.02f), 0.6f, 0.2f);
    rd_material ball = blended(hdrp_v3_splat(0.02f), 0.6f, 0.12f);
    int rings;
    sheet.emission_nits = hdrp_v3_make(3e3f, 38e3f, 46e3f);
    ring.emission_nits = hdrp_v3_make(6e3f, 60e3f, 40e3f);
    ball.emission_nits = hdrp_v3_make(50e3f, 12e3f, 60e3f);
    sheet.slot[RD_SLOT_BASE_COLOR] = rd_texture_slot_make(RD_TEX_HOLOGRAM);
    rd_build_mesh(b, rd_shape_card(0.9f, 0.7f, 0.08f, rd_uv_scale(1.0f, -1.0f)),
                  rd_build_material(b, &sheet, "hologram"),
                  rd_affine_mul(rd_translation(2.0f, 0.75f, 1.1f), rd_rotation_y(-0.5f)),
                  "hologram");
    rings = rd_build_material(b, &ring, "ring of light");
    for (int i = 0; i < 2; ++i) {
        rd_build_mesh(b, rd_shape_torus(0.22f + 0.1f * (float)i, 0.03f, 48), rings,
                      rd_affine_mul(rd_translation(1.45f, 1.75f, 0.2f),
                                    rd_rotation_x(0.5f + 0.8f * (float)i)),
                      "ring");
    }
    rd_build_mesh(b, rd_shape_sphere(0.14f, 48, rd_uv_scale(1.0f, 1.0f)),
                  rd_build_material(b, &ball, "ball of light"), rd_translation(1.45f, 1.75f, 0.2f),
                  "ball");
}

void rd_build_transparency(rd_builder* b)
{
    rd_build_display(b);
    add_smoke(b);
    add_panes(b);
    add_sparks(b);
    add_holograms(b);
}
