#include "app/desk/inside_thread.h"

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <new>
#include <optional>
#include <thread>
#include <utility>

#include "app/desk/thread_priority.h"
#include "techniques/base/error.h"

namespace sightlines {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int niceness = 3;  ///< after the window, before the pictures that are made in the background
constexpr int fast_samples = 1, sharp_samples = 2;
constexpr auto still = std::chrono::milliseconds(150);  ///< without a new request: the mouse rests

/// Whether only the marks differ, so that the sharp solid part need not be drawn again.
bool only_marks_differ(const InsideRequest& a, const InsideRequest& b) {
    return a.state == b.state && a.size == b.size && (a.picture == b.picture || same_solid(*a.picture, *b.picture));
}

/// What is drawn next.
struct Drawing {
    InsideRequest request;
    int samples = sharp_samples;
};

}  // namespace

struct InsideThread::Objects {
    const std::function<void()> changed;

    mutable std::mutex mutex;  ///< of what follows; never held while drawing
    std::condition_variable wake;
    bool closing = false;
    std::optional<InsideRequest> wanted;
    Clock::time_point wanted_at{};
    bool moving = false;  ///< requests follow each other as a mouse moves
    std::shared_ptr<const InsideShown> shown;
    std::string failure;
    std::thread thread;

    explicit Objects(std::function<void()> changed_) : changed(std::move(changed_)) {
        thread = std::thread([this] { run(); });
    }
    Objects(const Objects&) = delete;
    Objects& operator=(const Objects&) = delete;
    ~Objects() {
        {
            const std::lock_guard lock(mutex);
            closing = true;
        }
        wake.notify_all();
        thread.join();
    }

    void run() {
        lower_priority(niceness);
        try {
            InsideView view;
            std::optional<Drawing> drawn;
            while (const std::optional<Drawing> next = wait_for_next(drawn)) {
                draw_one(view, *next);
                drawn = next;
            }
        } catch (const EnvironmentError& error) {
            fail(error.what());
        } catch (const std::bad_alloc&) {
            fail("There is not enough memory to draw the view inside.");
        }
    }

    /// Fast first where something moves; sharp once it rests.
    std::optional<Drawing> wait_for_next(const std::optional<Drawing>& drawn) {
        std::unique_lock lock(mutex);
        for (;;) {
            if (closing) return std::nullopt;
            if (wanted && (!drawn || !(drawn->request == *wanted))) {
                const bool quick =
                    drawn && drawn->samples == sharp_samples && only_marks_differ(drawn->request, *wanted);
                return Drawing{*wanted, quick ? sharp_samples : fast_samples};
            }
            if (!wanted || drawn->samples == sharp_samples) {
                wake.wait(lock);
                continue;
            }
            const Clock::time_point rest = wanted_at + still;
            if (!moving || Clock::now() >= rest) return Drawing{*wanted, sharp_samples};
            wake.wait_until(lock, rest);
        }
    }

    void draw_one(InsideView& view, const Drawing& drawing) {
        const InsideRequest& request = drawing.request;
        const Clock::time_point start = Clock::now();
        ImageRgba8 pixels = render(view, *request.picture, request.state, request.lit, request.size, drawing.samples,
                                   request.text_scale);
        const std::chrono::duration<double> seconds = Clock::now() - start;
        auto done = std::make_shared<const InsideShown>(
            InsideShown{request, std::move(pixels),
                        shown_camera(*request.picture, request.state, request.size, request.text_scale),
                        drawing.samples, seconds.count()});
        {
            const std::lock_guard lock(mutex);
            shown.swap(done);
        }
        changed();
    }

    void fail(const std::string& message) {
        {
            const std::lock_guard lock(mutex);
            failure = message;
        }
        changed();
    }
};

InsideThread::InsideThread(std::function<void()> changed) : objects(std::make_unique<Objects>(std::move(changed))) {}
InsideThread::~InsideThread() = default;
InsideThread::InsideThread(InsideThread&&) noexcept = default;
InsideThread& InsideThread::operator=(InsideThread&&) noexcept = default;

void draw(InsideThread& thread, const InsideRequest& request) {
    if (!request.picture || request.size.width < 1 || request.size.height < 1) return;
    InsideThread::Objects& objects = *thread.objects;
    {
        const std::lock_guard lock(objects.mutex);
        if (objects.wanted == request) return;
        const Clock::time_point now = Clock::now();
        objects.moving = now - objects.wanted_at < still;
        objects.wanted_at = now;
        objects.wanted = request;
    }
    objects.wake.notify_all();
}

std::shared_ptr<const InsideShown> shown(const InsideThread& thread) {
    const std::lock_guard lock(thread.objects->mutex);
    return thread.objects->shown;
}

std::string failure(const InsideThread& thread) {
    const std::lock_guard lock(thread.objects->mutex);
    return thread.objects->failure;
}

}  // namespace sightlines
