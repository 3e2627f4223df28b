#include "echopath/signal/echo_tiles.h"

#include <algorithm>
#include <bit>

#include "echopath/base/errors.h"
#include "echopath/base/parallel.h"
#include "echopath/signal/kernels.h"

namespace echopath {
namespace {

constexpr int kLanes = TileAtChirps::kLanes;
constexpr int kDelayBits = 16;  // 64 places in each cell of 512 samples
constexpr int kDigitBits = 11;  // of a pass of the radix sort

// Sorts by bits [first_bit, end_bit), equal ones in their order.
void radix_sort(std::vector<uint64_t>& keys, int first_bit, int end_bit) {
  constexpr size_t kDigits = size_t{1} << kDigitBits;
  std::vector<uint64_t> sorted(keys.size());
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

const double* EchoTiles::nodes(const Tile& tile) const {
  return nodes_.data() + tile.vector * num_nodes_ * 3 * kLanes;
}

// A key is, from its highest bits: group, delay, block, echo in the block.
void EchoTiles::assign(std::span<const Echoes> blocks, int num_groups, double longest_delay) {
  num_nodes_ = blocks.front().sampling.num_nodes;
  int64_t total = 0, largest = 1;
  for (const Echoes& block : blocks) {
    total += block.num_echoes;
    largest = std::max(largest, block.num_echoes);
  }
  local_bits_ = bits_for(static_cast<uint64_t>(largest));
  index_bits_ = local_bits_ + bits_for(blocks.size());
  const int delay_bits = std::min(kDelayBits, 64 - index_bits_ - bits_for(static_cast<uint64_t>(num_groups)));
  require(delay_bits >= 0, "num_groups", "leaves too few bits for so many echoes", num_groups);
  group_shift_ = index_bits_ + delay_bits;
  const double steps = static_cast<double>((uint64_t{1} << delay_bits) - 1);

  std::vector<int64_t> first(blocks.size());
  for (size_t b = 1; b < blocks.size(); ++b) first[b] = first[b - 1] + blocks[b - 1].num_echoes;
  std::vector<uint64_t> order(static_cast<size_t>(total));
  parallel_for(static_cast<int64_t>(blocks.size()), [&](int64_t b) {
    const Echoes& block = blocks[static_cast<size_t>(b)];
    const double* delay = block.delay.data() + int64_t{num_nodes_ / 2} * block.num_echoes;
    uint64_t* keys = order.data() + first[static_cast<size_t>(b)];
    for (int64_t p = 0; p < block.num_echoes; ++p) {
      const auto place = static_cast<uint64_t>(std::clamp(delay[p] / longest_delay, 0.0, 1.0) * steps);
      const uint64_t group = block.group.empty() ? 0 : block.group[static_cast<size_t>(p)];
      keys[p] = ((group << delay_bits | place) << index_bits_) | static_cast<uint64_t>(b) << local_bits_ | static_cast<uint64_t>(p);
    }
  });
  radix_sort(order, index_bits_, group_shift_ + bits_for(static_cast<uint64_t>(num_groups)));
  cut(order);
  gather(blocks, order);
}

// Tiles end where the group does.
void EchoTiles::cut(const std::vector<uint64_t>& order) {
  tiles_.clear();
  first_.clear();
  const auto total = static_cast<int64_t>(order.size());
  const auto group_of = [&](int64_t i) {
    return group_shift_ == 64 ? 0u : static_cast<uint32_t>(order[static_cast<size_t>(i)] >> group_shift_);
  };
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
  nodes_.resize(std::max(nodes_.size(), static_cast<size_t>(vector) * num_nodes_ * 3 * kLanes));
}

void EchoTiles::gather(std::span<const Echoes> blocks, const std::vector<uint64_t>& order) {
  const uint64_t local_mask = (uint64_t{1} << local_bits_) - 1, index_mask = (uint64_t{1} << index_bits_) - 1;
  parallel_for(static_cast<int64_t>(tiles_.size()), [&](int64_t i) {
    const Tile& tile = tiles_[static_cast<size_t>(i)];
    double* out = nodes_.data() + tile.vector * num_nodes_ * 3 * kLanes;
    const int padded = (tile.count + kLanes - 1) / kLanes * kLanes;
    for (int p = 0; p < padded; ++p) {
      const bool is_real = p < tile.count;
      const uint64_t index = order[static_cast<size_t>(first_[static_cast<size_t>(i)] + std::min(p, tile.count - 1))] & index_mask;
      const Echoes& block = blocks[static_cast<size_t>(index >> local_bits_)];
      double* at = out + int64_t{p / kLanes} * num_nodes_ * 3 * kLanes + p % kLanes;
      auto from = static_cast<int64_t>(index & local_mask);
      for (int k = 0; k < num_nodes_; ++k, at += 3 * kLanes, from += block.num_echoes) {
        const std::complex<double> amplitude = block.amplitude[static_cast<size_t>(from)];
        at[0] = block.delay[static_cast<size_t>(from)];
        at[kLanes] = is_real ? amplitude.real() : 0.0;
        at[2 * kLanes] = is_real ? amplitude.imag() : 0.0;
      }
    }
  });
}

}  // namespace echopath
