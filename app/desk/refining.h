// The picture while it is made: regions become pixels as they come, and the whole is put out a few times a second.
// Internal to this folder.
#pragma once

#include "app/desk/lanes.h"

namespace sightlines {

/// What is kept between two regions of one picture. One call at a time.
struct Refining {
    Background::Objects& objects;
    Session session;  ///< that is made; its looks follow the newest
    std::size_t lights = 0;
    const RenderResult* technique = nullptr;  ///< the technique's own picture, where the reference is being made
    ImageRgba8 pixels{};                      ///< so far
    std::size_t missing = 0;                  ///< pixels that must come before anything is put out
    std::uint64_t looks_number = 0;           ///< of the Wanted that the looks are of
    Clock::time_point put_out_at{};
};

/// The pixels begin as what is shown of the same view (at another size, or of other parameters); where another view is
/// shown, that stays until every pixel has come.
Refining start_refining(Background::Objects& objects, const Session& session, std::size_t lights);

/// A region of the technique's picture, or of the reference's where `technique` is set.
void refine(Refining& refining, const RenderResult& so_far, PixelRect changed);

/// Whether what is shown is a picture of the same scene, camera and lights, whatever its size, technique or looks.
bool view_is_shown(Background::Objects& objects, const Session& session);

/// Whether only time has gone on since the technique's picture that is shown, and its structure took less than half a
/// second: this one's own picture is there soon, and a preview in between would flicker.
bool follows_quickly(const Shown& shown, const Session& session);

/// The session with the newest looks, selection and layout, where the window wants the same picture still.
Session with_newest_looks(Background::Objects& objects, const Session& session);

/// `in_place_of`: only where that is what is shown still; null: whatever is.
void put_out_picture(Background::Objects& objects, ImageRgba8 pixels, const Session& session, PictureState state,
                     const PictureShown* in_place_of = nullptr);

/// The whole of the session's channel.
ImageRgba8 pixels_of(const Session& session, const ChannelSource& from);

/// `picture` stretched to `size`, linearly between pixel centres.
ImageRgba8 resized(const ImageRgba8& picture, ImageSize size);

}  // namespace sightlines
