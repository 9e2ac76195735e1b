// The lane that follows the rays of the selected pixel, records the selected one and takes the view inside out of the
// structure; that tries scenes; and that gives the shown picture new looks while the other lane is busy with the next.
#include "app/desk/lanes.h"
#include "app/desk/refining.h"
#include "app/desk/thread_priority.h"
#include "app/inside.h"

namespace sightlines {
namespace {

constexpr int niceness = 6;  ///< before the picture's threads: this lane's work is short, and somebody waits for it

struct RaysLane {
    Background::Objects& objects;
    std::optional<Session> done, rays_done;  ///< the keys of what was made, or refused, last
    UnpackedVoxels unpacked;
};

/// Nothing is set when the program ends.
struct RaysJob {
    std::optional<Session> session{};
    std::optional<std::string> trial{};
    std::optional<Shown> looks_of{};  ///< what is shown, to be given the looks of the session
};

/// The shown picture with the looks that are wanted.
Session with_wanted_looks(const Background::Objects& objects) {
    Session session = objects.shown.picture->session;
    session.display = objects.wanted->session.display;
    session.channel = objects.wanted->session.channel;
    return session;
}

/// Whether the shown picture can have other looks from what is at hand, and the other lane will not see to it soon.
bool looks_are_due(const Background::Objects& objects) {
    const Shown& shown = objects.shown;
    if (!objects.wanted || !objects.picture_work.building || !shown.picture || !shown.result || !shown.lights ||
        shown.picture->state != PictureState::complete)
        return false;
    const Session wanted = with_wanted_looks(objects);
    const ChannelSource from{&shown.result->value, nullptr, shown.errors ? &shown.errors->value : nullptr, 0};
    return wanted != shown.picture->session && can_show(wanted.channel, from);
}

RaysJob next_job(RaysLane& lane, std::shared_ptr<Progress>& progress) {
    Background::Objects& objects = lane.objects;
    std::unique_lock lock(objects.mutex);
    const auto rays_are_due = [&] {
        return objects.wanted && objects.ready && *objects.ready == stage_key(objects.wanted->session) &&
               lane.done != rays_key(objects.wanted->session, true);
    };
    objects.wake.wait(
        lock, [&] { return objects.closing || objects.trial_wanted || looks_are_due(objects) || rays_are_due(); });
    if (objects.closing) return {};
    RaysJob job;
    if (looks_are_due(objects)) {
        job.session = with_wanted_looks(objects);
        job.looks_of = objects.shown;
        return job;
    }
    progress = std::make_shared<Progress>();
    job.trial = std::exchange(objects.trial_wanted, std::nullopt);
    objects.trying = job.trial.has_value();
    if (!job.trial) job.session = objects.wanted->session;
    objects.rays_work = {progress, job.trial ? Session{} : *job.session, false};
    return job;
}

void follow_rays(RaysLane& lane, const Session& session, Progress& progress) {
    Background::Objects& objects = lane.objects;
    Results& results = objects.results;
    std::shared_ptr<const PixelRays> rays;
    {
        const std::lock_guard lock(objects.mutex);
        rays = objects.shown.rays;
    }
    if (!rays || lane.rays_done != rays_key(session, false)) {
        rays = std::make_shared<const PixelRays>(pixel_rays(session, results, progress));
        put_out(objects, [&](Shown& shown) { replace_shown(objects, shown.rays, rays); });
        lane.rays_done = rays_key(session, false);
    }
    const auto ray = std::make_shared<const SelectedRay>(select_ray(session, *rays, results, progress));
    put_out(objects, [&](Shown& shown) { replace_shown(objects, shown.ray, ray); });
    std::shared_ptr<const InsidePicture> inside;
    if (!shown_figure(session).empty())
        inside = std::make_shared<const InsidePicture>(inside_picture(session, *ray, results, progress, lane.unpacked));
    put_out(objects, [&](Shown& shown) { replace_shown(objects, shown.inside, inside); });
}

void run_rays(RaysLane& lane, const Session& session, Progress& progress) {
    lane.done.reset();  // what is shown may be of this session from now on
    run_work(lane.objects, session, &Shown::ray_failure, [&] { follow_rays(lane, session, progress); });
    if (!progress.cancelled()) lane.done = rays_key(session, true);
}

void give_looks(Background::Objects& objects, const Session& session, const Shown& before) {
    const ChannelSource from{&before.result->value, nullptr, before.errors ? &before.errors->value : nullptr,
                             rays_per_pixel(session, before.lights->value)};
    put_out_picture(objects, pixels_of(session, from), session, PictureState::complete, before.picture.get());
}

SceneTrial tried(Results& results, const std::string& scene, Progress& progress) {
    Session session;
    session.scene = scene;
    try {
        const auto model = results.tried_model(session, progress);
        progress.begin("looking at the scene", 1);
        model->value.at(session.time_s);
        progress.check();
        return {scene, std::nullopt};
    } catch (const Cancelled&) {
        return {scene, "Opening " + scene + " was stopped."};
    } catch (const std::bad_alloc&) {
        return {scene, "There is not enough memory to open " + scene + "."};
    } catch (const InputError& error) {
        return {scene, error.what()};
    } catch (const EnvironmentError& error) {
        return {scene, error.what()};
    }
}

void run_trial(RaysLane& lane, const std::string& scene, Progress& progress) {
    const SceneTrial trial = tried(lane.objects.results, scene, progress);
    put_out(lane.objects, [&](Shown&) {
        lane.objects.trying = false;
        if (!lane.objects.trial_wanted) lane.objects.trial = trial;
    });
}

}  // namespace

void run_rays_lane(Background::Objects& objects) {
    lower_priority(niceness);
    RaysLane lane{objects, {}, {}, {}};
    std::shared_ptr<Progress> progress;
    for (;;) {
        const RaysJob job = next_job(lane, progress);
        if (job.looks_of) {
            give_looks(objects, *job.session, *job.looks_of);
            continue;
        }
        if (job.trial)
            run_trial(lane, *job.trial, *progress);
        else if (job.session)
            run_rays(lane, *job.session, *progress);
        else
            return;
        {
            const std::lock_guard lock(objects.mutex);
            objects.rays_work.progress.reset();
            ++objects.shown.number;
        }
        objects.changed();
    }
}

}  // namespace sightlines
