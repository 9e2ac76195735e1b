// Marching by the wide kernel: the opponents at their best. What was tried is in the README.
#include "shaders/wide.h"  // first: makes the kernels below wide

#include "techniques/baselines/lighting.h"
#include "techniques/baselines/marching/voxel_grid.h"

namespace sightlines::baselines {
namespace {

/// Answers a batch vector by vector.
template <March march>
struct MarchJudge {
    VoxelGrid query;
    wide::Words table;

    HWY_INLINE wide::Mask ask(const wide::Vec3& position, const wide::Vec3& normal, const wide::Vec3& light,
                              wide::Mask asked) const {
        if constexpr (march == March::voxels)
            return wide::is_blocked_by_voxels(query, table, position, normal, light, asked);
        else
            return wide::is_blocked_by_rows(query, table, position, normal, light, asked);
    }

    void operator()(const AskedLights& lights, std::uint32_t light, const RayBatch& batch,
                    PackedVerdicts& verdicts) const {
        const LightRecord& record = lights.records[light];
        for (std::size_t k = 0; k < batch.vectors(); ++k) {
            const wide::Vec3 position = batch.position(k);
            const wide::Vec3 end = wide::light_end(record, position, lights.reach_m);
            verdicts[k] = wide::bits_of(ask(position, batch.normal(k), end, wide::mask_of(0xffffu)));
        }
    }
};

/// Calls `ask` with the judge of the march.
template <class Ask>
auto with_judge(const Voxelization& voxels, March march, const ParameterValues& parameters, const Ask& ask) {
    const VoxelGrid query = make_query(voxels, parameters);
    if (march == March::voxels) return ask(MarchJudge<March::voxels>{query, {voxels.bits.data()}});
    return ask(MarchJudge<March::rows>{query, {voxels.distances.data()}});
}

template <March march>
void ask_many(const MarchJudge<march>& judge, std::span<const Segment> segments, std::span<const vec3> normals,
              std::span<std::uint8_t> answers) {
    for (std::size_t start = 0; start < segments.size(); start += wide::lanes) {
        const std::size_t count = std::min(wide::lanes, segments.size() - start);
        alignas(64) float numbers[9][wide::lanes] = {};
        for (std::size_t lane = 0; lane < count; ++lane) {
            for (int axis = 0; axis < 3; ++axis) {
                numbers[axis][lane] = segments[start + lane].origin[axis];
                numbers[3 + axis][lane] = normals[start + lane][axis];
                numbers[6 + axis][lane] = segments[start + lane].target[axis];
            }
        }
        const auto three = [&](int k) {
            return wide::Vec3{wide::load(numbers[k]), wide::load(numbers[k + 1]), wide::load(numbers[k + 2])};
        };
        const auto asked = wide::mask_of((1u << count) - 1u);
        const std::uint32_t bits = wide::bits_of(judge.ask(three(0), three(3), three(6), asked));
        for (std::size_t lane = 0; lane < count; ++lane) answers[start + lane] = (bits >> lane) & 1u;
    }
}

}  // namespace

void are_blocked(const Voxelization& voxels, const VoxelGrid& query, March march, std::span<const Segment> segments,
                 std::span<const vec3> normals, std::span<std::uint8_t> answers) {
    if (march == March::voxels)
        ask_many(MarchJudge<March::voxels>{query, {voxels.bits.data()}}, segments, normals, answers);
    else
        ask_many(MarchJudge<March::rows>{query, {voxels.distances.data()}}, segments, normals, answers);
}

RenderResult render_by_marching(const Voxelization& voxels, March march, const RenderRequest& request,
                                Progress& progress) {
    RenderResult result = with_judge(voxels, march, request.parameters, [&](const auto& judge) {
        return render_tiles(request, voxels.reach_m, judge, progress);
    });
    result.device = cpu_device(request.threads, std::to_string(wide::lanes) + " wide");
    return result;
}

QueryCount count_by_marching(const Voxelization& voxels, March march, const RenderRequest& request) {
    return with_judge(voxels, march, request.parameters,
                      [&](const auto& judge) { return count_tiles(request, voxels.reach_m, judge); });
}

}  // namespace sightlines::baselines
