// Typed arrays out of buffers: bounds, strides, component types, normalisation, sparse substitution.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "techniques/base/types.h"
#include "techniques/scene/gltf_source.h"

namespace sightlines {

/// Every view lies in its buffer, every accessor in its view, every sparse index in its accessor. InputError otherwise.
void check_views_and_accessors(const GltfSource& source);

/// The bytes of a checked view. InputError where its buffer came without data.
std::span<const std::uint8_t> view_bytes(const GltfSource& source, int view);

/// False where a buffer that the accessor needs came without data.
bool has_data(const GltfSource& source, int accessor);

/// All elements, component after component (matrices column by column, without padding), as floats; normalised integers
/// in [0, 1] or [-1, 1]; zeros where the accessor has no view. InputError where a value is not finite.
std::vector<float> read_floats(const GltfSource& source, int accessor);

/// All components of an accessor of unsigned integers (indices, joints). InputError for another component type.
std::vector<std::uint32_t> read_unsigned(const GltfSource& source, int accessor);

/// InputError unless the accessor holds `type` (TINYGLTF_TYPE_VEC3 ...); `use` says what for ("POSITION").
void require_type(const GltfSource& source, int accessor, int type, const std::string& use);

/// read_floats as vectors or matrices; the accessor's type must match.
template <class Element>
std::vector<Element> read_elements(const GltfSource& source, int accessor) {
    const std::vector<float> values = read_floats(source, accessor);
    std::vector<Element> elements(values.size() / (sizeof(Element) / sizeof(float)));
    float* out = reinterpret_cast<float*>(elements.data());
    for (std::size_t i = 0; i < values.size(); ++i) out[i] = values[i];
    return elements;
}

}  // namespace sightlines
