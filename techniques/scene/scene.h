// What a renderer sees: triangles in world space, their materials, cameras and lights, at one moment.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "techniques/base/image.h"
#include "techniques/base/types.h"

namespace sightlines {

enum class AlphaMode { opaque, mask, blend };
enum class Wrap { repeat, mirrored_repeat, clamp };

/// A picture, linear floats after decoding (sRGB pictures are decoded), alpha in w.
struct Texture {
    Image<glm::u8vec4> texels;  ///< as stored in the file; colour is sRGB
    Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
};

/// Where a material looks up a texture: which one, which of the two coordinate sets, and KHR_texture_transform.
struct TextureLookup {
    std::uint32_t texture = 0;
    std::uint32_t coordinate_set = 0;  ///< 0 or 1
    vec2 offset{0.0f}, scale{1.0f};
    float rotation_rad = 0.0f;
};

struct Material {
    std::string name;
    vec3 base_color{0.8f};  ///< linear Rec. 709, in [0, 1]
    float alpha = 1.0f;
    float metallic = 0.0f, roughness = 1.0f;
    vec3 emissive{0.0f};  ///< radiance, W/(sr m^2); KHR_materials_emissive_strength included
    AlphaMode alpha_mode = AlphaMode::opaque;
    float alpha_cutoff = 0.5f;
    bool double_sided = true;
    std::optional<TextureLookup> base_color_texture, emissive_texture;
};

enum class CameraKind { perspective, orthographic };

struct Camera {
    std::string name = "default";
    CameraKind kind = CameraKind::perspective;
    vec3 position{0.0f, 0.0f, 3.0f};  ///< m
    vec3 target{0.0f};                ///< m; the point that is looked at (and orbited)
    vec3 up{0.0f, 1.0f, 0.0f};
    float vertical_field_of_view_deg = 50.0f;
    float orthographic_height_m = 2.0f;  ///< full height of the picture, for an orthographic camera

    bool operator==(const Camera&) const = default;
};

/// `surface`: a lit patch of a surface as a light; it shines to its front only, as the cosine from its normal.
enum class LightKind { point, spot, directional, surface };

struct Light {
    LightKind kind = LightKind::point;
    vec3 position{0.0f};                ///< m
    vec3 direction{0.0f, -1.0f, 0.0f};  ///< unit, the way the light travels (spot, directional); a surface's normal
    vec3 intensity{1.0f};  ///< W/sr (point, spot; a surface: along its normal); directional: W/m^2. Linear Rec. 709
    float inner_cone_deg = 0.0f, outer_cone_deg = 45.0f;  ///< half angles of a spot
    float nearest_m = 0.0f;  ///< of a surface: what is nearer gets as much as from there, so that no corner burns out

    bool operator==(const Light&) const = default;
};

/// A run of triangles that came from one object: what later tells rigid from deforming.
struct Part {
    std::string name;
    std::uint32_t first_triangle = 0, triangle_count = 0;
    std::uint32_t mesh = 0;      ///< equal for instances of one mesh
    mat4 world_from_part{1.0f};  ///< identity where the part deforms (skin, morph)
    bool moves = false;          ///< world_from_part depends on time
    bool deforms = false;        ///< the vertices themselves depend on time
};

/// Immutable once made. Everything is in world space, in metres, at `time_s`.
struct Scene {
    std::string name;
    double time_s = 0.0;
    std::vector<vec3> positions;                    ///< [V]
    std::vector<vec3> normals;                      ///< [V], unit; made from the triangles where a file has none
    std::vector<vec2> texture_coordinates[2];       ///< [V] or empty
    std::vector<uvec3> triangles;                   ///< [T], each index < V
    std::vector<std::uint32_t> triangle_materials;  ///< [T], each < materials.size()
    std::vector<Material> materials;                ///< at least one
    std::vector<Texture> textures;
    std::vector<Part> parts;      ///< cover all triangles, in order
    std::vector<Camera> cameras;  ///< at least one (framed automatically where a file has none)
    std::vector<Light> lights;    ///< may be empty
    Box3 bounds;                  ///< of the triangles' vertices; empty without triangles
    Box3 motion_bounds;           ///< of the vertices at all times of the animation; equals bounds where nothing moves
    Box3 light_volume;            ///< where `--lights N` are spread; the bounds unless the scene says better
    std::vector<std::string> notes;  ///< for standard error: what was left out or approximated
};

/// A loaded file or a built-in scene: gives the scene at any moment. Cheap to copy; `at` may be called from any thread.
struct SceneModel {
    std::string name;
    std::string about;        ///< one sentence for `list scenes`
    double duration_s = 0.0;  ///< 0: nothing moves; `at` takes any time and loops
    std::function<Scene(double time_s)> at;
};

/// A camera that shows the whole box, from the front, a little above.
Camera framing_camera(const Box3& bounds);

/// The picture's frame in space.
struct CameraFrame {
    vec3 right{0.0f}, up{0.0f}, forward{0.0f};    ///< unit, world
    float half_width = 1.0f, half_height = 1.0f;  ///< perspective: at unit distance; orthographic: m
};
CameraFrame camera_frame(const Camera& camera, ImageSize size);

/// The scene's camera called `name`, or its first where `name` is empty. InputError offers the nearest name.
Camera find_camera(const Scene& scene, const std::string& name);

}  // namespace sightlines
