// The bake against plain loops, its options, its limits.
#include "techniques/visibility_field/bake.h"

#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>
#include <set>

#include <gtest/gtest.h>

#include "shaders/hemisphere.h"
#include "shaders/octahedral.h"
#include "techniques/base/error.h"
#include "techniques/rays/open_rays.h"
#include "techniques/scene/builtin_scenes.h"
#include "techniques/visibility_field/casting.h"
#include "techniques/visibility_field/dense_field.h"
#include "techniques/visibility_field/moving_bake.h"
#include "tests/visibility_field/scenes.h"

namespace sightlines::visibility_field {
namespace {

namespace kernel = scalar_kernel;

struct Prepared {
    Scene scene = testing::courtyard();
    std::shared_ptr<const EmbreeScene> embree = test::built(scene);
    Progress progress;
};

/// Algorithm 1, lines 5 to 28, as written: a mask of truths for each point, dilated by looking at each texel's
/// neighbours, then merged.
struct NaiveMask {
    int size;
    std::vector<bool> set = std::vector<bool>(static_cast<std::size_t>(size * size));

    std::size_t at(int column, int row) const {
        if (row < 0 || row >= size) {
            row = std::clamp(row, 0, size - 1);
            column = size - 1 - column;
        }
        if (column < 0 || column >= size) {
            column = std::clamp(column, 0, size - 1);
            row = size - 1 - row;
        }
        return static_cast<std::size_t>(row * size + column);
    }
    NaiveMask dilated() const {
        NaiveMask result{size};
        for (int row = 0; row < size; ++row)
            for (int column = 0; column < size; ++column)
                for (int y = -1; y <= 1; ++y)
                    for (int x = -1; x <= 1; ++x)
                        if (set[at(column + x, row + y)]) result.set[at(column, row)] = true;
        return result;
    }
    void merge(const NaiveMask& other) {
        for (std::size_t k = 0; k < set.size(); ++k) set[k] = set[k] || other.set[k];
    }
};

struct NaivePair {
    NaiveMask visible, occluded;
};

NaivePair cast_plainly(const EmbreeScene& embree, const SurfacePoint& point, const RaySet& set, int size,
                       std::uint64_t seed) {
    NaivePair masks{{size}, {size}};
    const std::uint32_t stream = ray_stream(point);
    const float turn = 2.0f * std::numbers::pi_v<float> * random_unit(seed, stream, 0);
    const kernel::HemisphereFrame frame = kernel::frame_about(point.normal, std::cos(turn), std::sin(turn));
    for (int k = 0; k < set.rays; ++k) {
        const auto ray = static_cast<std::size_t>(k);
        float height = set.height[ray] + random_unit(seed, stream, 1);
        if (height >= 1.0f) height -= 1.0f;
        const float radius = std::sqrt(std::max(0.0f, fused(-height, height, 1.0f)));
        const vec3 direction = kernel::direction_in(frame, radius * set.cosine[ray], radius * set.sine[ray], height);
        const kernel::OctahedralTexel texel = kernel::octahedral_texel(kernel::octahedral_place(direction), size);
        const bool blocked = is_blocked(embree, lifted_off(embree, point.position, point.normal), direction);
        NaiveMask& mask = blocked ? masks.occluded : masks.visible;
        mask.set[mask.at(texel.column, texel.row)] = true;
    }
    return {masks.visible.dilated(), masks.occluded.dilated()};
}

class Bake : public ::testing::TestWithParam<int> {};

TEST_P(Bake, GivesTheMasksOfPlainLoopsBitForBit) {
    Prepared prepared;
    BakeOptions options = testing::small_bake();
    options.mask_size = GetParam();
    options.points = 800;
    options.probes = 0;
    options.dilation = 1.0f;
    const VisibilityField field = testing::baked(prepared.scene, *prepared.embree, options);
    const CellPoints points = place_points(prepared.scene, field.shape, options, prepared.progress);
    const RaySet set = make_ray_set(options.rays);
    ASSERT_EQ(field.cells, points.cells.size());
    int labels = 0;
    const std::vector<OccupiedCell> cells = occupied_cells(field);
    for (std::uint32_t cell = 0; cell < field.cells; ++cell) {
        ASSERT_EQ(cell_number(field.shape, cells[cell].place), points.cells[cell]);
        NaivePair merged{{options.mask_size}, {options.mask_size}};
        for (std::uint32_t k = points.first[cell]; k < points.first[cell + 1]; ++k) {
            const NaivePair one =
                cast_plainly(*prepared.embree, points.points[k], set, options.mask_size, options.seed ^ casting_seed);
            merged.visible.merge(one.visible);
            merged.occluded.merge(one.occluded);
        }
        int visible = 0, occluded = 0;
        for (int row = 0; row < options.mask_size; ++row) {
            for (int column = 0; column < options.mask_size; ++column) {
                const bool seen = merged.visible.set[merged.visible.at(column, row)];
                const bool hidden = merged.occluded.set[merged.occluded.at(column, row)];
                ASSERT_EQ(mask_bit(mask_words(field, cell, 0), options.mask_size, column, row), seen);
                ASSERT_EQ(mask_bit(mask_words(field, cell, 1), options.mask_size, column, row), hidden);
                visible += seen;
                occluded += hidden;
            }
        }
        ASSERT_EQ(cells[cell].label, occluded > visible ? 1u : 0u);
        ASSERT_NEAR(occlusion_ratio(field, cell), static_cast<double>(occluded) / (GetParam() * GetParam()), 1e-12);
        labels += static_cast<int>(cells[cell].label);
    }
    EXPECT_GT(labels, 5);
    EXPECT_LT(labels, static_cast<int>(field.cells) - 5);
}

INSTANTIATE_TEST_SUITE_P(Sizes, Bake, ::testing::Values(8, 18, 33, 64));

TEST(BakeLabels, FollowEquationEightWhereAsked) {
    Prepared prepared;
    BakeOptions options = testing::small_bake();
    options.label = LabelRule::texels;
    const VisibilityField field = testing::baked(prepared.scene, *prepared.embree, options);
    for (const OccupiedCell& cell : occupied_cells(field))
        ASSERT_EQ(cell.label, occlusion_ratio(field, cell.index) > 0.5 ? 1u : 0u);
}

TEST(BakeDilation, ByMoreSetsMore) {
    Prepared prepared;
    BakeOptions options = testing::small_bake();
    options.probes = 0;
    std::vector<int> set;
    for (const float dilation : {0.0f, 1.0f / 3.0f, 1.0f, 2.0f}) {
        options.dilation = dilation;
        const VisibilityField field = testing::baked(prepared.scene, *prepared.embree, options);
        int bits = 0;
        for (std::uint32_t cell = 0; cell < field.cells; ++cell)
            for (const int which : {0, 1})
                for (const std::uint32_t word : mask_words(field, cell, which)) bits += std::popcount(word);
        set.push_back(bits);
    }
    EXPECT_LT(set[0], set[1]);
    EXPECT_LT(set[1], set[2]);
    EXPECT_LT(set[2], set[3]);
}

TEST(BakeResult, IsTheSameOnAnyNumberOfThreads) {
    Prepared prepared;
    BakeOptions options = testing::small_bake();
    options.threads = 1;
    const VisibilityField one = testing::baked(prepared.scene, *prepared.embree, options);
    options.threads = 2;
    const VisibilityField two = testing::baked(prepared.scene, *prepared.embree, options);
    EXPECT_EQ(one.masks, two.masks);
    EXPECT_EQ(one.mask_numbers, two.mask_numbers);
    options.seed = 5;
    EXPECT_NE(testing::baked(prepared.scene, *prepared.embree, options).masks, two.masks);
}

TEST(BakeResult, HoldsEachMaskOnce) {
    Prepared prepared;
    const VisibilityField field = testing::baked(prepared.scene, *prepared.embree, testing::small_bake());
    std::set<std::vector<std::uint32_t>> masks;
    for (std::size_t start = 0; start + spare_words < field.masks.size(); start += 11)
        masks.insert(std::vector(&field.masks[start], &field.masks[start] + 11));
    EXPECT_EQ(masks.size() * 11 + spare_words, field.masks.size());
    EXPECT_EQ(field.mask_numbers.size(), 2u * field.cells);
    EXPECT_LT(masks.size(), 2u * field.cells);
}

TEST(BakeResult, OfAPlaneUnderTheSkySeesAllOfTheUpperHalf) {
    Scene scene = testing::one_sided_scene();
    test::add_quad(scene, {-2.0f, 0.0f, -2.0f}, {0.0f, 0.0f, 4.0f}, {4.0f, 0.0f, 0.0f});
    const auto embree = test::built(scene);
    BakeOptions options = testing::small_bake();
    options.dilation = 0.0f;
    options.rays = 512;
    const VisibilityField field = testing::baked(scene, *embree, options);
    EXPECT_EQ(field.cells, 64u);
    for (const OccupiedCell& cell : occupied_cells(field)) {
        EXPECT_EQ(cell.label, 0u);
        EXPECT_EQ(occlusion_ratio(field, cell.index), 0.0);
        for (int row = 0; row < 18; ++row) {
            for (int column = 0; column < 18; ++column) {
                // Of the square, the diamond in the middle is up; texels on its rim are partly so.
                const double out = std::fabs((2 * column + 1) / 18.0 - 1.0) + std::fabs((2 * row + 1) / 18.0 - 1.0);
                const bool seen = mask_bit(mask_words(field, cell.index, 0), 18, column, row);
                EXPECT_TRUE(seen || out > 0.99) << column << " " << row;
                EXPECT_FALSE(seen && out > 1.12) << column << " " << row;
            }
        }
    }
}

TEST(BakeSteps, OfACellMergeToItsMasks) {
    Prepared prepared;
    BakeOptions options = testing::small_bake();
    options.probes = 0;
    options.dilation = 0.0f;
    CellPoints points;
    const VisibilityField field = bake(prepared.scene, *prepared.embree, options, prepared.progress, &points);
    const OccupiedCell cell = occupied_cells(field)[field.cells / 2];
    const auto steps_of = [&](ivec3 place) {
        return bake_steps(samples_in(field.shape, place, points, nullptr), *prepared.embree, options);
    };
    const CellSteps steps = steps_of(cell.place);
    ASSERT_FALSE(steps.visible.empty());
    ASSERT_EQ(steps.visible.size(), steps.points.points.size());
    for (std::size_t word = 0; word < 11; ++word) {
        std::uint32_t visible = 0, occluded = 0;
        for (const auto& each : steps.visible) visible |= each[word];
        for (const auto& each : steps.occluded) occluded |= each[word];
        EXPECT_EQ(visible, mask_words(field, cell.index, 0)[word]);
        EXPECT_EQ(occluded, mask_words(field, cell.index, 1)[word]);
    }
    EXPECT_TRUE(steps_of({4, 5, 4}).visible.empty());
}

TEST(BakeLimits, RefuseOptionsOutOfRange) {
    Prepared prepared;
    const auto refusal = [&](auto change) {
        BakeOptions options = testing::small_bake();
        change(options);
        try {
            testing::baked(prepared.scene, *prepared.embree, options);
        } catch (const InputError& error) {
            return std::string(error.what());
        }
        return std::string("accepted");
    };
    EXPECT_NE(refusal([](BakeOptions& o) { o.cell_m = 0.0f; }).find("cell size"), std::string::npos);
    EXPECT_NE(refusal([](BakeOptions& o) { o.cell_m = std::nanf(""); }).find("cell size"), std::string::npos);
    EXPECT_NE(refusal([](BakeOptions& o) { o.mask_size = 7; }).find("mask size"), std::string::npos);
    EXPECT_NE(refusal([](BakeOptions& o) { o.mask_size = 65; }).find("mask size"), std::string::npos);
    EXPECT_NE(refusal([](BakeOptions& o) { o.rays = 0; }).find("rays per sample"), std::string::npos);
    EXPECT_NE(refusal([](BakeOptions& o) { o.probes = -1; }).find("probes"), std::string::npos);
    EXPECT_NE(refusal([](BakeOptions& o) { o.dilation = 3.0f; }).find("dilation"), std::string::npos);
    EXPECT_EQ(refusal([](BakeOptions&) {}), "accepted");
}

TEST(BakeLimits, RefuseMoreMemoryThanThereIsBeforeTakingAny) {
    Prepared prepared;
    BakeOptions options = testing::small_bake();
    options.cell_m = 1e-5f;
    EXPECT_THROW(testing::baked(prepared.scene, *prepared.embree, options), EnvironmentError);
}

TEST(BakeLimits, StopWhenCancelled) {
    Prepared prepared;
    prepared.progress.cancel();
    EXPECT_THROW(bake(prepared.scene, *prepared.embree, testing::small_bake(), prepared.progress), Cancelled);
}

TEST(BakeLimits, NoSurfaceAndNoSamplesGiveAFieldThatHoldsNothing) {
    const Scene empty = test::scene_with_material();
    EXPECT_EQ(testing::baked(empty, *test::built(empty), testing::small_bake()).cells, 0u);
    Prepared prepared;
    BakeOptions options = testing::small_bake();
    options.points = 0;
    const VisibilityField field = testing::baked(prepared.scene, *prepared.embree, options);
    EXPECT_EQ(field.cells, 0u);
    EXPECT_TRUE(occupied_cells(field).empty());
}

TEST(BakeLimits, ScenesOfAnyScaleHaveMasks) {
    for (const float scale : {1e-5f, 1.0f, 1e4f}) {
        Scene scene = testing::courtyard();
        scene.bounds = {};
        for (vec3& position : scene.positions) {
            position *= scale;
            scene.bounds.add(position);
        }
        BakeOptions options = testing::small_bake();
        options.cell_m = std::max(0.5f * scale, 1e-6f);
        const VisibilityField field = testing::baked(scene, *test::built(scene), options);
        EXPECT_GT(field.cells, 300u) << scale;
        std::size_t labelled = 0;
        for (const OccupiedCell& cell : occupied_cells(field)) labelled += cell.label;
        EXPECT_GT(labelled, 20u) << scale;
        EXPECT_LT(labelled, field.cells - 20u) << scale;
    }
}

TEST(BakeSponza, TakesATwentiethOfThePapersLayout) {
    const std::filesystem::path file = std::string(SIGHTLINES_SHARED_FOLDER) + "/scenes/sponza_crytek.glb";
    if (!std::filesystem::exists(file)) GTEST_SKIP() << "no " << file.filename();
    Progress progress;
    const Scene scene = find_scene(file.string(), progress).at(0.0);
    BakeOptions options;
    options.points = 500'000;
    const VisibilityField field = testing::baked(scene, *test::built(scene, EmbreeUse::benchmark), options);
    EXPECT_GT(field.cells, 15'000u);
    EXPECT_LT(field.bytes(), 2'400u * 1024u);
    EXPECT_LT(field.bytes(), dense_bytes(field.shape) / 20);
}

TEST(DenseField, HoldsTheSameBitsInThePapersLayout) {
    Prepared prepared;
    const VisibilityField field = testing::baked(prepared.scene, *prepared.embree, testing::small_bake());
    const DenseField dense = to_dense(field);
    EXPECT_EQ(dense.texels.size(), dense_bytes(field.shape));
    EXPECT_EQ(dense.texels.size(),
              static_cast<std::size_t>(field.shape.cells_x * field.shape.cells_y * field.shape.cells_z) * 20 * 20);
    std::size_t next = 0;
    const std::vector<OccupiedCell> cells = occupied_cells(field);
    std::vector<std::uint32_t> index(
        static_cast<std::size_t>(field.shape.cells_x * field.shape.cells_y * field.shape.cells_z), 0xffffffffu);
    const auto flat = [&](ivec3 place) {
        return static_cast<std::size_t>((place.z * field.shape.cells_y + place.y) * field.shape.cells_x + place.x);
    };
    for (const OccupiedCell& cell : cells) index[flat(cell.place)] = cell.index;
    for (int z = 0; z < field.shape.cells_z; ++z)
        for (int y = 0; y < field.shape.cells_y; ++y)
            for (int x = 0; x < field.shape.cells_x; ++x) {
                const DenseCell cell = dense_cell(dense, {x, y, z});
                const std::uint32_t expected = index[flat({x, y, z})];
                ASSERT_EQ(cell.occupied, expected != 0xffffffffu);
                if (!cell.occupied) continue;
                ++next;
                ASSERT_EQ(cell.label, cells[expected].label);
                ASSERT_TRUE(std::ranges::equal(cell.visible, mask_words(field, expected, 0)));
                ASSERT_TRUE(std::ranges::equal(cell.occluded, mask_words(field, expected, 1)));
            }
    EXPECT_EQ(next, field.cells);
}

TEST(DenseField, PaddingRepeatsWhatLiesBeyondTheEdge) {
    Prepared prepared;
    const VisibilityField field = testing::baked(prepared.scene, *prepared.embree, testing::small_bake());
    const DenseField dense = to_dense(field);
    for (const OccupiedCell& cell : occupied_cells(field))
        for (int k = 0; k < 18; ++k) {
            ASSERT_EQ(dense.texels[dense.place(cell.place, -1, k)], dense.texels[dense.place(cell.place, 0, 17 - k)]);
            ASSERT_EQ(dense.texels[dense.place(cell.place, k, 18)], dense.texels[dense.place(cell.place, 17 - k, 17)]);
        }
    const ImageScalar layer = dense_layer(dense, 1);
    EXPECT_EQ(layer.size, (ImageSize{20 * field.shape.cells_x, 20 * field.shape.cells_z}));
}

}  // namespace
}  // namespace sightlines::visibility_field
