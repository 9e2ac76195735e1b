#include "techniques/voxel_rows/row_deals.h"

#include <algorithm>
#include <span>
#include <utility>

#include "techniques/base/parallel.h"

namespace sightlines::voxel_rows {
namespace {

constexpr std::size_t most_deals = 1024;
constexpr std::size_t rows_per_deal = 32768;  ///< at least, on average
constexpr std::size_t samples_per_deal = 64;

/// Where one deal ends and the next begins: prefixes that cut the sampled ones into equal shares, ascending.
std::vector<std::uint64_t> find_cuts(std::vector<std::uint64_t> sample, std::size_t deals) {
    std::ranges::sort(sample);
    std::vector<std::uint64_t> cuts;
    for (std::size_t deal = 1; deal < deals && !sample.empty(); ++deal)
        cuts.push_back(sample[deal * sample.size() / deals]);
    cuts.erase(std::ranges::unique(cuts).begin(), cuts.end());
    return cuts;
}

/// How many cuts are at most `prefix`. By halves without branches, which nobody could foretell.
std::size_t cuts_up_to(std::span<const std::uint64_t> cuts, std::uint64_t prefix) {
    std::size_t first = 0;
    for (std::size_t count = cuts.size(); count > 0;) {
        const std::size_t half = (count + 1) / 2;
        first += cuts[first + half - 1] <= prefix ? half : 0;
        count -= half;
    }
    return first;
}

/// Where rows come from: visit(source, take) calls take(row) for each row of one of the sources.
template <class Visit>
struct Sources {
    std::size_t count;
    std::size_t rows;  ///< of all, at most
    const Visit& visit;
};

template <int length, class Visit>
RowDeals<length> deal_out(const Sources<Visit>& sources, int shift, int threads, Progress& progress,
                          const HugeBuffer& spare) {
    progress.begin("dealing out distinct rows", 3 * static_cast<std::int64_t>(sources.count));
    const auto visit_all = [&](const auto& take) {
        parallel_for(static_cast<std::int64_t>(sources.count), threads, [&](std::int64_t index) {
            const auto source = static_cast<std::size_t>(index);
            sources.visit(source, [&](const DealtRow<length>& row) { take(source, row); });
            progress.advance();
        });
    };
    const auto prefix_of = [&](const RowBits<length>& row) { return coarse_prefix(shifted(row, shift)); };

    const std::size_t most = std::min(sources.rows / rows_per_deal + 1, most_deals);
    const std::size_t sampled = std::bit_floor(sources.rows / (most * samples_per_deal) + 1) - 1;
    std::vector<std::vector<std::uint64_t>> sample(sources.count);
    visit_all([&](std::size_t source, const DealtRow<length>& row) {
        if ((row.id * 0x9e3779b9u >> 8u & sampled) == 0) sample[source].push_back(prefix_of(row.row));
    });
    std::vector<std::uint64_t> prefixes;
    for (const auto& of_source : sample) prefixes.insert(prefixes.end(), of_source.begin(), of_source.end());
    RowDeals<length> dealt;
    dealt.cuts = find_cuts(std::move(prefixes), most);

    const std::size_t deals = dealt.cuts.size() + 1;
    std::vector<std::uint32_t> places(sources.count * deals);
    std::vector<std::vector<std::uint16_t>> deal_of_row(sources.count);  // in the order in which they are visited
    visit_all([&](std::size_t source, const DealtRow<length>& row) {
        const std::size_t deal = cuts_up_to(dealt.cuts, prefix_of(row.row));
        deal_of_row[source].push_back(static_cast<std::uint16_t>(deal));
        ++places[source * deals + deal];
    });
    std::uint32_t place = 0;
    for (std::size_t deal = 0; deal < deals; ++deal) {
        dealt.first.push_back(place);
        for (std::size_t source = 0; source < sources.count; ++source)
            place += std::exchange(places[source * deals + deal], place);
    }
    dealt.first.push_back(place);
    dealt.words = reuse_huge(spare, std::size_t{place} * dealt.stride);
    dealt.memory = dealt.words.owner == spare.owner ? spare.words : dealt.words.words;
    std::vector<std::size_t> visited(sources.count);
    visit_all([&](std::size_t source, const DealtRow<length>& row) {
        const std::size_t deal = deal_of_row[source][visited[source]++];
        std::uint32_t* to = &dealt.words.words[places[source * deals + deal]++ * dealt.stride];
        to = std::ranges::copy(row.row.words, to).out;
        *to++ = row.count;
        *to++ = row.id;
        *to = row.distance;
    });
    return dealt;
}

/// Keeps the rows whose distance is at least so much, in their order, at the beginning of their memory.
template <int length>
void gather(RowDeals<length>& rows, std::uint32_t least_distance, int threads, const Progress& progress) {
    const auto words_at = [&](std::size_t place) { return rows.words.words.data() + place * rows.stride; };
    std::vector<std::size_t> kept(rows.deals());
    parallel_for(static_cast<std::int64_t>(rows.deals()), threads, [&](std::int64_t index) {
        progress.check();
        const auto deal = static_cast<std::size_t>(index);
        std::size_t to = rows.first[deal];
        for (std::size_t place = to; place < rows.first[deal + 1]; ++place)
            if (rows.distance(place) >= least_distance) std::copy_n(words_at(place), rows.stride, words_at(to++));
        kept[deal] = to - rows.first[deal];
    });
    std::size_t place = 0;
    for (std::size_t deal = 0; deal < rows.deals(); ++deal) {
        std::copy_n(words_at(std::exchange(rows.first[deal], place)), kept[deal] * rows.stride, words_at(place));
        place += kept[deal];
    }
    rows.first.back() = place;
    rows.words.words = rows.words.words.first(place * rows.stride);
}

}  // namespace

template <int length>
RowDeals<length> deal_rows(const std::vector<DistinctRows<length>>& parts, int threads, Progress& progress,
                           const HugeBuffer& spare) {
    std::size_t rows = 0;
    for (const DistinctRows<length>& part : parts) rows += part.size();
    const auto visit = [&](std::size_t index, const auto& take) {
        const DistinctRows<length>& part = parts[index];
        for (std::uint32_t k = 0; k < part.size(); ++k)
            take(DealtRow<length>{part[k], part.counts[k], part.first_id + k, 0});
    };
    return deal_out<length>(Sources<decltype(visit)>{parts.size(), rows, visit}, 0, threads, progress, spare);
}

template <int length>
RowDeals<length> deal_again(RowDeals<length> rows, int shift, std::uint32_t least_distance, int threads,
                            Progress& progress) {
    gather(rows, least_distance, threads, progress);
    const auto visit = [&](std::size_t deal, const auto& take) {
        for (std::size_t place = rows.first[deal]; place < rows.first[deal + 1]; ++place) take(rows[place]);
    };
    const auto before = static_cast<std::size_t>(rows.words.words.data() - rows.memory.data());
    const auto behind = rows.memory.subspan(before + rows.words.words.size());
    const HugeBuffer free{before > behind.size() ? rows.memory.first(before) : behind, rows.words.owner};
    auto dealt =
        deal_out<length>(Sources<decltype(visit)>{rows.deals(), rows.rows(), visit}, shift, threads, progress, free);
    if (dealt.words.owner == rows.words.owner) dealt.memory = rows.memory;
    return dealt;
}

#define SIGHTLINES_FOR_ROW_LENGTH(length)                                                                             \
    template RowDeals<length> deal_rows(const std::vector<DistinctRows<length>>&, int, Progress&, const HugeBuffer&); \
    template RowDeals<length> deal_again(RowDeals<length>, int, std::uint32_t, int, Progress&);
SIGHTLINES_FOR_ROW_LENGTH(1)
SIGHTLINES_FOR_ROW_LENGTH(2)
SIGHTLINES_FOR_ROW_LENGTH(4)
SIGHTLINES_FOR_ROW_LENGTH(8)
#undef SIGHTLINES_FOR_ROW_LENGTH

}  // namespace sightlines::voxel_rows
