// What the views in space share: coloured triangles as VTK draws them, and one camera for VTK and for the marks on top.
// For the .cpp files of this folder only: it shows VTK's types.
#pragma once

#include <span>
#include <utility>

#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkNew.h>
#include <vtkPolyDataMapper.h>

#include "visualizers/view_camera.h"
#include "visualizers/view_geometry.h"

namespace sightlines {

/// Triangles with their own colours, drawn as they are.
struct SolidPiece {
    vtkNew<vtkPolyDataMapper> mapper;
    vtkNew<vtkActor> actor;

    SolidPiece();
};

void set_triangles(SolidPiece& piece, const ColouredTriangles& triangles);

/// A piece that is made again only when what it was made from, `Key`, changes.
template <class Key>
struct KeptPiece {
    SolidPiece solid;
    Key made_from{};
};

template <class Key, class Make>
void keep_made(KeptPiece<Key>& piece, bool visible, Key from, const Make& make) {
    piece.solid.actor->SetVisibility(visible);
    if (!visible || piece.made_from == from) return;
    set_triangles(piece.solid, make());
    piece.made_from = std::move(from);
}

/// The same view for VTK; near and far planes round the bounds, m.
void set_camera(vtkCamera& camera, const ViewCamera& view, const Box3& bounds);

/// The distance from which every point falls within `part` of the picture's half width and half height.
float fitting_distance_m(const ViewCamera& camera, vec3 focal_point, std::span<const vec3> points, vec2 part);

}  // namespace sightlines
