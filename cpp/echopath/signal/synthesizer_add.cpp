// The part of the synthesizer that adds echoes to the rows of their channels.
#include <algorithm>
#include <cmath>
#include <functional>

#include "echopath/base/threads/parallel.h"
#include "echopath/signal/kernels/carrier.h"
#include "echopath/signal/methods/method.h"
#include "echopath/signal/methods/per_sample.h"
#include "echopath/signal/row_memory.h"

namespace echopath {
namespace {

constexpr int kGroupsPerTask = 8;        // at most; fewer where that would leave threads without work
constexpr int64_t kStillParts = 16;      // at most, of echoes at rest; their number must not depend on the threads
constexpr int64_t kEchoesOfPart = 2048;  // at least, for each group: adding up the parts must cost little

// The bits of the result do not depend on it, because every chirp takes all echoes in their order.
int chirps_per_task(int num_chirps) {
  const int groups = (num_chirps + kChirpGroup - 1) / kChirpGroup;
  return kChirpGroup * std::clamp(groups / (2 * num_threads()), 1, kGroupsPerTask);
}

void run_tasks(int num_chirps, const std::function<void(int first, int count)>& work) {
  parallel_for_chunks(num_chirps, chirps_per_task(num_chirps),
                      [&](int64_t begin, int64_t end) { work(static_cast<int>(begin), static_cast<int>(end - begin)); });
}

// Returns [num_groups], 1 for groups that have echoes.
std::vector<uint8_t> groups_of(std::span<const Echoes> blocks, int num_groups) {
  std::vector<uint8_t> has_echoes(num_groups);
  for (const Echoes& block : blocks) {
    if (block.group.empty() && block.num_echoes > 0) has_echoes[0] = 1;
    for (const uint32_t group : block.group) has_echoes[group] = 1;
  }
  return has_echoes;
}

// Names a row of the bands of some chirps.
struct BandRow {
  RowBands& bands;
  size_t row;
};

TileRows rows_of_band(void* of, const CellRange& cells) {
  const auto* band = static_cast<const BandRow*>(of);
  return band->bands.room(band->row, cells);
}

TileRows rows_given(void* of, const CellRange& /*cells*/) { return *static_cast<const TileRows*>(of); }

}  // namespace

// Adds echoes at rest in a number of parts that does not depend on the threads; each part has rows of its own, which are
// added in order.
void Synthesizer::add_still(std::span<const Echoes> blocks, ChannelRows& rows, Job* job) const {
  int64_t total = 0;
  for (const Echoes& block : blocks) total += block.num_echoes;
  const auto size = static_cast<size_t>(row_size(false)), num_groups = static_cast<size_t>(num_groups_);
  const std::vector<uint8_t> has_echoes = groups_of(blocks, num_groups_);
  RowsOfGroups whole(num_groups);
  for (size_t group = 0; group < num_groups; ++group) {
    if (!has_echoes[group]) continue;
    rows.still[group].resize(size);
    whole[group] = rows.still[group].data();
  }
  const int64_t num_parts = std::min(total / (kEchoesOfPart * num_groups_), kStillParts);
  if (num_parts <= 1) return add_still_part(blocks, {0, total}, whole, job);
  std::vector<std::vector<double>> parts(num_parts);
  parallel_for(num_parts, [&](int64_t i) {
    std::vector<double>& part = parts[i];
    part.resize(size * num_groups);
    RowsOfGroups of_part(num_groups);
    for (size_t group = 0; group < num_groups; ++group) of_part[group] = part.data() + group * size;
    add_still_part(blocks, {i * total / num_parts, (i + 1) * total / num_parts}, of_part, job);
  });
  for (const std::vector<double>& part : parts) {
    for (size_t group = 0; group < num_groups; ++group) {
      for (size_t i = 0; whole[group] && i < size; ++i) whole[group][i] += part[group * size + i];
    }
  }
}

// `part` counts the echoes of all blocks, one block after the other.
void Synthesizer::add_still_part(std::span<const Echoes> blocks, Range part, const RowsOfGroups& rows, Job* job) const {
  int64_t first = 0;
  for (const Echoes& block : blocks) {
    const Range here{std::max<int64_t>(part.begin - first, 0), std::min(part.end - first, block.num_echoes)};
    if (here.begin < here.end) add_rows(block, here, {0, 1}, rows, job);
    first += block.num_echoes;
  }
}

// Each task clears its own chirps in the rows of groups that are new.
void Synthesizer::add_moving(std::span<const Echoes> blocks, int channel, Job* job) {
  const TimeSampling& sampling = blocks.front().sampling;
  if (spread_) assign_tiles(blocks);
  if (has_bands()) {
    if (bands_.empty()) start_bands();
    return run_tasks(waveform_.num_chirps,
                     [&](int first, int count) { add_to_bands(sampling, channel, {first, first + count}, job); });
  }
  const std::vector<uint8_t> has_echoes = groups_of(blocks, num_groups_);
  const int64_t size = row_size(true);
  RowsOfGroups all(has_echoes.size()), fresh;
  for (size_t group = 0; group < all.size(); ++group) {
    if (!has_echoes[group]) continue;
    std::unique_ptr<RowMemory>& of_group = channels_[channel].moving[group];
    const bool is_new = !of_group;
    if (is_new) of_group = RowMemory::take(static_cast<size_t>(size * waveform_.num_chirps));
    all[group] = of_group->values.get();
    if (is_new) fresh.push_back(all[group]);
  }
  run_tasks(waveform_.num_chirps, [&](int first, int count) {
    for (double* const values : fresh) std::fill_n(values + first * size, count * size, 0.0);
    const Range chirps{first, first + count};
    if (spread_) return add_tiles(sampling, chirps, all, job);
    for (const Echoes& block : blocks) add_rows(block, {0, block.num_echoes}, chirps, all, job);
  });
}

void Synthesizer::assign_tiles(std::span<const Echoes> blocks) {
  if (!tiles_) {
    tiles_ = KeptMemory::of_process().take<EchoTiles>();
    tiles_->forget();
  }
  tiles_->assign(blocks, num_groups_, longest_delay(), static_cast<int>(spread_->spreading().grid_size));
}

int Synthesizer::chirps_of_piece(int piece) const {
  return std::min(kChirpGroup, waveform_.num_chirps - piece * kChirpGroup);
}

void Synthesizer::start_bands() {
  const int num_pieces = (waveform_.num_chirps + kChirpGroup - 1) / kChirpGroup;
  for (int piece = 0; piece < num_pieces; ++piece) {
    bands_.push_back(KeptMemory::of_process().take<RowBands>());
    bands_.back()->start(channels_.size(), static_cast<size_t>(num_groups_), chirps_of_piece(piece), row_size(true) / 2);
  }
}

size_t Synthesizer::band_row(int channel, int group) const {
  return static_cast<size_t>(channel) * static_cast<size_t>(num_groups_) + static_cast<size_t>(group);
}

// Calls `add(tile, chirps)` for each tile at up to kChirpGroup chirps at a time.
template <class Add>
void Synthesizer::for_tiles(Range chirps, Job* job, const Add& add) const {
  for (const EchoTiles::Tile& tile : tiles_->tiles()) {
    if (job) job->throw_if_cancelled();
    for (int64_t chirp = chirps.begin; chirp < chirps.end; chirp += kChirpGroup)
      add(tile, Range{chirp, std::min(chirp + kChirpGroup, chirps.end)});
  }
}

void Synthesizer::add_to_bands(const TimeSampling& sampling, int channel, Range chirps, Job* job) {
  for_tiles(chirps, job, [&](const EchoTiles::Tile& tile, Range here) {
    BandRow row{*bands_[here.begin / kChirpGroup], band_row(channel, static_cast<int>(tile.group))};
    add_tile(tile, sampling, here, {rows_of_band, &row});
  });
}

// Returns the delay of the last cell.
double Synthesizer::longest_delay() const { return waveform_.sampling_rate / std::abs(waveform_.slope()); }

void Synthesizer::add_tiles(const TimeSampling& sampling, Range chirps, const RowsOfGroups& rows, Job* job) const {
  const int64_t stride = row_size(true);
  for_tiles(chirps, job, [&](const EchoTiles::Tile& tile, Range here) {
    TileRows there{rows[tile.group] + here.begin * stride, stride / 2, stride};
    add_tile(tile, sampling, here, {rows_given, &there});
  });
}

// Adds a tile at up to kChirpGroup chirps.
void Synthesizer::add_tile(const EchoTiles::Tile& tile, const TimeSampling& sampling, Range chirps,
                           const RowRoom& room) const {
  const auto weights = static_cast<size_t>(chirps.begin * sampling.order);
  const TileAtChirps at{tiles_->nodes(tile),
                        tile.count,
                        sampling.num_rows,
                        sampling.order,
                        static_cast<int>(chirps.end - chirps.begin),
                        &sampling.first_row[chirps.begin],
                        &sampling.value[weights],
                        &sampling.slope[weights],
                        sampling.rows == TimeSampling::Rows::kLogarithms};
  signal_kernels().add_tile(*model_, spread_->spreading(), at, room);
}

// Every chirp takes all echoes in their order, in blocks that do not depend on the tasks, so the bits are always the same.
void Synthesizer::add_rows(const Echoes& block, Range echoes, Range chirps, const RowsOfGroups& rows, Job* job) const {
  const int64_t stride = row_size(!block.sampling.is_static());
  for (int64_t begin = echoes.begin; begin < echoes.end; begin += Carriers::kCapacity) {
    if (job) job->throw_if_cancelled();
    const int count = static_cast<int>(std::min<int64_t>(Carriers::kCapacity, echoes.end - begin));
    for (int64_t chirp = chirps.begin; chirp < chirps.end; ++chirp) {
      add_some(block, static_cast<int>(chirp), begin, count, {rows.data(), chirp * stride});
    }
  }
}

void Synthesizer::add_some(const Echoes& block, int chirp, int64_t begin, int count, Rows rows) const {
  if (per_sample_ && !block.sampling.is_static()) {
    per_sample_->add(block, chirp, begin, count, sample_rows_->row_length(), rows);
    return;
  }
  Carriers carriers;
  evaluate_carriers(*model_, block, chirp, begin, count, carriers);
  tones_->add(carriers, rows);
}

}  // namespace echopath
