/* The scene that is shown when no file is given: a display of every material feature. */
#include "builtin_builder.h"
#include "builtin_texture.h"

static void set_slot(rd_material* m, rd_slot slot, rd_builtin_texture texture)
{
    m->slot[slot] = rd_texture_slot_make((int)texture);
}

/* >>the stage */

static void add_stage(rd_builder* b)
{
    rd_material floor = rd_dielectric(hdrp_v3_make(0.22f, 0.43f, 0.56f), 1.0f);
    rd_material plinth = rd_dielectric(hdrp_v3_make(0.60f, 0.585f, 0.56f), 0.5f);
    int stone;
    set_slot(&floor, RD_SLOT_BASE_COLOR, RD_TEX_FLOOR_COLOR);
    set_slot(&floor, RD_SLOT_METALLIC_ROUGHNESS, RD_TEX_FLOOR_ROUGHNESS);
    rd_build_mesh(b, rd_shape_cove(9.0f, 9.0f, -4.2f, 2.2f, 4.5f, 0.35f),
                  rd_build_material(b, &floor, "floor"), rd_affine_identity(), "floor");
    stone = rd_build_material(b, &plinth, "plinth");
    rd_build_mesh(b, rd_shape_rounded_box(hdrp_v3_make(1.15f, 0.50f, 1.15f), 0.02f), stone,
                  rd_translation(0.0f, 0.25f, -0.70f), "centre plinth");
    rd_build_mesh(b, rd_shape_rounded_box(hdrp_v3_make(0.85f, 0.72f, 0.85f), 0.02f), stone,
                  rd_translation(-1.45f, 0.36f, -0.95f), "left plinth");
    rd_build_mesh(b, rd_shape_rounded_box(hdrp_v3_make(0.85f, 0.72f, 0.85f), 0.02f), stone,
                  rd_translation(1.45f, 0.36f, -0.95f), "right plinth");
    rd_build_mesh(b, rd_shape_rounded_box(hdrp_v3_make(0.90f, 0.34f, 0.90f), 0.02f), stone,
                  rd_translation(-2.50f, 0.17f, -0.45f), "far left plinth");
    rd_build_mesh(b, rd_shape_rounded_box(hdrp_v3_make(0.90f, 0.34f, 0.90f), 0.02f), stone,
                  rd_translation(2.50f, 0.17f, -0.45f), "far right plinth");
}

/* >>rows of spheres in front: metals and dielectrics from smooth to rough */

static void add_rows(rd_builder* b)
{
    static const hdrp_v3 metals[5] = {{0.955f, 0.638f, 0.538f},  /* copper */
                                      {1.000f, 0.782f, 0.344f},  /* gold */
                                      {0.972f, 0.960f, 0.915f},  /* silver */
                                      {0.550f, 0.556f, 0.554f},  /* chromium */
                                      {0.542f, 0.497f, 0.449f}}; /* titanium */
    static const hdrp_v3 colors[5] = {{0.02f, 0.02f, 0.025f},
                                      {0.03f, 0.16f, 0.30f},
                                      {0.05f, 0.30f, 0.22f},
                                      {0.75f, 0.33f, 0.08f},
                                      {0.80f, 0.76f, 0.68f}};
    for (int i = 0; i < 5; ++i) {
        float roughness = 0.05f + 0.19f * (float)i;
        rd_material m = rd_metal(metals[i], roughness);
        rd_material d = rd_dielectric(colors[i], roughness);
        rd_build_mesh(b, rd_shape_sphere(0.175f, 64, rd_uv_scale(1.0f, 1.0f)),
                      rd_build_material(b, &m, "metal"),
                      rd_translation(-2.22f + 0.41f * (float)i, 0.175f, 0.95f), "metal sphere");
        rd_build_mesh(b, rd_shape_sphere(0.175f, 64, rd_uv_scale(1.0f, 1.0f)),
                      rd_build_material(b, &d, "dielectric"),
                      rd_translation(2.22f - 0.41f * (float)i, 0.175f, 0.95f), "dielectric sphere");
    }
}

/* >>one group for each feature */

/* Metallic paint: flakes below a smooth coat, the coat itself without them. */
static void add_clear_coat(rd_builder* b)
{
    rd_material m = rd_dielectric(hdrp_v3_make(0.45f, 0.012f, 0.02f), 0.42f);
    m.metallic = 0.65f;
    m.coat = 1.0f;
    m.coat_perceptual_roughness = 0.03f;
    set_slot(&m, RD_SLOT_NORMAL, RD_TEX_FLAKES);
    rd_build_mesh(b, rd_shape_sphere(0.46f, 128, rd_uv_scale(6.0f, -3.0f)),
                  rd_build_material(b, &m, "car paint"), rd_translation(0.0f, 0.96f, -0.70f),
                  "coated sphere");
}

/* Turned and brushed metal: the tangents run around the axis. */
static void add_anisotropy(rd_builder* b)
{
    static const hdrp_v2 disc[] = {{0.03f, 0.012f},  {0.42f, 0.012f},  {0.43f, 0.006f},
                                   {0.43f, -0.006f}, {0.42f, -0.012f}, {0.0f, -0.012f}};
    static const hdrp_v2 barrel[] = {{0.0f, 0.30f},     {0.20f, 0.30f},  {0.215f, 0.288f},
                                     {0.235f, 0.15f},   {0.242f, 0.0f},  {0.235f, -0.15f},
                                     {0.215f, -0.288f}, {0.20f, -0.30f}, {0.0f, -0.30f}};
    rd_material m = rd_metal(hdrp_v3_make(0.91f, 0.92f, 0.92f), 0.38f);
    rd_material brass = rd_metal(hdrp_v3_make(0.91f, 0.72f, 0.40f), 0.42f);
    rd_affine tilted = rd_affine_mul(rd_translation(-1.45f, 1.135f, -0.98f),
                                     rd_affine_mul(rd_rotation_y(0.30f), rd_rotation_x(1.30f)));
    m.anisotropy = brass.anisotropy = 0.85f;
    set_slot(&m, RD_SLOT_METALLIC_ROUGHNESS, RD_TEX_BRUSHED);
    set_slot(&brass, RD_SLOT_METALLIC_ROUGHNESS, RD_TEX_BRUSHED);
    rd_build_mesh(b, rd_shape_lathe(disc, 6, 128, rd_uv_scale(1.0f, 1.0f)),
                  rd_build_material(b, &m, "brushed steel"), tilted, "brushed disc");
    rd_build_mesh(b, rd_shape_lathe(barrel, 9, 96, rd_uv_scale(1.0f, 1.0f)),
                  rd_build_material(b, &brass, "brushed brass"),
                  rd_translation(-1.92f, 0.30f, 0.28f), "barrel");
}

/* Soap bubbles, and a torus of heat-coloured steel. */
static void add_iridescence(rd_builder* b)
{
    static const float bubbles[3][4] = {{0.62f, 1.62f, -0.35f, 0.20f},
                                        {0.98f, 1.98f, -0.55f, 0.12f},
                                        {0.28f, 2.02f, -0.60f, 0.085f}};
    rd_material bubble = rd_glass(1.0f, 0.0f);
    rd_material steel = rd_metal(hdrp_v3_make(0.56f, 0.55f, 0.54f), 0.12f);
    int soap;
    bubble.film = 1.0f;
    bubble.film_ior = 1.33f;
    bubble.film_thickness_min_nm = 180.0f;
    bubble.film_thickness_max_nm = 620.0f;
    bubble.double_sided = true;
    set_slot(&bubble, RD_SLOT_FILM_THICKNESS, RD_TEX_FILM);
    soap = rd_build_material(b, &bubble, "soap film");
    for (int i = 0; i < 3; ++i) {
        const float* p = bubbles[i];
        rd_build_mesh(b, rd_shape_sphere(p[3], 96, rd_uv_scale(1.0f, -1.0f)), soap,
                      rd_translation(p[0], p[1], p[2]), "bubble");
    }
    steel.film = 1.0f;
    steel.film_ior = 2.4f;
    steel.film_thickness_min_nm = 40.0f;
    steel.film_thickness_max_nm = 260.0f;
    set_slot(&steel, RD_SLOT_FILM_THICKNESS, RD_TEX_FILM);
    rd_build_mesh(b, rd_shape_torus(0.26f, 0.095f, 96),
                  rd_build_material(b, &steel, "tempered steel"),
                  rd_affine_mul(rd_translation(2.50f, 0.675f, -0.40f),
                                rd_affine_mul(rd_rotation_y(-0.5f), rd_rotation_x(1.25f))),
                  "iridescent torus");
}

/* A solid of coloured glass, one of clear glass, and a thin frosted sheet. */
static void add_transmission(rd_builder* b)
{
    rd_material green = rd_glass(1.5f, 0.5f);
    rd_material clear = rd_glass(1.52f, 0.46f);
    rd_material thin = rd_glass(1.5f, 0.0f);
    green.attenuation_color = hdrp_v3_make(0.25f, 0.85f, 0.65f);
    green.attenuation_distance_m = 0.35f;
    thin.base_color = hdrp_v3_make(0.95f, 0.80f, 0.55f);
    thin.perceptual_roughness = 0.25f;
    thin.double_sided = true;
    rd_build_mesh(b, rd_shape_rounded_box(hdrp_v3_make(0.46f, 0.46f, 0.46f), 0.06f),
                  rd_build_material(b, &green, "green glass"),
                  rd_affine_mul(rd_translation(1.45f, 0.951f, -0.95f), rd_rotation_y(0.65f)),
                  "glass cube");
    rd_build_mesh(b, rd_shape_sphere(0.23f, 96, rd_uv_scale(1.0f, 1.0f)),
                  rd_build_material(b, &clear, "clear glass"), rd_translation(0.20f, 0.23f, 1.60f),
                  "glass sphere");
    rd_build_mesh(b, rd_shape_card(0.50f, 0.62f, 0.0f, rd_uv_scale(1.0f, -1.0f)),
                  rd_build_material(b, &thin, "amber sheet"),
                  rd_affine_mul(rd_translation(1.18f, 0.0f, 0.32f), rd_rotation_y(-0.55f)),
                  "amber sheet");
}

/* MASK: a perforated screen and a plant. BLEND: a tinted pane with a label on it. */
static void add_screen(rd_builder* b)
{
    rd_material screen = rd_metal(hdrp_v3_make(0.91f, 0.78f, 0.55f), 0.4f);
    set_slot(&screen, RD_SLOT_BASE_COLOR, RD_TEX_SCREEN);
    screen.alpha_mode = RD_ALPHA_MASK;
    screen.double_sided = true;
    rd_build_mesh(b, rd_shape_card(1.35f, 1.75f, 0.0f, rd_uv_scale(13.5f, -10.1f)),
                  rd_build_material(b, &screen, "perforated steel"),
                  rd_affine_mul(rd_translation(-2.75f, 0.0f, -1.75f), rd_rotation_y(0.30f)),
                  "screen");
}

static void add_plant(rd_builder* b)
{
    static const hdrp_v2 pot[] = {{0.0f, 0.22f},  {0.135f, 0.22f}, {0.14f, 0.27f}, {0.175f, 0.28f},
                                  {0.18f, 0.27f}, {0.17f, 0.20f},  {0.12f, 0.0f},  {0.0f, 0.0f}};
    rd_material leaf = rd_dielectric(hdrp_v3_splat(1.0f), 0.45f);
    rd_material clay = rd_dielectric(hdrp_v3_make(0.50f, 0.20f, 0.11f), 0.75f);
    int leaves;
    set_slot(&leaf, RD_SLOT_BASE_COLOR, RD_TEX_LEAF);
    leaf.alpha_mode = RD_ALPHA_MASK;
    leaf.double_sided = true;
    leaf.slab_thickness = 0.5f;
    leaves = rd_build_material(b, &leaf, "leaf");
    rd_build_mesh(b, rd_shape_lathe(pot, 8, 48, rd_uv_scale(1.0f, 1.0f)),
                  rd_build_material(b, &clay, "clay"), rd_translation(-2.50f, 0.34f, -0.45f),
                  "pot");
    for (int i = 0; i < 14; ++i) {
        float turn = 2.399963f * (float)i; /* the golden angle */
        float lean = 0.25f + 0.055f * (float)i;
        float size = 0.62f - 0.014f * (float)i;
        rd_affine where = rd_affine_mul(rd_translation(-2.50f, 0.55f, -0.45f),
                                        rd_affine_mul(rd_rotation_y(turn), rd_rotation_x(-lean)));
        rd_build_mesh(b, rd_shape_card(size * 0.42f, size, 0.30f * size, rd_uv_scale(1.0f, -1.0f)),
                      leaves, where, "leaf");
    }
}

static void add_pane(rd_builder* b)
{
    rd_material pane = rd_dielectric(hdrp_v3_make(0.30f, 0.55f, 0.75f), 0.05f);
    rd_material label = rd_dielectric(hdrp_v3_splat(1.0f), 0.6f);
    rd_affine where = rd_affine_mul(rd_translation(-1.00f, 0.0f, 0.36f), rd_rotation_y(0.35f));
    pane.alpha_mode = label.alpha_mode = RD_ALPHA_BLEND;
    pane.double_sided = label.double_sided = true;
    pane.alpha = 0.35f;
    set_slot(&label, RD_SLOT_BASE_COLOR, RD_TEX_LABEL);
    rd_build_mesh(b, rd_shape_card(0.66f, 0.52f, 0.0f, rd_uv_scale(1.0f, -1.0f)),
                  rd_build_material(b, &pane, "tinted pane"), where, "pane");
    where.t = hdrp_v3_mad(where.t, where.z, 0.002f);
    where.t.y += 0.14f;
    rd_build_mesh(b, rd_shape_card(0.24f, 0.24f, 0.0f, rd_uv_scale(1.0f, -1.0f)),
                  rd_build_material(b, &label, "label"), where, "label");
}

/* Folded cloth with a weave, seen from both sides. */
static void add_cloth(rd_builder* b)
{
    static const hdrp_v2 rod[] = {{0.0f, 1.0f}, {0.022f, 1.0f}, {0.022f, -1.0f}, {0.0f, -1.0f}};
    rd_material m = rd_dielectric(hdrp_v3_splat(1.0f), 0.85f);
    rd_material wood = rd_dielectric(hdrp_v3_make(0.20f, 0.11f, 0.06f), 0.4f);
    set_slot(&m, RD_SLOT_BASE_COLOR, RD_TEX_WEAVE_COLOR);
    set_slot(&m, RD_SLOT_NORMAL, RD_TEX_WEAVE_NORMAL);
    m.slot[RD_SLOT_NORMAL].u_row = hdrp_v3_make(8.0f, 0.0f, 0.0f);
    m.slot[RD_SLOT_NORMAL].v_row = hdrp_v3_make(0.0f, 8.0f, 0.0f);
    m.double_sided = true;
    rd_build_mesh(b, rd_shape_cloth(1.75f, 1.95f, 0.10f, rd_uv_scale(1.0f, -1.0f)),
                  rd_build_material(b, &m, "cloth"), rd_translation(2.35f, 0.06f, -2.05f), "cloth");
    rd_build_mesh(
        b, rd_shape_lathe(rod, 4, 24, rd_uv_scale(1.0f, 1.0f)), rd_build_material(b, &wood, "wood"),
        rd_affine_mul(rd_translation(2.35f, 2.02f, -2.05f), rd_rotation_z(HDRP_HALF_PI)), "rod");
}

/* Dents that shrink below a pixel: their normals have to widen the highlight. */
static void add_hammered(rd_builder* b)
{
    static const hdrp_v2 vase[] = {{0.0f, 0.60f},   {0.085f, 0.62f}, {0.095f, 0.60f},
                                   {0.075f, 0.54f}, {0.070f, 0.48f}, {0.10f, 0.40f},
                                   {0.16f, 0.31f},  {0.20f, 0.21f},  {0.205f, 0.14f},
                                   {0.18f, 0.06f},  {0.13f, 0.0f},   {0.0f, 0.0f}};
    rd_material m = rd_metal(hdrp_v3_make(0.96f, 0.64f, 0.54f), 0.16f);
    set_slot(&m, RD_SLOT_NORMAL, RD_TEX_HAMMERED);
    rd_build_mesh(b, rd_shape_lathe(vase, 12, 96, rd_uv_scale(4.0f, 3.0f)),
                  rd_build_material(b, &m, "hammered copper"), rd_translation(0.0f, 0.0f, 0.32f),
                  "vase");
}

/* No uv at all: two triplanar layers, blended as surface gradients. */
static void add_rock(rd_builder* b)
{
    rd_material m = rd_dielectric(hdrp_v3_splat(1.0f), 0.8f);
    set_slot(&m, RD_SLOT_BASE_COLOR, RD_TEX_ROCK_COLOR);
    m.detail.layer_count = 2;
    m.detail.texture[0] = RD_TEX_ROCK_COARSE;
    m.detail.texture[1] = RD_TEX_ROCK_FINE;
    m.detail.scale[0] = 1.6f;
    m.detail.scale[1] = 4.0f;
    m.detail.strength[0] = m.detail.strength[1] = 1.0f;
    rd_build_mesh(b, rd_shape_rock(0.27f, 128, 5u), rd_build_material(b, &m, "rock"),
                  rd_translation(-0.86f, 0.20f, -0.25f), "rock");
}

/* >>light. The sun is part of the sky; these are the lamps of the display. */

static void add_lamps(rd_builder* b)
{
    hdrp_v3 warm = hdrp_v3_make(1.0f, 0.72f, 0.42f);
    hdrp_v3 cool = hdrp_v3_make(0.62f, 0.78f, 1.0f);
    rd_light spot = rd_light_at(RD_LIGHT_SPOT, hdrp_v3_make(-0.4f, 3.9f, 1.6f),
                                hdrp_v3_make(0.0f, 0.9f, -0.7f), hdrp_v3_make(1.0f, 0.93f, 0.84f));
    rd_light washer = rd_light_at(RD_LIGHT_SPOT, hdrp_v3_make(0.0f, 0.12f, -2.3f),
                                  hdrp_v3_make(0.0f, 2.1f, -4.2f), warm);
    rd_light pyramid = rd_light_at(RD_LIGHT_PYRAMID, hdrp_v3_make(-0.9f, 3.6f, -1.6f),
                                   hdrp_v3_make(-2.75f, 1.0f, -3.6f), cool);
    rd_light box = rd_light_at(RD_LIGHT_BOX, hdrp_v3_make(2.3f, 3.6f, -3.0f),
                               hdrp_v3_make(2.3f, 0.0f, -3.05f), cool);
    rd_light bulb = rd_light_at(RD_LIGHT_POINT, hdrp_v3_make(0.36f, 0.06f, 0.45f),
                                hdrp_v3_make(0.0f, 0.0f, 0.0f), warm);
    spot.intensity = 200000.0f;
    spot.inner_angle_rad = 0.20f;
    spot.outer_angle_rad = 0.30f;
    spot.radius_m = 0.05f;
    washer.intensity = 900000.0f;
    washer.inner_angle_rad = 0.25f;
    washer.outer_angle_rad = 0.85f;
    washer.radius_m = 0.04f;
    pyramid.intensity = 500000.0f;
    pyramid.half_width = 0.45f;
    pyramid.half_height = 0.30f;
    box.intensity = 30000.0f;
    box.half_width = 1.4f;
    box.half_height = 0.25f;
    box.range_m = 4.0f;
    bulb.intensity = 2500.0f;
    bulb.range_m = 4.0f;
    bulb.radius_m = 0.06f;
    rd_build_light(b, &spot);
    rd_build_light(b, &washer);
    rd_build_light(b, &pyramid);
    rd_build_light(b, &box);
    rd_build_light(b, &bulb);
}

/* The bulb itself, so that the light has a visible cause. */
static void add_bulb(rd_builder* b)
{
    rd_material m = rd_dielectric(hdrp_v3_splat(0.8f), 0.3f);
    /* What a sphere of this size needs to look as bright as its intensity: I / (pi r^2). */
    m.emission_nits =
        hdrp_v3_scale(hdrp_v3_make(1.0f, 0.72f, 0.42f), 2500.0f / (HDRP_PI * 0.06f * 0.06f));
    m.is_lamp = true;
    rd_build_mesh(b, rd_shape_sphere(0.06f, 48, rd_uv_scale(1.0f, 1.0f)),
                  rd_build_material(b, &m, "bulb"), rd_translation(0.36f, 0.06f, 0.45f), "bulb");
}

void rd_build_display(rd_builder* b)
{
    rd_scene* scene = b->scene;
    scene->has_sky = true;
    scene->sun_elevation_rad = 0.52f;
    scene->ground_albedo = hdrp_v3_make(0.14f, 0.22f, 0.26f);
    scene->sun_azimuth_rad = -1.05f;
    scene->slab_color[0] = hdrp_v3_make(0.55f, 0.75f, 0.15f);
    b->ok = rd_builtin_textures(&scene->textures);
    add_stage(b);
    add_rows(b);
    add_clear_coat(b);
    add_anisotropy(b);
    add_iridescence(b);
    add_transmission(b);
    add_screen(b);
    add_plant(b);
    add_pane(b);
    add_cloth(b);
    add_hammered(b);
    add_rock(b);
    add_lamps(b);
    add_bulb(b);
    rd_build_camera(b, hdrp_v3_make(0.25f, 1.75f, 6.6f), hdrp_v3_make(0.0f, 0.80f, -0.6f), 0.48f,
                    "display");
}
