#include "echopath/signal/synthesizer.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>

#include "echopath/base/errors.h"
#include "echopath/base/kept_memory.h"
#include "echopath/base/large_array.h"
#include "echopath/base/parallel.h"
#include "echopath/base/simd.h"
#include "echopath/signal/kernels/carrier.h"
#include "echopath/signal/methods/method.h"
#include "echopath/signal/methods/per_sample.h"

namespace echopath {
namespace {

constexpr int64_t kRecurrenceLimit = 40;  // echoes below which the recurrence beats the FFT of a NUFFT row
// Tasks of chirps own whole groups of this many, whose echoes are read once.
constexpr int kChirpGroup = TileAtChirps::kMaxChirps;
constexpr int kGroupsPerTask = 8;        // at most; fewer where that would leave threads without work
constexpr int64_t kStillParts = 16;      // at most, of echoes at rest; their number must not depend on the threads
constexpr int64_t kEchoesOfPart = 2048;  // at least, for each group: adding up the parts must cost little

Method choose_method(Method asked, int64_t expected_echoes) {
  if (asked != Method::kAuto) return asked;
  return expected_echoes < kRecurrenceLimit ? Method::kRecurrence : Method::kNufft;
}

ECHOPATH_INLINE void find_not_finite(const double* values, int64_t count, int64_t* bad) {
  int64_t found = 0;
  for (int64_t i = 0; i < count; ++i) found |= !(std::abs(values[i]) <= std::numeric_limits<double>::max());
  *bad = found;
}

ECHOPATH_INLINE void add_values(const double* values, int64_t count, double* __restrict sum) {
  for (int64_t i = 0; i < count; ++i) sum[i] += values[i];
}

void require_finite(const double* values, size_t count, const char* name) {
  int64_t found = 0;
  run_simd<find_not_finite>(values, static_cast<int64_t>(count), &found);
  if (!found) return;
  const double* bad = std::find_if(values, values + count, [](double value) { return !std::isfinite(value); });
  require(false, name, "must be finite", *bad);
}

void validate_sampling(const TimeSampling& sampling, int num_chirps) {
  const size_t chirps = static_cast<size_t>(num_chirps);
  require(sampling.num_rows >= 1, "sampling.num_rows", "must be at least 1", sampling.num_rows);
  require(sampling.order >= 1 && sampling.order <= sampling.num_rows, "sampling.order", "must be in [1, num_rows]",
          sampling.order);
  require(sampling.first_row.size() == chirps, "sampling.first_row", "must have one entry per chirp",
          sampling.first_row.size());
  const size_t weights = chirps * sampling.order;
  require(sampling.value.size() == weights, "sampling.value", "must have shape [chirps, order]", sampling.value.size());
  require(sampling.slope.size() == weights, "sampling.slope", "must have shape [chirps, order]", sampling.slope.size());
  for (const int node : sampling.first_row) {
    require(node >= 0 && node <= sampling.num_rows - sampling.order, "sampling.first_row",
            "must leave `order` rows in range", node);
  }
  require_finite(sampling.value.data(), weights, "sampling.value");
  require_finite(sampling.slope.data(), weights, "sampling.slope");
  for (const std::vector<double>* rows : {&sampling.second_derivative, &sampling.third_derivative}) {
    const char* name = rows == &sampling.second_derivative ? "sampling.second_derivative" : "sampling.third_derivative";
    require(rows->size() == sampling.second_derivative.size(), name, "must be empty only where the other is, values",
            rows->size());
    require(rows->empty() || rows->size() == weights, name, "must be empty or have shape [chirps, order]", rows->size());
    require_finite(rows->data(), rows->size(), name);
  }
}

// The bits of the result do not depend on it, because every chirp takes all echoes in their order.
int chirps_per_task(int num_chirps) {
  const int groups = (num_chirps + kChirpGroup - 1) / kChirpGroup;
  return kChirpGroup * std::clamp(groups / (2 * num_threads()), 1, kGroupsPerTask);
}

void run_tasks(int num_chirps, const std::function<void(int first, int count)>& work) {
  const int size = chirps_per_task(num_chirps);
  parallel_for((num_chirps + size - 1) / size, [&](int64_t task) {
    const int first = static_cast<int>(task) * size;
    work(first, std::min(size, num_chirps - first));
  });
}

bool same_sampling(const TimeSampling& a, const TimeSampling& b) {
  return a.num_rows == b.num_rows && a.order == b.order && a.first_row == b.first_row && a.value == b.value &&
         a.slope == b.slope;
}

// Returns how many blocks from the first on share its sampling.
size_t run_of_one_sampling(std::span<const Echoes> blocks) {
  size_t count = 1;
  while (count < blocks.size() && same_sampling(blocks[count].sampling, blocks.front().sampling)) ++count;
  return count;
}

}  // namespace

struct Synthesizer::RowMemory {
  std::unique_ptr<double[]> values;
  size_t room = 0;

  size_t num_bytes() const { return room * sizeof(double); }
  // With room for `count` values, which are not set.
  static std::unique_ptr<RowMemory> take(size_t count) {
    std::unique_ptr<RowMemory> rows = KeptMemory::of_process().take<RowMemory>(count * sizeof(double));
    if (rows->room >= count) return rows;
    *rows = {};
    *rows = {std::make_unique_for_overwrite<double[]>(count), count};
    prefer_large_pages(rows->values.get(), rows->num_bytes());
    return rows;
  }
};

Synthesizer::Synthesizer(const ChirpSequence& waveform, int num_channels, int num_groups, int64_t expected_echoes,
                         const SynthesisOptions& options)
    : waveform_(waveform), num_groups_(num_groups), method_(choose_method(options.method, expected_echoes)) {
  waveform.validate();
  require(num_channels >= 1, "num_channels", "must be at least 1", num_channels);
  require(num_groups >= 1, "num_groups", "must be at least 1", num_groups);
  require(expected_echoes >= 0, "expected_echoes", "must not be negative", expected_echoes);
  require(options.tolerance >= 1e-13 && options.tolerance <= 0.1, "tolerance", "must be in [1e-13, 0.1]", options.tolerance);
  if (method_ == Method::kNufft) {
    const auto nufft = make_nufft(waveform.num_samples, options.tolerance);
    spread_ = options.per_sample ? nullptr : nufft.get();
    tones_ = nufft;
  } else {
    tones_ = method_ == Method::kDirect ? make_direct(waveform.num_samples) : make_recurrence(waveform.num_samples);
  }
  model_ = std::make_unique<CarrierModel>(waveform, tones_->reference_sample());
  if (options.per_sample) {
    sample_rows_ = make_direct(waveform.num_samples);
    per_sample_ = std::make_unique<PerSample>(waveform, *model_);
  }
  const auto groups = static_cast<size_t>(num_groups);
  for (int channel = 0; channel < num_channels; ++channel) {
    channels_.push_back({std::vector<std::unique_ptr<RowMemory>>(groups), std::vector<std::vector<double>>(groups)});
  }
}

Synthesizer::~Synthesizer() {
  KeptMemory& kept = KeptMemory::of_process();
  for (ChannelRows& channel : channels_) {
    for (std::unique_ptr<RowMemory>& rows : channel.moving) kept.leave(std::move(rows));
  }
  for (std::unique_ptr<RowBands>& bands : bands_) kept.leave(std::move(bands));
  leave_scratch();
}
Synthesizer::Synthesizer(Synthesizer&&) noexcept = default;

void Synthesizer::leave_scratch() { KeptMemory::of_process().leave(std::move(tiles_)); }

void Synthesizer::validate(const Echoes& block) const {
  validate_sampling(block.sampling, waveform_.num_chirps);
  require(block.num_echoes >= 0, "num_echoes", "must not be negative", block.num_echoes);
  const size_t echoes = static_cast<size_t>(block.num_echoes);
  const size_t values = echoes * block.sampling.num_rows;
  require(block.delay.size() == values, "delay", "must have shape [num_rows, num_echoes]", block.delay.size());
  require(block.amplitude.size() == values, "amplitude", "must have shape [num_rows, num_echoes]", block.amplitude.size());
  require(block.group.empty() || block.group.size() == echoes, "group", "must be empty or have one entry per echo",
          block.group.size());
  for (const uint32_t group : block.group) {
    require(group < static_cast<uint32_t>(num_groups_), "group", "must be below num_groups", group);
  }
  require_finite(block.delay.data(), values, "delay");
  require_finite(reinterpret_cast<const double*>(block.amplitude.data()), 2 * values, "amplitude");
}

// Returns the number of doubles of one row, both parts.
int64_t Synthesizer::row_size(bool moving) const {
  return 2 * (moving && sample_rows_ ? sample_rows_ : tones_)->row_length();
}

void Synthesizer::add(int channel, std::span<const Echoes> blocks, Job* job) {
  require_channel(channel);
  parallel_for(static_cast<int64_t>(blocks.size()), [&](int64_t i) { validate(blocks[static_cast<size_t>(i)]); });
  while (!blocks.empty()) {
    const std::span<const Echoes> run = blocks.first(run_of_one_sampling(blocks));
    if (run.front().sampling.is_static()) {
      add_still(run, channels_[static_cast<size_t>(channel)], job);
    } else {
      add_moving(run, channel, job);
    }
    if (job) {
      for (const Echoes& block : run) job->advance(block.num_echoes);
    }
    blocks = blocks.subspan(run.size());
  }
}

namespace {

// Returns [num_groups], 1 for groups that have echoes.
std::vector<uint8_t> groups_of(std::span<const Echoes> blocks, int num_groups) {
  std::vector<uint8_t> has_echoes(static_cast<size_t>(num_groups));
  for (const Echoes& block : blocks) {
    if (block.group.empty() && block.num_echoes > 0) has_echoes[0] = 1;
    for (const uint32_t group : block.group) has_echoes[group] = 1;
  }
  return has_echoes;
}

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
  std::vector<std::vector<double>> parts(static_cast<size_t>(num_parts));
  parallel_for(num_parts, [&](int64_t i) {
    std::vector<double>& part = parts[static_cast<size_t>(i)];
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
    std::unique_ptr<RowMemory>& of_group = channels_[static_cast<size_t>(channel)].moving[group];
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
    bands_.back()->start(channels_.size() * static_cast<size_t>(num_groups_), chirps_of_piece(piece));
  }
}

size_t Synthesizer::band_row(int channel, int group) const {
  return static_cast<size_t>(channel) * static_cast<size_t>(num_groups_) + static_cast<size_t>(group);
}

namespace {

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

void Synthesizer::add_to_bands(const TimeSampling& sampling, int channel, Range chirps, Job* job) {
  for (const EchoTiles::Tile& tile : tiles_->tiles()) {
    if (job) job->throw_if_cancelled();
    for (int64_t chirp = chirps.begin; chirp < chirps.end; chirp += kChirpGroup) {
      BandRow row{*bands_[static_cast<size_t>(chirp / kChirpGroup)], band_row(channel, static_cast<int>(tile.group))};
      add_tile(tile, sampling, {chirp, std::min(chirp + kChirpGroup, chirps.end)}, {rows_of_band, &row});
    }
  }
}

// Returns the delay of the last cell.
double Synthesizer::longest_delay() const { return waveform_.sampling_rate / waveform_.slope(); }

void Synthesizer::add_tiles(const TimeSampling& sampling, Range chirps, const RowsOfGroups& rows, Job* job) const {
  const int64_t stride = row_size(true);
  for (const EchoTiles::Tile& tile : tiles_->tiles()) {
    if (job) job->throw_if_cancelled();
    for (int64_t chirp = chirps.begin; chirp < chirps.end; chirp += kChirpGroup) {
      TileRows there{rows[tile.group] + chirp * stride, stride / 2, stride};
      add_tile(tile, sampling, {chirp, std::min(chirp + kChirpGroup, chirps.end)}, {rows_given, &there});
    }
  }
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
                        &sampling.first_row[static_cast<size_t>(chirps.begin)],
                        &sampling.value[weights],
                        &sampling.slope[weights]};
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

void Synthesizer::require_channel(int channel) const {
  if (channel >= 0 && channel < static_cast<int>(channels_.size())) return;
  throw std::out_of_range("channel: must be in [0, " + std::to_string(channels_.size()) + "), got " +
                          std::to_string(channel));
}

size_t Synthesizer::group_bytes() const {
  return channels_.size() * static_cast<size_t>(row_size(true) * waveform_.num_chirps) * sizeof(double);
}

void Synthesizer::require_group(int group) const {
  if (group >= 0 && group < num_groups_) return;
  throw std::out_of_range("group: must be in [0, " + std::to_string(num_groups_) + "), got " + std::to_string(group));
}

bool Synthesizer::has_echoes(int channel, int group) const { return !is_still(channel, group) || has_still(channel, group); }

bool Synthesizer::has_still(int channel, int group) const {
  require_channel(channel);
  require_group(group);
  return !channels_[static_cast<size_t>(channel)].still[static_cast<size_t>(group)].empty();
}

bool Synthesizer::is_still(int channel, int group) const {
  require_channel(channel);
  require_group(group);
  if (!bands_.empty()) return !bands_.front()->has(band_row(channel, group));
  return !channels_[static_cast<size_t>(channel)].moving[static_cast<size_t>(group)];
}

RowCells Synthesizer::moving_cells(int channel, int group, int chirp) const {
  if (!bands_.empty()) {
    return bands_[static_cast<size_t>(chirp / kChirpGroup)]->cells(band_row(channel, group), chirp % kChirpGroup);
  }
  const RowMemory& rows = *channels_[static_cast<size_t>(channel)].moving[static_cast<size_t>(group)];
  const int64_t size = row_size(true);
  const double* const row = rows.values.get() + chirp * size;
  return {0, size / 2, row, row + size / 2};
}

// Returns the row [re/im, row length] of a group with moving echoes, which may be made in `room`.
const double* Synthesizer::moving_row(int channel, int group, int chirp, std::vector<double>& room) const {
  const RowCells cells = moving_cells(channel, group, chirp);
  if (2 * cells.count == row_size(true)) return cells.re;
  room.assign(static_cast<size_t>(row_size(true)), 0.0);
  add_moving_row(channel, group, chirp, room.data());
  return room.data();
}

// Adds to a row [re/im, row length].
void Synthesizer::add_moving_row(int channel, int group, int chirp, double* row) const {
  const RowCells cells = moving_cells(channel, group, chirp);
  run_simd<add_values>(cells.re, cells.count, row + cells.first);
  run_simd<add_values>(cells.im, cells.count, row + row_size(true) / 2 + cells.first);
}

void Synthesizer::write_samples(int channel, std::span<const int> groups, std::complex<double>* out) const {
  const int64_t num_samples = waveform_.num_samples;
  std::vector<std::complex<double>> at_rest(static_cast<size_t>(num_samples)), of_group(at_rest.size());
  std::vector<int> moving;
  for (const int group : groups) {
    if (!is_still(channel, group)) moving.push_back(group);
    if (!has_still(channel, group)) continue;
    write_row(channels_[static_cast<size_t>(channel)].still[static_cast<size_t>(group)].data(), false, of_group.data());
    for (size_t n = 0; n < at_rest.size(); ++n) at_rest[n] += of_group[n];
  }
  std::vector<double> row(static_cast<size_t>(row_size(true)));
  for (int chirp = 0; chirp < waveform_.num_chirps; ++chirp, out += num_samples) {
    std::fill(row.begin(), row.end(), 0.0);
    for (const int group : moving) add_moving_row(channel, group, chirp, row.data());
    if (moving.empty()) std::fill_n(out, num_samples, 0.0);
    else write_row(row.data(), true, out);
    for (size_t n = 0; n < at_rest.size(); ++n) out[n] += at_rest[n];
  }
}

void Synthesizer::absorb(const Synthesizer& other, int num_groups) {
  require(num_groups_ == 1, "num_groups", "must be 1 of what absorbs others", num_groups_);
  parallel_for(static_cast<int64_t>(channels_.size()), [&](int64_t channel) {
    for (int group = 0; group < num_groups; ++group) absorb_group(other, static_cast<int>(channel), group);
  });
}

void Synthesizer::absorb_group(const Synthesizer& other, int channel, int group) {
  ChannelRows& to = channels_[static_cast<size_t>(channel)];
  const std::vector<double>& still = other.channels_[static_cast<size_t>(channel)].still[static_cast<size_t>(group)];
  if (!still.empty()) to.still.front().resize(still.size());
  for (size_t i = 0; i < still.size(); ++i) to.still.front()[i] += still[i];
  if (other.is_still(channel, group)) return;
  const int64_t size = row_size(true);
  const auto count = static_cast<size_t>(size * waveform_.num_chirps);
  std::unique_ptr<RowMemory>& moving = to.moving.front();
  if (!moving) {
    moving = RowMemory::take(count);
    std::fill_n(moving->values.get(), count, 0.0);
  }
  for (int chirp = 0; chirp < waveform_.num_chirps; ++chirp) {
    other.add_moving_row(channel, group, chirp, moving->values.get() + chirp * size);
  }
}

size_t Synthesizer::num_band_bytes() const {
  size_t bytes = 0;
  for (const std::unique_ptr<RowBands>& bands : bands_) bytes += bands->num_bytes();
  return bytes;
}

std::vector<std::complex<double>> Synthesizer::cube(int group, Job* job) const {
  require_group(group);
  const size_t channel_size = static_cast<size_t>(waveform_.num_chirps) * static_cast<size_t>(waveform_.num_samples);
  std::vector<std::complex<double>> out(channels_.size() * channel_size);
  for (size_t channel = 0; channel < channels_.size(); ++channel) {
    write_channel(static_cast<int>(channel), group, out.data() + channel * channel_size, job);
  }
  return out;
}

// Adds to `out`, zeros [chirp, sample], the samples of one channel and group.
void Synthesizer::write_channel(int channel, int group, std::complex<double>* out, Job* job) const {
  const bool moves = !is_still(channel, group);
  const std::vector<double>& still = channels_[static_cast<size_t>(channel)].still[static_cast<size_t>(group)];
  if (!moves && still.empty()) return;
  const int64_t num_samples = waveform_.num_samples;
  std::vector<std::complex<double>> at_rest(static_cast<size_t>(num_samples));
  if (!still.empty()) write_row(still.data(), false, at_rest.data());
  parallel_for(waveform_.num_chirps, [&](int64_t chirp) {
    if (job) job->throw_if_cancelled();
    std::complex<double>* samples = out + chirp * num_samples;
    std::vector<double> room;
    if (moves) write_row(moving_row(channel, group, static_cast<int>(chirp), room), true, samples);
    for (int64_t n = 0; n < num_samples; ++n) samples[n] += at_rest[static_cast<size_t>(n)];
  });
}

void Synthesizer::write_row(const double* row, bool moving, std::complex<double>* out) const {
  (moving && sample_rows_ ? sample_rows_ : tones_)->samples(row, out);
  if (!waveform_.real) return;
  for (int n = 0; n < waveform_.num_samples; ++n) out[n] = {std::numbers::sqrt2 * out[n].real(), 0.0};
}

}  // namespace echopath
