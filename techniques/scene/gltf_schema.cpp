#include "techniques/scene/gltf_schema.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <span>
#include <string_view>

#include "techniques/base/error.h"

namespace sightlines {
namespace {

using nlohmann::json;

enum class Kind {
    text,
    truth,
    integer,
    number,
    index,
    object,
    texts,
    numbers,
    indices,
    objects,
    index_map,
    index_maps
};

/// One property. `refers` is the owner's name for the objects it holds, or the root array that its indices count in.
struct Rule {
    std::string_view owner, property;
    Kind kind;
    std::string_view refers = {};
    bool required = false;
    double lowest = -3.4e38, highest = 3.4e38;  ///< of each number; finite as a float
    std::size_t fewest = 0, most = 0xffffffff;  ///< elements of an array
};

constexpr bool required = true, optional = false;
constexpr double whole = 2147483647.0;             // what fits an int
constexpr double byte_count = 9007199254740992.0;  // what a double counts exactly
constexpr double pi = 3.14159265358979;
constexpr double tiny = 1e-9;

constexpr Rule rules[] = {
    {"root", "asset", Kind::object, "asset", required},
    {"root", "scene", Kind::index, "scenes"},
    {"root", "scenes", Kind::objects, "scene"},
    {"root", "nodes", Kind::objects, "node"},
    {"root", "meshes", Kind::objects, "mesh"},
    {"root", "accessors", Kind::objects, "accessor"},
    {"root", "bufferViews", Kind::objects, "bufferView"},
    {"root", "buffers", Kind::objects, "buffer"},
    {"root", "materials", Kind::objects, "material"},
    {"root", "textures", Kind::objects, "texture"},
    {"root", "images", Kind::objects, "image"},
    {"root", "samplers", Kind::objects, "sampler"},
    {"root", "skins", Kind::objects, "skin"},
    {"root", "animations", Kind::objects, "animation"},
    {"root", "cameras", Kind::objects, "camera"},
    {"root", "extensionsUsed", Kind::texts},
    {"root", "extensionsRequired", Kind::texts},
    {"root", "extensions", Kind::object, "root.extensions"},
    {"asset", "version", Kind::text, "", required},
    {"asset", "minVersion", Kind::text},
    {"buffer", "byteLength", Kind::integer, "", required, 1, byte_count},
    {"buffer", "uri", Kind::text},
    {"bufferView", "buffer", Kind::index, "buffers", required},
    {"bufferView", "byteOffset", Kind::integer, "", optional, 0, byte_count},
    {"bufferView", "byteLength", Kind::integer, "", required, 1, byte_count},
    {"bufferView", "byteStride", Kind::integer, "", optional, 4, 252},
    {"bufferView", "target", Kind::integer, "", optional, 0, whole},
    {"accessor", "bufferView", Kind::index, "bufferViews"},
    {"accessor", "byteOffset", Kind::integer, "", optional, 0, byte_count},
    {"accessor", "componentType", Kind::integer, "", required, 5120, 5126},
    {"accessor", "normalized", Kind::truth},
    {"accessor", "count", Kind::integer, "", required, 1, whole},
    {"accessor", "type", Kind::text, "", required},
    {"accessor", "min", Kind::numbers, "", optional, -1e308, 1e308, 1, 16},
    {"accessor", "max", Kind::numbers, "", optional, -1e308, 1e308, 1, 16},
    {"accessor", "sparse", Kind::object, "sparse"},
    {"sparse", "count", Kind::integer, "", required, 1, whole},
    {"sparse", "indices", Kind::object, "sparse.indices", required},
    {"sparse", "values", Kind::object, "sparse.values", required},
    {"sparse.indices", "bufferView", Kind::index, "bufferViews", required},
    {"sparse.indices", "byteOffset", Kind::integer, "", optional, 0, whole},
    {"sparse.indices", "componentType", Kind::integer, "", required, 5121, 5125},
    {"sparse.values", "bufferView", Kind::index, "bufferViews", required},
    {"sparse.values", "byteOffset", Kind::integer, "", optional, 0, whole},
    {"mesh", "primitives", Kind::objects, "primitive", required, 0, 0, 1},
    {"mesh", "weights", Kind::numbers},
    {"primitive", "attributes", Kind::index_map, "accessors", required},
    {"primitive", "indices", Kind::index, "accessors"},
    {"primitive", "material", Kind::index, "materials"},
    {"primitive", "mode", Kind::integer, "", optional, 0, 6},
    {"primitive", "targets", Kind::index_maps, "accessors"},
    {"node", "camera", Kind::index, "cameras"},
    {"node", "children", Kind::indices, "nodes"},
    {"node", "skin", Kind::index, "skins"},
    {"node", "mesh", Kind::index, "meshes"},
    {"node", "matrix", Kind::numbers, "", optional, -3.4e38, 3.4e38, 16, 16},
    {"node", "rotation", Kind::numbers, "", optional, -1.001, 1.001, 4, 4},
    {"node", "scale", Kind::numbers, "", optional, -3.4e38, 3.4e38, 3, 3},
    {"node", "translation", Kind::numbers, "", optional, -3.4e38, 3.4e38, 3, 3},
    {"node", "weights", Kind::numbers},
    {"node", "extensions", Kind::object, "node.extensions"},
    {"scene", "nodes", Kind::indices, "nodes"},
    {"skin", "inverseBindMatrices", Kind::index, "accessors"},
    {"skin", "skeleton", Kind::index, "nodes"},
    {"skin", "joints", Kind::indices, "nodes", required, 0, 0, 1},
    {"animation", "channels", Kind::objects, "channel", required},
    {"animation", "samplers", Kind::objects, "animation.sampler", required},
    {"channel", "sampler", Kind::integer, "", required, 0, whole},
    {"channel", "target", Kind::object, "channel.target", required},
    {"channel.target", "node", Kind::index, "nodes"},
    {"channel.target", "path", Kind::text, "", required},
    {"animation.sampler", "input", Kind::index, "accessors", required},
    {"animation.sampler", "output", Kind::index, "accessors", required},
    {"animation.sampler", "interpolation", Kind::text},
    {"material", "pbrMetallicRoughness", Kind::object, "pbr"},
    {"material", "normalTexture", Kind::object, "textureInfo"},
    {"material", "occlusionTexture", Kind::object, "textureInfo"},
    {"material", "emissiveTexture", Kind::object, "textureInfo"},
    {"material", "emissiveFactor", Kind::numbers, "", optional, 0, 3.4e38, 3, 3},
    {"material", "alphaMode", Kind::text},
    {"material", "alphaCutoff", Kind::number, "", optional, 0, 3.4e38},
    {"material", "doubleSided", Kind::truth},
    {"material", "extensions", Kind::object, "material.extensions"},
    {"pbr", "baseColorFactor", Kind::numbers, "", optional, 0, 1, 4, 4},
    {"pbr", "baseColorTexture", Kind::object, "textureInfo"},
    {"pbr", "metallicFactor", Kind::number, "", optional, 0, 1},
    {"pbr", "roughnessFactor", Kind::number, "", optional, 0, 1},
    {"pbr", "metallicRoughnessTexture", Kind::object, "textureInfo"},
    {"textureInfo", "index", Kind::index, "textures", required},
    {"textureInfo", "texCoord", Kind::integer, "", optional, 0, whole},
    {"textureInfo", "scale", Kind::number},
    {"textureInfo", "strength", Kind::number},
    {"textureInfo", "extensions", Kind::object, "textureInfo.extensions"},
    {"texture", "sampler", Kind::index, "samplers"},
    {"texture", "source", Kind::index, "images"},
    {"image", "uri", Kind::text},
    {"image", "mimeType", Kind::text},
    {"image", "bufferView", Kind::index, "bufferViews"},
    {"sampler", "magFilter", Kind::integer, "", optional, 0, whole},
    {"sampler", "minFilter", Kind::integer, "", optional, 0, whole},
    {"sampler", "wrapS", Kind::integer, "", optional, 0, whole},
    {"sampler", "wrapT", Kind::integer, "", optional, 0, whole},
    {"camera", "type", Kind::text, "", required},
    {"camera", "perspective", Kind::object, "perspective"},
    {"camera", "orthographic", Kind::object, "orthographic"},
    {"perspective", "yfov", Kind::number, "", required, tiny, pi},
    {"perspective", "znear", Kind::number, "", required, 0, 3.4e38},
    {"perspective", "zfar", Kind::number, "", optional, 0, 3.4e38},
    {"perspective", "aspectRatio", Kind::number, "", optional, tiny, 3.4e38},
    {"orthographic", "xmag", Kind::number, "", required},
    {"orthographic", "ymag", Kind::number, "", required},
    {"orthographic", "znear", Kind::number, "", required},
    {"orthographic", "zfar", Kind::number, "", required},
    {"root.extensions", "KHR_lights_punctual", Kind::object, "lights"},
    {"lights", "lights", Kind::objects, "light", required},
    {"light", "type", Kind::text, "", required},
    {"light", "color", Kind::numbers, "", optional, 0, 3.4e38, 3, 3},
    {"light", "intensity", Kind::number, "", optional, 0, 3.4e38},
    {"light", "range", Kind::number, "", optional, 0, 3.4e38},
    {"light", "spot", Kind::object, "spot"},
    {"spot", "innerConeAngle", Kind::number, "", optional, 0, pi / 2},
    {"spot", "outerConeAngle", Kind::number, "", optional, tiny, pi / 2 + 1e-6},
    {"node.extensions", "KHR_lights_punctual", Kind::object, "node.light"},
    {"node.light", "light", Kind::index, "lights", required},
    {"material.extensions", "KHR_materials_emissive_strength", Kind::object, "emissiveStrength"},
    {"material.extensions", "KHR_materials_unlit", Kind::object, "unlit"},
    {"emissiveStrength", "emissiveStrength", Kind::number, "", optional, 0, 3.4e38},
    {"textureInfo.extensions", "KHR_texture_transform", Kind::object, "textureTransform"},
    {"textureTransform", "offset", Kind::numbers, "", optional, -3.4e38, 3.4e38, 2, 2},
    {"textureTransform", "scale", Kind::numbers, "", optional, -3.4e38, 3.4e38, 2, 2},
    {"textureTransform", "rotation", Kind::number},
    {"textureTransform", "texCoord", Kind::integer, "", optional, 0, whole},
};

/// The extensions whose effect on the picture is honoured here, so that a file may require them.
constexpr std::string_view honoured_extensions[] = {"KHR_lights_punctual", "KHR_texture_transform",
                                                    "KHR_materials_emissive_strength", "KHR_materials_unlit",
                                                    "KHR_mesh_quantization"};

struct Walk {
    const std::string& file;
    const json& document;
};

[[noreturn]] void refuse(const Walk& walk, const std::string& place, const std::string& problem) {
    throw InputError(walk.file, place, problem, "export the file again, or mend it with a glTF validator");
}

std::string plain(double value) {
    char text[32];
    const auto end = std::to_chars(text, text + sizeof text, value).ptr;
    return std::string(text, end);
}

std::size_t root_array_size(const json& document, std::string_view name) {
    const json* owner = &document;
    if (name == "lights") {
        for (const char* key : {"extensions", "KHR_lights_punctual"}) {
            const auto found = owner->find(key);
            if (found == owner->end() || !found->is_object()) return 0;
            owner = &*found;
        }
    }
    const auto found = owner->find(std::string(name));
    return found != owner->end() && found->is_array() ? found->size() : 0;
}

void check_number(const Walk& walk, const json& value, const Rule& rule, const std::string& place) {
    if (!value.is_number()) refuse(walk, place, "is not a number");
    const double number = value.get<double>();
    if (!(number >= rule.lowest && number <= rule.highest))
        refuse(walk, place, plain(number) + " is outside " + plain(rule.lowest) + " to " + plain(rule.highest));
}

void check_integer(const Walk& walk, json& value, double lowest, double highest, const std::string& place) {
    if (!value.is_number()) refuse(walk, place, "is not a number");
    const double number = value.get<double>();
    if (number != std::floor(number)) refuse(walk, place, plain(number) + " is not a whole number");
    if (!(number >= lowest && number <= highest))
        refuse(walk, place, plain(number) + " is outside " + plain(lowest) + " to " + plain(highest));
    value = static_cast<std::int64_t>(number);
}

void check_index(const Walk& walk, json& value, std::string_view array, const std::string& place) {
    check_integer(walk, value, 0, whole, place);
    const std::size_t size = root_array_size(walk.document, array);
    if (value.get<std::size_t>() >= size)
        refuse(walk, place,
               "refers to " + std::string(array) + "[" + std::to_string(value.get<std::size_t>()) + "]; there are " +
                   std::to_string(size));
}

void check_object(const Walk& walk, json& object, std::string_view owner, const std::string& place);

void check_index_map(const Walk& walk, json& value, std::string_view array, const std::string& place) {
    if (!value.is_object()) refuse(walk, place, "is not an object");
    for (auto& [key, element] : value.items()) check_index(walk, element, array, place + "." + key.substr(0, 64));
}

void check_element(const Walk& walk, json& value, const Rule& rule, const std::string& place) {
    switch (rule.kind) {
        case Kind::texts:
            if (!value.is_string()) refuse(walk, place, "is not a string");
            return;
        case Kind::numbers:
            return check_number(walk, value, rule, place);
        case Kind::indices:
            return check_index(walk, value, rule.refers, place);
        case Kind::objects:
            return check_object(walk, value, rule.refers, place);
        default:
            return check_index_map(walk, value, rule.refers, place);
    }
}

void check_property(const Walk& walk, json& value, const Rule& rule, const std::string& place) {
    switch (rule.kind) {
        case Kind::text:
            if (!value.is_string()) refuse(walk, place, "is not a string");
            return;
        case Kind::truth:
            if (!value.is_boolean()) refuse(walk, place, "is neither true nor false");
            return;
        case Kind::integer:
            return check_integer(walk, value, rule.lowest, rule.highest, place);
        case Kind::number:
            return check_number(walk, value, rule, place);
        case Kind::index:
            return check_index(walk, value, rule.refers, place);
        case Kind::object:
            return check_object(walk, value, rule.refers, place);
        case Kind::index_map:
            return check_index_map(walk, value, rule.refers, place);
        default:
            break;
    }
    if (!value.is_array()) refuse(walk, place, "is not an array");
    if (value.size() < rule.fewest || value.size() > rule.most)
        refuse(walk, place,
               "holds " + std::to_string(value.size()) + " elements; there must be " +
                   (rule.fewest == rule.most ? "" : "at least ") + std::to_string(rule.fewest));
    for (std::size_t i = 0; i < value.size(); ++i)
        check_element(walk, value[i], rule, place + "[" + std::to_string(i) + "]");
}

/// The rules of one owner stand together in the table.
std::span<const Rule> rules_of(std::string_view owner) {
    const auto first = std::ranges::find(rules, owner, &Rule::owner);
    const auto last = std::find_if(first, std::end(rules), [&](const Rule& rule) { return rule.owner != owner; });
    return std::span(first, last);
}

void check_object(const Walk& walk, json& object, std::string_view owner, const std::string& place) {
    if (!object.is_object()) refuse(walk, place, "is not an object");
    object.erase("extras");
    if (const auto name = object.find("name"); name != object.end() && !name->is_string())
        refuse(walk, place + ".name", "is not a string");
    for (const Rule& rule : rules_of(owner)) {
        const auto found = object.find(std::string(rule.property));
        const std::string spot = (place.empty() ? "" : place + ".") + std::string(rule.property);
        if (found != object.end())
            check_property(walk, *found, rule, spot);
        else if (rule.required)
            refuse(walk, spot, "is missing");
    }
}

struct Version {
    int major_number = 0, minor_number = 0;
    auto operator<=>(const Version&) const = default;
};

std::optional<Version> parse_version(const std::string& text) {
    Version version;
    const char* const end = text.data() + text.size();
    const auto [dot, first_failure] = std::from_chars(text.data(), end, version.major_number);
    if (first_failure != std::errc() || dot == end || *dot != '.') return std::nullopt;
    const auto [rest, second_failure] = std::from_chars(dot + 1, end, version.minor_number);
    if (second_failure != std::errc() || rest != end) return std::nullopt;
    return version;
}

Version asset_version(const std::string& file, const json& asset, const char* property) {
    const std::string text = asset.at(property).get<std::string>();
    const std::optional<Version> version = parse_version(text);
    if (!version)
        throw InputError(file, std::string("asset.") + property, "`" + text + "` is not a version", "write `2.0`");
    return *version;
}

std::string joined(const std::vector<std::string>& names) {
    constexpr std::size_t shown = 8;
    std::string list;
    for (std::size_t i = 0; i < std::min(names.size(), shown); ++i)
        list += (i == 0 ? "" : ", ") + names[i].substr(0, 64);
    if (names.size() > shown) list += " and " + std::to_string(names.size() - shown) + " more";
    return list;
}

/// The names in the root array `property` that are not honoured here, each once.
std::vector<std::string> unknown_extensions(const json& document, const char* property) {
    std::vector<std::string> names;
    if (!document.contains(property)) return names;
    for (const json& name : document.at(property))
        if (std::ranges::find(honoured_extensions, name.get<std::string>()) == std::end(honoured_extensions) &&
            std::ranges::find(names, name.get<std::string>()) == names.end())
            names.push_back(name.get<std::string>());
    return names;
}

}  // namespace

void check_gltf_schema(const std::string& file, json& document) {
    check_object({file, document}, document, "root", "");
}

void check_gltf_version_and_extensions(const std::string& file, const json& document, std::vector<std::string>& notes) {
    const json& asset = document.at("asset");
    const Version version = asset_version(file, asset, "version");
    if (version.major_number != 2)
        throw InputError(file, "asset.version",
                         "is " + std::to_string(version.major_number) + ".x; this program reads glTF 2.x",
                         "convert the file to glTF 2.0");
    if (asset.contains("minVersion") && asset_version(file, asset, "minVersion") > version)
        throw InputError(file, "asset.minVersion", "is later than asset.version");
    if (version > Version{2, 0}) notes.push_back("a later minor version of glTF 2 is read as 2.0");

    if (const auto unknown = unknown_extensions(document, "extensionsRequired"); !unknown.empty())
        throw InputError(file, "extensionsRequired", "needs " + joined(unknown) + ", unknown to this program",
                         "export without compression or special extensions");
    if (const auto unknown = unknown_extensions(document, "extensionsUsed"); !unknown.empty())
        notes.push_back("extensions without effect here: " + joined(unknown));
}

}  // namespace sightlines
