// The figures of the papers' tables, as data.
#pragma once

#include <optional>
#include <span>
#include <string_view>

namespace sightlines {

/// One figure as printed.
struct PaperFigure {
    std::string_view scene;     ///< as our scene of the same name, or as its file
    std::string_view quantity;  ///< as in our rows
    double at = 0.0;            ///< what the table varies; 0: nothing
    double value = 0.0;
};

/// What quantities are called, in the papers' rows and ours.
namespace quantity {
constexpr std::string_view visibility = "visibility error, voxel rows";
constexpr std::string_view shadow = "shadow error, voxel rows";
constexpr const char* of_all_lights = ", of all lights";  ///< behind the name of an error
constexpr std::string_view imperfect_visibility = "visibility error, imperfect shadow maps";
constexpr std::string_view imperfect_shadow = "shadow error, imperfect shadow maps";
constexpr std::string_view equal_time_points = "points of imperfect shadow maps, equal time";
constexpr std::string_view equal_time_texels = "texels a side of imperfect shadow maps, equal time";
constexpr std::string_view equal_time_visibility = "visibility error, imperfect shadow maps, equal time";
constexpr std::string_view equal_time_shadow = "shadow error, imperfect shadow maps, equal time";
constexpr std::string_view render_time = "render time";
constexpr std::string_view over_ray_tracing = "speedup over ray tracing";
constexpr std::string_view over_shadow_maps = "speedup over shadow maps";
constexpr std::string_view shadow_map_resolution = "resolution of those shadow maps";
constexpr std::string_view time_per_light = "time per light";
constexpr std::string_view rebuild_time = "rebuild of the moving scene";
constexpr std::string_view asking_time = "render time without the rebuild";
constexpr std::string_view asking_time_per_light = "time per light without the rebuild";
constexpr std::string_view row_query_time = "voxel rows";
constexpr std::string_view voxel_marching_time = "voxel marching";
constexpr std::string_view over_voxel_marching = "speedup over voxel marching";
constexpr std::string_view row_marching_time = "row marching";
constexpr std::string_view over_row_marching = "speedup over row marching";
constexpr std::string_view uncompressed = "uncompressed";
constexpr std::string_view compressed = "compressed";
constexpr std::string_view plain_visibility = "visibility error, uncompressed";
constexpr std::string_view plain_shadow = "shadow error, uncompressed";
constexpr std::string_view compressed_visibility = "visibility error, compressed";
constexpr std::string_view compressed_shadow = "shadow error, compressed";
constexpr std::string_view voxelization_time = "voxelization";
constexpr std::string_view compression_time = "compression";
constexpr std::string_view time_without_field = "time without the field";
constexpr std::string_view time_with_field = "time with the field";
constexpr std::string_view field_speed_up = "speed-up";
constexpr std::string_view field_rmse = "RMSE";
constexpr std::string_view field_rays = "rays traced";
constexpr std::string_view field_bake = "baking";
constexpr std::string_view field_memory = "memory of the field";
constexpr std::string_view dense_memory = "memory, the paper's layout";
}  // namespace quantity

/// All figures of Wang 2017's table `number` (1 to 11), or of Figure 7 (`number` 0): those that its text gives.
std::span<const PaperFigure> wang_2017(int number);

/// All figures of Xu 2022 about one of our tables (1, or 5 to 9 for the figures, 0 for memory): those that its text
/// gives. It gives no RMSE, and nothing of Figure 9.
std::span<const PaperFigure> xu_2022(int number);

/// The figure for these, where the paper has one.
std::optional<double> find_figure(std::span<const PaperFigure> figures, std::string_view scene,
                                  std::string_view quantity, double at);

/// Where figures are from.
struct Paper {
    std::string_view citation, hardware;
    std::span<const PaperFigure> (*figures)(int number) = nullptr;  ///< by PaperTable::number
};

inline constexpr Paper wang_2017_paper{
    "L. Wang, X. Liang, C. Meng, V. Popescu: Fast Ray-Scene Intersection for Interactive Shadow Rendering with "
    "Thousands of Dynamic Lights. IEEE TVCG, 2017",
    "Intel Core i7-4770, 3.5 GHz, 8 GB; NVIDIA GeForce GTX 1080", wang_2017};
inline constexpr Paper xu_2022_paper{
    "Y. Xu, Y. Jiang, C. Wang, K. Li, P. Zhou, G. Geng: Precomputed Discrete Visibility Fields for Real-Time "
    "Ray-Traced Environment Lighting. 2022",
    "NVIDIA GeForce RTX 3080, 1920 x 1080 pixels; baked on an Intel Core i9-10980XE", xu_2022};

}  // namespace sightlines
