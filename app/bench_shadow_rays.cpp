#include "app/bench_shadow_rays.h"

#include <algorithm>
#include <chrono>
#include <functional>
#include <tuple>

#include "techniques/base/error.h"
#include "techniques/base/huge_buffer.h"
#include "techniques/voxel_rows/voxel_rows.h"

namespace sightlines {
namespace {

constexpr const char* uncompressed_key = "_uncompressed";

/// A row of the table and how it is measured once.
struct Contestant {
    BenchRow row;
    std::function<QueryCount()> ask;
};

/// Measures once; false where the machine cannot.
bool measure(Contestant& contestant, bool counts, std::vector<std::string>& notes) {
    try {
        const QueryCount asked = contestant.ask();
        contestant.row.rays = asked.rays;
        contestant.row.blocked = asked.blocked;
        if (counts) contestant.row.seconds.push_back(asked.seconds);
        return true;
    } catch (const EnvironmentError& error) {
        notes.push_back(contestant.row.title + " is left out: " + error.what());
        return false;
    }
}

/// The array on both backends. `request` must outlive them.
void add_rows(std::vector<Contestant>& contestants, const Shared<BuiltStructure>& structure,
              const RenderRequest& request, const std::string& key_end, const std::string& title_end) {
    const auto on = [&](Backend backend) {
        return [structure, &request, backend] {
            RenderRequest asked = request;
            asked.backend = backend;
            return voxel_rows::count_blocked(structure->value.structure, asked);
        };
    };
    contestants.push_back({{"voxel_rows_cpu" + key_end, "voxel rows, CPU" + title_end, 0, 0, {}}, on(Backend::cpu)});
    contestants.push_back(
        {{"voxel_rows_vulkan" + key_end, "voxel rows, Vulkan" + title_end, 0, 0, {}}, on(Backend::vulkan)});
}

/// How many times as long the compressed array takes as the uncompressed one; null where either was not asked.
Json compression_cost(const ShadowRayBench& bench, const std::string& key) {
    const auto rate_of = [&](const std::string& of) {
        const auto row = std::ranges::find(bench.rows, of, &BenchRow::key);
        return row == bench.rows.end() ? std::nullopt : median_rays_per_second(*row);
    };
    const auto compressed = rate_of(key), uncompressed = rate_of(key + uncompressed_key);
    return compressed && uncompressed ? Json(*uncompressed / *compressed) : Json();
}

/// The best median of Embree's variants, rays a second.
double best_embree(const ShadowRayBench& bench) {
    double best = 0.0;
    for (const BenchRow& row : bench.rows)
        if (row.key.starts_with("embree")) best = std::max(best, median_rays_per_second(row).value_or(0.0));
    return best;
}

Json ratio(const ShadowRayBench& bench, std::string_view key) {
    const auto row = std::ranges::find(bench.rows, key, &BenchRow::key);
    const auto rate = median_rays_per_second(*row);
    const double best = best_embree(bench);
    return rate && best > 0.0 ? Json(*rate / best) : Json();
}

}  // namespace

std::optional<double> median_rays_per_second(const BenchRow& row) {
    if (row.seconds.empty()) return std::nullopt;
    std::vector<double> sorted = row.seconds;
    std::ranges::sort(sorted);
    const std::size_t middle = sorted.size() / 2;
    const double median = sorted.size() % 2 == 1 ? sorted[middle] : 0.5 * (sorted[middle - 1] + sorted[middle]);
    return median > 0.0 ? static_cast<double>(row.rays) / median : 0.0;
}

ShadowRayBench bench_shadow_rays(const Session& session, int repetitions, Results& results, Progress& progress) {
    Session on_cpu = session;
    on_cpu.backend = BackendChoice::cpu;
    const auto scene = results.scene(session, progress);
    const auto surfaces = results.surfaces(session, progress);
    const auto lights = results.lights(session, progress);
    const auto start = std::chrono::steady_clock::now();
    const auto embree = build_embree_scene(scene->value, EmbreeUse::benchmark, results.threads(), progress);
    const double embree_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const auto structure = results.structure(on_cpu, progress);

    RenderRequest request;
    request.surfaces = &surfaces->value;
    request.lights = lights->value;
    request.parameters = technique_parameters(session);
    request.threads = results.threads();
    std::vector<Contestant> contestants;
    add_rows(contestants, structure, request, "", "");
    if (voxel_rows::is_compressed(request.parameters)) {
        Session plain = on_cpu;
        plain.parameters[plain.technique]["compression"] = 0.0;
        add_rows(contestants, results.structure(plain, progress), request, uncompressed_key, ", uncompressed");
    }
    const auto embree_by = [&](EmbreeVariant variant) {
        return
            [&, variant] { return count_blocked(*embree, variant, surfaces->value, lights->value, results.threads()); };
    };
    for (const auto& [variant, key, title] : {std::tuple{EmbreeVariant::single, "embree_1", "Embree, single rays"},
                                              {EmbreeVariant::packet_8, "embree_8", "Embree, packets of 8"},
                                              {EmbreeVariant::packet_16, "embree_16", "Embree, packets of 16"},
                                              {EmbreeVariant::stream, "embree_stream", "Embree, stream"}})
        contestants.push_back({{key, title, 0, 0, {}}, embree_by(variant)});

    ShadowRayBench bench{session,
                         scene->value.triangles.size(),
                         lights->value.size(),
                         structure->value.statistics.build_seconds,
                         embree_seconds,
                         structure->value.statistics.structure_bytes,
                         0,
                         {},
                         scene->value.notes};
    std::vector<bool> runs(contestants.size(), true);
    for (int repetition = -1; repetition < repetitions; ++repetition) {  // -1: warms up, does not count
        progress.begin("repetition " + std::to_string(repetition + 2) + " of " + std::to_string(repetitions + 1),
                       static_cast<std::int64_t>(contestants.size()));
        for (std::size_t i = 0; i < contestants.size(); ++i) {
            if (runs[i]) runs[i] = measure(contestants[i], repetition >= 0, bench.notes);
            progress.advance();
        }
    }
    for (const Contestant& contestant : contestants) bench.rows.push_back(contestant.row);
    bench.peak_bytes = peak_memory_bytes();
    return bench;
}

Json json_from_bench(const ShadowRayBench& bench) {
    Json rates = Json::object(), blocked = Json::object();
    for (const BenchRow& row : bench.rows) {
        const auto rate = median_rays_per_second(row);
        rates[row.key] = rate ? Json(1e-6 * *rate) : Json();
        blocked[row.key] = rate && row.rays > 0
                               ? Json(100.0 * static_cast<double>(row.blocked) / static_cast<double>(row.rays))
                               : Json();
    }
    return {{"scene", bench.session.scene},
            {"triangles", bench.triangles},
            {"lights", bench.lights},
            {"size", {bench.session.size.width, bench.session.size.height}},
            {"rays", bench.rows.front().rays},
            {"repetitions", bench.rows.front().seconds.size()},
            {"mrays_per_second", rates},
            {"ratio", {{"cpu", ratio(bench, "voxel_rows_cpu")}, {"vulkan", ratio(bench, "voxel_rows_vulkan")}}},
            {"compression_cost",
             {{"cpu", compression_cost(bench, "voxel_rows_cpu")},
              {"vulkan", compression_cost(bench, "voxel_rows_vulkan")}}},
            {"blocked_percent", blocked},
            {"seconds", {{"build", bench.build_seconds}, {"embree_build", bench.embree_build_seconds}}},
            {"memory_bytes", {{"structure", bench.structure_bytes}, {"peak", bench.peak_bytes}}}};
}

std::string heading_from_bench(const ShadowRayBench& bench) {
    const auto& size = bench.session.size;
    return "Shadow rays: " + bench.session.scene + ", " + count_text(bench.triangles) + " triangles, " +
           count_text(bench.lights) + " lights, " + std::to_string(size.width) + " x " + std::to_string(size.height) +
           " pixels, " + count_text(bench.rows.front().rays) + " rays, median of " +
           std::to_string(bench.rows.front().seconds.size()) + "\nRows built in " + seconds_text(bench.build_seconds) +
           " (" + bytes_text(bench.structure_bytes) + "), Embree's hierarchy in " +
           seconds_text(bench.embree_build_seconds) + "; peak memory " + bytes_text(bench.peak_bytes) + "\n";
}

TextTable table_from_bench(const ShadowRayBench& bench) {
    TextTable table;
    table.heading = {"technique", "M rays/s", "times best Embree", "blocked %", "s, fastest to slowest"};
    table.align = {TableAlign::left, TableAlign::right, TableAlign::right, TableAlign::right, TableAlign::right};
    const double best = best_embree(bench);
    for (const BenchRow& row : bench.rows) {
        const auto rate = median_rays_per_second(row);
        if (!rate) {
            table.rows.push_back({row.title, "-", "-", "-", "-"});
            continue;
        }
        const auto [fastest, slowest] = std::ranges::minmax(row.seconds);
        const double blocked =
            row.rays > 0 ? 100.0 * static_cast<double>(row.blocked) / static_cast<double>(row.rays) : 0.0;
        table.rows.push_back({row.title, fixed_text(1e-6 * *rate, 1), best > 0.0 ? fixed_text(*rate / best, 2) : "-",
                              fixed_text(blocked, 2), fixed_text(fastest, 3) + " to " + fixed_text(slowest, 3)});
    }
    return table;
}

}  // namespace sightlines
