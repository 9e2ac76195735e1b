#include "shaders/kernel_source.h"

#include <string>

#include "shaders/spirv.h"
#include "tests/compute/compute_testing.h"

namespace sightlines {
namespace {

TEST(KernelSource, IsTheFilesTextToTheLetter) {
    for (const char* name : {"shaders/voxel_rows.h", "shaders/lighting.h", "shaders/voxel_rows_lighting.comp",
                             "shaders/voxel_rows_lighting.glsl"}) {
        const std::vector<std::uint8_t> bytes =
            read_file(std::string(SIGHTLINES_SOURCE_FOLDER) + "/" + name, 1u << 20u);
        EXPECT_EQ(kernel_source(name), std::string(bytes.begin(), bytes.end())) << name;
    }
}

TEST(KernelSource, IsEmptyForOtherNames) {
    EXPECT_TRUE(kernel_source("shaders/no_such_kernel.h").empty());
    EXPECT_TRUE(kernel_source("../etc/passwd").empty());
}

TEST(Spirv, StartsWithItsMagicNumber) {
    ASSERT_FALSE(spirv::voxel_rows_lighting().empty());
    EXPECT_EQ(spirv::voxel_rows_lighting()[0], 0x07230203u);
}

}  // namespace
}  // namespace sightlines
