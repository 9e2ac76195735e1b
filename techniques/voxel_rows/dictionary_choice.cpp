#include "techniques/voxel_rows/dictionary_choice.h"

#include <algorithm>
#include <utility>

#include "techniques/base/parallel.h"

namespace sightlines::voxel_rows {
namespace {

constexpr std::size_t most_deals = 1024;
constexpr int coarsest_group = 2;  ///< down-sampled by 4

/// A distinct row on its way to those that are like it.
template <int length>
struct DealtRow {
    RowBits<length> row;
    std::uint32_t count, id;
};

/// Rows that are alike down-sampled.
struct Group {
    std::uint64_t count = 0;        ///< of all of them together
    std::uint32_t best_plus_1 = 0;  ///< the most frequent one; 0: a free place
};

template <int length>
bool more_frequent(const DealtRow<length>& a, const DealtRow<length>& b) {
    if (a.count != b.count) return a.count > b.count;
    const std::uint64_t hash_a = hash_row(a.row), hash_b = hash_row(b.row);
    return hash_a != hash_b ? hash_a < hash_b : a.row < b.row;
}

/// Adds each group's worth to the worth of its most frequent row.
template <int length>
void add_worth_of_groups(std::span<const DealtRow<length>> rows, int step, std::span<std::uint32_t> worth_of_id) {
    std::vector<Group> groups(std::bit_ceil(2 * rows.size() + 1));
    std::vector<RowBits<length>> keys(groups.size());
    for (std::uint32_t k = 0; k < rows.size(); ++k) {
        const RowBits<length> key = simplify(rows[k].row, step);
        std::size_t at = hash_row(key) & (groups.size() - 1);
        while (groups[at].best_plus_1 != 0 && keys[at] != key) at = (at + 1) & (groups.size() - 1);
        Group& group = groups[at];
        keys[at] = key;
        group.count += rows[k].count;
        if (group.best_plus_1 == 0 || more_frequent(rows[k], rows[group.best_plus_1 - 1])) group.best_plus_1 = k + 1;
    }
    for (const Group& group : groups) {
        if (group.best_plus_1 == 0) continue;
        std::uint32_t& worth = worth_of_id[rows[group.best_plus_1 - 1].id];
        const std::uint64_t more = worth + worth_of_group[step] * group.count;
        worth = static_cast<std::uint32_t>(std::min<std::uint64_t>(more, ~0u));
    }
}

/// Deals the distinct rows out by their hashes down-sampled by 4, so that each group comes together; [deals + 1] is
/// where each deal begins.
template <int length>
std::vector<std::size_t> deal_groups(const RowHistogram<length>& histogram, std::size_t deals, int threads,
                                     std::vector<DealtRow<length>>& dealt, Progress& progress) {
    const auto parts = static_cast<std::int64_t>(histogram.parts.size());
    const auto deal_of = [&](const RowBits<length>& row) {
        return (hash_row(simplify(row, coarsest_group)) >> 32u) & (deals - 1);
    };
    std::vector<std::uint32_t> places(histogram.parts.size() * deals);
    parallel_for(parts, threads, [&](std::int64_t part) {
        std::uint32_t* own = &places[static_cast<std::size_t>(part) * deals];
        for (const RowBits<length>& row : histogram.parts[static_cast<std::size_t>(part)].rows) ++own[deal_of(row)];
        progress.advance();
    });
    std::vector<std::size_t> first(deals + 1);
    std::uint32_t place = 0;
    for (std::size_t deal = 0; deal < deals; ++deal) {
        first[deal] = place;
        for (std::size_t part = 0; part < histogram.parts.size(); ++part)
            place += std::exchange(places[part * deals + deal], place);
    }
    first[deals] = place;
    dealt.resize(place);
    parallel_for(parts, threads, [&](std::int64_t index) {
        const auto& part = histogram.parts[static_cast<std::size_t>(index)];
        std::uint32_t* next = &places[static_cast<std::size_t>(index) * deals];
        for (std::uint32_t k = 0; k < part.rows.size(); ++k)
            dealt[next[deal_of(part.rows[k])]++] = {part.rows[k], part.counts[k], part.first_id + k};
        progress.advance();
    });
    return first;
}

/// What each distinct row is worth: [histogram.ids].
template <int length>
std::vector<std::uint32_t> worth_of_ids(const RowHistogram<length>& histogram, const DictionaryOptions& options,
                                        Progress& progress) {
    std::vector<std::uint32_t> worth(histogram.ids);
    for (const DistinctRows<length>& part : histogram.parts) {
        progress.check();
        std::ranges::copy(part.counts, worth.begin() + part.first_id);
    }
    if (options.choice == DictionaryChoice::frequent) return worth;
    const std::size_t deals = std::min(std::bit_ceil(histogram.distinct / 32768 + 1), most_deals);
    std::vector<DealtRow<length>> dealt;
    const std::vector<std::size_t> first = deal_groups(histogram, deals, options.threads, dealt, progress);
    parallel_for(static_cast<std::int64_t>(deals), options.threads, [&](std::int64_t index) {
        const auto deal = static_cast<std::size_t>(index);
        const auto rows = std::span<const DealtRow<length>>(dealt).subspan(first[deal], first[deal + 1] - first[deal]);
        for (int step = 1; step <= coarsest_group; ++step) add_worth_of_groups<length>(rows, step, worth);
        progress.check();
    });
    return worth;
}

/// The lowest worth among the n worthiest rows, as far as worths below 2^16 tell.
std::uint32_t least_worth(std::span<const std::uint32_t> worth, std::uint32_t n, const Progress& progress) {
    constexpr std::uint32_t highest = (1u << 16u) - 1;
    std::vector<std::uint64_t> rows_of_worth(highest + 1);
    for (std::size_t id = 0; id < worth.size(); ++id) {
        if (id % (1u << 20u) == 0) progress.check();
        ++rows_of_worth[std::min(worth[id], highest)];
    }
    std::uint64_t rows = 0;
    std::uint32_t least = highest;
    for (; least > 1; --least) {
        rows += rows_of_worth[least];
        if (rows >= n) break;
    }
    return least;
}

}  // namespace

template <int length>
std::vector<ChosenRow<length>> choose_rows(const RowHistogram<length>& histogram, const DictionaryOptions& options,
                                           Progress& progress) {
    progress.begin("choosing the dictionary", 2 * static_cast<std::int64_t>(histogram.parts.size()));
    const std::vector<std::uint32_t> worth = worth_of_ids(histogram, options, progress);
    const std::uint32_t least = least_worth(worth, options.rows, progress);
    std::vector<ChosenRow<length>> chosen;
    for (const DistinctRows<length>& part : histogram.parts) {
        progress.check();
        for (std::uint32_t k = 0; k < part.rows.size(); ++k)
            if (worth[part.first_id + k] >= least)
                chosen.push_back({part.rows[k], hash_row(part.rows[k]), part.counts[k], part.first_id + k});
    }
    std::uint32_t compared = 0;
    const auto by = [&](auto number_of) {
        return [&, number_of](const ChosenRow<length>& a, const ChosenRow<length>& b) {
            if (++compared % (1u << 16u) == 0) progress.check();  // sorting takes longer than whoever cancels waits
            if (number_of(a) != number_of(b)) return number_of(a) > number_of(b);
            return a.hash != b.hash ? a.hash < b.hash : a.row < b.row;
        };
    };
    if (chosen.size() > options.rows) {
        std::ranges::nth_element(chosen, chosen.begin() + options.rows,
                                 by([&](const ChosenRow<length>& row) { return worth[row.id]; }));
        chosen.resize(options.rows);
    }
    std::ranges::sort(chosen, by([](const ChosenRow<length>& row) { return row.count; }));
    return chosen;
}

template std::vector<ChosenRow<1>> choose_rows(const RowHistogram<1>&, const DictionaryOptions&, Progress&);
template std::vector<ChosenRow<2>> choose_rows(const RowHistogram<2>&, const DictionaryOptions&, Progress&);
template std::vector<ChosenRow<4>> choose_rows(const RowHistogram<4>&, const DictionaryOptions&, Progress&);
template std::vector<ChosenRow<8>> choose_rows(const RowHistogram<8>&, const DictionaryOptions&, Progress&);

}  // namespace sightlines::voxel_rows
