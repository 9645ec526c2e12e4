/* vk_minimal.c - lists of lights and deferred lighting, recorded into a command buffer of ours.
 * SPDX-License-Identifier: MIT
 *
 * Four materials on a wall below the sky, in a GBuffer that the host encodes. Fails where a pixel
 * is not what the same headers compute on the CPU; exit status 77: no device can do it. */
#define HDRP_CULL_IMPLEMENTATION
#define HDRP_GPU_VK_IMPLEMENTATION
#include "hdrp_gpu_vk.h"

#include <stdio.h>
#include <stdlib.h>

enum { WIDTH = 64, HEIGHT = 48, PIXELS = WIDTH * HEIGHT, TILE = 16, LIGHTS = 16 };
enum { DEPTH = 4, COLOR, IMAGES }; /* behind RT0 to RT3 */
static const hdrp_v3 forward = {0.0f, 0.0f, -1.0f}, up = {0.0f, 1.0f, 0.0f};

/* What host and device share, in one buffer; arrays begin at multiples of 256 bytes. */
typedef struct shared {
    uint32_t texels[COLOR][PIXELS]; /* RT0 to RT3, and depths in metres */
    hdrp_v4 lit[PIXELS];            /* the sky; comes back */
    hdrp_light lights[LIGHTS];
    hdrp_cull_shape shapes[LIGHTS];
    char params[HDRP_GPU_VK_LIGHTING_BYTES]; /* for the device alone */
} shared;

#define CHECK(call)                                                                                \
    if ((call) != 0) {                                                                             \
        fprintf(stderr, "vk_minimal: %s failed\n", #call), exit(1);                                \
    }

/* What an engine has already: a device, one queue that computes, a command buffer. */
static const VkPhysicalDeviceFeatures features = {.shaderStorageImageWriteWithoutFormat = VK_TRUE};
static hdrp_gpu_vk_desc desc; /* has the device */
static VkQueue queue;
static VkCommandPool pool;
static VkCommandBuffer commands;

static int open_device(void)
{
    VkApplicationInfo app = {.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO};
    VkInstanceCreateInfo of_instance = {.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
    VkDeviceQueueCreateInfo of_queue = {.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
    VkDeviceCreateInfo of_device = {.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO};
    VkCommandPoolCreateInfo of_pool = {.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
    VkCommandBufferAllocateInfo buffer = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
    uint32_t count = 1;
    app.apiVersion = VK_API_VERSION_1_1, of_instance.pApplicationInfo = &app;
    of_queue.queueCount = of_device.queueCreateInfoCount = 1; /* family 0 computes */
    of_queue.pQueuePriorities = &(float){1.0f};
    of_device.pQueueCreateInfos = &of_queue, of_device.pEnabledFeatures = &features;
    if (vkCreateInstance(&of_instance, NULL, &desc.instance) ||
        vkEnumeratePhysicalDevices(desc.instance, &count, &desc.physical_device) < 0 ||
        count == 0 || vkCreateDevice(desc.physical_device, &of_device, NULL, &desc.device) ||
        vkCreateCommandPool(desc.device, &of_pool, NULL, &pool)) {
        return 0;
    }
    vkGetDeviceQueue(desc.device, 0, 0, &queue);
    buffer.commandPool = pool, buffer.commandBufferCount = 1;
    return vkAllocateCommandBuffers(desc.device, &buffer, &commands) == VK_SUCCESS;
}

/* What comes later, of the host too, sees what was before; an image changes its layout. */
static void order(VkImage image, VkImageLayout before, VkImageLayout after)
{
    const VkPipelineStageFlags all = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT;
    VkMemoryBarrier m = {VK_STRUCTURE_TYPE_MEMORY_BARRIER, NULL, VK_ACCESS_MEMORY_WRITE_BIT,
                         VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT};
    VkImageMemoryBarrier b = {.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER};
    b.srcAccessMask = m.srcAccessMask, b.dstAccessMask = m.dstAccessMask;
    b.oldLayout = before, b.newLayout = after, b.image = image;
    b.subresourceRange = (VkImageSubresourceRange){VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    vkCmdPipelineBarrier(commands, all, all | VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &m, 0, NULL, 1, &b);
}

/* Plastic, gold and both with a coat of lacquer, 5 m away; lights between them and the eye. */
static void make_scene(shared* s)
{
    for (uint32_t i = 0; i < PIXELS; ++i) {
        uint32_t column = i % WIDTH / 16;
        hdrp_brdf_surface m = hdrp_brdf_surface_default();
        m.base_color = hdrp_v3_make(0.9f, column & 1 ? 0.7f : 0.2f, 0.1f);
        m.normal = m.coat_normal = hdrp_v3_neg(forward), m.coat_mask = 1.0f;
        m.metallic = (float)(column & 1);
        m.features = column & 2 ? HDRP_BRDF_FEATURE_CLEAR_COAT : 0u;
        hdrp_pack_gbuffer_texel t = hdrp_pack_gbuffer_texel_from_targets(
            hdrp_pack_gbuffer_encode(hdrp_brdf_data_from_surface(m), (hdrp_pack_gbuffer_extra){0}));
        s->texels[0][i] = t.rt0, s->texels[1][i] = t.rt1, s->texels[2][i] = t.rt2;
        s->texels[3][i] = t.rt3, s->lit[i] = hdrp_v4_make(0.25f, 0.5f, 1.0f, 1.0f);
        s->texels[DEPTH][i] = hdrp_bits_from_f32(i / WIDTH < TILE ? 1e9f : 5.0f);
    }
    for (uint32_t i = 0; i < LIGHTS; ++i) {
        hdrp_v3 at = hdrp_v3_make(0.4f * (float)i - 3.0f, 0.5f - 0.2f * (float)(i % 8), -4.0f);
        s->lights[i] = i % 2 ? hdrp_light_spot(at, forward, hdrp_v3_splat(20.0f), 2.0f, 0.3f, 0.6f)
                             : hdrp_light_point(at, hdrp_v3_splat(20.0f), 2.0f);
        s->shapes[i] = hdrp_cull_shape_from_light(s->lights[i]);
    }
}

/* A pixel on the CPU: every light, no lists. The eye is at the origin. */
static hdrp_v3 shade(const shared* s, hdrp_cull_camera camera, uint32_t x, uint32_t y)
{
    uint32_t i = y * WIDTH + x;
    hdrp_pack_gbuffer_texel t = {
        s->texels[0][i], s->texels[1][i], s->texels[2][i], s->texels[3][i], 0, 0};
    hdrp_brdf_data d = hdrp_pack_gbuffer_decode(hdrp_pack_gbuffer_targets_from_texel(t), 0);
    hdrp_v3 place =
        hdrp_cull_offset_of_pixel(camera, (float)x + 0.5f, (float)y + 0.5f, WIDTH, HEIGHT, 5.0f);
    hdrp_v3 v = hdrp_cull_direction_to_eye(camera, place), sum = hdrp_v3_splat(0.0f);
    float n_dot_v = hdrp_saturate(hdrp_v3_dot(d.normal, v));
    hdrp_brdf_fgd fgd = hdrp_brdf_fgd_fast(n_dot_v, d.perceptual_roughness);
    hdrp_brdf_lit_view w = hdrp_brdf_lit_view_make(d, v, fgd, d.features);
    for (i = 0; i < LIGHTS; ++i) {
        hdrp_light_incident in = hdrp_light_eval(s->lights[i], place);
        hdrp_brdf_lit lit = hdrp_brdf_lit_eval(d, w, in.l, d.features);
        sum = hdrp_v3_add(sum, hdrp_v3_mul(in.illuminance, hdrp_v3_add(lit.diffuse, lit.specular)));
    }
    return sum;
}

int main(void)
{
    const VkFormat format[IMAGES] = {VK_FORMAT_R8G8B8A8_SRGB,  VK_FORMAT_R8G8B8A8_UNORM,
                                     VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_B10G11R11_UFLOAT_PACK32,
                                     VK_FORMAT_R32_SFLOAT,     VK_FORMAT_R32G32B32A32_SFLOAT};
    const uint32_t words[] = {HDRP_GPU_VK_WORD_LIT | HDRP_GPU_VK_WORD_LIGHTS, HDRP_GPU_VK_WORD_ALL};
    const hdrp_cull_desc sizes = {WIDTH, HEIGHT, TILE, TILE, 1, LIGHTS, 0, HDRP_CULL_PIXELS, 0, 0};
    const VkFlags move = VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    VkFlags any = move | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT;
    const VkFlags host = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    const VkImageLayout general = VK_IMAGE_LAYOUT_GENERAL;
    const VkImageLayout shown = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    const VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    const VkSubmitInfo submit = {VK_STRUCTURE_TYPE_SUBMIT_INFO, 0, 0, 0, 0, 1, &commands, 0, 0};
    VkBufferImageCopy copy = {
        0, 0, 0, {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1}, {0}, {WIDTH, HEIGHT, 1}};
    hdrp_gpu_vk_cull_frame frame = {0};
    hdrp_gpu_vk_lighting l = {0};
    hdrp_gpu_vk_lit target = {0};
    hdrp_gpu_vk_image image[IMAGES];
    hdrp_gpu_vk_buffer buffer;
    hdrp_gpu_vk_lists lists;
    hdrp_gpu_vk_tiles tiles;
    hdrp_gpu_vk_variants variants;
    hdrp_gpu_vk gpu;
    float worst = 0.0f;
    shared* s;
    desc.get_instance_proc_addr = vkGetInstanceProcAddr, desc.features = &features;
    desc.passes = HDRP_GPU_VK_PASS_LISTS | HDRP_GPU_VK_PASS_LIGHT;
    if (!open_device() || hdrp_gpu_vk_missing(&desc, 0)) { /* which names what it lacks */
        return puts("skipped: no Vulkan device that can do it"), 77;
    }
    CHECK(hdrp_gpu_vk_init(&gpu, &desc) || hdrp_gpu_vk_lists_create(&gpu, &sizes, &lists));
    CHECK(hdrp_gpu_vk_tiles_create(&gpu, lists.grid, &tiles));
    CHECK(hdrp_gpu_vk_variants_create(&gpu, words, 2, &variants));
    CHECK(hdrp_gpu_vk_buffer_create(&gpu, sizeof *s, any, host, "shared", &buffer));
    CHECK(vkMapMemory(desc.device, buffer.block.memory, 0, VK_WHOLE_SIZE, 0, (void**)&s));
    make_scene(s);
    CHECK(vkBeginCommandBuffer(commands, &begin));
    for (uint32_t k = 0; k < IMAGES; ++k) {
        VkFlags use = move | (k < COLOR ? VK_IMAGE_USAGE_SAMPLED_BIT : VK_IMAGE_USAGE_STORAGE_BIT);
        CHECK(hdrp_gpu_vk_image_create(&gpu, format[k], WIDTH, HEIGHT, use, NULL, &image[k]));
        copy.bufferOffset = k * sizeof s->texels[0];
        order(image[k].image, VK_IMAGE_LAYOUT_UNDEFINED, general);
        vkCmdCopyBufferToImage(commands, buffer.buffer, image[k].image, general, 1, &copy);
        order(image[k].image, general, k < COLOR ? shown : general);
        *(k < DEPTH ? &l.rt[k] : k < COLOR ? &l.depth : &target.color) = image[k].view;
    }
    frame.camera = hdrp_cull_camera_perspective(hdrp_v3_splat(0.0f), forward, up, -0.8f, 0.8f,
                                                -0.6f, 0.6f, 0.1f, 100.0f);
    frame.shapes = buffer.buffer, frame.shapes_offset = offsetof(shared, shapes);
    frame.count = LIGHTS, frame.view = l.depth, frame.layout = shown;
    CHECK(hdrp_gpu_vk_begin_frame(&gpu, 0) ||
          hdrp_gpu_vk_build_lists(&gpu, commands, &lists, &frame));
    l.params = buffer.buffer, l.params_offset = offsetof(shared, params), l.light_count = LIGHTS;
    l.lights.buffer = buffer.buffer, l.lights.offset = offsetof(shared, lights);
    l.width_px = WIDTH, l.height_px = HEIGHT, l.camera = lists.camera, l.grid = lists.grid;
    l.list_flags = lists.desc.flags, l.tiles.buffer = lists.tiles.buffer;
    l.cells.buffer = lists.cells.buffer, l.entries.buffer = lists.entries.buffer;
    CHECK(hdrp_gpu_vk_write_lighting(&gpu, commands, &l));
    CHECK(hdrp_gpu_vk_classify(&gpu, commands, &l, &variants, &tiles));
    CHECK(hdrp_gpu_vk_light_deferred(&gpu, commands, &l, &variants, &tiles, &target));
    vkCmdCopyImageToBuffer(commands, image[COLOR].image, general, buffer.buffer, 1, &copy);
    order(image[COLOR].image, general, general);
    CHECK(vkEndCommandBuffer(commands) || vkQueueSubmit(queue, 1, &submit, VK_NULL_HANDLE));
    CHECK(vkQueueWaitIdle(queue));
    for (uint32_t x = 8; x < WIDTH; x += 16) {
        hdrp_v3 nits = hdrp_v3_from_v4(s->lit[32 * WIDTH + x]), cpu = shade(s, frame.camera, x, 32);
        float off = hdrp_v3_length(hdrp_v3_sub(nits, cpu)) / hdrp_v3_length(cpu);
        worst = off <= worst ? worst : off;
        printf("%7.4f nits, off by %.4f\n", (double)hdrp_luminance(nits), (double)off);
    }
    for (int k = 0; k < IMAGES; ++k) {
        hdrp_gpu_vk_image_destroy(&gpu, &image[k]);
    }
    hdrp_gpu_vk_variants_destroy(&gpu, &variants), hdrp_gpu_vk_tiles_destroy(&gpu, &tiles);
    hdrp_gpu_vk_lists_destroy(&gpu, &lists), hdrp_gpu_vk_buffer_destroy(&gpu, &buffer);
    hdrp_gpu_vk_destroy(&gpu), vkDestroyCommandPool(desc.device, pool, NULL);
    vkDestroyDevice(desc.device, NULL), vkDestroyInstance(desc.instance, NULL);
    return !(worst <= 0.01f);
}
