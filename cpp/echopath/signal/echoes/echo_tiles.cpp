#include "echopath/signal/echoes/echo_tiles.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "echopath/base/errors.h"
#include "echopath/base/memory/large_array.h"
#include "echopath/base/threads/parallel.h"
#include "echopath/signal/kernels/kernels.h"

namespace echopath {
namespace {

constexpr int kLanes = TileAtChirps::kLanes;
constexpr int kDelayBits = 16;  // 64 places in each cell of 512 samples
constexpr int kMaxDrifts = 64;
constexpr int kEchoesOfCell = 16;  // least mean number for each class of drift, so that moments are worth while
constexpr int kDigitBits = 11;     // of a pass of the radix sort

// Sorts by bits [first_bit, end_bit); equal keys keep their order. `sorted` is scratch memory.
void radix_sort(std::vector<uint64_t>& keys, std::vector<uint64_t>& sorted, int first_bit, int end_bit) {
  constexpr size_t kDigits = size_t{1} << kDigitBits;
  sorted.resize(keys.size());
  for (int bit = first_bit; bit < end_bit; bit += kDigitBits) {
    const auto digit = [&](uint64_t key) { return static_cast<size_t>(key >> bit) & (kDigits - 1); };
    std::vector<size_t> place(kDigits + 1);
    for (const uint64_t key : keys) ++place[digit(key) + 1];
    for (size_t d = 1; d <= kDigits; ++d) place[d] += place[d - 1];
    for (const uint64_t key : keys) sorted[place[digit(key)]++] = key;
    keys.swap(sorted);
  }
}

int bits_for(uint64_t count) { return static_cast<int>(std::bit_width(count - 1)); }

}  // namespace

const double* EchoTiles::nodes(const Tile& tile) const { return nodes_.get() + tile.vector * num_nodes_ * 3 * kLanes; }

// Divides echoes into classes by how far they drift over the frame.
struct DriftClasses {
  double least = 0.0;  // s, of delay
  double width = 1.0;  // s
  int count = 1;
};

namespace {

struct Extent {
  double least = std::numeric_limits<double>::infinity(), most = -least;
  void add(double value) {
    least = std::min(least, value);
    most = std::max(most, value);
  }
  void add(const Extent& other) {
    least = std::min(least, other.least);
    most = std::max(most, other.most);
  }
  double size() const { return std::max(0.0, most - least); }
};

double drift_of(const Echoes& block, int64_t echo) {
  return block.delay[(block.sampling.num_rows - 1) * block.num_echoes + echo] - block.delay[echo];
}

// Returns classes as narrow as a cell, unless that leaves few echoes for each cell and class.
DriftClasses classes_of_drift(std::span<const Echoes> blocks, double longest_delay, int num_cells) {
  std::vector<std::pair<Extent, Extent>> by_block(blocks.size());
  parallel_for(std::ssize(blocks), [&](int64_t b) {
    const Echoes& block = blocks[b];
    auto& [delay, drift] = by_block[b];
    for (int64_t p = 0; p < block.num_echoes; ++p) {
      delay.add(std::clamp(block.delay[p], 0.0, longest_delay));
      drift.add(std::clamp(drift_of(block, p), -longest_delay, longest_delay));
    }
  });
  Extent delay, drift;
  double total = 0.0;
  for (size_t b = 0; b < blocks.size(); ++b) {
    delay.add(by_block[b].first);
    drift.add(by_block[b].second);
    total += static_cast<double>(blocks[b].num_echoes);
  }
  const double cell = longest_delay / num_cells, cells = 1.0 + delay.size() / cell;
  const double most = std::clamp(total / (cells * kEchoesOfCell), 1.0, static_cast<double>(kMaxDrifts));
  DriftClasses classes;
  classes.least = drift.least;
  classes.width = std::max(cell, drift.size() / std::floor(most));
  classes.count = std::min(kMaxDrifts, 1 + static_cast<int>(drift.size() / classes.width));
  return classes;
}

}  // namespace

void EchoTiles::set_bits(std::span<const Echoes> blocks, int num_groups, int num_drifts) {
  int64_t largest = 1;
  for (const Echoes& block : blocks) largest = std::max(largest, block.num_echoes);
  local_bits_ = bits_for(static_cast<uint64_t>(largest));
  index_bits_ = local_bits_ + bits_for(blocks.size());
  drift_bits_ = bits_for(static_cast<uint64_t>(num_drifts));
  group_bits_ = bits_for(static_cast<uint64_t>(num_groups));
  delay_bits_ = std::min(kDelayBits, 63 - index_bits_ - drift_bits_ - group_bits_);
  require(delay_bits_ >= 0, "num_groups", "leaves too few bits for so many echoes", num_groups);
}

void EchoTiles::find_keys(std::span<const Echoes> blocks, double longest_delay, const DriftClasses& drifts) {
  std::vector<int64_t> first(blocks.size() + 1);
  for (size_t b = 0; b < blocks.size(); ++b) first[b + 1] = first[b] + blocks[b].num_echoes;
  const double steps = static_cast<double>((uint64_t{1} << delay_bits_) - 1) / longest_delay;
  order_.resize(first.back());
  parallel_for(std::ssize(blocks), [&](int64_t b) {
    const Echoes& block = blocks[b];
    const double* delay = block.delay.data() + int64_t{num_nodes_ / 2} * block.num_echoes;
    uint64_t* out = order_.data() + first[b];
    for (int64_t p = 0; p < block.num_echoes; ++p) {
      const auto place = static_cast<uint64_t>(std::clamp(delay[p], 0.0, longest_delay) * steps);
      const double drift = (drift_of(block, p) - drifts.least) / drifts.width;
      const auto drift_class = static_cast<uint64_t>(std::clamp(drift, 0.0, drifts.count - 1.0));
      const uint64_t group = block.group.empty() ? 0 : block.group[p];
      const uint64_t order = ((group << drift_bits_ | drift_class) << delay_bits_) | place;
      out[p] = order << index_bits_ | static_cast<uint64_t>(b) << local_bits_ | static_cast<uint64_t>(p);
    }
  });
}

void EchoTiles::sort(std::span<const Echoes> blocks, int num_groups, double longest_delay, int num_cells) {
  const DriftClasses drifts = classes_of_drift(blocks, longest_delay, num_cells);
  set_bits(blocks, num_groups, drifts.count);
  find_keys(blocks, longest_delay, drifts);
  radix_sort(order_, spare_order_, index_bits_, group_shift() + group_bits_);
  remember(blocks);
  cut();
}

void EchoTiles::assign(std::span<const Echoes> blocks, int num_groups, double longest_delay, int num_cells) {
  num_nodes_ = blocks.front().sampling.num_rows;
  if (!fits(blocks, longest_delay / num_cells)) sort(blocks, num_groups, longest_delay, num_cells);
  make_room();
  gather(blocks);
}

namespace {

constexpr int64_t kSampleStep = 61;  // of the echoes whose delays tell whether an order fits

// Calls visit(delay in the middle of the frame) for some echoes of a block.
template <class Visit>
void visit_samples(const Echoes& block, Visit visit) {
  const double* delay = block.delay.data() + int64_t{block.sampling.num_rows / 2} * block.num_echoes;
  for (int64_t p = 0; p < block.num_echoes; p += kSampleStep) visit(delay[p]);
}

}  // namespace

void EchoTiles::remember(std::span<const Echoes> blocks) {
  sizes_.clear();
  samples_.clear();
  groups_.resize(blocks.size());
  for (size_t b = 0; b < blocks.size(); ++b) {
    sizes_.push_back(blocks[b].num_echoes);
    groups_[b] = blocks[b].group;
    visit_samples(blocks[b], [&](double delay) { samples_.push_back(delay); });
  }
}

// The order of another channel serves where the delays are the same to within a cell: antennas of an array are nearer to
// each other than that. An order that does not suit the delays costs time and no accuracy.
bool EchoTiles::fits(std::span<const Echoes> blocks, double cell) const {
  if (sizes_.size() != blocks.size()) return false;
  for (size_t b = 0; b < blocks.size(); ++b) {
    if (sizes_[b] != blocks[b].num_echoes || groups_[b] != blocks[b].group) return false;
  }
  bool are_near = true;
  auto sample = samples_.begin();
  for (const Echoes& block : blocks) {
    visit_samples(block, [&](double delay) { are_near = are_near && std::abs(delay - *sample++) < cell; });
  }
  return are_near;
}

// A tile ends where its group does.
void EchoTiles::cut() {
  tiles_.clear();
  first_.clear();
  const auto total = std::ssize(order_);
  const auto group_of = [&](int64_t i) { return static_cast<uint32_t>(order_[i] >> group_shift()); };
  int64_t vector = 0;
  for (int64_t begin = 0; begin < total;) {
    const uint32_t group = group_of(begin);
    const int64_t limit = std::min<int64_t>(total, begin + TileAtChirps::kCapacity);
    int64_t end = limit;
    if (group_of(limit - 1) != group) {
      end = begin + 1;
      while (group_of(end) == group) ++end;
    }
    tiles_.push_back({vector, static_cast<int>(end - begin), group});
    first_.push_back(begin);
    vector += (end - begin + kLanes - 1) / kLanes;
    begin = end;
  }
}

void EchoTiles::make_room() {
  if (tiles_.empty()) return;
  const int64_t num_vectors = tiles_.back().vector + (tiles_.back().count + kLanes - 1) / kLanes;
  const size_t size = static_cast<size_t>(num_vectors) * num_nodes_ * 3 * kLanes;
  if (size <= num_values_) return;
  nodes_.reset();
  nodes_ = std::make_unique_for_overwrite<double[]>(size);
  num_values_ = size;
  prefer_large_pages(nodes_.get(), size * sizeof(double));
}

namespace {

// Says where the values of one echo stand in its block.
struct Source {
  const double* delay;
  const double* amplitude;  // re, im
  int64_t stride;           // echoes, from node to node
};

constexpr double kLogarithmOfNothing = -1e4;  // of an amplitude that is 0

// Gathers all nodes of one vector of echoes. It prefetches those of the next, which are far apart in memory.
void gather_vector(const Source* from, const Source* next, int count, int num_nodes, double nothing, double* out) {
  for (int k = 0; k < num_nodes; ++k, out += 3 * kLanes) {
    for (int lane = 0; lane < kLanes; ++lane) {
      const Source& source = from[lane];
      const int64_t at = k * source.stride, next_at = k * next[lane].stride;
      __builtin_prefetch(next[lane].delay + next_at);
      __builtin_prefetch(next[lane].amplitude + 2 * next_at);
      out[lane] = source.delay[at];
      out[kLanes + lane] = lane < count ? source.amplitude[2 * at] : nothing;
      out[2 * kLanes + lane] = lane < count ? source.amplitude[2 * at + 1] : 0.0;
    }
  }
}

// `source_of` takes the index of an echo in the tile, which may lie beyond the last. The last vector is filled up with
// amplitudes (nothing, 0).
template <class SourceOf>
void gather_tile(int count, int num_nodes, double nothing, SourceOf source_of, double* out) {
  Source sources[2][kLanes];
  const auto find_sources = [&](int begin) {
    for (int lane = 0; lane < kLanes; ++lane) sources[begin / kLanes % 2][lane] = source_of(begin + lane);
  };
  find_sources(0);
  for (int begin = 0; begin < count; begin += kLanes, out += int64_t{num_nodes} * 3 * kLanes) {
    find_sources(begin + kLanes);
    const int now = begin / kLanes % 2;
    gather_vector(sources[now], sources[1 - now], count - begin, num_nodes, nothing, out);
  }
}

}  // namespace

void EchoTiles::gather(std::span<const Echoes> blocks) {
  const uint64_t local_mask = (uint64_t{1} << local_bits_) - 1, index_mask = (uint64_t{1} << index_bits_) - 1;
  const double nothing = blocks.front().sampling.rows == TimeSampling::Rows::kLogarithms ? kLogarithmOfNothing : 0.0;
  parallel_for(std::ssize(tiles_), [&](int64_t i) {
    const Tile& tile = tiles_[i];
    const auto source_of = [&](int p) {
      const int64_t place = first_[i] + std::min(p, tile.count - 1);
      const uint64_t index = order_[place] & index_mask, echo = index & local_mask;
      const Echoes& block = blocks[index >> local_bits_];
      const auto* amplitude = reinterpret_cast<const double*>(block.amplitude.data() + echo);
      return Source{block.delay.data() + echo, amplitude, block.num_echoes};
    };
    gather_tile(tile.count, num_nodes_, nothing, source_of, nodes_.get() + tile.vector * num_nodes_ * 3 * kLanes);
  });
}

}  // namespace echopath
