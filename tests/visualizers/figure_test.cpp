#include "visualizers/figure.h"

#include <gtest/gtest.h>

#include <fstream>

#include <vtkCellData.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkXMLPolyDataReader.h>

#include "techniques/base/error.h"
#include "techniques/base/files.h"
#include "visualizer_testing.h"
#include "visualizers/voxel_surface.h"

namespace sightlines {
namespace {

namespace fs = std::filesystem;

/// An empty folder of this test's own.
fs::path fresh_folder(const std::string& name) {
    const fs::path folder = fs::path(SIGHTLINES_TEST_OUTPUT_FOLDER) / ("figure-" + name);
    fs::remove_all(folder);
    fs::create_directories(folder);
    return folder;
}

/// Whether every tag is closed in order and every quote is; enough to tell whole XML from half.
bool is_balanced_xml(const std::string& xml) {
    std::vector<std::string> open;
    for (std::size_t at = xml.find('<'); at != std::string::npos; at = xml.find('<', at + 1)) {
        const std::size_t end = xml.find('>', at);
        if (end == std::string::npos) return false;
        const std::string tag = xml.substr(at + 1, end - at - 1);
        if (std::ranges::count(tag, '"') % 2 != 0) return false;
        if (tag.starts_with('?') || tag.starts_with('!') || tag.ends_with('/')) continue;
        const std::string name =
            tag.substr(tag.starts_with('/') ? 1 : 0, tag.find_first_of(" \n/", 1) - (tag.starts_with('/') ? 1 : 0));
        if (!tag.starts_with('/'))
            open.push_back(tag.substr(0, tag.find_first_of(" \n")));
        else if (open.empty() || open.back() != name)
            return false;
        else
            open.pop_back();
    }
    return open.empty();
}

std::string figure_text(CanvasFormat format) {
    VoxelRowView view;
    const std::vector<std::uint8_t> bytes = voxel_row_figure(view, furnished_picture(), {}, format, {.dpi = 72.0f});
    return {bytes.begin(), bytes.end()};
}

TEST(Figure, TheSvgIsWholeXmlAndHoldsItsLabelsAsText) {
    const std::string svg = figure_text(CanvasFormat::svg);
    EXPECT_TRUE(is_balanced_xml(svg));
    for (const char* const label : {">s = 3<", ">e = 12<", ">BLOCKED<", ">2.12\u00b0<", ">surface point<", ">light<",
                                    ">2 of 10 voxels looked at are set. Embree agrees.<",
                                    ">row v 8, w 8 at \u03b8 0\u00b0, \u03c6 90\u00b0 of 16\u00b3 voxels<"})
        EXPECT_NE(svg.find(label), std::string::npos) << label;
}

TEST(Figure, ThePdfIsAPdf) {
    const std::string pdf = figure_text(CanvasFormat::pdf);
    EXPECT_TRUE(pdf.starts_with("%PDF-"));
    EXPECT_NE(pdf.rfind("%%EOF"), std::string::npos);
    EXPECT_GT(pdf.size(), 10000u);
}

TEST(Figure, TheSameInputGivesTheSameFile) {
    for (const CanvasFormat format : {CanvasFormat::png, CanvasFormat::svg, CanvasFormat::pdf})
        EXPECT_EQ(figure_text(format), figure_text(format));
}

TEST(Figure, DotsPerInchSetTheSizeOfThePng) {
    const fs::path folder = fresh_folder("dpi");
    InsideView view;
    write_figure(view, furnished_picture(), "voxel-row", {}, {.dpi = 72.0f, .width_mm = 127.0f}, folder);
    const ImageRgba8 small = read_png(folder / "voxel-row.png");
    EXPECT_EQ(small.size.width, 360);
    write_figure(view, furnished_picture(), "voxel-row", {}, {.dpi = 144.0f, .width_mm = 127.0f}, folder);
    EXPECT_EQ(read_png(folder / "voxel-row.png").size.width, 720);
}

TEST(Figure, APrintedFigureHasNoBackground) {
    const fs::path folder = fresh_folder("print");
    InsideView view;
    ViewState state;
    state.theme = Theme::print;
    write_figure(view, furnished_picture(), "voxel-row", state, {.dpi = 72.0f}, folder);
    const ImageRgba8 figure = read_png(folder / "voxel-row.png");
    EXPECT_EQ(figure.at(figure.size.width - 1, figure.size.height - 1).a, 0);
}

TEST(Figure, ImpossibleSizesAreRefused) {
    VoxelRowView view;
    for (const FigureOptions& options : {FigureOptions{.dpi = 0.0f}, FigureOptions{.dpi = 5000.0f},
                                         FigureOptions{.width_mm = 1.0f}, FigureOptions{.width_mm = 1e9f}})
        EXPECT_THROW(voxel_row_figure(view, furnished_picture(), {}, CanvasFormat::png, options), InputError);
    EXPECT_THROW(parse_figure_format("gif"), InputError);
    EXPECT_EQ(parse_figure_format("pdf"), FigureFormat::pdf);
}

TEST(Figure, AFolderThatIsNotThereIsAnEnvironmentErrorAndLeavesNothing) {
    InsideView view;
    const fs::path missing = fresh_folder("missing") / "deeper";
    for (const FigureFormat format : {FigureFormat::png, FigureFormat::vtk})
        EXPECT_THROW(write_figure(view, furnished_picture(), "voxel-row", {}, {.format = format}, missing),
                     EnvironmentError);
    EXPECT_FALSE(fs::exists(missing));
}

vtkSmartPointer<vtkPolyData> read_piece(const fs::path& file) {
    vtkNew<vtkXMLPolyDataReader> reader;
    reader->SetFileName(file.c_str());
    reader->Update();
    return reader->GetOutput();
}

TEST(VtkExport, TheFilesReadBackWithEveryFaceBitAndTriangle) {
    const fs::path folder = fresh_folder("vtk");
    const VoxelRowPicture picture = furnished_picture();
    InsideView view;
    const std::vector<fs::path> files =
        write_figure(view, picture, "voxel-row", {}, {.format = FigureFormat::vtk}, folder);
    ASSERT_EQ(files.size(), 5u);
    EXPECT_EQ(files.front().filename(), "voxel-row.vtm");
    for (const fs::path& file : files) EXPECT_TRUE(fs::is_regular_file(file)) << file;

    const auto voxels = read_piece(folder / "voxel-row-voxels.vtp");
    EXPECT_EQ(voxels->GetNumberOfPolys(), static_cast<vtkIdType>(voxel_faces(picture, {ivec3(0), ivec3(15)}).size()));
    vtkDataArray* const u = voxels->GetCellData()->GetArray("u");
    vtkDataArray* const v = voxels->GetCellData()->GetArray("v");
    vtkDataArray* const w = voxels->GetCellData()->GetArray("w");
    ASSERT_TRUE(u && v && w);
    for (vtkIdType cell = 0; cell < voxels->GetNumberOfPolys(); ++cell)
        EXPECT_TRUE(is_set(picture, ivec3(u->GetTuple1(cell), v->GetTuple1(cell), w->GetTuple1(cell))));

    const auto bits = read_piece(folder / "voxel-row-bits.vtp");
    EXPECT_EQ(bits->GetNumberOfPolys(), 16 * 6);
    int set = 0, kept = 0;
    for (vtkIdType cell = 0; cell < bits->GetNumberOfPolys(); cell += 6) {
        set += static_cast<int>(bits->GetCellData()->GetArray("set")->GetTuple1(cell));
        kept += static_cast<int>(bits->GetCellData()->GetArray("kept")->GetTuple1(cell));
    }
    EXPECT_EQ(set, 3);
    EXPECT_EQ(kept, 10);

    const auto ray = read_piece(folder / "voxel-row-ray.vtp");
    ASSERT_EQ(ray->GetNumberOfLines(), 2);
    EXPECT_NEAR(ray->GetPoint(0)[0], picture.ray.origin.x, 1e-6);
    EXPECT_EQ(read_piece(folder / "voxel-row-scene.vtp")->GetNumberOfPolys(), 2);

    const std::vector<std::uint8_t> index = read_file(files.front(), 1 << 20);
    EXPECT_TRUE(is_balanced_xml({index.begin(), index.end()}));
}

}  // namespace
}  // namespace sightlines
