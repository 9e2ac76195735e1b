// Visibility field: Xu et al. 2022, "Precomputed Discrete Visibility Fields for Real-Time Ray-Traced Environment
// Lighting". The technique's row in the catalog, and what a view asks beyond that.
#pragma once

#include "techniques/technique.h"
#include "techniques/visibility_field/area_sight.h"
#include "techniques/visibility_field/bake.h"
#include "techniques/visibility_field/moving_bake.h"
#include "techniques/visibility_field/trace.h"
#include "techniques/visibility_field/vulkan_backend.h"

namespace sightlines::visibility_field {

const Technique& technique();

/// What `technique().build` makes.
struct BuiltField {
    VisibilityField field;
    CellPoints points;                        ///< that it was baked from; where the scene moves, those of what moves
    std::shared_ptr<const FixedField> fixed;  ///< where the scene moves: what its other moments can use
    BakeOptions options;
    std::shared_ptr<const EmbreeScene> embree;       ///< that answers what the field leaves open
    AreaSight area_sight;                            ///< empty where nothing shines, or the scene moves
    std::optional<DenseField> dense;                 ///< where the paper's layout is asked for
    std::shared_ptr<const FieldOnDevice> on_device;  ///< where it was built for Vulkan
    double build_seconds = 0.0;
};

/// The field inside a structure that `technique().build` made.
const BuiltField& built_field(const Structure& structure);

/// The point samples of a cell.
CellPoints samples_of(const BuiltField& built, ivec3 place);

/// Which rays of a picture with these parameters are traced.
Culling culling_of(const ParameterValues& parameters);

}  // namespace sightlines::visibility_field
