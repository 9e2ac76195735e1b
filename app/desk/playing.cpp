#include "app/desk/playing.h"

#include "techniques/scene/animation.h"

namespace sightlines {

double played_time_s(const Playing& playing, const Session& session, const Shown& shown,
                     std::chrono::steady_clock::time_point now) {
    const auto& picture = shown.picture;
    // After a preview the next moment would end the building of this one's structure, again and again.
    const bool seen = picture && picture->state != PictureState::preview && picture->session.scene == session.scene &&
                      picture->session.time_s == session.time_s;
    if (!seen && !shown.picture_failure) return session.time_s;
    const std::chrono::duration<double> played = now - playing.since;
    return looped_time_s(playing.from_s + played.count(), shown.duration_s);
}

}  // namespace sightlines
