#pragma once
// What a synthesis works on, kept for the next.
#include <memory>
#include <vector>

#include "echopath/signal/echo_tiles.h"

namespace echopath {

class SynthesisMemory {
 public:
  // What another left, or new; see KeptMemory.
  static std::unique_ptr<SynthesisMemory> take();
  static void leave(std::unique_ptr<SynthesisMemory> memory);

  EchoTiles tiles;
  // Zeros [count].
  std::vector<double> take_rows(size_t count);
  void give(std::vector<double> rows);
  size_t num_bytes() const;

 private:
  std::vector<std::vector<double>> rows_;  // not in use
};

}  // namespace echopath
