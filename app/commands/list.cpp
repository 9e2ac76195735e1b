#include <functional>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "app/commands/commands.h"
#include "app/commands/flags.h"
#include "app/inside.h"
#include "app/results.h"
#include "app/table.h"
#include "techniques/compute/device.h"
#include "techniques/scene/builtin_scenes.h"
#include "techniques/technique.h"

namespace sightlines {
namespace {

/// What one kind of thing lists: the same content for people and as JSON.
struct Listing {
    TextTable table;
    Json json = Json::array();
    std::string empty = "nothing";  ///< said where there is nothing to list
    std::string after;              ///< a last line, for people only
};

Listing list_techniques() {
    Listing listing;
    listing.table.heading = {"name", "title", "about"};
    for (const Technique& technique : techniques()) {
        listing.table.rows.push_back(
            {std::string(technique.name), std::string(technique.title), std::string(technique.about)});
        listing.json.push_back(
            {{"name", technique.name},
             {"title", technique.title},
             {"about", technique.about},
             {"paper", technique.paper},
             {"stages", std::vector<std::string>(technique.stages.begin(), technique.stages.end())}});
    }
    return listing;
}

Listing list_scenes() {
    Listing listing;
    listing.table.heading = {"name", "moves", "about"};
    for (const SceneModel& model : builtin_scenes()) {
        const std::string moves = model.duration_s > 0.0 ? fixed_text(model.duration_s, 1) + " s" : "-";
        listing.table.rows.push_back({model.name, moves, model.about});
        listing.json.push_back({{"name", model.name}, {"duration_s", model.duration_s}, {"about", model.about}});
    }
    listing.after = "Or give the path of a .gltf or .glb file.";
    return listing;
}

Listing list_lessons() {
    Listing listing;
    listing.empty = "There are no lessons yet.";
    return listing;
}

Listing list_figures() {
    Listing listing;
    listing.table.heading = {"name", "technique", "about"};
    for (const FigureRow& figure : figures()) {
        listing.table.rows.push_back({std::string(figure.name),
                                      figure.technique.empty() ? "any" : std::string(figure.technique),
                                      std::string(figure.about)});
        listing.json.push_back({{"name", figure.name}, {"technique", figure.technique}, {"about", figure.about}});
    }
    return listing;
}

Json parameter_json(const Technique& technique, const Parameter& row) {
    Json json = {{"technique", technique.name},
                 {"name", row.name},
                 {"title", row.title},
                 {"unit", row.unit},
                 {"default", row.default_value},
                 {"lowest", row.lowest},
                 {"highest", row.highest},
                 {"help", row.help},
                 {"affects", row.affects == ParameterAffects::structure ? "structure" : "picture"}};
    constexpr const char* kinds[] = {"integer", "real", "boolean", "choice"};
    json["kind"] = kinds[static_cast<std::size_t>(row.kind)];
    if (row.paper_value) json["paper"] = *row.paper_value;
    if (!row.choices.empty()) json["choices"] = std::vector<std::string>(row.choices.begin(), row.choices.end());
    return json;
}

std::string range_text(const Parameter& row) {
    if (row.kind == ParameterKind::boolean) return "true, false";
    if (row.kind != ParameterKind::choice)
        return parameter_text(row, row.lowest) + " to " + parameter_text(row, row.highest);
    std::string all;
    for (const std::string_view choice : row.choices) all += (all.empty() ? "" : ", ") + std::string(choice);
    return all;
}

Listing list_parameters(const std::string& technique_name) {
    Listing listing;
    listing.table.heading = {"name", "default", "range", "unit", "paper", "help"};
    listing.table.align = {TableAlign::left, TableAlign::right, TableAlign::left, TableAlign::left, TableAlign::right};
    for (const Technique& technique : techniques()) {
        if (!technique_name.empty() && technique.name != technique_name) continue;
        listing.table.rows.push_back({std::string(technique.name) + ":"});
        for (const Parameter& row : technique.parameters) {
            listing.json.push_back(parameter_json(technique, row));
            std::string help = std::string(row.help);
            std::vector<std::string> lines = wrapped(help, 72);
            if (lines.empty()) lines.emplace_back();
            listing.table.rows.push_back({"  " + std::string(row.name), parameter_text(row, row.default_value),
                                          range_text(row), std::string(row.unit),
                                          row.paper_value ? parameter_text(row, *row.paper_value) : "-", lines[0]});
            for (std::size_t line = 1; line < lines.size(); ++line)
                listing.table.rows.push_back({"", "", "", "", "", lines[line]});
        }
    }
    listing.after = "Set one by --set name=value.";
    return listing;
}

Listing list_devices() {
    Listing listing;
    listing.empty = "There is no Vulkan driver; the CPU backend needs none.";
    listing.table.heading = {"device", "kind", "driver", "Vulkan", "ray queries", "memory", "usable"};
    listing.table.align = {TableAlign::left, TableAlign::left, TableAlign::left,
                           TableAlign::left, TableAlign::left, TableAlign::right};
    for (const compute::DeviceInfo& device : compute::list_devices()) {
        listing.table.rows.push_back({device.name, std::string(compute::title(device.kind)), device.driver,
                                      device.vulkan_version, device.queries_rays ? "yes" : "no",
                                      bytes_text(device.memory_bytes),
                                      device.lacks.empty() ? "yes" : "lacks " + device.lacks});
        listing.json.push_back({{"name", device.name},
                                {"kind", compute::title(device.kind)},
                                {"driver", device.driver},
                                {"vulkan", device.vulkan_version},
                                {"ray_queries", device.queries_rays},
                                {"memory_bytes", device.memory_bytes},
                                {"largest_allocation_bytes", device.largest_allocation_bytes},
                                {"subgroup_size", device.subgroup_size},
                                {"lacks", device.lacks}});
    }
    listing.after = automatic_backend() == Backend::vulkan ? "--backend automatic is vulkan here."
                                                           : "--backend automatic is cpu here: no real GPU.";
    return listing;
}

struct ListFlags {
    std::string what, technique;
    bool json = false;
};

Listing listing_of(const ListFlags& flags) {
    if (flags.what == "techniques") return list_techniques();
    if (flags.what == "scenes") return list_scenes();
    if (flags.what == "lessons") return list_lessons();
    if (flags.what == "figures") return list_figures();
    if (flags.what == "devices") return list_devices();
    return list_parameters(flags.technique);
}

CommandOutput run_list(const ListFlags& flags) {
    if (!flags.technique.empty()) find_technique(flags.technique);
    const Listing listing = listing_of(flags);
    if (flags.json) return {json_text(listing.json), {}};
    if (listing.table.rows.empty()) return {listing.empty + "\n", {}};
    return {text_from(listing.table) + (listing.after.empty() ? "" : "\n" + listing.after + "\n"), {}};
}

}  // namespace

void add_list_command(CLI::App& app, Command& chosen) {
    CLI::App& command = *app.add_subcommand("list", "Say what there is");
    const auto flags = std::make_shared<ListFlags>();
    command.add_option("what", flags->what, "techniques, scenes, lessons, figures, parameters or devices")
        ->required()
        ->check(CLI::IsMember({"techniques", "scenes", "lessons", "figures", "parameters", "devices"}));
    command.add_option("--technique", flags->technique, "Only the parameters of this one")->type_name("T");
    command.add_flag("--json", flags->json, "Print JSON");
    command.footer("Example:\n  sightlines list parameters --technique voxel_rows");
    command.callback([flags, &chosen] { chosen = {[flags](Progress&) { return run_list(*flags); }, true}; });
}

}  // namespace sightlines
