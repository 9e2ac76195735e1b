// The heavy work behind the window: two threads of lower priority, each making what the newest session asks for.
// The window never waits for them; it shows what they have put out so far.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/results.h"
#include "app/selection.h"
#include "visualizers/inside_view.h"

namespace sightlines {

/// Something that is being made now.
struct Work {
    std::string title;             ///< the stage in words: "voxelising directions"
    double fraction = 0.0;         ///< in [0, 1]
    double elapsed_s = 0.0;        ///< of this stage
    std::optional<double> left_s;  ///< of this stage, once it can be estimated
};

/// How far the picture is.
enum class PictureState {
    preview,   ///< ray traced, small, a few of the lights with the brightness of all: until the structure is there
    draft,     ///< the technique's own, at a part of the size: while a mouse drags
    refining,  ///< coarse blocks, becoming finer
    complete,
};

/// What the image pane shows. Immutable once put out; a newer one replaces it. Until the reference is there, a channel
/// that compares with it shows the lit picture, as `refining`.
struct PictureShown {
    ImageRgba8 pixels;  ///< a draft or preview is smaller than session.size
    Session session;    ///< that it was made for; what no picture depends on (the selection) may be older
    PictureState state = PictureState::preview;
    std::uint64_t number = 0;  ///< grows with every one put out
};

/// The figures of the status line; those that are not known (yet) are empty.
struct Measured {
    std::optional<double> load_s, build_s, render_s;
    std::optional<double> rays_per_second;
    std::optional<double> visibility_percent, shadow_percent;
    std::uint64_t structure_bytes = 0;
    std::string device;  ///< "CPU, 2 threads, AVX3"
};

/// Why something could not be made, and for which session.
struct Failure {
    std::string message;
    Session session;
    bool environment = false;  ///< no memory, no device: not the session's fault
};

/// Everything that the threads have put out. Cheap to copy; a null pointer means: nothing yet. Hold a copy for a frame
/// and no longer: what it points to may be gigabytes, and whoever lets go last waits for them to be freed.
struct Shown {
    std::shared_ptr<const PictureShown> picture;
    Shared<Scene> scene;      ///< of the latest session whose scene could be loaded
    double duration_s = 0.0;  ///< of that scene's movement; 0: nothing moves
    Shared<std::vector<Light>> lights;
    Shared<BuiltStructure> structure;  ///< null while another is built: there is memory for one
    Shared<RenderResult> result;       ///< the latest complete picture's
    Shared<ErrorMetrics> errors;
    Measured measured;
    std::shared_ptr<const PixelRays> rays;                ///< of the selected pixel
    std::shared_ptr<const SelectedRay> ray;               ///< the selected one, recorded
    std::shared_ptr<const InsidePicture> inside;          ///< what the view inside shows for it
    std::optional<Failure> picture_failure, ray_failure;  ///< of the latest session; cleared by the next that works
    std::vector<Work> work;                               ///< under way, the picture's first
    bool cancelled = false;    ///< the user stopped the picture; goes on with the next change
    std::uint64_t number = 0;  ///< grows with every change of anything here
};

/// A scene that is tried before the session takes it, so that one that cannot be read leaves what was there.
struct SceneTrial {
    std::string scene;
    std::optional<std::string> failure;  ///< empty: it can be read
};

struct Background {
    struct Objects;
    std::unique_ptr<Objects> objects;

    /// `changed` is called, from those threads, whenever `shown` has something new. `results` must outlive this.
    Background(Results& results, std::function<void()> changed);
    /// Cancels what is under way and waits for the threads: at most as long as a cancel takes (200 ms).
    ~Background();
    Background(Background&&) noexcept;
    Background& operator=(Background&&) noexcept;
};

/// From now on the threads make what this session shows: only what depends on the difference to the last one is made
/// again, and what is under way for another is cancelled. `dragging`: a mouse is changing it continuously, so drafts
/// do.
void want(Background& background, const Session& session, bool dragging);
/// Stops the picture that is being made, or the scene that is being tried. The next change of the session that asks for
/// another picture starts it again; so does `resume`.
void cancel(Background& background);
void resume(Background& background);
/// Tries to load a scene (a built-in's name or a file) on the threads; `take_trial` gives the outcome, once.
void try_scene(Background& background, const std::string& scene);
std::optional<SceneTrial> take_trial(Background& background);

Shown shown(const Background& background);

}  // namespace sightlines
