#include "app/inside.h"

#include <algorithm>
#include <array>

#include "techniques/base/error.h"
#include "techniques/voxel_rows/voxel_rows.h"

namespace sightlines {
namespace {

constexpr std::size_t most_unpacked = 4;

std::shared_ptr<const std::vector<std::uint8_t>> occupied_voxels(UnpackedVoxels& unpacked,
                                                                 const Shared<BuiltStructure>& structure,
                                                                 int direction) {
    auto& latest = unpacked.latest;
    std::erase_if(latest, [](const UnpackedVoxels::Direction& kept) { return kept.structure.expired(); });
    const auto found = std::ranges::find_if(latest, [&](const UnpackedVoxels::Direction& kept) {
        return kept.direction == direction && kept.structure.lock() == structure;
    });
    if (found != latest.end()) {
        std::rotate(latest.begin(), found, found + 1);
        return latest.front().occupied;
    }
    if (latest.size() == most_unpacked) latest.pop_back();
    const voxel_rows::RowArray& array = voxel_rows::row_array(structure->value.structure);
    auto occupied =
        std::make_shared<const std::vector<std::uint8_t>>(voxel_rows::unpack_voxelization(array, direction));
    latest.insert(latest.begin(), {structure, direction, occupied});
    return occupied;
}

}  // namespace

std::span<const FigureRow> figures() {
    static constexpr std::array rows{
        FigureRow{"voxel-row", "voxel_rows",
                  "The rotated voxelization that serves one ray: its row, the bits that count, the ray and its twin."}};
    return rows;
}

const FigureRow& find_figure(std::string_view name) {
    const auto found = std::ranges::find(figures(), name, &FigureRow::name);
    if (found != figures().end()) return *found;
    std::vector<std::string_view> names;
    std::string all;
    for (const FigureRow& row : figures()) {
        names.push_back(row.name);
        all.append(all.empty() ? "" : ", ").append(row.name);
    }
    const std::string near = nearest_name(std::string(name), names);
    throw InputError("figure " + std::string(name), "", "is not known",
                     near.empty() ? "there are: " + all : "did you mean " + near + "?");
}

VoxelRowPicture voxel_row_picture(const Session& session, const SelectedRay& ray, Results& results,
                                  Progress& progress) {
    UnpackedVoxels unpacked;
    return voxel_row_picture(session, ray, results, progress, unpacked);
}

VoxelRowPicture voxel_row_picture(const Session& session, const SelectedRay& ray, Results& results, Progress& progress,
                                  UnpackedVoxels& unpacked) {
    const auto structure = results.structure(session, progress);
    const auto scene = results.scene(session, progress);
    const voxel_rows::RowArray& array = voxel_rows::row_array(structure->value.structure);
    const voxel_rows::ServedRay served = voxel_rows::serve(array, ray.request);
    const double degrees_per_angle = 180.0 / array.grid.angles;
    VoxelRowPicture picture;
    picture.scene = {scene, &scene->value};
    picture.resolution = array.grid.resolution;
    picture.occupied = occupied_voxels(unpacked, structure, served.direction);
    picture.world_from_voxels = voxel_rows::world_from_voxels(array.grid, served.direction);
    picture.v = served.v;
    picture.w = served.w;
    picture.first = served.first;
    picture.last = served.last;
    picture.ray = ray.trace.ray;
    picture.row_direction = served.row_direction;
    picture.angular_error_deg = served.angular_error_deg;
    picture.theta_deg = static_cast<float>(served.theta * degrees_per_angle);
    picture.phi_deg = static_cast<float>(served.phi * degrees_per_angle);
    picture.blocked = served.blocked;
    picture.truly_blocked = ray.truly_blocked;
    return picture;
}

ViewState view_state(const Session& session, std::string_view figure) {
    const auto open = std::ranges::find(session.views, figure, &View::figure);
    return open == session.views.end() ? ViewState{} : open->state;
}

}  // namespace sightlines
