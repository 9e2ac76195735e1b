#include "app/window/fonts.h"

#include <cmath>
#include <memory>
#include <string>

#include <fontconfig/fontconfig.h>
#include <ft2build.h>
#include <imgui_freetype.h>
#include FT_FREETYPE_H

#include "techniques/base/error.h"

namespace sightlines {
namespace {

// Latin-1, Greek, punctuation, super- and subscripts, letterlike, arrows, operators, brackets, box and block, geometric
// shapes, stars and ticks. In pairs, as ImGui wants them; in no order of importance.
constexpr ImWchar glyph_ranges[] = {0x0020, 0x00FF, 0x0131, 0x0131, 0x0370, 0x03FF, 0x1D62, 0x1D6A, 0x2010,
                                    0x205E, 0x2070, 0x209C, 0x2102, 0x211D, 0x2190, 0x21FF, 0x2200, 0x22FF,
                                    0x2308, 0x230B, 0x25A0, 0x25FF, 0x2605, 0x2606, 0x2713, 0x2717, 0};

struct FontFile {
    std::string path;
    int index = 0;  ///< of the face inside the file
};

struct PatternDeleter {
    void operator()(FcPattern* pattern) const { FcPatternDestroy(pattern); }
};
using Pattern = std::unique_ptr<FcPattern, PatternDeleter>;
struct ConfigurationDeleter {
    void operator()(FcConfig* configuration) const { FcConfigDestroy(configuration); }
};
using Configuration = std::unique_ptr<FcConfig, ConfigurationDeleter>;

/// The upright font nearest to what is asked for: Inter where it is installed, else what the system has in its place.
FontFile find_font(FcConfig* installed, const char* family, const char* fallback_family, int weight) {
    const Pattern wanted(FcPatternCreate());
    FcPatternAddString(wanted.get(), FC_FAMILY, reinterpret_cast<const FcChar8*>(family));
    FcPatternAddString(wanted.get(), FC_FAMILY, reinterpret_cast<const FcChar8*>(fallback_family));
    FcPatternAddInteger(wanted.get(), FC_WEIGHT, weight);
    FcPatternAddInteger(wanted.get(), FC_SLANT, FC_SLANT_ROMAN);
    FcPatternAddBool(wanted.get(), FC_SCALABLE, FcTrue);
    FcConfigSubstitute(installed, wanted.get(), FcMatchPattern);
    FcDefaultSubstitute(wanted.get());
    FcResult result = FcResultNoMatch;
    const Pattern found(FcFontMatch(installed, wanted.get(), &result));
    FcChar8* path = nullptr;
    FontFile file;
    if (!found || FcPatternGetString(found.get(), FC_FILE, 0, &path) != FcResultMatch)
        throw EnvironmentError("the fonts", "no font is installed",
                               "install the Debian packages fonts-inter and fonts-jetbrains-mono");
    FcPatternGetInteger(found.get(), FC_INDEX, 0, &file.index);
    file.path = reinterpret_cast<const char*>(path);
    return file;
}

/// What ImGui calls a font's size is the height of its line, ascent and descent; designers count the em.
float lines_per_em(const FontFile& file) {
    struct Library {
        FT_Library handle = nullptr;
        ~Library() { FT_Done_FreeType(handle); }
    } library;
    FT_Face face = nullptr;
    if (FT_Init_FreeType(&library.handle) || FT_New_Face(library.handle, file.path.c_str(), file.index, &face) ||
        face->units_per_EM == 0)
        throw EnvironmentError(file.path, "cannot be read as a font");
    return static_cast<float>(face->ascender - face->descender) / static_cast<float>(face->units_per_EM);
}

/// The typefaces of the program, with what lends them the glyphs that they lack.
struct Typeface {
    FontFile file, lender;
    float lines_per_em = 1.0f;
};

Typeface find_typeface(FcConfig* installed, const char* family, const char* fallback_family, int weight) {
    Typeface typeface;
    typeface.file = find_font(installed, family, fallback_family, weight);
    typeface.lender = find_font(installed, fallback_family, fallback_family, weight);
    typeface.lines_per_em = lines_per_em(typeface.file);
    return typeface;
}

ImFont* add_font(const Typeface& typeface, float em_pixels) {
    ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
    const float size = std::round(em_pixels * typeface.lines_per_em);
    ImFontConfig config;
    config.FontNo = typeface.file.index;
    config.OversampleH = config.OversampleV = 1;
    config.PixelSnapH = true;
    ImFont* const font = atlas.AddFontFromFileTTF(typeface.file.path.c_str(), size, &config, glyph_ranges);
    config.FontNo = typeface.lender.index;
    config.MergeMode = true;
    atlas.AddFontFromFileTTF(typeface.lender.path.c_str(), size, &config, glyph_ranges);
    return font;
}

}  // namespace

Fonts load_fonts(float scale) {
    const Configuration owned(FcInitLoadConfigAndFonts());
    FcConfig* const installed = owned.get();
    const Typeface text = find_typeface(installed, "Inter", "DejaVu Sans", FC_WEIGHT_REGULAR);
    const Typeface bold = find_typeface(installed, "Inter", "DejaVu Sans", FC_WEIGHT_DEMIBOLD);
    const Typeface mono = find_typeface(installed, "JetBrains Mono", "DejaVu Sans Mono", FC_WEIGHT_REGULAR);
    ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
    atlas.Clear();
    atlas.FontBuilderIO = ImGuiFreeType::GetBuilderForFreeType();
    // Stems snapped to whole pixels in height, shapes left alone in width: crisp lines, true letters.
    atlas.FontBuilderFlags = ImGuiFreeTypeBuilderFlags_LightHinting;
    Fonts fonts;
    fonts.text = add_font(text, 14.0f * scale);
    fonts.text_bold = add_font(bold, 14.0f * scale);
    fonts.small = add_font(text, 12.0f * scale);
    fonts.mono = add_font(mono, 13.0f * scale);
    if (!atlas.Build()) throw EnvironmentError("the fonts", "cannot be rasterised");
    atlas.ClearInputData();
    ImGui::GetIO().FontDefault = fonts.text;
    return fonts;
}

}  // namespace sightlines
