// What the tables of Xu 2022 are measured with: a scene with its tree and its light, and the two ways to make a field.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/bench_tables.h"
#include "techniques/rays/embree_scene.h"
#include "techniques/scene/harmonics.h"
#include "techniques/visibility_field/bake.h"
#include "techniques/visibility_field/measure.h"

namespace sightlines {

/// A scene as the field's tables ask it. Kept in the BenchRun.
struct FieldScene {
    std::string label;  ///< a built-in scene's name or the file's; "sponza" and "bistro" for files called so
    Shared<Scene> scene;
    Shared<SurfaceBuffer> surfaces;
    std::shared_ptr<const EmbreeScene> embree;  ///< EmbreeUse::benchmark
    Harmonics light;
};

/// One way to make and to use a field.
struct FieldWay {
    std::string suffix;  ///< of the quantities' names: "", " (plain)", " (finer)"
    visibility_field::BakeOptions bake;
    visibility_field::RayOrder order = visibility_field::RayOrder::direction;
    visibility_field::Culling culling = visibility_field::Culling::label;
    float roughness = 0.0f;  ///< more than 0: surfaces are glossy, and samples drawn by what they reflect
    bool indirect = false;   ///< surfaces light each other once
};

/// Samples a pixel of the table with this number, where it does not vary them: the paper's, few with --quick.
int field_samples(const BenchRun& run, int number);

/// The library's defaults, and after them the paper's choices: random points, dilated by a texel, equation 8, rays in
/// the order of pixels. Few points with --quick.
std::vector<FieldWay> field_ways(const BenchRun& run, const Results& results);

/// The same with masks of 32 x 32 texels.
FieldWay with_finer_masks(FieldWay way);

/// What all measurements of one of the field's tables go through.
struct FieldMeasuring {
    MeasuredTable& table;
    BenchRun& run;
    Results& results;
    Progress& progress;
};

/// How a figure stands in its row.
struct FieldFigure {
    std::string_view quantity, unit;
    int digits = 1;
    bool in_chart = true;
};

/// The scenes that the run asks for, else `usual`.
std::vector<std::string> field_scenes(const FieldMeasuring& m, const std::string& usual);

/// Loads and builds, once in a run.
std::shared_ptr<const FieldScene> field_scene(FieldMeasuring& m, const std::string& name);

/// Nothing, and a note, where memory does not suffice for it.
std::optional<visibility_field::VisibilityField> bake_field(FieldMeasuring& m, const FieldScene& scene,
                                                            const visibility_field::BakeOptions& options);

visibility_field::FieldMeasurement measure_field(FieldMeasuring& m, const FieldScene& scene,
                                                 const visibility_field::VisibilityField& field, const FieldWay& way,
                                                 int samples);

/// Adds the way's row, with the paper's figure beside the first way's.
void add_field_figure(FieldMeasuring& m, const FieldScene& scene, const FieldWay& way, const FieldFigure& figure,
                      double ours, double at = 0.0, const std::string& setting = "");

/// Adds what the paper gives of scenes and settings that were not measured, for the figures listed; the table's setup;
/// the notes that all of the field's tables share.
void finish_field_table(FieldMeasuring& m, const std::vector<FieldFigure>& figures, std::string_view setting_unit);

}  // namespace sightlines
