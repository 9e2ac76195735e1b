#include "techniques/voxel_rows/vulkan_objects.h"

#include <array>
#include <map>
#include <mutex>

#include "shaders/spirv.h"
#include "techniques/voxel_rows/query.h"

namespace sightlines::voxel_rows {
namespace {

/// What a pipeline is compiled for, besides the arrays.
struct PipelineKey {
    int subrays = 1;
    std::uint32_t shade = 1, kind_of_all_lights = 0;

    auto operator<=>(const PipelineKey&) const = default;
};

/// One type's array on the device; empty where it has no words.
struct TypeMemory {
    std::shared_ptr<void> words_owner;  ///< keeps the words alive as long as `rows`, which may be the same memory
    compute::Buffer rows, frames;
};

}  // namespace

struct VulkanObjects {
    std::shared_ptr<const compute::Device> device;
    std::vector<TypeMemory> types;
    RowShape shape{};  ///< of any of them: resolution and row length are the same for all
    mutable std::mutex pipelines_mutex;
    mutable std::map<PipelineKey, compute::Pipeline> pipelines;
};

namespace {

const compute::Pipeline& pipeline_for(const VulkanObjects& objects, const PipelineKey& key) {
    const std::lock_guard lock(objects.pipelines_mutex);
    if (const auto found = objects.pipelines.find(key); found != objects.pipelines.end()) return found->second;
    const std::array<compute::SpecializationConstant, 5> constants{{
        {0, static_cast<std::uint32_t>(objects.shape.resolution)},
        {1, static_cast<std::uint32_t>(objects.shape.words_per_row)},
        {2, static_cast<std::uint32_t>(key.subrays)},
        {4, key.shade},
        {5, key.kind_of_all_lights},
    }};
    compute::Pipeline pipeline = compute::make_pipeline(objects.device, spirv::voxel_row_objects_lighting(),
                                                        sizeof(ObjectLightingJob), constants);
    return objects.pipelines.emplace(key, std::move(pipeline)).first->second;
}

}  // namespace

std::shared_ptr<const VulkanObjects> give_objects_to_vulkan(std::span<const RowArray> types, Progress& progress) {
    const auto objects = std::make_shared<VulkanObjects>();
    objects->device = compute::open_device();
    for (const RowArray& type : types) {
        TypeMemory& memory = objects->types.emplace_back();
        if (type.words.words.empty()) continue;
        objects->shape = make_shape(type);
        memory.words_owner = type.words.owner;
        memory.rows = compute::give_to_device(objects->device, std::as_bytes(type.words.words), progress);
        memory.frames = compute::make_buffer(objects->device, type.grid.frames.size() * sizeof(DirectionFrame),
                                             compute::MemoryPlace::device);
        compute::upload(memory.frames, std::as_bytes(std::span(type.grid.frames)), progress);
    }
    return objects;
}

ObjectAsker make_object_asker(const ObjectsOnDevice& objects, const ParameterValues& parameters, bool shade,
                              std::uint32_t kind_of_all_lights, float reach_m, const Progress& progress) {
    const VulkanObjects& device = *objects.on_device;
    std::vector<ObjectInstance> instances = object_instances(objects.objects, parameters);
    for (ObjectInstance& instance : instances) {
        instance.frames = device.types[instance.type].frames.address;
        instance.rows = device.types[instance.type].rows.address;
    }
    ObjectAsker asker;
    asker.pipeline = &pipeline_for(device, {instances.front().query.subrays, shade ? 1u : 0u, kind_of_all_lights});
    const auto bytes = std::as_bytes(std::span(instances));
    asker.table = compute::make_buffer(device.device, bytes.size(), compute::MemoryPlace::device);
    compute::upload(asker.table, bytes, progress);
    asker.job.objects = asker.table.address;
    asker.job.object_count = static_cast<std::uint32_t>(instances.size());
    asker.job.reach_m = reach_m;
    return asker;
}

double ask_objects(ObjectAsker& asker, std::uint32_t first_light, std::uint32_t end_light, std::uint32_t groups) {
    asker.job.first_light = first_light;
    asker.job.end_light = end_light;
    return compute::dispatch(*asker.pipeline, std::as_bytes(std::span(&asker.job, 1)), {groups, 1, 1});
}

}  // namespace sightlines::voxel_rows
