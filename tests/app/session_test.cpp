#include "app/session.h"

#include <fstream>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "app/results.h"
#include "run_program.h"
#include "techniques/base/error.h"
#include "techniques/base/random.h"
#include "techniques/technique.h"

namespace sightlines {
namespace {

namespace fs = std::filesystem;

/// Draws numbers for one random session.
struct Draw {
    std::uint32_t session = 0, next = 0;
    float unit() { return random_unit(7, session, next++); }
    float between(float low, float high) { return low + (high - low) * unit(); }
    int whole(int low, int high) { return low + static_cast<int>(unit() * static_cast<float>(high - low + 1)); }
    bool coin() { return unit() < 0.5f; }
    vec3 point() { return {between(-1e3f, 1e3f), between(-1.0f, 1.0f), between(-1e-3f, 1e3f)}; }
};

ParameterValues random_parameters(const Technique& technique, Draw& draw) {
    ParameterValues values;
    for (const Parameter& row : technique.parameters) {
        if (draw.coin()) continue;
        double value = row.lowest + (row.highest - row.lowest) * static_cast<double>(draw.unit());
        if (row.kind != ParameterKind::real) value = std::floor(value);
        if (value != row.default_value) values[std::string(row.name)] = value;
    }
    return values;
}

View random_view(Draw& draw) {
    View view;
    if (draw.coin())
        view.state.camera =
            OrbitCamera{draw.point(), draw.between(-180, 180), draw.between(-89, 89), draw.between(1, 9)};
    view.state.theme = static_cast<Theme>(draw.whole(0, 2));
    view.state.voxels = draw.coin();
    view.state.labels = draw.coin();
    view.state.cut_away = static_cast<CutAway>(draw.whole(0, 1));
    view.state.slab_voxels = draw.whole(1, 64);
    view.state.slice_first = draw.whole(0, 100);
    return view;
}

Workbench random_workbench(Draw& draw) {
    Workbench look;
    look.theme = static_cast<Theme>(draw.whole(0, 1));
    look.text_scale = draw.between(0.5f, 3.0f);
    look.layout.main_width = draw.between(0.05f, 0.95f);
    look.layout.lower_middle = draw.between(0.05f, 0.95f);
    for (PaneContent& content : look.layout.panes) content = static_cast<PaneContent>(draw.whole(0, 5));
    if (draw.coin()) look.layout.maximised = static_cast<PanePlace>(draw.whole(0, 5));
    look.fit_picture = draw.coin();
    look.sorted_by = static_cast<RayColumn>(draw.whole(0, 4));
    look.descending = draw.coin();
    look.lights_shown = draw.coin();
    return look;
}

Session random_session(std::uint32_t number) {
    Draw draw{number};
    Session session;
    session.scene = draw.coin() ? "cornell" : "folder/with \"quotes\" and ümlaut.glb";
    session.time_s = static_cast<double>(draw.between(-5, 50));
    session.camera = draw.coin() ? "" : "nave";
    if (draw.coin()) {
        session.free_camera = Camera{};
        session.free_camera->position = draw.point();
        session.free_camera->target = session.free_camera->position + vec3(1.0f, 0.25f, draw.between(-2, 2));
        session.free_camera->vertical_field_of_view_deg = draw.between(1, 170);
        session.free_camera->kind = static_cast<CameraKind>(draw.whole(0, 1));
    }
    session.size = {draw.whole(1, 4096), draw.whole(1, 4096)};
    session.lights = {static_cast<std::uint32_t>(draw.whole(0, 65536)),
                      static_cast<LightPlacement>(draw.whole(0, 1)),
                      draw.coin(),
                      draw.coin(),
                      draw.between(0, 10),
                      {}};
    for (int moved = draw.whole(0, 3); moved > 0; --moved)
        session.lights.moved.push_back({static_cast<std::uint32_t>(draw.whole(0, 65535)), draw.point()});
    session.lights.virtual_lights = static_cast<std::uint32_t>(draw.whole(0, 65536));
    session.environment = {draw.coin() ? "" : "folder/sky.hdr", draw.between(-90, 90), draw.between(-360, 360),
                           draw.between(-360, 360), draw.between(-3600, 3600)};
    for (const Technique& technique : techniques()) {
        ParameterValues values = random_parameters(technique, draw);
        if (!values.empty()) session.parameters[std::string(technique.name)] = std::move(values);
    }
    session.backend = static_cast<BackendChoice>(draw.whole(0, 2));
    session.seed = (static_cast<std::uint64_t>(random_u32(1, number, 0)) << 32u) | random_u32(2, number, 0);
    session.reference = draw.coin();
    if (draw.coin()) session.selection.pixel = ivec2(draw.whole(0, 999), draw.whole(0, 999));
    if (draw.coin()) session.selection.light = static_cast<std::uint32_t>(draw.whole(0, 65535));
    if (draw.coin()) session.selection.voxel = ivec3(draw.whole(0, 255), 3, 4);
    session.selection.step = static_cast<std::uint32_t>(draw.whole(0, 40));
    for (int view = draw.whole(0, 3); view > 0; --view) session.views.push_back(random_view(draw));
    session.display = {draw.between(-8, 8), draw.coin()};
    session.channel = static_cast<Channel>(draw.whole(0, 8));
    session.workbench = random_workbench(draw);
    return session;
}

std::string refusal(const Json& json) {
    try {
        session_from_json(json, "file.json");
    } catch (const InputError& error) {
        return error.what();
    }
    return "accepted";
}

TEST(Session, IsTheDefaultWhereTheJsonSaysNothing) {
    EXPECT_EQ(session_from_json(Json::object(), "here"), Session{});
    EXPECT_EQ(session_from_json({{"lights", nullptr}, {"seed", nullptr}}, "here"), Session{});
}

TEST(Session, ComesBackTheSameFromItsOwnText) {
    for (std::uint32_t number = 0; number < 500; ++number) {
        const Session session = random_session(number);
        const std::string text = json_from_session(session).dump();
        ASSERT_EQ(session_from_json(Json::parse(text), "here"), session) << text;
    }
}

TEST(Session, TakesAnEnvironmentThatIsItsFilesNameAlone) {
    EXPECT_EQ(session_from_json({{"environment", "sky.hdr"}}, "here").environment.file, "sky.hdr");
    EXPECT_EQ(session_from_json({{"environment", ""}}, "here"), Session{});
    EXPECT_EQ(patched(Session{}, {{"environment", "sky.hdr"}}, "here").environment.file, "sky.hdr");
}

TEST(Session, RefusesAnEnvironmentThatCannotBe) {
    const auto refused = [](const Json& environment, const std::string& place) {
        const std::string message = refusal({{"environment", environment}});
        EXPECT_NE(message.find(place), std::string::npos) << message;
    };
    refused({{"sun_elevation_deg", 91}}, "/environment/sun_elevation_deg");
    refused({{"turn_deg", "far"}}, "/environment/turn_deg");
    refused({{"suns", 2}}, "/environment/suns");
    refused({{"file", 5}}, "/environment/file");
    refused(7, "/environment");
}

TEST(Session, RefusesAWorkbenchThatCannotBeShown) {
    EXPECT_NE(refusal({{"workbench", {{"theme", "print"}}}}).find("/workbench/theme"), std::string::npos);
    EXPECT_NE(refusal({{"workbench", {{"layout", {{"side", "clock"}}}}}}).find("/workbench/layout/side"),
              std::string::npos);
    EXPECT_NE(refusal({{"workbench", {{"layout", {{"maximised", "none"}}}}}}).find("maximised"), std::string::npos);
    EXPECT_NE(refusal({{"workbench", {{"layout", {{"main_width", 1.5}}}}}}).find("main_width"), std::string::npos);
    EXPECT_NE(refusal({{"lights", {{"moved", {{{"light", -1}}}}}}}).find("/lights/moved/0/light"), std::string::npos);
}

TEST(Session, DiffersWhereOneFieldDiffers) {
    int different = 0;
    for (std::uint32_t number = 0; number < 50; ++number)
        different += random_session(number) == random_session(number + 1) ? 0 : 1;
    EXPECT_EQ(different, 50);
}

TEST(Session, WritesFloatsAsPeopleWriteThem) {
    Session session;
    session.lights.brightness = 0.1f;
    EXPECT_EQ(json_from_session(session)["lights"]["brightness"].dump(), "0.1");
}

TEST(Session, IsChangedByAPatchOnlyWhereThePatchSpeaks) {
    Session session = random_session(3);
    session.free_camera.reset();
    Session expected = session;
    expected.lights.count = 17;
    expected.selection.pixel = ivec2(4, 5);
    const Json patch = {{"lights", {{"count", 17}}}, {"selection", {{"pixel", {4, 5}}}}};
    EXPECT_EQ(patched(session, patch, "step"), expected);
    EXPECT_EQ(patched(session, Json::object(), "step"), session);
}

TEST(Session, LosesWhatAPatchSetsToNull) {
    Session session;
    session.selection.light = 9;
    session.seed = 42;
    const Session after = patched(session, {{"seed", nullptr}, {"selection", {{"light", nullptr}}}}, "step");
    EXPECT_EQ(after, Session{});
}

TEST(Session, KeepsEachTechniquesOwnParameters) {
    const Session session = session_from_json({{"parameters", {{"voxel_rows", {{"resolution", 64}}}}}}, "here");
    EXPECT_EQ(technique_parameters(session), (ParameterValues{{"resolution", 64.0}}));
    EXPECT_EQ(json_from_session(session)["parameters"]["voxel_rows"]["resolution"], 64);
}

struct Refused {
    const char* json;
    const char* message;  ///< part of it
};

TEST(Session, RefusesWithTheJsonPointerAndAWayToMendIt) {
    const Refused table[] = {
        {R"([1, 2])", "is not an object"},
        {R"({"scen": "atrium"})", "file.json: /scen: is not known (did you mean scene?)"},
        {R"({"lights": {"cuont": 3}})", "/lights/cuont: is not known (did you mean count?)"},
        {R"({"lights": {"count": 65537}})", "/lights/count: 65537 is outside its range (give 0 to 65536)"},
        {R"({"lights": {"count": -1}})", "/lights/count: -1 is outside"},
        {R"({"lights": {"virtual_lights": 65537}})", "/lights/virtual_lights: 65537 is outside"},
        {R"({"lights": {"count": 1.5}})", "/lights/count: 1.5 is not a whole number"},
        {R"({"lights": [1]})", "/lights: is not an object"},
        {R"({"lights": {"placement": "spere"}})", "/lights/placement: has no choice spere (did you mean sphere?)"},
        {R"({"size": {"width": 0}})", "/size/width: 0 is outside its range"},
        {R"({"size": {"width": 16384, "height": 16384}})", "/size: 16384x16384 is too large"},
        {R"({"seed": -1})", "/seed: -1 is outside"},
        {R"({"time_s": "late"})", "/time_s: is not a number"},
        {R"({"technique": "voxel_row"})", "/technique: technique voxel_row is not known (did you mean voxel_rows?)"},
        {R"({"parameters": {"voxel_rows": {"resolutoin": 64}}})", "/parameters/voxel_rows/resolutoin: is not known"},
        {R"({"parameters": {"voxel_rows": {"resolution": 1e9}}})", "/parameters/voxel_rows/resolution: 1000000000"},
        {R"({"parameters": {"voxel_rows": {"resolution": [64]}}})", "is not a number"},
        {R"({"parameters": {"voxel_rows": 3}})", "/parameters/voxel_rows: is not an object"},
        {R"({"parameters": {"depth_maps": {}}})", "/parameters/depth_maps: technique depth_maps is not known"},
        {R"({"selection": {"pixel": [1]}})", "/selection/pixel: is not a list of 2 numbers"},
        {R"({"selection": {"pixel": [1, -1]}})", "/selection/pixel/1: -1 is outside"},
        {R"({"free_camera": {"position_m": [0, 0, 0], "target_m": [0, 0, 0]}})", "/free_camera: has no picture"},
        {R"({"free_camera": {"target_m": [0, 0, 1e300]}})", "/free_camera/target_m/2: 1e+300 is outside"},
        {R"({"views": [{}, {"slab_voxels": 0}]})", "/views/1/slab_voxels: 0 is outside"},
        {R"({"views": 3})", "/views: is not a list"},
        {R"({"display": {"tone_curve": 1}})", "/display/tone_curve: is not true or false"},
        {R"({"a/b~c": 1})", "/a~1b~0c: is not known"}};
    for (const Refused& row : table)
        EXPECT_NE(refusal(Json::parse(row.json)).find(row.message), std::string::npos)
            << row.json << "\n gives " << refusal(Json::parse(row.json));
}

TEST(Session, RefusesMoreViewsThanItsLimit) {
    Json views = Json::array();
    for (std::size_t i = 0; i <= max_views; ++i) views.push_back(Json::object());
    EXPECT_NE(refusal({{"views", views}}).find("at most 16 entries"), std::string::npos);
}

TEST(SessionFile, ComesBackTheSame) {
    const fs::path file = fresh_folder() / "session.json";
    Session session = random_session(11);
    session.scene = "trees";
    session.environment.file.clear();
    save_session(file, session);
    EXPECT_EQ(load_session(file), session);
}

TEST(SessionFile, FindsItsSceneBesideItWhereverTheProgramRuns) {
    const fs::path folder = fresh_folder();
    Session session;
    session.scene = (folder / "models" / "house.glb").string();
    session.environment.file = (folder / "skies" / "noon.hdr").string();
    save_session(folder / "session.json", session);
    EXPECT_EQ(Json::parse(text_of(folder / "session.json"))["scene"], "models/house.glb");
    EXPECT_EQ(Json::parse(text_of(folder / "session.json"))["environment"]["file"], "skies/noon.hdr");
    EXPECT_EQ(fs::weakly_canonical(load_session(folder / "session.json").environment.file),
              fs::weakly_canonical(session.environment.file));
    EXPECT_EQ(fs::weakly_canonical(load_session(folder / "session.json").scene), fs::weakly_canonical(session.scene));
}

TEST(SessionFile, MayNotNameASceneOutsideItsFolder) {
    const fs::path folder = fresh_folder();
    fs::create_directory(folder / "inner");
    fs::create_directory_symlink("..", folder / "inner" / "link");
    for (const char* scene : {"../house.glb", "/etc/house.glb", "link/house.glb", "a/../../house.glb"}) {
        std::ofstream(folder / "inner" / "session.json") << Json{{"scene", scene}}.dump();
        EXPECT_THROW(load_session(folder / "inner" / "session.json"), InputError) << scene;
    }
}

TEST(SessionFile, IsRefusedWithLineAndColumnWhereItIsNotJson) {
    const fs::path file = fresh_folder() / "session.json";
    std::ofstream(file) << "{\n  \"seed\": 1,\n  \"scene\" \"atrium\"\n}\n";
    try {
        load_session(file);
        FAIL() << "accepted";
    } catch (const InputError& error) {
        EXPECT_EQ(error.place.substr(0, 6), "line 3") << error.what();
    }
}

TEST(SessionFile, IsRefusedWhereItIsNestedTooDeeply) {
    const fs::path file = fresh_folder() / "session.json";
    std::string deep;
    for (int level = 0; level < 200000; ++level) deep += "{\"a\":";
    std::ofstream(file) << deep;
    EXPECT_THROW(load_session(file), InputError);
}

TEST(SessionPart, ForgetsWhatAStageDoesNotDependOn) {
    const Session session = random_session(5);
    Session looks = session;
    looks.display.exposure_stops += 1.0f;
    looks.selection.pixel = ivec2(1, 1);
    looks.views.clear();
    looks.channel = session.channel;
    EXPECT_EQ(picture_part(looks), picture_part(session));
    Session lit = session;
    lit.lights.count = session.lights.count + 1;
    EXPECT_EQ(structure_part(lit), structure_part(session));
    EXPECT_EQ(surfaces_part(lit), surfaces_part(session));
    EXPECT_NE(picture_part(lit), picture_part(session));
    Session later = session;
    later.time_s += 1.0;
    EXPECT_NE(structure_part(later), structure_part(session));
    EXPECT_EQ(model_part(later), model_part(session));
}

TEST(SessionPart, DependsOnTheEnvironmentOnlyWhereThatLights) {
    Session session;
    Session turned = session;
    turned.environment.turn_deg = 20.0f;
    EXPECT_EQ(picture_part(turned), picture_part(session));
    EXPECT_EQ(reference_part(turned), reference_part(session));
    session.technique = turned.technique = "visibility_field";
    EXPECT_NE(picture_part(turned), picture_part(session));
    EXPECT_NE(reference_part(turned), reference_part(session));
    EXPECT_EQ(structure_part(turned), structure_part(session));
    Session lamps = session;
    lamps.lights.count = 77;
    EXPECT_EQ(picture_part(lamps), picture_part(session));
    EXPECT_EQ(lights_part(lamps), lights_part(session));
}

TEST(SessionPart, OfTheEnvironmentTurnsWithTimeAndForgetsTheSunOfAFile) {
    Session by_hand, by_time;
    by_hand.environment.turn_deg = 50.0f;
    by_time.environment.turn_deg = 10.0f;
    by_time.environment.turn_deg_per_s = 20.0f;
    by_time.time_s = 2.0;
    EXPECT_EQ(environment_part(by_time), environment_part(by_hand));
    by_time.time_s = 3.0;
    EXPECT_NE(environment_part(by_time), environment_part(by_hand));
    Session low = by_hand;
    low.environment.sun_elevation_deg = 5.0f;
    EXPECT_NE(environment_part(low), environment_part(by_hand));
    low.environment.file = by_hand.environment.file = "sky.hdr";
    EXPECT_EQ(environment_part(low), environment_part(by_hand));
}

TEST(SessionPart, OfTheStructureHoldsOnlyParametersThatChangeIt) {
    for (const Technique& technique : techniques()) {
        for (const Parameter& row : technique.parameters) {
            Session session;
            session.technique = std::string(technique.name);
            const Session at_defaults = session;
            const double other = row.default_value == row.lowest ? row.highest : row.lowest;
            session.parameters[session.technique][std::string(row.name)] = other;
            const bool changes = !(structure_part(session) == structure_part(at_defaults));
            EXPECT_EQ(changes, row.affects == ParameterAffects::structure) << row.name;
            EXPECT_NE(picture_part(session), picture_part(at_defaults)) << row.name;
        }
    }
}

TEST(ShippedSessions, LoadAndDifferInTheirTechniqueAlone) {
    std::map<std::string, Session> first_of_scene;
    std::set<std::string> techniques_shown;
    for (const auto& entry : fs::directory_iterator(fs::path(SIGHTLINES_SOURCE_FOLDER) / "lessons" / "comparisons")) {
        if (entry.path().extension() != ".json") continue;
        Session session = load_session(entry.path());
        EXPECT_TRUE(techniques_shown.insert(session.scene + session.technique).second) << entry.path();
        EXPECT_TRUE(entry.path().filename().string().starts_with(session.scene + "-")) << entry.path();
        session.technique.clear();
        session.parameters.clear();
        EXPECT_EQ(first_of_scene.emplace(session.scene, session).first->second, session) << entry.path();
    }
    EXPECT_EQ(techniques_shown.size(), 18u);
}

}  // namespace
}  // namespace sightlines
