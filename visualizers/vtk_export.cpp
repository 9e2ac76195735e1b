#include "visualizers/vtk_export.h"

#include <array>
#include <initializer_list>
#include <string>
#include <utility>

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkFloatArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkXMLPolyDataWriter.h>

#include "techniques/base/error.h"
#include "techniques/base/files.h"
#include "visualizers/voxel_surface.h"

namespace sightlines {
namespace {

/// Cells with their own points and one integer array a name.
struct Cells {
    vtkNew<vtkPoints> points;
    vtkNew<vtkCellArray> cells;
    std::vector<vtkSmartPointer<vtkIntArray>> data;

    explicit Cells(std::initializer_list<const char*> names) {
        points->SetDataTypeToFloat();
        for (const char* const name : names) {
            data.push_back(vtkSmartPointer<vtkIntArray>::New());
            data.back()->SetName(name);
        }
    }
    void add(std::span<const vec3> corners, std::initializer_list<int> values) {
        cells->InsertNextCell(static_cast<int>(corners.size()));
        for (const vec3& corner : corners)
            cells->InsertCellPoint(points->InsertNextPoint(corner.x, corner.y, corner.z));
        std::size_t array = 0;
        for (const int value : values) data[array++]->InsertNextValue(value);
    }
    vtkSmartPointer<vtkPolyData> finished(bool lines) const {
        auto out = vtkSmartPointer<vtkPolyData>::New();
        out->SetPoints(points);
        if (lines)
            out->SetLines(cells);
        else
            out->SetPolys(cells);
        for (const auto& array : data) out->GetCellData()->AddArray(array);
        return out;
    }
};

std::array<vec3, 4> world_corners(const VoxelRowPicture& picture, const VoxelFace& face) {
    std::array<vec3, 4> corners;
    for (std::size_t i = 0; i < 4; ++i) corners[i] = world_point(picture, vec3(face.corners[i]));
    return corners;
}

std::vector<VoxelFace> all_faces(const VoxelRowPicture& picture) {
    return voxel_faces(picture, {ivec3(0), ivec3(picture.resolution - 1)});
}

ivec3 voxel_of(const VoxelFace& face) {
    ivec3 voxel = glm::min(glm::min(face.corners[0], face.corners[1]), glm::min(face.corners[2], face.corners[3]));
    if (face.towards_higher) --voxel[face.axis];
    return voxel;
}

vtkSmartPointer<vtkPolyData> voxels_data(const VoxelRowPicture& picture) {
    Cells cells{"u", "v", "w"};
    for (const VoxelFace& face : all_faces(picture)) {
        const ivec3 voxel = voxel_of(face);
        cells.add(world_corners(picture, face), {voxel.x, voxel.y, voxel.z});
    }
    return cells.finished(false);
}

/// The voxels of the objects that move; (u, v, w) count in each one's own voxelization.
vtkSmartPointer<vtkPolyData> objects_data(const VoxelRowPicture& picture) {
    Cells cells{"instance", "blocked", "u", "v", "w"};
    int instance = 0;
    for (const ObjectPicture& object : picture.objects) {
        if (object.rows)
            for (const VoxelFace& face : all_faces(*object.rows)) {
                const ivec3 voxel = voxel_of(face);
                cells.add(world_corners(*object.rows, face),
                          {instance, object.blocked ? 1 : 0, voxel.x, voxel.y, voxel.z});
            }
        ++instance;
    }
    return cells.finished(false);
}

vtkSmartPointer<vtkPolyData> bits_data(const VoxelRowPicture& picture) {
    Cells cells{"u", "set", "kept"};
    for (int u = 0; u < picture.resolution; ++u) {
        const ivec3 voxel{u, picture.v, picture.w};
        for (int side = 0; side < 6; ++side) {
            const int axis = side / 2, across = (axis + 1) % 3, along = (axis + 2) % 3;
            std::array<vec3, 4> corners;
            for (std::size_t i = 0; i < 4; ++i) {
                ivec3 corner = voxel;
                corner[axis] += side % 2;
                corner[across] += i == 1 || i == 2 ? 1 : 0;
                corner[along] += i >= 2 ? 1 : 0;
                corners[i] = world_point(picture, vec3(corner));
            }
            cells.add(corners, {u, is_set(picture, voxel) ? 1 : 0, u >= picture.first && u <= picture.last ? 1 : 0});
        }
    }
    return cells.finished(false);
}

vtkSmartPointer<vtkPolyData> ray_data(const VoxelRowPicture& picture) {
    Cells cells{"twin"};
    const Segment twin = twin_of(picture);
    cells.add(std::array{picture.ray.origin, picture.ray.target}, {0});
    cells.add(std::array{twin.origin, twin.target}, {1});
    return cells.finished(true);
}

vtkSmartPointer<vtkPolyData> scene_data(const Scene& scene) {
    vtkNew<vtkPoints> points;
    points->SetDataTypeToFloat();
    for (const vec3& p : scene.positions) points->InsertNextPoint(p.x, p.y, p.z);
    vtkNew<vtkFloatArray> normals;
    normals->SetName("Normals");
    normals->SetNumberOfComponents(3);
    for (const vec3& n : scene.normals) normals->InsertNextTuple3(n.x, n.y, n.z);
    vtkNew<vtkCellArray> triangles;
    for (const uvec3& t : scene.triangles) triangles->InsertNextCell({t.x, t.y, t.z});
    auto out = vtkSmartPointer<vtkPolyData>::New();
    out->SetPoints(points);
    out->SetPolys(triangles);
    if (scene.normals.size() == scene.positions.size()) out->GetPointData()->SetNormals(normals);
    return out;
}

/// The file's bytes are made in memory first, so that write_file can put them in place whole.
void write_piece(const std::filesystem::path& file, vtkPolyData* data) {
    vtkNew<vtkXMLPolyDataWriter> writer;
    writer->SetInputData(data);
    writer->SetDataModeToAppended();
    writer->EncodeAppendedDataOff();
    writer->SetCompressorTypeToZLib();
    writer->WriteToOutputStringOn();
    if (!writer->Write()) throw EnvironmentError(file.string(), "VTK could not make the file", "free some memory");
    write_file(file, std::string_view(writer->GetOutputString()));
}

}  // namespace

std::vector<std::filesystem::path> write_voxel_row_vtk(const VoxelRowPicture& picture,
                                                       const std::filesystem::path& folder) {
    const std::filesystem::path index = folder / "voxel-row.vtm";
    check_writable(index);
    std::vector<std::filesystem::path> files{index};
    std::string blocks;
    const auto write = [&](const std::string& name, vtkPolyData* data) {
        const std::string file = "voxel-row-" + name + ".vtp";
        write_piece(folder / file, data);
        blocks += "    <DataSet index=\"" + std::to_string(files.size() - 1) + "\" name=\"" + name + "\" file=\"" +
                  file + "\"/>\n";
        files.push_back(folder / file);
    };
    write("voxels", voxels_data(picture));
    write("bits", bits_data(picture));
    write("ray", ray_data(picture));
    if (!picture.objects.empty()) write("objects", objects_data(picture));
    if (picture.scene) write("scene", scene_data(*picture.scene));
    write_file(index,
               "<?xml version=\"1.0\"?>\n<VTKFile type=\"vtkMultiBlockDataSet\" version=\"1.0\" "
               "byte_order=\"LittleEndian\">\n  <vtkMultiBlockDataSet>\n" +
                   blocks + "  </vtkMultiBlockDataSet>\n</VTKFile>\n");
    return files;
}

}  // namespace sightlines
