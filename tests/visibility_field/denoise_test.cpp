// The filter keeps what is not noise.
#include "techniques/visibility_field/denoise.h"

#include <cmath>

#include <gtest/gtest.h>

#include "techniques/base/random.h"

namespace sightlines::visibility_field {
namespace {

constexpr ImageSize size{40, 30};

/// Seen square on: a floor on the left, and on the right a wall that meets it, or the same floor.
SurfaceBuffer two_surfaces(bool with_wall) {
    SurfaceBuffer surfaces;
    surfaces.size = size;
    for (int y = 0; y < size.height; ++y) {
        for (int x = 0; x < size.width; ++x) {
            const bool wall = with_wall && x >= 20;
            const float along = 0.1f * static_cast<float>(x - 20);
            surfaces.position.push_back(wall ? vec3(0.0f, along, 0.1f * static_cast<float>(y))
                                             : vec3(along, 0.0f, 0.1f * static_cast<float>(y)));
            surfaces.normal.push_back(wall ? vec3(-1.0f, 0.0f, 0.0f) : vec3(0.0f, 1.0f, 0.0f));
            surfaces.triangle.push_back(y == 0 ? no_triangle : 0);
        }
    }
    surfaces.shading_normal = surfaces.normal;
    return surfaces;
}

double rmse(const ImageRgb& picture, const ImageRgb& truth) {
    double sum = 0.0;
    for (std::size_t p = static_cast<std::size_t>(size.width); p < picture.pixels.size(); ++p)
        sum += glm::dot(picture.pixels[p] - truth.pixels[p], picture.pixels[p] - truth.pixels[p]);
    return std::sqrt(sum / static_cast<double>(3 * picture.pixels.size()));
}

ImageRgb noisy(const ImageRgb& picture, float strength) {
    ImageRgb result = picture;
    for (std::uint32_t p = 0; p < result.pixels.size(); ++p)
        result.pixels[p] *= 1.0f + strength * (random_unit(9, p, 0) - 0.5f);
    return result;
}

TEST(Denoise, KeepsAConstant) {
    const ImageRgb even(size, vec3(0.3f, 0.7f, 1.1f));
    ImageRgb picture = even;
    denoise(two_surfaces(true), most_denoising_passes, 2, picture);
    for (std::size_t p = 0; p < even.pixels.size(); ++p)
        ASSERT_LT(glm::distance(picture.pixels[p], even.pixels[p]), 1e-5f);
}

TEST(Denoise, KeepsAnEdgeBetweenSurfacesThatAFlatPictureWouldLose) {
    // So little apart that brightness alone does not keep them so.
    ImageRgb truth(size);
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x) truth.at(x, y) = vec3(x < 20 ? 1.0f : 1.03f);
    ImageRgb with_wall = truth, flat = truth;
    denoise(two_surfaces(true), 3, 2, with_wall);
    denoise(two_surfaces(false), 3, 2, flat);
    EXPECT_LT(rmse(with_wall, truth), 1e-5);
    EXPECT_GT(rmse(flat, truth), 2e-3);
}

TEST(Denoise, KeepsAnEdgeOfBrightnessOnOneSurface) {
    ImageRgb truth(size);
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x) truth.at(x, y) = vec3(x < 20 ? 0.02f : 1.0f);
    ImageRgb picture = truth;
    denoise(two_surfaces(false), 3, 2, picture);
    EXPECT_LT(std::fabs(picture.at(25, 15).x - 1.0f), 0.05f);
    EXPECT_LT(picture.at(10, 15).x, 0.1f);
}

TEST(Denoise, TakesNoiseOutMoreWithEachOfTheFirstPasses) {
    ImageRgb truth(size);
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x) truth.at(x, y) = vec3(0.5f + 0.005f * static_cast<float>(x));
    double before = rmse(noisy(truth, 0.3f), truth);
    for (const int passes : {1, 2, 3}) {
        ImageRgb picture = noisy(truth, 0.3f);
        denoise(two_surfaces(false), passes, 2, picture);
        EXPECT_LT(rmse(picture, truth), 0.9 * before) << passes;
        before = rmse(picture, truth);
    }
}

TEST(Denoise, LeavesTheBackgroundAndZeroPassesAlone) {
    const ImageRgb picture = noisy(ImageRgb(size, vec3(1.0f)), 1.0f);
    ImageRgb none = picture, all = picture;
    denoise(two_surfaces(true), 0, 2, none);
    EXPECT_EQ(none, picture);
    denoise(two_surfaces(true), 2, 2, all);
    for (int x = 0; x < size.width; ++x) EXPECT_EQ(all.at(x, 0), picture.at(x, 0));
    EXPECT_NE(all.at(5, 5), picture.at(5, 5));
}

TEST(Denoise, DoesNotDependOnThreads) {
    ImageRgb one = noisy(ImageRgb(size, vec3(1.0f)), 1.0f), two = one;
    denoise(two_surfaces(true), 3, 1, one);
    denoise(two_surfaces(true), 3, 2, two);
    EXPECT_EQ(one, two);
}

}  // namespace
}  // namespace sightlines::visibility_field
