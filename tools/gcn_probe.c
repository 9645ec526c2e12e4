/* gcn_probe.c - what a Vulkan driver says about compute shaders that it compiles.
 * SPDX-License-Identifier: MIT
 *
 * Usage: gcn_probe [FOLDER] <list. Each line of the list is "NAME FILE.spv MASK", where MASK is the
 * value of specialization constant 0, or - where the shader has none. One line per fact goes to
 * stdout, with tabs between name, key and value; the driver itself has the name "driver". With a
 * FOLDER, the machine code of each shader is written to FOLDER/NAME. tools/gcn_probe.py runs this
 * on Mesa's null device, which compiles for GPUs that are not there.
 *
 * A shader may use, in set 0: storage buffers at bindings 0 to 2, a combined image sampler at 3,
 * and 16 bytes of push constants. With a fourth word, BINDINGS, it uses those instead, a letter for
 * each from 0 on, and 128 bytes of push constants: s storage image, t sampled image, c sampled
 * image with a sampler, b storage buffer, u uniform buffer. */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <vulkan/vulkan.h>

#define MAX_SHADER_BYTES (16u << 20)
#define MAX_STATISTICS   64u
#define MAX_TEXTS        16u
#define MAX_BINDINGS     32u
#define BINDINGS         "bbbc"

typedef struct probe {
    VkInstance instance;
    VkPhysicalDevice physical;
    VkDevice device;
    VkDescriptorSetLayout set_layout;
    VkPipelineLayout layout;
    PFN_vkGetPipelineExecutablePropertiesKHR get_executables;
    PFN_vkGetPipelineExecutableStatisticsKHR get_statistics;
    PFN_vkGetPipelineExecutableInternalRepresentationsKHR get_texts;
    const char* folder; /* for machine code, or NULL */
} probe;

static void check(VkResult result, const char* what)
{
    if (result != VK_SUCCESS) {
        fprintf(stderr, "gcn_probe: %s: VkResult %d\n", what, (int)result);
        exit(1);
    }
}

/* The first device: the environment names one driver, and its null device is alone. */
static void open_instance(probe* p)
{
    VkApplicationInfo application = {0};
    VkInstanceCreateInfo info = {0};
    VkPhysicalDeviceDriverProperties driver = {0};
    VkPhysicalDeviceProperties2 properties = {0};
    uint32_t count = 1;
    VkResult result;
    application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
    application.apiVersion = VK_API_VERSION_1_2;
    info.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
    info.pApplicationInfo = &application;
    check(vkCreateInstance(&info, NULL, &p->instance), "vkCreateInstance");
    result = vkEnumeratePhysicalDevices(p->instance, &count, &p->physical);
    check(result == VK_INCOMPLETE ? VK_SUCCESS : result, "vkEnumeratePhysicalDevices");
    if (count == 0) {
        fprintf(stderr, "gcn_probe: the driver has no device\n");
        exit(1);
    }
    driver.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES;
    properties.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
    properties.pNext = &driver;
    vkGetPhysicalDeviceProperties2(p->physical, &properties);
    printf("driver\tdevice\t%s\n", properties.properties.deviceName);
    printf("driver\tname\t%s\n", driver.driverName);
    printf("driver\tversion\t%s\n", driver.driverInfo);
}

static void open_device(probe* p)
{
    static const char* const extensions[] = {VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME};
    const float priority = 1.0f;
    VkPhysicalDevicePipelineExecutablePropertiesFeaturesKHR features = {0};
    VkDeviceQueueCreateInfo queue = {0};
    VkDeviceCreateInfo info = {0};
    features.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PIPELINE_EXECUTABLE_PROPERTIES_FEATURES_KHR;
    features.pipelineExecutableInfo = VK_TRUE;
    queue.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
    queue.queueCount = 1;
    queue.pQueuePriorities = &priority;
    info.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
    info.pNext = &features;
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queue;
    info.enabledExtensionCount = 1;
    info.ppEnabledExtensionNames = extensions;
    check(vkCreateDevice(p->physical, &info, NULL, &p->device), "vkCreateDevice");
    p->get_executables = (PFN_vkGetPipelineExecutablePropertiesKHR)vkGetDeviceProcAddr(
        p->device, "vkGetPipelineExecutablePropertiesKHR");
    p->get_statistics = (PFN_vkGetPipelineExecutableStatisticsKHR)vkGetDeviceProcAddr(
        p->device, "vkGetPipelineExecutableStatisticsKHR");
    p->get_texts = (PFN_vkGetPipelineExecutableInternalRepresentationsKHR)vkGetDeviceProcAddr(
        p->device, "vkGetPipelineExecutableInternalRepresentationsKHR");
    if (!p->get_executables || !p->get_statistics || !p->get_texts) {
        check(VK_ERROR_EXTENSION_NOT_PRESENT, "VK_KHR_pipeline_executable_properties");
    }
}

static VkDescriptorType type_of(char letter)
{
    switch (letter) {
    case 's':
        return VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
    case 't':
        return VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE;
    case 'c':
        return VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    case 'u':
        return VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
    default:
        return VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    }
}

static void open_layout(probe* p, const char* letters, uint32_t push_bytes)
{
    VkDescriptorSetLayoutBinding bindings[MAX_BINDINGS];
    VkDescriptorSetLayoutCreateInfo set = {0};
    VkPushConstantRange push = {VK_SHADER_STAGE_COMPUTE_BIT, 0, 0};
    VkPipelineLayoutCreateInfo layout = {0};
    uint32_t i;
    memset(bindings, 0, sizeof bindings);
    push.size = push_bytes;
    for (i = 0; letters[i] && i < MAX_BINDINGS; ++i) {
        bindings[i].binding = i;
        bindings[i].descriptorType = type_of(letters[i]);
        bindings[i].descriptorCount = 1;
        bindings[i].stageFlags = VK_SHADER_STAGE_COMPUTE_BIT;
    }
    set.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
    set.bindingCount = i;
    set.pBindings = bindings;
    check(vkCreateDescriptorSetLayout(p->device, &set, NULL, &p->set_layout),
          "vkCreateDescriptorSetLayout");
    layout.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
    layout.setLayoutCount = 1;
    layout.pSetLayouts = &p->set_layout;
    layout.pushConstantRangeCount = 1;
    layout.pPushConstantRanges = &push;
    check(vkCreatePipelineLayout(p->device, &layout, NULL, &p->layout), "vkCreatePipelineLayout");
}

static void close_layout(probe* p)
{
    vkDestroyPipelineLayout(p->device, p->layout, NULL);
    vkDestroyDescriptorSetLayout(p->device, p->set_layout, NULL);
}

static VkShaderModule read_shader(const probe* p, const char* path)
{
    FILE* file = fopen(path, "rb");
    uint32_t* words = (uint32_t*)malloc(MAX_SHADER_BYTES);
    VkShaderModuleCreateInfo info = {0};
    VkShaderModule shader;
    if (!file || !words) {
        fprintf(stderr, "gcn_probe: cannot read %s\n", path);
        exit(1);
    }
    info.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
    info.codeSize = fread(words, 1, MAX_SHADER_BYTES, file);
    info.pCode = words;
    fclose(file);
    if (info.codeSize == 0 || info.codeSize == MAX_SHADER_BYTES || info.codeSize % 4 != 0) {
        fprintf(stderr, "gcn_probe: %s is no shader\n", path);
        exit(1);
    }
    check(vkCreateShaderModule(p->device, &info, NULL, &shader), path);
    free(words);
    return shader;
}

static VkPipeline compile(const probe* p, VkShaderModule shader, const char* mask_text)
{
    uint32_t mask = (uint32_t)strtoul(mask_text, NULL, 0);
    VkSpecializationMapEntry entry = {0, 0, sizeof mask};
    VkSpecializationInfo constants = {1, &entry, sizeof mask, &mask};
    VkComputePipelineCreateInfo info = {0};
    VkPipeline pipeline;
    info.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO;
    info.flags = VK_PIPELINE_CREATE_CAPTURE_STATISTICS_BIT_KHR;
    if (p->folder) {
        info.flags |= VK_PIPELINE_CREATE_CAPTURE_INTERNAL_REPRESENTATIONS_BIT_KHR;
    }
    info.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
    info.stage.module = shader;
    info.stage.pName = "main";
    info.stage.pSpecializationInfo = strcmp(mask_text, "-") != 0 ? &constants : NULL;
    info.layout = p->layout;
    check(vkCreateComputePipelines(p->device, VK_NULL_HANDLE, 1, &info, NULL, &pipeline),
          "vkCreateComputePipelines");
    return pipeline;
}

static void print_statistics(const probe* p, const char* name, VkPipelineExecutableInfoKHR which)
{
    VkPipelineExecutableStatisticKHR found[MAX_STATISTICS];
    uint32_t count = MAX_STATISTICS, i;
    memset(found, 0, sizeof found);
    for (i = 0; i < MAX_STATISTICS; ++i) {
        found[i].sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_STATISTIC_KHR;
    }
    check(p->get_statistics(p->device, &which, &count, found), "statistics");
    for (i = 0; i < count; ++i) {
        if (found[i].format == VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_UINT64_KHR) {
            printf("%s\t%s\t%" PRIu64 "\n", name, found[i].name, found[i].value.u64);
        }
    }
}

static void write_code(const probe* p, const char* name, VkPipelineExecutableInfoKHR which)
{
    VkPipelineExecutableInternalRepresentationKHR found[MAX_TEXTS];
    uint32_t count = MAX_TEXTS, i;
    char path[4096];
    memset(found, 0, sizeof found);
    for (i = 0; i < MAX_TEXTS; ++i) {
        found[i].sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_INTERNAL_REPRESENTATION_KHR;
    }
    check(p->get_texts(p->device, &which, &count, found), "internal representations");
    for (i = 0; i < count; ++i) {
        found[i].pData = malloc(found[i].dataSize + 1);
    }
    check(p->get_texts(p->device, &which, &count, found), "internal representations");
    snprintf(path, sizeof path, "%s/%s", p->folder, name);
    for (i = 0; i < count; ++i) {
        if (found[i].isText && strcmp(found[i].name, "Assembly") == 0) {
            FILE* file = fopen(path, "wb");
            if (!file || fputs((const char*)found[i].pData, file) < 0 || fclose(file) != 0) {
                fprintf(stderr, "gcn_probe: cannot write %s\n", path);
                exit(1);
            }
        }
        free(found[i].pData);
    }
}

static void report(const probe* p, const char* name, const char* path, const char* mask)
{
    VkShaderModule shader = read_shader(p, path);
    VkPipeline pipeline = compile(p, shader, mask);
    VkPipelineInfoKHR info = {0};
    VkPipelineExecutablePropertiesKHR executable = {0};
    VkPipelineExecutableInfoKHR which = {0};
    uint32_t count = 1;
    info.sType = VK_STRUCTURE_TYPE_PIPELINE_INFO_KHR;
    info.pipeline = pipeline;
    executable.sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_PROPERTIES_KHR;
    check(p->get_executables(p->device, &info, &count, &executable), "executables");
    which.sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_INFO_KHR;
    which.pipeline = pipeline;
    print_statistics(p, name, which);
    if (p->folder) {
        write_code(p, name, which);
    }
    vkDestroyPipeline(p->device, pipeline, NULL);
    vkDestroyShaderModule(p->device, shader, NULL);
}

int main(int argc, char** argv)
{
    probe p = {0};
    char line[4096], name[256], path[3072], mask[64], bindings[MAX_BINDINGS + 1];
    p.folder = argc > 1 ? argv[1] : NULL;
    open_instance(&p);
    open_device(&p);
    while (fgets(line, sizeof line, stdin)) {
        int words = sscanf(line, "%255s %3071s %63s %32s", name, path, mask, bindings);
        if (words < 3) {
            fprintf(stderr, "gcn_probe: not NAME FILE MASK [BINDINGS]: %s", line);
            return 1;
        }
        open_layout(&p, words > 3 ? bindings : BINDINGS, words > 3 ? 128 : 16);
        report(&p, name, path, mask);
        close_layout(&p);
    }
    vkDestroyDevice(p.device, NULL);
    vkDestroyInstance(p.instance, NULL);
    return 0;
}
