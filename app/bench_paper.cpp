// Wang 2017, section 6. Missing: what the text of the tables does not give (the park's in Table 1, 10,000 lights in
// Table 2, 256 voxels in Table 3); Figure 7 is a curve without figures, of which only Table 1's points are known.
#include "app/bench_paper.h"

#include <algorithm>
#include <array>

namespace sightlines {
namespace {

using namespace quantity;

constexpr std::array<PaperFigure, 21> table_1{{
    {"trees", visibility, 0, 4.8},
    {"garden", visibility, 0, 7.8},
    {"cathedral", visibility, 0, 6.4},
    {"planes", visibility, 0, 3.4},
    {"bear", visibility, 0, 3.3},
    {"trees", imperfect_visibility, 0, 8.5},
    {"garden", imperfect_visibility, 0, 13.1},
    {"cathedral", imperfect_visibility, 0, 20.1},
    {"planes", imperfect_visibility, 0, 6.5},
    {"bear", imperfect_visibility, 0, 6.1},
    {"trees", shadow, 0, 1.8},
    {"garden", shadow, 0, 2.7},
    {"cathedral", shadow, 0, 3.2},
    {"planes", shadow, 0, 1.7},
    {"bear", shadow, 0, 2.1},
    {"trees", imperfect_shadow, 0, 6.7},
    {"garden", imperfect_shadow, 0, 5.8},
    {"cathedral", imperfect_shadow, 0, 9.8},
    {"planes", imperfect_shadow, 0, 3.4},
    {"bear", imperfect_shadow, 0, 4.9},
    {"park", imperfect_shadow, 0, 12.1},
}};

constexpr std::array<PaperFigure, 16> table_2{{
    {"trees", visibility, 512, 4.6},
    {"trees", visibility, 1024, 4.8},
    {"trees", visibility, 2048, 4.7},
    {"trees", visibility, 4096, 4.6},
    {"trees", shadow, 512, 1.8},
    {"trees", shadow, 1024, 1.8},
    {"trees", shadow, 2048, 1.7},
    {"trees", shadow, 4096, 1.7},
    {"garden", visibility, 512, 7.8},
    {"garden", visibility, 1024, 7.8},
    {"garden", visibility, 2048, 7.9},
    {"garden", visibility, 4096, 7.7},
    {"garden", shadow, 512, 2.8},
    {"garden", shadow, 1024, 2.7},
    {"garden", shadow, 2048, 2.9},
    {"garden", shadow, 4096, 2.7},
}};

constexpr std::array<PaperFigure, 18> table_3{{
    {"trees", visibility, 32, 10.5},
    {"trees", visibility, 64, 6},
    {"trees", visibility, 128, 4.8},
    {"trees", shadow, 32, 7.1},
    {"trees", shadow, 64, 3.1},
    {"trees", shadow, 128, 1.8},
    {"garden", visibility, 32, 12.3},
    {"garden", visibility, 64, 8.8},
    {"garden", visibility, 128, 7.8},
    {"garden", shadow, 32, 6.4},
    {"garden", shadow, 64, 3.5},
    {"garden", shadow, 128, 2.7},
    {"cathedral", visibility, 32, 14.4},
    {"cathedral", visibility, 64, 10},
    {"cathedral", visibility, 128, 6.4},
    {"cathedral", shadow, 32, 6.7},
    {"cathedral", shadow, 64, 4.5},
    {"cathedral", shadow, 128, 3},
}};

constexpr std::array<PaperFigure, 12> table_4{{
    {"trees", visibility, 6, 6.4},
    {"trees", visibility, 3, 5.3},
    {"trees", visibility, 2, 4.8},
    {"trees", shadow, 6, 2.6},
    {"trees", shadow, 3, 2.1},
    {"trees", shadow, 2, 1.8},
    {"garden", visibility, 6, 10.6},
    {"garden", visibility, 3, 8.3},
    {"garden", visibility, 2, 7.8},
    {"garden", shadow, 6, 4.1},
    {"garden", shadow, 3, 2.8},
    {"garden", shadow, 2, 2.7},
}};

constexpr std::array<PaperFigure, 24> table_5{{
    {"trees", render_time, 0, 38},
    {"garden", render_time, 0, 43},
    {"cathedral", render_time, 0, 59},
    {"planes", render_time, 0, 66},
    {"bear", render_time, 0, 312},
    {"park", render_time, 0, 441},
    {"trees", over_ray_tracing, 0, 43},
    {"garden", over_ray_tracing, 0, 15},
    {"cathedral", over_ray_tracing, 0, 21},
    {"planes", over_ray_tracing, 0, 12},
    {"bear", over_ray_tracing, 0, 6},
    {"park", over_ray_tracing, 0, 35},
    {"trees", over_shadow_maps, 0, 52},
    {"garden", over_shadow_maps, 0, 16},
    {"cathedral", over_shadow_maps, 0, 89},
    {"planes", over_shadow_maps, 0, 24},
    {"bear", over_shadow_maps, 0, 10},
    {"park", over_shadow_maps, 0, 41},
    {"trees", shadow_map_resolution, 0, 384},
    {"garden", shadow_map_resolution, 0, 128},
    {"cathedral", shadow_map_resolution, 0, 36},
    {"planes", shadow_map_resolution, 0, 96},
    {"bear", shadow_map_resolution, 0, 128},
    {"park", shadow_map_resolution, 0, 64},
}};

constexpr std::array<PaperFigure, 25> table_6{{
    {"trees", render_time, 512, 20},        {"trees", render_time, 1024, 38},
    {"trees", render_time, 2048, 77},       {"trees", render_time, 4096, 159},
    {"trees", render_time, 10000, 378},     {"garden", render_time, 512, 21},
    {"garden", render_time, 1024, 43},      {"garden", render_time, 2048, 89},
    {"garden", render_time, 4096, 183},     {"garden", render_time, 10000, 459},
    {"cathedral", render_time, 512, 29},    {"cathedral", render_time, 1024, 59},
    {"cathedral", render_time, 2048, 124},  {"cathedral", render_time, 4096, 273},
    {"cathedral", render_time, 10000, 683}, {"planes", render_time, 512, 35},
    {"planes", render_time, 1024, 66},      {"planes", render_time, 2048, 135},
    {"planes", render_time, 4096, 266},     {"planes", render_time, 10000, 647},
    {"bear", render_time, 512, 297},        {"bear", render_time, 1024, 312},
    {"bear", render_time, 2048, 345},       {"bear", render_time, 4096, 417},
    {"bear", render_time, 10000, 630},
}};

constexpr std::array<PaperFigure, 20> table_7{{
    {"trees", row_query_time, 0, 38},
    {"garden", row_query_time, 0, 43},
    {"cathedral", row_query_time, 0, 59},
    {"planes", row_query_time, 0, 66},
    {"bear", row_query_time, 0, 312},
    {"park", row_query_time, 0, 441},
    {"trees", voxel_marching_time, 0, 2858},
    {"garden", voxel_marching_time, 0, 3401},
    {"cathedral", voxel_marching_time, 0, 2673},
    {"planes", voxel_marching_time, 0, 2825},
    {"bear", voxel_marching_time, 0, 3806},
    {"park", voxel_marching_time, 0, 22482},
    {"trees", over_voxel_marching, 0, 75},
    {"garden", over_voxel_marching, 0, 79},
    {"cathedral", over_voxel_marching, 0, 45},
    {"planes", over_voxel_marching, 0, 43},
    {"bear", over_voxel_marching, 0, 12},
    {"park", over_voxel_marching, 0, 51},
    {"trees", over_row_marching, 0, 22},
    {"garden", over_row_marching, 0, 31},
}};

constexpr std::array<PaperFigure, 8> table_8{{
    {"trees", uncompressed, 32, 32},
    {"trees", uncompressed, 64, 254},
    {"trees", uncompressed, 128, 2025},
    {"trees", uncompressed, 256, 16200},
    {"trees", compressed, 32, 36},
    {"trees", compressed, 64, 95},
    {"trees", compressed, 128, 333},
    {"trees", compressed, 256, 1298},
}};

constexpr std::array<PaperFigure, 16> table_9{{
    {"trees", plain_visibility, 0, 4.5},
    {"garden", plain_visibility, 0, 7.6},
    {"cathedral", plain_visibility, 0, 6.4},
    {"planes", plain_visibility, 0, 3.3},
    {"trees", plain_shadow, 0, 1.7},
    {"garden", plain_shadow, 0, 2.7},
    {"cathedral", plain_shadow, 0, 3.2},
    {"planes", plain_shadow, 0, 1.6},
    {"trees", compressed_visibility, 0, 4.8},
    {"garden", compressed_visibility, 0, 7.8},
    {"cathedral", compressed_visibility, 0, 6.4},
    {"planes", compressed_visibility, 0, 3.4},
    {"trees", compressed_shadow, 0, 1.8},
    {"garden", compressed_shadow, 0, 2.7},
    {"cathedral", compressed_shadow, 0, 3.2},
    {"planes", compressed_shadow, 0, 1.7},
}};

constexpr std::array<PaperFigure, 6> table_10{{
    {"trees", voxelization_time, 0, 0.2},
    {"garden", voxelization_time, 0, 0.19},
    {"cathedral", voxelization_time, 0, 0.19},
    {"trees", compression_time, 0, 492},
    {"garden", compression_time, 0, 470},
    {"cathedral", compression_time, 0, 527},
}};

constexpr std::array<PaperFigure, 6> table_11{{
    {"trees", uncompressed, 0, 28},
    {"garden", uncompressed, 0, 25},
    {"cathedral", uncompressed, 0, 20},
    {"trees", compressed, 0, 26},
    {"garden", compressed, 0, 23},
    {"cathedral", compressed, 0, 17},
}};

constexpr std::array<PaperFigure, 4> figure_7{{
    {"trees", imperfect_shadow, 11000, 6.7},
    {"garden", imperfect_shadow, 11000, 5.8},
    {"trees", shadow, 11000, 1.8},
    {"garden", shadow, 11000, 2.7},
}};

// Xu 2022. Figures 5 to 7 at 128 samples a pixel, cells of 50 cm and 10 million points share Table 1's time; that of
// the bistro is Figure 1's.
constexpr std::array<PaperFigure, 12> xu_table_1{{
    {"sponza", time_without_field, 16, 6.69},
    {"sponza", time_without_field, 32, 13.79},
    {"sponza", time_without_field, 64, 27.28},
    {"sponza", time_without_field, 128, 55.19},
    {"sponza", time_with_field, 16, 2.23},
    {"sponza", time_with_field, 32, 4.02},
    {"sponza", time_with_field, 64, 7.81},
    {"sponza", time_with_field, 128, 15.74},
    {"sponza", field_speed_up, 16, 3.12},
    {"sponza", field_speed_up, 32, 3.43},
    {"sponza", field_speed_up, 64, 3.49},
    {"sponza", field_speed_up, 128, 3.51},
}};

constexpr std::array<PaperFigure, 4> xu_figure_5{{
    {"sponza", time_without_field, 0, 55.19},
    {"sponza", time_with_field, 0, 15.74},
    {"sponza", field_speed_up, 0, 3.51},
    {"bistro", time_with_field, 0, 33.67},
}};

constexpr std::array<PaperFigure, 1> xu_figure_6{{{"sponza", time_with_field, 10e6, 15.74}}};

constexpr std::array<PaperFigure, 2> xu_figure_7{{
    {"sponza", time_with_field, 50, 15.74},
    {"sponza", dense_memory, 50, 49008},
}};

constexpr std::array<PaperFigure, 6> xu_figure_10{{
    {"sponza", time_without_field, 0, 54.64},
    {"sponza", time_with_field, 0, 10.14},
    {"sponza", field_speed_up, 0, 5.39},
    {"bistro", time_without_field, 0, 48.75},
    {"bistro", time_with_field, 0, 27.16},
    {"bistro", field_speed_up, 0, 1.79},
}};

constexpr std::array<PaperFigure, 2> xu_memory{{
    {"sponza", dense_memory, 50, 49008},
    {"bistro", dense_memory, 100, 173958},
}};

}  // namespace

std::span<const PaperFigure> wang_2017(int number) {
    const std::array<std::span<const PaperFigure>, 12> all{figure_7, table_1, table_2, table_3, table_4,  table_5,
                                                           table_6,  table_7, table_8, table_9, table_10, table_11};
    return all.at(static_cast<std::size_t>(number));
}

std::span<const PaperFigure> xu_2022(int number) {
    switch (number) {
        case 1:
        case 8:
            return xu_table_1;
        case 5:
            return xu_figure_5;
        case 6:
            return xu_figure_6;
        case 7:
            return xu_figure_7;
        case 10:
            return xu_figure_10;
        case 0:
            return xu_memory;
        default:
            return {};
    }
}

std::optional<double> find_figure(std::span<const PaperFigure> figures, std::string_view scene,
                                  std::string_view quantity, double at) {
    const auto found = std::ranges::find_if(figures, [&](const PaperFigure& figure) {
        return figure.scene == scene && figure.quantity == quantity && figure.at == at;
    });
    return found == figures.end() ? std::nullopt : std::optional(found->value);
}

}  // namespace sightlines
