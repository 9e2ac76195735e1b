// The shape of a glTF document: which property holds what, and what it may refer to.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace sightlines {

/// Checks every property that the reader looks at: present where it must be, of the right JSON type, inside its range,
/// its array of the right length, its index inside the array that it counts in. Whole numbers written as `1.0` become
/// integers, and `extras` are dropped, so that what is parsed next cannot see anything unchecked.
/// InputError names the spot (`nodes[3].children[0]`).
void check_gltf_schema(const std::string& file, nlohmann::json& document);

/// The document's version is 2.x, and every extension that it requires is honoured here. Adds notes for extensions
/// that are merely used, and for a later minor version.
void check_gltf_version_and_extensions(const std::string& file, const nlohmann::json& document,
                                       std::vector<std::string>& notes);

}  // namespace sightlines
