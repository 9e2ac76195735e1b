// The lane that makes the picture: scene, a quick preview, lights, surfaces, structure, picture, reference, errors.
#include <algorithm>
#include <utility>

#include "app/desk/lanes.h"
#include "app/desk/refining.h"
#include "app/desk/thread_priority.h"

namespace sightlines {
namespace {

constexpr int niceness = 10;
constexpr int draft_divisor = 4, least_draft_width = 160;
constexpr std::size_t most_preview_lights = 16;
constexpr auto while_retired = std::chrono::milliseconds(100);
constexpr auto longest_wait_for_window = std::chrono::milliseconds(200);

/// What the lane keeps between jobs.
struct PictureLane {
    Background::Objects& objects;
    std::uint64_t taken = 0;  ///< the number of the Wanted that was worked on last
    // Drafts and previews have surfaces of their own, so that those of the full size stay.
    std::optional<Session> small_part{};
    Shared<Scene> small_scene{};
    SurfaceBuffer small_surfaces{};
};

/// One job with what all its steps need.
struct Job {
    PictureLane& lane;
    Session session;
    bool dragging = false;
    Progress& progress;
    Shared<Scene> scene;
    Shared<std::vector<Light>> lights;

    Background::Objects& objects() const { return lane.objects; }
    Results& results() const { return lane.objects.results; }
    std::size_t rays_per_pixel() const { return sightlines::rays_per_pixel(session, lights->value); }
};

Session small_session(Session session) {
    const ImageSize full = session.size;
    const int width = std::min(full.width, std::max(full.width / draft_divisor, least_draft_width));
    const double scale = static_cast<double>(width) / full.width;
    session.size = {width, std::max(1, static_cast<int>(full.height * scale + 0.5))};
    return session;
}

const SurfaceBuffer& small_surfaces(const Job& job, const Session& small) {
    PictureLane& lane = job.lane;
    const Session part = surfaces_part(small);
    if (lane.small_part == part && lane.small_scene == job.scene) return lane.small_surfaces;
    const auto embree = job.results().embree(job.session, job.progress);
    lane.small_part.reset();
    lane.small_surfaces = visible_surfaces(job.scene->value, *embree->value, session_camera(small, job.scene->value),
                                           small.size, job.results().threads(), job.progress);
    lane.small_part = part;
    lane.small_scene = job.scene;
    return lane.small_surfaces;
}

/// A few of the lights, as bright together as all.
std::vector<Light> few_lights(const std::vector<Light>& lights) {
    const std::size_t count = std::min(lights.size(), most_preview_lights);
    std::vector<Light> few;
    for (std::size_t i = 0; i < count; ++i) {
        few.push_back(lights[i * lights.size() / count]);
        few.back().intensity *= static_cast<float>(lights.size()) / static_cast<float>(count);
    }
    return few;
}

void make_preview(const Job& job) {
    const Session small = small_session(job.session);
    const auto embree = job.results().embree(job.session, job.progress);
    const SurfaceBuffer& surfaces = small_surfaces(job, small);
    const std::vector<Light> lights = few_lights(job.lights->value);
    PictureRequest asked;
    if (lit_by_environment(job.session)) asked = job.results().request(small, surfaces, lights, job.progress);
    // Otherwise not Results' own request, which would have to know the backend first: asking the driver takes time.
    RenderRequest& request = asked.request;
    request.surfaces = &surfaces;
    request.lights = lights;
    request.threads = job.results().threads();
    request.keep_verdicts = false;
    const RenderResult result =
        reference_picture(find_technique(job.session.technique), *embree->value, request, job.progress);
    const Session looks = with_newest_looks(job.objects(), job.session);
    put_out_picture(job.objects(), pixels_of(looks, {&result, nullptr, nullptr, rays_per_pixel(small, lights)}), looks,
                    PictureState::preview);
}

/// Scene and lights, and a wrong camera is refused before the long work.
void prepare_scene(Job& job) {
    job.scene = job.results().scene(job.session, job.progress);
    session_camera(job.session, job.scene->value);
    job.lights = job.results().lights(job.session, job.progress);
    bool new_scene = false;
    {
        const std::lock_guard lock(job.objects().mutex);
        new_scene = job.objects().shown.scene != job.scene;
        if (!new_scene && job.objects().shown.lights == job.lights) return;
    }
    const auto model = new_scene ? job.results().model(job.session, job.progress) : nullptr;
    put_out(job.objects(), [&](Shown& shown) {
        if (model) shown.measured.load_s = job.scene->seconds + model->seconds;
        if (model) shown.duration_s = model->value.duration_s;
        replace_shown(job.objects(), shown.scene, job.scene);
        replace_shown(job.objects(), shown.lights, job.lights);
    });
}

/// The old structure goes before the next is built, and the window must have let go of it for that: it shows none
/// meanwhile.
void make_room(const Job& job) {
    std::weak_ptr<const Made<BuiltStructure>> old;
    {
        const std::lock_guard lock(job.objects().mutex);
        old = job.objects().shown.structure;
    }
    if (old.expired()) return;
    put_out(job.objects(),
            [&](Shown& shown) { replace_shown<Made<BuiltStructure>>(job.objects(), shown.structure, nullptr); });
    const Clock::time_point latest = Clock::now() + longest_wait_for_window;
    constexpr long retired_and_results = 2;
    while (old.use_count() > retired_and_results && Clock::now() < latest) {
        job.progress.check();
        std::this_thread::sleep_for(std::chrono::milliseconds(4));
    }
    const std::lock_guard lock(job.objects().mutex);
    std::erase_if(job.objects().retired, [&](const std::shared_ptr<const void>& held) {
        return !held.owner_before(old) && !old.owner_before(held);
    });
}

/// From here on a draft gives way where it would build what the mouse has left already.
void begin_building(const Job& job) {
    const std::lock_guard lock(job.objects().mutex);
    job.objects().picture_work.building = true;
    if (structure_part(job.objects().wanted->session) != structure_part(job.session)) throw Cancelled();
}

bool preview_helps(const Job& job) {
    if (view_is_shown(job.objects(), job.session)) return false;
    const std::lock_guard lock(job.objects().mutex);
    return !follows_quickly(job.objects().shown, job.session);
}

Shared<BuiltStructure> prepare_structure(const Job& job) {
    Shared<BuiltStructure> structure = job.results().latest_structure(job.session);
    if (!structure) {
        if (preview_helps(job)) make_preview(job);
        begin_building(job);
        make_room(job);
        structure = job.results().structure(job.session, job.progress);
    }
    bool is_new = false;
    {
        const std::lock_guard lock(job.objects().mutex);
        job.objects().picture_work.building = false;
        is_new = job.objects().shown.structure != structure;
    }
    if (is_new)
        put_out(job.objects(), [&](Shown& shown) {
            replace_shown(job.objects(), shown.structure, structure);
            shown.measured.build_s = structure->value.statistics.build_seconds;
            shown.measured.structure_bytes = structure->value.statistics.structure_bytes;
        });
    return structure;
}

void make_draft(const Job& job) {
    const Shared<BuiltStructure> structure = prepare_structure(job);
    const Session small = small_session(job.session);
    PictureRequest asked = job.results().request(small, small_surfaces(job, small), job.lights->value, job.progress);
    asked.request.keep_verdicts = false;
    const RenderResult result =
        structure->value.technique->render(structure->value.structure, asked.request, job.progress);
    const Session looks = with_newest_looks(job.objects(), job.session);
    put_out_picture(job.objects(), pixels_of(looks, {&result, nullptr, nullptr, job.rays_per_pixel()}), looks,
                    PictureState::draft);
}

/// Puts out what is known now of the finished picture. Until the reference is there, a channel that compares shows the
/// lit picture.
void put_out_finished(const Job& job, const RenderResult& picture, const RenderResult* reference = nullptr,
                      const ErrorMetrics* errors = nullptr, const ErrorMetrics* compression = nullptr) {
    const Session looks = with_newest_looks(job.objects(), job.session);
    const ChannelSource from{&picture, reference, errors, job.rays_per_pixel(), compression};
    put_out_picture(job.objects(), pixels_of(looks, from), looks,
                    can_show(looks.channel, from) ? PictureState::complete : PictureState::refining);
}

/// Whether the pixels for these looks of this result are on the screen.
bool is_put_out(const Job& job, const Shared<RenderResult>& picture) {
    const std::lock_guard lock(job.objects().mutex);
    const Shown& shown = job.objects().shown;
    return shown.picture && shown.result == picture && shown.picture->state == PictureState::complete &&
           shown.picture->session.display == job.session.display &&
           shown.picture->session.channel == job.session.channel &&
           picture_key(shown.picture->session) == picture_key(job.session);
}

void put_out_measured(const Job& job, const Shared<RenderResult>& picture, const Shared<ErrorMetrics>& errors) {
    put_out(job.objects(), [&](Shown& shown) {
        replace_shown(job.objects(), shown.result, picture);
        replace_shown(job.objects(), shown.errors, errors);
        Measured& measured = shown.measured;
        measured.render_s = picture->value.seconds;
        measured.rays_per_second.reset();
        if (picture->value.seconds > 0.0)
            measured.rays_per_second = static_cast<double>(picture->value.rays) / picture->value.seconds;
        measured.device = picture->value.device;
        measured.visibility_percent.reset();
        measured.shadow_percent.reset();
        if (!errors) return;
        measured.visibility_percent = errors->value.visibility_percent;
        measured.shadow_percent = errors->value.shadow_percent;
    });
}

std::uint64_t newest_number(const Background::Objects& objects) {
    const std::lock_guard lock(objects.mutex);
    return objects.wanted->number;
}

bool compares(Channel channel) {
    return channel == Channel::reference || channel == Channel::visibility_error || channel == Channel::shadow_error ||
           channel == Channel::compression;
}

/// Whether a picture of this channel is shown, which stays until the next that compares is there.
bool channel_is_shown(const Job& job) {
    if (!view_is_shown(job.objects(), job.session)) return false;
    const std::lock_guard lock(job.objects().mutex);
    return job.objects().shown.picture->session.channel == job.session.channel &&
           job.objects().shown.picture->state == PictureState::complete;
}

/// The reference, shown as it comes where the session looks at it; the looks of the lit picture change meanwhile.
Shared<RenderResult> make_reference(const Job& job, const Shared<RenderResult>& picture) {
    Refining refining = start_refining(job.objects(), job.session, job.rays_per_pixel());
    refining.technique = &picture->value;
    std::uint64_t looks = newest_number(job.objects());
    const auto on_region = [&](const RenderResult& so_far, PixelRect changed) {
        if (job.session.channel == Channel::reference) return refine(refining, so_far, changed);
        if (compares(job.session.channel) || std::exchange(looks, newest_number(job.objects())) == looks) return;
        put_out_finished(job, picture->value);
    };
    return job.results().reference(job.session, job.progress, on_region);
}

void compare_with_reference(const Job& job, const Shared<RenderResult>& picture) {
    bool known = false;
    {
        const std::lock_guard lock(job.objects().mutex);
        known = job.objects().shown.result == picture && job.objects().shown.errors;
    }
    if (!known) {
        put_out_measured(job, picture, nullptr);
        if (!compares(job.session.channel)) put_out_finished(job, picture->value);
    }
    const auto reference = known ? job.results().reference(job.session, job.progress) : make_reference(job, picture);
    const auto errors = job.results().errors(job.session, job.progress);
    if (!known) put_out_measured(job, picture, errors);
    if (known && is_put_out(job, picture)) return;
    const auto compression =
        job.session.channel == Channel::compression ? job.results().compression(job.session, job.progress) : nullptr;
    put_out_finished(job, picture->value, &reference->value, &errors->value,
                     compression ? &compression->value : nullptr);
}

/// The technique's picture, finer and finer on the screen.
Shared<RenderResult> refined_picture(const Job& job) {
    if (auto ready = job.results().latest_picture(job.session)) return ready;
    Refining refining = start_refining(job.objects(), job.session, job.rays_per_pixel());
    OnRegion on_region = [&](const RenderResult& so_far, PixelRect changed) { refine(refining, so_far, changed); };
    if (compares(job.session.channel) && channel_is_shown(job)) on_region = [](const RenderResult&, PixelRect) {};
    return job.results().picture(job.session, job.progress, on_region);
}

void make_picture(Job job) {
    prepare_scene(job);
    if (job.dragging && !job.results().latest_picture(job.session)) return make_draft(job);
    const Shared<BuiltStructure> structure = prepare_structure(job);
    job.results().surfaces(job.session, job.progress);
    {
        const std::lock_guard lock(job.objects().mutex);
        job.objects().ready = stage_key(job.session);
    }
    job.objects().wake.notify_all();

    const Shared<RenderResult> picture = refined_picture(job);
    if (needs_reference(job.session)) return compare_with_reference(job, picture);
    if (is_put_out(job, picture)) return;
    put_out_measured(job, picture, nullptr);
    put_out_finished(job, picture->value);
}

/// The next thing to work on; null when the program ends.
std::optional<Wanted> next_wanted(PictureLane& lane, std::shared_ptr<Progress>& progress) {
    Background::Objects& objects = lane.objects;
    std::unique_lock lock(objects.mutex);
    const auto there_is_work = [&] {
        return objects.closing || (objects.wanted && objects.wanted->number != lane.taken && !objects.shown.cancelled);
    };
    while (!there_is_work()) {
        if (objects.retired.empty()) {
            objects.wake.wait(lock);
            continue;
        }
        objects.wake.wait_for(lock, while_retired, there_is_work);
        lock.unlock();
        free_retired(objects);
        lock.lock();
    }
    if (objects.closing) return std::nullopt;
    const Wanted wanted = *objects.wanted;
    lane.taken = wanted.number;
    if (objects.ready && *objects.ready != stage_key(wanted.session)) objects.ready.reset();
    progress = std::make_shared<Progress>();
    objects.picture_work = {progress, wanted.session, wanted.dragging};
    return wanted;
}

}  // namespace

void run_picture_lane(Background::Objects& objects) {
    lower_priority(niceness);
    PictureLane lane{objects};
    std::shared_ptr<Progress> progress;
    while (const std::optional<Wanted> wanted = next_wanted(lane, progress)) {
        free_retired(objects);
        run_work(objects, wanted->session, &Shown::picture_failure, [&] {
            make_picture({lane, wanted->session, wanted->dragging, *progress, nullptr, nullptr});
        });
        {
            const std::lock_guard lock(objects.mutex);
            objects.picture_work = {};
            ++objects.shown.number;
        }
        objects.changed();
    }
}

}  // namespace sightlines
