#include "techniques/scene/gltf_materials.h"

#include <map>
#include <optional>
#include <string>
#include <tuple>

#include "techniques/base/error.h"
#include "techniques/scene/gltf_images.h"
#include "techniques/scene/gltf_limits.h"

namespace sightlines {
namespace {

Wrap wrap_of(const GltfSource& source, std::size_t sampler, int mode) {
    switch (mode) {
        case TINYGLTF_TEXTURE_WRAP_REPEAT:
            return Wrap::repeat;
        case TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT:
            return Wrap::mirrored_repeat;
        case TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE:
            return Wrap::clamp;
        default:
            throw InputError(source.file, gltf_place("samplers", sampler),
                             "has the unknown wrap mode " + std::to_string(mode));
    }
}

/// Textures that are in use so far; one picture with one pair of wrap modes is decoded once.
struct TexturesInUse {
    std::map<std::tuple<int, Wrap, Wrap>, std::optional<std::uint32_t>> known;
    std::vector<Texture> textures;
    std::uint64_t texels = 0;
};

std::optional<std::uint32_t> texture_in_use(GltfSource& source, TexturesInUse& in_use, int index) {
    const tinygltf::Texture& texture = source.document.textures[static_cast<std::size_t>(index)];
    if (texture.source < 0) {
        add_note(source.notes, "textures that only an unknown extension provides are left out");
        return std::nullopt;
    }
    Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
    if (texture.sampler >= 0) {
        const auto sampler = static_cast<std::size_t>(texture.sampler);
        wrap_u = wrap_of(source, sampler, source.document.samplers[sampler].wrapS);
        wrap_v = wrap_of(source, sampler, source.document.samplers[sampler].wrapT);
    }
    const std::tuple key(texture.source, wrap_u, wrap_v);
    if (const auto found = in_use.known.find(key); found != in_use.known.end()) return found->second;

    const GltfImage& image = source.images[static_cast<std::size_t>(texture.source)];
    auto picture = decode_gltf_image(source, image, gltf_limits::texels - in_use.texels);
    if (!picture) {
        add_note(source.notes, "pictures that are neither PNG nor JPEG are left out");
        return in_use.known[key] = std::nullopt;
    }
    in_use.texels += picture->pixels.size();
    in_use.textures.push_back({std::move(*picture), wrap_u, wrap_v});
    return in_use.known[key] = static_cast<std::uint32_t>(in_use.textures.size() - 1);
}

vec2 vector_of(const tinygltf::Value& value) {
    return {static_cast<float>(value.Get(0).GetNumberAsDouble()), static_cast<float>(value.Get(1).GetNumberAsDouble())};
}

std::optional<TextureLookup> lookup_of(GltfSource& source, TexturesInUse& in_use, const tinygltf::TextureInfo& info) {
    if (info.index < 0) return std::nullopt;
    TextureLookup lookup;
    int coordinate_set = info.texCoord;
    if (const auto found = info.extensions.find("KHR_texture_transform"); found != info.extensions.end()) {
        const tinygltf::Value& transform = found->second;
        if (transform.Has("offset")) lookup.offset = vector_of(transform.Get("offset"));
        if (transform.Has("scale")) lookup.scale = vector_of(transform.Get("scale"));
        if (transform.Has("rotation"))
            lookup.rotation_rad = static_cast<float>(transform.Get("rotation").GetNumberAsDouble());
        if (transform.Has("texCoord")) coordinate_set = transform.Get("texCoord").GetNumberAsInt();
    }
    if (coordinate_set > 1) {
        add_note(source.notes, "textures on a coordinate set beyond TEXCOORD_1 are left out");
        return std::nullopt;
    }
    lookup.coordinate_set = static_cast<std::uint32_t>(coordinate_set);
    const std::optional<std::uint32_t> texture = texture_in_use(source, in_use, info.index);
    if (!texture) return std::nullopt;
    lookup.texture = *texture;
    return lookup;
}

AlphaMode alpha_mode_of(GltfSource& source, std::size_t index, const std::string& mode) {
    if (mode == "OPAQUE") return AlphaMode::opaque;
    if (mode == "MASK") return AlphaMode::mask;
    if (mode != "BLEND")
        throw InputError(source.file, gltf_place("materials", index) + ".alphaMode", "`" + mode + "` is not known",
                         "OPAQUE, MASK or BLEND");
    add_note(source.notes, "blended transparency is shown opaque");
    return AlphaMode::blend;
}

vec3 colour_of(const std::vector<double>& values) {
    return {static_cast<float>(values[0]), static_cast<float>(values[1]), static_cast<float>(values[2])};
}

/// Unlit means: its own colour whatever the light, so it emits that colour and reflects nothing.
void make_unlit(Material& material) {
    material.emissive = material.base_color;
    material.emissive_texture = material.base_color_texture;
    material.base_color = vec3(0.0f);
}

Material material_of(GltfSource& source, TexturesInUse& in_use, std::size_t index) {
    const tinygltf::Material& given = source.document.materials[index];
    const tinygltf::PbrMetallicRoughness& pbr = given.pbrMetallicRoughness;
    Material material;
    material.name = given.name.empty() ? "material " + std::to_string(index) : given.name;
    material.base_color = colour_of(pbr.baseColorFactor);
    material.alpha = static_cast<float>(pbr.baseColorFactor[3]);
    material.metallic = static_cast<float>(pbr.metallicFactor);
    material.roughness = static_cast<float>(pbr.roughnessFactor);
    material.emissive = colour_of(given.emissiveFactor);
    material.alpha_mode = alpha_mode_of(source, index, given.alphaMode);
    material.alpha_cutoff = static_cast<float>(given.alphaCutoff);
    material.double_sided = given.doubleSided;
    material.base_color_texture = lookup_of(source, in_use, pbr.baseColorTexture);
    material.emissive_texture = lookup_of(source, in_use, given.emissiveTexture);
    if (const auto found = given.extensions.find("KHR_materials_emissive_strength");
        found != given.extensions.end() && found->second.Has("emissiveStrength"))
        material.emissive *= static_cast<float>(found->second.Get("emissiveStrength").GetNumberAsDouble());
    if (given.extensions.contains("KHR_materials_unlit")) make_unlit(material);
    if (given.normalTexture.index >= 0 || given.occlusionTexture.index >= 0 || pbr.metallicRoughnessTexture.index >= 0)
        add_note(source.notes, "normal, occlusion and metallic-roughness textures are not used");
    return material;
}

bool needs_default_material(const tinygltf::Model& document) {
    bool needed = document.materials.empty();
    for (const tinygltf::Mesh& mesh : document.meshes)
        for (const tinygltf::Primitive& primitive : mesh.primitives) needed = needed || primitive.material < 0;
    return needed;
}

}  // namespace

GltfMaterials load_gltf_materials(GltfSource& source, Progress& progress) {
    GltfMaterials result;
    TexturesInUse in_use;
    const std::size_t count = source.document.materials.size();
    progress.begin("reading materials", static_cast<std::int64_t>(count));
    for (std::size_t i = 0; i < count; ++i) {
        result.materials.push_back(material_of(source, in_use, i));
        progress.advance();
    }
    if (needs_default_material(source.document)) result.materials.emplace_back().name = "default";
    result.textures = std::move(in_use.textures);
    return result;
}

}  // namespace sightlines
