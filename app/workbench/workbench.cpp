#include "app/workbench/workbench.h"

#include <atomic>
#include <chrono>
#include <cmath>
#include <utility>

#include "app/desk/autosave.h"
#include "app/desk/background.h"
#include "app/desk/history.h"
#include "app/desk/inside_thread.h"
#include "app/workbench/actions.h"
#include "app/workbench/frame.h"
#include "app/workbench/frame_log.h"
#include "app/workbench/panes.h"
#include "techniques/base/error.h"

namespace sightlines {
namespace {

using Clock = std::chrono::steady_clock;

constexpr ImageSize first_size{1600, 900};
constexpr auto gesture_pause = std::chrono::milliseconds(300);  // wheel steps closer than this are one gesture
constexpr int frames_to_settle = 3;                             // ImGui's layouts need a frame or two after an input
constexpr double idle_wait_s = 0.5, working_wait_s = 0.1;
constexpr int least_picture_side = 64;

/// Everything that lives as long as the window. The order is that of the start; the end goes backwards.
struct Bench {
    std::atomic<const Window*> waiting{nullptr};  ///< that the threads may wake
    Results results{0, automatic_backend};
    Background background;
    InsideThread inside;
    Autosave autosave;
    Window window;
    PaneTextures textures;
    Ui ui;
    History history;
    FrameLog log;
    Session wanted;  ///< that the background was asked for last
    bool wanted_draft = false;
    Clock::time_point last_gesture;
    int settling = frames_to_settle;
    Shared<Scene> announced;     ///< the scene whose notes were shown and that the title names
    std::string save_complaint;  ///< that was shown

    explicit Bench(const WorkbenchRequest& request)
        : background(results, [this] { wake_window(); }),
          inside([this] { wake_window(); }),
          autosave(request.session_file),
          window(started(request.session), first_size),
          log(open_frame_log(request.frame_log)) {
        history.now = request.session;
        ui.recent = recent_scenes();
        if (request.message) ui.message = Message{*request.message, true};
        waiting = &window;
        on_display_lost(
            window, [](void* saved) { save_now(*static_cast<Autosave*>(saved)); }, &autosave);
    }
    ~Bench() { waiting = nullptr; }
    Bench(const Bench&) = delete;
    Bench& operator=(const Bench&) = delete;

    void wake_window() const {
        if (const Window* const window_now = waiting) wake(*window_now);
    }
    /// The work begins before the window opens: both take their time.
    std::string started(const Session& session) {
        results.cache_folder = default_cache_folder();
        want(background, session, true);
        return "Sightlines";
    }
};

WindowLook look_of(const Session& session) { return {session.workbench.theme, session.workbench.text_scale}; }

const Area* pane_with(const Layout& layout, const Arrangement& areas, PaneContent content) {
    for (std::size_t place = 0; place < pane_count; ++place)
        if (layout.panes[place] == content && areas.panes[place].size.x > 0.0f) return &areas.panes[place];
    return nullptr;
}

/// The picture's size follows its pane, the picked pixel stays where it is in the picture.
void fit_picture(Session& session, const Arrangement& areas, float scale) {
    if (!session.workbench.fit_picture) return;
    const Area* const pane = pane_with(session.workbench.layout, areas, PaneContent::image);
    if (pane == nullptr) return;
    const vec2 room = glm::floor(pane_body(*pane, scale).size);
    const ImageSize size{std::max(static_cast<int>(room.x), least_picture_side),
                         std::max(static_cast<int>(room.y), least_picture_side)};
    if (size == session.size) return;
    if (session.selection.pixel) {
        const vec2 share = (vec2(*session.selection.pixel) + 0.5f) / vec2(session.size.width, session.size.height);
        session.selection.pixel = ivec2(share * vec2(size.width, size.height));
    }
    session.size = size;
}

/// How long the session's time runs before it begins again: as the scene moves, or as its surroundings turn once.
double running_time_s(const Session& session, double scene_duration_s) {
    const auto turning = static_cast<double>(std::abs(session.environment.turn_deg_per_s));
    if (scene_duration_s > 0.0 || !lit_by_environment(session) || turning == 0.0) return scene_duration_s;
    return 360.0 / turning;
}

/// What was dropped on the window: scenes, sessions and environments, the last of each counts.
void open_dropped(Frame& frame, const std::vector<std::filesystem::path>& files) {
    for (const auto& file : files) {
        if (file.extension() == ".hdr") {
            open_environment(frame, file);
            continue;
        }
        if (file.extension() != ".json") {
            open_scene(frame, file.string());
            continue;
        }
        try {
            frame.next = load_session(file);
        } catch (const std::runtime_error& error) {
            frame.ui.message = Message{error.what(), true};
        }
    }
}

/// The session takes a scene that could be read: what belonged to the old one's space is let go.
void take_scene(Frame& frame) {
    const auto trial = take_trial(frame.background);
    if (!trial) return;
    if (trial->failure) {
        frame.ui.message = Message{*trial->failure, true};
        return;
    }
    Session& next = frame.next;
    next.scene = trial->scene;
    next.camera.clear();
    next.free_camera.reset();
    next.time_s = 0.0;
    frame.ui.playing.reset();
    next.lights.moved.clear();
    next.selection = {};
    set_inside_state(next, reframed(inside_state(next)));
    if (std::filesystem::path(trial->scene).has_extension()) {
        remember_scene(trial->scene);
        frame.ui.recent = recent_scenes();
    }
}

void draw_everything(Frame& frame, const Arrangement& areas) {
    draw_top_bar(frame, areas.top_bar);
    for (std::size_t place = 0; place < pane_count; ++place)
        if (areas.panes[place].size.x > 0.0f) draw_pane(frame, static_cast<PanePlace>(place), areas.panes[place]);
    draw_step_bar(frame, areas.step_bar);
    draw_status_bar(frame, areas.status_bar);
    draw_splitters(frame, areas);
    draw_message(frame, areas.top_bar);
    draw_dialogs(frame);
}

/// What the frame left behind becomes the session; undo and redo go by whole gestures.
void commit(Bench& bench, const Frame& frame) {
    const auto now = Clock::now();
    const bool new_press = ImGui::IsMouseClicked(ImGuiMouseButton_Left) ||
                           ImGui::IsMouseClicked(ImGuiMouseButton_Right) ||
                           ImGui::IsMouseClicked(ImGuiMouseButton_Middle);
    if (new_press || (!frame.in_gesture && now - bench.last_gesture > gesture_pause)) end_gesture(bench.history);
    if (frame.in_gesture) bench.last_gesture = now;
    edit(bench.history, frame.next, frame.in_gesture);
    if (frame.undo) undo(bench.history);
    if (frame.redo) redo(bench.history);
}

/// Hands the session to the threads. A drag that would build a new structure at every step waits for its end.
void ask_for_work(Bench& bench, const Frame& frame) {
    const Session& now = bench.history.now;
    const bool dragging = frame.in_gesture || Clock::now() - bench.last_gesture < gesture_pause;
    const bool same_structure = structure_part(now) == structure_part(bench.wanted);
    if (dragging && !same_structure && ImGui::IsAnyItemActive()) return;
    if (now == bench.wanted && dragging == bench.wanted_draft) return;
    want(bench.background, now, dragging);
    bench.wanted = now;
    bench.wanted_draft = dragging;
}

void ask_for_inside(Bench& bench, const Frame& frame, const Arrangement& areas) {
    const Session& now = bench.history.now;
    const Area* const pane = pane_with(now.workbench.layout, areas, PaneContent::inside);
    if (pane == nullptr || !frame.shown.inside) return;
    const Area body = pane_body(*pane, frame.scale);
    InsideRequest request{frame.shown.inside, inside_state(now), {}, {}, frame.scale};
    request.state.theme = now.workbench.theme;
    request.size = {std::max(static_cast<int>(body.size.x), 1), std::max(static_cast<int>(body.size.y), 1)};
    if (const auto steps = recorded_steps(frame); !steps.empty()) {
        const std::size_t step = std::min<std::size_t>(now.selection.step, steps.size() - 1);
        request.lit.step = steps[step].geometry;
    }
    request.lit.pointed = frame.ui.pointed;
    const VoxelRowPicture* const rows = rows_in_space(*frame.shown.inside);
    if (rows != nullptr && now.selection.voxel && ray_is_current(frame))
        request.lit.pointed.push_back(voxel_box(*rows, *now.selection.voxel));
    draw(bench.inside, request);
}

/// What the user should know without having asked: the notes of a new scene, and that the session cannot be saved.
void announce(Bench& bench, const Shown& now) {
    if (now.scene && now.scene != bench.announced) {
        bench.announced = now.scene;
        set_title(bench.window, now.scene->value.name + " - Sightlines");
        std::string notes;
        for (const std::string& note : now.scene->value.notes) notes.append(notes.empty() ? "" : "\n").append(note);
        if (!notes.empty() && !bench.ui.message) bench.ui.message = Message{notes, false};
    }
    const std::string complaint = save_failure(bench.autosave);
    if (complaint != bench.save_complaint && !complaint.empty()) bench.ui.message = Message{complaint, true};
    bench.save_complaint = complaint;
}

/// How long nothing has to be drawn if nothing happens.
double wait_of(const Bench& bench, const Frame& frame) {
    if (frame.in_gesture || bench.settling > 0) return 0.0;
    if (Clock::now() - bench.last_gesture < gesture_pause || ImGui::GetIO().WantTextInput) return working_wait_s;
    return frame.shown.work.empty() ? idle_wait_s : working_wait_s;
}

std::string working_text(const Shown& shown) {
    std::string text;
    for (const Work& work : shown.work) text.append(text.empty() ? "" : "; ").append(work.title);
    return text;
}

/// One frame; gives how long to wait before the next.
double draw_frame(Bench& bench, const WindowEvents& events) {
    const auto start = Clock::now();
    if (events.any_input)
        bench.settling = frames_to_settle;
    else
        bench.settling = std::max(0, bench.settling - 1);
    Session& session = bench.history.now;
    const float unit = scale(bench.window);
    const ImageSize window_size = framebuffer_size(bench.window);
    fit_picture(session, arrange(session.workbench.layout, window_size, unit), unit);
    const Arrangement areas = arrange(session.workbench.layout, window_size, unit);
    Shown shown_now = shown(bench.background);
    shown_now.duration_s = running_time_s(session, shown_now.duration_s);
    const auto inside_now = shown(bench.inside);
    const std::string inside_failure = failure(bench.inside);
    announce(bench, shown_now);
    bench.ui.pointed.clear();
    Frame frame{.window = bench.window,
                .background = bench.background,
                .shown = shown_now,
                .inside = inside_now,
                .inside_failure = inside_failure,
                .textures = bench.textures,
                .ui = bench.ui,
                .session = session,
                .next = session,
                .scale = unit,
                .fonts = fonts(bench.window),
                .colours = colours(session.workbench.theme),
                .can_undo = can_undo(bench.history),
                .can_redo = can_redo(bench.history)};
    open_dropped(frame, events.dropped_files);
    take_scene(frame);
    run_keys(frame, events.keys);
    go_on_playing(frame);
    draw_everything(frame, areas);
    if (events.closing) bench.ui.quitting = true;
    commit(bench, frame);
    ask_for_work(bench, frame);
    ask_for_inside(bench, frame, areas);
    save_soon(bench.autosave, bench.history.now);
    end_frame(bench.window);
    log_frame(bench.log, start, working_text(shown_now));
    return wait_of(bench, frame);
}

}  // namespace

Session first_session() {
    Session session;
    session.lights.count = 1024;
    session.size = {608, 488};
    session.workbench.fit_picture = true;
    return session;
}

void run_workbench(const WorkbenchRequest& request, const Progress& stop) {
    prepare_drivers();
    Bench bench(request);
    double wait_s = 0.0;
    while (!bench.ui.quitting && !stop.cancelled()) {
        const WindowEvents events = begin_frame(bench.window, look_of(bench.history.now), wait_s);
        wait_s = draw_frame(bench, events);
    }
}

}  // namespace sightlines
