// What opens over the panes: the list of keys, the lists of files, and the message line.
#include <algorithm>
#include <array>
#include <system_error>

#include <imgui.h>
#include <imgui_stdlib.h>

#include "app/desk/autosave.h"
#include "app/workbench/actions.h"
#include "app/workbench/panes.h"
#include "app/workbench/widgets.h"
#include "techniques/base/error.h"
#include "techniques/base/files.h"
#include "techniques/scene/environment.h"

namespace sightlines {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_files = 500;

/// A key or a gesture: how at the left, what at the right of the column.
void key_line(const Frame& frame, const std::string& how, const std::string& what, float how_width) {
    const float left = ImGui::GetCursorPosX();
    text_in(frame.fonts.small, frame.colours.accent, how);
    ImGui::SameLine();
    ImGui::SetCursorPosX(left + how_width);
    text_in(frame.fonts.small, frame.colours.ink, what);
}

void draw_key_group(const Frame& frame, std::string_view group, float how_width) {
    text_in(frame.fonts.text_bold, frame.colours.ink, group);
    for (const Action& action : actions())
        if (action.group == group) key_line(frame, keys_text(action), std::string(action.title), how_width);
    for (const Gesture& gesture : gestures())
        if (gesture.group == group) key_line(frame, std::string(gesture.how), std::string(gesture.what), how_width);
    ImGui::Dummy({0.0f, 8.0f * frame.scale});
}

void draw_keys(Frame& frame) {
    constexpr std::array<std::array<std::string_view, 3>, 2> groups{
        {{"The selected ray", "View", "Session"}, {"Image", "Window", ""}}};
    float how_width = 0.0f, what_width = 0.0f;
    for (const Action& action : actions()) {
        how_width = std::max(how_width, width_of(frame.fonts.small, keys_text(action)));
        what_width = std::max(what_width, width_of(frame.fonts.small, action.title));
    }
    for (const Gesture& gesture : gestures()) {
        how_width = std::max(how_width, width_of(frame.fonts.small, gesture.how));
        what_width = std::max(what_width, width_of(frame.fonts.small, gesture.what));
    }
    how_width += 16.0f * frame.scale;
    const float column = how_width + what_width + 24.0f * frame.scale;
    const ImVec2 room = ImGui::GetMainViewport()->WorkSize;
    const bool two = 2.0f * column + 48.0f * frame.scale < room.x;
    ImGui::BeginChild("keys", {(two ? 2.0f : 1.0f) * column,
                               std::min((two ? 640.0f : 1200.0f) * frame.scale, room.y - 128.0f * frame.scale)});
    for (std::size_t i = 0; i < groups.size(); ++i) {
        if (two && i > 0) ImGui::SameLine();
        ImGui::BeginGroup();
        for (const std::string_view group : groups[i])
            if (!group.empty()) draw_key_group(frame, group, how_width);
        if (two) ImGui::Dummy({column - 16.0f * frame.scale, 0.0f});
        ImGui::EndGroup();
    }
    ImGui::EndChild();
}

struct Listed {
    fs::path path;
    bool is_folder = false;
};

/// What lies in `folder`: folders first, then files of the given extensions, by name. Hidden ones are left out.
std::vector<Listed> listed(const fs::path& folder, std::span<const std::string_view> extensions) {
    std::vector<Listed> all;
    std::error_code error;
    for (fs::directory_iterator entry(folder, fs::directory_options::skip_permission_denied, error), end;
         !error && entry != end && all.size() < most_files; entry.increment(error)) {
        const fs::path path = entry->path();
        std::error_code unknown;
        const bool is_folder = entry->is_directory(unknown);
        if (path.filename().string().starts_with('.')) continue;
        if (is_folder || std::ranges::find(extensions, path.extension().string()) != extensions.end())
            all.push_back({path, is_folder});
    }
    std::ranges::sort(all, [](const Listed& a, const Listed& b) {
        return a.is_folder != b.is_folder ? a.is_folder : a.path.filename() < b.path.filename();
    });
    return all;
}

/// The list of files and the typed path; the chosen file, once there is one.
std::optional<fs::path> draw_files(Frame& frame, std::span<const std::string_view> extensions, const char* verb) {
    Ui& ui = frame.ui;
    std::optional<fs::path> chosen;
    const ImVec2 window = ImGui::GetMainViewport()->WorkSize;
    const float width = std::min(640.0f * frame.scale, window.x - 64.0f * frame.scale);
    elided_text(frame.fonts.small, frame.colours.muted, ui.folder.string(), width);
    ImGui::BeginChild("files", {width, std::min(320.0f * frame.scale, window.y - 240.0f * frame.scale)}, true);
    std::optional<fs::path> entered;
    if (ui.folder.has_parent_path() && ImGui::Selectable("..", false, ImGuiSelectableFlags_DontClosePopups))
        entered = ui.folder.parent_path();
    for (const Listed& file : listed(ui.folder, extensions)) {
        const std::string name = file.path.filename().string() + (file.is_folder ? "/" : "");
        if (!ImGui::Selectable(name.c_str(), ui.typed_path == file.path.string(),
                               ImGuiSelectableFlags_DontClosePopups | ImGuiSelectableFlags_AllowDoubleClick))
            continue;
        if (file.is_folder)
            entered = file.path;
        else
            ui.typed_path = file.path.string();
        if (!file.is_folder && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) chosen = file.path;
    }
    if (entered) ui.folder = *entered;
    ImGui::EndChild();
    ImGui::SetNextItemWidth(width - 176.0f * frame.scale);
    if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
    const bool enter = ImGui::InputText("##path", &ui.typed_path, ImGuiInputTextFlags_EnterReturnsTrue);
    ImGui::SameLine();
    if ((ImGui::Button(verb, {80.0f * frame.scale, 0.0f}) || enter) && !ui.typed_path.empty()) chosen = ui.typed_path;
    ImGui::SameLine();
    if (ImGui::Button("Cancel", {80.0f * frame.scale, 0.0f})) ImGui::CloseCurrentPopup();
    if (chosen) ImGui::CloseCurrentPopup();
    return chosen;
}

/// Does what the dialog is for; an error becomes the message.
void use_file(Frame& frame, Dialog dialog, fs::path file) {
    try {
        if (dialog == Dialog::open_scene) {
            open_scene(frame, file.string());
        } else if (dialog == Dialog::open_environment) {
            open_environment(frame, file);
        } else if (dialog == Dialog::open_session) {
            frame.next = load_session(file);
        } else {
            if (file.extension() != ".json") file += ".json";
            save_session(file, frame.session);
            frame.ui.message = Message{"Saved as " + file.string(), false};
        }
    } catch (const std::runtime_error& error) {
        frame.ui.message = Message{error.what(), true};
    }
}

struct DialogRow {
    Dialog dialog;
    const char *title, *verb;
};
constexpr std::array<DialogRow, 5> dialogs{{{Dialog::keys, "Keys and mouse", ""},
                                            {Dialog::open_scene, "Open a scene", "Open"},
                                            {Dialog::open_session, "Open a session", "Open"},
                                            {Dialog::save_session, "Save the session as", "Save"},
                                            {Dialog::open_environment, "Open an environment", "Open"}}};

void draw_dialog(Frame& frame, const DialogRow& row) {
    constexpr std::array<std::string_view, 2> scenes{".gltf", ".glb"};
    constexpr std::array<std::string_view, 1> sessions{".json"};
    if (row.dialog == Dialog::keys) {
        draw_keys(frame);
        if (ImGui::Button("Close", {80.0f * frame.scale, 0.0f})) ImGui::CloseCurrentPopup();
        return;
    }
    constexpr std::array<std::string_view, 1> pictures{".hdr"};
    const auto extensions = row.dialog == Dialog::open_scene         ? std::span<const std::string_view>(scenes)
                            : row.dialog == Dialog::open_environment ? std::span<const std::string_view>(pictures)
                                                                     : std::span<const std::string_view>(sessions);
    if (const auto file = draw_files(frame, extensions, row.verb)) use_file(frame, row.dialog, *file);
}

}  // namespace

void open_scene(Frame& frame, const std::string& scene) {
    frame.ui.message.reset();
    try_scene(frame.background, scene);
}

void open_environment(Frame& frame, const fs::path& file) {
    try {
        read_environment(file);
        frame.next.environment.file = file.string();
        frame.ui.message.reset();
    } catch (const std::runtime_error& error) {
        frame.ui.message = Message{error.what(), true};
    }
}

void draw_dialogs(Frame& frame) {
    const Dialog asked = std::exchange(frame.ui.dialog, Dialog::none);
    frame.ui.opened_dialog = Dialog::none;
    for (const DialogRow& row : dialogs) {
        if (asked == row.dialog) {
            ImGui::OpenPopup(row.title);
            frame.ui.typed_path.clear();
            std::error_code error;
            if (frame.ui.folder.empty()) frame.ui.folder = fs::current_path(error);
        }
        const ImVec2 window = ImGui::GetMainViewport()->WorkSize;
        ImGui::SetNextWindowPos({0.5f * window.x, 0.5f * window.y}, ImGuiCond_Always, {0.5f, 0.5f});
        if (!ImGui::BeginPopupModal(
                row.title, nullptr,
                ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings))
            continue;
        frame.ui.opened_dialog = row.dialog;
        draw_dialog(frame, row);
        if (frame.escape) ImGui::CloseCurrentPopup();
        ImGui::EndPopup();
    }
}

void draw_message(Frame& frame, const Area& top_bar) {
    std::string text;
    bool is_error = true, closable = false;
    if (frame.ui.message) {
        text = frame.ui.message->text;
        is_error = frame.ui.message->is_error;
        closable = true;
    } else if (frame.shown.picture_failure) {
        text = frame.shown.picture_failure->message;
    }
    if (text.empty()) return;
    const float width = std::min(720.0f * frame.scale, top_bar.size.x - 32.0f * frame.scale);
    const float close = closable ? 32.0f * frame.scale : 0.0f, padding = 12.0f * frame.scale;
    const float wrap = width - close - 3.0f * padding;
    const ImVec2 extent = frame.fonts.text->CalcTextSizeA(frame.fonts.text->FontSize, 1.0e9f, wrap, text.c_str());
    const Area area{{0.5f * (top_bar.size.x - width), top_bar.end().y + 8.0f * frame.scale},
                    {width, extent.y + 2.0f * padding}};
    begin_area(frame, "message", area, frame.colours.raised, {12.0f, 12.0f}, Layer::above,
               ImGuiWindowFlags_NoScrollbar);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.PushClipRectFullScreen();
    list.AddRectFilled(to_imgui(area.corner), {area.corner.x + 4.0f * frame.scale, area.end().y},
                       is_error ? frame.colours.wrong : frame.colours.good);
    list.PopClipRect();
    ImGui::PushTextWrapPos(padding + wrap);
    text_in(frame.fonts.text, frame.colours.ink, text);
    ImGui::PopTextWrapPos();
    if (closable) {
        ImGui::SetCursorPos({width - close - 4.0f * frame.scale, 0.5f * (area.size.y - ImGui::GetFrameHeight())});
        if (icon_button(frame, "close message", Icon::close)) frame.ui.message.reset();
    }
    ImGui::End();
}

}  // namespace sightlines
