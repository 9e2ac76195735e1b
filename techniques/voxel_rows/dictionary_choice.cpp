#include "techniques/voxel_rows/dictionary_choice.h"

#include <algorithm>

#include "techniques/base/parallel.h"
#include "techniques/base/parallel_sort.h"

namespace sightlines::voxel_rows {
namespace {

constexpr int coarsest_group = 2;  ///< down-sampled by 4
constexpr std::uint32_t most_worth = ~0u;

/// Rows of one deal that are alike down-sampled.
template <int length>
struct Group {
    RowBits<length> key;
    std::uint32_t count = 0;        ///< of all of them together
    std::uint32_t best_plus_1 = 0;  ///< the most frequent one's place in the deal; 0: a free place
};

template <int length>
bool is_more_frequent(const DealtRow<length>& a, const DealtRow<length>& b) {
    if (a.count != b.count) return a.count > b.count;
    const std::uint64_t hash_a = hash_row(a.row), hash_b = hash_row(b.row);
    return hash_a != hash_b ? hash_a < hash_b : a.row < b.row;
}

/// Adds each group's worth to the worth of its most frequent row. worth: [rows of the deal].
template <int length>
void add_worth_of_groups(const RowDeals<length>& rows, std::size_t deal, int step, std::span<std::uint32_t> worth) {
    std::vector<Group<length>> groups(std::bit_ceil(2 * worth.size() + 1));
    for (std::uint32_t k = 0; k < worth.size(); ++k) {
        const DealtRow<length> row = rows[rows.first[deal] + k];
        const RowBits<length> key = simplify(row.row, step);
        std::size_t at = hash_row(key) & (groups.size() - 1);
        while (groups[at].best_plus_1 != 0 && groups[at].key != key) at = (at + 1) & (groups.size() - 1);
        Group<length>& group = groups[at];
        if (group.best_plus_1 == 0 || is_more_frequent(row, rows[rows.first[deal] + group.best_plus_1 - 1])) {
            group.key = key;
            group.best_plus_1 = k + 1;
        }
        group.count += row.count;
    }
    for (const Group<length>& group : groups) {
        if (group.best_plus_1 == 0) continue;
        std::uint32_t& of_best = worth[group.best_plus_1 - 1];
        const std::uint64_t more = of_best + worth_of_group[step] * group.count;
        of_best = static_cast<std::uint32_t>(std::min<std::uint64_t>(more, most_worth));
    }
}

/// What each row is worth: [rows.rows()].
template <int length>
HugeBuffer worth_of_rows(const RowDeals<length>& rows, const DictionaryOptions& options, Progress& progress) {
    HugeBuffer worth = allocate_huge(rows.rows());
    parallel_for(static_cast<std::int64_t>(rows.deals()), options.threads, [&](std::int64_t index) {
        const auto deal = static_cast<std::size_t>(index);
        const std::size_t first = rows.first[deal];
        const auto own = worth.words.subspan(first, rows.first[deal + 1] - first);
        for (std::size_t k = 0; k < own.size(); ++k) own[k] = rows[first + k].count;
        if (options.choice == DictionaryChoice::covering)
            for (int step = 1; step <= coarsest_group; ++step) add_worth_of_groups(rows, deal, step, own);
        progress.advance();
    });
    return worth;
}

/// Some of the rows, for one thread.
struct Slice {
    std::size_t first_row, end_row;
};

/// All rows, in so many slices that no thread waits long for another.
template <int length>
std::vector<Slice> slices_of(const RowDeals<length>& rows) {
    constexpr std::size_t count = 32;
    std::vector<Slice> slices;
    for (std::size_t k = 0; k < count; ++k) slices.push_back({rows.rows() * k / count, rows.rows() * (k + 1) / count});
    return slices;
}

/// The lowest worth among the n worthiest rows, as far as worths below 2^16 tell.
std::uint32_t least_worth(std::span<const std::uint32_t> worth, std::span<const Slice> slices,
                          const DictionaryOptions& options, const Progress& progress) {
    constexpr std::uint32_t highest = (1u << 16u) - 1;
    std::vector<std::vector<std::uint32_t>> rows_of_worth(slices.size());
    parallel_for(static_cast<std::int64_t>(slices.size()), options.threads, [&](std::int64_t index) {
        progress.check();
        const Slice& slice = slices[static_cast<std::size_t>(index)];
        auto& own = rows_of_worth[static_cast<std::size_t>(index)];
        own.resize(highest + 1);
        for (std::size_t place = slice.first_row; place < slice.end_row; ++place)
            ++own[std::min(worth[place], highest)];
    });
    std::uint64_t rows = 0;
    std::uint32_t least = highest;
    for (; least > 1; --least) {
        for (const auto& of_slice : rows_of_worth) rows += of_slice[least];
        if (rows >= options.rows) break;
    }
    return least;
}

/// All rows that are worth at least so much.
template <int length>
std::vector<ChosenRow<length>> rows_worth(std::uint32_t least, const RowDeals<length>& rows,
                                          std::span<const std::uint32_t> worth, std::span<const Slice> slices,
                                          const DictionaryOptions& options, const Progress& progress) {
    std::vector<std::vector<ChosenRow<length>>> of_slice(slices.size());
    parallel_for(static_cast<std::int64_t>(slices.size()), options.threads, [&](std::int64_t index) {
        progress.check();
        const Slice& slice = slices[static_cast<std::size_t>(index)];
        for (std::size_t place = slice.first_row; place < slice.end_row; ++place) {
            if (worth[place] < least) continue;
            const DealtRow<length> row = rows[place];
            of_slice[static_cast<std::size_t>(index)].push_back({row.row, hash_row(row.row), row.count, worth[place]});
        }
    });
    std::vector<ChosenRow<length>> taken;
    for (const auto& own : of_slice) taken.insert(taken.end(), own.begin(), own.end());
    return taken;
}

}  // namespace

template <int length>
std::vector<ChosenRow<length>> choose_rows(const RowDeals<length>& rows, const DictionaryOptions& options,
                                           Progress& progress) {
    progress.begin("choosing the dictionary", static_cast<std::int64_t>(rows.deals()));
    const HugeBuffer worth = worth_of_rows(rows, options, progress);
    const std::vector<Slice> slices = slices_of(rows);
    const std::uint32_t least = least_worth(worth.words, slices, options, progress);
    std::vector<ChosenRow<length>> chosen = rows_worth(least, rows, worth.words, slices, options, progress);
    // Sorting takes longer than whoever cancels waits.
    const auto by = [&](auto number) {
        return [&progress, number](const ChosenRow<length>& a, const ChosenRow<length>& b) {
            progress.check();
            if (a.*number != b.*number) return a.*number > b.*number;
            return a.hash != b.hash ? a.hash < b.hash : a.row < b.row;
        };
    };
    if (chosen.size() > options.rows) {
        std::ranges::nth_element(chosen, chosen.begin() + options.rows, by(&ChosenRow<length>::worth));
        chosen.resize(options.rows);
    }
    sort_in_parallel(chosen, options.threads, by(&ChosenRow<length>::count));
    return chosen;
}

template std::vector<ChosenRow<1>> choose_rows(const RowDeals<1>&, const DictionaryOptions&, Progress&);
template std::vector<ChosenRow<2>> choose_rows(const RowDeals<2>&, const DictionaryOptions&, Progress&);
template std::vector<ChosenRow<4>> choose_rows(const RowDeals<4>&, const DictionaryOptions&, Progress&);
template std::vector<ChosenRow<8>> choose_rows(const RowDeals<8>&, const DictionaryOptions&, Progress&);

}  // namespace sightlines::voxel_rows
