/* test_gpu_env.c - environments and tone mapping against the functions of the CPU.
 * SPDX-License-Identifier: MIT */
#include "gpu_test.h"

#include "hdrp_env.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static gpu_device device;
static hdrp_gpu_vk gpu;

static int set_up(void** state)
{
    hdrp_gpu_vk_desc desc = gpu_desc(&device);
    (void)state;
    desc.passes = HDRP_GPU_VK_PASS_ENVIRONMENT | HDRP_GPU_VK_PASS_TONE_MAP;
    return hdrp_gpu_vk_init(&gpu, &desc) != HDRP_OK;
}

static int tear_down(void** state)
{
    (void)state;
    hdrp_gpu_vk_destroy(&gpu);
    return device.messages != 0;
}

/* A number in [0,1) of a fixed sequence (Steele et al. 2014, splitmix64). */
static double random_number(uint64_t* state)
{
    uint64_t z = (*state += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return (double)((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

static float half_to_float(uint16_t h)
{
    int exponent = h >> 10 & 31;
    float mantissa = (float)(h & 1023);
    float v = exponent == 31 ? INFINITY
              : exponent     ? ldexpf(mantissa + 1024.0f, exponent - 25)
                             : ldexpf(mantissa, -24);
    return h >> 15 ? -v : v;
}

/* ---- pictures -------------------------------------------------------------------------------- */

/* A picture on both sides: of four floats a texel, the image of the device in layers. */
typedef struct picture {
    hdrp_env_image cpu;
    hdrp_gpu_vk_env_image on_gpu;
    hdrp_gpu_vk_image image;
    hdrp_gpu_vk_buffer staging;
    float* texels;
} picture;

static picture picture_make(hdrp_env_image_kind kind, uint32_t width, uint32_t height)
{
    picture p;
    uint32_t layers = kind == HDRP_ENV_CUBE ? 6u : 1u;
    const VkImageCreateInfo info = {.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                                    .imageType = VK_IMAGE_TYPE_2D,
                                    .format = VK_FORMAT_R32G32B32A32_SFLOAT,
                                    .extent = {width, height, 1},
                                    .mipLevels = 1,
                                    .arrayLayers = layers,
                                    .samples = VK_SAMPLE_COUNT_1_BIT,
                                    .usage = VK_IMAGE_USAGE_SAMPLED_BIT |
                                             VK_IMAGE_USAGE_TRANSFER_DST_BIT};
    memset(&p, 0, sizeof p);
    p.image = gpu_image(&device, &info,
                        layers == 6u ? VK_IMAGE_VIEW_TYPE_2D_ARRAY : VK_IMAGE_VIEW_TYPE_2D,
                        VK_IMAGE_ASPECT_COLOR_BIT);
    p.on_gpu.view = p.image.view;
    p.staging = gpu_host_buffer(&gpu, (VkDeviceSize)16 * width * height * layers);
    p.texels = gpu_map(&device, &p.staging);
    p.cpu.texels = p.texels;
    p.cpu.width = width;
    p.cpu.height = height;
    p.cpu.kind = kind;
    p.cpu.texel_stride = 4;
    p.on_gpu.layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    p.on_gpu.width_px = width;
    p.on_gpu.height_px = height;
    p.on_gpu.kind = kind;
    return p;
}

static void picture_destroy(picture* p)
{
    gpu_unmap(&device, &p->staging);
    hdrp_gpu_vk_buffer_destroy(&gpu, &p->staging);
    gpu_image_destroy(&device, &p->image);
}

static void change(VkCommandBuffer commands, VkImage image, VkImageLayout before,
                   VkImageLayout after)
{
    gpu_change_layout(commands, image, VK_IMAGE_ASPECT_COLOR_BIT, before, after);
}

static void picture_upload(VkCommandBuffer commands, const picture* p)
{
    uint32_t layers = p->cpu.kind == HDRP_ENV_CUBE ? 6u : 1u;
    const VkBufferImageCopy region = {.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, layers},
                                      .imageExtent = {p->cpu.width, p->cpu.height, 1}};
    change(commands, p->image.image, VK_IMAGE_LAYOUT_UNDEFINED,
           VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    vkCmdCopyBufferToImage(commands, p->staging.buffer, p->image.image,
                           VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
    change(commands, p->image.image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
           VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
}

static size_t texel_count(const picture* p)
{
    return (size_t)p->cpu.width * p->cpu.height * (p->cpu.kind == HDRP_ENV_CUBE ? 6u : 1u);
}

static void paint(picture* p, float r, float g, float b)
{
    for (size_t i = 0; i < texel_count(p); ++i) {
        p->texels[4 * i] = r;
        p->texels[4 * i + 1] = g;
        p->texels[4 * i + 2] = b;
        p->texels[4 * i + 3] = 1.0f;
    }
}

/* Coloured noise, and lamps that outshine it. */
static void paint_sky(picture* p, uint64_t seed)
{
    for (size_t i = 0; i < texel_count(p); ++i) {
        float lamp = random_number(&seed) < 0.002 ? 1e4f : 1.0f;
        for (int c = 0; c < 3; ++c) {
            p->texels[4 * i + (size_t)c] = lamp * (float)random_number(&seed);
        }
        p->texels[4 * i + 3] = 1.0f;
    }
}

/* ---- what was baked -------------------------------------------------------------------------- */

static size_t cube_texels(uint32_t size, uint32_t levels)
{
    size_t n = 0;
    for (uint32_t k = 0; k < levels; ++k) {
        n += (size_t)6 * (size >> k) * (size >> k);
    }
    return n;
}

/* The texels of a cube as floats, level after level. */
typedef struct readback {
    hdrp_gpu_vk_buffer specular, irradiance, sh, radiance;
} readback;

static void copy_cube(VkCommandBuffer commands, const hdrp_gpu_vk_cube* cube,
                      const hdrp_gpu_vk_buffer* to)
{
    VkDeviceSize bytes = cube->format == VK_FORMAT_R32G32B32A32_SFLOAT ? 16 : 8;
    change(commands, cube->image, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
           VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    for (uint32_t k = 0; k < cube->level_count; ++k) {
        const VkBufferImageCopy region = {
            .bufferOffset = bytes * cube_texels(cube->size_px, k),
            .imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, k, 0, 6},
            .imageExtent = {cube->size_px >> k, cube->size_px >> k, 1}};
        vkCmdCopyImageToBuffer(commands, cube->image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                               to->buffer, 1, &region);
    }
}

static void copy_buffer(VkCommandBuffer commands, const hdrp_gpu_vk_buffer* from,
                        const hdrp_gpu_vk_buffer* to)
{
    const VkBufferCopy region = {.size = from->bytes};
    vkCmdCopyBuffer(commands, from->buffer, to->buffer, 1, &region);
}

static readback read_env(VkCommandBuffer commands, const hdrp_gpu_vk_env* env)
{
    readback back;
    VkDeviceSize bytes = env->specular.format == VK_FORMAT_R32G32B32A32_SFLOAT ? 16 : 8;
    back.specular = gpu_host_buffer(
        &gpu, bytes * cube_texels(env->specular.size_px, env->specular.level_count));
    back.irradiance = gpu_host_buffer(&gpu, bytes * cube_texels(env->irradiance.size_px, 1));
    back.sh = gpu_host_buffer(&gpu, env->sh.bytes);
    back.radiance = gpu_host_buffer(&gpu, env->radiance.bytes);
    copy_cube(commands, &env->specular, &back.specular);
    copy_cube(commands, &env->irradiance, &back.irradiance);
    copy_buffer(commands, &env->sh, &back.sh);
    copy_buffer(commands, &env->radiance, &back.radiance);
    return back;
}

static void readback_destroy(readback* back)
{
    hdrp_gpu_vk_buffer_destroy(&gpu, &back->specular);
    hdrp_gpu_vk_buffer_destroy(&gpu, &back->irradiance);
    hdrp_gpu_vk_buffer_destroy(&gpu, &back->sh);
    hdrp_gpu_vk_buffer_destroy(&gpu, &back->radiance);
}

/* Everything at once. */
static readback bake(const hdrp_gpu_vk_env* env, const picture* p)
{
    VkCommandBuffer commands;
    readback back;
    assert_int_equal(hdrp_gpu_vk_begin_frame(&gpu, 0), HDRP_OK);
    commands = gpu_begin(&device);
    picture_upload(commands, p);
    assert_int_equal(hdrp_gpu_vk_env_bake(&gpu, commands, env, &p->on_gpu), HDRP_OK);
    back = read_env(commands, env);
    gpu_run(&device);
    return back;
}

static hdrp_gpu_vk_env make_env(const hdrp_env_desc* desc, VkFormat format)
{
    hdrp_gpu_vk_env env;
    assert_int_equal(hdrp_gpu_vk_env_create(&gpu, desc, format, &env), HDRP_OK);
    return env;
}

/* That of the CPU, from the picture or from the radiance of the device. */
static hdrp_env cpu_bake(const hdrp_env_desc* desc, const picture* p, const hdrp_v4* radiance,
                         void** memory)
{
    hdrp_env env;
    size_t bytes = hdrp_env_memory_size(desc);
    *memory = aligned_alloc(HDRP_MEMORY_ALIGNMENT, bytes);
    assert_non_null(*memory);
    assert_int_equal(hdrp_env_init(&env, desc, *memory, bytes), HDRP_OK);
    if (radiance) {
        memcpy(env.radiance.texels, radiance, sizeof *radiance * cube_texels(env.radiance.size, 1));
    } else {
        assert_int_equal(hdrp_env_resample(&env, &p->cpu, 0, 6 * env.radiance.size), HDRP_OK);
    }
    assert_int_equal(hdrp_env_reduce(&env, 0, 6), HDRP_OK);
    assert_int_equal(hdrp_env_prefilter(&env, 0, hdrp_env_specular_rows(&env)), HDRP_OK);
    assert_int_equal(hdrp_env_convolve_irradiance(&env, 0, 6 * env.irradiance.size), HDRP_OK);
    return env;
}

static double channel(const hdrp_v4* v, int c)
{
    return (double)(c == 0 ? v->x : c == 1 ? v->y : v->z);
}

/* Largest difference of two lists of texels, over the largest channel of the expected texel, or over
 * `scale` where that is not 0. */
static double worst(const hdrp_v4* found, const hdrp_v4* expected, size_t count, double scale)
{
    double most = 0.0;
    for (size_t i = 0; i < count; ++i) {
        double largest = fmax(channel(expected + i, 0),
                              fmax(channel(expected + i, 1), channel(expected + i, 2)));
        for (int c = 0; c < 3; ++c) {
            double off = fabs(channel(found + i, c) - channel(expected + i, c));
            double relative = off / (scale > 0.0 ? scale : fmax(largest, 1e-30));
            most = relative > most || !(relative == relative) ? relative : most;
        }
    }
    return most;
}

/* ---- environment ----------------------------------------------------------------------------- */

static void all_steps_are_those_of_the_cpu(void** state)
{
    static const struct {
        hdrp_env_image_kind kind;
        uint32_t width, height;
        hdrp_env_desc desc;
    } cases[] = {{HDRP_ENV_LATLONG, 128, 64, {32, 16, 0, 8, 0.0f}},
                 {HDRP_ENV_LATLONG, 61, 37, {16, 16, 5, 4, 0.7f}},
                 {HDRP_ENV_LATLONG, 1, 1, {8, 8, 1, 1, 0.4f}},
                 {HDRP_ENV_LATLONG, 512, 255, {8, 4, 3, 2, 0.4f}},
                 {HDRP_ENV_CUBE, 32, 32, {32, 8, 0, 4, 0.4f}},
                 {HDRP_ENV_CUBE, 19, 19, {16, 8, 0, 4, 0.4f}},
                 {HDRP_ENV_CUBE, 1, 1, {4, 4, 0, 1, 0.4f}},
                 {HDRP_ENV_LATLONG, 16, 9, {2, 2, 2, 1, 0.4f}},
                 {HDRP_ENV_LATLONG, 16, 8, {1, 1, 1, 1, 0.4f}}};
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        picture p = picture_make(cases[i].kind, cases[i].width, cases[i].height);
        hdrp_gpu_vk_env env = make_env(&cases[i].desc, VK_FORMAT_R32G32B32A32_SFLOAT);
        readback back;
        hdrp_env from_picture, from_radiance;
        void* memory[2];
        hdrp_env_sh sh;
        const hdrp_v4 *radiance, *harmonics;
        double off[4];
        paint_sky(&p, 7 + i);
        back = bake(&env, &p);
        radiance = gpu_map(&device, &back.radiance);
        from_picture = cpu_bake(&cases[i].desc, &p, NULL, &memory[0]);
        from_radiance = cpu_bake(&cases[i].desc, &p, radiance, &memory[1]);
        assert_int_equal(env.specular.size_px, from_picture.specular.size);
        assert_int_equal(env.specular.level_count, from_picture.specular.level_count);
        assert_int_equal(env.irradiance.size_px, from_picture.irradiance.size);
        off[0] = worst(radiance, from_picture.radiance.texels,
                       cube_texels(from_picture.radiance.size, 1), 1e4);
        off[1] =
            worst(radiance, from_radiance.radiance.texels,
                  cube_texels(env.desc.radiance_size, from_radiance.radiance.level_count), 0.0);
        off[2] = worst(gpu_map(&device, &back.specular), from_radiance.specular.texels,
                       cube_texels(env.specular.size_px, env.specular.level_count), 0.0);
        off[3] = worst(gpu_map(&device, &back.irradiance), from_radiance.irradiance.texels,
                       cube_texels(env.irradiance.size_px, 1), 0.0);
        printf("%3u x %3u: resampled within %.2g, reduced %.2g, specular %.2g, irradiance %.2g\n",
               cases[i].width, cases[i].height, off[0], off[1], off[2], off[3]);
        assert_true(off[0] <= 2e-4 && off[1] <= 1e-5 && off[2] <= 1e-5 && off[3] <= 1e-5);
        assert_int_equal(hdrp_env_project_sh(&from_radiance, &sh), HDRP_OK);
        harmonics = gpu_map(&device, &back.sh);
        assert_true(worst(harmonics, &sh.mean, 9, (double)sh.mean.x) <= 1e-5);
        for (int k = 0; k < 9; ++k) {
            assert_true(harmonics[k].w == 0.0f);
        }
        gpu_unmap(&device, &back.radiance);
        gpu_unmap(&device, &back.specular);
        gpu_unmap(&device, &back.irradiance);
        gpu_unmap(&device, &back.sh);
        readback_destroy(&back);
        hdrp_gpu_vk_env_destroy(&gpu, &env);
        picture_destroy(&p);
        free(memory[0]);
        free(memory[1]);
    }
}

static void a_constant_sky_stays_constant(void** state)
{
    const hdrp_env_desc desc = {16, 16, 0, 4, 0.0f};
    (void)state;
    for (int kind = 0; kind < 2; ++kind) {
        picture p =
            kind ? picture_make(HDRP_ENV_CUBE, 7, 7) : picture_make(HDRP_ENV_LATLONG, 50, 23);
        hdrp_gpu_vk_env env = make_env(&desc, VK_FORMAT_R16G16B16A16_SFLOAT);
        readback back;
        const uint16_t* halves;
        const float* radiance;
        paint(&p, 1.0f, 0.5f, 3.0f);
        back = bake(&env, &p);
        radiance = gpu_map(&device, &back.radiance);
        for (size_t i = 0; i < cube_texels(16, 1); ++i) {
            assert_true(radiance[4 * i] == 1.0f && radiance[4 * i + 1] == 0.5f);
            assert_true(radiance[4 * i + 2] == 3.0f);
        }
        halves = gpu_map(&device, &back.specular);
        for (size_t i = 0; i < cube_texels(16, env.specular.level_count); ++i) {
            assert_true(half_to_float(halves[4 * i]) == 1.0f);
            assert_true(half_to_float(halves[4 * i + 1]) == 0.5f);
            assert_true(half_to_float(halves[4 * i + 2]) == 3.0f);
            assert_true(half_to_float(halves[4 * i + 3]) == 1.0f);
        }
        gpu_unmap(&device, &back.specular);
        gpu_unmap(&device, &back.radiance);
        readback_destroy(&back);
        hdrp_gpu_vk_env_destroy(&gpu, &env);
        picture_destroy(&p);
    }
}

/* A sun of one texel keeps its flux, is finite in halves, and what is no light is none. */
static void a_sun_is_finite_and_what_is_no_light_is_black(void** state)
{
    const hdrp_env_desc desc = {16, 16, 0, 4, 0.0f};
    picture p = picture_make(HDRP_ENV_LATLONG, 64, 32);
    hdrp_gpu_vk_env env = make_env(&desc, VK_FORMAT_R16G16B16A16_SFLOAT);
    readback back;
    const hdrp_v4* radiance;
    const uint16_t* halves;
    double flux = 0.0, expected;
    size_t sun = 9 * 64 + 17;
    int largest = 0;
    (void)state;
    paint(&p, 0.0f, 0.0f, 0.0f);
    p.texels[4 * sun] = 1e9f;
    p.texels[4] = NAN;
    p.texels[8] = -1e30f;
    p.texels[12] = -INFINITY;
    p.texels[4 * sun + 2] = INFINITY;
    back = bake(&env, &p);
    radiance = gpu_map(&device, &back.radiance);
    for (size_t i = 0; i < cube_texels(16, 1); ++i) {
        flux += (double)radiance[i].x * (double)radiance[i].w;
        assert_true(radiance[i].x >= 0.0f && radiance[i].z <= 1.0001e20f);
    }
    expected = 1e9 * (double)hdrp_env_latlong_solid_angle(9, 64, 32);
    printf("the flux of a sun: %.2g off\n", fabs(flux / expected - 1.0));
    assert_true(fabs(flux / expected - 1.0) < 1e-4);
    halves = gpu_map(&device, &back.specular);
    for (size_t i = 0; i < 4 * cube_texels(16, env.specular.level_count); ++i) {
        assert_true((halves[i] & 0x7fff) <= 0x7bff && halves[i] >> 15 == 0);
        largest += halves[i] == 0x7bff;
    }
    assert_true(largest > 10);
    gpu_unmap(&device, &back.specular);
    readback_destroy(&back);
    /* With an exposure it fits. */
    p.texels[4 * sun + 2] = 0.0f;
    p.on_gpu.nits_per_unit = 1e-6f;
    back = bake(&env, &p);
    halves = gpu_map(&device, &back.specular);
    for (size_t i = 0; i < 4 * cube_texels(16, env.specular.level_count); ++i) {
        assert_true(halves[i] < 0x7bff);
    }
    gpu_unmap(&device, &back.specular);
    readback_destroy(&back);
    hdrp_gpu_vk_env_destroy(&gpu, &env);
    picture_destroy(&p);
}

/* Parts in several frames make the bits of the whole. */
static void no_step_depends_on_the_split(void** state)
{
    const hdrp_env_desc desc = {16, 16, 0, 4, 0.0f};
    picture p = picture_make(HDRP_ENV_LATLONG, 40, 20);
    hdrp_gpu_vk_env env = make_env(&desc, VK_FORMAT_R32G32B32A32_SFLOAT);
    hdrp_gpu_vk_env split = make_env(&desc, VK_FORMAT_R32G32B32A32_SFLOAT);
    uint32_t levels = env.desc.specular_levels, frame = 0;
    readback whole, parts;
    VkCommandBuffer commands;
    (void)state;
    paint_sky(&p, 3);
    whole = bake(&env, &p);
    for (uint32_t row = 0; row < 96; row += 13, ++frame) {
        assert_int_equal(hdrp_gpu_vk_begin_frame(&gpu, frame % 2), HDRP_OK);
        commands = gpu_begin(&device);
        if (row == 0) {
            picture_upload(commands, &p);
        }
        assert_int_equal(hdrp_gpu_vk_env_resample(&gpu, commands, &split, &p.on_gpu, row,
                                                  row + 13 < 96 ? 13 : 96 - row),
                         HDRP_OK);
        gpu_run(&device);
    }
    commands = gpu_begin(&device);
    assert_int_equal(hdrp_gpu_vk_env_reduce(&gpu, commands, &split), HDRP_OK);
    for (uint32_t face = 0; face < 6 * levels; face += 4) {
        assert_int_equal(hdrp_gpu_vk_env_prefilter(&gpu, commands, &split, face,
                                                   face + 4 < 6 * levels ? 4 : 6 * levels - face),
                         HDRP_OK);
    }
    gpu_run(&device);
    assert_int_equal(hdrp_gpu_vk_begin_frame(&gpu, 0), HDRP_OK);
    commands = gpu_begin(&device);
    for (uint32_t face = 0; face < 6; face += 2) {
        assert_int_equal(hdrp_gpu_vk_env_convolve_irradiance(&gpu, commands, &split, face, 2),
                         HDRP_OK);
    }
    assert_int_equal(hdrp_gpu_vk_env_project_sh(&gpu, commands, &split), HDRP_OK);
    assert_int_equal(hdrp_gpu_vk_env_prefilter(&gpu, commands, &split, 6 * levels, 0), HDRP_OK);
    assert_int_equal(hdrp_gpu_vk_env_prefilter(&gpu, commands, &split, 3, 0), HDRP_OK);
    parts = read_env(commands, &split);
    gpu_run(&device);
    assert_memory_equal(gpu_map(&device, &whole.specular), gpu_map(&device, &parts.specular),
                        whole.specular.bytes);
    assert_memory_equal(gpu_map(&device, &whole.irradiance), gpu_map(&device, &parts.irradiance),
                        whole.irradiance.bytes);
    assert_memory_equal(gpu_map(&device, &whole.sh), gpu_map(&device, &parts.sh), whole.sh.bytes);
    gpu_unmap(&device, &whole.specular), gpu_unmap(&device, &parts.specular);
    gpu_unmap(&device, &whole.irradiance), gpu_unmap(&device, &parts.irradiance);
    gpu_unmap(&device, &whole.sh), gpu_unmap(&device, &parts.sh);
    readback_destroy(&whole);
    readback_destroy(&parts);
    hdrp_gpu_vk_env_destroy(&gpu, &env);
    hdrp_gpu_vk_env_destroy(&gpu, &split);
    picture_destroy(&p);
}

static void bad_environments_are_refused(void** state)
{
    const hdrp_env_desc good = {8, 8, 0, 4, 0.0f};
    hdrp_env_desc bad[8];
    picture p = picture_make(HDRP_ENV_LATLONG, 8, 4);
    hdrp_gpu_vk_env env = make_env(&good, VK_FORMAT_R16G16B16A16_SFLOAT), made = {0};
    hdrp_gpu_vk_env_image image;
    hdrp_gpu_vk_cube cube = {0};
    VkCommandBuffer commands = gpu_begin(&device);
    const VkFormat format = VK_FORMAT_R16G16B16A16_SFLOAT;
    (void)state;
    assert_int_equal(hdrp_gpu_vk_begin_frame(&gpu, 0), HDRP_OK);
    for (size_t i = 0; i < 8; ++i) {
        bad[i] = good;
    }
    bad[0].radiance_size = 12, bad[1].radiance_size = 8192, bad[2].specular_size = 16;
    bad[3].specular_levels = 5, bad[4].irradiance_size = 512, bad[5].opening = 0.01f;
    bad[6].opening = NAN, bad[7].specular_size = 3;
    for (size_t i = 0; i < 8; ++i) {
        void* memory = aligned_alloc(64, 64);
        hdrp_env cpu;
        assert_int_equal(hdrp_gpu_vk_env_create(&gpu, &bad[i], format, &made),
                         HDRP_ERROR_BAD_ARGUMENT);
        assert_int_equal(hdrp_env_init(&cpu, &bad[i], memory, 64), HDRP_ERROR_BAD_ARGUMENT);
        free(memory);
    }
    assert_int_equal(hdrp_gpu_vk_env_create(NULL, &good, format, &made), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_gpu_vk_env_create(&gpu, &good, format, NULL), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_gpu_vk_env_create(&gpu, &good, VK_FORMAT_R8G8B8A8_UNORM, &made),
                     HDRP_ERROR_UNSUPPORTED);
    assert_null(made.radiance.buffer);
    for (int i = 0; i < 6; ++i) {
        image = p.on_gpu;
        image.view = i == 0 ? VK_NULL_HANDLE : image.view;
        image.width_px = i == 1 ? 0 : image.width_px;
        image.height_px = i == 2 ? 16385 : image.height_px;
        image.kind = i == 3 ? HDRP_ENV_CUBE : i == 4 ? (hdrp_env_image_kind)2 : image.kind;
        image.nits_per_unit = i == 5 ? -1.0f : 1.0f;
        assert_int_equal(hdrp_gpu_vk_env_bake(&gpu, commands, &env, &image),
                         i == 0 ? HDRP_ERROR_NULL_POINTER : HDRP_ERROR_BAD_ARGUMENT);
    }
    image = p.on_gpu;
    assert_int_equal(hdrp_gpu_vk_env_bake(&gpu, commands, &made, &image), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_gpu_vk_env_bake(NULL, commands, &env, &image), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_gpu_vk_env_bake(&gpu, NULL, &env, &image), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_gpu_vk_env_bake(&gpu, commands, &env, NULL), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_gpu_vk_env_resample(&gpu, commands, &env, &image, 49, 0),
                     HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(hdrp_gpu_vk_env_resample(&gpu, commands, &env, &image, 1, 48),
                     HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(hdrp_gpu_vk_env_prefilter(&gpu, commands, &env, 13, 0),
                     HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(hdrp_gpu_vk_env_prefilter(&gpu, commands, &env, 1, 0xffffffffu),
                     HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(hdrp_gpu_vk_env_convolve_irradiance(&gpu, commands, &env, 6, 1),
                     HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(hdrp_gpu_vk_env_reduce(&gpu, commands, NULL), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_gpu_vk_env_project_sh(&gpu, commands, NULL), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(gpu.passes_recorded, 0);
    gpu.passes_recorded = gpu.desc.frame_passes - 5; /* one too few */
    assert_int_equal(hdrp_gpu_vk_env_bake(&gpu, commands, &env, &image),
                     HDRP_ERROR_OUT_OF_DEVICE_MEMORY);
    assert_int_equal(gpu.passes_recorded, gpu.desc.frame_passes - 5);
    gpu.passes_recorded = 0;
    assert_int_equal(hdrp_gpu_vk_cube_create(&gpu, format, 3, 1, 8, NULL, &cube),
                     HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(hdrp_gpu_vk_cube_create(&gpu, format, 4, 4, 8, NULL, &cube),
                     HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(hdrp_gpu_vk_cube_create(&gpu, format, 4, 0, 8, NULL, &cube),
                     HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(hdrp_gpu_vk_cube_create(&gpu, format, 4, 1, 0, NULL, &cube),
                     HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(hdrp_gpu_vk_cube_create(&gpu, format, 4, 1, 8, NULL, NULL),
                     HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_gpu_vk_cube_create(&gpu, VK_FORMAT_UNDEFINED, 4, 1, 8, NULL, &cube),
                     HDRP_ERROR_UNSUPPORTED);
    hdrp_gpu_vk_cube_destroy(&gpu, &cube);
    hdrp_gpu_vk_cube_destroy(&gpu, NULL);
    hdrp_gpu_vk_env_destroy(&gpu, NULL);
    hdrp_gpu_vk_env_destroy(&gpu, &made);
    gpu_run(&device);
    hdrp_gpu_vk_env_destroy(&gpu, &env);
    hdrp_gpu_vk_env_destroy(&gpu, &env);
    picture_destroy(&p);
}

/* ---- tone map -------------------------------------------------------------------------------- */

static hdrp_gpu_vk_image make_target(VkFormat format, uint32_t width, uint32_t height)
{
    hdrp_gpu_vk_image image;
    assert_int_equal(hdrp_gpu_vk_image_create(&gpu, format, width, height,
                                              VK_IMAGE_USAGE_STORAGE_BIT |
                                                  VK_IMAGE_USAGE_SAMPLED_BIT |
                                                  VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
                                              "shown", &image),
                     HDRP_OK);
    return image;
}

/* What the CPU shows of a channel, as the shader. */
static float shown_of(hdrp_v3 v, uint32_t x, uint32_t y, uint32_t c, float largest,
                      const hdrp_gpu_vk_tone_map* map)
{
    hdrp_v3 t =
        hdrp_tonemap(hdrp_v3_scale(v, map->exposure > 0.0f ? map->exposure : 1.0f), map->curve);
    float code = c == 0 ? t.x : c == 1 ? t.y : t.z;
    float noise =
        map->is_dithered ? hdrp_dither_from_hash(hdrp_hash3(x | y << 16, c, map->frame)) : 0.0f;
    code = map->is_linear ? code : hdrp_srgb_from_linear(code);
    return largest > 0.0f ? hdrp_dithered(code, largest, noise) : code;
}

static void what_is_shown_is_what_the_cpu_shows(void** state)
{
    static const uint32_t sizes[][2] = {{1, 1}, {67, 33}, {128, 5}};
    (void)state;
    for (uint32_t i = 0; i < 12; ++i) {
        uint32_t width = sizes[i % 3][0], height = sizes[i % 3][1];
        bool is_float = i % 4 == 3;
        picture p = picture_make(HDRP_ENV_LATLONG, width, height);
        hdrp_gpu_vk_image to = make_target(
            is_float ? VK_FORMAT_R32G32B32A32_SFLOAT : VK_FORMAT_R8G8B8A8_UNORM, width, height);
        hdrp_gpu_vk_buffer back = gpu_host_buffer(&gpu, (VkDeviceSize)16 * width * height);
        hdrp_gpu_vk_tone_map map = {.source = p.on_gpu.view,
                                    .layout = p.on_gpu.layout,
                                    .target = &to,
                                    .exposure = i % 2 ? 0.0f : 0.3f,
                                    .curve = i / 2 % 2,
                                    .is_linear = i / 4 % 2,
                                    .is_dithered = i / 3 % 2,
                                    .frame = i};
        VkCommandBuffer commands;
        const void* found;
        uint32_t next = 0;
        uint64_t seed = i;
        for (size_t k = 0; k < 4 * texel_count(&p); ++k) {
            p.texels[k] = (float)exp2(12.0 * random_number(&seed) - 9.0);
        }
        if (width > 1) {
            p.texels[0] = NAN, p.texels[1] = INFINITY, p.texels[2] = -1.0f, p.texels[3] = NAN;
            p.texels[4] = p.texels[5] = p.texels[6] = 0.0f;
            p.texels[8] = p.texels[9] = p.texels[10] = INFINITY;
        }
        assert_int_equal(hdrp_gpu_vk_begin_frame(&gpu, 0), HDRP_OK);
        commands = gpu_begin(&device);
        picture_upload(commands, &p);
        assert_int_equal(hdrp_gpu_vk_tone_map_record(&gpu, commands, &map), HDRP_OK);
        gpu_download(commands, &to, &back);
        gpu_run(&device);
        found = gpu_map(&device, &back);
        for (uint32_t k = 0; k < 4 * width * height; ++k) {
            uint32_t x = k / 4 % width, y = k / 4 / width, c = k % 4;
            const float* t = p.texels + k / 4 * 4;
            float expected = c == 3 ? hdrp_saturate(t[3])
                                    : shown_of(hdrp_v3_make(t[0], t[1], t[2]), x, y, c,
                                               is_float ? 0.0f : 255.0f, &map);
            if (is_float) {
                assert_true(fabsf(((const float*)found)[k] - expected) <= 2e-6f);
            } else {
                int code = ((const uint8_t*)found)[k];
                int off = abs(code - (int)(expected * 255.0f + 0.5f));
                assert_true(off <= 1);
                next += off != 0;
            }
        }
        assert_true(next <= 1 + width * height / 500);
        gpu_unmap(&device, &back);
        hdrp_gpu_vk_buffer_destroy(&gpu, &back);
        hdrp_gpu_vk_image_destroy(&gpu, &to);
        picture_destroy(&p);
    }
}

static void bad_tone_maps_are_refused(void** state)
{
    hdrp_gpu_vk_image to = make_target(VK_FORMAT_R8G8B8A8_UNORM, 4, 4), bad = to;
    picture p = picture_make(HDRP_ENV_LATLONG, 4, 4);
    const hdrp_gpu_vk_tone_map good = {
        .source = p.on_gpu.view, .layout = p.on_gpu.layout, .target = &to};
    hdrp_gpu_vk_tone_map map;
    VkCommandBuffer commands = gpu_begin(&device);
    (void)state;
    assert_int_equal(hdrp_gpu_vk_begin_frame(&gpu, 0), HDRP_OK);
    assert_int_equal(hdrp_gpu_vk_tone_map_record(NULL, commands, &good), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_gpu_vk_tone_map_record(&gpu, NULL, &good), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_gpu_vk_tone_map_record(&gpu, commands, NULL), HDRP_ERROR_NULL_POINTER);
    map = good, map.source = VK_NULL_HANDLE;
    assert_int_equal(hdrp_gpu_vk_tone_map_record(&gpu, commands, &map), HDRP_ERROR_NULL_POINTER);
    map = good, map.target = NULL;
    assert_int_equal(hdrp_gpu_vk_tone_map_record(&gpu, commands, &map), HDRP_ERROR_NULL_POINTER);
    for (int i = 0; i < 6; ++i) {
        map = good;
        map.curve = i == 0 ? 2 : 0;
        map.is_linear = i == 1 ? 2 : 0;
        map.is_dithered = i == 2 ? 2 : 0;
        map.exposure = i == 3 ? NAN : i == 4 ? -1.0f : 0.0f;
        bad.width_px = i == 5 ? 0 : 4;
        map.target = &bad;
        assert_int_equal(hdrp_gpu_vk_tone_map_record(&gpu, commands, &map),
                         HDRP_ERROR_BAD_ARGUMENT);
    }
    bad = to, bad.format = VK_FORMAT_R8G8B8A8_SRGB, map = good, map.target = &bad;
    assert_int_equal(hdrp_gpu_vk_tone_map_record(&gpu, commands, &map), HDRP_ERROR_UNSUPPORTED);
    assert_int_equal(gpu.passes_recorded, 0);
    gpu_run(&device);
    hdrp_gpu_vk_image_destroy(&gpu, &to);
    picture_destroy(&p);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(all_steps_are_those_of_the_cpu, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_constant_sky_stays_constant, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_sun_is_finite_and_what_is_no_light_is_black, set_up,
                                        tear_down),
        cmocka_unit_test_setup_teardown(no_step_depends_on_the_split, set_up, tear_down),
        cmocka_unit_test_setup_teardown(bad_environments_are_refused, set_up, tear_down),
        cmocka_unit_test_setup_teardown(what_is_shown_is_what_the_cpu_shows, set_up, tear_down),
        cmocka_unit_test_setup_teardown(bad_tone_maps_are_refused, set_up, tear_down),
    };
    int failed;
    if (!gpu_open(&device)) {
        return GPU_SKIPPED;
    }
    failed = cmocka_run_group_tests(tests, NULL, NULL);
    failed += device.messages != 0;
    gpu_close(&device);
    return failed;
}
