#include "echopath/trace/path_block.h"

#include <algorithm>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace echopath {

void PathBlock::add_record(int64_t offset, int count, uint64_t diffuse_bits, std::complex<double> path_weight,
                           int path_stratum) {
  offsets.push_back(offset);
  num_bounces.push_back(static_cast<uint8_t>(count));
  diffuse.push_back(diffuse_bits);
  weight.emplace_back(static_cast<float>(path_weight.real()), static_cast<float>(path_weight.imag()));
  stratum.push_back(static_cast<uint8_t>(path_stratum));
  flags.push_back(0);
  batch.push_back(current_batch);
}

void PathBlock::add(const Hit* first, int count, uint64_t diffuse_bits, std::complex<double> path_weight, int path_stratum) {
  add_record(static_cast<int64_t>(hits.size()), count, diffuse_bits, path_weight, path_stratum);
  hits.insert(hits.end(), first, first + count);
}

void PathBlock::add_prefix(int skipped, int count, uint64_t diffuse_bits, std::complex<double> path_weight,
                           int path_stratum) {
  pending_.push_back(offsets.size());
  used_depth_ = std::max(used_depth_, skipped + count);
  add_record(skipped, count, diffuse_bits, path_weight, path_stratum);
}

void PathBlock::add_reversal(const Hit* first, int count, uint64_t diffuse_bits, std::complex<double> path_weight,
                             int path_stratum) {
  uint64_t reversed_bits = 0;
  for (int k = 0; k < count; ++k) reversed_bits |= (diffuse_bits >> k & 1) << (count - 1 - k);
  add_record(static_cast<int64_t>(hits.size()), count, reversed_bits, path_weight, path_stratum);
  flags.back() = kReversedPath;
  for (int k = count; k-- > 0;) hits.push_back(first[k]);
}

void PathBlock::set_jones(const JonesMatrix& matrix) {
  jones.resize(offsets.size());
  jones.back() = matrix;
}

void PathBlock::set_curved_cell(const std::array<float, 7>& cell) {
  curved_cell.resize(offsets.size());
  curved_cell.back() = cell;
}

void PathBlock::end_ray(const Hit* ray_hits) {
  const auto base = static_cast<int64_t>(hits.size());
  hits.insert(hits.end(), ray_hits, ray_hits + used_depth_);
  for (const size_t path : pending_) offsets[path] += base;
  pending_.clear();
  used_depth_ = 0;
}

void PathBlock::shrink_to_fit() {
  hits.shrink_to_fit();
  offsets.shrink_to_fit();
  num_bounces.shrink_to_fit();
  diffuse.shrink_to_fit();
  weight.shrink_to_fit();
  stratum.shrink_to_fit();
  curved_cell.shrink_to_fit();
  jones.shrink_to_fit();
}

namespace {

// To the system: what thousands of small blocks leave behind is never large enough for a later array.
void give_back_free_memory() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

void add_statistics(TraceStatistics& total, const TraceStatistics& part) {
  total.num_queries += part.num_queries;
  total.num_hits += part.num_hits;
  total.num_near_antenna += part.num_near_antenna;
  total.num_grazing += part.num_grazing;
  total.num_small_mirrors += part.num_small_mirrors;
  total.num_false_hits += part.num_false_hits;
}

template <class T>
void append(std::vector<T>& all, const std::vector<T>& part) {
  all.insert(all.end(), part.begin(), part.end());
}

// A column that exists only where some path needs it: zeros for those before.
template <class T>
void append_sparse(std::vector<T>& all, const std::vector<T>& part, size_t before) {
  if (part.empty()) return;
  all.resize(before);
  append(all, part);
}

}  // namespace

void join_blocks(std::vector<PathBlock>& blocks, Paths& paths, Job* job) {
  size_t num_hits = 0, num_paths = 0;
  for (const PathBlock& block : blocks) {
    num_hits += block.hits.size();
    num_paths += block.offsets.size();
  }
  auto hits = std::make_shared<std::vector<Hit>>();
  hits->reserve(num_hits);
  paths.offsets.reserve(num_paths);
  paths.num_bounces.reserve(num_paths);
  paths.diffuse.reserve(num_paths);
  paths.weight.reserve(num_paths);
  paths.stratum.reserve(num_paths);
  paths.flags.reserve(num_paths);
  paths.batch.reserve(num_paths);
  for (PathBlock& block : blocks) {
    if (job) job->throw_if_cancelled();
    const auto base = static_cast<int64_t>(hits->size());
    append(*hits, block.hits);
    for (const int64_t offset : block.offsets) paths.offsets.push_back(base + offset);
    append(paths.num_bounces, block.num_bounces);
    append(paths.diffuse, block.diffuse);
    append(paths.weight, block.weight);
    append(paths.stratum, block.stratum);
    append(paths.flags, block.flags);
    append(paths.batch, block.batch);
    const size_t before = paths.offsets.size() - block.offsets.size();
    append_sparse(paths.curved_cell, block.curved_cell, before);
    append_sparse(paths.jones, block.jones, before);
    add_statistics(paths.frame.statistics, block.statistics);
    block = PathBlock();  // frees it: the peak stays near one copy of the record
  }
  if (!paths.curved_cell.empty()) paths.curved_cell.resize(num_paths);
  if (!paths.jones.empty()) paths.jones.resize(num_paths);
  paths.hits = std::move(hits);
  paths.frame.statistics.num_paths = paths.num_paths();
  give_back_free_memory();
}

}  // namespace echopath
