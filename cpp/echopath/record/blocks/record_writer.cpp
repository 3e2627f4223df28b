#include "echopath/record/blocks/record_writer.h"

#include <algorithm>
#include <functional>

#include "echopath/base/threads/parallel.h"

namespace echopath {
namespace {

// Factor on the room that blocks alike are expected to need, because those to come differ. Memory that is not touched costs
// nothing.
constexpr double kRoomToSpare = 1.1;

// Holds where each block begins in the record, and where the last one ends.
struct Places {
  std::vector<size_t> paths, hits;

  Places(const std::vector<const PathBlock*>& blocks, size_t first_path, size_t first_hit)
      : paths{first_path}, hits{first_hit} {
    for (const PathBlock* block : blocks) {
      paths.push_back(paths.back() + block->num_paths());
      hits.push_back(hits.back() + block->num_hits());
    }
  }
};

template <class Column>
bool has(const std::vector<const PathBlock*>& blocks, Column column) {
  return std::ranges::any_of(blocks, [&](const PathBlock* block) { return !(block->*column).empty(); });
}

bool has_matrices(const std::vector<const PathBlock*>& blocks) {
  return has(blocks, &PathBlock::jones) || has(blocks, &PathBlock::fan_jones);
}

}  // namespace

double RecordWriter::num_bytes(const std::vector<PathBlock>& like, int64_t num_blocks) {
  double num_paths = 0.0, num_hits = 0.0;
  std::vector<const PathBlock*> blocks;
  for (const PathBlock& block : like) {
    blocks.push_back(&block);
    num_paths += static_cast<double>(block.num_paths());
    num_hits += static_cast<double>(block.num_hits());
  }
  const Paths none;
  size_t of_path = 0;
  for_each_column([&](auto column) { of_path += sizeof((none.*column)[0]); });
  if (has(blocks, &PathBlock::curved_cell)) of_path += sizeof(none.curved_cell[0]);
  if (has_matrices(blocks)) of_path += sizeof(none.jones[0]);
  const double times = static_cast<double>(num_blocks) / std::max(1.0, static_cast<double>(like.size()));
  return times * (static_cast<double>(of_path) * num_paths + static_cast<double>(sizeof(Hit)) * num_hits);
}

void RecordWriter::expect(const std::vector<PathBlock>& like, int64_t num_blocks) {
  if (like.empty()) return;
  std::vector<const PathBlock*> blocks;
  for (const PathBlock& block : like) blocks.push_back(&block);
  const Places places(blocks, 0, 0);
  const double times = kRoomToSpare * static_cast<double>(num_blocks) / static_cast<double>(like.size());
  const auto rows = static_cast<size_t>(times * static_cast<double>(places.paths.back()));
  hits_->reserve(static_cast<size_t>(times * static_cast<double>(places.hits.back())));
  for_each_column([&](auto column) { (paths_.*column).reserve(rows); });
  if (has(blocks, &PathBlock::curved_cell)) paths_.curved_cell.reserve(rows);
  if (has_matrices(blocks)) paths_.jones.reserve(rows);
}

// Grows all columns at once, because the first touch of their memory takes the time. An optional column exists from the
// first block that has it, with zeros before. No large pages are asked for: a virtual machine whose free memory went back to
// its host is given each of them anew, in milliseconds, and a record is walked from end to end.
void RecordWriter::make_room(const std::vector<const PathBlock*>& blocks, size_t num_paths, size_t num_hits) {
  const bool has_cells = !paths_.curved_cell.empty() || has(blocks, &PathBlock::curved_cell);
  const bool has_jones = !paths_.jones.empty() || has_matrices(blocks);
  std::vector<std::function<void()>> grow = {[&] { hits_->resize(num_hits); }};
  for_each_column([&](auto column) { grow.push_back([&, column] { (paths_.*column).resize(num_paths); }); });
  grow.push_back([&] { paths_.curved_cell.resize(has_cells ? num_paths : 0); });
  grow.push_back([&] { paths_.jones.resize(has_jones ? num_paths : 0); });
  parallel_for(std::ssize(grow), [&](int64_t i) { grow[i](); });
}

void RecordWriter::append(const std::vector<const PathBlock*>& blocks, Job* job) {
  const Places places(blocks, paths_.offsets.size(), hits_->size());
  make_room(blocks, places.paths.back(), places.hits.back());
  Job own(job);  // its progress is not that of the rays
  parallel_for(std::ssize(blocks), [&](int64_t index) {
    const size_t row = places.paths[index], hit = places.hits[index];
    const PathRows rows{hits_->data() + hit,         static_cast<int64_t>(hit),
                        paths_.offsets.data() + row, paths_.num_bounces.data() + row,
                        paths_.diffuse.data() + row, paths_.weight.data() + row,
                        paths_.stratum.data() + row, paths_.batch.data() + row,
                        paths_.flags.data() + row};
    blocks[index]->write(rows, paths_);
  }, &own);
  for (const PathBlock* block : blocks) paths_.frame.statistics.add(block->statistics);
}

void RecordWriter::finish() {
  paths_.hits = std::move(hits_);
  paths_.frame.statistics.num_paths = paths_.num_paths();
}

}  // namespace echopath
