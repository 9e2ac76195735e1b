// The colours of views and figures. Set and clear, ray and row differ in hue and lightness for every kind of colour
// vision (after Okabe and Ito 2008), and never by colour alone.
#pragma once

#include "techniques/base/types.h"
#include "visualizers/view_state.h"

namespace sightlines {

/// sRGB in [0, 1].
struct Palette {
    vec3 page, ink, muted, hairline;    ///< background, text, secondary text, thin rules
    vec3 ghost, voxel, section;         ///< scene mesh, voxel faces, faces made by cutting
    vec3 set_bit, set_bit_clipped;      ///< a set voxel of the row inside and outside the extent
    vec3 clear_bit, clear_bit_clipped;  ///< a clear one's frame
    vec3 ray, twin, extent, light;      ///< ray, row direction, [s, e], the light's disc
    vec3 pointed;                       ///< what the step touches, and what is pointed at
};

inline vec3 srgb(unsigned hex) {
    return vec3(static_cast<float>(hex >> 16 & 255u), static_cast<float>(hex >> 8 & 255u),
                static_cast<float>(hex & 255u)) /
           255.0f;
}

inline Palette palette(Theme theme) {
    if (theme == Theme::dark)
        return {.page = srgb(0x14171C),
                .ink = srgb(0xEEF1F5),
                .muted = srgb(0x9AA4B2),
                .hairline = srgb(0x39424F),
                .ghost = srgb(0x333C49),
                .voxel = srgb(0x5F7189),
                .section = srgb(0x8597AE),
                .set_bit = srgb(0xFF8A3D),
                .set_bit_clipped = srgb(0xA87650),
                .clear_bit = srgb(0xF3D9C4),
                .clear_bit_clipped = srgb(0x7C8797),
                .ray = srgb(0x58B7FF),
                .twin = srgb(0xF2E27A),
                .extent = srgb(0xEEF1F5),
                .light = srgb(0xFFD95A),
                .pointed = srgb(0xFF7AC6)};
    return {.page = theme == Theme::print ? srgb(0xFFFFFF) : srgb(0xFAFAF8),
            .ink = srgb(0x1B1F24),
            .muted = srgb(0x5B6470),
            .hairline = srgb(0xCDD2D8),
            .ghost = srgb(0xF1F2F4),
            .voxel = srgb(0xC3CEDB),
            .section = srgb(0x8D9DB1),
            .set_bit = srgb(0xE8590C),
            .set_bit_clipped = srgb(0xE3AE88),
            .clear_bit = srgb(0x8A3C0A),
            .clear_bit_clipped = srgb(0x9AA2AD),
            .ray = srgb(0x0067B8),
            .twin = srgb(0x007A5A),
            .extent = srgb(0x1B1F24),
            .light = srgb(0xF2B705),
            .pointed = srgb(0xC2187A)};
}

}  // namespace sightlines
