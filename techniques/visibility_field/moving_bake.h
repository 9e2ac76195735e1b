// Fields of scenes that move. What stands still is baked once, with the answer to each of its rays; for each moment
// only those cells are baked again whose rays can have changed, and of their rays only those that nothing standing
// still blocks are cast, at what moves. The paper names scenes that move as future work (section 7).
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "techniques/base/progress.h"
#include "techniques/rays/embree_scene.h"
#include "techniques/scene/scene.h"
#include "techniques/visibility_field/bake.h"
#include "techniques/visibility_field/cell_masks.h"

namespace sightlines::visibility_field {

/// What all moments of a scene share. Immutable.
struct FixedField {
    VisibilityField field;                      ///< as if nothing else were there; its grid is round all moments
    double changing_share = 0.0;                ///< changing_share() of the scene
    float lift_m = 0.0f;                        ///< how far above the surface its rays start
    CellPoints points;                          ///< on what stands still
    std::vector<std::uint32_t> blocked;         ///< [points][words_of_rays]: the rays that meet what stands still
    std::vector<std::uint8_t> labels;           ///< [cells]
    MaskNumbers mask_numbers;                   ///< of `field.masks`
    std::shared_ptr<const EmbreeScene> embree;  ///< of what stands still
    double seconds = 0.0;                       ///< that it took
};

/// By how much more surface there is to place samples on than what stands still, to a power of two, so that samples
/// need not be placed anew for every moment: 0 for less than 1/32. Infinite where nothing stands still.
double changing_share(const Scene& scene);

/// The field of what never changes in the scene. Its samples are as dense as those of all surfaces together, by
/// changing_share. Throws as bake does.
std::shared_ptr<const FixedField> bake_fixed(const Scene& scene, const BakeOptions& options, Progress& progress);

/// Whether the field is that of this scene, too, at its own moment; scene and options must otherwise be the same.
bool serves(const FixedField& fixed, const Scene& scene, const BakeOptions& options);

/// The field of a moment: as if all samples had been cast at the whole scene. The same whatever moment `fixed` was
/// baked from, as long as it serves. `embree` was built from the scene. Throws as bake does. `kept`: where not null,
/// gets the samples of what moves.
VisibilityField bake_moment(const FixedField& fixed, const Scene& scene, const EmbreeScene& embree,
                            const BakeOptions& options, Progress& progress, CellPoints* kept = nullptr);

/// The samples of one cell: those of `fixed` (may be null) before the others.
CellPoints samples_in(const FieldShape& shape, ivec3 place, const CellPoints& samples, const CellPoints* fixed);

}  // namespace sightlines::visibility_field
