// The table of a pixel's light rays: ours, the truth, the distance, and where they differ.
#include <algorithm>
#include <array>
#include <numeric>

#include "app/table.h"
#include "app/workbench/panes.h"
#include "app/workbench/widgets.h"

namespace sightlines {
namespace {

struct ColumnRow {
    RayColumn column;
    const char* title;
    const char* about;
    float weight;
    bool right;  ///< numbers stand at the right
};
constexpr std::array<ColumnRow, 5> columns{{
    {RayColumn::light, "Light", "The light's number", 0.8f, true},
    {RayColumn::ours, "Ours", "What the technique answers", 1.15f, false},
    {RayColumn::truth, "Truth", "What Embree answers", 1.15f, false},
    {RayColumn::distance, "Distance", "From the surface to the light", 1.15f, true},
    {RayColumn::error, "Error", "A false shadow, or light that leaks through", 1.75f, false},
}};

/// Narrow panes say the same in fewer letters.
const char* verdict(bool blocked, bool narrow) { return !blocked ? "open" : narrow ? "blkd" : "blocked"; }

const char* error_text(const RayRow& row, bool narrow) {
    if (narrow) return "";
    return row.blocked ? "shadow" : "leak";
}

/// Design pixels below which the table is narrow.
constexpr float narrow_width = 320.0f;

/// Rows in the order that the session asks for; equal ones by light.
std::vector<std::size_t> sorted_rows(const PixelRays& rays, RayColumn column, bool descending) {
    const auto key = [&](std::size_t i) -> float {
        const RayRow& row = rays.rows[i];
        switch (column) {
            case RayColumn::light:
                return static_cast<float>(row.light);
            case RayColumn::ours:
                return row.blocked ? 1.0f : 0.0f;
            case RayColumn::truth:
                return row.truly_blocked ? 1.0f : 0.0f;
            case RayColumn::distance:
                return row.distance_m;
            // Wrong ones first, then the blocked: there is more to see on them.
            case RayColumn::error:
                break;
        }
        return row.wrong() ? 2.0f : row.blocked ? 1.0f : 0.0f;
    };
    std::vector<std::size_t> order(rays.rows.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(
        order, [&](std::size_t a, std::size_t b) { return descending ? key(a) > key(b) : key(a) < key(b); });
    return order;
}

void draw_heading(Frame& frame) {
    Workbench& look = frame.next.workbench;
    ImGui::TableNextRow(ImGuiTableRowFlags_Headers);
    for (const ColumnRow& column : columns) {
        ImGui::TableNextColumn();
        const bool sorted = look.sorted_by == column.column;
        const bool number = column.column == RayColumn::light && lit_by_environment(frame.session);
        std::string text = number ? "Sample" : column.title;
        if (sorted) text += look.descending ? " ▼" : " ▲";
        const float width = ImGui::GetContentRegionAvail().x;
        const ImVec2 corner = ImGui::GetCursorPos();
        if (ImGui::InvisibleButton(column.title,
                                   {std::max(width, 1.0f), frame.fonts.small->FontSize + 6.0f * frame.scale})) {
            look.descending = sorted ? !look.descending : column.column == RayColumn::error;
            look.sorted_by = column.column;
        }
        const bool hovered = ImGui::IsItemHovered();
        tooltip(frame, std::string(number ? "The sample's number" : column.about) + ". Click to sort.");
        const std::string shown = elided(frame.fonts.small, text, width);
        ImGui::SetCursorPos({column.right ? corner.x + width - width_of(frame.fonts.small, shown) : corner.x,
                             corner.y + 2.0f * frame.scale});
        text_in(frame.fonts.small, hovered || sorted ? frame.colours.ink : frame.colours.muted, shown);
    }
}

/// One row; true when it was clicked.
bool draw_row(const Frame& frame, const RayRow& row, bool selected, bool narrow) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    const ImU32 ink = selected ? frame.colours.ink : frame.colours.muted;
    ImFont* mono = frame.fonts.mono;
    ImGui::PushID(static_cast<int>(row.light));
    const ImVec2 start = ImGui::GetCursorPos();
    const bool clicked =
        ImGui::Selectable("##row", selected, ImGuiSelectableFlags_SpanAllColumns, {0.0f, mono->FontSize});
    ImGui::PopID();
    const std::string light = std::to_string(row.light);
    ImGui::SetCursorPos({start.x + ImGui::GetColumnWidth() - width_of(mono, light), start.y});
    text_in(mono, ink, light);
    ImGui::TableNextColumn();
    text_in(frame.fonts.text, ink, verdict(row.blocked, narrow));
    ImGui::TableNextColumn();
    text_in(frame.fonts.text, ink, verdict(row.truly_blocked, narrow));
    ImGui::TableNextColumn();
    const std::string distance = fixed_text(static_cast<double>(row.distance_m), 2) + (narrow ? "" : " m");
    text_right(mono, ink, distance, ImGui::GetCursorPosX() + ImGui::GetContentRegionAvail().x);
    ImGui::TableNextColumn();
    if (row.wrong()) {
        const ImVec2 at = ImGui::GetCursorScreenPos();
        const float radius = 3.5f * frame.scale;
        ImGui::GetWindowDrawList()->AddCircleFilled({at.x + radius, at.y + 0.5f * mono->FontSize + 1.0f}, radius,
                                                    frame.colours.wrong);
        ImGui::SetCursorPosX(ImGui::GetCursorPosX() + 3.5f * radius);
        text_in(frame.fonts.text, frame.colours.wrong, error_text(row, narrow));
    }
    return clicked;
}

}  // namespace

std::optional<std::uint32_t> neighbouring_ray(const Frame& frame, int offset) {
    if (!frame.shown.rays || !frame.shown.ray) return std::nullopt;
    const Workbench& look = frame.session.workbench;
    const PixelRays& rays = *frame.shown.rays;
    const auto order = sorted_rows(rays, look.sorted_by, look.descending);
    const std::uint32_t now = frame.next.selection.light.value_or(frame.shown.ray->light);
    const auto at = std::ranges::find_if(order, [&](std::size_t i) { return rays.rows[i].light == now; });
    const std::ptrdiff_t next = (at - order.begin()) + offset;
    if (at == order.end() || next < 0 || next >= std::ssize(order)) return std::nullopt;
    return rays.rows[order[static_cast<std::size_t>(next)]].light;
}

namespace {

/// Brings the row of a newly selected ray into view.
void scroll_to_selected(Frame& frame, const PixelRays& rays, std::span<const std::size_t> order,
                        std::uint32_t selected) {
    if (frame.ui.scrolled_ray == selected) return;
    frame.ui.scrolled_ray = selected;
    const auto at = std::ranges::find_if(order, [&](std::size_t i) { return rays.rows[i].light == selected; });
    const float row_height = frame.fonts.mono->FontSize + 2.0f * ImGui::GetStyle().CellPadding.y;
    const float top = static_cast<float>(at - order.begin()) * row_height;
    if (top < ImGui::GetScrollY() || top + 3.0f * row_height > ImGui::GetScrollY() + ImGui::GetWindowHeight())
        ImGui::SetScrollY(std::max(0.0f, top - 0.4f * ImGui::GetWindowHeight()));
}

void draw_table(Frame& frame, const PixelRays& rays, bool narrow) {
    if (!ImGui::BeginTable("rays", static_cast<int>(columns.size()),
                           ImGuiTableFlags_ScrollY | ImGuiTableFlags_SizingStretchProp | ImGuiTableFlags_PadOuterX))
        return;
    for (const ColumnRow& column : columns)
        ImGui::TableSetupColumn(
            column.title, ImGuiTableColumnFlags_WidthStretch,
            column.weight * (lit_by_environment(frame.session) && &column == columns.begin() ? 1.4f : 1.0f));
    ImGui::TableSetupScrollFreeze(0, 1);
    draw_heading(frame);
    const Workbench& look = frame.session.workbench;
    const auto order = sorted_rows(rays, look.sorted_by, look.descending);
    const std::uint32_t selected =
        frame.shown.ray ? frame.session.selection.light.value_or(frame.shown.ray->light) : no_triangle;
    scroll_to_selected(frame, rays, order, selected);
    ImGuiListClipper clipper;
    clipper.Begin(static_cast<int>(order.size()));
    while (clipper.Step())
        for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
            const RayRow& row = rays.rows[order[static_cast<std::size_t>(i)]];
            if (draw_row(frame, row, row.light == selected, narrow)) select_light(frame, row.light);
        }
    ImGui::EndTable();
}

}  // namespace

void draw_rays(Frame& frame) {
    if (frame.shown.ray_failure) return empty_pane_text(frame, "No ray to show", ray_failure_text(frame));
    if (!frame.shown.rays)
        return empty_pane_text(frame, "The rays of a pixel appear here",
                               lit_by_environment(frame.session)
                                   ? "Click a point of the image: each of its samples of the environment is one ray."
                                   : "Click a point of the image: each light in front of it is one ray.");
    const bool narrow = ImGui::GetContentRegionAvail().x < narrow_width * frame.scale;
    const float padding = narrow ? 3.0f * frame.scale : ImGui::GetStyle().CellPadding.x;
    ImGui::PushStyleVar(ImGuiStyleVar_CellPadding, ImVec2(padding, ImGui::GetStyle().CellPadding.y));
    draw_table(frame, *frame.shown.rays, narrow);
    ImGui::PopStyleVar();
}

void draw_rays_controls(Frame& frame, float right) {
    if (!frame.shown.rays || frame.shown.ray_failure) return;
    const PixelRays& rays = *frame.shown.rays;
    const auto wrong = std::ranges::count_if(rays.rows, &RayRow::wrong);
    ImGui::AlignTextToFramePadding();
    elided_text(frame.fonts.small, frame.colours.muted,
                count_text(static_cast<std::uint64_t>(wrong)) + " of " + count_text(rays.rows.size()) +
                    " wrong at pixel " + std::to_string(rays.pixel.x) + ", " + std::to_string(rays.pixel.y),
                right - ImGui::GetCursorPosX());
}

}  // namespace sightlines
