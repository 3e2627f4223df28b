// The part of the synthesizer that reads what was added: rows, samples and cubes.
#include <algorithm>
#include <numbers>
#include <stdexcept>
#include <string>

#include "echopath/base/lanes/simd.h"
#include "echopath/base/threads/parallel.h"
#include "echopath/signal/methods/method.h"
#include "echopath/signal/row_memory.h"

namespace echopath {
namespace {

ECHOPATH_INLINE void add_values(const double* values, int64_t count, double* __restrict sum) {
  for (int64_t i = 0; i < count; ++i) sum[i] += values[i];
}

}  // namespace

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
  return !channels_[channel].still[group].empty();
}

bool Synthesizer::is_still(int channel, int group) const {
  require_channel(channel);
  require_group(group);
  if (!bands_.empty()) return !bands_.front()->has(band_row(channel, group));
  return !channels_[channel].moving[group];
}

RowCells Synthesizer::moving_cells(int channel, int group, int chirp) const {
  if (!bands_.empty()) {
    return bands_[chirp / kChirpGroup]->cells(band_row(channel, group), chirp % kChirpGroup);
  }
  const RowMemory& rows = *channels_[channel].moving[group];
  const int64_t size = row_size(true);
  const double* const row = rows.values.get() + chirp * size;
  return {0, size / 2, row, row + size / 2};
}

// Returns the row [re/im, row length] of a group with moving echoes, which may be made in `room`.
const double* Synthesizer::moving_row(int channel, int group, int chirp, std::vector<double>& room) const {
  const RowCells cells = moving_cells(channel, group, chirp);
  if (2 * cells.count == row_size(true)) return cells.re;
  room.assign(row_size(true), 0.0);
  add_moving_row(channel, group, chirp, room.data());
  return room.data();
}

// Adds to a row [re/im, row length].
void Synthesizer::add_moving_row(int channel, int group, int chirp, double* row) const {
  const RowCells cells = moving_cells(channel, group, chirp);
  run_simd<add_values>(cells.re, cells.count, row + cells.first);
  run_simd<add_values>(cells.im, cells.count, row + row_size(true) / 2 + cells.first);
}

void Synthesizer::add_still_samples(int channel, std::span<const int> groups, std::complex<double>* out) const {
  std::vector<std::complex<double>> of_group(waveform_.num_samples);
  for (const int group : groups) {
    if (!has_still(channel, group)) continue;
    write_row(channels_[channel].still[group].data(), false, of_group.data());
    for (size_t n = 0; n < of_group.size(); ++n) out[n] += of_group[n];
  }
}

void Synthesizer::write_samples(int channel, std::span<const int> groups, std::complex<double>* out) const {
  const int64_t num_samples = waveform_.num_samples;
  std::vector<std::complex<double>> at_rest(num_samples);
  add_still_samples(channel, groups, at_rest.data());
  std::vector<int> moving;
  for (const int group : groups) {
    if (!is_still(channel, group)) moving.push_back(group);
  }
  std::vector<double> row(row_size(true));
  for (int chirp = 0; chirp < waveform_.num_chirps; ++chirp, out += num_samples) {
    std::ranges::fill(row, 0.0);
    for (const int group : moving) add_moving_row(channel, group, chirp, row.data());
    if (moving.empty()) std::fill_n(out, num_samples, 0.0);
    else write_row(row.data(), true, out);
    for (size_t n = 0; n < at_rest.size(); ++n) out[n] += at_rest[n];
  }
}

void Synthesizer::absorb(const Synthesizer& other, int num_groups) {
  require(num_groups_ == 1, "num_groups", "must be 1 of what absorbs others", num_groups_);
  parallel_for(std::ssize(channels_), [&](int64_t channel) {
    for (int group = 0; group < num_groups; ++group) absorb_group(other, static_cast<int>(channel), group);
  });
}

void Synthesizer::absorb_group(const Synthesizer& other, int channel, int group) {
  ChannelRows& to = channels_[channel];
  const std::vector<double>& still = other.channels_[channel].still[group];
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
  const std::vector<double>& still = channels_[channel].still[group];
  if (!moves && still.empty()) return;
  const int64_t num_samples = waveform_.num_samples;
  std::vector<std::complex<double>> at_rest(num_samples);
  if (!still.empty()) write_row(still.data(), false, at_rest.data());
  parallel_for(waveform_.num_chirps, [&](int64_t chirp) {
    if (job) job->throw_if_cancelled();
    std::complex<double>* samples = out + chirp * num_samples;
    std::vector<double> room;
    if (moves) write_row(moving_row(channel, group, static_cast<int>(chirp), room), true, samples);
    for (int64_t n = 0; n < num_samples; ++n) samples[n] += at_rest[n];
  });
}

void Synthesizer::write_row(const double* row, bool moving, std::complex<double>* out) const {
  (moving && sample_rows_ ? sample_rows_ : tones_)->samples(row, out);
  if (waveform_.falls()) {
    for (int n = 0; n < waveform_.num_samples; ++n) out[n] = std::conj(out[n]);
  }
  if (!waveform_.real) return;
  for (int n = 0; n < waveform_.num_samples; ++n) out[n] = {std::numbers::sqrt2 * out[n].real(), 0.0};
}

}  // namespace echopath
