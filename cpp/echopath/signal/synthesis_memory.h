#pragma once
// What a synthesis works on, kept for the next.
#include <memory>
#include <vector>

#include "echopath/signal/echo_tiles.h"

namespace echopath {

struct RowMemory {
  std::unique_ptr<double[]> values;
  size_t room = 0;
};

class SynthesisMemory {
 public:
  // What another left, or new; see KeptMemory.
  static std::unique_ptr<SynthesisMemory> take();
  static void leave(std::unique_ptr<SynthesisMemory> memory) noexcept;

  EchoTiles tiles;
  // Room for `count` values, which are not set.
  RowMemory take_rows(size_t count);
  void give(RowMemory rows);
  size_t num_bytes() const;

 private:
  std::vector<RowMemory> rows_;  // not in use
};

}  // namespace echopath
