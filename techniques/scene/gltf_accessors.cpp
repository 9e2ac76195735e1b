#include "techniques/scene/gltf_accessors.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

#include "techniques/base/error.h"
#include "techniques/scene/gltf_limits.h"

namespace sightlines {
namespace {

/// Where the components of an accessor's elements lie.
struct Layout {
    std::size_t columns = 1, rows = 1;  ///< a vector is one column
    std::size_t component_bytes = 0;
    std::size_t column_stride_bytes = 0;  ///< columns of matrices start at multiples of 4 bytes
    std::size_t element_bytes = 0;

    std::size_t components() const { return columns * rows; }
};

std::size_t component_bytes(int component_type) {
    switch (component_type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return 1;
        case TINYGLTF_COMPONENT_TYPE_SHORT:
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return 2;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        case TINYGLTF_COMPONENT_TYPE_FLOAT:
            return 4;
        default:
            return 0;
    }
}

/// component_bytes is 0 where glTF knows no such component type.
Layout layout_of(const tinygltf::Accessor& accessor) {
    Layout layout;
    layout.component_bytes = component_bytes(accessor.componentType);
    switch (accessor.type) {
        case TINYGLTF_TYPE_VEC2:
            layout.rows = 2;
            break;
        case TINYGLTF_TYPE_VEC3:
            layout.rows = 3;
            break;
        case TINYGLTF_TYPE_VEC4:
            layout.rows = 4;
            break;
        case TINYGLTF_TYPE_MAT2:
            layout.columns = layout.rows = 2;
            break;
        case TINYGLTF_TYPE_MAT3:
            layout.columns = layout.rows = 3;
            break;
        case TINYGLTF_TYPE_MAT4:
            layout.columns = layout.rows = 4;
            break;
        default:
            break;
    }
    const std::size_t column = layout.rows * layout.component_bytes;
    layout.column_stride_bytes = layout.columns > 1 ? (column + 3) / 4 * 4 : column;
    layout.element_bytes = layout.column_stride_bytes * (layout.columns - 1) + column;
    return layout;
}

/// Bytes from one element to the next.
std::size_t stride_of(const tinygltf::BufferView& view, const Layout& layout) {
    const std::size_t packed = layout.column_stride_bytes * layout.columns;
    return view.byteStride != 0 ? view.byteStride : packed;
}

/// All numbers were bounded by the schema (count < 2^31, bytes < 2^53, stride < 2^8): the sums do not overflow.
void require_range(const GltfSource& source, const std::string& place, int view_index, std::uint64_t offset,
                   std::uint64_t count, std::uint64_t stride, std::uint64_t element_bytes) {
    const tinygltf::BufferView& view = source.document.bufferViews[static_cast<std::size_t>(view_index)];
    const std::uint64_t end = offset + (count - 1) * stride + element_bytes;
    if (end > view.byteLength)
        throw InputError(source.file, place,
                         "reaches to byte " + std::to_string(end) + " of bufferViews[" + std::to_string(view_index) +
                             "], which holds " + std::to_string(view.byteLength),
                         "the file is damaged: export it again");
}

void check_sparse(const GltfSource& source, const tinygltf::Accessor& accessor, const std::string& place) {
    const auto& sparse = accessor.sparse;
    if (static_cast<std::size_t>(sparse.count) > accessor.count)
        throw InputError(source.file, place + ".sparse.count", "is larger than the accessor's own count");
    const std::size_t index_bytes = component_bytes(sparse.indices.componentType);
    if (index_bytes == 0 || sparse.indices.componentType == TINYGLTF_COMPONENT_TYPE_SHORT)
        throw InputError(source.file, place + ".sparse.indices", "its component type is not an unsigned integer");
    for (const int view : {sparse.indices.bufferView, sparse.values.bufferView})
        if (source.document.bufferViews[static_cast<std::size_t>(view)].byteStride != 0)
            throw InputError(source.file, place + ".sparse", "its buffer view has a stride", "sparse data is packed");
    const Layout layout = layout_of(accessor);
    const auto count = static_cast<std::uint64_t>(sparse.count);
    require_range(source, place + ".sparse.indices", sparse.indices.bufferView,
                  static_cast<std::uint64_t>(sparse.indices.byteOffset), count, index_bytes, index_bytes);
    require_range(source, place + ".sparse.values", sparse.values.bufferView,
                  static_cast<std::uint64_t>(sparse.values.byteOffset), count,
                  layout.column_stride_bytes * layout.columns, layout.element_bytes);
}

void check_accessor(const GltfSource& source, std::size_t index) {
    const tinygltf::Accessor& accessor = source.document.accessors[index];
    const std::string place = gltf_place("accessors", index);
    const Layout layout = layout_of(accessor);
    if (layout.component_bytes == 0)
        throw InputError(source.file, place,
                         "has the unknown component type " + std::to_string(accessor.componentType));
    if (accessor.bufferView >= 0) {
        const std::size_t stride =
            stride_of(source.document.bufferViews[static_cast<std::size_t>(accessor.bufferView)], layout);
        if (stride < layout.element_bytes)
            throw InputError(source.file, place,
                             "its elements of " + std::to_string(layout.element_bytes) +
                                 " bytes overlap at the view's stride of " + std::to_string(stride));
        require_range(source, place, accessor.bufferView, accessor.byteOffset, accessor.count, stride,
                      layout.element_bytes);
    }
    if (accessor.sparse.isSparse) check_sparse(source, accessor, place);
}

template <class Component>
float as_float(Component value, bool normalized) {
    if constexpr (std::is_integral_v<Component>) {
        if (normalized)
            return std::max(static_cast<float>(value) / static_cast<float>(std::numeric_limits<Component>::max()),
                            -1.0f);
    }
    return static_cast<float>(value);
}

/// Converts `count` elements at `first` into consecutive values of type Out.
template <class Component, class Out>
void convert(const std::uint8_t* first, std::size_t count, std::size_t stride, const Layout& layout, bool normalized,
             Out* out) {
    for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t column = 0; column < layout.columns; ++column) {
            const std::uint8_t* at = first + i * stride + column * layout.column_stride_bytes;
            for (std::size_t row = 0; row < layout.rows; ++row, at += sizeof(Component)) {
                Component value;
                std::memcpy(&value, at, sizeof value);
                if constexpr (std::is_same_v<Out, float>)
                    *out++ = as_float(value, normalized);
                else
                    *out++ = static_cast<Out>(value);
            }
        }
    }
}

template <class Out>
void convert_by_type(int component_type, const std::uint8_t* first, std::size_t count, std::size_t stride,
                     const Layout& layout, bool normalized, Out* out) {
    switch (component_type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            return convert<std::int8_t>(first, count, stride, layout, normalized, out);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return convert<std::uint8_t>(first, count, stride, layout, normalized, out);
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            return convert<std::int16_t>(first, count, stride, layout, normalized, out);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return convert<std::uint16_t>(first, count, stride, layout, normalized, out);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            return convert<std::uint32_t>(first, count, stride, layout, normalized, out);
        default:
            if constexpr (std::is_same_v<Out, float>) convert<float>(first, count, stride, layout, normalized, out);
    }
}

template <class Out>
std::vector<Out> read_values(const GltfSource& source, int index) {
    const tinygltf::Accessor& accessor = source.document.accessors[static_cast<std::size_t>(index)];
    const std::string place = gltf_place("accessors", static_cast<std::size_t>(index));
    if (accessor.count > gltf_limits::vertices)
        throw InputError(source.file, place,
                         "holds " + std::to_string(accessor.count) + " elements; the limit is " +
                             std::to_string(gltf_limits::vertices),
                         "split the mesh");
    const Layout layout = layout_of(accessor);
    std::vector<Out> values(accessor.count * layout.components());
    if (accessor.bufferView >= 0) {
        const auto bytes = view_bytes(source, accessor.bufferView);
        const std::size_t stride =
            stride_of(source.document.bufferViews[static_cast<std::size_t>(accessor.bufferView)], layout);
        convert_by_type(accessor.componentType, bytes.data() + accessor.byteOffset, accessor.count, stride, layout,
                        accessor.normalized, values.data());
    }
    if (!accessor.sparse.isSparse) return values;

    const auto& sparse = accessor.sparse;
    const auto count = static_cast<std::size_t>(sparse.count);
    const std::size_t index_bytes = component_bytes(sparse.indices.componentType);
    std::vector<std::uint32_t> targets(count);
    convert_by_type(sparse.indices.componentType,
                    view_bytes(source, sparse.indices.bufferView).data() + sparse.indices.byteOffset, count,
                    index_bytes, Layout{1, 1, index_bytes, index_bytes, index_bytes}, false, targets.data());
    const std::uint8_t* replacement = view_bytes(source, sparse.values.bufferView).data() + sparse.values.byteOffset;
    const std::size_t stride = layout.column_stride_bytes * layout.columns;
    for (std::size_t i = 0; i < count; ++i) {
        if (targets[i] >= accessor.count || (i > 0 && targets[i] <= targets[i - 1]))
            throw InputError(source.file, place + ".sparse.indices",
                             "index " + std::to_string(i) + " is " + std::to_string(targets[i]) +
                                 ": they must increase and stay below " + std::to_string(accessor.count));
        convert_by_type(accessor.componentType, replacement + i * stride, 1, stride, layout, accessor.normalized,
                        values.data() + targets[i] * layout.components());
    }
    return values;
}

}  // namespace

void check_views_and_accessors(const GltfSource& source) {
    for (std::size_t i = 0; i < source.document.bufferViews.size(); ++i) {
        const tinygltf::BufferView& view = source.document.bufferViews[i];
        const GltfBuffer& buffer = source.buffers[static_cast<std::size_t>(view.buffer)];
        if (view.byteOffset + view.byteLength > buffer.byte_length)
            throw InputError(source.file, gltf_place("bufferViews", i),
                             "reaches to byte " + std::to_string(view.byteOffset + view.byteLength) +
                                 " of a buffer of " + std::to_string(buffer.byte_length),
                             "the file is damaged: export it again");
    }
    for (std::size_t i = 0; i < source.document.accessors.size(); ++i) check_accessor(source, i);
}

std::span<const std::uint8_t> view_bytes(const GltfSource& source, int index) {
    const tinygltf::BufferView& view = source.document.bufferViews[static_cast<std::size_t>(index)];
    const auto buffer = static_cast<std::size_t>(view.buffer);
    if (!source.buffers[buffer].bytes)
        throw InputError(source.file, gltf_place("buffers", buffer), "comes without data", "give it a `uri`");
    return source.buffers[buffer].bytes->subspan(view.byteOffset, view.byteLength);
}

bool has_data(const GltfSource& source, int index) {
    const tinygltf::Accessor& accessor = source.document.accessors[static_cast<std::size_t>(index)];
    const auto present = [&](int view) {
        return view < 0 || source
                               .buffers[static_cast<std::size_t>(
                                   source.document.bufferViews[static_cast<std::size_t>(view)].buffer)]
                               .bytes.has_value();
    };
    return present(accessor.bufferView) && (!accessor.sparse.isSparse || (present(accessor.sparse.indices.bufferView) &&
                                                                          present(accessor.sparse.values.bufferView)));
}

std::vector<float> read_floats(const GltfSource& source, int accessor) {
    std::vector<float> values = read_values<float>(source, accessor);
    const auto bad = std::ranges::find_if(values, [](float value) { return !std::isfinite(value); });
    if (bad != values.end())
        throw InputError(source.file, gltf_place("accessors", static_cast<std::size_t>(accessor)),
                         "value " + std::to_string(bad - values.begin()) + " is not a finite number",
                         "repair the mesh and export it again");
    return values;
}

std::vector<std::uint32_t> read_unsigned(const GltfSource& source, int accessor) {
    const int type = source.document.accessors[static_cast<std::size_t>(accessor)].componentType;
    if (type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE && type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
        type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT)
        throw InputError(source.file, gltf_place("accessors", static_cast<std::size_t>(accessor)),
                         "its components are not unsigned integers");
    return read_values<std::uint32_t>(source, accessor);
}

void require_type(const GltfSource& source, int accessor, int type, const std::string& use) {
    if (source.document.accessors[static_cast<std::size_t>(accessor)].type != type)
        throw InputError(source.file, gltf_place("accessors", static_cast<std::size_t>(accessor)),
                         "has the wrong type for " + use);
}

}  // namespace sightlines
