#pragma once
// Keeps the memory of a synthesis for the next one.
#include <memory>
#include <vector>

#include "echopath/signal/echoes/echo_tiles.h"

namespace echopath {

struct RowMemory {
  std::unique_ptr<double[]> values;
  size_t room = 0;
};

class SynthesisMemory {
 public:
  // Returns the memory that an earlier synthesis left, or a new one (KeptMemory).
  static std::unique_ptr<SynthesisMemory> take();
  static void leave(std::unique_ptr<SynthesisMemory> memory) noexcept;

  EchoTiles tiles;
  // Returns room for `count` values, which are not set.
  RowMemory take_rows(size_t count);
  void give(RowMemory rows);
  size_t num_bytes() const;

 private:
  std::vector<RowMemory> rows_;  // not in use
};

}  // namespace echopath
