#include "app/bench_measure.h"

#include <algorithm>
#include <array>
#include <fstream>

#include "techniques/base/median.h"

namespace sightlines {

bool deforms(std::string_view scene) { return scene == "bear" || scene == "park"; }

bool moves(std::string_view scene) { return deforms(scene) || scene == "planes"; }

Variant rows_with(bool compressed, ParameterValues values) {
    values["compression"] = compressed ? 1.0 : 0.0;
    return {"voxel_rows", std::move(values)};
}

Variant rows_for(std::string_view scene) { return rows_with(!deforms(scene)); }

Session session_of(const BenchRun& run, std::string_view scene, const Variant& variant, std::uint32_t lights) {
    Session session = run.base;
    session.scene = scene;
    session.technique = variant.technique;
    for (const auto& [name, value] : variant.values) session.parameters[variant.technique][name] = value;
    if (!find_technique(variant.technique).on_vulkan) session.backend = BackendChoice::cpu;
    if (lights > 0)
        session.lights.count = lights;
    else if (run.own_lights && scene == "park")
        session.lights.count = 0;
    return session;
}

MeanErrors errors_of(BenchRun& run, const Session& asked, Results& results, Progress& progress) {
    Session session = asked;
    session.reference = true;
    const std::string key = json_from_session(picture_part(session)).dump();
    const auto known = run.known_errors.find(key);
    if (known != run.known_errors.end()) return known->second;
    const ErrorMetrics errors = results.errors(session, progress)->value;
    const double percent_of_all = 100.0 / static_cast<double>(results.lights(session, progress)->value.size());
    return run.known_errors[key] = {errors.visibility_percent, errors.shadow_percent,
                                    percent_of_all * errors.wrong_rays, percent_of_all * errors.uncancelled_rays};
}

std::uint32_t light_sets(std::uint32_t lights, std::uint32_t enough) {
    return lights == 0 ? 1u : std::max(1u, (enough + lights - 1) / lights);
}

MeanErrors mean_errors(BenchRun& run, Session session, std::uint32_t sets, Results& results, Progress& progress) {
    MeanErrors mean;
    for (std::uint32_t set = 0; set < sets; ++set, ++session.seed) {
        const MeanErrors errors = errors_of(run, session, results, progress);
        mean.visibility += errors.visibility / sets;
        mean.shadow += errors.shadow / sets;
        mean.visibility_of_all += errors.visibility_of_all / sets;
        mean.shadow_of_all += errors.shadow_of_all / sets;
    }
    return mean;
}

std::vector<double> median_seconds(const BenchRun& run, const std::vector<std::function<double()>>& asks,
                                   Progress& progress) {
    std::vector<std::vector<double>> seconds(asks.size());
    for (int repetition = -1; repetition < run.repetitions; ++repetition)
        for (std::size_t i = 0; i < asks.size(); ++i) {
            progress.check();
            const double took = asks[i]();
            if (repetition >= 0) seconds[i].push_back(took);
        }
    std::vector<double> medians;
    for (const auto& each : seconds) medians.push_back(median(each));
    return medians;
}

Prepared prepare(const Session& session, Results& results, Progress& progress) {
    Prepared prepared{session, results.surfaces(session, progress), results.lights(session, progress), nullptr};
    prepared.structure = results.structure(session, progress);
    return prepared;
}

Prepared with_values(Prepared prepared, const ParameterValues& values) {
    for (const auto& [name, value] : values) prepared.session.parameters[prepared.session.technique][name] = value;
    return prepared;
}

double render_seconds(const Prepared& prepared, Results& results, Progress& progress, std::string& device) {
    const PictureRequest asked =
        results.request(prepared.session, prepared.surfaces->value, prepared.lights->value, progress);
    const BuiltStructure& built = prepared.structure->value;
    const RenderResult picture = built.technique->render(built.structure, asked.request, progress);
    device = picture.device;
    return picture.seconds;
}

std::string processor_name() {
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);) {
        const std::size_t colon = line.find(':');
        if (line.starts_with("model name") && colon != std::string::npos && colon + 2 < line.size())
            return line.substr(colon + 2);
    }
    return "";
}

}  // namespace sightlines
