/* A street at night with about 500 lights of all kinds, for looking at how they are culled. Only
 * the moon and the street lamps cast shadows: walls are blockers of the other lights, and windows
 * portals in them. */
#include "builtin_builder.h"

#include <math.h>

/* Houses on each side, from z = 0 on towards -Z. The left side is a mirror image. */
#define HOUSES      9
#define HOUSE_WIDTH 5.0f
#define FACADE      5.0f /* from the middle of the street */
#define DEPTH       4.0f /* of rooms */
#define HEIGHT      3.2f
#define STREET_END  (-HOUSE_WIDTH * HOUSES)
#define THICKNESS   0.2f
/* Of windows. */
#define SILL     0.8f
#define LINTEL   2.5f
#define WINDOW_W 2.6f

/* Light layers: the one that all is on, and that of what is shown in the rooms. */
#define LAYER_ALL     1u
#define LAYER_EXHIBIT 2u

static const hdrp_v3 up = {0.0f, 1.0f, 0.0f};

static float random_of(int house, int what, uint32_t purpose)
{
    return hdrp_unit_from_u32(hdrp_hash3((uint32_t)house, (uint32_t)what, purpose));
}

static hdrp_v3 hue(float h)
{
    float x = h * 6.0f;
    hdrp_v3 pure = hdrp_v3_saturate(hdrp_v3_make(
        hdrp_abs(x - 3.0f) - 1.0f, 2.0f - hdrp_abs(x - 2.0f), 2.0f - hdrp_abs(x - 4.0f)));
    return hdrp_v3_lerp(pure, hdrp_v3_splat(1.0f), 0.25f);
}

/* The middle of a house along the street. */
static float middle_of(int house)
{
    return -HOUSE_WIDTH * ((float)house + 0.5f);
}

/* >>buildings */

typedef struct paints {
    int wall[3], room, asphalt, kerb, pane, bulb, exhibit[5], glass;
} paints;

static int paint(rd_builder* b, float r, float g, float bl, float roughness, const char* name)
{
    rd_material m = rd_dielectric(hdrp_v3_make(r, g, bl), roughness);
    return rd_build_material(b, &m, name);
}

/* One of each feature: what is shown in the rooms, and stands on the pavement. */
static void add_exhibit_paints(rd_builder* b, paints* p)
{
    rd_material coated = rd_dielectric(hdrp_v3_make(0.45f, 0.012f, 0.02f), 0.42f);
    rd_material brushed = rd_metal(hdrp_v3_make(0.91f, 0.72f, 0.40f), 0.38f);
    rd_material tempered = rd_metal(hdrp_v3_make(0.56f, 0.55f, 0.54f), 0.2f);
    rd_material leaf = rd_dielectric(hdrp_v3_make(0.25f, 0.5f, 0.1f), 0.5f);
    rd_material gold = rd_metal(hdrp_v3_make(1.0f, 0.782f, 0.344f), 0.25f);
    coated.coat = 1.0f;
    coated.coat_perceptual_roughness = HDRP_BRDF_COAT_PERCEPTUAL_ROUGHNESS;
    brushed.anisotropy = 0.8f;
    tempered.film = 1.0f;
    tempered.film_ior = 2.2f;
    tempered.film_thickness_min_nm = tempered.film_thickness_max_nm = 300.0f;
    leaf.slab_thickness = 0.5f;
    leaf.double_sided = true;
    p->exhibit[0] = rd_build_material(b, &coated, "car paint");
    p->exhibit[1] = rd_build_material(b, &brushed, "brushed brass");
    p->exhibit[2] = rd_build_material(b, &tempered, "tempered steel");
    p->exhibit[3] = rd_build_material(b, &leaf, "leaf");
    p->exhibit[4] = rd_build_material(b, &gold, "gold");
}

static void add_paints(rd_builder* b, paints* p)
{
    rd_material pane = rd_dielectric(hdrp_v3_make(0.5f, 0.6f, 0.65f), 0.05f);
    rd_material glass = rd_glass(1.5f, 0.3f);
    rd_material bulb = rd_dielectric(hdrp_v3_splat(0.8f), 0.4f);
    pane.alpha_mode = RD_ALPHA_BLEND;
    pane.alpha = 0.15f;
    pane.double_sided = true;
    bulb.emission_nits = hdrp_v3_make(3000.0f, 2200.0f, 1300.0f);
    bulb.is_lamp = true;
    p->wall[0] = paint(b, 0.55f, 0.50f, 0.44f, 0.7f, "plaster");
    p->wall[1] = paint(b, 0.42f, 0.24f, 0.18f, 0.8f, "brick");
    p->wall[2] = paint(b, 0.35f, 0.40f, 0.45f, 0.6f, "slate");
    p->room = paint(b, 0.7f, 0.66f, 0.6f, 0.8f, "room");
    p->asphalt = paint(b, 0.08f, 0.08f, 0.085f, 0.3f, "wet asphalt");
    p->kerb = paint(b, 0.3f, 0.3f, 0.31f, 0.55f, "pavement");
    p->pane = rd_build_material(b, &pane, "pane");
    p->glass = rd_build_material(b, &glass, "glass");
    p->bulb = rd_build_material(b, &bulb, "bulb");
    add_exhibit_paints(b, p);
}

/* From low to high; on the left side mirrored. */
static void add_box(rd_builder* b, int material, float side, hdrp_v3 low, hdrp_v3 high,
                    const char* name)
{
    hdrp_v3 size = hdrp_v3_sub(high, low);
    hdrp_v3 center = hdrp_v3_scale(hdrp_v3_add(low, high), 0.5f);
    rd_build_mesh(b, rd_shape_rounded_box(size, 0.01f), material,
                  rd_translation(side * center.x, center.y, center.z), name);
}

/* Four walls around a window. */
static void add_facade(rd_builder* b, const paints* p, float side, int house)
{
    float x0 = FACADE, x1 = FACADE + THICKNESS, z = middle_of(house);
    float half = 0.5f * HOUSE_WIDTH, hole = 0.5f * WINDOW_W;
    int wall = p->wall[(house + (side > 0.0f ? 0 : 1)) % 3];
    add_box(b, wall, side, hdrp_v3_make(x0, 0.0f, z - half), hdrp_v3_make(x1, SILL, z + half),
            "facade");
    add_box(b, wall, side, hdrp_v3_make(x0, LINTEL, z - half),
            hdrp_v3_make(x1, HEIGHT + 0.3f, z + half), "facade");
    add_box(b, wall, side, hdrp_v3_make(x0, SILL, z - half), hdrp_v3_make(x1, LINTEL, z - hole),
            "facade");
    add_box(b, wall, side, hdrp_v3_make(x0, SILL, z + hole), hdrp_v3_make(x1, LINTEL, z + half),
            "facade");
    if (house % 2 == 0) {
        rd_affine where = rd_rotation_y(side * HDRP_HALF_PI);
        where.t = hdrp_v3_make(side * (x0 + 0.5f * THICKNESS), SILL, z);
        rd_build_mesh(b, rd_shape_card(WINDOW_W, LINTEL - SILL, 0.0f, rd_uv_scale(1.0f, 1.0f)),
                      p->pane, where, "pane");
    }
}

static void add_side(rd_builder* b, const paints* p, float side)
{
    float inside = FACADE + 0.5f * THICKNESS, back = FACADE + DEPTH;
    add_box(b, p->room, side, hdrp_v3_make(back, 0.0f, STREET_END),
            hdrp_v3_make(back + THICKNESS, HEIGHT, 0.0f), "back wall");
    add_box(b, p->room, side, hdrp_v3_make(inside, HEIGHT, STREET_END),
            hdrp_v3_make(back, HEIGHT + THICKNESS, 0.0f), "ceiling");
    add_box(b, p->kerb, side, hdrp_v3_make(3.6f, -0.2f, STREET_END), hdrp_v3_make(back, 0.1f, 0.0f),
            "pavement");
    for (int i = 0; i <= HOUSES; ++i) {
        float z = -HOUSE_WIDTH * (float)i;
        add_box(b, p->room, side, hdrp_v3_make(inside, 0.0f, z - 0.5f * THICKNESS),
                hdrp_v3_make(back, HEIGHT, z + 0.5f * THICKNESS), "side wall");
    }
    for (int i = 0; i < HOUSES; ++i) {
        add_facade(b, p, side, i);
    }
}

static void add_exhibits(rd_builder* b, const paints* p, float side, int house)
{
    float z = middle_of(house);
    int outside = p->exhibit[(house + (side > 0.0f ? 0 : 2)) % 5];
    rd_build_mesh(b, rd_shape_sphere(0.45f, 48, rd_uv_scale(1.0f, 1.0f)), p->exhibit[house % 5],
                  rd_translation(side * 6.2f, 1.2f, z), "exhibit");
    if (b->ok) {
        b->scene->meshes[b->scene->mesh_count - 1].light_layers = LAYER_ALL | LAYER_EXHIBIT;
    }
    rd_build_mesh(b, rd_shape_sphere(0.35f, 48, rd_uv_scale(1.0f, 1.0f)),
                  house % 3 == 2 ? p->glass : outside, rd_translation(side * 4.2f, 0.45f, z + 2.2f),
                  "bollard");
}

/* >>lights */

static rd_light lamp(rd_light_type type, hdrp_v3 position, hdrp_v3 target, hdrp_v3 color,
                     float candela, float range_m)
{
    rd_light l = rd_light_at(type, position, target, color);
    l.intensity = candela;
    l.range_m = range_m;
    l.light_layers = LAYER_ALL;
    return l;
}

static rd_light bulb_at(float x, float y, float z, hdrp_v3 color, float candela, float range_m)
{
    hdrp_v3 at = hdrp_v3_make(x, y, z);
    return lamp(RD_LIGHT_POINT, at, hdrp_v3_make(x, y - 1.0f, z), color, candela, range_m);
}

/* What keeps the light of a room inside: its side walls, and its facade but for the window. */
static void add_room_blockers(rd_builder* b, float side, int house, int* out)
{
    float z = middle_of(house), x = side * (FACADE + 0.5f * THICKNESS);
    hdrp_v3 across = hdrp_v3_make(1.0f, 0.0f, 0.0f), along = hdrp_v3_make(0.0f, 0.0f, 1.0f);
    float middle = 0.5f * (SILL + LINTEL);
    int window =
        rd_build_blocker(b, hdrp_cull_blocker_rectangle(hdrp_v3_make(x, middle, z), across, up,
                                                        0.5f * WINDOW_W, 0.5f * (LINTEL - SILL)));
    hdrp_cull_blocker facade = hdrp_cull_blocker_rectangle(
        hdrp_v3_make(x, 0.5f * HEIGHT, z), across, up, 0.5f * HOUSE_WIDTH, 0.5f * HEIGHT + 0.3f);
    out[0] = rd_build_blocker(b, hdrp_cull_blocker_with_portals(facade, (hdrp_u32)window, 1u));
    for (int i = 0; i < 2; ++i) {
        hdrp_v3 at = hdrp_v3_make(side * (FACADE + 0.5f * DEPTH), 0.5f * HEIGHT,
                                  z + ((float)i - 0.5f) * HOUSE_WIDTH);
        out[1 + i] = rd_build_blocker(
            b, hdrp_cull_blocker_rectangle(at, along, up, 0.5f * DEPTH, 0.5f * HEIGHT + 0.3f));
    }
}

static void add_room_bulbs(rd_builder* b, float side, int house, const int* blockers)
{
    float z = middle_of(house), back = FACADE + DEPTH;
    for (int i = 0; i < 8; ++i) {
        float along = z + ((float)i - 3.5f) * 0.55f;
        hdrp_v3 color = hue(random_of(house, i, side > 0.0f ? 1u : 2u));
        rd_build_blocked_light(
            b, bulb_at(side * (back - 0.3f), i % 2 ? 1.7f : 0.9f, along, color, 2.5f, 1.3f),
            blockers, 3u);
    }
    for (int i = 0; i < 2; ++i) {
        hdrp_v3 warm = hdrp_v3_make(1.0f, 0.72f, 0.45f);
        rd_build_blocked_light(
            b, bulb_at(side * (FACADE + 2.0f), 2.6f, z + (float)i * 2.4f - 1.2f, warm, 12.0f, 4.5f),
            blockers, 3u);
        rd_light accent = bulb_at(side * 5.7f, 2.1f, z + (float)i - 0.5f,
                                  hue(random_of(house, i, 3u)), 10.0f, 1.8f);
        accent.light_layers = LAYER_EXHIBIT;
        rd_build_blocked_light(b, accent, blockers, 3u);
    }
}

/* A ceiling lamp, one that shines through the window, and a picture projected on the back wall. */
static void add_room_lamps(rd_builder* b, float side, int house, const int* blockers)
{
    float z = middle_of(house);
    hdrp_v3 white = hdrp_v3_make(1.0f, 0.86f, 0.7f), color = hue(random_of(house, 0, 4u));
    rd_light ceiling = lamp(RD_LIGHT_PYRAMID, hdrp_v3_make(side * 7.0f, 3.1f, z),
                            hdrp_v3_make(side * 7.0f, 0.0f, z), white, 30.0f, 4.0f);
    rd_light beam = lamp(RD_LIGHT_SPOT, hdrp_v3_make(side * 8.5f, 2.6f, z),
                         hdrp_v3_make(side * 3.0f, 0.6f, z), color, 250.0f, 10.0f);
    rd_light picture = lamp(RD_LIGHT_BOX, hdrp_v3_make(side * 7.8f, 2.0f, z),
                            hdrp_v3_make(side * 9.0f, 2.0f, z), color, 15.0f, 1.3f);
    ceiling.half_width = 0.9f;
    ceiling.half_height = 0.6f;
    beam.inner_angle_rad = 0.25f;
    beam.outer_angle_rad = 0.45f;
    picture.half_width = 0.8f;
    picture.half_height = 0.5f;
    rd_build_blocked_light(b, ceiling, blockers, 3u);
    rd_build_blocked_light(b, beam, blockers, 3u);
    rd_build_blocked_light(b, picture, blockers, 3u);
}

/* Outside: a sign of four bulbs, a washer above the window, and a street lamp with shadows. */
static void add_front(rd_builder* b, float side, int house)
{
    float z = middle_of(house), x = side * (FACADE - 0.25f);
    hdrp_v3 color = hue(random_of(house, 0, side > 0.0f ? 5u : 6u));
    int wall = rd_build_blocker(
        b, hdrp_cull_blocker_plane(hdrp_v3_make(side * (FACADE + 0.5f * THICKNESS), 0.0f, 0.0f),
                                   hdrp_v3_make(-side, 0.0f, 0.0f)));
    rd_light washer = lamp(RD_LIGHT_PYRAMID, hdrp_v3_make(x, 3.3f, z),
                           hdrp_v3_make(side * FACADE, 0.0f, z), color, 25.0f, 3.6f);
    rd_light street = lamp(RD_LIGHT_SPOT, hdrp_v3_make(side * 3.4f, 4.6f, z + 2.5f),
                           hdrp_v3_make(side * 2.6f, 0.0f, z + 2.5f),
                           hdrp_v3_make(1.0f, 0.78f, 0.5f), 130.0f, 7.5f);
    washer.half_width = 0.7f;
    washer.half_height = 0.15f;
    street.inner_angle_rad = 0.5f;
    street.outer_angle_rad = 0.95f;
    street.radius_m = 0.05f;
    for (int i = 0; i < 4; ++i) {
        rd_build_blocked_light(b, bulb_at(x, 2.9f, z + ((float)i - 1.5f) * 0.5f, color, 1.5f, 1.2f),
                               &wall, 1u);
    }
    rd_build_blocked_light(b, washer, &wall, 1u);
    rd_build_light(b, &street);
}

/* Bulbs on strings across the street. */
static void add_string(rd_builder* b, const paints* p, int house)
{
    for (int i = 0; i < 13; ++i) {
        float t = ((float)i - 6.0f) / 6.0f;
        float x = 4.6f * t, y = 3.0f + 0.7f * t * t, z = -HOUSE_WIDTH * ((float)house + 0.75f);
        rd_light l = bulb_at(x, y, z, hue(random_of(house, i, 7u)), 4.0f, 2.2f);
        l.shadowless = true;
        rd_build_light(b, &l);
        rd_build_mesh(b, rd_shape_sphere(0.04f, 12, rd_uv_scale(1.0f, 1.0f)), p->bulb,
                      rd_translation(x, y, z), "bulb");
    }
}

/* Stripes of light for those who cross the street, and the moon. */
static void add_street_lights(rd_builder* b)
{
    rd_light moon = lamp(RD_LIGHT_DIRECTIONAL, hdrp_v3_make(3.0f, 8.0f, 4.0f), hdrp_v3_splat(0.0f),
                         hdrp_v3_make(0.6f, 0.75f, 1.0f), 0.25f, 0.0f);
    rd_build_light(b, &moon);
    for (int i = 0; i < 6; ++i) {
        float x = 1.2f * (float)i - 3.0f;
        rd_light stripe = lamp(RD_LIGHT_BOX, hdrp_v3_make(x, 3.8f, -7.5f),
                               hdrp_v3_make(x, 0.0f, -7.5f), hdrp_v3_splat(1.0f), 12.0f, 4.0f);
        stripe.shadowless = true;
        stripe.half_width = 1.1f;
        stripe.half_height = 0.3f;
        stripe.right = hdrp_v3_make(0.0f, 0.0f, 1.0f);
        stripe.up = hdrp_v3_make(1.0f, 0.0f, 0.0f);
        rd_build_light(b, &stripe);
    }
}

static void add_house(rd_builder* b, const paints* p, float side, int house)
{
    int blockers[3];
    add_exhibits(b, p, side, house);
    add_room_blockers(b, side, house, blockers);
    add_room_bulbs(b, side, house, blockers);
    add_room_lamps(b, side, house, blockers);
    add_front(b, side, house);
}

void rd_build_street(rd_builder* b)
{
    paints p;
    b->scene->slab_color[0] = hdrp_v3_make(0.55f, 0.75f, 0.15f);
    add_paints(b, &p);
    add_box(b, p.asphalt, 1.0f, hdrp_v3_make(-3.6f, -0.2f, STREET_END),
            hdrp_v3_make(3.6f, 0.0f, 4.0f), "street");
    for (int i = 0; i < 2; ++i) {
        float side = i ? 1.0f : -1.0f;
        add_side(b, &p, side);
        for (int house = 0; house < HOUSES; ++house) {
            add_house(b, &p, side, house);
        }
    }
    for (int house = 0; house < HOUSES; ++house) {
        add_string(b, &p, house);
    }
    add_street_lights(b);
    rd_build_camera(b, hdrp_v3_make(-2.6f, 1.9f, 0.5f), hdrp_v3_make(1.6f, 1.35f, -10.0f), 0.85f,
                    "street");
}
