// Algorithm 1: casting rays from point samples of the surface and merging what they see.
#pragma once

#include <cstdint>

#include "techniques/base/progress.h"
#include "techniques/rays/embree_scene.h"
#include "techniques/scene/scene.h"
#include "techniques/visibility_field/field.h"
#include "techniques/visibility_field/points.h"

namespace sightlines::visibility_field {

/// How a cell's label is found. `texels`: 1 where more than half of the occlusion mask is set (equation 8). `smaller`:
/// 1 where more texels are set in the occlusion mask than in the visibility mask, so that the smaller region is traced;
/// points of one plane see half of the sphere only, so that equation 8 hardly ever calls their cell occluded.
enum class LabelRule { texels, smaller };

struct BakeOptions {
    float cell_m = 0.5f;               ///< side of a grid cell
    int mask_size = 18;                ///< texels along a side of each mask, 8 to 64
    std::uint32_t points = 4'000'000;  ///< point samples; a stratified bake may take a few more
    int rays = 64;                     ///< from each point sample, 1 to 4,096
    int probes = 128;  ///< 0 to 4,096, or the cell's points if more: rays into a texel beside a mask's; 0: dilation
    float dilation = 1.0f / 3.0f;  ///< without probes: texels, 0 to 2, in steps of 1 / casting_steps; 1 in the paper
    Placement placement = Placement::stratified;
    LabelRule label = LabelRule::smaller;
    std::uint64_t seed = 1;
    int threads = 0;
};

/// Into how many parts each side of a texel is divided while rays are cast, so that dilation can be by less than a
/// texel: as many as fit into 64 (3 for 18 x 18).
int casting_steps(int mask_size);

/// InputError for options out of range, EnvironmentError where memory does not suffice.
void check_bake(const Scene& scene, const BakeOptions& options);

/// The field of a scene; `embree` was built from it. A pure function of scene and options, whatever the threads.
/// Materials that are not double-sided are sampled on their front only. A scene without surface, or no samples, gives a
/// field whose cells hold nothing, so that every ray is traced. Scenes that move are baked as moving_bake.h says.
/// Throws as check_bake does; Cancelled. `kept`: where not null, gets the samples that were cast from; of a
/// scene that moves, those of what moves.
VisibilityField bake(const Scene& scene, const EmbreeScene& embree, const BakeOptions& options, Progress& progress,
                     CellPoints* kept = nullptr);

/// What each point sample of a cell sees by itself, not dilated: for the lesson that steps through the merging (Figure
/// 3).
struct CellSteps {
    CellPoints points;                                 ///< of this cell alone
    std::vector<std::vector<std::uint32_t>> visible;   ///< [points][words_per_mask]
    std::vector<std::vector<std::uint32_t>> occluded;  ///< [points][words_per_mask]
};

/// The samples of one cell (samples_in), cast from once more.
CellSteps bake_steps(CellPoints samples, const EmbreeScene& embree, const BakeOptions& options);

}  // namespace sightlines::visibility_field
