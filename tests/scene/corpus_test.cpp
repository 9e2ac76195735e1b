// The third-party corpus with a verdict for each file: every row, one test.
#include <algorithm>
#include <cctype>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "tests/scene/gltf_testing.h"

namespace sightlines {
namespace {

const std::string corpus_folder = std::string(SIGHTLINES_SHARED_FOLDER) + "/corpus/";

struct Row {
    std::string file, expected, kind, extensions_required;
};

void PrintTo(const Row& row, std::ostream* stream) { *stream << row.file; }

std::vector<Row> corpus_rows() {
    std::ifstream table(corpus_folder + "index.tsv");
    std::vector<Row> rows;
    std::string line;
    std::getline(table, line);
    while (std::getline(table, line)) {
        std::vector<std::string> cells;
        std::istringstream stream(line);
        for (std::string cell; std::getline(stream, cell, '\t');) cells.push_back(cell);
        if (cells.size() == 7) rows.push_back({cells[0], cells[1], cells[5], cells[6]});
    }
    if (rows.empty()) rows.push_back({});  // one row that says what is absent
    return rows;
}

struct Outcome {
    bool loaded = false;
    std::string message;
};

/// Anything else than success or InputError fails the test by its exception.
Outcome outcome_of(const std::string& file) {
    try {
        Progress progress;
        const SceneModel model = load_gltf(corpus_folder + file, progress);
        for (const double time_s : {0.0, 0.5 * model.duration_s, model.duration_s}) {
            const Scene scene = model.at(time_s);
            EXPECT_EQ(scene.triangles.size(), scene.triangle_materials.size());
            EXPECT_EQ(scene.positions.size(), scene.normals.size());
            EXPECT_FALSE(scene.cameras.empty());
            EXPECT_FALSE(scene.materials.empty());
            for (const uvec3& triangle : scene.triangles)
                EXPECT_LT(std::max({triangle.x, triangle.y, triangle.z}), scene.positions.size());
            EXPECT_TRUE(!scene.triangles.empty() || !scene.notes.empty()) << "an empty scene says why";
        }
        return {true, ""};
    } catch (const InputError& error) {
        return {false, error.what()};
    }
}

class Corpus : public testing::TestWithParam<Row> {};

TEST_P(Corpus, GetsTheVerdictOfTheTable) {
    const Row& row = GetParam();
    if (row.file.empty()) GTEST_SKIP() << corpus_folder << "index.tsv is absent";
    const Outcome outcome = outcome_of(row.file);
    if (row.kind == "structural" || row.kind == "missing-resource") {
        EXPECT_FALSE(outcome.loaded) << row.file;
        EXPECT_EQ(outcome.message.find('\n'), std::string::npos) << outcome.message;
    } else if (row.expected == "loads" && row.extensions_required == "-") {
        EXPECT_TRUE(outcome.loaded) << row.file << ": " << outcome.message;
    }
    RecordProperty("message", outcome.message);
}

std::string row_name(const testing::TestParamInfo<Row>& row) {
    std::string name = std::to_string(row.index) + "_" + row.param.kind + "_" + row.param.file;
    for (char& letter : name)
        if (std::isalnum(static_cast<unsigned char>(letter)) == 0) letter = '_';
    return name;
}

INSTANTIATE_TEST_SUITE_P(Table, Corpus, testing::ValuesIn(corpus_rows()), row_name);

}  // namespace
}  // namespace sightlines
