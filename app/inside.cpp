#include "app/inside.h"

#include <algorithm>
#include <array>
#include <functional>
#include <numeric>

#include "techniques/base/error.h"
#include "techniques/trace_boxes.h"
#include "techniques/voxel_rows/dictionary.h"
#include "techniques/voxel_rows/voxel_rows.h"

namespace sightlines {
namespace {

constexpr std::size_t most_unpacked = 4;
constexpr std::size_t most_used_shown = 32;

/// What a view inside is taken out of.
struct Opened {
    Shared<BuiltStructure> structure;
    Shared<Scene> scene;
    const voxel_rows::RowArray& array;
    voxel_rows::ServedRay served;
};

Opened opened(const Session& session, const SelectedRay& ray, Results& results, Progress& progress) {
    const auto structure = results.structure(session, progress);
    const voxel_rows::RowArray& array = voxel_rows::row_array(structure->value.structure);
    return {structure, results.scene(session, progress), array, voxel_rows::serve(array, ray.request)};
}

/// The voxelization that `make` gives, or the same that was shown before.
template <class Make>
std::shared_ptr<const std::vector<std::uint8_t>> occupied_voxels(UnpackedVoxels& unpacked, const Opened& from,
                                                                 bool uncompressed, const Make& make) {
    auto& latest = unpacked.latest;
    std::erase_if(latest, [](const UnpackedVoxels::Direction& kept) { return kept.structure.expired(); });
    const auto found = std::ranges::find_if(latest, [&](const UnpackedVoxels::Direction& kept) {
        return kept.direction == from.served.direction && kept.uncompressed == uncompressed &&
               kept.structure.lock() == from.structure;
    });
    if (found != latest.end()) {
        std::rotate(latest.begin(), found, found + 1);
        return latest.front().occupied;
    }
    if (latest.size() == most_unpacked) latest.pop_back();
    auto occupied = std::make_shared<const std::vector<std::uint8_t>>(make());
    latest.insert(latest.begin(), {from.structure, from.served.direction, uncompressed, occupied});
    return occupied;
}

/// The row of an object that the picture shows: of two the one that is in the way, else the first.
const voxel_rows::AskedRow& shown_row(const voxel_rows::AskedObject& asked) {
    const auto blocked = std::ranges::find_if(asked.rows, &voxel_rows::AskedRow::blocked);
    return blocked == asked.rows.end() ? asked.rows.front() : *blocked;
}

/// The voxels of the object's array in the direction that serves the ray, where the object is now.
std::shared_ptr<const VoxelRowPicture> rows_of(const voxel_rows::RowArray& type, const mat4& world_from_object,
                                               const voxel_rows::AskedObject& asked, const Segment& ray) {
    if (asked.rows.empty()) return nullptr;
    const voxel_rows::AskedRow& row = shown_row(asked);
    VoxelRowPicture rows;
    rows.resolution = type.grid.resolution;
    rows.occupied =
        std::make_shared<const std::vector<std::uint8_t>>(voxel_rows::unpack_voxelization(type, asked.direction));
    rows.world_from_voxels = world_from_object * voxel_rows::world_from_voxels(type.grid, asked.direction);
    rows.v = row.v;
    rows.w = row.w;
    rows.first = row.first;
    rows.last = row.last;
    rows.ray = ray;
    rows.row_direction = glm::normalize(vec3(rows.world_from_voxels[0]));
    rows.blocked = row.blocked;
    return std::make_shared<const VoxelRowPicture>(std::move(rows));
}

/// The objects that the ray was asked of after what stands still (Algorithm 5).
std::vector<ObjectPicture> objects_of(const SelectedRay& ray, const voxel_rows::Objects& objects) {
    std::vector<ObjectPicture> pictures;
    for (const voxel_rows::AskedObject& asked : voxel_rows::asked_objects(objects, ray.trace)) {
        const voxel_rows::PlacedObject& placed = objects.placed[asked.instance];
        const voxel_rows::RowArray& type = objects.types[placed.type];
        const Box3& own = type.grid.bounds;
        pictures.push_back({"instance " + std::to_string(asked.instance),
                            box_geometry("", placed.world_from_object, own.lowest, own.highest).points, asked.blocked(),
                            rows_of(type, placed.world_from_object, asked, ray.trace.ray)});
    }
    return pictures;
}

/// All but the voxels.
VoxelRowPicture picture_of(const SelectedRay& ray, const Opened& from) {
    const voxel_rows::ServedRay& served = from.served;
    const double degrees_per_angle = 180.0 / from.array.grid.angles;
    VoxelRowPicture picture;
    picture.scene = {from.scene, &from.scene->value};
    picture.resolution = from.array.grid.resolution;
    picture.world_from_voxels = voxel_rows::world_from_voxels(from.array.grid, served.direction);
    picture.v = served.v;
    picture.w = served.w;
    picture.first = served.first;
    picture.last = served.last;
    picture.ray = ray.trace.ray;
    // A ray to the sun is shown as far as the scene goes, or the scene would be a speck at its end.
    if (ray.request.light.kind == LightKind::directional) picture.ray.target = served.ray.target;
    picture.row_direction = served.row_direction;
    picture.angular_error_deg = served.angular_error_deg;
    picture.theta_deg = static_cast<float>(served.theta * degrees_per_angle);
    picture.phi_deg = static_cast<float>(served.phi * degrees_per_angle);
    picture.blocked = ray.trace.blocked;
    picture.truly_blocked = ray.truly_blocked;
    picture.objects = objects_of(ray, voxel_rows::objects(from.structure->value.structure));
    return picture;
}

std::vector<std::uint8_t> bits_of(std::span<const std::uint32_t> words, int resolution) {
    std::vector<std::uint8_t> bits(static_cast<std::size_t>(resolution));
    for (std::size_t u = 0; u < bits.size(); ++u) bits[u] = words[u / 32] >> (u % 32) & 1u;
    return bits;
}

DictionarySummary summary_of(const voxel_rows::RowArray& array) {
    const voxel_rows::RowDictionary& dictionary = array.dictionary;
    DictionarySummary summary{dictionary.rows_mapped, dictionary.rows_left_over, dictionary.frequencies, {}};
    std::ranges::sort(summary.frequencies, std::greater());
    std::vector<std::uint32_t> order(dictionary.frequencies.size());
    std::iota(order.begin(), order.end(), 0u);
    const std::size_t shown = std::min(order.size(), most_used_shown);
    std::ranges::partial_sort(order, order.begin() + static_cast<std::ptrdiff_t>(shown), [&](auto a, auto b) {
        return std::pair(dictionary.frequencies[b], a) < std::pair(dictionary.frequencies[a], b);
    });
    const auto length = static_cast<std::size_t>(array.grid.words_per_row);
    for (const std::uint32_t row : std::span(order).first(shown))
        summary.most_used.push_back(bits_of(array.words.words.subspan(row * length, length), array.grid.resolution));
    return summary;
}

std::shared_ptr<const DictionarySummary> summary_of(UnpackedVoxels& unpacked, const Opened& from) {
    if (!unpacked.summary || unpacked.summarised.lock() != from.structure) {
        unpacked.summary = std::make_shared<const DictionarySummary>(summary_of(from.array));
        unpacked.summarised = from.structure;
    }
    return unpacked.summary;
}

/// The own row of the picture, as the array would hold it.
std::vector<std::uint32_t> own_words(const VoxelRowPicture& picture, int words_per_row) {
    std::vector<std::uint32_t> words(static_cast<std::size_t>(words_per_row));
    for (int u = 0; u < picture.resolution; ++u)
        if (is_set(picture, {u, picture.v, picture.w})) words[static_cast<std::size_t>(u / 32)] |= 1u << (u % 32);
    return words;
}

/// Whether the row has a set voxel in its extent.
bool is_row_blocked(const VoxelRowPicture& picture) {
    for (int u = picture.first; u <= picture.last; ++u)
        if (is_set(picture, {u, picture.v, picture.w})) return true;
    return false;
}

}  // namespace

std::span<const FigureRow> figures() {
    static constexpr std::array rows{
        FigureRow{"voxel-row", "Row of voxels", "voxel_rows", false,
                  "The rotated voxelization that serves one ray: its row, the bits that count, the ray and its twin."},
        FigureRow{
            "dictionary", "Dictionary", "voxel_rows", true,
            "The ray's row and the one that stands for it, bit under bit and in space; the dictionary in charts."},
        FigureRow{"ray", "Ray in the scene", "", false,
                  "The scene cut open along the ray, what each step touched, and the maps that were looked up."},
        FigureRow{"merging", "Merging of masks", "visibility_field", false,
                  "A cell's point samples in space, what the latest sees by itself, and all so far together."},
        FigureRow{"atlas", "Layer of the atlas", "visibility_field", false,
                  "A layer of cells in space, and as the paper lays their masks out, a byte a texel."}};
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

bool shows_cells(const Session& session) { return session.technique == "visibility_field"; }

bool can_show(const FigureRow& figure, const Session& session) {
    if (!figure.technique.empty() && session.technique != figure.technique) return false;
    return !figure.compressed || voxel_rows::is_compressed(technique_parameters(session));
}

std::string_view shown_figure(const Session& session) {
    if (!session.views.empty()) {
        const auto open = std::ranges::find(figures(), session.views.front().figure, &FigureRow::name);
        if (open != figures().end() && can_show(*open, session)) return open->name;
    }
    const auto first = std::ranges::find_if(figures(), [&](const FigureRow& row) { return can_show(row, session); });
    return first == figures().end() ? std::string_view() : first->name;
}

void show_figure(Session& session, std::string_view figure) {
    auto open = std::ranges::find(session.views, figure, &View::figure);
    if (open == session.views.end()) open = session.views.insert(open, View{std::string(figure), {}});
    std::rotate(session.views.begin(), open, open + 1);
}

VoxelRowPicture voxel_row_picture(const Session& session, const SelectedRay& ray, Results& results, Progress& progress,
                                  UnpackedVoxels& unpacked) {
    const Opened from = opened(session, ray, results, progress);
    VoxelRowPicture picture = picture_of(ray, from);
    picture.occupied = occupied_voxels(
        unpacked, from, false, [&] { return voxel_rows::unpack_voxelization(from.array, from.served.direction); });
    return picture;
}

DictionaryPicture dictionary_picture(const Session& session, const SelectedRay& ray, Results& results,
                                     Progress& progress, UnpackedVoxels& unpacked) {
    const Opened from = opened(session, ray, results, progress);
    DictionaryPicture picture;
    picture.row = picture_of(ray, from);
    picture.row.occupied = occupied_voxels(unpacked, from, true, [&] {
        return voxel_rows::uncompressed_voxelization(from.scene->value, technique_parameters(session),
                                                     from.served.direction, results.threads(), progress);
    });
    picture.row.blocked = is_row_blocked(picture.row);
    picture.row.objects.clear();  // they are asked by rows of their own, which no dictionary holds
    picture.summary = summary_of(unpacked, from);
    const RowShape shape = voxel_rows::make_shape(from.array);
    const std::uint32_t row =
        scalar_kernel::row_index(shape, {from.served.theta, from.served.phi}, from.served.v, from.served.w);
    const auto mapped = voxel_rows::row_words(from.array, row);
    picture.mapped = bits_of(mapped, shape.resolution);
    const voxel_rows::DictionaryEntry entry = voxel_rows::dictionary_entry(from.array, row);
    picture.mapped_index = entry.index;
    picture.frequency = entry.frequency;
    picture.step =
        voxel_rows::mapping_step(own_words(picture.row, shape.words_per_row), mapped, from.array.dictionary.steps);
    return picture;
}

InsidePicture inside_picture(const Session& session, const SelectedRay& ray, Results& results, Progress& progress,
                             UnpackedVoxels& unpacked) {
    if (shown_figure(session) == "dictionary") return dictionary_picture(session, ray, results, progress, unpacked);
    if (shown_figure(session) == "voxel-row") return voxel_row_picture(session, ray, results, progress, unpacked);
    return ray_picture(session, ray, results, progress, unpacked);
}

ViewState view_state(const Session& session, std::string_view figure) {
    const auto open = std::ranges::find(session.views, figure, &View::figure);
    return open == session.views.end() ? ViewState{} : open->state;
}

}  // namespace sightlines
