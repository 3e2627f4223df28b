#include "echopath/signal/synthesis_memory.h"

#include <utility>

#include "echopath/base/kept_memory.h"
#include "echopath/base/large_array.h"

namespace echopath {

std::unique_ptr<SynthesisMemory> SynthesisMemory::take() { return KeptMemory<SynthesisMemory>::of_process().take(); }

void SynthesisMemory::leave(std::unique_ptr<SynthesisMemory> memory) noexcept {
  KeptMemory<SynthesisMemory>::of_process().leave(std::move(memory));
}

// Takes the smallest room that suffices.
RowMemory SynthesisMemory::take_rows(size_t count) {
  auto best = rows_.end();
  for (auto rows = rows_.begin(); rows != rows_.end(); ++rows) {
    if (rows->room >= count && (best == rows_.end() || rows->room < best->room)) best = rows;
  }
  RowMemory taken;
  if (best != rows_.end()) {
    taken = std::exchange(*best, std::move(rows_.back()));
    rows_.pop_back();
    return taken;
  }
  taken = {std::make_unique_for_overwrite<double[]>(count), count};
  prefer_large_pages(taken.values.get(), count * sizeof(double));
  return taken;
}

void SynthesisMemory::give(RowMemory rows) {
  if (rows.values) rows_.push_back(std::move(rows));
}

size_t SynthesisMemory::num_bytes() const {
  size_t values = 0;
  for (const RowMemory& rows : rows_) values += rows.room;
  return values * sizeof(double) + tiles.num_bytes();
}

}  // namespace echopath
