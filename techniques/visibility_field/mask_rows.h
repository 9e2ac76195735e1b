// Octahedral masks while they are made: a 64-bit word a row, so that a whole row is dilated at once.
#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace sightlines::visibility_field {

constexpr int smallest_mask = 8, largest_mask = 64;

/// Bit `column` of word `row`: the texel. Rows and columns from the mask's size on are clear.
using MaskRows = std::array<std::uint64_t, largest_mask>;

/// Each texel set where itself or one of its eight neighbours is (Algorithm 1, lines 15 and 16). Beyond an edge of the
/// square its neighbours are the texels that touch it on the sphere: those of the same edge, mirrored.
MaskRows dilated(const MaskRows& rows, int size);

/// The mask of size x size texels of which each is set where any of its steps x steps parts is: `rows` holds the parts.
MaskRows reduced(const MaskRows& rows, int size, int steps);

/// How many texels are set.
int texels_set(const MaskRows& rows);

/// Packs the texels one after the other, row by row; `words` holds (size * size + 31) / 32 words, all of which are
/// written.
void pack(const MaskRows& rows, int size, std::span<std::uint32_t> words);

}  // namespace sightlines::visibility_field
