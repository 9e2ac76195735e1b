#include "app/desk/refining.h"

#include <algorithm>
#include <cmath>

namespace sightlines {
namespace {

constexpr auto between_pictures = std::chrono::milliseconds(80);  // each costs the window a frame
constexpr double quick_build_s = 0.5;

Session view_key(const Session& session) {
    Session key = reference_part(session);
    key.reference = false;
    key.size = {};
    key.parameters.clear();
    return key;
}

void paste(const ImageRgba8& part, PixelRect rect, ImageRgba8& whole) {
    for (int y = 0; y < rect.height; ++y) std::copy_n(&part.at(0, y), rect.width, &whole.at(rect.x, rect.y + y));
}

/// The pixels of a part, by the looks of the session.
void shade(Refining& refining, const RenderResult& so_far, PixelRect rect) {
    const bool of_reference = refining.technique != nullptr;
    const ChannelSource from{of_reference ? refining.technique : &so_far, of_reference ? &so_far : nullptr, nullptr,
                             refining.lights};
    paste(shown_channel(refining.session.channel, refining.session.display, from, rect), rect, refining.pixels);
}

/// Takes the newest looks over; true where they have changed.
bool take_looks(Refining& refining) {
    {
        const std::lock_guard lock(refining.objects.mutex);
        if (!refining.objects.wanted || refining.objects.wanted->number == refining.looks_number) return false;
        refining.looks_number = refining.objects.wanted->number;
    }
    Session newest = with_newest_looks(refining.objects, refining.session);
    const bool changed = newest.display != refining.session.display || newest.channel != refining.session.channel;
    refining.session = std::move(newest);
    return changed;
}

}  // namespace

bool view_is_shown(Background::Objects& objects, const Session& session) {
    std::shared_ptr<const PictureShown> picture;
    {
        const std::lock_guard lock(objects.mutex);
        picture = objects.shown.picture;
    }
    return picture && view_key(picture->session) == view_key(session);
}

bool follows_quickly(const Shown& shown, const Session& session) {
    if (!shown.picture || shown.picture->state == PictureState::preview) return false;
    if (!shown.measured.build_s || *shown.measured.build_s > quick_build_s) return false;
    Session before = shown.picture->session;
    before.time_s = session.time_s;
    return view_key(before) == view_key(session) && structure_part(before) == structure_part(session);
}

Session with_newest_looks(Background::Objects& objects, const Session& session) {
    const std::lock_guard lock(objects.mutex);
    const bool same = objects.wanted && picture_key(objects.wanted->session) == picture_key(session);
    return same ? objects.wanted->session : session;
}

ImageRgba8 resized(const ImageRgba8& picture, ImageSize size) {
    if (picture.size == size) return picture;
    struct Tap {
        int before, after, share;  // of `after`, in 256ths
    };
    const auto taps = [](int from, int to) {
        std::vector<Tap> all(static_cast<std::size_t>(to));
        for (int i = 0; i < to; ++i) {
            const float at = std::max(
                0.0f, (static_cast<float>(i) + 0.5f) * static_cast<float>(from) / static_cast<float>(to) - 0.5f);
            const int before = std::min(static_cast<int>(at), from - 1);
            all[static_cast<std::size_t>(i)] = {before, std::min(before + 1, from - 1),
                                                static_cast<int>(256.0f * (at - static_cast<float>(before)))};
        }
        return all;
    };
    const std::vector<Tap> across = taps(picture.size.width, size.width), down = taps(picture.size.height, size.height);
    const auto mixed = [](glm::ivec4 a, glm::ivec4 b, int share) { return a * (256 - share) + b * share; };
    ImageRgba8 out(size);
    for (int y = 0; y < size.height; ++y) {
        const Tap row = down[static_cast<std::size_t>(y)];
        for (int x = 0; x < size.width; ++x) {
            const Tap column = across[static_cast<std::size_t>(x)];
            const auto along = [&](int source_y) {
                return mixed(glm::ivec4(picture.at(column.before, source_y)),
                             glm::ivec4(picture.at(column.after, source_y)), column.share);
            };
            out.at(x, y) = glm::u8vec4(mixed(along(row.before), along(row.after), row.share) / 65536);
        }
    }
    return out;
}

ImageRgba8 pixels_of(const Session& session, const ChannelSource& from) {
    const ImageSize size = from.picture->radiance.size;
    return shown_channel(session.channel, session.display, from, {0, 0, size.width, size.height});
}

void put_out_picture(Background::Objects& objects, ImageRgba8 pixels, const Session& session, PictureState state,
                     const PictureShown* in_place_of) {
    auto picture = std::make_shared<PictureShown>(PictureShown{std::move(pixels), session, state, 0});
    put_out(objects, [&](Shown& shown) {
        if (in_place_of != nullptr && shown.picture.get() != in_place_of) return;
        picture->number = shown.picture ? shown.picture->number + 1 : 1;
        replace_shown<PictureShown>(objects, shown.picture, std::move(picture));
    });
}

Refining start_refining(Background::Objects& objects, const Session& session, std::size_t lights) {
    Refining refining{objects, session, lights};
    refining.missing = session.size.pixels();
    if (!view_is_shown(objects, session)) {
        refining.pixels = ImageRgba8(session.size);
        return refining;
    }
    std::shared_ptr<const PictureShown> begin;
    {
        const std::lock_guard lock(objects.mutex);
        begin = objects.shown.picture;
    }
    refining.pixels = resized(begin->pixels, session.size);
    if (begin->session.channel == session.channel) refining.missing = 0;
    return refining;
}

void refine(Refining& refining, const RenderResult& so_far, PixelRect changed) {
    if (take_looks(refining))
        shade(refining, so_far, {0, 0, refining.pixels.size.width, refining.pixels.size.height});
    else
        shade(refining, so_far, changed);
    const std::size_t come = static_cast<std::size_t>(changed.width) * static_cast<std::size_t>(changed.height);
    refining.missing -= std::min(refining.missing, come);
    if (refining.missing > 0 || Clock::now() - refining.put_out_at < between_pictures) return;
    put_out_picture(refining.objects, refining.pixels, refining.session, PictureState::refining);
    refining.put_out_at = Clock::now();
}

}  // namespace sightlines
