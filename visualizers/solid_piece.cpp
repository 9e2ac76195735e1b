#include "visualizers/solid_piece.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkProperty.h>
#include <vtkUnsignedCharArray.h>

namespace sightlines {
namespace {

vtkSmartPointer<vtkPolyData> poly_data(const ColouredTriangles& from) {
    vtkNew<vtkFloatArray> positions;
    positions->SetNumberOfComponents(3);
    positions->SetNumberOfTuples(static_cast<vtkIdType>(from.positions.size()));
    std::memcpy(positions->GetPointer(0), from.positions.data(), from.positions.size() * sizeof(vec3));
    vtkNew<vtkPoints> points;
    points->SetData(positions);
    vtkNew<vtkUnsignedCharArray> colours;
    colours->SetNumberOfComponents(3);
    colours->SetNumberOfTuples(static_cast<vtkIdType>(from.colours.size()));
    std::memcpy(colours->GetPointer(0), from.colours.data(), from.colours.size() * sizeof(glm::u8vec3));
    vtkNew<vtkCellArray> cells;
    cells->AllocateExact(static_cast<vtkIdType>(from.triangles.size()),
                         3 * static_cast<vtkIdType>(from.triangles.size()));
    for (const uvec3& triangle : from.triangles) {
        cells->InsertNextCell(3);
        for (int i = 0; i < 3; ++i) cells->InsertCellPoint(triangle[i]);
    }
    auto data = vtkSmartPointer<vtkPolyData>::New();
    data->SetPoints(points);
    data->SetPolys(cells);
    data->GetPointData()->SetScalars(colours);
    return data;
}

}  // namespace

SolidPiece::SolidPiece() {
    mapper->SetColorModeToDirectScalars();
    actor->SetMapper(mapper);
    actor->GetProperty()->LightingOff();  // lit when made
}

void set_triangles(SolidPiece& piece, const ColouredTriangles& triangles) {
    piece.mapper->SetInputData(poly_data(triangles));
}

void set_camera(vtkCamera& camera, const ViewCamera& view, const Box3& bounds) {
    const float centre_m = glm::dot(bounds.centre() - view.position, view.forward);
    const float radius_m = 0.5f * bounds.diagonal();
    const float far_m = std::max(centre_m + radius_m, 1.0f);
    camera.SetPosition(view.position.x, view.position.y, view.position.z);
    const vec3 focal = view.position + view.forward;
    camera.SetFocalPoint(focal.x, focal.y, focal.z);
    camera.SetViewUp(view.up.x, view.up.y, view.up.z);
    camera.SetViewAngle(view_field_of_view_deg);
    camera.SetClippingRange(std::max(centre_m - radius_m, 1e-3f * far_m), far_m);
}

float fitting_distance_m(const ViewCamera& camera, vec3 focal_point, std::span<const vec3> points, vec2 part) {
    const vec2 slope = part * 0.5f * vec2(camera.size.width, camera.size.height) / camera.pixels_per_slope;
    float distance_m = 0.0f;
    for (const vec3& point : points) {
        const vec3 offset = point - focal_point;
        const float behind_m = glm::dot(offset, camera.forward);
        distance_m = std::max({distance_m, std::abs(glm::dot(offset, camera.right)) / slope.x - behind_m,
                               std::abs(glm::dot(offset, camera.up)) / slope.y - behind_m});
    }
    return distance_m;
}

}  // namespace sightlines
