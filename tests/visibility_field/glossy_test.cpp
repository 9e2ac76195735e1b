// Glossy surfaces against integrals.
#include "techniques/visibility_field/glossy.h"

#include <numeric>

#include <gtest/gtest.h>

#include "techniques/base/hammersley.h"
#include "techniques/base/random.h"
#include "tests/visibility_field/chi_square.h"

namespace sightlines::visibility_field {
namespace {

constexpr float pi = std::numbers::pi_v<float>;

vec3 leaning(float degrees) {
    return {std::sin(glm::radians(degrees)) * 0.8f, std::sin(glm::radians(degrees)) * 0.6f,
            std::cos(glm::radians(degrees))};
}

/// The share of light from `to_eye` that the surface sends anywhere; by reciprocity what it sends of a white sky there.
double whole_reflectance(const Gloss& gloss, vec3 to_eye) {
    const std::vector<double> all = testing::integrals({}, 40, [&](vec3 direction) {
        return direction.z > 0.0f ? reflected_share(gloss, to_eye, direction).x * direction.z : 0.0f;
    });
    return std::reduce(all.begin(), all.end());
}

TEST(Glossy, FacetsThatAreSeenFillTheSurfaceThatIsSeen) {
    // Heitz's weak white furnace: where facets mirror everything and none is hidden from the light nothing is lost.
    for (const float roughness : {0.3f, 0.6f, 1.0f})
        for (const float degrees : {0.0f, 40.0f, 75.0f}) {
            const float width = roughness * roughness;
            const std::vector<double> all = testing::integrals(
                {}, 40, [&](vec3 direction) { return mirrored_density(width, leaning(degrees), direction); });
            EXPECT_NEAR(std::reduce(all.begin(), all.end()), 1.0, 5e-3) << roughness << " " << degrees;
        }
}

TEST(Glossy, AWhiteFurnaceLosesOnlyWhatFacetsHide) {
    for (const float degrees : {0.0f, 40.0f, 75.0f}) {
        double before = 1.001;
        for (const float roughness : {0.25f, 0.5f, 1.0f}) {
            const double kept = whole_reflectance({vec3(0.0f), vec3(1.0f), roughness * roughness}, leaning(degrees));
            EXPECT_LT(kept, before) << roughness << " " << degrees;  // rougher ones hide more
            EXPECT_GT(kept, 0.3) << roughness << " " << degrees;
            before = kept;
        }
        EXPECT_GT(whole_reflectance({vec3(0.0f), vec3(1.0f), 0.0625f}, leaning(degrees)), 0.95) << degrees;
    }
}

TEST(Glossy, TheRoughestSurfaceSeenHeadOnLosesTheLogarithmOfTwo) {
    // Its facets' normals follow the cosine; a light at cosine c is seen by 2 c / (1 + c) of them: the integral of
    // c / (1 + c) from 0 to 1.
    const double kept = whole_reflectance({vec3(0.0f), vec3(1.0f), 1.0f}, vec3(0.0f, 0.0f, 1.0f));
    EXPECT_NEAR(kept, 1.0 - std::numbers::ln2, 1e-3);
}

TEST(Glossy, NoSurfaceSendsMoreThanItGets) {
    for (const float metalness : {0.0f, 0.5f, 1.0f})
        for (const float roughness : {0.25f, 0.6f, 1.0f})
            for (const float degrees : {0.0f, 40.0f, 80.0f}) {
                const Gloss gloss = make_gloss(vec3(1.0f - 0.5f * metalness), roughness, metalness);
                EXPECT_LT(whole_reflectance(gloss, leaning(degrees)), 1.003) << metalness << " " << roughness;
            }
}

TEST(Glossy, LightGoesBothWaysAlike) {
    const Gloss gloss = make_gloss(vec3(0.7f, 0.5f, 0.2f), 0.4f, 0.3f);
    for (std::uint32_t k = 0; k < 100; ++k) {
        vec3 a = sphere_direction(random_unit(1, k, 0), random_unit(1, k, 1));
        vec3 b = sphere_direction(random_unit(2, k, 0), random_unit(2, k, 1));
        a.z = std::fabs(a.z);
        b.z = std::fabs(b.z);
        const vec3 there = reflected_share(gloss, a, b), back = reflected_share(gloss, b, a);
        EXPECT_LT(glm::distance(there, back), 1e-4f * glm::length(there));
    }
}

TEST(Glossy, ADullSurfaceWithoutFacetsReflectsEvenly) {
    const Gloss even{vec3(0.6f), vec3(0.0f), 1.0f};
    // What Schlick's term takes for facets seen from the side is small where eye and light are near the normal.
    EXPECT_NEAR(reflected_share(even, vec3(0.0f, 0.0f, 1.0f), leaning(20.0f)).x, 0.6f / pi, 1e-3f);
    EXPECT_EQ(reflected_share(even, vec3(0.0f, 0.0f, 1.0f), vec3(0.0f, 0.0f, -1.0f)), vec3(0.0f));
}

TEST(Glossy, MirroredSamplesFallWhereTheirDensitySays) {
    constexpr std::uint32_t samples = 100'000;
    const testing::SphereBins bins;
    for (const float roughness : {0.4f, 0.7f, 1.0f})
        for (const float degrees : {5.0f, 50.0f, 80.0f}) {
            const float width = roughness * roughness;
            std::vector<double> found(bins.count());
            for (std::uint32_t k = 0; k < samples; ++k)
                found[bins.bin_of(
                    mirrored_sample(width, leaning(degrees), {random_unit(3, k, 0), random_unit(3, k, 1)}))] += 1.0;
            const std::vector<double> expected = testing::integrals(
                bins, 30, [&](vec3 direction) { return mirrored_density(width, leaning(degrees), direction); });
            EXPECT_LT(testing::chi_square(expected, found, samples), 1.35) << roughness << " " << degrees;
            const std::vector<double> others = testing::integrals(
                bins, 30, [&](vec3 direction) { return mirrored_density(1.2f * width, leaning(degrees), direction); });
            EXPECT_GT(testing::chi_square(others, found, samples), 2.0) << "the test could not fail";
        }
}

TEST(Glossy, MirroredSamplesComeToTheIntegral) {
    const Gloss gloss{vec3(0.0f), vec3(0.8f), 0.3f};
    const vec3 to_eye = leaning(50.0f);
    double sum = 0.0;
    constexpr std::uint32_t samples = 20'000;
    for (std::uint32_t k = 0; k < samples; ++k) {
        const vec3 direction = mirrored_sample(gloss.width, to_eye, hammersley(k, samples));
        if (direction.z <= 0.0f) continue;
        sum += reflected_share(gloss, to_eye, direction).x * direction.z /
               mirrored_density(gloss.width, to_eye, direction) / samples;
    }
    EXPECT_NEAR(sum, whole_reflectance(gloss, to_eye), 2e-3);
}

TEST(Glossy, AMetalHasItsColourInTheMirrorAndAnythingElseInTheRest) {
    const Gloss plastic = make_gloss(vec3(0.8f, 0.4f, 0.2f), 0.5f, 0.0f),
                metal = make_gloss(vec3(0.4f, 0.2f, 0.1f), 0.5f, 1.0f);
    EXPECT_EQ(plastic.diffuse, vec3(0.8f, 0.4f, 0.2f));
    EXPECT_EQ(plastic.head_on, vec3(0.04f));
    EXPECT_EQ(metal.diffuse, vec3(0.0f));
    EXPECT_LT(glm::distance(metal.head_on, vec3(0.8f, 0.4f, 0.2f)), 1e-6f);
    EXPECT_FLOAT_EQ(metal.width, 0.25f);
    EXPECT_GT(make_gloss(vec3(0.5f), 0.0f, 0.0f).width, 0.0f);
}

}  // namespace
}  // namespace sightlines::visibility_field
