#include <cstdlib>
#include <utility>

#include "techniques/base/error.h"
#include "tests/compute/compute_testing.h"

namespace sightlines::compute {
namespace {

/// Sets an environment variable for the length of a test.
struct ScopedVariable {
    const char* name;
    ScopedVariable(const char* name_, const char* value) : name(name_) { setenv(name, value, 1); }
    ~ScopedVariable() { unsetenv(name); }
    ScopedVariable(const ScopedVariable&) = delete;
    ScopedVariable& operator=(const ScopedVariable&) = delete;
};

TEST(Devices, AreListedUsableOnesFirstAndGpusBeforeSoftware) {
    NEEDS_VULKAN;
    const std::vector<DeviceInfo> devices = list_devices();
    for (std::size_t i = 0; i + 1 < devices.size(); ++i) {
        const auto order = [](const DeviceInfo& device) { return std::pair(!device.lacks.empty(), device.kind); };
        EXPECT_LE(order(devices[i]), order(devices[i + 1]));
    }
}

TEST(Devices, SayWhatTheyAre) {
    NEEDS_VULKAN;
    const DeviceInfo device = list_devices().front();
    EXPECT_FALSE(device.name.empty());
    EXPECT_FALSE(device.driver.empty());
    EXPECT_EQ(device.vulkan_version.substr(0, 2), "1.");
    EXPECT_GE(device.memory_bytes, std::uint64_t{1} << 28u);
    EXPECT_GE(device.largest_allocation_bytes, std::uint64_t{1} << 28u);
    EXPECT_GE(device.largest_workgroup, 128u);
    EXPECT_GE(device.subgroup_size, 1u);
}

TEST(Devices, AreNoneWithoutADriver) {
    const ScopedVariable no_driver("VK_ICD_FILENAMES", "/nowhere/no_driver.json");
    const ScopedVariable no_driver_either("VK_DRIVER_FILES", "/nowhere/no_driver.json");
    EXPECT_TRUE(list_devices().empty());
}

TEST(OpenDevice, SaysHowToGetADriverWhereThereIsNone) {
    const ScopedVariable no_driver("VK_ICD_FILENAMES", "/nowhere/no_driver.json");
    const ScopedVariable no_driver_either("VK_DRIVER_FILES", "/nowhere/no_driver.json");
    try {
        open_device();
        FAIL() << "opened a device without a driver";
    } catch (const EnvironmentError& error) {
        EXPECT_EQ(error.where, "Vulkan");
        EXPECT_NE(error.remedy.find("install"), std::string::npos);
    }
}

TEST(OpenDevice, OpensTheMostPreferredOneAndAnyByName) {
    NEEDS_VULKAN;
    const std::string name = list_devices().front().name;
    EXPECT_EQ(open_device()->info.name, name);
    EXPECT_EQ(open_device(name)->info.name, name);
}

TEST(OpenDevice, OffersTheNearestNameForAWrongOne) {
    NEEDS_VULKAN;
    const std::string name = list_devices().front().name;
    try {
        open_device(name.substr(1));
        FAIL() << "opened a device that does not exist";
    } catch (const InputError& error) {
        EXPECT_NE(error.remedy.find(name), std::string::npos);
    }
}

TEST(OpenDevice, PassesTheValidationLayerWithAllThatItDoes) {
    NEEDS_VULKAN;
    const ScopedVariable validated("SIGHTLINES_VULKAN_VALIDATION", "1");
    const auto device = open_device();
    if (!device->messenger) GTEST_SKIP() << "vulkan-validationlayers is not installed";
    const std::vector<std::uint32_t> numbers(1000, 3u);
    const Buffer from = give_to_device(device, std::as_bytes(std::span(numbers)), Progress());
    EXPECT_EQ(scaled(from, 1000, 5), std::vector<std::uint32_t>(1000, 15u));
    EXPECT_EQ(device->validation_errors, 0);
}

TEST(BytesText, HasThreeDigitsAndAUnit) {
    EXPECT_EQ(bytes_text(0), "0 B");
    EXPECT_EQ(bytes_text(2123366400), "2.12 GB");
    EXPECT_EQ(bytes_text(64000), "64 kB");
}

}  // namespace
}  // namespace sightlines::compute
