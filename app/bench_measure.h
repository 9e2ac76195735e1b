// What the tables are measured with: sessions, errors that are asked once, times that are measured in turn.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/results.h"

namespace sightlines {

struct FieldScene;  // bench_field.h

/// Errors in percent (ErrorMetrics): of the rays that are asked, and of all lights.
struct MeanErrors {
    double visibility = 0.0, shadow = 0.0;
    double visibility_of_all = 0.0, shadow_of_all = 0.0;
};

/// What all tables of one run share.
struct BenchRun {
    Session base;                     ///< picture, seed, camera; the parameters of voxel rows for all tables
    std::vector<std::string> scenes;  ///< instead of the tables' own; empty: those
    bool own_lights = true;           ///< a scene of the paper with its own number of lights keeps that
    bool quick = false;
    int repetitions = 3;
    std::function<void(const std::string&)> say;  ///< what is being measured; may be empty
    std::map<std::string, MeanErrors> known_errors;
    std::map<std::string, std::shared_ptr<const FieldScene>> field_scenes;  ///< by name, for the visibility field
};

/// A technique with the parameters that differ from the run's.
struct Variant {
    std::string technique;
    ParameterValues values;
};

/// Voxel rows as the paper's tables have them: compressed, and as they are where the scene deforms, since the array is
/// then built for every picture.
Variant rows_for(std::string_view scene);
Variant rows_with(bool compressed, ParameterValues values = {});
/// Whether every picture needs a new structure of rows (the bear, the park).
bool deforms(std::string_view scene);
/// Whether every picture needs a new hierarchy of triangles.
bool moves(std::string_view scene);

/// Lights 0: the run's own choice for that scene.
Session session_of(const BenchRun& run, std::string_view scene, const Variant& variant, std::uint32_t lights = 0);

/// Against Embree; each session is asked once in a run.
MeanErrors errors_of(BenchRun& run, const Session& session, Results& results, Progress& progress);

/// How many sets of lights, each by another seed, together have at least `enough` lights; 1 where one has.
std::uint32_t light_sets(std::uint32_t lights, std::uint32_t enough);

/// The mean of the errors with `sets` sets of lights, by the session's seed and those that follow it: one set of a few
/// lights is too small a sample of the places where lights may be.
MeanErrors mean_errors(BenchRun& run, Session session, std::uint32_t sets, Results& results, Progress& progress);

/// Seconds of the medians, one for each of `asks`: every repetition asks each of them once, in turn, after one round
/// that does not count.
std::vector<double> median_seconds(const BenchRun& run, const std::vector<std::function<double()>>& asks,
                                   Progress& progress);

/// A structure with all that a picture of it needs, kept alive.
struct Prepared {
    Session session;
    Shared<SurfaceBuffer> surfaces;
    Shared<std::vector<Light>> lights;
    Shared<BuiltStructure> structure;
};
Prepared prepare(const Session& session, Results& results, Progress& progress);

/// The same structure, asked with other parameters that only change the picture.
Prepared with_values(Prepared prepared, const ParameterValues& values);

/// Seconds of one picture, without verdicts; `device` becomes what made it.
double render_seconds(const Prepared& prepared, Results& results, Progress& progress, std::string& device);

/// "AMD EPYC, 2 threads" or the like; empty where the system does not tell.
std::string processor_name();

}  // namespace sightlines
