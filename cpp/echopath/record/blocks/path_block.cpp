#include "echopath/record/blocks/path_block.h"

#include <algorithm>
#include <utility>

namespace echopath {

void PathBlock::add(const Hit* first, int count, uint64_t diffuse_bits, std::complex<float> path_weight, int path_stratum) {
  add_record(std::ssize(hits), count, diffuse_bits, path_weight, path_stratum);
  hits.insert(hits.end(), first, first + count);
}

void PathBlock::add_reversal(const Hit* first, int count, uint64_t diffuse_bits, std::complex<float> path_weight,
                             int path_stratum) {
  uint64_t reversed_bits = 0;
  for (int k = 0; k < count; ++k) reversed_bits |= (diffuse_bits >> k & 1) << (count - 1 - k);
  add_record(std::ssize(hits), count, reversed_bits, path_weight, path_stratum);
  rows.flags[rows.size() - 1] |= kReversedPath;
  for (int k = count; k-- > 0;) hits.push_back(first[k]);
}

void PathBlock::set_jones(const JonesMatrix& matrix) {
  jones.resize(rows.size());
  jones.back() = matrix;
}

void PathBlock::set_curved_cell(const std::array<float, 7>& cell) {
  curved_cell.resize(rows.size());
  curved_cell.back() = cell;
}

void PathBlock::begin_fan(const Hit& hit, int path_stratum, int max_bounces) {
  PathFan& fan = fans.emplace_back();
  fan.num_before = rows.size();
  fan.hit = hit;
  fan.stratum = static_cast<uint16_t>(path_stratum);
  fan.batch = current_batch;
  fan.flags = current_ray;
  fan.max_bounces = static_cast<uint32_t>(max_bounces);
}

void PathBlock::add_leg(std::complex<double> factor) {
  const std::complex<float> rounded(static_cast<float>(factor.real()), static_cast<float>(factor.imag()));
  fan_legs.push_back({rounded, static_cast<uint32_t>(fan_hits.size()), 0});
}

void PathBlock::add_leg_hit(const Hit& hit) {
  fan_hits.push_back(hit);
  ++fan_legs.back().num_hits;
}

void PathBlock::end_fan() {
  const PathFan& fan = fans.back();
  const FanLeg* legs = fan_legs.data() + fan_legs.size() - fan.num_in - fan.num_out;
  FanPairs(fan, legs, fan_hits.data()).count(num_fan_paths_, num_fan_hits_);
}

// Stores the hits of the current ray as far as its chains go.
void PathBlock::end_chains(const Hit* ray_hits) {
  const auto first = static_cast<uint32_t>(chain_hits.size());
  uint32_t longest = 0;
  const auto begin_at_first = [&](HitChain& chain) {
    chain.first = first;
    longest = std::max(longest, chain.count);
  };
  std::for_each(chains.begin() + static_cast<int64_t>(first_chain_of_ray_), chains.end(), begin_at_first);
  std::for_each(lit_chains.begin() + static_cast<int64_t>(first_lit_chain_of_ray_), lit_chains.end(), begin_at_first);
  chain_hits.insert(chain_hits.end(), ray_hits, ray_hits + longest);
  first_chain_of_ray_ = chains.size();
  first_lit_chain_of_ray_ = lit_chains.size();
}

void PathBlock::clear() {
  hits.clear();
  rows.clear();
  curved_cell.clear();
  jones.clear();
  fan_jones.clear();
  fans.clear();
  fan_legs.clear();
  fan_hits.clear();
  chain_hits.clear();
  chains.clear();
  lit_chains.clear();
  statistics = TraceStatistics();
  num_fan_paths_ = num_fan_hits_ = 0;
  first_of_ray_ = first_chain_of_ray_ = first_lit_chain_of_ray_ = 0;
  used_depth_ = 0;
  current_batch = kNoBatch;
  current_ray = 0;
}

// Writes the paths [begin, end) that are not of fans. `first_hit` is the index of the block's hits in the record, `row` that
// of its first path.
void PathBlock::write_own(size_t begin, size_t end, int64_t first_hit, size_t row, PathRows& to, Paths& paths) const {
  const auto copy = [&](const auto& column, auto* out) {
    std::copy(column.begin() + static_cast<int64_t>(begin), column.begin() + static_cast<int64_t>(end), out);
  };
  for (size_t i = begin; i < end; ++i) to.offsets[i - begin] = first_hit + rows.offset[i];
  copy(rows.num_bounces, to.num_bounces);
  copy(rows.diffuse, to.diffuse);
  copy(rows.weight, to.weight);
  copy(rows.stratum, to.stratum);
  copy(rows.batch, to.batch);
  copy(rows.flags, to.flags);
  to.skip_rows(end - begin);
  // These columns end with the last path that has an entry.
  for (size_t i = begin; i < std::min(end, curved_cell.size()); ++i) paths.curved_cell[row + i - begin] = curved_cell[i];
  for (size_t i = begin; i < std::min(end, jones.size()); ++i) paths.jones[row + i - begin] = jones[i];
}

void PathBlock::write(PathRows to, Paths& paths) const {
  const int64_t first_hit = to.first_hit;
  const int64_t* const first_row = paths.offsets.data();
  std::ranges::copy(hits, to.hits);
  to.skip_hits(hits.size());
  std::vector<int64_t> places;
  const FanLeg* legs = fan_legs.data();
  const JonesMatrix* of_pairs = fan_jones.empty() ? nullptr : fan_jones.data();
  size_t done = 0;
  const auto write_until = [&](size_t end) {
    write_own(std::exchange(done, end), end, first_hit, static_cast<size_t>(to.offsets - first_row), to, paths);
  };
  for (const PathFan& fan : fans) {
    write_until(fan.num_before);
    const int64_t* const before = to.offsets;
    FanPairs(fan, legs, fan_hits.data()).write(to, places);
    legs += fan.num_in + fan.num_out;
    if (!of_pairs) continue;
    const auto count = to.offsets - before;
    std::copy_n(of_pairs, count, paths.jones.data() + (before - first_row));
    of_pairs += count;
  }
  write_until(rows.size());
}

}  // namespace echopath
