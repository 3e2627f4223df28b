#include "echopath/signal/synthesis_memory.h"

#include <algorithm>
#include <utility>

#include "echopath/base/kept_memory.h"
#include "echopath/base/large_array.h"

namespace echopath {
namespace {

KeptMemory<SynthesisMemory>& kept() {
  static KeptMemory<SynthesisMemory>& memory = *new KeptMemory<SynthesisMemory>;  // threads may outlive what is static
  return memory;
}

}  // namespace

std::unique_ptr<SynthesisMemory> SynthesisMemory::take() { return kept().take(); }

void SynthesisMemory::leave(std::unique_ptr<SynthesisMemory> memory) { kept().leave(std::move(memory)); }

// The smallest that will do.
std::vector<double> SynthesisMemory::take_rows(size_t count) {
  const auto by_room = [](const std::vector<double>& a, const std::vector<double>& b) { return a.capacity() < b.capacity(); };
  std::sort(rows_.begin(), rows_.end(), by_room);
  const auto found = std::find_if(rows_.begin(), rows_.end(), [&](const auto& rows) { return rows.capacity() >= count; });
  std::vector<double> taken;
  if (found == rows_.end()) {
    resize_large(taken, count);
    return taken;
  }
  taken = std::move(*found);
  rows_.erase(found);
  taken.assign(count, 0.0);
  return taken;
}

void SynthesisMemory::give(std::vector<double> rows) {
  if (rows.capacity() > 0) rows_.push_back(std::move(rows));
}

size_t SynthesisMemory::num_bytes() const {
  size_t values = 0;
  for (const std::vector<double>& rows : rows_) values += rows.capacity();
  return values * sizeof(double) + tiles.num_bytes();
}

}  // namespace echopath
