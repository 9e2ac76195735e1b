#include "techniques/visibility_field/field.h"

#include <bit>
#include <cmath>

#include "shaders/visibility_field.h"

namespace sightlines::visibility_field {
namespace {

constexpr float nudge_of_cell = 1.0e-3f;  // far above rounding, far below what a cell is worth

int cells_across(float size_m, float cell_m) {
    return static_cast<int>(std::max(1.0, std::ceil(static_cast<double>(size_m) / cell_m)));
}

}  // namespace

FieldShape make_shape(const Box3& bounds, float cell_m, int mask_size) {
    FieldShape shape{};
    const vec3 size = bounds.size();
    shape.cell_m = cell_m;
    shape.cells_x = cells_across(size.x, cell_m);
    shape.cells_y = cells_across(size.y, cell_m);
    shape.cells_z = cells_across(size.z, cell_m);
    shape.bricks_x = (shape.cells_x + brick_side - 1) / brick_side;
    shape.bricks_y = (shape.cells_y + brick_side - 1) / brick_side;
    shape.origin = bounds.centre() - 0.5f * cell_m * vec3(shape.cells_x, shape.cells_y, shape.cells_z);
    shape.mask_size = mask_size;
    shape.words_per_mask = (mask_size * mask_size + 31) / 32;
    shape.nudge_m = nudge_of_cell * cell_m;
    return shape;
}

std::size_t brick_count(const FieldShape& shape) {
    const int bricks_z = (shape.cells_z + brick_side - 1) / brick_side;
    return static_cast<std::size_t>(shape.bricks_x) * static_cast<std::size_t>(shape.bricks_y) *
           static_cast<std::size_t>(bricks_z);
}

std::vector<OccupiedCell> occupied_cells(const VisibilityField& field) {
    const FieldShape& shape = field.shape;
    std::vector<OccupiedCell> cells;
    cells.reserve(field.cells);
    for (std::size_t number = 0; number < field.bricks.size(); ++number) {
        const FieldBrick& brick = field.bricks[number];
        const auto columns = static_cast<std::size_t>(shape.bricks_x), rows = static_cast<std::size_t>(shape.bricks_y);
        const ivec3 corner(brick_side * static_cast<int>(number % columns),
                           brick_side * static_cast<int>(number / columns % rows),
                           brick_side * static_cast<int>(number / columns / rows));
        const auto occupied = brick.occupied_low | std::uint64_t{brick.occupied_high} << 32u;
        const auto labels = brick.label_low | std::uint64_t{brick.label_high} << 32u;
        for (std::uint64_t left = occupied; left != 0; left &= left - 1) {
            const int bit = std::countr_zero(left);
            const ivec3 inside(bit % brick_side, bit / brick_side % brick_side, bit / (brick_side * brick_side));
            cells.push_back({corner + inside, static_cast<std::uint32_t>(cells.size()),
                             static_cast<std::uint32_t>(labels >> bit & 1u)});
        }
    }
    return cells;
}

std::span<const std::uint32_t> mask_words(const VisibilityField& field, std::uint32_t cell, int which) {
    const auto words = static_cast<std::size_t>(field.shape.words_per_mask);
    const std::size_t number = field.mask_numbers[2 * std::size_t{cell} + static_cast<std::size_t>(which)];
    return std::span(field.masks).subspan(number * words, words);
}

bool mask_bit(std::span<const std::uint32_t> words, int mask_size, int column, int row) {
    const int texel = row * mask_size + column;
    return words[static_cast<std::size_t>(texel / 32)] >> (texel % 32) & 1u;
}

double occlusion_ratio(const VisibilityField& field, std::uint32_t cell) {
    int set = 0;
    for (const std::uint32_t word : mask_words(field, cell, 1)) set += std::popcount(word);
    return static_cast<double>(set) / (field.shape.mask_size * field.shape.mask_size);
}

Box3 cell_box(const FieldShape& shape, ivec3 place) {
    const vec3 lowest = shape.origin + shape.cell_m * vec3(place);
    return {lowest, lowest + shape.cell_m};
}

}  // namespace sightlines::visibility_field
