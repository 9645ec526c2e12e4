/* bench_record.c - times the recording of shadow maps: bench_record [--threads N] [--objects N]
 *     [--rounds N] [--chunks N]
 * SPDX-License-Identifier: MIT
 *
 * Three spots, and for each of them every object: its rows are made, pushed, and a box is drawn.
 * One thread records all of it, or threads record parts of it into secondary command buffers, which
 * are executed in order; what all ways draw is compared. All ways take turns, so that
 * whatever slows the machine down slows down all of them, and the median of the turns counts. Where
 * it has other work, the least says more, and cpu_ms: the time that processors had for the busiest
 * thread. The threads are those of this program: hdrp has none. */
#define HDRP_GPU_VK_IMPLEMENTATION
#define HDRP_SHADOW_IMPLEMENTATION
#include "hdrp_gpu_vk_shadow.h"

#include "bench_vk.h"

#include <omp.h>
#include <string.h>
#include <time.h>

#include "record_vert.h"

#define LIGHTS     3u
#define ATLAS_PX   2048u
#define CHUNKS_MAX 64u
#define ROUNDS_MAX 501u

enum { INLINE, ONE_THREAD, THREADS, WAY_COUNT };
static const char* const way_names[] = {"primary, one thread", "secondary, one thread",
                                        "secondary, threads"};

typedef struct object {
    hdrp_v3 corner; /* m, of a box along the axes */
    hdrp_v3 size;
} object;

static bench_vk vk;

static struct {
    /* Of each way, so that each frees its own: of the parts, and of the primary. */
    VkCommandPool pools[WAY_COUNT][LIGHTS * CHUNKS_MAX + 1u];
    VkCommandBuffer buffers[WAY_COUNT][LIGHTS * CHUNKS_MAX + 1u];
    VkImage atlas;
    VkDeviceMemory atlas_memory, read_memory;
    VkImageView view;
    VkBuffer read;
    VkRenderPass pass;
    VkFramebuffer framebuffer;
    VkPipelineLayout layout;
    VkPipeline pipeline;
} maps;

static object* objects;
static uint32_t object_count = 7000u, chunk_count = 4u, rounds = 51u, threads = 2u;
static hdrp_shadow_view views[LIGHTS];

static double seconds(clockid_t of)
{
    struct timespec t;
    clock_gettime(of, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* ---- the scene ------------------------------------------------------------------------------- */

static float random_float(void)
{
    static uint64_t state = 1u;
    state = state * 6364136223846793005u + 1442695040888963407u;
    return (float)(state >> 40) * 0x1p-24f;
}

static void make_scene(void)
{
    const hdrp_v3 white = {1.0f, 1.0f, 1.0f}, down = {0.1f, -1.0f, 0.2f};
    hdrp_shadow_request requests[LIGHTS];
    hdrp_u32x4 places[LIGHTS];
    uint32_t order[LIGHTS];
    objects = malloc(object_count * sizeof *objects);
    for (uint32_t i = 0u; i < object_count; ++i) {
        float s = 0.1f + 0.4f * random_float();
        objects[i].corner = hdrp_v3_make(40.0f * random_float() - 20.0f, 4.0f * random_float(),
                                         40.0f * random_float() - 20.0f);
        objects[i].size = hdrp_v3_make(s, s * (0.5f + random_float()), s);
    }
    for (uint32_t i = 0u; i < LIGHTS; ++i) {
        requests[i] = (hdrp_shadow_request){1.0f, 1024u, 1u, 0u, 0u};
    }
    if (hdrp_shadow_place(ATLAS_PX, 64u, requests, LIGHTS, order, places, NULL) != HDRP_OK) {
        exit(1);
    }
    for (uint32_t i = 0u; i < LIGHTS; ++i) {
        hdrp_v3 at = hdrp_v3_make(12.0f * (float)i - 12.0f, 18.0f, 0.0f);
        hdrp_light light = hdrp_light_spot(at, down, white, 60.0f, 0.6f, 0.9f);
        views[i] = hdrp_shadow_view_light(light, 0u, 0.2f, places[i],
                                          hdrp_shadow_settings_make(HDRP_SHADOW_FILTER_TENT_3, 1u));
    }
}

/* ---- Vulkan ---------------------------------------------------------------------------------- */

static uint32_t memory_type(uint32_t bits, VkMemoryPropertyFlags wanted)
{
    VkPhysicalDeviceMemoryProperties m;
    vkGetPhysicalDeviceMemoryProperties(vk.physical, &m);
    for (uint32_t i = 0u; i < m.memoryTypeCount; ++i) {
        if (bits >> i & 1u && (m.memoryTypes[i].propertyFlags & wanted) == wanted) {
            return i;
        }
    }
    fprintf(stderr, "bench_record: no memory\n");
    exit(1);
}

static VkDeviceMemory allocate(VkMemoryRequirements needs, VkMemoryPropertyFlags wanted)
{
    const VkMemoryAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                       .allocationSize = needs.size,
                                       .memoryTypeIndex =
                                           memory_type(needs.memoryTypeBits, wanted)};
    VkDeviceMemory memory;
    VK(vkAllocateMemory(vk.device, &info, NULL, &memory));
    return memory;
}

static void make_buffers(int way, uint32_t family)
{
    uint32_t parts = LIGHTS * chunk_count;
    for (uint32_t i = 0u; i <= parts; ++i) {
        const VkCommandPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                              .queueFamilyIndex = family};
        VkCommandBufferAllocateInfo buffer = {.sType =
                                                  VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                              .level = i < parts ? VK_COMMAND_BUFFER_LEVEL_SECONDARY
                                                                 : VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                              .commandBufferCount = 1u};
        VK(vkCreateCommandPool(vk.device, &pool, NULL, &maps.pools[way][i]));
        buffer.commandPool = maps.pools[way][i];
        VK(vkAllocateCommandBuffers(vk.device, &buffer, &maps.buffers[way][i]));
    }
}

static void open_device(void)
{
    bench_vk_open(&vk, VK_QUEUE_GRAPHICS_BIT);
    printf("# %s, %u objects, %u lights, %u threads, %u parts of a light, %u turns\n",
           vk.properties.deviceName, object_count, LIGHTS, threads, chunk_count, rounds);
    for (int way = 0; way < WAY_COUNT; ++way) {
        make_buffers(way, vk.family);
    }
}

/* The atlas, and memory to read it from. */
static void make_atlas(void)
{
    const VkImageCreateInfo image = {.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                                     .imageType = VK_IMAGE_TYPE_2D,
                                     .format = VK_FORMAT_D32_SFLOAT,
                                     .extent = {ATLAS_PX, ATLAS_PX, 1u},
                                     .mipLevels = 1u,
                                     .arrayLayers = 1u,
                                     .samples = VK_SAMPLE_COUNT_1_BIT,
                                     .usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT |
                                              VK_IMAGE_USAGE_TRANSFER_SRC_BIT};
    const VkBufferCreateInfo buffer = {.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
                                       .size = (VkDeviceSize)ATLAS_PX * ATLAS_PX * 4u,
                                       .usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT};
    VkImageViewCreateInfo view = {.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                  .viewType = VK_IMAGE_VIEW_TYPE_2D,
                                  .format = VK_FORMAT_D32_SFLOAT,
                                  .subresourceRange = {VK_IMAGE_ASPECT_DEPTH_BIT, 0u, 1u, 0u, 1u}};
    VkMemoryRequirements needs;
    VK(vkCreateImage(vk.device, &image, NULL, &maps.atlas));
    vkGetImageMemoryRequirements(vk.device, maps.atlas, &needs);
    maps.atlas_memory = allocate(needs, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
    VK(vkBindImageMemory(vk.device, maps.atlas, maps.atlas_memory, 0u));
    view.image = maps.atlas;
    VK(vkCreateImageView(vk.device, &view, NULL, &maps.view));
    VK(vkCreateBuffer(vk.device, &buffer, NULL, &maps.read));
    vkGetBufferMemoryRequirements(vk.device, maps.read, &needs);
    maps.read_memory =
        allocate(needs, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
    VK(vkBindBufferMemory(vk.device, maps.read, maps.read_memory, 0u));
}

static void make_pass(void)
{
    const VkAttachmentDescription depth = {.format = VK_FORMAT_D32_SFLOAT,
                                           .samples = VK_SAMPLE_COUNT_1_BIT,
                                           .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
                                           .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
                                           .finalLayout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL};
    const VkAttachmentReference reference = {0u, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL};
    const VkSubpassDescription subpass = {.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS,
                                          .pDepthStencilAttachment = &reference};
    const VkSubpassDependency after = {.srcSubpass = 0u,
                                       .dstSubpass = VK_SUBPASS_EXTERNAL,
                                       .srcStageMask = VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT,
                                       .dstStageMask = VK_PIPELINE_STAGE_TRANSFER_BIT,
                                       .srcAccessMask =
                                           VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT,
                                       .dstAccessMask = VK_ACCESS_TRANSFER_READ_BIT};
    const VkRenderPassCreateInfo pass = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO,
                                         .attachmentCount = 1u,
                                         .pAttachments = &depth,
                                         .subpassCount = 1u,
                                         .pSubpasses = &subpass,
                                         .dependencyCount = 1u,
                                         .pDependencies = &after};
    VkFramebufferCreateInfo framebuffer = {.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO,
                                           .attachmentCount = 1u,
                                           .pAttachments = &maps.view,
                                           .width = ATLAS_PX,
                                           .height = ATLAS_PX,
                                           .layers = 1u};
    VK(vkCreateRenderPass(vk.device, &pass, NULL, &maps.pass));
    framebuffer.renderPass = maps.pass;
    VK(vkCreateFramebuffer(vk.device, &framebuffer, NULL, &maps.framebuffer));
}

static void make_pipeline(void)
{
    const VkPushConstantRange range = {VK_SHADER_STAGE_VERTEX_BIT, 0u, 64u};
    const VkPipelineLayoutCreateInfo layout = {.sType =
                                                   VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                               .pushConstantRangeCount = 1u,
                                               .pPushConstantRanges = &range};
    const VkShaderModuleCreateInfo code = {.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                                           .codeSize = sizeof record_vert,
                                           .pCode = record_vert};
    VkPipelineShaderStageCreateInfo stage = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
        .stage = VK_SHADER_STAGE_VERTEX_BIT,
        .pName = "main"};
    const VkPipelineVertexInputStateCreateInfo input = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
    const VkPipelineInputAssemblyStateCreateInfo assembly = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO,
        .topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST};
    const VkPipelineViewportStateCreateInfo viewport = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO,
        .viewportCount = 1u,
        .scissorCount = 1u};
    hdrp_gpu_vk_shadow_raster raster = hdrp_gpu_vk_shadow_raster_of(&views[0]);
    const VkPipelineRasterizationStateCreateInfo rasterization = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO,
        .depthClampEnable = raster.depth_clamp,
        .depthBiasEnable = raster.depth_bias,
        .lineWidth = 1.0f};
    const VkPipelineMultisampleStateCreateInfo samples = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO,
        .rasterizationSamples = VK_SAMPLE_COUNT_1_BIT};
    const VkPipelineDepthStencilStateCreateInfo depth = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO,
        .depthTestEnable = VK_TRUE,
        .depthWriteEnable = VK_TRUE,
        .depthCompareOp = raster.compare};
    const VkDynamicState states[] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
    const VkPipelineDynamicStateCreateInfo dynamic = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO,
        .dynamicStateCount = 2u,
        .pDynamicStates = states};
    VkGraphicsPipelineCreateInfo info = {.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO,
                                         .stageCount = 1u,
                                         .pVertexInputState = &input,
                                         .pInputAssemblyState = &assembly,
                                         .pViewportState = &viewport,
                                         .pRasterizationState = &rasterization,
                                         .pMultisampleState = &samples,
                                         .pDepthStencilState = &depth,
                                         .pDynamicState = &dynamic};
    VK(vkCreatePipelineLayout(vk.device, &layout, NULL, &maps.layout));
    VK(vkCreateShaderModule(vk.device, &code, NULL, &stage.module));
    info.pStages = &stage;
    info.layout = maps.layout;
    info.renderPass = maps.pass;
    VK(vkCreateGraphicsPipelines(vk.device, VK_NULL_HANDLE, 1u, &info, NULL, &maps.pipeline));
    vkDestroyShaderModule(vk.device, stage.module, NULL);
}

/* ---- recording ------------------------------------------------------------------------------- */

/* A row of the projection of the unit box that an object is. */
static hdrp_v4 row_of(hdrp_v4 row, const object* o)
{
    hdrp_v3 a = hdrp_v3_from_v4(row);
    return hdrp_v4_from_v3(hdrp_v3_mul(a, o->size), hdrp_v3_dot(a, o->corner) + row.w);
}

/* The objects of a part of a light, with all the state that a command buffer begins with. */
static void record_part(VkCommandBuffer commands, uint32_t light, uint32_t first, uint32_t last)
{
    const hdrp_shadow_view* v = &views[light];
    hdrp_gpu_vk_shadow_raster raster = hdrp_gpu_vk_shadow_raster_of(v);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, maps.pipeline);
    vkCmdSetViewport(commands, 0u, 1u, &raster.viewport);
    vkCmdSetScissor(commands, 0u, 1u, &raster.scissor);
    for (uint32_t i = first; i < last; ++i) {
        const hdrp_v4 rows[4] = {row_of(v->clip_x, &objects[i]), row_of(v->clip_y, &objects[i]),
                                 row_of(v->clip_z, &objects[i]), row_of(v->clip_w, &objects[i])};
        vkCmdPushConstants(commands, maps.layout, VK_SHADER_STAGE_VERTEX_BIT, 0u, sizeof rows,
                           rows);
        vkCmdDraw(commands, 36u, 1u, 0u, 0u);
    }
}

/* A secondary command buffer, and nothing that another thread touches. */
static void record_secondary(int way, uint32_t part)
{
    const VkCommandBufferInheritanceInfo inherited = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_INHERITANCE_INFO,
        .renderPass = maps.pass,
        .framebuffer = maps.framebuffer};
    const VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                            .flags =
                                                VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT |
                                                VK_COMMAND_BUFFER_USAGE_RENDER_PASS_CONTINUE_BIT,
                                            .pInheritanceInfo = &inherited};
    uint32_t light = part / chunk_count, k = part % chunk_count;
    uint64_t n = object_count;
    VkCommandBuffer commands = maps.buffers[way][part];
    VK(vkResetCommandPool(vk.device, maps.pools[way][part], 0u));
    VK(vkBeginCommandBuffer(commands, &begin));
    record_part(commands, light, (uint32_t)(n * k / chunk_count),
                (uint32_t)(n * (k + 1u) / chunk_count));
    VK(vkEndCommandBuffer(commands));
}

/* Time of the processors [s]: that of the busiest thread, and of what follows it. */
static double record(int way)
{
    const VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                            .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    const VkClearValue cleared = {.depthStencil = hdrp_gpu_vk_shadow_raster_of(&views[0]).far_away};
    const VkRenderPassBeginInfo pass = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
                                        .renderPass = maps.pass,
                                        .framebuffer = maps.framebuffer,
                                        .renderArea = {{0, 0}, {ATLAS_PX, ATLAS_PX}},
                                        .clearValueCount = 1u,
                                        .pClearValues = &cleared};
    uint32_t parts = LIGHTS * chunk_count;
    VkCommandBuffer primary = maps.buffers[way][parts];
    double begun = seconds(CLOCK_THREAD_CPUTIME_ID), longest = 0.0;
    if (way != INLINE) {
#pragma omp parallel num_threads(way == THREADS ? (int)threads : 1) reduction(max : longest)
        {
            double own = seconds(CLOCK_THREAD_CPUTIME_ID);
            /* Always the same parts: what a thread has allocated it frees, too. */
#pragma omp for schedule(static)
            for (uint32_t i = 0u; i < parts; ++i) {
                record_secondary(way, i);
            }
            longest = seconds(CLOCK_THREAD_CPUTIME_ID) - own;
        }
        begun = seconds(CLOCK_THREAD_CPUTIME_ID);
    }
    VK(vkResetCommandPool(vk.device, maps.pools[way][parts], 0u));
    VK(vkBeginCommandBuffer(primary, &begin));
    vkCmdBeginRenderPass(primary, &pass,
                         way == INLINE ? VK_SUBPASS_CONTENTS_INLINE
                                       : VK_SUBPASS_CONTENTS_SECONDARY_COMMAND_BUFFERS);
    for (uint32_t light = 0u; way == INLINE && light < LIGHTS; ++light) {
        record_part(primary, light, 0u, object_count);
    }
    if (way != INLINE) {
        vkCmdExecuteCommands(primary, parts, maps.buffers[way]);
    }
    vkCmdEndRenderPass(primary);
    return longest + seconds(CLOCK_THREAD_CPUTIME_ID) - begun;
}

/* Draws what was recorded; a sum over the bits of the atlas, and how many texels were drawn. */
static uint64_t draw(int way, uint32_t* drawn)
{
    const VkBufferImageCopy all = {.imageSubresource = {VK_IMAGE_ASPECT_DEPTH_BIT, 0u, 0u, 1u},
                                   .imageExtent = {ATLAS_PX, ATLAS_PX, 1u}};
    VkSubmitInfo submit = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO, .commandBufferCount = 1u};
    VkCommandBuffer primary = maps.buffers[way][LIGHTS * chunk_count];
    const uint32_t* texels;
    void* memory;
    uint64_t sum = 0u;
    (void)record(way);
    vkCmdCopyImageToBuffer(primary, maps.atlas, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, maps.read, 1u,
                           &all);
    VK(vkEndCommandBuffer(primary));
    submit.pCommandBuffers = &primary;
    VK(vkQueueSubmit(vk.queue, 1u, &submit, VK_NULL_HANDLE));
    VK(vkQueueWaitIdle(vk.queue));
    VK(vkMapMemory(vk.device, maps.read_memory, 0u, VK_WHOLE_SIZE, 0u, &memory));
    texels = memory;
    *drawn = 0u;
    for (uint32_t i = 0u; i < ATLAS_PX * ATLAS_PX; ++i) {
        sum = sum * 31u + texels[i];
        *drawn += texels[i] != 0u;
    }
    vkUnmapMemory(vk.device, maps.read_memory);
    return sum;
}

static int by_size(const void* a, const void* b)
{
    double x = *(const double*)a, y = *(const double*)b;
    return (x > y) - (x < y);
}

static double turns[2][WAY_COUNT][ROUNDS_MAX]; /* ms: by the clock, and of processors */

static void measure(void)
{
    double ms[2][WAY_COUNT];
    for (uint32_t i = 0u; i < rounds; ++i) {
        for (uint32_t k = 0u; k < WAY_COUNT; ++k) {
            int way = (int)((i + k) % WAY_COUNT);
            double begin = seconds(CLOCK_MONOTONIC);
            turns[1][way][i] = 1e3 * record(way);
            VK(vkEndCommandBuffer(maps.buffers[way][LIGHTS * chunk_count]));
            turns[0][way][i] = 1e3 * (seconds(CLOCK_MONOTONIC) - begin);
        }
    }
    puts("way,ms,least_ms,cpu_ms,least_cpu_ms");
    for (int way = 0; way < WAY_COUNT; ++way) {
        for (int k = 0; k < 2; ++k) {
            qsort(turns[k][way], rounds, sizeof(double), by_size);
            ms[k][way] = turns[k][way][rounds / 2u];
        }
        printf("\"%s\",%.2f,%.2f,%.2f,%.2f\n", way_names[way], ms[0][way], turns[0][way][0],
               ms[1][way], turns[1][way][0]);
    }
    printf("# threads take %.2f of the time of one that records the same, and at their best %.2f\n",
           ms[0][THREADS] / ms[0][ONE_THREAD], turns[0][THREADS][0] / turns[0][ONE_THREAD][0]);
}

static uint32_t number(const char* text, uint32_t limit)
{
    long n = strtol(text, NULL, 10);
    return n < 1 ? 1u : n > (long)limit ? limit : (uint32_t)n;
}

int main(int argc, char** argv)
{
    uint64_t sums[WAY_COUNT];
    uint32_t drawn = 0u;
    threads = (uint32_t)omp_get_num_procs();
    for (int i = 1; i + 1 < argc; i += 2) {
        if (strcmp(argv[i], "--threads") == 0) {
            threads = number(argv[i + 1], 256u);
        } else if (strcmp(argv[i], "--objects") == 0) {
            object_count = number(argv[i + 1], 1000000u);
        } else if (strcmp(argv[i], "--rounds") == 0) {
            rounds = number(argv[i + 1], ROUNDS_MAX);
        } else if (strcmp(argv[i], "--chunks") == 0) {
            chunk_count = number(argv[i + 1], CHUNKS_MAX);
        }
    }
    make_scene();
    open_device();
    make_atlas();
    make_pass();
    make_pipeline();
    for (int way = 0; way < WAY_COUNT; ++way) {
        sums[way] = draw(way, &drawn);
        if (sums[way] != sums[0] || drawn == 0u) {
            fprintf(stderr, "bench_record: %s draws something else\n", way_names[way]);
            return 1;
        }
    }
    printf("# all ways draw the same %u texels\n", drawn);
    measure();
    return 0;
}
