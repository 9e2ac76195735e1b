// The heavy results that a session stands for: loaded, built, rendered once, and kept while the part of the session
// that they depend on stays the same. Moving a light does not rebuild the structure; the exposure renders nothing.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/session.h"
#include "techniques/rays/embree_scene.h"
#include "techniques/rays/reference.h"
#include "techniques/technique.h"

namespace sightlines {

/// A result and what it took to make it.
template <class Value>
struct Made {
    Value value;
    double seconds = 0.0;
};
template <class Value>
using Shared = std::shared_ptr<const Made<Value>>;

/// A built structure, with the scene that it came from kept alive.
struct BuiltStructure {
    const Technique* technique = nullptr;
    std::shared_ptr<const Made<Scene>> scene;
    Structure structure;
    Statistics statistics;
};

/// The latest result of one stage, and the part of the session that it was made from. Any number of threads may ask;
/// one makes, and the others wait for it (and give up when their own progress is cancelled).
template <class Value>
class Stage {
public:
    /// The result for `part`, or null where the latest one is for another part. Does not wait for work under way.
    Shared<Value> latest(const Session& part) const {
        const std::lock_guard lock(latest_mutex_);
        return part_ && *part_ == part ? value_ : nullptr;
    }
    bool empty() const {
        const std::lock_guard lock(latest_mutex_);
        return value_ == nullptr;
    }

    /// The result for `part`, by `make()` where the latest one is not it. `forget_first`: lets go of the latest one
    /// before making the next, so that two large ones never live at the same time.
    template <class Make>
    Shared<Value> get(const Session& part, Progress& progress, bool forget_first, Make make);

private:
    void keep(const std::optional<Session>& part, Shared<Value> value) {
        const std::lock_guard lock(latest_mutex_);
        part_ = part;
        value_.swap(value);  // the old one is destroyed after the lock is released
    }

    /// Waits until nobody else makes the result, or until the progress is cancelled.
    void begin_making(const Progress& progress) {
        std::unique_lock lock(making_mutex_);
        while (making_) {
            progress.check();
            made_.wait_for(lock, std::chrono::milliseconds(20));
        }
        making_ = true;
    }
    void end_making() {
        {
            const std::lock_guard lock(making_mutex_);
            making_ = false;
        }
        made_.notify_all();
    }

    std::mutex making_mutex_;
    std::condition_variable made_;
    bool making_ = false;
    mutable std::mutex latest_mutex_;
    std::optional<Session> part_;
    Shared<Value> value_;
};

/// What the results of all times share. Only the maker of its stage touches it.
template <class Value>
class AtAnyTime {
public:
    /// What was left for `part` at whatever time; empty where the latest was for another part.
    Value& of(Session part) {
        part.time_s = 0.0;
        if (part_ != part) value_ = {};
        part_ = std::move(part);
        return value_;
    }

private:
    std::optional<Session> part_;
    Value value_{};
};

/// Called after each refinement pass over a region with the picture so far (RenderRequest::on_region).
using OnRegion = std::function<void(const RenderResult& so_far, PixelRect changed)>;

/// A request with what it must not outlive, but for the surfaces and lights.
struct PictureRequest {
    Shared<Scene> scene;
    Shared<EnvironmentLight> environment;  ///< null where the technique is lit by lights
    Shared<std::any> samples;              ///< likewise
    RenderRequest request;
};

/// All stages of one workbench or one command. Every member may be called from any thread; each throws InputError,
/// EnvironmentError or Cancelled and then keeps what it had. Everything returned is immutable.
class Results {
public:
    /// `threads` 0: as many as the machine has; never changes a result. `automatic`: what a session that leaves the
    /// choice of backend open gets (automatic_backend()).
    Results(int threads, Backend automatic) : Results(threads, [automatic] { return automatic; }) {}
    /// `automatic` is called once, by the thread that first needs to know: asking the driver takes time.
    Results(int threads, std::function<Backend()> automatic) : threads_(threads), automatic_(std::move(automatic)) {}

    /// Where structures that take long to build are kept between runs. Set before the first use; empty: nowhere.
    std::filesystem::path cache_folder;

    Shared<SceneModel> model(const Session& session, Progress& progress);
    /// As `model`, but what was there stays until the new one is read: for a scene that is only tried.
    Shared<SceneModel> tried_model(const Session& session, Progress& progress);
    Shared<Scene> scene(const Session& session, Progress& progress);
    Shared<std::shared_ptr<const EmbreeScene>> embree(const Session& session, Progress& progress);
    Shared<SurfaceBuffer> surfaces(const Session& session, Progress& progress);
    /// None where the technique is lit by the environment.
    Shared<std::vector<Light>> lights(const Session& session, Progress& progress);
    /// Read or made, and turned. Also where the technique does not ask for it.
    Shared<EnvironmentLight> environment(const Session& session, Progress& progress);
    /// What each pixel asks of it (EnvironmentLit::samples); the technique must be lit by it.
    Shared<std::any> samples(const Session& session, Progress& progress);
    Shared<BuiltStructure> structure(const Session& session, Progress& progress);
    /// With verdicts where the session asks for the reference. `on_region` is called only where the picture is made.
    Shared<RenderResult> picture(const Session& session, Progress& progress, const OnRegion& on_region = {});
    /// `on_region` as for `picture`.
    Shared<RenderResult> reference(const Session& session, Progress& progress, const OnRegion& on_region = {});
    /// The technique's picture against the reference; the session must ask for the reference.
    Shared<ErrorMetrics> errors(const Session& session, Progress& progress);

    /// The technique's picture against that of the same structure before compression: what its visibility errors are of
    /// is what compression changed. All the same where nothing is compressed. The session must ask for the reference.
    Shared<ErrorMetrics> compression(const Session& session, Progress& progress);

    /// What is there already, without waiting: for the screen, which shows what it has while the next is being made.
    Shared<RenderResult> latest_picture(const Session& session) const;
    Shared<BuiltStructure> latest_structure(const Session& session) const;

    int threads() const { return threads_; }
    /// Where the session's technique runs.
    Backend backend(const Session& session) const;
    /// What the session asks of a technique for these surfaces, which may be of another size.
    PictureRequest request(const Session& session, const SurfaceBuffer& surfaces, const std::vector<Light>& lights,
                           Progress& progress);

private:
    Session resolved(Session session) const;
    /// At time 0 where neither the scene, once it is loaded and that is known, nor the session's lights change: what is
    /// made of them then stays as time goes on, and only what depends on the turning surroundings is made again.
    Session at_rest(Session session) const;
    /// What the structure for this scene depends on: not the time where nothing moves.
    Session structure_key(const Session& session, const Scene& scene) const;

    int threads_;
    std::function<Backend()> automatic_;
    mutable std::once_flag automatic_asked_;
    mutable Backend automatic_answer_ = Backend::cpu;
    Stage<SceneModel> model_;
    Stage<Scene> scene_;
    Stage<std::shared_ptr<const EmbreeScene>> embree_;
    AtAnyTime<std::shared_ptr<const EmbreeScene>> fixed_tree_;  ///< of what never moves
    Stage<SurfaceBuffer> surfaces_;
    Stage<std::vector<Light>> lights_;
    Stage<EnvironmentLight> surroundings_, environment_;  ///< not turned; turned
    Stage<std::any> samples_;
    Stage<BuiltStructure> structure_;
    AtAnyTime<std::any> kept_;  ///< for the structure of another time
    Stage<RenderResult> picture_, reference_;
    Stage<ErrorMetrics> errors_, compression_;
};

/// In the user's cache (XDG_CACHE_HOME); empty where SIGHTLINES_CACHE is "off".
std::filesystem::path default_cache_folder();

/// The picture that the session's surroundings are made from, not turned. InputError as read_environment.
Environment make_surroundings(const EnvironmentChoice& choice);

/// How far the surroundings are turned at the session's time, degrees in (-360, 360).
float turn_deg(const Session& session);

/// The most rays that a pixel asks: the lights, or its samples of the environment.
std::size_t rays_per_pixel(const Session& session, const std::vector<Light>& lights);

/// What the technique's picture is compared with: the same rays by the given tree.
RenderResult reference_picture(const Technique& technique, const EmbreeScene& embree, const RenderRequest& request,
                               Progress& progress);

/// The camera of the session in `scene`: the free one, else the named one, else the first.
Camera session_camera(const Session& session, const Scene& scene);

/// What `automatic` stands for on this machine: Vulkan where there is a real GPU. Asks the Vulkan driver each time.
Backend automatic_backend();

/// The session with everything at its default that a stage does not depend on: its key in the cache.
Session model_part(const Session& session);
Session scene_part(const Session& session);
Session surfaces_part(const Session& session);
Session lights_part(const Session& session);
Session environment_part(const Session& session);
Session structure_part(const Session& session);
Session picture_part(const Session& session);
Session reference_part(const Session& session);

}  // namespace sightlines
