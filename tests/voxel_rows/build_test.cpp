// Both builds against naive ones.
#include <algorithm>
#include <bit>
#include <cstring>

#include <gtest/gtest.h>

#include "techniques/scene/surface_fragments.h"
#include "techniques/voxel_rows/query.h"
#include "techniques/voxel_rows/row_array.h"
#include "techniques/voxel_rows/slice_bits.h"
#include "techniques/voxel_rows/voxel_rows.h"
#include "tests/voxel_rows/scenes.h"

namespace sightlines::voxel_rows {
namespace {

BuildOptions small_build(int resolution = 48) {
    BuildOptions options;
    options.resolution = resolution;
    options.angle_step_deg = 6.0;
    options.threads = 2;
    return options;
}

std::size_t set_bits(std::span<const std::uint32_t> words) {
    std::size_t count = 0;
    for (const std::uint32_t word : words) count += static_cast<std::size_t>(std::popcount(word));
    return count;
}

std::size_t different_bits(std::span<const std::uint32_t> a, std::span<const std::uint32_t> b) {
    std::size_t count = 0;
    for (std::size_t k = 0; k < a.size(); ++k) count += static_cast<std::size_t>(std::popcount(a[k] ^ b[k]));
    return count;
}

/// Algorithm 6 word for word: every fragment into every direction by the frame alone, bit by bit.
std::vector<std::uint32_t> splat_naively(const RowArray& like, std::span<const Fragment> fragments) {
    const RowShape shape = make_shape(like.grid);
    std::vector<std::uint32_t> words(like.words.words.size());
    for (const Fragment& fragment : fragments) {
        for (int theta = 0; theta < shape.angles; ++theta) {
            for (int phi = 0; phi < shape.angles; ++phi) {
                const DirectionFrame& frame = like.grid.frames[static_cast<std::size_t>(theta * shape.angles + phi)];
                const vec3 at = voxel_coordinates(shape, frame, fragment.position);
                const int u = scalar_kernel::voxel_index(shape, at.x);
                const std::size_t row =
                    scalar_kernel::row_index(shape, {theta, phi}, scalar_kernel::voxel_index(shape, at.y),
                                             scalar_kernel::voxel_index(shape, at.z));
                words[row * static_cast<std::size_t>(shape.words_per_row) + static_cast<std::size_t>(u / 32)] |=
                    1u << (u % 32);
            }
        }
    }
    return words;
}

TEST(VoxelRowsBuild, VoxelisesOneDirectionByItselfAsTheWholeBuildDoes) {
    const Scene scene = testing::scattered_triangles(60, 1);
    BuildOptions options = small_build();
    options.angle_step_deg = 30.0;
    Progress progress;
    const RowArray whole = build_from_fragments(scene, options, progress);
    const RowArray direct = build_directly(scene, options, progress);
    for (int direction = 0; direction < whole.grid.angles * whole.grid.angles; ++direction) {
        EXPECT_EQ(voxelize_from_fragments(scene, options, direction, progress), unpack_voxelization(whole, direction));
        EXPECT_EQ(voxelize_directly(scene, options, direction), unpack_voxelization(direct, direction));
    }
}

TEST(VoxelRowsBuild, SplatsEachFragmentIntoItsVoxelOfEveryDirection) {
    const Scene scene = testing::scattered_triangles(60, 1);
    for (const int resolution : {32, 48, 64, 100}) {
        BuildOptions options = small_build(resolution);
        options.coverage = 0.0;
        Progress progress;
        const RowArray array = build_from_fragments(scene, options, progress);
        const std::vector<Fragment> fragments =
            surface_fragments(scene, fragment_grid(array.grid, options.samples_per_voxel), 1, progress);
        ASSERT_EQ(fragments.size(), array.fragments);
        const std::vector<std::uint32_t> naive = splat_naively(array, fragments);
        const std::size_t all = set_bits(naive);
        ASSERT_GT(all, 100000u);
        // The fast way rounds coordinates in the plane of theta; a fragment on a voxel's face may fall on its other
        // side.
        EXPECT_LT(different_bits(array.words.words, naive), all / 20000) << "resolution " << resolution;
    }
}

TEST(VoxelRowsBuild, GivesTheSameArrayWithOneThreadAndWithTwo) {
    const Scene scene = testing::scattered_triangles(200, 2);
    BuildOptions options = small_build();
    Progress progress;
    const RowArray two = build_from_fragments(scene, options, progress);
    options.threads = 1;
    const RowArray one = build_from_fragments(scene, options, progress);
    EXPECT_EQ(different_bits(one.words.words, two.words.words), 0u);
}

/// Set voxels of a that have no set voxel of b among their 27 neighbours.
std::size_t lonely_voxels(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b, int n) {
    std::size_t lonely = 0;
    const auto at = [n](int u, int v, int w) { return (static_cast<std::size_t>(w) * n + v) * n + u; };
    for (int w = 0; w < n; ++w)
        for (int v = 0; v < n; ++v)
            for (int u = 0; u < n; ++u) {
                if (a[at(u, v, w)] == 0) continue;
                bool near = false;
                for (int k = std::max(0, w - 1); k <= std::min(n - 1, w + 1); ++k)
                    for (int j = std::max(0, v - 1); j <= std::min(n - 1, v + 1); ++j)
                        for (int i = std::max(0, u - 1); i <= std::min(n - 1, u + 1); ++i) near |= b[at(i, j, k)] != 0;
                lonely += !near;
            }
    return lonely;
}

TEST(VoxelRowsBuild, AgreesWithTheDirectBuildToTheNeighbouringVoxel) {
    const Scene scene = testing::scattered_triangles(60, 3);
    Progress progress;
    BuildOptions any_fragment = small_build();
    any_fragment.coverage = 0.0;
    const RowArray fast = build_from_fragments(scene, any_fragment, progress);
    const RowArray direct = build_directly(scene, small_build(), progress);
    for (int direction = 0; direction < 900; direction += 37) {
        const auto a = unpack_voxelization(fast, direction), b = unpack_voxelization(direct, direction);
        EXPECT_EQ(lonely_voxels(b, a, 48), 0u) << "direction " << direction;
        // The fragments reach into sharp corners that hold no pixel centre of the direct build.
        const auto set = static_cast<std::size_t>(std::count(a.begin(), a.end(), 1));
        EXPECT_LT(lonely_voxels(a, b, 48), set / 10) << "direction " << direction;
    }
}

TEST(VoxelRowsBuild, SetsFewerVoxelsTheMoreOfThemMustBeCovered) {
    const Scene scene = testing::scattered_triangles(200, 2);
    std::size_t before = ~std::size_t{0};
    for (const double coverage : {0.0, 0.7, 1.0}) {
        BuildOptions options = small_build();
        options.coverage = coverage;
        Progress progress;
        const std::size_t set = set_bits(build_from_fragments(scene, options, progress).words.words);
        EXPECT_GT(set, 0u);
        EXPECT_LT(set, before);
        before = set;
    }
}

TEST(VoxelRowsBuild, LeavesNoHoleInAWallSeenFromAnyDirection) {
    const Scene scene = testing::wall_in_a_box(4.0f);
    Progress progress;
    for (const bool direct : {false, true}) {
        const RowArray array = direct ? build_directly(scene, small_build(), progress)
                                      : build_from_fragments(scene, small_build(), progress);
        for (std::uint32_t k = 0; k < 20000; ++k) {
            // From one side of the wall to the other, through its middle part, as far from it as the voxels are wide.
            const vec3 from(-1.9f, 1.4f * random_unit(9, k, 0) - 0.7f, 1.4f * random_unit(9, k, 1) - 0.7f);
            const vec3 to(1.9f, 1.4f * random_unit(9, k, 2) - 0.7f, 1.4f * random_unit(9, k, 3) - 0.7f);
            TraceRequest request;
            request.position = from;
            request.normal = vec3(1.0f, 0.0f, 0.0f);
            request.light.position = to;
            ASSERT_TRUE(serve(array, request).blocked) << "direct " << direct << ", ray " << k;
        }
    }
}

TEST(VoxelRowsBuild, KeepsAWallThatHasNoThicknessAlongAnAxis) {
    for (int thin = 0; thin < 3; ++thin) {
        Scene scene;
        const auto corner = [thin](float a, float b) {
            vec3 point(0.0f);
            point[(thin + 1) % 3] = a;
            point[(thin + 2) % 3] = b;
            return point;
        };
        testing::add_triangle(scene, corner(-2, -2), corner(2, -2), corner(2, 2));
        testing::add_triangle(scene, corner(-2, -2), corner(2, 2), corner(-2, 2));
        const Scene wall = testing::finished(scene);
        Progress progress;
        const RowArray array = build_from_fragments(wall, small_build(), progress);
        for (int direction = 0; direction < 900; direction += 7) {
            const auto occupied = unpack_voxelization(array, direction);
            EXPECT_NE(std::count(occupied.begin(), occupied.end(), 1), 0) << "thin " << thin << ' ' << direction;
        }
    }
}

TEST(VoxelRowsBuild, StopsWhenCancelled) {
    Progress progress;
    progress.cancel();
    EXPECT_THROW(build_from_fragments(testing::scattered_triangles(10, 4), small_build(), progress), Cancelled);
}

TEST(VoxelRowsBuild, SaysHowMuchMemoryIsMissing) {
    BuildOptions options = small_build(256);
    options.angle_step_deg = 1.0;  // 68 GB
    if (available_memory_bytes() > std::uint64_t{70} << 30u) GTEST_SKIP() << "this machine has the memory";
    Progress progress;
    EXPECT_THROW(build_from_fragments(testing::scattered_triangles(10, 4), options, progress), EnvironmentError);
}

TEST(VoxelRowsBuild, MakesAClearArrayOfASceneWithoutTriangles) {
    Progress progress;
    const Scene empty = testing::finished({});
    const RowArray array = build_from_fragments(empty, small_build(32), progress);
    EXPECT_EQ(set_bits(array.words.words), 0u);
}

/// A wall of 2.7 m in a box of 4 m, across `normal`, its middle at `centre`.
Scene wall_across(vec3 normal, vec3 centre, bool double_sided) {
    Scene scene;
    const vec3 other = std::abs(normal.y) < 0.9f ? vec3(0, 1, 0) : vec3(1, 0, 0);
    const vec3 a = 1.35f * glm::normalize(glm::cross(normal, other)), b = glm::cross(normal, a);
    testing::add_triangle(scene, centre - a - b, centre + a - b, centre + a + b);
    testing::add_triangle(scene, centre - a - b, centre + a + b, centre - a + b);
    scene.bounds.add(vec3(-2.0f));
    scene.bounds.add(vec3(2.0f));
    scene = testing::finished(scene);
    scene.materials[0].double_sided = double_sided;
    return scene;
}

/// Rays that a wall lets pass, of `count` through its middle, at up to 75 degrees from its normal.
int leaks(const RowArray& array, vec3 normal, vec3 centre, std::uint32_t count, int& asked) {
    const RowShape query = make_query(array, {}, {});
    int leaking = 0;
    for (std::uint32_t k = 0; k < count; ++k) {
        const vec3 direction = sphere_direction(random_unit(31, k, 0), random_unit(31, k, 1));
        if (std::abs(glm::dot(direction, normal)) < 0.26f) continue;
        const vec3 off = 0.4f * sphere_direction(random_unit(32, k, 0), random_unit(32, k, 1));
        const vec3 through = centre + off - glm::dot(off, normal) * normal;
        const Segment ray{through - (0.6f + 0.5f * random_unit(33, k, 0)) * direction,
                          through + (0.6f + 0.5f * random_unit(33, k, 1)) * direction};
        leaking += !is_blocked(array, query, ray, vec3(0.0f));
        ++asked;
    }
    return leaking;
}

TEST(VoxelRowsBuild, LeavesNoHoleInAWallWhereverItStraddlesTheVoxels) {
    Progress progress;
    int asked = 0;
    for (std::uint32_t k = 0; k < 24; ++k) {  // a voxel is 83 mm wide: offsets of all parts of one
        vec3 normal(0.0f), centre(0.0f);
        normal[static_cast<int>(k % 3)] = 1.0f;
        centre[static_cast<int>(k % 3)] = 0.0104f * static_cast<float>(k);
        const RowArray array = build_from_fragments(wall_across(normal, centre, k % 2 == 0), small_build(), progress);
        EXPECT_EQ(leaks(array, normal, centre, 4000, asked), 0) << "wall " << k;
    }
    EXPECT_GT(asked, 60000);
}

TEST(VoxelRowsBuild, LeavesNoHoleInAWallTiltedAnyWay) {
    Progress progress;
    int asked = 0;
    for (std::uint32_t k = 0; k < 36; ++k) {  // a third of them by up to 10 degrees only
        vec3 normal = sphere_direction(random_unit(34, k, 0), random_unit(34, k, 1));
        if (k % 3 == 0) normal = glm::normalize(vec3(1, 0, 0) + 0.17f * random_unit(34, k, 5) * normal);
        const vec3 centre = 0.2f * vec3(random_unit(34, k, 2), random_unit(34, k, 3), random_unit(34, k, 4));
        const RowArray array = build_from_fragments(wall_across(normal, centre, k % 2 == 0), small_build(), progress);
        EXPECT_EQ(leaks(array, normal, centre, 4000, asked), 0) << "wall " << k;
    }
    EXPECT_GT(asked, 90000);
}

TEST(SliceBits, SetsWhatHoldsEnoughAloneOrWithAnEmptierNeighbourAndTransposes) {
    for (const int n : {32, 64, 100, 128, 256}) {
        SliceBits along_u(n), along_w(n), transposed(n);
        SliceCounts filled(n);
        std::uint64_t sum = 0;
        for (int w = 0; w < n; ++w) {
            for (int u = 0; u < n; ++u) {
                const std::uint32_t value = random_u32(3, static_cast<std::uint32_t>(w * n + u), 0) % 256u;
                filled.bytes[static_cast<std::size_t>(filled.place_of(u, w))] = static_cast<std::uint8_t>(value);
                sum += value;
            }
        }
        const auto at = [&](int u, int w) {
            const bool inside = u >= 0 && w >= 0 && u < n && w < n;
            return inside ? int{filled.bytes[static_cast<std::size_t>(filled.place_of(u, w))]} : 0;
        };
        const auto is_set = [&](const SliceBits& bits, int u, int w) {
            return (bits.words[static_cast<std::size_t>(u / 64 * bits.side + w)] >> (u % 64) & 1u) != 0;
        };
        for (const Needed needed : {Needed{1, 1}, Needed{100, 40}, Needed{40, 100}, Needed{255, 255}}) {
            SliceCounts counts = filled;
            EXPECT_EQ(take_bits(counts, needed, along_u, along_w), sum);
            EXPECT_EQ(std::ranges::count(counts.bytes, 0), static_cast<std::ptrdiff_t>(counts.bytes.size()));
            transpose(along_w, transposed);
            for (int w = 0; w < n; ++w) {
                for (int u = 0; u < n; ++u) {
                    const int own = at(u, w);
                    const auto expected = [&](int neighbour, int least) {
                        return own >= least || (own > 0 && own >= neighbour && own + neighbour >= least);
                    };
                    ASSERT_EQ(is_set(along_u, u, w), expected(std::max(at(u - 1, w), at(u + 1, w)), needed.along_u));
                    ASSERT_EQ(is_set(along_w, u, w), expected(std::max(at(u, w - 1), at(u, w + 1)), needed.along_w));
                    ASSERT_EQ(is_set(transposed, w, u), is_set(along_w, u, w));
                }
            }
        }
    }
}

TEST(SliceBits, AreStoredWholeWithNothingBehindTheirVoxels) {
    for (const int n : {32, 64, 100, 128, 160, 192, 256}) {
        RowArray array;
        array.grid = make_grid(Box3{vec3(0.0f), vec3(1.0f)}, n, 90.0);
        const auto length = static_cast<std::size_t>(array.grid.words_per_row);
        array.words = allocate_huge(array.grid.rows() * length);
        std::ranges::fill(array.words.words, 0xffffffffu);
        const RowShape shape = make_shape(array.grid);
        SliceBits bits(n);
        for (std::size_t k = 0; k < bits.words.size(); ++k)
            bits.words[k] = std::uint64_t{random_u32(9, static_cast<std::uint32_t>(k), 0)} << (k % 32u);
        store_slice(array, shape, 1, 5, bits);
        finish_storing();
        for (int w = 0; w < n; ++w) {
            const auto row = row_words(array, scalar_kernel::row_index(shape, {0, 1}, 5, w));
            for (std::size_t word = 0; word < length; ++word) {
                const auto block = static_cast<int>(word / 2);
                const std::uint64_t stored =
                    64 * block < bits.side ? bits.words[static_cast<std::size_t>(block * bits.side + w)] : 0;
                ASSERT_EQ(row[word], static_cast<std::uint32_t>(stored >> (32 * (word % 2)))) << n << ' ' << w;
            }
        }
    }
}

}  // namespace
}  // namespace sightlines::voxel_rows
