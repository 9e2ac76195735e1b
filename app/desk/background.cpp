#include "app/desk/background.h"

#include <algorithm>

#include "app/desk/lanes.h"
#include "app/inside.h"

namespace sightlines {
namespace {

constexpr double shortest_estimate_s = 0.3, least_fraction = 0.05;

/// Whether what the lane does serves the session as well.
bool serves(const LaneWork& work, const Session& session, bool dragging) {
    if (picture_key(work.session) == picture_key(session)) return !work.draft || dragging;
    // A draft is finished, so that something moves; but not where that means to build a structure that nobody wants.
    return work.draft && dragging && (!work.building || structure_part(work.session) == structure_part(session));
}

void cancel_work(const LaneWork& work) {
    if (work.progress) work.progress->cancel();
}

std::optional<Work> work_shown(const LaneWork& work) {
    if (!work.progress) return std::nullopt;
    Work shown{work.progress->stage(), std::clamp(work.progress->fraction(), 0.0, 1.0), 0.0, std::nullopt};
    if (shown.title.empty()) return std::nullopt;
    if (work.timed != work.progress.get() || work.stage != shown.title) {
        work.timed = work.progress.get();
        work.stage = shown.title;
        work.began = Clock::now();
    }
    shown.elapsed_s = std::chrono::duration<double>(Clock::now() - work.began).count();
    if (shown.fraction > least_fraction && shown.elapsed_s > shortest_estimate_s)
        shown.left_s = shown.elapsed_s * (1.0 - shown.fraction) / shown.fraction;
    return shown;
}

}  // namespace

Session picture_key(const Session& session) { return picture_part(session); }

Session stage_key(const Session& session) {
    Session key = picture_part(session);
    key.reference = false;
    return key;
}

Session rays_key(const Session& session, bool light) {
    Session key = stage_key(session);
    key.selection.pixel = session.selection.pixel;
    if (!light) return key;
    key.selection.light = session.selection.light;
    if (shows_cells(session)) key.selection.voxel = session.selection.voxel;
    key.views = {View{std::string(shown_figure(session)), {}}};  // whose picture is taken out of the structure
    return key;
}

void free_retired(Background::Objects& objects) {
    Retired freed;  // after the lock is released
    const std::lock_guard lock(objects.mutex);
    const auto ours = std::partition(objects.retired.begin(), objects.retired.end(),
                                     [](const auto& held) { return held.use_count() > 1; });
    freed.assign(std::make_move_iterator(ours), std::make_move_iterator(objects.retired.end()));
    objects.retired.erase(ours, objects.retired.end());
}

Background::Objects::Objects(Results& results_, std::function<void()> changed_)
    : results(results_), changed(std::move(changed_)) {
    picture_lane = std::thread([this] { run_picture_lane(*this); });
    rays_lane = std::thread([this] { run_rays_lane(*this); });
}

Background::Objects::~Objects() {
    {
        const std::lock_guard lock(mutex);
        closing = true;
        cancel_work(picture_work);
        cancel_work(rays_work);
    }
    wake.notify_all();
    picture_lane.join();
    rays_lane.join();
}

Background::Background(Results& results, std::function<void()> changed)
    : objects(std::make_unique<Objects>(results, std::move(changed))) {}
Background::~Background() = default;
Background::Background(Background&&) noexcept = default;
Background& Background::operator=(Background&&) noexcept = default;

void want(Background& background, const Session& session, bool dragging) {
    Background::Objects& objects = *background.objects;
    {
        const std::lock_guard lock(objects.mutex);
        std::optional<Wanted>& wanted = objects.wanted;
        if (wanted && wanted->session == session && wanted->dragging == dragging) return;
        const bool new_picture = !wanted || picture_key(wanted->session) != picture_key(session);
        const bool new_rays = !wanted || rays_key(wanted->session, true) != rays_key(session, true);
        if (new_picture && objects.shown.cancelled) {
            objects.shown.cancelled = false;
            ++objects.shown.number;
        }
        if (objects.picture_work.progress && !serves(objects.picture_work, session, dragging))
            cancel_work(objects.picture_work);
        if (new_rays && !objects.trying) cancel_work(objects.rays_work);
        wanted = Wanted{session, dragging, wanted ? wanted->number + 1 : 1};
    }
    objects.wake.notify_all();
}

void cancel(Background& background) {
    Background::Objects& objects = *background.objects;
    {
        const std::lock_guard lock(objects.mutex);
        if (objects.trying) cancel_work(objects.rays_work);
        if (!objects.picture_work.progress) return;
        cancel_work(objects.picture_work);
        objects.shown.cancelled = true;
        ++objects.shown.number;
    }
    objects.changed();
}

void resume(Background& background) {
    Background::Objects& objects = *background.objects;
    {
        const std::lock_guard lock(objects.mutex);
        if (!objects.shown.cancelled) return;
        objects.shown.cancelled = false;
        ++objects.shown.number;
        if (objects.wanted) ++objects.wanted->number;
    }
    objects.wake.notify_all();
    objects.changed();
}

void try_scene(Background& background, const std::string& scene) {
    Background::Objects& objects = *background.objects;
    {
        const std::lock_guard lock(objects.mutex);
        objects.trial_wanted = scene;
        objects.trial.reset();
        cancel_work(objects.rays_work);
    }
    objects.wake.notify_all();
}

std::optional<SceneTrial> take_trial(Background& background) {
    const std::lock_guard lock(background.objects->mutex);
    return std::exchange(background.objects->trial, std::nullopt);
}

Shown shown(const Background& background) {
    const Background::Objects& objects = *background.objects;
    const std::lock_guard lock(objects.mutex);
    Shown now = objects.shown;
    for (const LaneWork* lane : {&objects.picture_work, &objects.rays_work})
        if (auto work = work_shown(*lane)) now.work.push_back(std::move(*work));
    return now;
}

}  // namespace sightlines
