// The dictionary (Wang 2017, Algorithm 2) against the paper's own words, and queries through it.
#include "techniques/voxel_rows/dictionary.h"

#include <algorithm>
#include <map>
#include <ranges>

#include <gtest/gtest.h>

#include "techniques/base/error.h"
#include "techniques/voxel_rows/dictionary_search.h"
#include "techniques/voxel_rows/query.h"
#include "techniques/voxel_rows/row_deals.h"
#include "techniques/voxel_rows/voxel_rows.h"
#include "tests/voxel_rows/scenes.h"

namespace sightlines::voxel_rows {
namespace {

using Row = std::vector<std::uint32_t>;

RowArray small_array(int resolution, double angle_step_deg = 22.5) {
    BuildOptions options;
    options.resolution = resolution;
    options.angle_step_deg = angle_step_deg;
    Progress progress;
    return build_from_fragments(testing::scattered_triangles(150, 5), options, progress);
}

DictionaryOptions as_in_the_paper(std::uint32_t rows) {
    return {.rows = rows, .choice = DictionaryChoice::frequent, .leftovers = Leftovers::random};
}

RowArray compressed(const RowArray& array, const DictionaryOptions& options) {
    Progress progress;
    return compress(array, options, progress);
}

/// The places of all rows but padding.
std::vector<std::uint32_t> real_rows(const RowGrid& grid) {
    const RowShape shape = make_shape(grid);
    std::vector<std::uint32_t> rows;
    for (int theta = 0; theta < grid.angles; ++theta)
        for (int phi = 0; phi < grid.angles; ++phi)
            for (int v = 0; v < grid.resolution; ++v)
                for (int w = 0; w < grid.resolution; ++w)
                    rows.push_back(scalar_kernel::row_index(shape, {theta, phi}, v, w));
    return rows;
}

Row row_of(const RowArray& array, std::uint32_t row) {
    const auto words = row_words(array, row);
    return {words.begin(), words.end()};
}

std::map<Row, std::uint32_t> naive_histogram(const RowArray& array) {
    std::map<Row, std::uint32_t> histogram;
    for (const std::uint32_t row : real_rows(array.grid)) ++histogram[row_of(array, row)];
    return histogram;
}

/// One bit for each 2^step bits, set iff any of these is.
std::vector<bool> naively_simplified(const Row& row, int step) {
    std::vector<bool> bits(32 * row.size() >> static_cast<unsigned>(step));
    for (std::size_t u = 0; u < 32 * row.size(); ++u)
        if (row[u / 32] >> (u % 32) & 1u) bits[u >> static_cast<unsigned>(step)] = true;
    return bits;
}

struct NaiveDictionary {
    std::vector<Row> rows;                  ///< D
    std::map<Row, std::uint32_t> index_of;  ///< V'
    std::vector<std::uint64_t> rows_mapped;
    std::uint64_t left_over = 0;
};

/// Algorithm 2 line by line.
NaiveDictionary naive_dictionary(const RowArray& array, const DictionaryOptions& options) {
    const std::map<Row, std::uint32_t> histogram = naive_histogram(array);
    NaiveDictionary naive;
    for (const auto& [row, count] : histogram) naive.rows.push_back(row);
    std::ranges::sort(naive.rows, [&](const Row& a, const Row& b) {
        if (histogram.at(a) != histogram.at(b)) return histogram.at(a) > histogram.at(b);
        return row_hash(a) < row_hash(b);
    });
    naive.rows.resize(std::min<std::size_t>(naive.rows.size(), options.rows));
    naive.rows_mapped.resize(static_cast<std::size_t>(options.steps));
    for (int step = 0; step < options.steps; ++step) {
        std::map<std::vector<bool>, std::uint32_t> simplified;
        for (std::uint32_t j = 0; j < naive.rows.size(); ++j)
            simplified.try_emplace(naively_simplified(naive.rows[j], step), j);
        for (const auto& [row, count] : histogram) {
            const auto found = simplified.find(naively_simplified(row, step));
            if (naive.index_of.contains(row) || found == simplified.end()) continue;
            naive.index_of[row] = found->second;
            naive.rows_mapped[static_cast<std::size_t>(step)] += count;
        }
    }
    for (const auto& [row, count] : histogram) {
        if (naive.index_of.contains(row)) continue;
        const std::uint64_t hash = row_hash(row);
        naive.index_of[row] =
            random_u32(options.seed, static_cast<std::uint32_t>(hash >> 32u), static_cast<std::uint32_t>(hash)) %
            static_cast<std::uint32_t>(naive.rows.size());
        naive.left_over += count;
    }
    return naive;
}

class Dictionary : public ::testing::TestWithParam<int> {};

TEST_P(Dictionary, IsTheOneOfThePaperWordForWord) {
    const RowArray array = small_array(GetParam());
    for (const std::uint32_t rows : {40u, 1000u}) {
        DictionaryOptions options = as_in_the_paper(rows);
        options.seed = 77;
        const RowArray made = compressed(array, options);
        const NaiveDictionary naive = naive_dictionary(array, options);
        ASSERT_EQ(made.dictionary.rows, naive.rows.size());
        EXPECT_EQ(made.dictionary.rows_mapped, naive.rows_mapped);
        EXPECT_EQ(made.dictionary.rows_left_over, naive.left_over);
        EXPECT_GT(naive.rows_mapped[3] + naive.left_over, 0u);
        for (const std::uint32_t row : real_rows(array.grid)) {
            const std::uint32_t index = naive.index_of.at(row_of(array, row));
            ASSERT_EQ(dictionary_entry(made, row).index, index) << row;
            ASSERT_EQ(row_of(made, row), naive.rows[index]) << row;
        }
    }
}

TEST_P(Dictionary, LosesNothingWhereItHoldsEveryRow) {
    const RowArray array = small_array(GetParam());
    const RowArray made = compressed(array, {.rows = 4'000'000});
    EXPECT_EQ(made.dictionary.rows, made.dictionary.distinct_rows);
    EXPECT_EQ(made.dictionary.differing_share, 0.0);
    for (const std::uint32_t row : real_rows(array.grid)) ASSERT_EQ(row_of(made, row), row_of(array, row));
}

TEST_P(Dictionary, IsTheSameWithOneThreadAndWithTwo) {
    const RowArray array = small_array(GetParam());
    const RowArray one = compressed(array, {.rows = 500, .threads = 1});
    const RowArray two = compressed(array, {.rows = 500, .threads = 2});
    EXPECT_TRUE(std::ranges::equal(one.words.words, two.words.words));
    EXPECT_EQ(one.dictionary.frequencies, two.dictionary.frequencies);
    EXPECT_EQ(one.dictionary.rows_mapped, two.dictionary.rows_mapped);
    EXPECT_EQ(one.dictionary.differing_share, two.dictionary.differing_share);
}

TEST_P(Dictionary, AnswersAlikeByTheScalarAndTheWideKernelAndWithAnyIndexBits) {
    const Scene scene = testing::scattered_triangles(150, 5);
    const RowArray array = small_array(GetParam());
    const RowArray packed = compressed(array, {.rows = 700}), plain = compressed(array, {.rows = 700, .packed = false});
    ASSERT_EQ(packed.dictionary.index_bits, 20);
    ASSERT_EQ(plain.dictionary.index_bits, 32);
    EXPECT_LT(packed.words.bytes(), plain.words.bytes());
    constexpr std::uint32_t count = 100'003;
    std::vector<Segment> segments(count);
    std::vector<vec3> normals(count);
    for (std::uint32_t k = 0; k < count; ++k) {
        segments[k] = {testing::random_point(scene.bounds, 14, k), testing::random_point(scene.bounds, 15, k)};
        normals[k] = sphere_direction(random_unit(16, k, 0), random_unit(16, k, 1));
    }
    for (const double subrays : {1.0, 2.0}) {
        std::uint32_t blocked = 0;
        for (const RowArray* made : {&packed, &plain}) {
            const RowShape query = make_query(*made, {{"subrays", subrays}}, {});
            std::vector<std::uint8_t> wide(count);
            are_blocked(*made, query, segments, normals, wide);
            for (std::uint32_t k = 0; k < count; ++k) {
                ASSERT_EQ(wide[k] != 0, is_blocked(*made, query, segments[k], normals[k])) << k;
                blocked += wide[k];
            }
        }
        EXPECT_EQ(blocked % 2, 0u) << "20 and 32 bits";
        EXPECT_GT(blocked, count / 5);
        EXPECT_LT(blocked, 2 * count - count / 5);
    }
    for (std::uint32_t row = 0; row < array.grid.rows(); ++row)
        ASSERT_EQ(dictionary_entry(packed, row).index, dictionary_entry(plain, row).index);
}

TEST_P(Dictionary, FindsARowNoFurtherAwayThanThePapers) {
    const RowArray array = small_array(GetParam());
    for (const int steps : {1, 3, 6}) {
        DictionaryOptions options{.rows = 300, .steps = steps, .leftovers = Leftovers::random};
        const RowArray random = compressed(array, options);
        options.leftovers = Leftovers::nearest;
        const RowArray nearest = compressed(array, options);
        EXPECT_EQ(random.dictionary.rows_mapped, nearest.dictionary.rows_mapped);
        EXPECT_LT(nearest.dictionary.differing_share, random.dictionary.differing_share);
        for (const std::uint32_t row : real_rows(array.grid)) {
            const Row bits = row_of(array, row);
            ASSERT_LE(differing_lights(bits, row_of(nearest, row), GetParam()),
                      differing_lights(bits, row_of(random, row), GetParam()));
        }
    }
}

INSTANTIATE_TEST_SUITE_P(RowLengths, Dictionary, ::testing::Values(32, 50, 100, 150));

TEST(DictionaryChoice, CoversMoreRowsThanTheMostFrequentOnesDo) {
    const RowArray array = small_array(64);
    DictionaryOptions options{.rows = 2000};
    const RowArray covering = compressed(array, options);
    options.choice = DictionaryChoice::frequent;
    const RowArray frequent = compressed(array, options);
    EXPECT_GT(frequent.dictionary.rows_mapped[0], covering.dictionary.rows_mapped[0]);
    EXPECT_LT(covering.dictionary.differing_share, 0.9 * frequent.dictionary.differing_share);
}

TEST(DictionaryEntries, TellHowOftenTheirRowOccurredAndComeMostFrequentFirst) {
    const RowArray array = small_array(40);
    const RowArray made = compressed(array, {.rows = 200});
    const std::map<Row, std::uint32_t> histogram = naive_histogram(array);
    EXPECT_EQ(made.dictionary.distinct_rows, histogram.size());
    EXPECT_TRUE(std::ranges::is_sorted(made.dictionary.frequencies, std::ranges::greater()));
    for (const std::uint32_t row : real_rows(array.grid))
        ASSERT_EQ(dictionary_entry(made, row).frequency, histogram.at(row_of(made, row)));
}

TEST(DictionaryEntries, MatchTheirRowsAtTheStepThatIsCounted) {
    const RowArray array = small_array(48);
    const RowArray made = compressed(array, as_in_the_paper(150));
    std::vector<std::uint64_t> rows_of_step(5);
    for (const std::uint32_t row : real_rows(array.grid)) {
        // A random row may match down-sampled by chance only where a step would have found one.
        ++rows_of_step[static_cast<std::size_t>(mapping_step(row_words(array, row), row_words(made, row), 4))];
    }
    EXPECT_EQ(rows_of_step[4], made.dictionary.rows_left_over);
    rows_of_step.pop_back();
    EXPECT_EQ(rows_of_step, made.dictionary.rows_mapped);
}

TEST(RowHistogram, CountsAsAMapDoesWhateverTheParts) {
    const RowArray array = small_array(150);
    const std::map<Row, std::uint32_t> naive = naive_histogram(array);
    for (const std::size_t rows_per_part : {std::size_t{64}, std::size_t{3000}, std::size_t{1} << 16u}) {
        Progress progress;
        const auto histogram = count_rows<8>(array, 2, progress, rows_per_part);
        EXPECT_EQ(histogram.distinct, naive.size());
        std::map<std::uint32_t, Row> row_of_id;
        for (const auto& part : histogram.parts) {
            for (std::uint32_t k = 0; k < part.size(); ++k) {
                const auto bits = part[k];
                const Row row(bits.words.begin(), bits.words.end());
                ASSERT_EQ(part.counts[k], naive.at(row));
                ASSERT_TRUE(row_of_id.emplace(part.first_id + k, row).second);
            }
        }
        for (const std::uint32_t row : real_rows(array.grid))
            ASSERT_EQ(row_of_id.at(histogram.id_of_row.words[row]), row_of(array, row));
    }
}

TEST(DictionaryMeasure, CountsTheLightsThatTheOtherRowAnswersDifferentlyFromSurfaces) {
    for (std::uint32_t k = 0; k < 3000; ++k) {
        const int resolution = 33 + static_cast<int>(random_u32(1, k, 0) % 60u);
        Row a(resolution <= 64 ? 2 : 4), b(a.size());
        for (int u = 0; u < resolution; ++u) {
            const auto bit = static_cast<std::uint32_t>(u);
            if (random_unit(2, k, bit) < 0.15f) a[bit / 32] |= 1u << (bit % 32);
            if (random_unit(3, k, bit) < 0.1f) b[bit / 32] |= 1u << (bit % 32);
        }
        const auto set = [](const Row& row, int u) {
            return (row[static_cast<std::size_t>(u) / 32] >> (u % 32) & 1u) != 0;
        };
        std::uint32_t differing = 0;
        for (int u = 0; u < resolution; ++u) {
            for (const int way : {1, -1}) {
                // u: where a ray starts, one or two voxels beyond a set one.
                const auto set_behind = [&](int far) {
                    const int behind = u - far * way;
                    return behind >= 0 && behind < resolution && set(a, behind);
                };
                if (set(a, u) || !(set_behind(1) || set_behind(2))) continue;
                bool blocked_a = false, blocked_b = false;
                std::uint32_t far = 0;
                for (int end = u; end >= 0 && end < resolution; end += way, ++far) {
                    blocked_a |= set(a, end);
                    blocked_b |= set(b, end);
                    if (blocked_a != blocked_b) differing += (far + 1) * (far + 1) * (far + 1) - far * far * far;
                }
            }
        }
        ASSERT_EQ(differing_lights(a, b, resolution), differing) << "row " << k;
        ASSERT_EQ(differing_lights(a, a, resolution), 0u);
    }
}

std::vector<RowBits<8>> random_rows(std::uint32_t count) {
    std::vector<RowBits<8>> rows(count);
    for (std::uint32_t k = 0; k < count; ++k)
        for (std::uint32_t bit = 0; bit < 200; ++bit)
            if (random_unit(5, k, bit) < 0.05f) rows[k].words[bit / 32] |= 1u << (bit % 32);
    return rows;
}

TEST(DictionaryMeasure, IsTheSameForManyRowsAtOnce) {
    const std::vector<RowBits<8>> rows = random_rows(300);
    Progress progress;
    const SortedRows<8> sorted = sort_rows(rows, 200, 0, 1, progress);
    for (std::uint32_t k = 0; k < rows.size(); k += 3) {
        RowBits<8> row = rows[k];
        row.words[k % 6] ^= 1u << (k % 32);
        const RowProbes<8> probes(row, 200);
        for (std::uint32_t first = 0; first < rows.size(); first += 37) {
            const Range range{first, std::min(50u, static_cast<std::uint32_t>(rows.size()) - first)};
            Match expected{0, farthest};
            for (std::uint32_t j = range.first; j < range.first + range.count; ++j) {
                const RowBits<8>& other = sorted.rows[j];
                const Distance distance{differing_lights(probes, other), differing_voxels(row, other)};
                if (distance < expected.distance) expected = {j, distance};
            }
            const Match found = nearest_in(sorted, range, row, probes, {0, farthest});
            ASSERT_EQ(found.place, expected.place);
            ASSERT_EQ(found.distance, expected.distance);
        }
    }
}

TEST(DictionarySearch, FindsEveryRowAndAllThatMatchItDownSampled) {
    std::vector<RowBits<8>> rows = random_rows(300);
    for (std::uint32_t k = 0; k < 300; ++k) {  // alike after every step; then after the second
        rows.push_back(rows[k]);
        rows.back().words[0] ^= 2;
    }
    Progress progress;
    for (const int shift : {0, 4}) {
        const SortedRows<8> sorted = sort_rows(rows, 200, shift, 2, progress);
        const Range all{0, static_cast<std::uint32_t>(rows.size())};
        for (std::uint32_t k = 0; k < rows.size(); ++k) {
            const std::uint32_t place = place_among(sorted, all, rows[k]);
            ASSERT_LT(place, rows.size());
            ASSERT_EQ(sorted.rows[place], rows[k]);
            RowBits<8> other = rows[k];  // one that is not there
            other.words[3] ^= 1u << (k % 32);
            for (int step = 1; step <= coarsest_step; ++step) {
                const auto matching = find_matching(sorted, other, place_among(sorted, all, other), step);
                const auto matches = [&](const RowBits<8>& row, int after) {
                    return simplify(shifted(row, shift), after) == simplify(shifted(other, shift), after);
                };
                int first = step;
                while (first <= coarsest_step &&
                       std::ranges::none_of(rows, [&](const auto& row) { return matches(row, first); }))
                    ++first;
                ASSERT_EQ(matching ? matching->step : coarsest_step + 1, first);
                if (!matching) continue;
                const auto best = std::ranges::find_if(rows, [&](const auto& row) { return matches(row, first); });
                const Group& group = group_of(sorted, *matching, step);
                ASSERT_EQ(sorted.index[group.best], static_cast<std::uint32_t>(best - rows.begin()));
                ASSERT_EQ(group.range.count,
                          std::ranges::count_if(rows, [&](const auto& row) { return matches(row, first); }));
            }
        }
    }
}

TEST(RowDeals, HoldEveryDistinctRowOnceInTheOrderOfTheirPrefixesAndAreDealtAgainInPlace) {
    std::array<Row, 3> bits, counts;
    for (std::uint32_t k = 0; k < 100'000; ++k) {
        for (const std::uint32_t word : {random_u32(7, k, 0), 0u, random_u32(7, k, 1) & random_u32(7, k, 2), k})
            bits[k % 3].push_back(word);
        counts[k % 3].push_back(k % 5);
    }
    std::vector<DistinctRows<4>> parts;
    for (std::size_t part = 0; part < 3; ++part) {
        const std::uint32_t first_id =
            part == 0 ? 0 : parts.back().first_id + static_cast<std::uint32_t>(parts.back().size());
        parts.push_back({first_id, bits[part], counts[part]});
    }
    Progress progress;
    RowDeals<4> dealt = deal_rows(parts, 2, progress);
    EXPECT_GT(dealt.deals(), 2u);
    const auto expect_in_order = [](const RowDeals<4>& deals, int shift) {
        for (std::size_t deal = 0; deal < deals.deals(); ++deal) {
            for (std::size_t place = deals.first[deal]; place < deals.first[deal + 1]; ++place) {
                const std::uint64_t prefix = coarse_prefix(shifted(deals[place].row, shift));
                ASSERT_GE(prefix, deal > 0 ? deals.cuts[deal - 1] : 0);
                ASSERT_LT(prefix, deal < deals.cuts.size() ? deals.cuts[deal] : ~std::uint64_t{0});
            }
        }
    };
    std::vector<bool> seen(100'000);
    for (std::size_t place = 0; place < dealt.rows(); ++place) {
        const DealtRow<4> row = dealt[place];
        const std::uint32_t k = row.row.words[3];
        ASSERT_FALSE(seen[k]);
        seen[k] = true;
        ASSERT_EQ(row.row, parts[k % 3][k / 3]);
        ASSERT_EQ(row.count, k % 5);
        ASSERT_EQ(row.id, parts[k % 3].first_id + k / 3);
        dealt.distance(place) = k % 2 + 1;
    }
    ASSERT_EQ(dealt.rows(), seen.size());
    expect_in_order(dealt, 0);
    const void* const memory = dealt.memory.data();
    for (const std::uint32_t every : {2u, 4u, 8u}) {  // at the end of the memory, at its beginning, at its end
        dealt = deal_again(std::move(dealt), 4, 2u, 2, progress);
        EXPECT_EQ(dealt.memory.data(), memory);
        ASSERT_EQ(dealt.rows(), 100'000u / every);
        std::vector<bool> seen_again(100'000);
        for (std::size_t place = 0; place < dealt.rows(); ++place) {
            ASSERT_EQ(dealt[place].distance, 2u);
            const std::uint32_t k = dealt[place].row.words[3];
            ASSERT_EQ(k % every, every - 1);
            ASSERT_EQ(dealt[place].row, parts[k % 3][k / 3]);
            ASSERT_FALSE(seen_again[k]);
            seen_again[k] = true;
            dealt.distance(place) = k % (2 * every) == 2 * every - 1 ? 2 : 1;
        }
        expect_in_order(dealt, 4);
    }
}

TEST(DictionaryBuild, StopsWhenCancelled) {
    const RowArray array = small_array(32);
    Progress progress;
    progress.cancel();
    EXPECT_THROW(compress(array, {}, progress), Cancelled);
}

TEST(DictionaryBuild, TakesNoRowOfPaddingForOneOfTheScene) {
    BuildOptions options;
    options.resolution = 33;  // padded to 40
    options.angle_step_deg = 45.0;
    Progress progress;
    RowArray array = allocate_array(testing::wall_in_a_box(2.0f), options);
    std::ranges::fill(array.words.words, 0x70000000u);
    for (const std::uint32_t row : real_rows(array.grid)) {
        array.words.words[2 * row] = 1u + row % 3u;
        array.words.words[2 * row + 1] = 0;
    }
    const RowArray made = compressed(array, {});
    EXPECT_EQ(made.dictionary.rows, 3u);
    std::uint64_t rows = 0;
    for (const std::uint32_t frequency : made.dictionary.frequencies) rows += frequency;
    EXPECT_EQ(rows, real_rows(array.grid).size());
}

TEST(CompressedVoxelRows, RenderAsTheScalarKernelAnswers) {
    const Scene scene = testing::scattered_triangles(150, 7);
    BuildRequest build;
    build.scene = &scene;
    build.parameters = {{"compression", 1.0}, {"dictionary_rows", 5000.0}, {"angle_step", 6.0}, {"resolution", 64.0}};
    Progress progress;
    const Structure structure = technique().build(build, progress);
    const RowArray& array = row_array(structure);
    ASSERT_EQ(array.dictionary.rows, 5000u);
    SurfaceBuffer surfaces;
    surfaces.size = {50, 30};
    for (std::uint32_t k = 0; k < surfaces.size.pixels(); ++k) {
        surfaces.position.push_back(testing::random_point(scene.bounds, 11, k));
        surfaces.normal.push_back(sphere_direction(random_unit(12, k, 0), random_unit(12, k, 1)));
        surfaces.triangle.push_back(k % 9 == 0 ? no_triangle : 0);
    }
    surfaces.shading_normal = surfaces.normal;
    surfaces.albedo.resize(surfaces.position.size(), vec3(0.5f));
    surfaces.emission.resize(surfaces.position.size(), vec3(0.0f));
    std::vector<Light> lights(41);
    for (std::uint32_t k = 0; k < lights.size(); ++k) lights[k].position = testing::random_point(scene.bounds, 13, k);
    RenderRequest request;
    request.surfaces = &surfaces;
    request.lights = lights;
    request.keep_verdicts = true;
    const RenderResult result = technique().render(structure, request, progress);
    const RowShape query = make_query(array, {}, lights);
    std::uint64_t blocked = 0;
    for (std::size_t pixel = 0; pixel < surfaces.position.size(); ++pixel) {
        for (std::uint32_t light = 0; light < lights.size(); ++light) {
            const Segment ray{surfaces.position[pixel], lights[light].position};
            const bool in_front = surfaces.triangle[pixel] != no_triangle &&
                                  glm::dot(surfaces.normal[pixel], ray.target - ray.origin) > 0.0f;
            const bool expected = in_front && is_blocked(array, query, ray, surfaces.normal[pixel]);
            ASSERT_EQ(result.verdicts.blocked(pixel, light), expected) << pixel << ' ' << light;
            blocked += expected;
        }
    }
    EXPECT_GT(blocked, 5000u);
    EXPECT_EQ(count_blocked(structure, request).blocked, blocked);
}

TEST(CompressedVoxelRows, TellTheirSizesAndWhereTheRowsWent) {
    const Scene scene = testing::scattered_triangles(100, 7);
    BuildRequest build;
    build.scene = &scene;
    build.parameters = {{"compression", 1.0}, {"dictionary_rows", 2000.0}, {"angle_step", 6.0}};
    Progress progress;
    const Statistics statistics = technique().statistics(technique().build(build, progress));
    EXPECT_EQ(statistics.uncompressed_bytes, 900u * 128u * 128u * 16u);
    EXPECT_NEAR(static_cast<double>(statistics.structure_bytes), 900.0 * 128 * 128 * 2.5 + 2000 * 16, 100.0);
    EXPECT_GT(statistics.compress_seconds, 0.0);
    double rows = 0.0;
    for (const Statistic& value : statistics.values)
        if (value.name.starts_with("rows mapped") || value.name == "rows in the dictionary" ||
            value.name == "rows left over")
            rows += value.value;
    EXPECT_EQ(rows, 900.0 * 128 * 128);
}

}  // namespace
}  // namespace sightlines::voxel_rows
