#include "techniques/scene/surface_fragments.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <span>
#include <utility>

#include "techniques/base/parallel.h"

namespace sightlines {
namespace {

/// How far outside the box, in cells, a sample still counts as on its face: rounding of the corners that made the box.
constexpr double face_tolerance_cells = 1e-3;

/// Triangles that one task rasterises, and layers that one task makes unique. Fixed, so that nothing depends on the
/// number of threads.
constexpr std::size_t triangles_per_chunk = 2048, layers_per_slab = 8;

/// A sample before the cells are made unique.
struct Sample {
    Fragment fragment;
    std::uint32_t cell_in_layer;  ///< y * cells.x + x
    std::uint32_t layer;          ///< z
};

/// The samples of one chunk of triangles, in triangle order. Cells sampled a short while ago are remembered, so that
/// most of a chunk's repetitions become one sample with their summed area.
struct SampleList {
    std::vector<Sample> samples;
    std::vector<std::uint32_t> recent = std::vector<std::uint32_t>(4096, ~std::uint32_t{0});
    std::vector<Sample> of_triangle;  ///< those of the triangle at hand
    std::size_t taken = 0;            ///< of the triangle at hand, those outside the grid as well

    /// Gives each sample of the triangle at hand its share of the area, and moves on to the next triangle.
    void finish_triangle(double area_m2) {
        for (Sample& sample : of_triangle) {
            sample.fragment.area_m2 = static_cast<float>(area_m2 / static_cast<double>(taken));
            add(sample);
        }
        of_triangle.clear();
        taken = 0;
    }

private:
    void add(const Sample& sample) {
        const std::uint64_t cell = (std::uint64_t{sample.layer} << 32u) | sample.cell_in_layer;
        std::uint32_t& remembered = recent[(cell * 0x9e3779b97f4a7c15u) >> 52u];
        if (remembered < samples.size() && samples[remembered].layer == sample.layer &&
            samples[remembered].cell_in_layer == sample.cell_in_layer) {
            samples[remembered].fragment.area_m2 += sample.fragment.area_m2;
            return;
        }
        remembered = static_cast<std::uint32_t>(samples.size());
        samples.push_back(sample);
    }
};

/// World positions in units of cells and back.
struct GridFrame {
    dvec3 lowest, cells_per_metre, metres_per_cell;
    ivec3 cells;
};

GridFrame grid_frame(const FragmentGrid& grid) {
    GridFrame frame{dvec3(grid.box.lowest), dvec3(0.0), dvec3(0.0), grid.cells};
    const dvec3 size = dvec3(grid.box.highest) - dvec3(grid.box.lowest);
    for (int axis = 0; axis < 3; ++axis) {
        frame.metres_per_cell[axis] = size[axis] / grid.cells[axis];
        // A box without extent along an axis (a flat scene) has all its surface in the first layer.
        if (size[axis] > 0.0) frame.cells_per_metre[axis] = grid.cells[axis] / size[axis];
    }
    return frame;
}

/// Adds the sample at `point` (in cells), unless it lies outside the grid.
void add_sample(const GridFrame& frame, dvec3 point, std::uint32_t triangle, SampleList& samples) {
    ++samples.taken;
    ivec3 cell;
    for (int axis = 0; axis < 3; ++axis) {
        const double last = frame.cells[axis];
        if (!(point[axis] >= -face_tolerance_cells && point[axis] <= last + face_tolerance_cells)) return;
        cell[axis] = std::clamp(static_cast<int>(std::floor(point[axis])), 0, frame.cells[axis] - 1);
    }
    const auto cell_in_layer = static_cast<std::uint32_t>(cell.y) * static_cast<std::uint32_t>(frame.cells.x) +
                               static_cast<std::uint32_t>(cell.x);
    const vec3 position(frame.lowest + point * frame.metres_per_cell);
    samples.of_triangle.push_back({{position, 0.0f, triangle}, cell_in_layer, static_cast<std::uint32_t>(cell.z)});
}

/// A triangle seen along its dominant axis: corners in cells, x and y the axes of the picture, z the depth.
struct Projection {
    std::array<dvec3, 3> corners;
    int axis_x, axis_y, axis_depth;
    double doubled_area;  ///< signed, of the picture

    dvec3 unprojected(dvec3 point) const {
        dvec3 result;
        result[axis_x] = point.x;
        result[axis_y] = point.y;
        result[axis_depth] = point.z;
        return result;
    }
};

Projection project(const std::array<dvec3, 3>& corners) {
    const dvec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
    const dvec3 size = glm::abs(normal);
    const int depth = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
    Projection projection{{}, (depth + 1) % 3, (depth + 2) % 3, depth, normal[depth]};
    for (std::size_t i = 0; i < 3; ++i)
        projection.corners[i] = {corners[i][projection.axis_x], corners[i][projection.axis_y], corners[i][depth]};
    return projection;
}

/// Pixels [first, last] of one row of the picture; empty where first > last.
struct PixelSpan {
    int first = 0, last = -1;
};

/// First and last pixel whose centre lies in [low, high], of `count` pixels.
PixelSpan centres_between(double low, double high, int count) {
    const double first = std::clamp(std::ceil(low - 0.5), 0.0, static_cast<double>(count));
    const double last = std::clamp(std::floor(high - 0.5), -1.0, count - 1.0);
    return {static_cast<int>(first), static_cast<int>(last)};
}

/// The pixels whose centres the triangle covers in row `row`. Each edge is intersected from its lower end up, so that
/// two triangles that share it find the very same point, and no centre on it is lost between them.
PixelSpan covered_pixels(const Projection& triangle, int row, int width) {
    const double y = row + 0.5;
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (std::size_t i = 0; i < 3; ++i) {
        dvec3 lower = triangle.corners[i], upper = triangle.corners[(i + 1) % 3];
        if (lower.y > upper.y || (lower.y == upper.y && lower.x > upper.x)) std::swap(lower, upper);
        if (y < lower.y || y > upper.y) continue;
        const double height = upper.y - lower.y;
        const double x = height > 0.0 ? lower.x + (upper.x - lower.x) * ((y - lower.y) / height) : lower.x;
        low = std::min(low, x);
        high = std::max(high, height > 0.0 ? x : upper.x);
    }
    return low <= high ? centres_between(low, high, width) : PixelSpan{};
}

/// Samples the triangle in every pixel centre that it covers; returns whether there was one.
bool add_pixel_centres(const GridFrame& frame, const Projection& triangle, std::uint32_t index, SampleList& samples) {
    const auto& [a, b, c] = triangle.corners;
    const auto [lowest_depth, highest_depth] = std::minmax({a.z, b.z, c.z});
    const auto [lowest_y, highest_y] = std::minmax({a.y, b.y, c.y});
    const dvec3 ab = b - a, ac = c - a;
    const double depth_per_x = (ab.z * ac.y - ac.z * ab.y) / triangle.doubled_area;
    const double depth_per_y = (ac.z * ab.x - ab.z * ac.x) / triangle.doubled_area;
    const int width = frame.cells[triangle.axis_x];
    const PixelSpan rows = centres_between(lowest_y, highest_y, frame.cells[triangle.axis_y]);
    bool any = false;
    for (int row = rows.first; row <= rows.last; ++row) {
        const PixelSpan pixels = covered_pixels(triangle, row, width);
        for (int pixel = pixels.first; pixel <= pixels.last; ++pixel) {
            const double x = pixel + 0.5, y = row + 0.5;
            const double depth = a.z + (x - a.x) * depth_per_x + (y - a.y) * depth_per_y;
            // Rounding of a sliver's slopes must not carry the sample off the triangle.
            const dvec3 point(x, y, std::clamp(depth, lowest_depth, highest_depth));
            add_sample(frame, triangle.unprojected(point), index, samples);
            any = true;
        }
    }
    return any;
}

/// The part [t0, t1] of the segment a to b that lies in the grid; t0 > t1 where there is none.
dvec2 clipped(const GridFrame& frame, dvec3 a, dvec3 b) {
    dvec2 part(0.0, 1.0);
    for (int axis = 0; axis < 3; ++axis) {
        const double step = b[axis] - a[axis];
        if (step == 0.0) continue;
        double t0 = (-face_tolerance_cells - a[axis]) / step;
        double t1 = (frame.cells[axis] + face_tolerance_cells - a[axis]) / step;
        if (t0 > t1) std::swap(t0, t1);
        part = {std::max(part.x, t0), std::min(part.y, t1)};
    }
    return part;
}

/// Samples the edges at most a cell apart. Where `skip_covered`, not in pixels whose centres the triangle covers
/// anyway.
void add_edges(const GridFrame& frame, const Projection& triangle, std::uint32_t index, bool skip_covered,
               SampleList& samples) {
    for (std::size_t i = 0; i < 3; ++i) {
        const dvec3 a = triangle.corners[i], b = triangle.corners[(i + 1) % 3];
        const dvec2 part = clipped(frame, triangle.unprojected(a), triangle.unprojected(b));
        if (part.x > part.y) continue;
        const dvec3 length = glm::abs(b - a) * (part.y - part.x);
        const int count = static_cast<int>(std::ceil(std::max({length.x, length.y, length.z})));
        for (int k = 0; k < count; ++k) {
            const double t = part.x + (part.y - part.x) * ((k + 0.5) / count);
            const dvec3 point = a + t * (b - a);
            if (skip_covered) {
                const int row = static_cast<int>(std::floor(point.y)), pixel = static_cast<int>(std::floor(point.x));
                const PixelSpan covered = covered_pixels(triangle, row, frame.cells[triangle.axis_x]);
                if (pixel >= covered.first && pixel <= covered.last) continue;
            }
            add_sample(frame, triangle.unprojected(point), index, samples);
        }
    }
}

/// Whether pixel centres alone would leave gaps along the triangle: long, and less than a pixel wide or pointed.
bool is_thin(const Projection& triangle) {
    double longest = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
        const dvec3 edge = triangle.corners[(i + 1) % 3] - triangle.corners[i];
        longest = std::max(longest, std::hypot(edge.x, edge.y));
    }
    return longest > 2.0 && std::abs(triangle.doubled_area) < longest * std::max(1.0, 0.25 * longest);
}

void sample_triangle(const GridFrame& frame, const std::array<dvec3, 3>& corners, std::uint32_t index,
                     SampleList& samples) {
    const Projection triangle = project(corners);
    const bool any = triangle.doubled_area != 0.0 && add_pixel_centres(frame, triangle, index, samples);
    if (any && !is_thin(triangle)) return;
    if (!any) add_sample(frame, (corners[0] + corners[1] + corners[2]) / 3.0, index, samples);
    const bool in_one_cell =
        glm::floor(corners[0]) == glm::floor(corners[1]) && glm::floor(corners[0]) == glm::floor(corners[2]);
    if (!in_one_cell) add_edges(frame, triangle, index, any, samples);
}

void add_triangle(const GridFrame& frame, const Scene& scene, std::uint32_t index, SampleList& samples) {
    const uvec3 vertices = scene.triangles[index];
    std::array<dvec3, 3> world, corners;
    for (int i = 0; i < 3; ++i) {
        const auto k = static_cast<std::size_t>(i);
        world[k] = dvec3(scene.positions[vertices[i]]);
        corners[k] = (world[k] - frame.lowest) * frame.cells_per_metre;
    }
    // Animations can pose vertices nowhere; clipping such edges would not end.
    const dvec3 sum = corners[0] + corners[1] + corners[2];
    if (!std::isfinite(sum.x + sum.y + sum.z)) return;
    sample_triangle(frame, corners, index, samples);
    samples.finish_triangle(0.5 * glm::length(glm::cross(world[1] - world[0], world[2] - world[0])));
}

/// The samples of one chunk of triangles by layer: those of layer k are [starts[k], starts[k + 1]), in triangle order.
struct Chunk {
    std::vector<Sample> samples;
    std::vector<std::uint32_t> starts;

    std::span<const Sample> layer(std::size_t k) const {
        return {samples.data() + starts[k], samples.data() + starts[k + 1]};
    }
};

/// Stable counting sort.
Chunk sorted_by_layer(const std::vector<Sample>& samples, std::size_t layers) {
    Chunk chunk{std::vector<Sample>(samples.size()), std::vector<std::uint32_t>(layers + 1, 0)};
    for (const Sample& sample : samples) ++chunk.starts[sample.layer + 1];
    for (std::size_t k = 0; k < layers; ++k) chunk.starts[k + 1] += chunk.starts[k];
    std::vector<std::uint32_t> next(chunk.starts.begin(), chunk.starts.end() - 1);
    for (const Sample& sample : samples) chunk.samples[next[sample.layer]++] = sample;
    return chunk;
}

/// Keeps the first sample of each cell of one layer, with the area of all.
struct LayerCells {
    std::vector<std::uint64_t> occupied;  ///< one bit a cell
    std::vector<Fragment> kept;           ///< [cells]; valid where the bit is set

    explicit LayerCells(std::size_t cells) : occupied((cells + 63) / 64, 0), kept(cells) {}

    void add(const Sample& sample) {
        std::uint64_t& word = occupied[sample.cell_in_layer / 64u];
        const std::uint64_t bit = std::uint64_t{1} << (sample.cell_in_layer % 64u);
        if (word & bit) {
            kept[sample.cell_in_layer].area_m2 += sample.fragment.area_m2;
            return;
        }
        word |= bit;
        kept[sample.cell_in_layer] = sample.fragment;
    }
    /// Appends the kept fragments by cell, and forgets them.
    void take(std::vector<Fragment>& fragments) {
        for (std::size_t word = 0; word < occupied.size(); ++word) {
            for (std::uint64_t bits = std::exchange(occupied[word], 0); bits != 0; bits &= bits - 1)
                fragments.push_back(kept[word * 64 + static_cast<std::size_t>(std::countr_zero(bits))]);
        }
    }
};

}  // namespace

std::vector<Fragment> surface_fragments(const Scene& scene, const FragmentGrid& grid, int threads, Progress& progress) {
    assert(grid.cells.x > 0 && grid.cells.y > 0 && grid.cells.z > 0);
    if (scene.triangles.empty() || grid.box.empty()) return {};
    const GridFrame frame = grid_frame(grid);
    const std::size_t triangles = scene.triangles.size(), layers = static_cast<std::size_t>(grid.cells.z);
    std::vector<Chunk> chunks((triangles + triangles_per_chunk - 1) / triangles_per_chunk);
    std::vector<std::vector<Fragment>> slabs((layers + layers_per_slab - 1) / layers_per_slab);
    progress.begin("sampling the surface", static_cast<std::int64_t>(chunks.size() + slabs.size()));
    parallel_for(static_cast<std::int64_t>(chunks.size()), threads, [&](std::int64_t chunk) {
        const std::size_t first = static_cast<std::size_t>(chunk) * triangles_per_chunk;
        const std::size_t end = std::min(first + triangles_per_chunk, triangles);
        SampleList list;
        for (std::size_t i = first; i < end; ++i) add_triangle(frame, scene, static_cast<std::uint32_t>(i), list);
        chunks[chunk] = sorted_by_layer(list.samples, layers);
        progress.advance();
    });
    const std::size_t cells_per_layer = static_cast<std::size_t>(grid.cells.x) * static_cast<std::size_t>(grid.cells.y);
    parallel_for(static_cast<std::int64_t>(slabs.size()), threads, [&](std::int64_t slab) {
        const std::size_t first = static_cast<std::size_t>(slab) * layers_per_slab;
        LayerCells cells(cells_per_layer);
        for (std::size_t layer = first; layer < std::min(first + layers_per_slab, layers); ++layer) {
            for (const Chunk& chunk : chunks) {
                for (const Sample& sample : chunk.layer(layer)) cells.add(sample);
            }
            cells.take(slabs[slab]);
        }
        progress.advance();
    });
    std::size_t total = 0;
    for (const auto& slab : slabs) total += slab.size();
    std::vector<Fragment> fragments;
    fragments.reserve(total);
    for (const auto& slab : slabs) fragments.insert(fragments.end(), slab.begin(), slab.end());
    return fragments;
}

vec3 winding_normal(const Scene& scene, std::uint32_t triangle) {
    const uvec3 corners = scene.triangles[triangle];
    const vec3 a = scene.positions[corners.x];
    const vec3 normal = glm::cross(scene.positions[corners.y] - a, scene.positions[corners.z] - a);
    const float length = glm::length(normal);
    return length > 0.0f ? normal / length : vec3(0.0f);
}

}  // namespace sightlines
