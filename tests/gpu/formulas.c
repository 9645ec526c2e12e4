/* formulas.c - every formula on a Vulkan device and in C, on samples of the finite scan.
 * SPDX-License-Identifier: MIT
 *
 * formulas FOLDER [FUNCTION...]: FOLDER holds a shader FUNCTION.spv for each, see formulas.py.
 * Prints a table of how far the numbers of the results are from those of the C build; of functions
 * that are named, all arguments of the worst result too. */
#include "gpu_test.h"

#define main finite_scan_main
#include "../finite/finite_scan.c"
#undef main

#ifdef __SSE2__
#include <xmmintrin.h>
#endif

#define STRIDE          128u /* floats from call to call, as in tools/gcn_shaders.py */
#define GROUP           64u
#define CALLS           512u
#define FILE_BYTES      (1u << 20)
#define UNTOUCHED       0xa5a5a5a5u
#define SHOWN_ARGUMENTS 12 /* the most whose worst values the table shows */

/* Of every number of a result: the first bin whose limit is not below the distance in units in the
 * last place; no limit holds where one is NaN and the other is not, or integers differ. */
#define OTHER UINT64_MAX
static const struct {
    const char* name;
    uint64_t limit;
} bins[] = {{"equal", 0},       {"ulp_1", 1},          {"ulp_4", 4},        {"ulp_64", 64},
            {"ulp_1024", 1024}, {"beyond", OTHER - 1}, {"different", OTHER}};
#define BINS (sizeof bins / sizeof bins[0])

typedef struct comparison {
    uint64_t counts[BINS], far_off, denormals, worst;
    size_t worst_call, worst_leaf;
    uint32_t worst_device, worst_host;
} comparison;

typedef struct runner {
    gpu_device device;
    hdrp_gpu_vk gpu; /* for its buffers */
    hdrp_gpu_vk_buffer values, results;
    VkDescriptorSetLayout set_layout;
    VkPipelineLayout layout;
    VkDescriptorPool pool;
    VkDescriptorSet set;
    uint32_t words[FILE_BYTES / 4]; /* of a shader */
} runner;

static void runner_begin(runner* r)
{
    const VkDeviceSize bytes = (VkDeviceSize)CALLS * STRIDE * sizeof(float);
    const VkDescriptorSetLayoutBinding bindings[2] = {
        {0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, VK_SHADER_STAGE_COMPUTE_BIT, NULL},
        {1, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, VK_SHADER_STAGE_COMPUTE_BIT, NULL}};
    const VkDescriptorSetLayoutCreateInfo sets = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
        .bindingCount = 2,
        .pBindings = bindings};
    const VkPipelineLayoutCreateInfo layout = {.sType =
                                                   VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                               .setLayoutCount = 1,
                                               .pSetLayouts = &r->set_layout};
    const VkDescriptorPoolSize size = {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 2};
    const VkDescriptorPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                             .maxSets = 1,
                                             .poolSizeCount = 1,
                                             .pPoolSizes = &size};
    VkDescriptorSetAllocateInfo set = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                       .descriptorSetCount = 1,
                                       .pSetLayouts = &r->set_layout};
    const VkDevice d = r->device.device;
    hdrp_gpu_vk_desc desc = gpu_desc(&r->device);
    VkDescriptorBufferInfo buffers[2];
    VkWriteDescriptorSet write = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                  .descriptorCount = 2,
                                  .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                  .pBufferInfo = buffers};
    desc.passes = HDRP_GPU_VK_PASS_DEPTH;
    assert_int_equal(hdrp_gpu_vk_init(&r->gpu, &desc), HDRP_OK);
    r->values = gpu_host_buffer(&r->gpu, bytes);
    r->results = gpu_host_buffer(&r->gpu, bytes);
    buffers[0] = (VkDescriptorBufferInfo){r->values.buffer, 0, bytes};
    buffers[1] = (VkDescriptorBufferInfo){r->results.buffer, 0, bytes};
    assert_int_equal(vkCreateDescriptorSetLayout(d, &sets, NULL, &r->set_layout), VK_SUCCESS);
    assert_int_equal(vkCreatePipelineLayout(d, &layout, NULL, &r->layout), VK_SUCCESS);
    assert_int_equal(vkCreateDescriptorPool(d, &pool, NULL, &r->pool), VK_SUCCESS);
    set.descriptorPool = r->pool;
    assert_int_equal(vkAllocateDescriptorSets(d, &set, &r->set), VK_SUCCESS);
    write.dstSet = r->set;
    vkUpdateDescriptorSets(d, 1, &write, 0, NULL);
}

static void runner_end(runner* r)
{
    const VkDevice d = r->device.device;
    vkDestroyDescriptorPool(d, r->pool, NULL);
    vkDestroyPipelineLayout(d, r->layout, NULL);
    vkDestroyDescriptorSetLayout(d, r->set_layout, NULL);
    hdrp_gpu_vk_buffer_destroy(&r->gpu, &r->values);
    hdrp_gpu_vk_buffer_destroy(&r->gpu, &r->results);
    hdrp_gpu_vk_destroy(&r->gpu);
}

/* Calls the formula of a shader; what it takes and gives lies in the buffers. */
static void runner_call(runner* r, const uint32_t* words, size_t bytes)
{
    const VkDevice d = r->device.device;
    const VkShaderModuleCreateInfo code = {
        .sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO, .codeSize = bytes, .pCode = words};
    VkComputePipelineCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
        .stage = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                  .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                  .pName = "main"},
        .layout = r->layout};
    VkPipeline pipeline;
    VkCommandBuffer commands;
    assert_int_equal(vkCreateShaderModule(d, &code, NULL, &info.stage.module), VK_SUCCESS);
    assert_int_equal(vkCreateComputePipelines(d, VK_NULL_HANDLE, 1, &info, NULL, &pipeline),
                     VK_SUCCESS);
    commands = gpu_begin(&r->device);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, r->layout, 0, 1, &r->set, 0,
                            NULL);
    vkCmdDispatch(commands, CALLS / GROUP, 1, 1);
    gpu_run(&r->device);
    vkDestroyPipeline(d, pipeline, NULL);
    vkDestroyShaderModule(d, info.stage.module, NULL);
}

/* One line that names the device and the driver. */
static void print_driver(const gpu_device* d)
{
    VkPhysicalDeviceDriverProperties driver = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
    VkPhysicalDeviceProperties2 properties = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, .pNext = &driver};
    vkGetPhysicalDeviceProperties2(d->physical, &properties);
    printf("driver: %s, %s, %s\n", properties.properties.deviceName, driver.driverName,
           driver.driverInfo);
}

static size_t read_file(const char* folder, const char* name, void* bytes)
{
    char path[1024];
    FILE* file;
    size_t size;
    snprintf(path, sizeof path, "%s/%s.spv", folder, name);
    file = fopen(path, "rb");
    if (!file) {
        return 0;
    }
    size = fread(bytes, 1, FILE_BYTES, file);
    fclose(file);
    return size;
}

/* Floats in the order of their values, as integers: both zeros are 0. */
static int64_t rank(uint32_t bits)
{
    return bits >> 31 ? -(int64_t)(bits & 0x7fffffffu) : (int64_t)bits;
}

static bool is_nan(uint32_t bits)
{
    return (bits & 0x7fffffffu) > 0x7f800000u;
}

static uint64_t distance(uint32_t a, uint32_t b, fs_kind kind)
{
    if (a == b || (kind == FS_F32 && is_nan(a) && is_nan(b))) {
        return 0;
    }
    if (kind != FS_F32 || is_nan(a) || is_nan(b)) {
        return OTHER;
    }
    return (uint64_t)(rank(a) > rank(b) ? rank(a) - rank(b) : rank(b) - rank(a));
}

/* Copies the numbers of a value to a row of a buffer and returns where the next ones go. */
static size_t put_leaves(const fs_type* type, const void* value, uint32_t* row, size_t at)
{
    for (size_t i = 0; i < type->leaf_count; ++i) {
        memcpy(&row[at + i], (const unsigned char*)value + type->leaves[i].offset, 4);
    }
    return at + type->leaf_count;
}

/* A device may take denormals for 0 and may return 0 for them. Where the processor can do the same,
 * the C build is asked twice. */
static void flush_denormals(bool is_on)
{
#ifdef __SSE2__
    const unsigned flush = 0x8040; /* FTZ and DAZ */
    _mm_setcsr(is_on ? _mm_getcsr() | flush : _mm_getcsr() & ~flush);
#else
    (void)is_on;
#endif
}

static uint32_t expected[CALLS][STRIDE], flushed[CALLS][STRIDE];

/* Fills the rows of arguments and of results that are expected; returns how many there are. */
static size_t call_host(const fs_function* f, uint32_t* values)
{
    uint64_t storage[MAX_BYTES / sizeof(uint64_t)];
    walk w = walk_begin(f, CALLS);
    size_t calls = 0;
    while (walk_next(&w)) {
        size_t at = 0;
        if (f->is_required && !f->is_required(w.arguments)) {
            continue;
        }
        for (size_t i = 0; i < f->argument_count; ++i) {
            at = put_leaves(f->arguments[i].type, w.arguments[i], values + calls * STRIDE, at);
        }
        f->call(w.arguments, storage);
        put_leaves(f->result, storage, expected[calls], 0);
        flush_denormals(true);
        f->call(w.arguments, storage);
        flush_denormals(false);
        put_leaves(f->result, storage, flushed[calls++], 0);
    }
    return calls;
}

/* More than Vulkan lets a sine be off, with as much again for what is done to it: 2^-11 each,
 * absolute for numbers below 1 and relative above. */
static bool is_far(uint32_t device, uint32_t host)
{
    float a, b;
    memcpy(&a, &device, sizeof a);
    memcpy(&b, &host, sizeof b);
    return !(fabs((double)a - (double)b) <= ldexp(fmax(fabs((double)b), 1.0), -10));
}

static void count(comparison* c, const fs_function* f, size_t call, size_t leaf, uint32_t device)
{
    const fs_kind kind = f->result->leaves[leaf].kind;
    const uint64_t off = distance(device, expected[call][leaf], kind);
    const uint64_t off_flushed = distance(device, flushed[call][leaf], kind);
    const uint64_t least = off_flushed < off ? off_flushed : off;
    const uint32_t host = off_flushed < off ? flushed[call][leaf] : expected[call][leaf];
    size_t bin = 0;
    while (least > bins[bin].limit) {
        ++bin;
    }
    c->counts[bin]++;
    c->far_off += bins[bin].limit == OTHER || (bins[bin].limit > 1024 && is_far(device, host));
    c->denormals += off_flushed < off;
    if (least > c->worst) {
        c->worst = least;
        c->worst_call = call;
        c->worst_leaf = leaf;
        c->worst_device = device;
        c->worst_host = host;
    }
}

static void print_number(fs_kind kind, uint32_t bits)
{
    float x;
    memcpy(&x, &bits, sizeof x);
    if (kind == FS_F32) {
        printf(is_nan(bits) ? "nan" : "%.9g", (double)x);
    } else {
        printf("%lu", (unsigned long)bits);
    }
}

/* The arguments of a call, in one field of a table. */
static void print_row(const fs_function* f, const uint32_t* row, const char* between)
{
    for (size_t i = 0; i < f->argument_count; ++i) {
        const fs_argument* a = &f->arguments[i];
        for (size_t k = 0; k < a->type->leaf_count; ++k) {
            const char* leaf = a->type->leaves[k].name;
            printf("%s%s%s%s ", i + k ? between : "", a->name, leaf[0] ? "." : "", leaf);
            print_number(a->type->leaves[k].kind, *row++);
        }
    }
}

static void print_worst(const fs_function* f, const comparison* c, const uint32_t* values,
                        bool is_verbose)
{
    const fs_leaf* leaf = &f->result->leaves[c->worst_leaf];
    size_t arguments = 0;
    for (size_t i = 0; i < f->argument_count; ++i) {
        arguments += f->arguments[i].type->leaf_count;
    }
    printf("%s%s", leaf->name, leaf->name[0] ? " " : "");
    print_number(leaf->kind, c->worst_device);
    printf(" for ");
    print_number(leaf->kind, c->worst_host);
    printf(" at ");
    if (arguments > SHOWN_ARGUMENTS && !is_verbose) {
        printf("call %lu", (unsigned long)c->worst_call);
    } else {
        print_row(f, values + c->worst_call * STRIDE, is_verbose ? "\n  " : "; ");
    }
}

static void print_comparison(const fs_function* f, const comparison* c, const uint32_t* values,
                             bool is_verbose)
{
    uint64_t total = 0;
    for (size_t i = 0; i < BINS; ++i) {
        total += c->counts[i];
    }
    printf("%s,%llu", f->name, (unsigned long long)total);
    for (size_t i = 0; i < BINS; ++i) {
        printf(",%llu", (unsigned long long)c->counts[i]);
    }
    printf(",%llu,%llu,", (unsigned long long)c->far_off, (unsigned long long)c->denormals);
    if (c->worst != 0) {
        print_worst(f, c, values, is_verbose);
    }
    printf("\n");
}

/* False where the shader left a result alone. */
static bool compare(runner* r, const fs_function* f, size_t bytes, bool is_verbose)
{
    uint32_t* values = gpu_map(&r->device, &r->values);
    uint32_t* results = gpu_map(&r->device, &r->results);
    comparison c = {{0}, 0, 0, 0, 0, 0, 0, 0};
    bool is_whole = true;
    memset(values, 0, CALLS * STRIDE * sizeof(float));
    memset(results, 0xa5, CALLS * STRIDE * sizeof(float));
    const size_t calls = call_host(f, values);
    runner_call(r, r->words, bytes);
    for (size_t k = 0; k < calls; ++k) {
        for (size_t i = 0; i < f->result->leaf_count; ++i) {
            is_whole = is_whole && results[k * STRIDE + i] != UNTOUCHED;
            count(&c, f, k, i, results[k * STRIDE + i]);
        }
    }
    print_comparison(f, &c, values, is_verbose);
    gpu_unmap(&r->device, &r->values);
    gpu_unmap(&r->device, &r->results);
    return is_whole;
}

int main(int argc, char** argv)
{
    static runner r;
    int compared = 0, missing = 0;
    if (argc < 2) {
        fputs("usage: formulas FOLDER [FUNCTION...]\n", stderr);
        return 2;
    }
    if (!gpu_open(&r.device)) {
        return GPU_SKIPPED;
    }
    runner_begin(&r);
    print_driver(&r.device);
    printf("function,results");
    for (size_t i = 0; i < BINS; ++i) {
        printf(",%s", bins[i].name);
    }
    printf(",far,denormals,worst\n");
    for (size_t k = 0; k < sizeof headers / sizeof headers[0]; ++k) {
        for (const fs_function* const* f = headers[k]; *f; ++f) {
            size_t bytes;
            if (!is_selected((*f)->name, argc - 2, argv + 2)) {
                continue;
            }
            bytes = read_file(argv[1], (*f)->name, r.words);
            if (bytes == 0 || (*f)->missing || !build_arguments(*f) ||
                !compare(&r, *f, bytes, argc > 2)) {
                fprintf(stderr, "%s: no shader, no samples or no results\n", (*f)->name);
                ++missing;
            }
            ++compared;
        }
    }
    runner_end(&r);
    gpu_close(&r.device);
    return compared == 0 || missing != 0 || r.device.messages != 0;
}
