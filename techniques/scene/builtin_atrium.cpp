// The built-in atrium: a court open to the sky between two storeys of arcades.
#include "techniques/scene/builtin_atrium.h"

#include <cmath>

#include "techniques/scene/builtin_models.h"

namespace sightlines {
namespace {

using namespace atrium;

/// One side of the court: the frame in which its columns stand along x and the court lies towards +z.
struct Side {
    mat4 world_from_side;
    float half_length;
    int bays;
};

std::vector<Side> court_sides() {
    return {{placed({0.0f, 0.0f, -court_z}, 0.0f), court_x, bays_x},
            {placed({0.0f, 0.0f, court_z}, 180.0f), court_x, bays_x},
            {placed({-court_x, 0.0f, 0.0f}, 90.0f), court_z, bays_z},
            {placed({court_x, 0.0f, 0.0f}, 270.0f), court_z, bays_z}};
}

/// Adds meshes as parts, one mesh number for all instances of a mesh.
struct Builder {
    Scene& scene;
    std::uint32_t meshes = 0;

    void add(const Mesh& mesh, const std::string& name, const std::vector<mat4>& places) {
        for (const mat4& place : places) add_part(scene, mesh, name, meshes, place);
        ++meshes;
    }
    void add(const Mesh& mesh, const std::string& name) { add(mesh, name, {mat4(1.0f)}); }
};

/// The middles of all bays of all sides at `height`, moved by `towards_court`.
std::vector<mat4> bay_places(float height, float towards_court) {
    std::vector<mat4> places;
    for (const Side& side : court_sides()) {
        for (int i = 0; i < side.bays; ++i) {
            const float x = -side.half_length + bay * (static_cast<float>(i) + 0.5f);
            places.push_back(side.world_from_side * placed({x, height, towards_court}));
        }
    }
    return places;
}

void add_architecture(Builder& builder) {
    builder.add(floor_mesh(), "floor");
    builder.add(walls_mesh(), "outer walls");
    builder.add(slabs_mesh(), "slabs and cornices");
    builder.add(beams_mesh(), "beams");
    builder.add(roof_mesh(), "roof");
    std::vector<mat4> columns, piers;
    for (const float floor : {0.0f, upper_floor}) {
        for (const Side& side : court_sides()) {
            for (int i = 1; i < side.bays; ++i) {
                const float x = -side.half_length + bay * static_cast<float>(i);
                columns.push_back(side.world_from_side * placed({x, floor, 0.0f}));
            }
            piers.push_back(side.world_from_side * placed({-side.half_length, floor, 0.0f}));
        }
    }
    builder.add(column_mesh(), "column", columns);
    builder.add(pier_mesh(), "corner pier", piers);
    std::vector<mat4> arches = bay_places(column_height, 0.0f);
    const std::vector<mat4> upper_arches = bay_places(upper_floor + column_height, 0.0f);
    arches.insert(arches.end(), upper_arches.begin(), upper_arches.end());
    builder.add(arch_mesh(), "arch", arches);
    builder.add(balustrade_mesh(), "balustrade", bay_places(upper_floor, 0.0f));
    builder.add(blind_arch_mesh(plaster_pale), "blind arch, lower storey", bay_places(0.0f, -gallery_depth));
    builder.add(blind_arch_mesh(wood_dark), "blind arch, upper storey", bay_places(upper_floor, -gallery_depth));
}

/// Which bay of a long side, counted from its left end, holds what; the two sides face each other mirrored.
void add_cloths(Builder& builder) {
    const std::vector<mat4> lower = bay_places(0.0f, 0.0f);
    const auto at = [&](int side, int i) { return lower[static_cast<std::size_t>(side * bays_x + i)]; };
    builder.add(curtain_mesh(crimson, 1), "crimson curtain", {at(0, 1), at(1, 7)});
    builder.add(curtain_mesh(ultramarine, 2), "ultramarine curtain", {at(0, 4), at(1, 1)});
    builder.add(curtain_mesh(emerald, 3), "emerald curtain", {at(0, 7), at(1, 4)});
    const mat4 tied = placed({0.0f, 3.12f, 0.30f});
    builder.add(swag_mesh(saffron), "saffron swag", {at(0, 3) * tied, at(1, 3) * tied, at(1, 6) * tied});
    builder.add(swag_mesh(crimson), "crimson swag", {at(0, 0) * tied, at(0, 6) * tied, at(1, 0) * tied});
    const mat4 rail = placed({0.0f, upper_floor + 0.98f, 0.0f});
    builder.add(banner_mesh(ultramarine, 4), "ultramarine banner",
                {at(0, 2) * rail, at(1, 5) * rail, at(0, 17) * rail});
    builder.add(banner_mesh(crimson, 5), "crimson banner", {at(0, 5) * rail, at(1, 2) * rail, at(0, 20) * rail});
}

void add_plants(Builder& builder) {
    constexpr float row_z = court_z - 1.05f;
    const std::vector<vec2> bushes = {{-9.0f, -row_z}, {-3.0f, -row_z}, {3.0f, -row_z}, {9.0f, -row_z},
                                      {-6.0f, row_z},  {0.0f, row_z},   {6.0f, row_z}};
    const std::vector<vec2> agaves = {{-6.0f, -row_z}, {0.0f, -row_z}, {6.0f, -row_z}, {-9.0f, row_z},
                                      {-3.0f, row_z},  {3.0f, row_z},  {9.0f, row_z}};
    std::vector<mat4> clay_vases, teal_vases;
    for (std::size_t i = 0; i < bushes.size(); ++i) {
        const vec3 foot(bushes[i].x, court_floor, bushes[i].y);
        clay_vases.push_back(placed(foot, 37.0f * static_cast<float>(i), 1.1f));
        builder.add(bush_mesh(1440, 100 + static_cast<std::uint32_t>(i)), "bush",
                    {placed(foot + vec3(0.0f, 0.9f, 0.0f), 0.0f, 1.0f)});
    }
    std::vector<mat4> agave_places;
    for (std::size_t i = 0; i < agaves.size(); ++i) {
        const vec3 foot(agaves[i].x, court_floor, agaves[i].y);
        teal_vases.push_back(placed(foot, 53.0f * static_cast<float>(i)));
        agave_places.push_back(placed(foot + vec3(0.0f, 0.81f, 0.0f), 71.0f * static_cast<float>(i)));
    }
    builder.add(vase_mesh(clay), "clay vase", clay_vases);
    builder.add(vase_mesh(glaze_teal), "teal vase", teal_vases);
    builder.add(agave_mesh(46, 7), "agave", agave_places);
}

/// Where lanterns hang: under the beams in the middle of the galleries, at every second column and on both storeys.
std::vector<vec3> lantern_hooks() {
    std::vector<vec3> hooks;
    for (const float ceiling : {arcade_top - 0.26f, upper_top - 0.26f}) {
        for (const float side : {-1.0f, 1.0f}) {
            for (const float x : {-9.0f, -3.0f, 3.0f, 9.0f})
                hooks.push_back({x, ceiling, side * (court_z + 0.5f * gallery_depth)});
            hooks.push_back({side * (court_x + 0.5f * gallery_depth), ceiling, 0.0f});
        }
    }
    return hooks;
}

void add_furniture(Builder& builder) {
    builder.add(fountain_mesh(), "fountain", {placed({0.0f, court_floor, 0.0f})});
    std::vector<mat4> benches;
    for (const float x : {-9.0f, -3.0f, 3.0f, 9.0f}) {
        benches.push_back(placed({x, 0.0f, wall_z - 0.5f}));
        benches.push_back(placed({x, 0.0f, -wall_z + 0.5f}));
    }
    builder.add(bench_mesh(), "bench", benches);
    std::vector<mat4> lanterns;
    for (const vec3 hook : lantern_hooks()) lanterns.push_back(placed(hook));
    builder.add(lantern_mesh(), "lantern", lanterns);
}

std::vector<Camera> cameras() {
    Camera along{"default", CameraKind::perspective, {-11.0f, 1.75f, 1.9f}, {2.0f, 3.1f, -1.2f}};
    along.vertical_field_of_view_deg = 58.0f;
    Camera gallery{"gallery", CameraKind::perspective, {-13.0f, upper_floor + 1.7f, 0.4f}, {2.0f, 4.4f, -0.2f}};
    gallery.vertical_field_of_view_deg = 58.0f;
    Camera above{"above", CameraKind::perspective, {-5.0f, 38.0f, 9.0f}, {0.0f, 2.0f, 0.3f}};
    above.vertical_field_of_view_deg = 45.0f;
    return {along, gallery, above};
}

/// The sun, a clear sky, and a flame just under each lantern.
std::vector<Light> own_lights(double time_s) {
    SunArc arc;
    arc.first_azimuth_deg = 232.0f;
    arc.last_azimuth_deg = 318.0f;
    arc.lowest_elevation_deg = 57.0f;
    arc.highest_elevation_deg = 70.0f;
    arc.irradiance = {6.6f, 5.5f, 4.1f};
    std::vector<Light> lights = {sun_light(arc, time_s)};
    const std::vector<Light> sky = sky_lights(48, {1.15f, 1.5f, 2.1f});
    lights.insert(lights.end(), sky.begin(), sky.end());
    for (const vec3 hook : lantern_hooks()) {
        Light flame;
        flame.position = hook - vec3(0.0f, lantern_drop + 0.03f, 0.0f);
        flame.intensity = {2.6f, 1.5f, 0.65f};
        lights.push_back(flame);
    }
    return lights;
}

Scene atrium_at(double time_s) {
    Scene scene;
    scene.name = "atrium";
    scene.time_s = time_s;
    scene.materials = materials();
    Builder builder{scene};
    add_architecture(builder);
    add_cloths(builder);
    add_plants(builder);
    add_furniture(builder);
    scene.cameras = cameras();
    scene.lights = own_lights(time_s);
    scene.bounds = scene.motion_bounds = tight_bounds(scene);
    // The air of the open court, clear of the arcades, the plants and the fountain.
    scene.light_volume = {{-court_x + 0.8f, 2.1f, -court_z + 0.8f}, {court_x - 0.8f, eaves - 0.3f, court_z - 0.8f}};
    return scene;
}

}  // namespace

SceneModel atrium_model() {
    return {"atrium", "A court between two storeys of arcades, with cloths, plants and a moving sun.",
            SunArc{}.duration_s, atrium_at};
}

}  // namespace sightlines
