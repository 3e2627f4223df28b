#pragma once
// Holds what the parts of the synthesizer share: the rows of moving echoes. Internal to the module.
#include <memory>

#include "echopath/base/memory/kept_memory.h"
#include "echopath/base/memory/large_array.h"
#include "echopath/signal/synthesizer.h"

namespace echopath {

// Counts the chirps to which echoes are added at a time, so that echoes are read once for all of them. Each parallel task
// has whole groups of so many chirps.
inline constexpr int kChirpGroup = TileAtChirps::kMaxChirps;

// Holds the memory of the rows of one channel and group.
struct Synthesizer::RowMemory {
  std::unique_ptr<double[]> values;
  size_t room = 0;

  size_t num_bytes() const { return room * sizeof(double); }
  // Returns memory with room for `count` values, which are not set.
  static std::unique_ptr<RowMemory> take(size_t count) {
    std::unique_ptr<RowMemory> rows = KeptMemory::of_process().take<RowMemory>(count * sizeof(double));
    if (rows->room >= count) return rows;
    *rows = {};
    *rows = {std::make_unique_for_overwrite<double[]>(count), count};
    prefer_large_pages(rows->values.get(), rows->num_bytes());
    return rows;
  }
};

}  // namespace echopath
