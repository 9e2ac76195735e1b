// The explicit list of techniques: one row each.
#include <algorithm>
#include <array>

#include "techniques/base/error.h"
#include "techniques/baselines/baselines.h"
#include "techniques/technique.h"
#include "techniques/visibility_field/visibility_field.h"
#include "techniques/voxel_rows/voxel_rows.h"

namespace sightlines {

std::span<const Technique> techniques() {
    static const std::array rows{voxel_rows::technique(),     visibility_field::technique(),
                                 baselines::voxel_marching(), baselines::row_marching(),
                                 baselines::shadow_maps(),    baselines::imperfect_shadow_maps(),
                                 baselines::ray_tracing()};
    return rows;
}

const Technique& find_technique(std::string_view name) {
    const std::span<const Technique> all = techniques();
    const auto found = std::ranges::find(all, name, &Technique::name);
    if (found != all.end()) return *found;
    std::vector<std::string> names;
    for (const Technique& technique : all) names.emplace_back(technique.name);
    const std::string near = nearest_name(std::string(name), names);
    std::string listed;
    for (const std::string& each : names) listed += (listed.empty() ? "" : ", ") + each;
    throw InputError("technique " + std::string(name), "", "is not known",
                     near.empty() ? "there are: " + listed : "did you mean " + near + "?");
}

}  // namespace sightlines
