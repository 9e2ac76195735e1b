#include <algorithm>

#include <gtest/gtest.h>

#include "app/inside.h"
#include "techniques/base/error.h"
#include "techniques/visibility_field/visibility_field.h"
#include "visualizers/mask_merging.h"

namespace sightlines {
namespace {

Session small_session(const std::string& technique) {
    Session session;
    session.scene = "cornell";
    session.size = {48, 27};
    session.lights.count = 4;
    session.backend = BackendChoice::cpu;
    session.technique = technique;
    session.views = {View{"ray", {}}};
    if (technique == "voxel_rows") session.parameters[technique] = {{"resolution", 32.0}, {"angle_step", 6.0}};
    if (technique == "visibility_field") session.parameters[technique] = {{"points", 20000.0}};
    return session;
}

struct Made {
    Results results{0, Backend::cpu};
    Progress progress;
    UnpackedVoxels unpacked;

    RayPicture picture(const Session& session, SelectedRay* selected = nullptr) {
        const SelectedRay ray = select_ray(session, results, progress);
        if (selected != nullptr) *selected = ray;
        return std::get<RayPicture>(inside_picture(session, ray, results, progress, unpacked));
    }
};

TEST(RayPicture, IsThereForEveryTechniqueAndTellsItsVerdict) {
    for (const Technique& technique : techniques()) {
        Made made;
        SelectedRay ray;
        const Session session = small_session(std::string(technique.name));
        const RayPicture picture = made.picture(session, &ray);
        EXPECT_EQ(picture.blocked, ray.trace.blocked) << technique.name;
        EXPECT_EQ(picture.truly_blocked, ray.truly_blocked) << technique.name;
        EXPECT_EQ(picture.ray.origin, ray.trace.ray.origin) << technique.name;
        ASSERT_NE(picture.scene, nullptr);
        const bool nothing_touched =
            std::ranges::all_of(ray.trace.steps, [](const TraceStep& step) { return step.geometry.empty(); });
        EXPECT_EQ(picture.recorded.empty(), nothing_touched) << technique.name;
    }
}

TEST(RayPicture, HoldsEachPieceOfGeometryOnce) {
    Made made;
    const RayPicture picture = made.picture(small_session("voxel_marching"));
    for (std::size_t i = 0; i < picture.recorded.size(); ++i)
        for (std::size_t k = 0; k < i; ++k) ASSERT_FALSE(picture.recorded[i] == picture.recorded[k]);
}

TEST(RayPicture, ShowsTheOccupiedVoxelsOfMarchingWithoutMakingThemAnew) {
    Made made;
    const Session session = small_session("voxel_marching");
    const RayPicture picture = made.picture(session);
    ASSERT_NE(picture.boxes, nullptr);
    EXPECT_GT(picture.boxes->size(), 1000u);
    EXPECT_EQ(made.picture(session).boxes, picture.boxes);
    // A ray that is blocked ends in an occupied voxel.
    Session blocked = session;
    for (std::uint32_t light = 0; light < 4; ++light) {
        blocked.selection.light = light;
        SelectedRay ray;
        RayPicture shown;
        try {
            shown = made.picture(blocked, &ray);
        } catch (const InputError&) {
            continue;  // behind the surface
        }
        if (!ray.trace.blocked) continue;
        const TraceGeometry* last = nullptr;
        for (const TraceGeometry& piece : shown.recorded)
            if (piece.name == "voxel") last = &piece;
        ASSERT_NE(last, nullptr);
        const vec3 middle = last->points[0] + 0.5f * (last->points[1] + last->points[2] + last->points[3]);
        EXPECT_TRUE(std::ranges::any_of(*shown.boxes, [&](const ValuedBox& box) {
            return glm::distance(box.box.centre(), middle) < 1e-3f * box.box.diagonal();
        }));
    }
}

TEST(RayPicture, MarksTheTexelOfOneFaceOfACubeOfShadowMaps) {
    Made made;
    const RayPicture picture = made.picture(small_session("shadow_maps"));
    ASSERT_EQ(picture.maps.size(), 6u);
    int asked = 0;
    for (const PictureMap& map : picture.maps) {
        ASSERT_EQ(map.size, ivec2(128));
        ASSERT_EQ(map.values.size(), 128u * 128u);
        asked += map.asked.has_value();
        for (const float value : map.values) ASSERT_TRUE(value >= 0.0f && value <= 1.0f);
    }
    EXPECT_EQ(asked, 1);
}

TEST(RayPicture, ShowsImperfectMapsBeforeAndAfterTheirHolesAreFilled) {
    Made made;
    const RayPicture picture = made.picture(small_session("imperfect_shadow_maps"));
    ASSERT_EQ(picture.maps.size(), 4u);
    const auto holes = [](const PictureMap& map) { return std::ranges::count(map.values, 0.0f); };
    EXPECT_GT(holes(picture.maps[0]) + holes(picture.maps[1]), holes(picture.maps[2]) + holes(picture.maps[3]));
}

TEST(RayPicture, ShowsTheFieldsCellAndBothItsMasksFlatAndFolded) {
    Made made;
    const Session session = small_session("visibility_field");
    SelectedRay ray;
    const RayPicture picture = made.picture(session, &ray);
    const visibility_field::BuiltField& built =
        visibility_field::built_field(made.results.structure(session, made.progress)->value.structure);
    EXPECT_EQ(picture.boxes->size(), built.field.cells);
    ASSERT_EQ(picture.maps.size(), 2u);
    const int side = built.field.shape.mask_size;
    std::size_t either = 0;
    for (std::size_t k = 0; k < picture.maps[0].values.size(); ++k)
        either += picture.maps[0].values[k] > 0.0f || picture.maps[1].values[k] > 0.0f;
    EXPECT_EQ(picture.patches.size(), either);
    // The patch of the texel that the ray asks lies where the ray leaves the sphere.
    ASSERT_TRUE(picture.maps[0].asked);
    const vec3 direction = -ray.request.light.direction;
    const auto asked = static_cast<std::size_t>(picture.maps[0].asked->y * side + picture.maps[0].asked->x);
    std::size_t before = 0;
    for (std::size_t k = 0; k < asked; ++k)
        before += picture.maps[0].values[k] > 0.0f || picture.maps[1].values[k] > 0.0f;
    if (picture.maps[0].values[asked] == 0.0f && picture.maps[1].values[asked] == 0.0f) return;
    const ValuedPatch& patch = picture.patches[before];
    const vec3 middle = 0.25f * (patch.corners[0] + patch.corners[1] + patch.corners[2] + patch.corners[3]);
    const Box3 cell = visibility_field::cell_box(
        built.field.shape,
        visibility_field::trace_sample(built.field, *built.embree, visibility_field::Culling::label,
                                       {ray.request.position, ray.request.normal, direction, vec3(0.0f)})
            .cell);
    EXPECT_GT(glm::dot(glm::normalize(middle - cell.centre()), direction), 0.98f);
}

TEST(RayPicture, ShowsThePickedCellInsteadOfTheRaysOwn) {
    Made made;
    Session session = small_session("visibility_field");
    const RayPicture own = made.picture(session);
    const auto other = std::ranges::find_if(*own.boxes, [&](const ValuedBox& box) {
        return glm::distance(box.box.centre(), own.cell->centre()) > 0.5f * own.cell->diagonal();
    });
    ASSERT_NE(other, own.boxes->end());
    session.selection.voxel = other->place;
    const RayPicture picked = made.picture(session);
    EXPECT_LT(glm::distance(picked.cell->centre(), other->box.centre()), 1e-3f);
    EXPECT_EQ(picked.maps[0].asked, own.maps[0].asked) << "the ray's direction, whatever the cell";
    session.selection.voxel = ivec3(1000);
    EXPECT_EQ(made.picture(session).cell->centre(), own.cell->centre()) << "a cell without masks is not shown";
}

TEST(RayPicture, MergesTheCellsSamplesIntoWhatTheFieldHolds) {
    Made made;
    Session session = small_session("visibility_field");
    session.parameters["visibility_field"]["probes"] = 0.0;
    session.parameters["visibility_field"]["dilation"] = 0.0;
    const RayPicture stored = made.picture(session);
    session.views = {View{"merging", {}}};
    const RayPicture merging = made.picture(session);
    ASSERT_TRUE(merging.samples);
    ASSERT_GT(merging.samples->size(), 1u);
    const RayPicture all = merged_until(merging, most_merged_samples);
    EXPECT_EQ(all.maps[2].values, stored.maps[0].values);
    EXPECT_EQ(all.maps[3].values, stored.maps[1].values);
    EXPECT_EQ(all.patches, stored.patches);
}

TEST(RayPicture, ShowsTheCellsOfOneLayerAndTheirMapsAsThePaperLaysThemOut) {
    Made made;
    Session session = small_session("visibility_field");
    session.views = {View{"atlas", {}}};
    const RayPicture picture = made.picture(session);
    const visibility_field::BuiltField& built =
        visibility_field::built_field(made.results.structure(session, made.progress)->value.structure);
    const FieldShape& shape = built.field.shape;
    const int map_side = shape.mask_size + 2;
    ASSERT_EQ(picture.maps.size(), 1u);
    EXPECT_EQ(picture.maps[0].size, ivec2(shape.cells_x, shape.cells_z) * map_side);
    ASSERT_FALSE(picture.boxes->empty());
    const int layer = picture.boxes->front().place.y;
    for (const ValuedBox& box : *picture.boxes) EXPECT_EQ(box.place.y, layer);
    const ImageScalar whole = dense_layer(visibility_field::to_dense(built.field), layer);
    EXPECT_EQ(dense_layer(built.field, layer).pixels, whole.pixels);
    const ivec2 cell = *picture.maps[0].asked / map_side;
    EXPECT_TRUE(std::ranges::any_of(
        *picture.boxes, [&](const ValuedBox& box) { return box.place.x == cell.x && box.place.z == cell.y; }));
}

}  // namespace
}  // namespace sightlines
