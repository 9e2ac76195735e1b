#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include "techniques/base/error.h"
#include "techniques/scene/gltf_accessors.h"
#include "techniques/scene/gltf_limits.h"
#include "techniques/scene/gltf_nodes.h"

namespace sightlines {
namespace {

std::optional<NodeProperty> property_of(const std::string& path) {
    if (path == "translation") return NodeProperty::translation;
    if (path == "rotation") return NodeProperty::rotation;
    if (path == "scale") return NodeProperty::scale;
    if (path == "weights") return NodeProperty::weights;
    return std::nullopt;
}

Interpolation interpolation_of(const GltfSource& source, const std::string& place, const std::string& name) {
    if (name == "LINEAR") return Interpolation::linear;
    if (name == "STEP") return Interpolation::step;
    if (name == "CUBICSPLINE") return Interpolation::cubic_spline;
    throw InputError(source.file, place + ".interpolation", "`" + name + "` is not known",
                     "LINEAR, STEP or CUBICSPLINE");
}

std::vector<float> times_of(const GltfSource& source, const std::string& place, int accessor) {
    require_type(source, accessor, TINYGLTF_TYPE_SCALAR, "keyframe times");
    std::vector<float> times_s = read_floats(source, accessor);
    if (times_s.front() < 0.0f || !std::ranges::is_sorted(times_s))
        throw InputError(source.file, place + ".input", "its times are negative or go backwards",
                         "export the animation again");
    return times_s;
}

/// The numbers that one keyframe holds, and the accessor type that carries them.
struct Shape {
    std::uint32_t components = 3;
    int accessor_type = TINYGLTF_TYPE_VEC3;
};

Shape shape_of(const GltfScene& scene, const GltfChannel& channel) {
    switch (channel.property) {
        case NodeProperty::rotation:
            return {4, TINYGLTF_TYPE_VEC4};
        case NodeProperty::weights: {
            const int mesh = scene.nodes[channel.node].mesh;
            const std::size_t targets = mesh < 0 ? 0 : scene.meshes[static_cast<std::size_t>(mesh)].target_count;
            return {static_cast<std::uint32_t>(targets), TINYGLTF_TYPE_SCALAR};
        }
        default:
            return {};
    }
}

/// LINEAR and STEP rotations must have a direction at every keyframe.
void check_rotations(const GltfSource& source, const std::string& place, const AnimationCurve& curve) {
    const std::size_t each = curve.interpolation == Interpolation::cubic_spline ? 12 : 4;
    const std::size_t value = curve.interpolation == Interpolation::cubic_spline ? 4 : 0;
    for (std::size_t i = value; i < curve.values.size(); i += each) {
        const float* q = curve.values.data() + i;
        if (!(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3] > 1e-12f))
            throw InputError(source.file, place + ".output", "holds a rotation of length zero",
                             "export the animation again");
    }
}

AnimationCurve curve_of(const GltfSource& source, const std::string& place, const tinygltf::AnimationSampler& sampler,
                        NodeProperty property, Shape shape) {
    AnimationCurve curve;
    curve.interpolation = interpolation_of(source, place, sampler.interpolation);
    curve.components = shape.components;
    require_type(source, sampler.output, shape.accessor_type, "this animated property");
    const std::uint64_t keys = source.document.accessors[static_cast<std::size_t>(sampler.input)].count;
    const std::uint64_t outputs = source.document.accessors[static_cast<std::size_t>(sampler.output)].count;
    const std::uint64_t outputs_per_key = (curve.interpolation == Interpolation::cubic_spline ? 3u : 1u) *
                                          (property == NodeProperty::weights ? shape.components : 1u);
    if (outputs != keys * outputs_per_key)
        throw InputError(source.file, place + ".output",
                         "has " + std::to_string(outputs) + " elements; " + std::to_string(keys) + " keyframes need " +
                             std::to_string(keys * outputs_per_key),
                         "export the animation again");
    curve.times_s = times_of(source, place, sampler.input);
    curve.values = read_floats(source, sampler.output);
    if (property == NodeProperty::rotation) check_rotations(source, place, curve);
    return curve;
}

using Target = std::pair<std::uint32_t, NodeProperty>;

/// The channels of one animation that move something we show.
std::vector<GltfChannel> channels_of(GltfSource& source, const GltfScene& scene, std::size_t index,
                                     std::uint64_t& values) {
    const tinygltf::Animation& animation = source.document.animations[index];
    std::vector<GltfChannel> channels;
    std::set<Target> targets;
    for (std::size_t i = 0; i < animation.channels.size(); ++i) {
        const tinygltf::AnimationChannel& given = animation.channels[i];
        const std::string place = gltf_place("animations", index) + "." + gltf_place("channels", i);
        if (static_cast<std::size_t>(given.sampler) >= animation.samplers.size())
            throw InputError(source.file, place + ".sampler",
                             "refers to sampler " + std::to_string(given.sampler) + " of " +
                                 std::to_string(animation.samplers.size()));
        const std::optional<NodeProperty> property = property_of(given.target_path);
        if (!property) {
            add_note(source.notes, "animation channels with an unknown path are ignored");
            continue;
        }
        GltfChannel channel{static_cast<std::uint32_t>(given.target_node), *property, {}};
        if (*property != NodeProperty::weights && scene.nodes[channel.node].matrix)
            throw InputError(source.file, place, "moves a node that is placed by a matrix",
                             "give the node translation, rotation and scale");
        if (!targets.emplace(channel.node, *property).second)
            throw InputError(source.file, place, "two channels move the same property of the same node", "keep one");
        const Shape shape = shape_of(scene, channel);
        if (shape.components == 0) {
            add_note(source.notes, "animated weights on nodes without morph targets are ignored");
            continue;
        }
        const auto sampler = static_cast<std::size_t>(given.sampler);
        const std::string sampler_place = gltf_place("animations", index) + "." + gltf_place("samplers", sampler);
        channel.curve = curve_of(source, sampler_place, animation.samplers[sampler], *property, shape);
        values += channel.curve.values.size() + channel.curve.times_s.size();
        if (values > gltf_limits::keyframe_values)
            throw InputError(source.file, place,
                             "brings the animations above the limit of " +
                                 std::to_string(gltf_limits::keyframe_values) + " numbers");
        channels.push_back(std::move(channel));
    }
    return channels;
}

void mark_moving_nodes(GltfScene& scene) {
    for (const GltfChannel& channel : scene.channels)
        (channel.property == NodeProperty::weights ? scene.nodes[channel.node].morphs
                                                   : scene.nodes[channel.node].moves) = true;
    for (const std::uint32_t index : scene.parents_first) {
        GltfNode& node = scene.nodes[index];
        if (node.parent >= 0) node.moves = node.moves || scene.nodes[static_cast<std::size_t>(node.parent)].moves;
    }
}

}  // namespace

void load_gltf_animations(GltfSource& source, GltfScene& scene) {
    std::set<Target> taken;
    std::uint64_t values = 0;
    std::size_t left_out = 0;
    for (std::size_t i = 0; i < source.document.animations.size(); ++i) {
        std::vector<GltfChannel> channels = channels_of(source, scene, i, values);
        const bool clashes = std::ranges::any_of(channels, [&](const GltfChannel& c) {
            return taken.contains({c.node, c.property});
        });
        if (clashes) {
            ++left_out;
            continue;
        }
        for (GltfChannel& channel : channels) {
            taken.emplace(channel.node, channel.property);
            scene.duration_s = std::max(scene.duration_s, static_cast<double>(channel.curve.times_s.back()));
            scene.channels.push_back(std::move(channel));
        }
    }
    if (left_out > 0)
        add_note(source.notes, "of " + std::to_string(source.document.animations.size()) + " animations " +
                                   std::to_string(left_out) + " are not played: they move what an earlier one moves");
    mark_moving_nodes(scene);
}

}  // namespace sightlines
