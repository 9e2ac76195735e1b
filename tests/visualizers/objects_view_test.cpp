// The view inside of voxel rows where objects move: what the ray was asked of besides what stands still.
#include <gtest/gtest.h>

#include <vtkCellData.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkXMLPolyDataReader.h>

#include "tests/golden_pictures.h"
#include "tests/visualizers/visualizer_testing.h"
#include "visualizers/figure.h"
#include "visualizers/view_camera.h"

namespace sightlines {
namespace {

const ImageSize size{480, 320};

VoxelRowPicture without_objects(VoxelRowPicture picture) {
    picture.objects.clear();
    return picture;
}

TEST(ObjectsView, DrawsTheirVoxelsAndTheirRowsWhereTheyAre) {
    VoxelRowView view;
    VoxelRowPicture picture = small_picture({});
    picture.objects = {small_object("instance 0", {8.2f, 6.6f, 7.0f}, true)};
    ViewState state = voxels_only();
    state.camera = shown_camera(picture, state, size);
    const std::size_t voxels = pixels_drawn(render_solid(view, picture, state, size, 1));
    EXPECT_GT(voxels, 300u);
    state.row = true;
    EXPECT_GT(pixels_drawn(render_solid(view, picture, state, size, 1)),
              pixels_drawn(render_solid(view, without_objects(picture), state, size, 1)) + voxels / 2);
    state.row = state.voxels = false;
    EXPECT_EQ(pixels_drawn(render_solid(view, picture, state, size, 1)), 0u);
    // At another moment it is elsewhere.
    state.voxels = true;
    VoxelRowPicture later = picture;
    later.objects = {small_object("instance 0", {4.0f, 6.6f, 7.0f}, true)};
    EXPECT_NE(render_solid(view, later, state, size, 1), render_solid(view, picture, state, size, 1));
    EXPECT_FALSE(same_solid(later, picture));
}

TEST(ObjectsView, DrawsTheSameWhateverWasDrawnBefore) {
    VoxelRowView view, fresh;
    const VoxelRowPicture picture = picture_with_objects();
    render(view, without_objects(picture), {}, size, 1);
    const ImageRgba8 first = render(view, picture, {}, size, 1);
    render(view, without_objects(picture), {}, size, 1);
    EXPECT_EQ(render(view, picture, {}, size, 1), first);
    EXPECT_EQ(render(fresh, picture, {}, size, 1), first);
}

TEST(ObjectsView, AnObjectHidesTheVoxelsBehindItFromPicking) {
    VoxelRowPicture picture = small_picture({{8, 8, 3}});
    ViewState state = voxels_only();
    state.cut_away = CutAway::none;
    state.camera =
        OrbitCamera{.focal_point = {8.5f, 8.5f, 8.5f}, .azimuth_deg = 0.0f, .elevation_deg = 0.0f, .distance_m = 60.0f};
    const vec2 middle = 0.5f * vec2(size.width, size.height);
    EXPECT_EQ(pick(picture, state, size, middle), ivec3(8, 8, 3));
    picture.objects = {small_object("instance 0", {6.5f, 6.5f, 7.0f}, true)};
    EXPECT_FALSE(pick(picture, state, size, middle));
    picture.objects = {small_object("instance 0", {6.5f, 6.5f, -4.0f}, true)};
    EXPECT_EQ(pick(picture, state, size, middle), ivec3(8, 8, 3)) << "it is behind the voxel";
}

TEST(ObjectsView, SaysWhichObjectIsInTheWay) {
    VoxelRowView view;
    const auto svg_of = [&](const VoxelRowPicture& picture) {
        const auto bytes = voxel_row_figure(view, picture, {}, CanvasFormat::svg, {.dpi = 72.0f});
        return std::string(bytes.begin(), bytes.end());
    };
    const VoxelRowPicture picture = picture_with_objects();
    const std::string svg = svg_of(picture);
    for (const char* const label :
         {"BLOCKED", "by instance 2, which moves; 0 of 5 voxels of what stands still. Embree agrees.",
          "instance 1: lets it by", "instance 2: in the way", "object that was asked"})
        EXPECT_NE(svg.find(">" + std::string(label) + "<"), std::string::npos) << label;
    EXPECT_EQ(svg.find("instance 0"), std::string::npos) << "it is passed by";
    EXPECT_EQ(svg_of(without_objects(picture)).find("object"), std::string::npos);
}

TEST(ObjectsView, IsExportedWithEachObjectsVoxels) {
    const std::filesystem::path folder = std::filesystem::path(SIGHTLINES_TEST_OUTPUT_FOLDER) / "objects-vtk";
    std::filesystem::create_directories(folder);
    InsideView view;
    const auto files =
        write_figure(view, picture_with_objects(), "voxel-row", {}, {.format = FigureFormat::vtk}, folder);
    ASSERT_EQ(files.size(), 6u);
    vtkNew<vtkXMLPolyDataReader> reader;
    reader->SetFileName((folder / "voxel-row-objects.vtp").c_str());
    reader->Update();
    vtkPolyData* const data = reader->GetOutput();
    ASSERT_EQ(data->GetNumberOfPolys(), 2 * 6 * 16) << "two blocks of 4 x 4 x 4";
    for (vtkIdType cell = 0; cell < data->GetNumberOfPolys(); ++cell)
        EXPECT_EQ(data->GetCellData()->GetArray("blocked")->GetTuple1(cell),
                  data->GetCellData()->GetArray("instance")->GetTuple1(cell) == 2.0);
}

TEST(ObjectsView, LooksAsItDid) {
    VoxelRowView view;
    ViewState state;
    state.labels = false;  // text depends on the fonts that are installed
    EXPECT_EQ(
        unlike_golden(render(view, picture_with_objects(), state, {360, 240}, 2), "visualizers", "voxel-row-objects"),
        "");
}

}  // namespace
}  // namespace sightlines
