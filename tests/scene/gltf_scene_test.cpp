// Materials, pictures, cameras, lights, whole scenes.
#include <cmath>
#include <string>

#include "techniques/base/image.h"
#include "tests/scene/gltf_testing.h"

namespace sightlines {
namespace {

using namespace testing_gltf;

Document with_material(const json& material) {
    Document document = triangle_document();
    document.root["materials"] = json::array({material});
    json& primitive = document.root["meshes"][0]["primitives"][0];
    primitive["material"] = 0;
    primitive["attributes"]["TEXCOORD_0"] = document.add_floats({0, 0, 1, 0, 0, 1}, "VEC2");
    return document;
}

/// A picture of 2 x 1: red, and half transparent blue.
std::string picture_uri() {
    ImageRgba8 picture(ImageSize{2, 1});
    picture.pixels = {{255, 0, 0, 255}, {0, 0, 255, 128}};
    return "data:image/png;base64," + base64(encode_png(picture));
}

Document with_texture(const json& lookup, const json& sampler = json::object()) {
    Document document = with_material({{"pbrMetallicRoughness", {{"baseColorTexture", lookup}}}});
    document.root["images"] = json::array({{{"uri", picture_uri()}}});
    document.root["samplers"] = json::array({sampler});
    document.root["textures"] = json::array({{{"source", 0}, {"sampler", 0}}});
    return document;
}

TEST(GltfMaterial, FactorsAreReadAsTheyAre) {
    const Scene scene = scene_of(
        with_material({{"name", "brass"},
                       {"pbrMetallicRoughness",
                        {{"baseColorFactor", {0.1, 0.2, 0.3, 0.4}}, {"metallicFactor", 0.5}, {"roughnessFactor", 0.6}}},
                       {"emissiveFactor", {1, 0.5, 0.25}},
                       {"alphaMode", "MASK"},
                       {"alphaCutoff", 0.7},
                       {"doubleSided", true},
                       {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 8}}}}}}));
    ASSERT_EQ(scene.materials.size(), 1u);
    const Material& material = scene.materials[0];
    EXPECT_EQ(material.name, "brass");
    expect_near(material.base_color, {0.1f, 0.2f, 0.3f});
    EXPECT_FLOAT_EQ(material.alpha, 0.4f);
    EXPECT_FLOAT_EQ(material.metallic, 0.5f);
    EXPECT_FLOAT_EQ(material.roughness, 0.6f);
    expect_near(material.emissive, {8, 4, 2});
    EXPECT_EQ(material.alpha_mode, AlphaMode::mask);
    EXPECT_FLOAT_EQ(material.alpha_cutoff, 0.7f);
    EXPECT_TRUE(material.double_sided);
}

TEST(GltfMaterial, DefaultsAreThoseOfTheSpecification) {
    const Material material = scene_of(with_material(json::object())).materials[0];
    EXPECT_EQ(material.base_color, vec3(1.0f));
    EXPECT_EQ(material.metallic, 1.0f);
    EXPECT_EQ(material.roughness, 1.0f);
    EXPECT_FALSE(material.double_sided);
    EXPECT_EQ(material.alpha_mode, AlphaMode::opaque);
}

TEST(GltfMaterial, APrimitiveWithoutMaterialGetsTheDefaultOne) {
    const Scene scene = scene_of(triangle_document());
    ASSERT_EQ(scene.materials.size(), 1u);
    EXPECT_EQ(scene.triangle_materials, std::vector<std::uint32_t>{0});
    EXPECT_EQ(scene.materials[0].metallic, 0.0f);
}

TEST(GltfMaterial, BlendingIsNotedAsShownOpaque) {
    const Scene scene = scene_of(with_material({{"alphaMode", "BLEND"}}));
    EXPECT_EQ(scene.materials[0].alpha_mode, AlphaMode::blend);
    EXPECT_TRUE(contains(json(scene.notes).dump(), "shown opaque"));
}

TEST(GltfMaterial, UnlitMaterialsEmitTheirColour) {
    const Material material =
        scene_of(with_material({{"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 0.25, 1, 1}}}},
                                {"extensions", {{"KHR_materials_unlit", json::object()}}}}))
            .materials[0];
    expect_near(material.emissive, {0.5f, 0.25f, 1});
    EXPECT_EQ(material.base_color, vec3(0.0f));
}

TEST(GltfMaterial, PicturesKeepTheirTexelsAndWrapModes) {
    const Scene scene = scene_of(with_texture({{"index", 0}}, {{"wrapS", 33071}, {"wrapT", 33648}}));
    ASSERT_EQ(scene.textures.size(), 1u);
    EXPECT_EQ(scene.textures[0].texels.size, (ImageSize{2, 1}));
    EXPECT_EQ(scene.textures[0].texels.at(0, 0), glm::u8vec4(255, 0, 0, 255));
    EXPECT_EQ(scene.textures[0].texels.at(1, 0), glm::u8vec4(0, 0, 255, 128));
    EXPECT_EQ(scene.textures[0].wrap_u, Wrap::clamp);
    EXPECT_EQ(scene.textures[0].wrap_v, Wrap::mirrored_repeat);
    ASSERT_TRUE(scene.materials[0].base_color_texture.has_value());
    EXPECT_EQ(scene.materials[0].base_color_texture->texture, 0u);
}

TEST(GltfMaterial, TextureTransformsAreRead) {
    Document document =
        with_texture({{"index", 0},
                      {"extensions",
                       {{"KHR_texture_transform",
                         {{"offset", {0.5, 0.25}}, {"scale", {2, 3}}, {"rotation", 1.5}, {"texCoord", 1}}}}}});
    document.root["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_1"] =
        document.add_floats({0, 0, 1, 0, 0, 1}, "VEC2");
    const Scene scene = scene_of(document);
    const TextureLookup lookup = scene.materials[0].base_color_texture.value();
    EXPECT_EQ(lookup.offset, vec2(0.5f, 0.25f));
    EXPECT_EQ(lookup.scale, vec2(2.0f, 3.0f));
    EXPECT_FLOAT_EQ(lookup.rotation_rad, 1.5f);
    EXPECT_EQ(lookup.coordinate_set, 1u);
}

TEST(GltfMaterial, ATextureWithoutItsCoordinatesIsNotLookedUp) {
    const Scene scene = scene_of(with_texture({{"index", 0}, {"texCoord", 1}}));
    EXPECT_FALSE(scene.materials[0].base_color_texture.has_value());
}

TEST(GltfMaterial, DamagedAndTooLargePicturesAreRefusedByName) {
    Document document = with_texture({{"index", 0}});
    std::vector<std::uint8_t> png = encode_png(ImageRgba8(ImageSize{8, 8}));
    std::vector<std::uint8_t> cut(png.begin(), png.begin() + 40);
    document.root["images"][0]["uri"] = "data:image/png;base64," + base64(cut);
    EXPECT_TRUE(contains(refusal(document), "images[0]: is a damaged picture"));
    png[16] = png[20] = 0x00;
    png[17] = png[21] = 0x01;  // claims 65,536 x 65,536
    document.root["images"][0]["uri"] = "data:image/png;base64," + base64(png);
    EXPECT_TRUE(contains(refusal(document), "images[0]"));
    document.root["images"][0]["uri"] = "data:image/webp;base64,UklGRg==";
    EXPECT_TRUE(contains(json(scene_of(document).notes).dump(), "neither PNG nor JPEG"));
}

TEST(GltfCamera, LooksAlongItsNodesNegativeZ) {
    Document document = triangle_document();
    document.root["cameras"] = json::array(
        {{{"type", "perspective"}, {"perspective", {{"yfov", 1.0}, {"znear", 0.1}}}},
         {{"type", "orthographic"}, {"orthographic", {{"xmag", 3}, {"ymag", 2}, {"znear", 0.1}, {"zfar", 10}}}}});
    const double half = std::sqrt(0.5);
    document.root["nodes"] =
        json::array({{{"mesh", 0}},
                     {{"camera", 0}, {"name", "door"}, {"translation", {5, 1, 0}}, {"rotation", {0, half, 0, half}}},
                     {{"camera", 1}}});
    document.root["scenes"][0]["nodes"] = {0, 1, 2};
    const Scene scene = scene_of(document);
    ASSERT_EQ(scene.cameras.size(), 2u);
    const Camera camera = find_camera(scene, "door");
    expect_near(camera.position, {5, 1, 0});
    expect_near(glm::normalize(camera.target - camera.position), {-1, 0, 0});
    expect_near(camera.up, {0, 1, 0});
    EXPECT_NEAR(camera.vertical_field_of_view_deg, 57.29578, 1e-4);
    EXPECT_EQ(scene.cameras[1].kind, CameraKind::orthographic);
    EXPECT_FLOAT_EQ(scene.cameras[1].orthographic_height_m, 4.0f);
    EXPECT_EQ(find_camera(scene, "").name, "door");
    EXPECT_TRUE(contains(refusal([&] { find_camera(scene, "dor"); }), "did you mean `door`"));
}

/// Whether a square picture of `camera` shows `point`.
bool shows(const Camera& camera, vec3 point) {
    const vec3 forward = glm::normalize(camera.target - camera.position);
    const vec3 right = glm::normalize(glm::cross(forward, camera.up)), up = glm::cross(right, forward);
    const vec3 offset = point - camera.position;
    const float reach = glm::dot(offset, forward) * std::tan(glm::radians(0.5f * camera.vertical_field_of_view_deg));
    return reach > 0.0f && std::abs(glm::dot(offset, right)) <= reach && std::abs(glm::dot(offset, up)) <= reach;
}

TEST(GltfCamera, TheFramingCameraShowsTheWholeBoxFromAboveItsFront) {
    for (const vec3 size :
         {vec3(1, 1, 1), vec3(30, 12, 18), vec3(0.1f, 20, 0.1f), vec3(2, 0, 500), vec3(7, 0, 0), vec3(0)}) {
        const Box3 bounds{vec3(3, -1, 2), vec3(3, -1, 2) + size};
        const Camera camera = framing_camera(bounds);
        EXPECT_GT(camera.position.z, bounds.centre().z);
        EXPECT_GT(camera.position.y, bounds.centre().y);
        for (int corner = 0; corner < 8; ++corner)
            EXPECT_TRUE(shows(camera, bounds.lowest + size * vec3(corner & 1, (corner >> 1) & 1, corner >> 2)));
    }
    EXPECT_EQ(framing_camera(Box3{}), Camera{});
}

TEST(GltfLight, PunctualLightsStandAndShineWhereTheirNodesSay) {
    Document document = triangle_document();
    document.root["extensions"]["KHR_lights_punctual"]["lights"] =
        json::array({{{"type", "point"}, {"color", {1, 0.5, 0.25}}, {"intensity", 40}},
                     {{"type", "directional"}},
                     {{"type", "spot"}, {"spot", {{"innerConeAngle", 0.1}, {"outerConeAngle", 0.5}}}}});
    const double half = std::sqrt(0.5);
    const auto light = [](int index) { return json{{"KHR_lights_punctual", {{"light", index}}}}; };
    document.root["nodes"] = json::array({{{"mesh", 0}},
                                          {{"translation", {0, 3, 0}}, {"scale", {9, 9, 9}}, {"children", {2}}},
                                          {{"extensions", light(0)}, {"translation", {1, 0, 0}}},
                                          {{"extensions", light(1)}, {"rotation", {-half, 0, 0, half}}},
                                          {{"extensions", light(2)}}});
    document.root["scenes"][0]["nodes"] = {0, 1, 3, 4};
    const Scene scene = scene_of(document);
    ASSERT_EQ(scene.lights.size(), 3u);
    EXPECT_EQ(scene.lights[0].kind, LightKind::point);
    expect_near(scene.lights[0].position, {9, 3, 0});
    expect_near(scene.lights[0].intensity, {40, 20, 10});
    EXPECT_EQ(scene.lights[1].kind, LightKind::directional);
    expect_near(scene.lights[1].direction, {0, -1, 0});
    EXPECT_EQ(scene.lights[2].kind, LightKind::spot);
    expect_near(scene.lights[2].direction, {0, 0, -1});
    EXPECT_NEAR(scene.lights[2].inner_cone_deg, 5.729578, 1e-4);
    EXPECT_NEAR(scene.lights[2].outer_cone_deg, 28.64789, 1e-4);
}

TEST(GltfScene, EveryWrongTypeOrReferenceIsRefusedWithItsPlace) {
    const auto place_of = [](const json& patch) {
        Document document = triangle_document();
        document.root.merge_patch(patch);
        return refusal(document);
    };
    EXPECT_TRUE(contains(place_of({{"scene", 7}}), "scene: refers to scenes[7]; there are 1"));
    EXPECT_TRUE(contains(place_of({{"scene", "first"}}), "scene: is not a number"));
    EXPECT_TRUE(contains(place_of({{"nodes", {{{"mesh", 3}}}}}), "nodes[0].mesh"));
    EXPECT_TRUE(contains(place_of({{"samplers", json::object()}}), "samplers: is not an array"));
    EXPECT_TRUE(contains(place_of({{"nodes", {{{"matrix", {1, 2}}}}}}), "nodes[0].matrix: holds 2 elements"));
    EXPECT_TRUE(contains(place_of({{"asset", {{"version", "3.0"}}}}), "asset.version"));
    EXPECT_TRUE(contains(place_of({{"asset", nullptr}}), "asset: is missing"));
    EXPECT_TRUE(contains(place_of({{"meshes", {{{"primitives", json::array()}}}}}), "meshes[0].primitives"));
}

TEST(GltfScene, SharedScenesLoadWithTheirPublishedTriangles) {
    const std::vector<std::pair<std::string, std::size_t>> scenes = {
        {"sponza_crytek", 262267},      {"sibenik", 75284}, {"cornell_box", 36},
        {"flight_helmet_notex", 94722}, {"fox", 576},       {"cesium_man", 4672},
        {"rigid_anim_bunny", 69463}};
    for (const auto& [name, triangles] : scenes) {
        const std::filesystem::path file = std::filesystem::path(SIGHTLINES_SHARED_FOLDER) / "scenes" / (name + ".glb");
        if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is absent";
        Progress progress;
        const Scene scene = load_gltf(file, progress).at(0.0);
        EXPECT_EQ(scene.triangles.size(), triangles) << name;
        for (const vec3& normal : scene.normals) ASSERT_NEAR(glm::length(normal), 1.0f, 1e-4f) << name;
    }
}

}  // namespace
}  // namespace sightlines
